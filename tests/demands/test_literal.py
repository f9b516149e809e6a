"""Programs written from the papers alone FOLLOW their pages by default, and none of their faults does."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from tests.demands.literal_program import DOCUMENT, PLACE, broken_by, verdicts

FAULTS = tomllib.loads((PLACE / "faults.toml").read_text("utf-8"))["fault"]
SUITES = ("sequences", "brief")
FIRST = {row["program"]: number for number, row in reversed(list(enumerate(FAULTS)))}
"""The first fault of each program."""


def words(target: str, path: Path, names: tuple[str, ...]) -> dict[str, str]:
    return {one.suite: f"{one.word}: {one.reason}" for one in verdicts(target, path, names)}


@pytest.mark.deep
@pytest.mark.parametrize(
    ("target", "suite"),
    [
        *((target, "sequences") for target in DOCUMENT),
        *(pytest.param(target, "brief", marks=pytest.mark.long) for target in DOCUMENT),
    ],
)
def test_who_had_only_the_paper_follows_it(target: str, suite: str) -> None:
    found = words(target, PLACE / f"{target}.st", (suite,))
    assert all(said.startswith("FOLLOWS") for said in found.values()), found


@pytest.mark.deep
@pytest.mark.parametrize(
    "number",
    [
        pytest.param(number, marks=() if number in FIRST.values() else pytest.mark.long)
        for number in range(len(FAULTS))
    ],
)
def test_a_fault_breaks_the_page(number: int, tmp_path: Path) -> None:
    row: dict[str, Any] = FAULTS[number]
    text = (PLACE / f"{row['program']}.st").read_text("utf-8")
    assert text.count(row["old"]) == 1
    wrong = tmp_path / f"{row['program']}.st"
    wrong.write_text(text.replace(row["old"], row["new"]), "utf-8")
    if "wires" in row:
        assert broken_by(row["program"], wrong, row["wires"]) == "LevelAfterTheTestPulse"
        assert broken_by(row["program"], PLACE / f"{row['program']}.st", row["wires"]) == ""
        return
    found = (verdict for suite in SUITES for verdict in verdicts(row["program"], wrong, (suite,)))
    assert any(verdict.word == "BREAKS" for verdict in found)


def test_each_target_has_a_program_and_five_faults() -> None:
    assert {path.stem for path in PLACE.glob("*.st")} == set(DOCUMENT)
    assert {target: sum(row["program"] == target for row in FAULTS) for target in DOCUMENT} == dict.fromkeys(
        DOCUMENT, 5
    )
