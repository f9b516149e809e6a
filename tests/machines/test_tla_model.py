"""The machine as a TLA+ module: contracts that the blocks keep, and wirings that TLC refutes."""

from __future__ import annotations

import dataclasses
import re
import shutil
import tomllib
from pathlib import Path

import pytest

from machines.tlc_runs import Task, model_of, tasks
from machines.verdicts import Machine
from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.lane.machine_tlc import judged
from modeproof.tlc.run_judge import HOLDS, VIOLATED
from tests.machines.test_machine_command import without_the_beam

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "spec/machine_cell"
TEXT = (FOLDER / "wiring.toml").read_text("utf-8")

MISTAKES = {
    "unlock before the pick-up": (
        "S_Contactor2 AND NOT edm.S_EDM_Out",
        "S_Contactor2",
        "unlock",
        "UnlockAtRest",
    ),
    "a safeguard is forgotten": (
        'automatic = [["guard", "beam"]]',
        'automatic = [["beam"]]',
        "open_door",
        "AutomaticClosed",
    ),
    "Activate from the mode": (
        '[block.beam.inputs]\nActivate = "TRUE"',
        '[block.beam.inputs]\nActivate = "beam_in_use"',
        "beam",
        "Assumes_beam",
    ),
    "the status of the guard for the request": (
        'S_OutControl = "running.Q1 OR held.Q1"',
        'S_OutControl = "guard.S_GuardLocked"',
        "modes",
        "NoModeNoMotion",
    ),
    "two modes at once": ('is = "fplc.MSO_1"', 'is = "fplc.MSO_1 OR fplc.MSO_2"', "modes", "OneMode"),
    "a change of the mode keeps the reset": (
        "NOT a_mode OR mode_changes OR fault OR NOT S_EmergencyStop",
        "NOT a_mode OR fault OR NOT S_EmergencyStop",
        "modes",
        "ModeChangeStops",
    ),
    "the switch is active by its mode": (
        '[block.enable.inputs]\nActivate = "TRUE"',
        '[block.enable.inputs]\nActivate = "enable_in_use"',
        "switch",
        "Assumes_enable",
    ),
    "one reset for door and desk": (
        'Reset = "ResetGuard"',
        'Reset = "Reset"',
        "door_resets",
        "DoorNeedsReset",
    ),
    "a start that is held": (
        "start_edge.Q AND ready AND NOT ready_begins.Q AND",
        "Start AND ready AND",
        "letting_go",
        "LettingGoStops",
    ),
    "no start button": (
        "start_edge.Q AND ready AND NOT ready_begins.Q AND",
        "ready AND NOT ready_begins.Q AND",
        "start",
        "ResetThenStart",
    ),
    "an error keeps the request": (
        'R1 = "NOT a_mode OR mode_changes OR fault OR NOT S_EmergencyStop"',
        'R1 = "NOT a_mode OR mode_changes OR fplc.ERROR OR NOT S_EmergencyStop"',
        "start",
        "Assumes_edm",
    ),
}

FAULTS = {
    "keeps_guard": ("guard_locking/GuardLocking.tla", "LockLost(i) == ~Secured(i)", "LockLost(i) == FALSE"),
    "keeps_beam": (
        "testable_safety_sensor/TestableSafetySensor.tla",
        "\nLost(i) == ~Free(i)",
        "\nLost(i) == FALSE",
    ),
    "keeps_switch": (
        "enable_switch/EnableSwitch.tla",
        'MayEnable(i) == On("Stage0", i)',
        'MayEnable(i) == On("Stage2", i) \\/ On("Stage0", i)',
    ),
    "keeps_contactors": (
        "edm/EDM.tla",
        'S_EDM_Out == state = "OutputEnable"',
        "S_EDM_Out == state \\in Clocked",
    ),
    "keeps_fplc": (
        "mode_selection/Fplc.tla",
        "mode' = {fplcSelection}",
        "mode' = {fplcSelection} \\cup mode",
    ),
}

OWN = """[[property]]
id = "reset-is-off"
sentence = "It is so."
hazard = "planted"
cites = ["A-02"]
never = "Reset"
"""
SAFETY = tomllib.loads((FOLDER / "safety.toml").read_text("utf-8"))


def task(id: str, file: Path | None = None) -> Task:
    [found] = [made for made in tasks(file, FOLDER) if made.id == id]
    return found


def test_the_kept_module_is_made_from_the_wiring() -> None:
    made = model_of(Machine(TEXT, "wiring.toml", FOLDER / "safety.toml", FOLDER / "use.toml"), FOLDER)
    assert made == (FOLDER / "MachineCell.tla").read_text("utf-8")


def with_fault(place: Path, id: str) -> None:
    """A copy of the specifications in which one block has one edit."""
    shutil.copytree(ROOT / "spec", place / "spec", ignore=shutil.ignore_patterns("*.toml", "*.cfg"))
    name, old, new = FAULTS[id]
    path = place / "spec" / name
    text = path.read_text("utf-8")
    assert text.count(old) == 1
    path.write_text(text.replace(old, new), "utf-8")


@pytest.mark.parametrize(
    "id", [pytest.param(id, marks=[pytest.mark.deep] if at else []) for at, id in enumerate(FAULTS)]
)
def test_a_faulty_block_breaks_the_contract_that_it_keeps(tmp_path: Path, id: str) -> None:
    found, _ = judged(ROOT, task(id), True)
    assert (found.verdict, found.as_expected) == (HOLDS, True)
    with_fault(tmp_path, id)
    found, outcome = judged(tmp_path, task(id), True)
    assert found.verdict == VIOLATED
    assert outcome.log.trace


@pytest.mark.deep
def test_a_faulty_block_in_the_cell_leaves_the_contracts(tmp_path: Path) -> None:
    with_fault(tmp_path, "keeps_contactors")
    made = dataclasses.replace(task("whole_five"), checks=("IsOverContracts",))
    cfg = re.sub(r"INVARIANTS.*", "", made.files["Cell.cfg"])
    found, outcome = judged(tmp_path, dataclasses.replace(made, files={**made.files, "Cell.cfg": cfg}), True)
    assert (found.verdict, found.violated) == (VIOLATED, "IsOverContracts")
    assert outcome.log.trace


@pytest.mark.deep
@pytest.mark.parametrize("block", ["guard", "beam", "switch", "contactors"])
def test_a_block_needs_what_its_contract_assumes(block: str) -> None:
    found, _ = judged(ROOT, task(f"needs_{block}"), True)
    assert (found.verdict, found.as_expected) == (VIOLATED, True)


SLOW = (
    "one reset for door and desk",
    "a start that is held",
    "no start button",
    "an error keeps the request",
)


@pytest.mark.parametrize(
    "what",
    [pytest.param(what, marks=[pytest.mark.long if what in SLOW else pytest.mark.deep]) for what in MISTAKES],
)
def test_tlc_refutes_a_mistake_of_wiring(tmp_path: Path, what: str) -> None:
    old, new, run, falls = MISTAKES[what]
    assert TEXT.count(old) == 1
    mine = tmp_path / "my.toml"
    mine.write_text(TEXT.replace(old, new), "utf-8")
    found, outcome = judged(ROOT, task(run, mine), False)
    assert (found.verdict, found.violated) == (VIOLATED, falls)
    assert outcome.log.trace


@pytest.mark.deep
@pytest.mark.parametrize("id", ["unlock", "whole_five"])
def test_the_shipped_cell_holds_over_contracts(id: str) -> None:
    found, _ = judged(ROOT, task(id), True)
    assert (found.verdict, found.as_expected) == (HOLDS, True)


@pytest.mark.deep
def test_a_door_without_a_reset_is_a_dead_end(tmp_path: Path) -> None:
    mine = tmp_path / "my.toml"
    mine.write_text(TEXT.replace('Reset = "ResetGuard"', 'Reset = "FALSE"'), "utf-8")
    found, _ = judged(ROOT, task("back_to_each_mode", mine), False)
    assert (found.verdict, found.violated) == (VIOLATED, "GoalIsReached")


def test_the_page_has_the_runs_and_their_states() -> None:
    page = (ROOT / "docs/wire-your-machine.md").read_text("utf-8")
    rows = dict(re.findall(r"^\|.*?`(\w+)` \|.*?([\d,]+) \|$", page, re.MULTILINE))
    made = {run.id: run for run in tasks(None, FOLDER)}
    for id, run in made.items():
        assert run.breaks or run.distinct, id
        assert f"`{id}`" in page or id.startswith("needs_")
    assert len(rows) > 12
    assert {id: f"{made[id].distinct:,}" for id in rows} == rows
    assert f"{made['back_to_each_mode'].distinct:,} states" in page


@pytest.mark.deep
def test_a_count_that_moved_is_not_as_expected() -> None:
    found, _ = judged(ROOT, dataclasses.replace(task("keeps_guard"), distinct=1), True)
    assert not found.as_expected
    assert "pinned 1" in found.reason


def test_a_block_without_a_contract_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mine = tmp_path / "my.toml"
    late = '[block.late]\nof = "TON"\nwhy = "a delay"\ninputs.IN = "Start"\nparameters.PT = 20\n\n[signals]'
    mine.write_text(TEXT.replace("[signals]", late).replace('    "edm",\n', '    "late", "edm",\n'), "utf-8")
    assert main(["machine", str(mine), "--model", str(tmp_path / "M.tla")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "block.late" in said
    assert "no TON" in said


def test_a_run_of_an_unknown_property_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mine = tmp_path / "safety.toml"
    mine.write_text(
        (FOLDER / "safety.toml").read_text("utf-8").replace('"unlock-at-rest"', '"at-rest"'), "utf-8"
    )
    assert main(["machine", "--properties", str(mine), "--tlc", "unlock"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "no property 'unlock-at-rest'" in said


def test_a_wiring_without_a_block_of_the_runs_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "my.toml"
    mine.write_text(TEXT.replace("guard.", "door.").replace("block.guard", "block.door"), "utf-8")
    text = mine.read_text("utf-8").replace('"guard", "beam", "enable",\n', '"door", "beam", "enable",\n')
    mine.write_text(text, "utf-8")
    assert main(["machine", str(mine), "--tlc", "unlock"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "speaks of a block 'guard'" in said


def test_a_part_that_names_no_run_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", "--tlc", "no-such-run"]) == 2
    assert "no run of TLC" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no [[property]] in it"),
        ("x = [", "no TOML"),
        (None, "cannot be read: No such file"),
        ("[observer.x]\n" + OWN, "x: key 'of' is missing"),
        (OWN.replace("Reset", "x.Q") + '[observer.x]\nof = "R_TRIG"\ninputs = {}\n', "with all its inputs"),
        (
            OWN.replace("Reset", "ResetIt"),
            f"mine.toml:2: reset-is-off: {FOLDER / 'wiring.toml'} has no 'ResetIt'",
        ),
    ],
)
@pytest.mark.parametrize("option", ["--tlc", "--model"])
def test_bad_properties_are_refused_by_their_own_name(
    text: str | None, said: str, option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine, target = tmp_path / "mine.toml", tmp_path / "M.tla"
    if text is not None:
        mine.write_text(text, "utf-8")
    words = ["--tlc", "unlock"] if option == "--tlc" else ["--model", str(target)]
    assert main(["machine", "--properties", str(mine), *words]) == 2
    found = capsys.readouterr().err
    assert found.count("\n") == 1
    assert found.startswith(f"modeproof: {mine}")
    assert said in found
    assert not target.exists()


def test_a_model_has_the_properties_that_were_given(tmp_path: Path) -> None:
    mine, target = tmp_path / "mine.toml", tmp_path / "M.tla"
    mine.write_text(OWN, "utf-8")
    assert main(["machine", "--properties", str(mine), "--model", str(target)]) == 0
    made = target.read_text("utf-8")
    assert 'ResetIsOff == "reset-is-off"' in made
    assert "UnlockAtRest" not in made


def test_a_model_leaves_out_what_the_wiring_lacks(tmp_path: Path) -> None:
    mine, target = tmp_path / "my.toml", tmp_path / "M.tla"
    mine.write_text(without_the_beam(), "utf-8")
    assert main(["machine", str(mine), "--model", str(target)]) == 0
    made = target.read_text("utf-8")
    assert "Left out, for the machine has no SF_TestableSafetySensor: beam-needs-reset." in made
    assert "BeamNeedsReset ==" not in made
    assert "UnlockAtRest ==" in made


@pytest.mark.parametrize(
    ("option", "name", "shipped"),
    [
        ([], "wiring", False),
        (["--properties"], "safety", False),
        (["--use"], "use", False),
        (["--properties"], "safety", True),
    ],
)
def test_counts_are_compared_only_where_all_is_shipped(
    option: list[str], name: str, shipped: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = FOLDER / f"{name}.toml" if shipped else shutil.copy(FOLDER / f"{name}.toml", tmp_path)
    asked = []

    def judge(place: Path, task: Task, shipped: bool) -> None:
        asked.append(shipped)
        raise Unjudged("enough")

    monkeypatch.setattr("modeproof.lane.machine_tlc.judged", judge)
    monkeypatch.setattr("machines.tlc_runs._looked_at", lambda machine: SAFETY)
    assert main(["machine", *option, str(file), "--tlc", "unlock"]) == 2
    assert asked == [shipped]
