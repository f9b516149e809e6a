"""A suite takes every transition it promises, is the same each time, and is whole or not there."""

from __future__ import annotations

import json
from array import array
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.graph.columns import Columns, merge_columns
from modeproof.ground.errors import Unjudged
from modeproof.kit.vectors import open_suite
from modeproof.suites.tour import covers, every_step, every_transition, walks
from modeproof.suites.write import write_suite
from tests.graph.printed import LETTERS, lamp_graph


def table(rows: list[list[int]]) -> Columns:
    return Columns(
        members=tuple((n,) for n in range(len(rows[0]))),
        step_of=tuple(array("l", [0] * len(row)) for row in rows),
        next_of=tuple(array("l", row) for row in rows),
    )


@st.composite
def graphs(draw: st.DrawFn) -> Columns:
    """Random graphs whose states can all be reached from state 0."""
    states, columns = draw(st.integers(1, 8)), draw(st.integers(1, 5))
    any_state = st.integers(0, states - 1)
    rows = draw(
        st.lists(st.lists(any_state, min_size=columns, max_size=columns), min_size=states, max_size=states)
    )
    seen = [0]
    for state in seen:
        seen += [after for after in dict.fromkeys(rows[state]) if after not in seen]
    place = {state: n for n, state in enumerate(seen)}
    return table([[place[after] for after in rows[state]] for state in seen])


@given(graphs(), st.sampled_from([every_transition, every_step]))
def test_every_wanted_transition_is_taken(columns: Columns, choose: object) -> None:
    wanted = choose(columns)  # type: ignore[operator]
    cases = walks(columns, 0, wanted)
    assert covers(columns, 0, wanted, cases)
    assert cases == walks(columns, 0, wanted), "the same graph gives the same walks"
    if choose is every_transition:
        assert sum(map(len, wanted)) == columns.transitions


def test_a_state_that_is_never_left_needs_a_reset() -> None:
    columns = table([[1, 2], [1, 1], [2, 2]])
    cases = walks(columns, 0, every_transition(columns))
    assert len(cases) == 2 and sum(map(len, cases)) == 6


def test_walks_that_miss_a_transition_or_jump_are_noticed() -> None:
    columns = table([[1, 0], [0, 1]])
    wanted = every_transition(columns)
    (case,) = walks(columns, 0, wanted)
    assert covers(columns, 0, wanted, [case])
    assert not covers(columns, 0, wanted, [case[:-1]])
    assert not covers(columns, 0, wanted, [case[1:]])


def test_inputs_that_no_state_tells_apart_share_a_column(tmp_path: Path) -> None:
    columns = merge_columns(lamp_graph(tmp_path))
    assert sum(map(len, columns.members)) == len(LETTERS)
    by_letter = {letter: c for c, members in enumerate(columns.members) for letter in members}
    same_dt = [n for n, (press, word, dt) in enumerate(LETTERS) if dt == 1 and not (press and word == 0x0FF0)]
    assert len({by_letter[n] for n in same_dt}) == 1
    assert by_letter[12] != by_letter[0] and len(columns.members) == 6


def test_members_of_a_column_and_of_a_class_take_turns(tmp_path: Path) -> None:
    stats = write_suite(tmp_path / "t.jsonl", "tour", [lamp_graph(tmp_path)])
    words = {scan.inputs["word"] for case in open_suite(tmp_path / "t.jsonl").cases() for scan in case.scans}
    assert stats.inputs_used > stats.columns and {"0000", "0001", "0FF0"} <= words


def test_a_suite_stays_the_same_and_says_what_it_is(tmp_path: Path) -> None:
    graph = lamp_graph(tmp_path)
    for name in ("a", "b"):
        write_suite(tmp_path / name, "tour", [graph])
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    header = json.loads((tmp_path / "a").read_text().splitlines()[0])
    assert header["transitions"] == 18 and header["guarantees"] and header["hypothesis"]
    assert {row["name"]: row["transitions"] for row in header["steps"]}["SwitchOn"] == 3
    ids = [case.id for case in open_suite(tmp_path / "a").cases()]
    assert len(set(ids)) == len(ids) == header["cases"]


def test_the_brief_suite_is_shorter_and_takes_every_step(tmp_path: Path) -> None:
    graph = lamp_graph(tmp_path)
    tour = write_suite(tmp_path / "t", "tour", [graph])
    brief = write_suite(tmp_path / "b", "brief", [graph])
    assert brief.scans < tour.scans and brief.transitions == 7
    steps = {scan.step for case in open_suite(tmp_path / "b").cases() for scan in case.scans}
    assert len(steps) == 4


def test_a_suite_that_cannot_be_written_leaves_no_part_behind(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(Unjudged, match="cannot be written"):
        write_suite(tmp_path / "file" / "t.jsonl", "tour", [lamp_graph(tmp_path)])
    with pytest.raises(Unjudged, match="no suite"):
        write_suite(tmp_path / "t.jsonl", "toru", [lamp_graph(tmp_path)])
    with pytest.raises(Unjudged):
        write_suite(tmp_path / "t.jsonl", "tour", [])
    assert not (tmp_path / "t.jsonl").exists()
