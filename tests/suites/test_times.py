"""Time in small pieces, and waits longer than a counter of 16 bits lasts: where a program forgets time."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.graph.columns import merge_columns
from modeproof.graph.device import DeviceGraph
from modeproof.kit.suite_judge import CONFORMS, DIFFERS, run_suite
from modeproof.kit.vectors import open_suite
from modeproof.suites.times import plan, split
from modeproof.suites.write import NoCases, write_suite
from tests.graph import printed
from tests.graph.printed import CODE, OTHER, lamp_graph, lines
from tests.kit.programs import starter
from tests.suites.relay import relay_graph

ROUNDED = """
right = scan
def scan(m): return right({**m, "dt_ms": m["dt_ms"] // UNIT * UNIT})
"""
OVERFLOW = """
right, idle = scan, 0
def scan(m):  # dark for longer than the counter lasts: pressed, it shines for the rest of it
    global idle, elapsed
    idle = 0 if on else idle + m["dt_ms"]
    out = right(m)
    if on and BITS <= idle: elapsed, idle = idle % BITS - BITS // 2, 0
    return out
"""


def test_a_good_program_passes(tmp_path: Path) -> None:
    write_suite(tmp_path / "t", "times", [lamp_graph(tmp_path)])
    suite = open_suite(tmp_path / "t")
    notes = suite.header["graphs"][0]
    assert notes["pieces"] > 0 and notes["long_waits"] > 0
    assert run_suite(suite, starter(tmp_path)).word == CONFORMS


@pytest.mark.parametrize("unit", [2, 10, 50])
def test_rounding_each_scans_time_passes_only_the_tour(tmp_path: Path, unit: int) -> None:
    graph = lamp_graph(tmp_path)
    for name, word in (("tour", CONFORMS), ("wp", CONFORMS), ("times", DIFFERS)):
        write_suite(tmp_path / name, name, [graph])
        fault = ROUNDED.replace("UNIT", str(unit))
        assert run_suite(open_suite(tmp_path / name), starter(tmp_path, fault)).word == word


@pytest.mark.parametrize("bits", [1 << 15, 1 << 16])
def test_an_overflowing_timer_passes_the_tour_but_not_this(tmp_path: Path, bits: int) -> None:
    graph = lamp_graph(tmp_path, lines())
    for name, word in (("tour", CONFORMS), ("times", DIFFERS)):
        write_suite(tmp_path / name, name, [graph])
        fault = OVERFLOW.replace("BITS", str(bits))
        assert run_suite(open_suite(tmp_path / name), starter(tmp_path, fault)).word == word


def test_a_timer_overflows_where_the_graph_has_short_times(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The lamp for 20 ms: a wait of 65 s would take thousands of scans of such times."""
    monkeypatch.setattr(printed, "TICK_MS", 10)
    write_suite(tmp_path / "t", "times", [lamp_graph(tmp_path, lines())])
    suite = open_suite(tmp_path / "t")
    assert max(scan.dt_ms for case in suite.cases() for scan in case.scans) == 1000
    assert run_suite(suite, starter(tmp_path, "LIMIT = 20")).word == CONFORMS
    for bits in (1 << 15, 1 << 16):
        fault = "LIMIT = 20\n" + OVERFLOW.replace("BITS", str(bits))
        assert run_suite(suite, starter(tmp_path, fault)).word == DIFFERS


def uneven_lamp(folder: Path, monkeypatch: pytest.MonkeyPatch) -> DeviceGraph:
    """The lamp for 10 ms, with times in its graph of which none measures the others."""
    letters = [
        (press, word, dt) for press in (False, True) for word in (0, CODE, OTHER) for dt in (0, 5, 9, 10)
    ]
    for name, value in (("LETTERS", tuple(letters)), ("LIMIT", 10), ("TICK_MS", 1)):
        monkeypatch.setattr(printed, name, value)
    return lamp_graph(folder)


def test_time_comes_in_pieces_only_where_nothing_can_happen_meanwhile(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After 9 ms another 5 would end in the middle: 5 ms are no pieces of anything; 10 are, of 9 and 1."""
    write_suite(tmp_path / "t", "times", [uneven_lamp(tmp_path, monkeypatch)])
    suite = open_suite(tmp_path / "t")
    assert suite.header["graphs"][0]["pieces"] > 0
    assert run_suite(suite, starter(tmp_path, "LIMIT = 10")).word == CONFORMS
    rounded = "LIMIT = 10\n" + ROUNDED.replace("UNIT", "2")
    assert run_suite(suite, starter(tmp_path, rounded)).word == DIFFERS


@given(st.integers(2, 5000))
def test_pieces_add_up(time_ms: int) -> None:
    assert all(sum(way) == time_ms and min(way) > 0 and len(way) > 1 for way in split(time_ms))


def test_a_device_without_time_has_no_such_cases(tmp_path: Path) -> None:
    graph = relay_graph(tmp_path)
    assert list(plan(graph, merge_columns(graph)).cases) == []
    with pytest.raises(NoCases, match="relay times: the suite would have no cases"):
        write_suite(tmp_path / "t", "times", [graph])
    assert not (tmp_path / "t").exists()
