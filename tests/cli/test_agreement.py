"""Model checker and theorems are compared property by property; a difference is not as expected."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from modeproof.ground import evidence
from modeproof.ground.evidence import evidence_path
from modeproof.lane.agreement import ID, compare, line
from modeproof.lane.summary import failures, render
from modeproof.report.verdicts import status_of


@dataclass(frozen=True)
class Row:
    """As the room of the proofs gives them."""

    id: str
    theorem: str
    reason: str = ""
    environment: str = "honest"
    tlc: str = "HOLDS"
    note: str = ""


def _module(*rows: Row, disagreements: tuple[str, ...] = ()) -> ModuleType:
    module = ModuleType("agreement")
    vars(module).update(rows=lambda: rows, disagreements=lambda: disagreements)
    return module


def _compared(place: Path, module: ModuleType, **verdicts: str) -> dict[str, Any]:
    return compare(place, "toy", module, verdicts, {})


BOTH = _module(Row("One", "first"), Row("Two", "", "nobody knows"))


def test_what_holds_and_is_proved_or_has_a_reason_agrees(tmp_path: Path) -> None:
    record = _compared(tmp_path, BOTH, first="PROVED")
    assert (record["verdict"], status_of(record)) == ("EQUAL", 0)
    assert evidence.read(evidence_path(tmp_path, "toy", ID)) == record
    assert "EQUAL; 1 of 2 properties" in line([record])
    assert line([record]) in render("toy", [], [record])


@pytest.mark.parametrize("verdict", ["VIOLATED", "INCONCLUSIVE", "UNJUDGED"])
def test_an_unproved_theorem_where_tlc_holds_is_a_difference(tmp_path: Path, verdict: str) -> None:
    record = _compared(tmp_path, BOTH, first=verdict)
    assert (record["verdict"], status_of(record)) == ("DIFFERS", 1)
    assert record["reason"] == f"One (honest): HOLDS, and first: {verdict}"
    assert "toy/agreement: DIFFERS: One (honest)" in failures([record], [])[0]
    assert "DIFFERS" in line([record])


def test_a_theorem_that_was_not_asked_is_a_difference(tmp_path: Path) -> None:
    assert status_of(_compared(tmp_path, BOTH)) == 1


def test_a_theorem_without_what_tlc_needs_is_a_difference(tmp_path: Path) -> None:
    module = _module(Row("One", "first"), disagreements=("One (honest): first does not rest on A-1",))
    record = _compared(tmp_path, module, first="PROVED")
    assert record["result"]["problems"] == ["One (honest): first does not rest on A-1"]
    assert status_of(record) == 1


def test_rows_that_fail_or_are_missing_are_a_difference(tmp_path: Path) -> None:
    def none() -> tuple[Row, ...]:
        raise ValueError("One: neither a formula proves it nor a reason says why none does")

    module = _module()
    assert _compared(tmp_path, module)["reason"] == "no property of the whole system was compared"
    vars(module).update(rows=none)
    assert "neither a formula" in _compared(tmp_path, module)["reason"]
