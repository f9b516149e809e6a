"""Properties in the report: each with what the evidence says of it, and a hole where there is none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modeproof.registers.citations import read_sources
from modeproof.registers.edits import write_stamps
from modeproof.registers.killers import load_killers, stamps_of
from modeproof.registers.load import load_document
from modeproof.report.build import make
from modeproof.report.parts.properties import part
from modeproof.report.sources import DIFFERS, HOLE, gather
from tests.report.paper import RESULT, change, make_paper, put, second, without


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """The box with all its evidence."""
    return make_paper(tmp_path)


def shown(root: Path) -> dict[str, Any]:
    """The data of the only property."""
    data = part(gather(root)).data
    found: dict[str, Any] = data["documents"][0]["properties"][0]
    return found


def test_a_property_has_meaning_sources_witness_and_each_engines_verdict(root: Path) -> None:
    run = second(root)
    one = shown(root)
    assert (one["sentence"], one["hazard"]) == ("It shuts only over the door.", "It shuts on a hand.")
    assert one["clauses"] == ["BX-1-2", "BX-1-1"]
    assert one["formal"]["text"].startswith("ShutsOverDoor == [][boxState' # boxState => door']")
    assert one["witness"]["run"] == "WIT_Box" and one["witness"]["verdict"].value == "REACHED"
    row = one["environments"][0]
    assert (row["word"], row["good"], row["engines"]) == ("HOLDS", True, ["TLC", "Z3", "cvc5"])
    assert (row["run"], row["distinct"].value, row["generated"].value) == ("MC_Box", 5, 11)
    assert row["distinct"].source == "build/evidence/box/MC_Box.json"
    assert [other["id"] for other in row["other_runs"]] == [run], "what tries a reading is no other run"
    assert one["theorems"][0]["sentence"] == "It shuts only over the door, whatever happens."
    assert part(gather(root)).troubles == ()


def test_a_property_without_evidence_shows_a_hole_in_its_place(root: Path) -> None:
    without(root, "MC_Box")
    row = shown(root)["environments"][0]
    assert (row["word"], row["good"], row["distinct"]) == ("not there", None, None)
    report = make(root)
    assert '<span class="hole">? not there</span>' in report.html
    assert report.status == HOLE
    assert any("MC_Box" in one.what for one in report.troubles if one.status == HOLE)


def test_evidence_of_another_text_is_no_verdict_on_this_one(root: Path) -> None:
    change(root / "spec" / "box" / "Box.tla", "CODE == TLCEval", "CODE  == TLCEval")
    row = shown(root)["environments"][0]
    assert (row["word"], row["good"], row["engines"]) == ("HOLDS", None, [])
    assert row["why"] == "the evidence is of another text of spec/box/Box.tla"


def test_engines_that_contradict_each_other_are_not_as_expected(root: Path) -> None:
    name = "it_shuts_over_the_door_only"
    put(root, name, verdict="VIOLATED", as_expected=False, reason="counterexample door=0")
    row = shown(root)["environments"][0]
    assert row["disagreement"] == f"MC_Box says HOLDS, {name} says VIOLATED"
    assert (row["good"], row["engines"]) == (False, ["TLC"])
    report = make(root)
    assert "two engines disagree: MC_Box says HOLDS" in report.html
    assert report.status == DIFFERS


def test_a_run_that_fails_outweighs_one_that_holds(root: Path) -> None:
    changes = {"verdict": "VIOLATED", "as_expected": False, "reason": "ShutsOverDoor is violated"}
    run = second(root, result={"violated": "ShutsOverDoor"}, **changes)
    row = shown(root)["environments"][0]
    assert (row["run"], row["word"], row["good"]) == (run, "VIOLATED", False)


def test_nothing_is_known_where_another_property_fell_first(root: Path) -> None:
    changes = {"verdict": "VIOLATED", "as_expected": False, "reason": "TypeOK is violated"}
    put(root, "MC_Box", result={"violated": "TypeOK"}, **changes)
    assert shown(root)["environments"][0]["word"] == "INCONCLUSIVE"


def test_an_unreached_witness_is_not_as_expected(root: Path) -> None:
    put(root, "WIT_Box", result={"reached": []})
    found = part(gather(root))
    assert [one.status for one in found.troubles] == [DIFFERS]
    assert "WIT_Box has not reached Close" in found.troubles[0].what


def test_a_run_of_another_lane_is_no_hole_or_verdict(root: Path) -> None:
    without(root, "MC_Box")
    without(root, "MC_Box_lazy")
    path = root / "spec" / "box" / "runs.toml"
    path.write_text(path.read_text().replace('lanes = ["full"]', 'lanes = ["exhaustive"]'))
    put(root, "WIT_Box")
    found = part(gather(root))
    row = found.data["documents"][0]["properties"][0]["environments"][0]
    assert (row["word"], row["good"], found.troubles) == ("not in this lane", None, ())


def test_unrecorded_kills_are_a_hole_with_the_command(root: Path) -> None:
    assert shown(root)["kills"] is None
    assert "no campaign over this text: <code>modeproof mutate spec --document box</code>" in make(root).html


def test_a_property_says_its_killed_mutants_and_how_many_alone(root: Path) -> None:
    mutants = [
        {"id": "Box-1", "killers": ["ShutsOverDoor"], "verdict": "KILLED", "operator": "swap"},
        {"id": "Box-2", "killers": ["ShutsOverDoor", "TypeOK"], "verdict": "KILLED", "operator": "swap"},
        {"id": "Box-3", "killers": [], "verdict": "SURVIVED", "operator": "swap"},
    ]
    result = {"mutants": mutants, "judges": {"ShutsOverDoor": 3, "TypeOK": 3}}
    put(root, "strength_spec", kind="strength", result=result, verdict="KILLED", expected="KILLED")
    kills = shown(root)["kills"]
    assert [kills[key].value for key in ("asked", "killed", "alone")] == [3, 2, 1]
    assert kills["mutants"] == ["Box-1", "Box-2"]


def test_text_of_registers_and_evidence_cannot_become_markup(root: Path) -> None:
    hostile = "<script>alert(1)</script>"
    change(root / "spec" / "box" / "properties.toml", "It shuts on a hand.", hostile)
    put(root, "MC_Box", strength=hostile, result=RESULT["MC_Box"])
    html = make(root).html
    assert "alert(1)&lt;/script&gt;" in html and hostile not in html


def test_the_runs_table_has_every_declared_run_with_its_command(root: Path) -> None:
    without(root, "NEG_Box_hasty")
    rows = {row["id"]: row for row in part(gather(root)).data["documents"][0]["runs"]}
    assert list(rows) == ["MC_Box", "MC_Box_lazy", "NEG_Box_eager", "NEG_Box_hasty", "WIT_Box"]
    assert rows["NEG_Box_eager"]["traced"] and rows["NEG_Box_eager"]["steps"].value == 1
    assert rows["NEG_Box_hasty"]["verdict"] is None and not rows["NEG_Box_hasty"]["traced"]
    assert rows["NEG_Box_hasty"]["command"] == "modeproof check box/NEG_Box_hasty"


def test_an_edit_says_where_it_was_not_judged(root: Path) -> None:
    file = root / "spec/box/killers.toml"
    place = 'run = "MC_Box"\nin = "Box"\n'
    row = (
        f"[[killer.ShutsOverDoor]]\n{place}old = 'Ready(i) == i.door \\/ ~Needed'\nnew = 'Ready(i) == TRUE'\n"
    )
    file.write_text(row)
    (told,) = part(gather(root)).troubles
    assert (told.status, told.what) == (HOLE, "box: an edit of ShutsOverDoor was not judged on this text")
    assert "? not judged on this text" in make(root).html
    document = load_document(root, "box")
    stamps = stamps_of(document, read_sources(document), load_killers(root, "box"))
    write_stamps(document, "killers", {name: str(stamp) for name, stamp in stamps.items()})
    assert part(gather(root)).troubles == ()
    assert (
        "one edit: <code>Ready(i) == i.door \\/ ~Needed</code> becomes <code>Ready(i) == TRUE</code> in Box"
        in make(root).html
    )
