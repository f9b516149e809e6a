"""A machine as a program of one's own: its properties are proved of its source, mistakes in it are found."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from machines.equality import Equality
from machines.machine_command import lines_of, taken
from machines.user_program import ProgramMachine
from machines.verdicts import Machine
from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.kit.suite_judge import CONFORMS, DIFFERS, Plan, run_suite
from modeproof.kit.vectors import EXACT, open_suite
from programs.language.tool_differences import COUNT, EDGE
from programs.semantics.interpreter import Machine as Interpreter

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "spec/machine_cell"
WIRING = (FOLDER / "wiring.toml").read_text("utf-8")
BY_HAND = ROOT / "examples/st/machine_cell.st"
SOURCE = BY_HAND.read_text("utf-8")
MISTAKES = {
    "the mode is one scan old": ("newMode <> oldMode", "FALSE", "mode-change-stops"),
    "no start button": ("Start AND NOT oldStart AND couldStart", "couldStart", "reset-then-start"),
    "unlock before the pick-up": (" AND NOT S_DriveEnable;\nIF atRest", ";\nIF atRest", "unlock-at-rest"),
    "stop is forgotten": ("isReset AND allowed AND Stop", "isReset AND allowed", "stop-stops"),
    "one reset for door and desk": ("Reset := ResetGuard", "Reset := Reset", "door-error-stays"),
}


def machine(path: Path, runs: int) -> ProgramMachine:
    made = ProgramMachine(
        WIRING, "wiring.toml", FOLDER / "safety.toml", FOLDER / "use.toml", runs=runs, sources=[path]
    )
    made.triggers = [[] for _ in made.questions.rows]
    return made


def edited(tmp_path: Path, old: str, new: str) -> Path:
    assert old in SOURCE, old
    path = tmp_path / "mine.st"
    path.write_text(SOURCE.replace(old, new, 1), "utf-8")
    return path


class InTheInterpreter:
    """The program behind the interface of the kit."""

    def __init__(self, path: Path) -> None:
        self.machine = machine(path, 1)
        self.state: Interpreter = self.machine.runner.power_up()

    def hello(self, target: str) -> Mapping[str, Any]:
        return {"ok": True, "name": "by hand", "version": "", "relations": [EXACT]}

    def reset(self, params: Mapping[str, Any]) -> None:
        self.state = self.machine.runner.power_up()

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        given = {name: int(value, 16) if isinstance(value, str) else value for name, value in inputs.items()}
        _, values = self.machine.runner.scan(self.state, given, dt_ms)
        shown = {name: values[name] for name in self.machine.wiring.table.outputs}
        return {name: value if isinstance(value, bool) else f"{value:04X}" for name, value in shown.items()}

    def close(self) -> None:
        pass


@pytest.mark.deep
@pytest.mark.parametrize("name", ["mistakes", pytest.param("sequences", marks=pytest.mark.long)])
def test_the_program_by_hand_conforms_to_the_vectors(name: str) -> None:
    suite = open_suite(ROOT / f"vectors/machine_cell/{name}.jsonl.gz")
    assert run_suite(suite, lambda: InTheInterpreter(BY_HAND)).word == CONFORMS


@pytest.mark.deep
def test_a_mistake_in_the_program_differs(tmp_path: Path) -> None:
    path = edited(tmp_path, "guard.S_GuardLocked AND beam.S_OSSD_Out", "guard.S_GuardLocked")
    suite = open_suite(ROOT / "vectors/machine_cell/sequences.jsonl.gz")
    assert run_suite(suite, lambda: InTheInterpreter(path), plan=Plan(most=1, effort=0)).word == DIFFERS


@pytest.mark.deep
@pytest.mark.parametrize(
    "what",
    [pytest.param(what, marks=[pytest.mark.long] if at != 1 else []) for at, what in enumerate(MISTAKES)],
)
def test_a_mistake_in_the_program_breaks_its_property(what: str, tmp_path: Path) -> None:
    old, new, falls = MISTAKES[what]
    found = machine(edited(tmp_path, old, new), 60)
    broken = found.look(lambda seen: falls in seen.broken).broken
    assert falls in broken


REFUSALS = {
    "an input that is not there": ("LA, A, B", "LB, A, B", "no input LA"),
    "an instance of another name": ("edm : SF_EDM", "contactors : SF_EDM", "no instance edm of SF_EDM"),
    "an instance of another block": ("edm : SF_EDM", "edm : SF_EnableSwitch", "edm is no SF_EDM"),
    "a name that means a wire": ("runs : BOOL", "runs, automatic : BOOL", "automatic is a signal of"),
    "a return": ("oldMode := newMode;", "oldMode := newMode; IF Stop THEN RETURN; END_IF;", "RETURN"),
}


@pytest.mark.parametrize("what", REFUSALS)
def test_a_program_of_other_names_is_refused_in_its_line(what: str, tmp_path: Path) -> None:
    old, new, said = REFUSALS[what]
    with pytest.raises(Unjudged, match=said) as caught:
        assert machine(edited(tmp_path, old, new), 1).own
    assert "mine.st:" in str(caught.value)


def test_a_block_of_a_documents_name_is_refused(tmp_path: Path) -> None:
    fake = "FUNCTION_BLOCK SF_EDM VAR_OUTPUT Error : BOOL; END_VAR Error := FALSE; END_FUNCTION_BLOCK\n"
    path = tmp_path / "mine.st"
    path.write_text(fake + SOURCE, "utf-8")
    with pytest.raises(Unjudged, match=r"mine\.st:1: SF_EDM: .* means the document's block"):
        assert machine(path, 1).own


@pytest.mark.parametrize("pin", ["edm.Error", "fplc.ERROR"])
def test_a_program_that_overwrites_an_output_is_refused(pin: str, tmp_path: Path) -> None:
    path = edited(tmp_path, "oldMode := newMode;", f"oldMode := newMode; {pin} := FALSE;")
    with pytest.raises(Unjudged, match=r"mine\.st:\d+: \w+ is an output of a block and is written"):
        assert machine(path, 1).cell


@pytest.mark.parametrize(
    ("call", "name"),
    [("start_due(S1 := FALSE, R := TRUE);", "start_due"), ("desk_reset(CLK := FALSE);", "desk_reset")],
)
def test_a_program_cannot_call_an_observer(call: str, name: str, tmp_path: Path) -> None:
    path = edited(tmp_path, "oldMode := newMode;", f"oldMode := newMode; {call}")
    with pytest.raises(Unjudged, match=f"{name} is not declared"):
        assert machine(path, 1).cell


def asked_of(path: Path, tmp_path: Path) -> ProgramMachine:
    """The program with one property, and few runs."""
    properties = tmp_path / "one.toml"
    properties.write_text(
        """[[property]]
id = "unlock-held"
sentence = "The bolt is withdrawn only while the button is held."
hazard = "As in safety.toml."
cites = ["GL-IN-SAFETYACTIVE"]
holds = "S_UnlockGuard"
only_if = "UnlockButton"
""",
        "utf-8",
    )
    return ProgramMachine(WIRING, "w.toml", properties, FOLDER / "use.toml", runs=60, sources=[path])


@pytest.mark.deep
def test_a_property_is_proved_of_the_program_by_hand(tmp_path: Path) -> None:
    found = asked_of(BY_HAND, tmp_path)
    assert found.all(60)[0].word == "PROVED"


@pytest.mark.deep
@pytest.mark.long
def test_a_value_that_leaves_its_type_proves_nothing(tmp_path: Path) -> None:
    path = edited(tmp_path, "oldMode := newMode;", "oldMode := newMode; scans := scans + 1;")
    path.write_text(path.read_text("utf-8").replace("oldMode : INT;", "oldMode, scans : INT;"), "utf-8")
    verdict = asked_of(path, tmp_path).all(60)[0]
    assert verdict.word == "UNKNOWN"
    assert verdict.how.startswith("a value may leave its type")


def test_what_a_verdict_takes_as_given_is_said(tmp_path: Path) -> None:
    path = edited(tmp_path, "oldMode := newMode;", "oldMode := newMode; ups(CU := Stop);")
    path.write_text(path.read_text("utf-8").replace("oldMode : INT;", "oldMode : INT; ups : CTU;"), "utf-8")
    assert taken(machine(path, 1)) == [EDGE, COUNT] and taken(machine(BY_HAND, 1)) == [EDGE]
    assert f"  assumed     {EDGE}; {COUNT}" in lines_of(machine(path, 1), [], 0.0)


def beside(path: Path, runs: int) -> Equality:
    return Equality(WIRING, "w.toml", FOLDER / "safety.toml", FOLDER / "use.toml", runs=runs, sources=[path])


def test_every_output_is_asked_about_as_by_the_command() -> None:
    machine = beside(BY_HAND, 1)
    machine.leave_out = True  # as where no file of properties is given
    assert [row["id"] for row in machine.questions.rows] == [
        f"{name}-as-wired" for name in machine.wiring.table.outputs
    ]
    assert machine.watched.rows == {}


@pytest.mark.deep
def test_a_program_that_is_wired_otherwise_is_not_equal(tmp_path: Path) -> None:
    path = edited(tmp_path, "Lamp := edm.Error OR", "Lamp := ")
    broken = beside(path, 40).look(lambda seen: bool(seen.broken)).broken
    assert set(broken) == {"Lamp-as-wired"}


@pytest.mark.long
def test_runs_show_no_difference_of_the_program_by_hand() -> None:
    assert not beside(BY_HAND, 2).look().broken


@pytest.mark.long
def test_every_output_of_the_program_by_hand_is_as_wired(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["machine", "--source", str(BY_HAND), "--equal", "--recheck"]) == 0
    assert "7 PROVED, 0 REFUTED, 0 UNKNOWN" in capsys.readouterr().out


@pytest.mark.long
def test_every_property_is_proved_of_the_program_by_hand(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", "--source", str(BY_HAND), "--recheck"]) == 0
    said = capsys.readouterr().out
    count = len(tomllib.loads((FOLDER / "safety.toml").read_text("utf-8"))["property"])
    assert f"{count} PROVED, 0 REFUTED, 0 UNKNOWN" in said


PRESS = ROOT / "examples/machines/press.toml"


@pytest.mark.parametrize("path", [FOLDER / "wiring.toml", PRESS], ids=["cell", "press"])
def test_the_program_that_is_written_is_read(path: Path, tmp_path: Path) -> None:
    """And it does what the wiring says, scan by scan."""
    written = tmp_path / "written.st"
    assert main(["machine", str(path), "--program", str(written), "--quiet"]) == 0
    given = path.read_text("utf-8"), str(path), FOLDER / "safety.toml", FOLDER / "use.toml"
    program = ProgramMachine(*given, leave_out=True, runs=1, sources=[written])
    wired = Machine(*given, leave_out=True, runs=1)
    assert program.lacking == {}
    scans = [scan for scan, _, _ in wired.runner.runs(0)]
    outputs = [*wired.wiring.table.outputs, "guard.Error", "edm.Error"]
    for here, there in zip(wired.runner.replayed(scans), program.runner.replayed(scans), strict=True):
        assert {name: here[name] for name in outputs} == {name: there[name] for name in outputs}
