"""A case that shows a difference becomes short, and what is left can be run again by its numbers."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.kit.errors import Unjudged
from modeproof.kit.shrink import Part, cut, read_part
from modeproof.kit.suite_judge import Difference, Options, Plan, run_suite
from modeproof.kit.text import as_text
from modeproof.kit.vectors import Case, Suite, open_suite
from modeproof.suites.write import write_suite
from tests.graph.printed import lamp_graph
from tests.kit.lamps import Lamp, SlowAndWrong, made


class Worn(Lamp):
    """Goes off too late from the third time on that it is switched on."""

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset(params)
        self.times = 0

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        before = self.on
        out = super().scan(dt_ms, inputs)
        self.times += self.on and not before
        self.limit = 501 if self.times >= 3 else 500
        return out


class Moody(Lamp):
    """Wrong once, and never again."""

    moods = 0

    def shown(self, out: Mapping[str, Any]) -> Mapping[str, Any]:
        Moody.moods += 1
        return {**out, "MW": "1234"} if Moody.moods == 9 else out


@pytest.fixture
def tour(tmp_path: Path) -> Suite:
    write_suite(tmp_path / "tour.jsonl", "tour", [lamp_graph(tmp_path)])
    return open_suite(tmp_path / "tour.jsonl")


def found(suite: Suite, lamp: type[Lamp], relation: str = "exact", effort: int = 60) -> Difference:
    difference = run_suite(suite, lamp, plan=Plan(Options(relation), effort=effort)).difference
    assert difference is not None
    return difference


def test_what_needs_its_history_keeps_it_and_nothing_else(tour: Suite) -> None:
    one = found(tour, Worn)
    assert one.confirmed and one.scan > 8
    assert 6 <= len(one.shortest.scans) <= 8, "three times on, twice off, and too late, at two paces"
    assert run_suite(tour, Worn, plan=Plan(only=one.case.id, part=one.part)).word == "DIFFERS"
    assert run_suite(tour, Lamp, plan=Plan(only=one.case.id, part=one.part)).word == "CONFORMS"


def test_without_effort_the_beginning_of_the_case_is_given(tour: Suite) -> None:
    one = found(tour, Worn, effort=0)
    assert one.shortest.scans == one.case.scans[: one.scan] and one.part == f"1-{one.scan}"


def test_a_difference_is_repeatable_only_if_it_shows_again(tour: Suite) -> None:
    Moody.moods = 0
    verdict = run_suite(tour, Moody, plan=Plan(effort=60))
    assert verdict.difference is not None and not verdict.difference.confirmed
    assert "does not always do the same" in as_text(verdict)


def test_where_nothing_is_expected_any_scan_may_go(tmp_path: Path) -> None:
    one = found(made(tmp_path, "sic"), SlowAndWrong, "monitor")
    assert one.confirmed and len(one.shortest.scans) == 1


@given(st.sets(st.integers(0, 22), min_size=1), st.none() | st.integers(0, 22))
def test_a_part_is_read_as_it_is_written(kept: set[int], way: int | None) -> None:
    part = Part(tuple(sorted(kept)), way)
    case = Case("x-1", "why", "document", (), {}, 0, 0, (None,) * 23)  # type: ignore[arg-type]
    assert read_part(str(part), case) == part


@pytest.mark.parametrize(
    "text", ["", "0", "24", "3-1", "2,1", "1,1", "x", "1-", "~1", "1,~1", "~30,1", "1-99999999"]
)
def test_what_is_no_part_is_unjudged(text: str) -> None:
    case = Case("x-1", "why", "document", (), {}, 0, 0, (None,) * 23)  # type: ignore[arg-type]
    with pytest.raises(Unjudged, match="--scans"):
        read_part(text, case)


def test_every_part_that_is_tried_expects_what_the_specification_does(tour: Suite) -> None:
    """The right lamp passes whatever part a wrong one fails."""
    case = next(iter(tour.cases()))
    for way in range(len(case.scans) - 1):
        part = Part((way + 1,), way)
        lamp = Lamp()
        lamp.reset(case.params)
        for scan in cut(tour, case, part).scans:
            assert lamp.scan(scan.dt_ms, scan.inputs) == scan.outputs
