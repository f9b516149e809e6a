"""The logs of examples/logs are judged as their names say, at exactly the line of the planted fault."""

from __future__ import annotations

from dataclasses import replace

import pytest

from modeproof.ground.places import root
from modeproof.trace.exact import Scans
from modeproof.trace.follow import Followed
from modeproof.trace.log import Log, Rows
from modeproof.trace.log_judge import Graphs, Judgement
from modeproof.trace.targets import find_target
from tests.trace.judging import LOGS, example, judge, record

GOOD = ("fplc_good.jsonl", "fplc_good.csv", "fplc_partial.csv")
PLANTED = {"fplc_wrong_echo.jsonl": 29, "fplc_short_dwell.jsonl": 40, "fplc_skipped_step.jsonl": 34}
"""The first impossible line of the file."""
SCANS = Scans(18, 22)
"""The examples were recorded with scans of 20 ms."""
MIDDLE, SAMPLED = "fplc_from_the_middle.jsonl", "fplc_sampled.csv"


@pytest.fixture(scope="module")
def found(graphs: Graphs) -> dict[str, Judgement]:
    names = [*GOOD, *PLANTED, MIDDLE, SAMPLED]
    judged = judge("fplc", [example("fplc", name) for name in names], graphs)
    return dict(zip(names, judged, strict=True))


def test_the_logs_are_those_that_the_recorder_writes() -> None:
    assert {
        path.name: path.read_text() for path in LOGS.iterdir() if path.suffix != ".py" and path.is_file()
    } == (record.logs())


@pytest.mark.parametrize("name", GOOD)
def test_a_good_log_is_accepted_by_both(name: str, found: dict[str, Judgement]) -> None:
    one = found[name]
    assert (one.verdict, one.accepted, one.status) == ("CONFORMS", len(one.log.rows), 0)
    assert isinstance(one.followed, Followed) and one.followed.accepted == len(one.log.rows) == 52


@pytest.mark.parametrize("name", PLANTED)
def test_a_planted_fault_is_found_at_its_line(name: str, found: dict[str, Judgement]) -> None:
    one = found[name]
    assert (one.verdict, one.status) == ("DIFFERS", 1)
    assert one.log.rows[one.accepted].line == PLANTED[name]


def test_only_tlc_counts_the_ms(found: dict[str, Judgement]) -> None:
    one = found["fplc_short_dwell.jsonl"].followed
    assert isinstance(one, Followed)
    assert (one.accepted, one.open) == (52, ("the time of fplc",))


def test_a_log_may_begin_in_the_middle(graphs: Graphs, found: dict[str, Judgement]) -> None:
    (anywhere,) = judge("fplc", [example("fplc", MIDDLE)], graphs, anywhere=True)
    assert (anywhere.verdict, found[MIDDLE].verdict, found[MIDDLE].accepted) == ("CONFORMS", "DIFFERS", 0)


@pytest.mark.parametrize(("dwell", "followed"), [(100, {"fplc"}), (0, set())])
def test_no_graph_with_a_dwell_time_follows_a_log_without(
    dwell: int, followed: set[str], graphs: Graphs
) -> None:
    log, target = example("fplc", GOOD[0]), find_target(root(), "fplc")
    log = replace(log, params={"fplc": {**log.params["fplc"], "T_DWELL_ms": dwell}})
    assert graphs.matching(target, log).keys() == followed


def test_samples_may_have_scans_between_them(graphs: Graphs, found: dict[str, Judgement]) -> None:
    sampled, other = judge("fplc", [example("fplc", SAMPLED), wrong_sample()], graphs, samples=SCANS)
    assert (sampled.verdict, found[SAMPLED].verdict) == ("CONFORMS", "DIFFERS")
    assert (other.verdict, other.accepted) == ("DIFFERS", 9)


def wrong_sample() -> Log:
    """The sampled log with a level that nobody has, in the tenth sample."""
    log = example("fplc", SAMPLED)
    row = log.rows[9]
    wrong = replace(row, outputs={**row.outputs, "MW01": 0x0F0F})
    return replace(log, rows=Rows((*log.rows[:9], wrong, *log.rows[10:])))


def test_a_log_of_the_system_is_judged_scan_by_scan(graphs: Graphs) -> None:
    names = ("key_flows_good.jsonl", "key_flows_lost_word.jsonl")
    good, lost = judge("key_flows", [example("key_flows", name) for name in names], graphs)
    assert (good.verdict, len(good.log.rows)) == ("CONFORMS", 364)
    row = lost.log.rows[lost.accepted]
    assert (lost.verdict, row.line, row.device) == ("DIFFERS", 213, "fplc")
    assert isinstance(lost.followed, Followed) and lost.followed.wrong_input == ("MW07", 0x3C3C, "plc")
