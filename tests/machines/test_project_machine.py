"""The machine cell: its properties are proved, mistakes of wiring are found, and nothing more is said."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import pytest

from machines import flowchart as machine_picture
from machines.concrete_runs import Scan
from machines.trial import edits
from machines.verdicts import Machine
from machines.wiring import wiring_of
from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.certificates.recheck import SOLVERS

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "spec/machine_cell"
TEXT = (FOLDER / "wiring.toml").read_text("utf-8")
SAFETY = tomllib.loads((FOLDER / "safety.toml").read_text("utf-8"))
AT_REST = 'S_SafetyActive = "zone_safe"'
BEFORE_PICK_UP = " AND NOT edm.S_EDM_Out"

MISTAKES = {
    "the status of the guard for the request": (
        'S_OutControl = "running.Q1 OR held.Q1"',
        'S_OutControl = "guard.S_GuardLocked"',
        "safeguards-of-the-mode",
    ),
    "one reset for door and desk": ('Reset = "ResetGuard"', 'Reset = "Reset"', "door-error-stays"),
    "unlock before standstill": (AT_REST, 'S_SafetyActive = "TRUE"', "unlock-at-rest"),
    "unlock before the pick-up": (BEFORE_PICK_UP, "", "unlock-at-rest"),
    "Activate from the mode": (
        '[block.beam.inputs]\nActivate = "TRUE"',
        '[block.beam.inputs]\nActivate = "beam_in_use"',
        "beam-error-stays",
    ),
    "modes that are not exclusive": ('is = "fplc.MSO_0"', 'is = "fplc.MSO_0 OR fplc.MSO_1"', "one-mode"),
    "a start that is held": ("start_edge.Q AND ready", "Start AND ready", "stuck-start"),
    "the mode is one scan old": ('    "fplc",\n', "", "mode-change-stops"),
}


def mistaken(what: str) -> tuple[str, str]:
    old, new, falls = MISTAKES[what]
    assert old in TEXT, old
    text = TEXT.replace(old, new, 1)
    if what == "the mode is one scan old":
        text = text.replace('    "edm",\n]', '    "edm", "fplc",\n]', 1)
    return text, falls


def plain(text: str, runs: int) -> Machine:
    """A machine that is only run with plain values: its triggers, which come from terms, are left out."""
    machine = Machine(text, "my.toml", FOLDER / "safety.toml", FOLDER / "use.toml", runs=runs)
    machine.triggers = [[] for _ in machine.questions.rows]
    return machine


@pytest.mark.parametrize(
    "what", [pytest.param(what, marks=[pytest.mark.deep] if at else []) for at, what in enumerate(MISTAKES)]
)
def test_a_mistake_of_wiring_breaks_its_property(what: str) -> None:
    text, falls = mistaken(what)
    machine = plain(text, 400)
    broken = machine.look(lambda seen: falls in seen.broken).broken
    assert falls in broken
    rule = next(rule for rule in machine.rules if rule.id == falls)
    scans = machine.runner.shortened(broken[falls], rule, 100)
    assert machine.runner.broken(scans, rule) == len(scans)
    shipped = plain(TEXT, 1)
    own = next(rule for rule in shipped.rules if rule.id == falls)  # what its signals are is wiring too
    assert shipped.runner.broken(scans, own) is None


def test_runs_break_nothing_of_the_shipped_wiring() -> None:
    assert not plain(TEXT, 6).look().broken


@pytest.mark.long  # as `make verify` does
def test_every_property_of_the_shipped_wiring_is_proved(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["machine", "--json", str(tmp_path / "verdicts.json")]) == 0
    found = json.loads((tmp_path / "verdicts.json").read_text("utf-8"))
    assert [row["id"] for row in found["verdicts"]] == [row["id"] for row in SAFETY["property"]]
    for row in found["verdicts"]:
        assert row["verdict"] == "PROVED"
        assert row["hazard"]
        assert row["reached_in_scans"]
        assert None not in row["reached_in_scans"]
    assert f"{len(SAFETY['property'])} PROVED, 0 REFUTED, 0 UNKNOWN" in capsys.readouterr().out


def unlocking(tmp_path: Path) -> Path:
    """The file of properties with one that needs few of the blocks."""
    path = tmp_path / "one.toml"
    path.write_text(
        """[[property]]
id = "at-rest"
sentence = "The bolt is withdrawn only while the button is held."
hazard = "As in safety.toml."
cites = ["GL-IN-SAFETYACTIVE"]
holds = "S_UnlockGuard"
only_if = "UnlockButton"
""",
        "utf-8",
    )
    return path


@pytest.mark.deep
def test_a_wrong_wire_is_named_with_the_scans(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mine = tmp_path / "my.toml"
    mine.write_text(TEXT.replace('UnlockRequest = "UnlockButton"', 'UnlockRequest = "ResetGuard"'), "utf-8")
    assert main(["machine", str(mine), "--properties", str(unlocking(tmp_path))]) == 1
    said = capsys.readouterr().out
    assert "REFUTED: at-rest" in said
    assert "wrong scan" in said
    assert "block.guard.inputs.UnlockRequest; with 'UnlockButton'" in said


@pytest.mark.deep
def test_a_wrong_invariant_is_refused_by_both_solvers(tmp_path: Path) -> None:
    machine = Machine(TEXT, "my.toml", unlocking(tmp_path), FOLDER / "use.toml", runs=40)
    lemmas = machine.lemmas(60)
    assert not machine.again(lemmas, machine.asked)
    assert all(machine.shown(lemmas, machine.asked).values())
    control = machine.system.state["GUARD.control"]
    wrong = [*lemmas, control == 0]
    assert machine.again(wrong, machine.asked) == "z3 on scan.smt2: sat"
    assert not any(machine.shown(wrong, machine.asked).values())
    scan = machine.questions_again(wrong, machine.asked)[1]
    assert [solver(scan) for solver in SOLVERS.values()] == ["sat", "sat"]


@pytest.mark.long
def test_what_has_no_invariant_is_unknown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = unlocking(tmp_path)
    text = path.read_text("utf-8").replace('"S_UnlockGuard"', '"running.Q1"')
    path.write_text(text.replace('"UnlockButton"', '"S_DriveEnable OR edm.Error"'), "utf-8")
    assert main(["machine", "--properties", str(path), "--seconds", "0"]) == 2
    assert "UNKNOWN: at-rest" in capsys.readouterr().out


def test_a_property_of_an_unknown_signal_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = unlocking(tmp_path)
    path.write_text(path.read_text("utf-8").replace("S_UnlockGuard", "S_Unlock"), "utf-8")
    assert main(["machine", "--properties", str(path)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "S_Unlock" in said


@pytest.mark.deep
def test_each_edit_of_the_wiring_changes_the_file_once() -> None:
    found = list(edits(TEXT, wiring_of(TEXT, "wiring.toml")))
    assert len({edit.after for edit in found} - {TEXT}) == len(found) > 300
    whole = tomllib.loads(TEXT)
    assert all(tomllib.loads(edit.after) != whole for edit in found)


def mistakes() -> list[tuple[str, str]]:
    """The edits in the table of the page, and the property that falls with each."""
    page = (ROOT / "docs/wire-your-machine.md").read_text("utf-8")
    return re.findall(r"^\| `(.*?)` \| .* \| `(.*?)` \| \d+ \|$", page, re.MULTILINE)


def test_the_page_tells_of_edits_of_the_wiring() -> None:
    known = {edit.id for edit in edits(TEXT, wiring_of(TEXT, "wiring.toml"))}
    page = (ROOT / "docs/wire-your-machine.md").read_text("utf-8")
    assert f"Of {len(known)} edits" in page
    assert len(mistakes()) > 12
    assert {id for id, _ in mistakes()} <= known


@pytest.mark.parametrize(
    ("id", "falls"),
    [pytest.param(*row, marks=[pytest.mark.deep] if at else []) for at, row in enumerate(mistakes()[1::4])],
)
def test_a_mistake_of_the_page_happens_again(id: str, falls: str) -> None:
    edit = next(edit for edit in edits(TEXT, wiring_of(TEXT, "wiring.toml")) if edit.id == id)
    broken = plain(edit.after, 400).look(lambda seen: falls in seen.broken).broken
    assert falls in broken


def test_every_property_has_hazard_and_clauses_that_exist() -> None:
    clauses = "".join(path.read_text("utf-8") for path in ROOT.glob("spec/*/*.toml") if path.parent != FOLDER)
    for row in SAFETY["property"]:
        assert row["hazard"]
        assert all(f'"{cite}"' in clauses or f".{cite}]" in clauses for cite in row["cites"]), row["id"]


def test_a_property_without_a_hazard_is_refused(tmp_path: Path) -> None:
    path = unlocking(tmp_path)
    path.write_text(path.read_text("utf-8").replace('hazard = "As in safety.toml."\n', ""), "utf-8")
    machine = Machine(TEXT, "my.toml", path, FOLDER / "use.toml")
    with pytest.raises(Unjudged, match="at-rest: hazard is missing"):
        assert machine.questions


def test_the_page_has_picture_and_matrix_of_the_wiring() -> None:
    page = (ROOT / "docs/wire-your-machine.md").read_text("utf-8")
    wiring = wiring_of(TEXT, "wiring.toml")
    assert machine_picture.picture(wiring) in page
    assert machine_picture.matrix(wiring) in page


@pytest.mark.deep
def test_a_forgotten_door_is_found_in_the_fewest_scans() -> None:
    text = TEXT.replace('automatic = [["guard", "beam"]]', 'automatic = [["enable"]]')
    assert text != TEXT
    machine = Machine(text, "my.toml", FOLDER / "safety.toml", FOLDER / "use.toml")
    machine.search.look(["automatic-closed"], 60)
    scans = machine.search.scans("automatic-closed")
    assert scans is not None
    assert (len(scans), machine.search.clean("automatic-closed")) == (17, 16)
    rule = next(rule for rule in machine.rules if rule.id == "automatic-closed")
    calm = machine.runner.calmed(scans, rule, 400)
    assert machine.runner.broken(calm, rule) == 17

    def changes(of: list[Scan]) -> int:
        return sum(of[n][1][name] != of[n - 1][1][name] for n in range(1, 17) for name in of[0][1])

    assert changes(calm) < changes(scans)


@pytest.mark.deep
@pytest.mark.long
def test_a_press_is_judged_whole(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", str(ROOT / "examples/machines/press.toml"), "--quiet"]) == 0
    said = capsys.readouterr().out
    assert "  verdicts    42 PROVED, 0 REFUTED, 0 UNKNOWN" in said
    for id in ("reset-then-start", "mode-change-stops", "reset-never-starts", "mode-needs-key"):
        assert f"PROVED: {id}: " in said
    assert said.count("  not asked   ") == 3
