"""A long log is judged in pieces: the states after one are those before the next. And what samples allow."""

from __future__ import annotations

import tracemalloc
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.trace import exact
from modeproof.trace.exact import Scans
from modeproof.trace.log import Log, Row, Rows
from modeproof.trace.log_judge import Graphs, compared
from tests.trace.judging import example, judge
from tests.trace.test_devices import target_of
from tests.trace.test_examples import MIDDLE, PLANTED, SAMPLED

PIECE = 18


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces of so few lines that every example has several."""
    monkeypatch.setattr(exact, "PIECE_LINES", PIECE)


def test_a_fault_is_found_in_a_later_piece(small: None, graphs: Graphs) -> None:
    names = ["fplc_good.jsonl", *PLANTED]
    found = judge("fplc", [example("fplc", name) for name in names], graphs)
    whole, *wrong = found
    assert (whole.verdict, whole.accepted) == ("CONFORMS", 52)
    assert [one.log.rows[one.accepted].line for one in wrong] == list(PLANTED.values())
    assert all(len(one.matched.views) == 1 for one in wrong), "the state before the fault is known"


@pytest.mark.deep
def test_pieces_carry_every_state_that_is_possible(graphs: Graphs, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exact, "PIECE_LINES", 3)
    log = example("fplc", MIDDLE)

    def shown(_device: str, side: str, values: Mapping[str, Any]) -> Mapping[str, Any]:
        return values if side == "in" else {"MW01": values["MW01"]}  # any mode may be set

    blind = replace(log, rows=log.rows[:6].changed(shown))
    (one,) = judge("fplc", [blind], graphs, anywhere=True)
    assert (one.verdict, one.accepted) == ("CONFORMS", 6)
    monkeypatch.setattr(exact, "MOST_STATES", 1)
    with pytest.raises(Unjudged, match="leaves more open than can be followed from piece to piece"):
        judge("fplc", [blind], graphs, anywhere=True)


@pytest.mark.deep
def test_a_system_is_judged_in_pieces_too(graphs: Graphs, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exact, "PIECE_LINES", 100)
    names = ("key_flows_good.jsonl", "key_flows_lost_word.jsonl")
    good, lost = judge("key_flows", [example("key_flows", name) for name in names], graphs)
    assert (good.verdict, good.accepted, lost.verdict) == ("CONFORMS", 364, "DIFFERS")
    assert lost.log.rows[lost.accepted].line == 213


def stuck(name: str = SAMPLED) -> Log:
    """The samples, then a key whose five wires stay TRUE for 30 s while the F-PLC reports no error."""
    log = example("fplc", name)
    wires = dict.fromkeys(("LA", "A", "B", "C", "D", "STR"), True)
    last = log.rows[-1]
    inputs = {**last.inputs, **wires}
    more = [Row(last.line + n, "fplc", dt, inputs, last.outputs) for n, dt in ((1, 200), (2, 30_000))]
    return replace(log, rows=Rows((*log.rows, *more)))


def test_time_between_samples_bounds_what_may_happen(small: None, graphs: Graphs) -> None:
    good, late = judge("fplc", [example("fplc", SAMPLED), stuck()], graphs, samples=Scans(20, 20))
    assert (good.verdict, late.verdict, late.accepted) == ("CONFORMS", "DIFFERS", len(good.log.rows) + 1)


@pytest.mark.deep
def test_a_scan_time_that_the_machine_has_not_differs(graphs: Graphs) -> None:
    (slow,) = judge("fplc", [example("fplc", SAMPLED)], graphs, samples=Scans(300, 300))
    assert slow.verdict == "DIFFERS"


def test_equal_rows_take_no_more_than_their_place() -> None:
    values = {"LA": True, "MW03": 7}
    tracemalloc.start()
    rows = Rows(Row(n, "fplc", n % 5, dict(values), {"MW01": n % 3}) for n in range(50_000))
    size, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert size < 50_000 * 40
    assert len(rows) == 50_000 and rows[49_999] == Row(49_999, "fplc", 4, values, {"MW01": 49_999 % 3})
    assert rows.times("fplc") == set(range(5)) and sum(number for _, number in rows.kinds()) == 50_000
    assert [row.line for row in rows[10:13]] == [10, 11, 12]


def test_what_was_compared_is_counted_by_output(graphs: Graphs) -> None:
    target = target_of("hmi")
    log = Log(
        "a log",
        Rows(
            [
                Row(1, "hmi", 1, {}, {"active": 1}),
                Row(2, "hmi", 1, {"ActiveMSO": 1}, {"active": 1}),
                Row(3, "hmi", 1, {}, {"screen": "select"}),
                Row(4, "hmi", 1, {"ActiveMSO": 1}, {}),
            ]
        ),
        {"hmi": {}},
    )
    found = compared(target, log, graphs.passed(target))
    assert (found.lines, found.outputs["hmi"]["active"], found.outputs["hmi"]["screen"]) == (2, 1, 1)
    assert found.outputs["hmi"]["shown"] == 0
