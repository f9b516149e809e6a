"""The wiring on trial: an outcome counts for the files that it was found with."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import z3

from machines import trial as machine_trial
from machines.trial import Outcome, Trial, edits
from machines.trial_record import as_json, basis_of, read_outcomes
from machines.verdicts import Machine
from modeproof.ground.errors import Unjudged
from programs.invariants.induction import System

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "spec/machine_cell"
TEXT = (FOLDER / "wiring.toml").read_text("utf-8")


def plain(text: str = TEXT, runs: int = 240) -> Machine:
    machine = Machine(text, "wiring.toml", FOLDER / "safety.toml", FOLDER / "use.toml", runs=runs)
    machine.triggers = [[] for _ in machine.questions.rows]
    return machine


def kept(folder: Path, basis: dict[str, str], verdict: str, scans: int) -> Path:
    """One outcome on the disk."""
    edit = next(edits(TEXT, plain().wiring))
    path = folder / "trial.json"
    path.write_text(as_json([Outcome(edit, verdict, ["one-mode"], scans)], basis), "utf-8")
    return path


def test_an_outcome_holds_for_the_files_it_was_found_with(tmp_path: Path) -> None:
    basis = basis_of(plain())
    path = kept(tmp_path, basis, "KILLED", 7)
    (row,) = read_outcomes(path, basis).values()
    assert (row["verdict"], row["by"], row["scans"]) == ("KILLED", ["one-mode"], 7)
    for name in {*basis} - {"use"}:
        assert not read_outcomes(path, {**basis, name: "other"})
    assert not read_outcomes(tmp_path / "none.json", basis)


@pytest.mark.parametrize(
    ("verdict", "scans", "holds"), [("KILLED", 7, True), ("KILLED", 0, False), ("HARMLESS", 0, True)]
)
def test_only_what_runs_did_not_reach_rests_on_their_guide(
    verdict: str, scans: int, holds: bool, tmp_path: Path
) -> None:
    path = kept(tmp_path, {"code": "x", "use": "y"}, verdict, scans)
    assert bool(read_outcomes(path, {"code": "x", "use": "z"})) == holds


@pytest.mark.parametrize("text", ["{", "[]", '{"basis": {}, "edits": [{}]}'])
def test_a_damaged_outcome_is_never_a_kill(text: str, tmp_path: Path) -> None:
    path = tmp_path / "trial.json"
    path.write_text(text, "utf-8")
    with pytest.raises(Unjudged, match="delete it"):
        read_outcomes(path, {})


def test_words_about_the_wiring_leave_outcomes_as_they_are() -> None:
    basis = basis_of(plain())
    assert basis_of(plain(TEXT.replace('why = "the door of the zone"', 'why = "the door"'))) == basis
    assert basis_of(plain(TEXT.replace("TestTime = 100", "TestTime = 90")))["wiring"] != basis["wiring"]


def test_blocks_that_do_not_read_each_other_change_over_freely() -> None:
    trial = Trial(plain(runs=1))
    found = {edit.id: edit for edit in edits(TEXT, trial.machine.wiring) if edit.kind == "order"}
    harmless = trial.run(found["order = manual_begins and automatic_begins changed over"])
    assert harmless is not None
    assert harmless.word == "HARMLESS"
    killed = trial.run(found["order = fplc last"])
    assert killed is not None
    assert killed.word == "KILLED"


@pytest.mark.deep
def test_an_edit_that_a_property_reads_is_not_the_same() -> None:
    trial = Trial(plain(runs=1))
    for id, same in (
        ("outputs.S_FullSpeed = starts", False),
        ("order = manual_begins and automatic_begins changed over", True),
    ):
        edit = next(edit for edit in edits(TEXT, trial.machine.wiring) if edit.id == id)
        assert trial._same(trial.edited(edit)) == same


def same(one: Any, other: Any) -> bool:
    solver = z3.Solver()
    solver.add(one != other)
    return bool(solver.check() == z3.unsat)


def test_a_lost_fact_may_hold_where_a_flag_is_off() -> None:
    """x follows y by a scan: once it was never true; now it is true only where y is, or not for long."""
    x, y, asked = z3.Bools("x y asked")
    yes, no = z3.BoolVal(True), z3.BoolVal(False)
    after = {"x": y, "y": z3.Or(y, asked)}
    edited: Any = SimpleNamespace(
        system=System({"x": x, "y": y}, {"asked": asked}, {"x": no, "y": no}, after, yes, yes, yes)
    )
    never = z3.Not(x)
    assert machine_trial._kept(edited, [never]) == []
    found = machine_trial._weakened(edited, [never])
    # z3 writes the parts of OR in the order in which it has met them, also in other tests: the meaning counts
    wanted = [z3.Or(y, z3.Not(x)), yes]
    assert all(any(same(lemma, other) for other in wanted) for lemma in found)
    assert all(any(same(lemma, other) for lemma in found) for other in wanted)
