"""Planted faults in the report: counts by judge, survivors explained, a hole without a campaign."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modeproof.report.build import make
from modeproof.report.parts.strength import part
from modeproof.report.sources import HOLE, NOTE, gather
from tests.report.paper import make_paper, put

HOSTILE = "<img src=x onerror=alert(1)>"


def mutant(number: int, verdict: str, *killers: str, **more: str) -> dict[str, Any]:
    """One judged mutant."""
    place = {"module": "Box", "definition": "Close", "operator": "guard dropped" if number % 2 else "swap"}
    edit = {"line": number, "old": "i.door", "new": HOSTILE}
    return {"id": f"Box-{number}", **place, **edit, "verdict": verdict, "killers": list(killers), **more}


MUTANTS = [
    mutant(1, "KILLED", "ShutsOverDoor"),
    mutant(2, "KILLED", "TypeOK", "ShutsOverDoor"),
    mutant(3, "SURVIVED", kind="harmless", why="Nobody sees it."),
    mutant(4, "EQUIVALENT"),
]
JUDGES = {"ShutsOverDoor": 4, "TypeOK": 3, "Idle": 2}


def recorded(root: Path, mutants: list[dict[str, Any]] = MUTANTS, **changes: Any) -> None:
    """Record a campaign over the specification."""
    result = {"every": len(mutants), "out_of_scope": 0, "mutants": mutants, "judges": JUDGES}
    fields = {"verdict": "KILLED", "expected": "KILLED", **changes}
    put(root, "strength_spec", kind="strength", result=result, **fields)


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with all its evidence and one recorded campaign."""
    made = make_paper(tmp_path)
    recorded(made)
    return made


def spec(root: Path) -> dict[str, Any]:
    """The recorded campaign over the specification."""
    found: dict[str, Any] = part(gather(root)).data["documents"][0]["campaigns"][0]["recorded"]
    return found


def test_each_judge_counts_asked_killed_killed_first_and_killed_alone(root: Path) -> None:
    rows = {row["id"]: row for row in spec(root)["judges"]}
    numbers = [
        [rows[name][key].value for key in ("asked", "killed", "first", "alone", "negatives")]
        for name in JUDGES
    ]
    assert numbers == [[4, 2, 1, 1, 2], [3, 1, 1, 0, 0], [2, 0, 0, 0, 0]]
    assert spec(root)["operators"] == ["guard dropped", "swap"]
    assert rows["ShutsOverDoor"]["cells"] == [1, 1]
    assert (spec(root)["nothing"], spec(root)["never_alone"]) == (["Idle"], ["TypeOK"])


def test_what_is_equivalent_is_not_counted_as_behaving_differently(root: Path) -> None:
    assert spec(root)["different"].value == 3
    assert {word: figure.value for word, figure in spec(root)["counts"].items()} == {
        "KILLED": 2,
        "SURVIVED": 1,
        "EQUIVALENT": 1,
        "INVALID": 0,
        "UNMEASURED": 0,
    }


def test_a_survivor_stands_with_its_explanation(root: Path) -> None:
    group = spec(root)["survivors"][0]
    assert (group["kind"], group["why"], group["mutants"][0]["id"]) == (
        "harmless",
        "Nobody sees it.",
        "Box-3",
    )
    assert spec(root)["unexplained"] == []


def test_a_survivor_that_nobody_explained_is_not_as_expected(root: Path) -> None:
    why = "Box-5 survives without an explanation"
    recorded(root, [*MUTANTS, mutant(5, "SURVIVED")], verdict="SURVIVED", as_expected=False, reason=why)
    found = spec(root)
    assert [one["id"] for one in found["unexplained"]] == ["Box-5"] and found["good"] is False
    assert make(root).status == 1


def test_unmeasured_mutants_of_a_campaign_are_a_hole_not_kills(root: Path) -> None:
    why = "1 of 5 mutants are not judged"
    recorded(root, [*MUTANTS, mutant(5, "UNMEASURED")], verdict="UNMEASURED", as_expected=False, reason=why)
    found = spec(root)
    assert (found["good"], found["different"].value) == (None, 4)
    assert make(root).status == HOLE


def test_an_unrecorded_campaign_is_a_hole_with_its_command(root: Path) -> None:
    found = part(gather(root))
    assert [one["recorded"] is None for one in found.data["documents"][0]["campaigns"]] == [False, True, True]
    assert [one.status for one in found.troubles] == [NOTE, NOTE]
    assert found.troubles[0].remedy == "modeproof mutate impl --document box"
    assert "no campaign over this text; <code>modeproof mutate impl --judge vectors" in make(root).html


def test_the_text_of_an_edit_cannot_become_markup(root: Path) -> None:
    html = make(root).html
    assert HOSTILE not in html and "&lt;img src=x" in html
