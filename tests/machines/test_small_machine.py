"""A machine of one latch, judged from its file to evidence and exit status: each verdict, and why."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from machines.evidence import machine_of
from machines.killers import Killers, read_killers
from machines.machine_command import lines_of, status
from machines.trial import Trial, edits
from machines.trial_record import basis_of, outcomes_path
from machines.verdicts import Machine
from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.lane.machine_command import judge_machine
from modeproof.lane.summary import machine_line
from modeproof.report.verdicts import status_of

WIRING = """title = "a drive behind a door"
cycle_ms = 10
scan_ms = [5, 50]
order = ["running"]
[inputs]
Key = { type = "BOOL", from = "desk", why = "chooses the only mode" }
Door = { type = "BOOL", from = "door", why = "it is closed" }
Start = { type = "BOOL", from = "desk", why = "starts" }
Stop = { type = "BOOL", from = "desk", why = "stops" }
[modes]
hand = { is = "Key", why = "by hand" }
[safeguards]
door = { is = "Door", why = "closed" }
[matrix]
hand = [["door"]]
[block.running]
of = "RS"
why = "from start to stop"
inputs.S = "Start"
inputs.R1 = "Stop OR NOT safeguards_hold"
[outputs]
S_Drive = { is = "running.Q1", to = "drive", why = "it may move" }
"""
SAFETY = """[observer]
pressed = { of = "R_TRIG", inputs.CLK = "Start" }
moves = { of = "R_TRIG", inputs.CLK = "S_Drive" }
"""
USE = """[[story]]
id = "start"
first = true
row = [{ Key = true, Door = true }, { Start = true }, { Start = false, scans = 3 }]
"""
CLOSED = ("closed", 'holds = "S_Drive"\nonly_if = "Door AND Key"')
KILLERS = """[[killer.closed]]
in = "block.running.inputs.R1"
new = "Stop"
scans = ["10: Start=1"]
"""


def asked(*rows: tuple[str, str]) -> str:
    said = 'sentence = "It is so."\nhazard = "planted"\ncites = ["A-02"]\n'
    return SAFETY + "".join(f'[[property]]\nid = "{id}"\n{said}{text}\n' for id, text in rows)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of the machine in a tree of its own."""
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    found = tmp_path / "spec/latch"
    found.mkdir(parents=True)
    for name, text in {"wiring": WIRING, "safety": asked(CLOSED), "use": USE, "killers": KILLERS}.items():
        (found / f"{name}.toml").write_text(text, "utf-8")
    return found


def words(folder: Path, *rows: tuple[str, str], wiring: str = WIRING) -> dict[str, tuple[str, str]]:
    """For each property the verdict and how it came."""
    path = folder / "own.toml"
    path.write_text(asked(*rows), "utf-8")
    machine = Machine(wiring, "my.toml", path, folder / "use.toml", leave_out=True, runs=20)
    found = machine.all(20, recheck=True)
    assert status(found) == (1 if "REFUTED" in {one.word for one in found} else 2 if len(found) > 1 else 0)
    return {verdict.asked.id: (verdict.word, verdict.how) for verdict in found}


def test_each_verdict_comes_with_its_reason(folder: Path) -> None:
    found = words(
        folder,
        CLOSED,
        ("wrong", 'never = "S_Drive AND NOT Start"'),
        ("idle", 'holds = "S_Drive AND NOT Door"\nonly_if = "Stop"'),
        ("absent", 'never = "S_Drive AND Beam"'),
        ("nothing", 'holds = "S_Drive"\nonly_if = "TRUE"'),
    )
    assert [found[id][0] for id in ("closed", "wrong", "idle", "absent", "nothing")] == [
        "PROVED",
        "REFUTED",
        "EMPTY",
        "NOT JUDGED",
        "EMPTY",
    ]
    assert "judged again by z3 and cvc5" in found["closed"][1]
    assert found["idle"][1] == "`S_Drive AND NOT Door` can never be true, so it says nothing"
    assert found["wrong"][1] == "2 scans: no fewer do, whatever inputs and scan times"
    assert found["absent"][1] == "the wiring has no 'Beam'"


ALLOWED = "a property of a machine has TRUE, FALSE, names, AND, OR and NOT, and no"
NO_PROPERTY = {
    "S_Drive = TRUE": f"{ALLOWED} =",
    "S_Drive XOR Start": f"{ALLOWED} XOR",
    "SEL(Start, Stop, Door)": f"{ALLOWED} SEL(...)",
    "S_Drive AND T#5ms": f"{ALLOWED} 5",
    "running.S AND Stop": "running has no output 'S'; allowed: Q1",
    "runing.Q1 AND Stop": "runing is not declared; did you mean 'running'",
    "running AND Stop": "running is a block; name one of its outputs",
    "S_Drive AND Gate": "Gate is not declared",
    "Code AND Stop": "Code is a WORD, and a BOOL is needed",
}
CODE = '[inputs]\nCode = { type = "WORD", from = "desk", why = "a number" }'


@pytest.mark.parametrize("text", NO_PROPERTY)
def test_what_no_property_has_is_refused_before_any_work(
    text: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine, path = folder / "wiring.toml", folder / "own.toml"
    mine.write_text(WIRING.replace("[inputs]", CODE), "utf-8")
    path.write_text(asked(("own", f'never = "{text}"')), "utf-8")
    assert main(["machine", str(mine), "--properties", str(path), "--use", str(folder / "use.toml")]) == 2
    said = capsys.readouterr()
    assert (said.out, said.err.count("\n")) == ("", 1)
    assert f"{path}:5: own: never: {text!r}: " in said.err
    assert NO_PROPERTY[text] in said.err


@pytest.mark.parametrize(
    "text", ["s_drive & not start", "S_Drive AND (* or *) NOT Start", "(S_Drive\nAND NOT Start)"]
)
def test_another_spelling_of_a_property_means_the_same(text: str, folder: Path) -> None:
    path = folder / "own.toml"
    path.write_text(asked(("own", f'never = """{text}"""')), "utf-8")
    machine = Machine(WIRING, "my.toml", path, folder / "use.toml", runs=20)
    (found,) = machine.all(20)
    assert found.word == "REFUTED"
    assert [part for part, _ in found.asked.trigger] == ["S_Drive", "NOT Start"]


OBSERVERS = {
    'late = { of = "TON", inputs.IN = "Start" }': "late: R_TRIG, F_TRIG, SR or RS with all its inputs",
    'AND = { of = "R_TRIG", inputs.CLK = "Start" }': "AND: a name begins with a letter",
    'is = { of = "R_TRIG", inputs.CLK = "Start" }': "is: is is a keyword of Python",
    'late = { of = "R_TRIG", inputs.CLK = "Start = TRUE" }': f"late: 'Start = TRUE': {ALLOWED} =",
    "late = 3": "late: must be a table, not 3",
}


@pytest.mark.parametrize("row", OBSERVERS)
def test_what_no_observer_is_is_refused_in_its_line(row: str, folder: Path) -> None:
    path = folder / "own.toml"
    path.write_text(asked(CLOSED).replace("[observer]", f"[observer]\n{row}"), "utf-8")
    with pytest.raises(Unjudged) as caught:
        Machine(WIRING, "my.toml", path, folder / "use.toml", runs=1).all(1)
    assert caught.value.message.startswith(f"{path}:2: observer.{OBSERVERS[row]}")


def test_an_observer_in_another_case_sees_the_same(folder: Path) -> None:
    path = folder / "own.toml"
    text = asked(("own", 'never = "Pressed.q AND s_drive"')).replace('"R_TRIG"', '"r_trig"', 1)
    path.write_text(text.replace('CLK = "Start"', 'CLK = "start"'), "utf-8")
    (found,) = Machine(WIRING, "my.toml", path, folder / "use.toml", runs=20).all(20)
    assert found.word == "REFUTED"


def test_properties_as_the_wiring_spells_them_stay_as_they_are() -> None:
    shipped = Path(__file__).parents[2] / "spec/machine_cell"
    text = (shipped / "wiring.toml").read_text("utf-8")
    found = Machine(text, "w.toml", shipped / "safety.toml", shipped / "use.toml")
    assert found.questions.rows == found.every.rows
    assert found.watched.rows == found.observers.rows


def lacking_a_beam(folder: Path) -> Machine:
    """The machine with a property and an observer of a beam that it has not."""
    path = folder / "safety.toml"
    text = asked(CLOSED, ("dark", 'never = "S_Drive AND beam_edge.Q"'))
    path.write_text(f'{text}[observer.beam_edge]\nof = "R_TRIG"\ninputs.CLK = "S_BeamFree"\n', "utf-8")
    return Machine(WIRING, "my.toml", path, folder / "use.toml", leave_out=True, runs=20)


def test_edits_are_tried_without_what_the_wiring_lacks(folder: Path) -> None:
    machine = lacking_a_beam(folder)
    [edit] = [one for one in edits(WIRING, machine.wiring) if one.id == "block.running.inputs.R1 = Stop"]
    outcome = Trial(machine).run(edit)
    assert outcome is not None
    assert (outcome.word, outcome.by) == ("KILLED", ["closed"])


def test_killers_are_played_without_what_the_wiring_lacks(folder: Path) -> None:
    machine = lacking_a_beam(folder)
    assert machine.lacking.keys() == {"dark"}
    assert Killers(machine).problems(read_killers(folder / "killers.toml")) == {}


@pytest.mark.deep
def test_one_property_that_is_proved_is_a_pass(folder: Path) -> None:
    assert words(folder, CLOSED)["closed"][0] == "PROVED"


@pytest.mark.deep
def test_a_wire_left_out_is_refuted(folder: Path) -> None:
    wiring = WIRING.replace("Stop OR NOT safeguards_hold", "Stop")
    assert words(folder, CLOSED, wiring=wiring)["closed"][0] == "REFUTED"


def test_evidence_of_it_is_as_expected(folder: Path) -> None:
    record = judge_machine(folder.parents[1], "latch")
    assert (record["verdict"], record["reason"]) == ("PROVED", "")
    assert record["inputs"].keys() >= {f"spec/latch/{name}.toml" for name in ("wiring", "safety", "use")}
    assert machine_line(record).endswith(
        "1 of 1 are broken by an edit; no run of TLC; latch is our own design, no document"
    )


def outcome(folder: Path, basis: dict[str, str]) -> None:
    """Keep the outcome of one edit where the trial keeps it."""
    path = outcomes_path(folder.parents[1], "latch")
    path.parent.mkdir(parents=True)
    row = {"kind": "part left out", "row": "block.running.inputs.R1", "text": "Stop"}
    told = {**row, "verdict": "KILLED", "by": ["closed"], "scans": 2}
    path.write_text(json.dumps({"basis": basis, "edits": [told]}), "utf-8")


@pytest.mark.parametrize("present", [True, False])
def test_a_trial_counts_for_the_text_it_was_made_of(present: bool, folder: Path) -> None:
    basis = basis_of(machine_of(folder))
    outcome(folder, basis if present else {**basis, "wiring": "another"})
    trial = judge_machine(folder.parents[1], "latch")["result"]["trial"]
    assert (trial["judged"], trial["falls"]) == (int(present), {"closed": int(present)})


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("file", "old", "new", "verdict"),
    [
        ("wiring", "Stop OR NOT safeguards_hold", "Stop", "REFUTED"),
        ("wiring", '"Stop OR NOT', '"Halt OR NOT', "UNJUDGED"),
        ("safety", "Door AND Key", "Door AND Key OR TRUE", "UNJUDGED"),
        ("safety", 'holds = "S_Drive"', 'holds = "S_Drive AND NOT Door"', "UNJUDGED"),
        ("safety", "Door AND Key", "Gate AND Key", "UNJUDGED"),
        ("killers", "closed", "shut", "SURVIVED"),
    ],
)
def test_a_planted_fault_turns_the_lane_red(
    folder: Path, file: str, old: str, new: str, verdict: str
) -> None:
    path = folder / f"{file}.toml"
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    record = judge_machine(folder.parents[1], "latch")
    assert (record["verdict"], record["as_expected"]) == (verdict, False)
    assert status_of(record) == (1 if verdict in ("REFUTED", "SURVIVED") else 2)
    assert record["reason"]


@pytest.mark.parametrize("recorded", [pytest.param(False, marks=pytest.mark.deep), True])
def test_an_edit_with_which_a_property_falls_is_found(
    recorded: bool, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("machines.machine_command.FOLDER", Path("spec/latch"))
    path = folder / "killers.toml"
    path.write_text("", "utf-8")
    if recorded:
        outcome(folder, basis_of(machine_of(folder)))
    assert main(["machine", "--killers", "--quiet"]) == 0
    assert "1 of 1 properties are broken by an edit" in capsys.readouterr().out
    assert ('new = "Stop"' in path.read_text("utf-8")) or not recorded
    assert "[[killer.closed]]" in path.read_text("utf-8")


def test_a_property_that_nothing_breaks_is_named(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("machines.machine_command.FOLDER", Path("spec/latch"))
    (folder / "safety.toml").write_text(asked(("said", 'always = "Key OR NOT Key"')), "utf-8")
    assert main(["machine", "--killers", "--quiet"]) == 1
    said = capsys.readouterr().out
    assert "said: no edit of the wiring is known that breaks it" in said
    assert "0 of 1 properties are broken by an edit" in said


MOTOR = WIRING + 'S_Motor = { is = "Start OR running.Q1", to = "drive", why = "a second one" }\n'
STOP = WIRING.replace("[modes]", 'S_EStop = { type = "BOOL", from = "desk", why = "pressed" }\n[modes]', 1)
UNREAD = STOP.replace(
    "[modes]", '[signals]\nidle = { is = "NOT S_EStop", why = "nobody has it" }\n[modes]', 1
)


def left_out(folder: Path, wiring: str, said: str = "") -> list[tuple[str, str]]:
    path = folder / "own.toml"
    path.write_text(f"[unasked]\n{said}\n{asked(CLOSED)}", "utf-8")
    found = Machine(wiring, "my.toml", path, folder / "use.toml", runs=20).all(20)
    assert status(found) == (2 if len(found) > 1 else 0)
    return [(one.word, one.asked.id) for one in found[1:]]


@pytest.mark.parametrize(
    ("wiring", "name"),
    [(MOTOR, "output S_Motor"), (STOP, "input S_EStop"), (UNREAD, "input S_EStop")],
)
def test_what_no_question_reaches_is_no_pass(folder: Path, wiring: str, name: str) -> None:
    assert left_out(folder, wiring) == [("NOT ASKED", name)]
    assert left_out(folder, wiring, f'{name.split()[1]} = "a lamp for the desk"') == []


@pytest.mark.parametrize(
    ("row", "lost"),
    [
        ('holds = "Running.q1"\nonly_if = "Door AND Key"', []),
        ('never = "Key AND NOT Key OR moves.Q AND NOT Door"', []),
        ('holds = "pressed.Q"\nonly_if = "Start"', ["output S_Drive"]),
    ],
)
def test_an_output_is_asked_about_by_pin_or_observer(folder: Path, row: str, lost: list[str]) -> None:
    path = folder / "own.toml"
    path.write_text(asked(("one", row)), "utf-8")
    found = Machine(WIRING, "my.toml", path, folder / "use.toml", runs=20).all(20)
    assert [one.asked.id for one in found if one.word == "NOT ASKED"] == lost


@pytest.mark.parametrize(
    ("said", "words"),
    [('S_Drive = ""', "unasked.S_Drive: say why"), ('S_Drve = "x"', "no such name; did you mean 'S_Drive'")],
)
def test_an_excuse_names_something_and_says_why(folder: Path, said: str, words: str) -> None:
    with pytest.raises(Unjudged, match=words):
        left_out(folder, WIRING, said)


ROLES = """[roles]
modes = ["hand", "foot"]
[roles.devices]
beam = { of = "SF_TestableSafetySensor", names = ["S_BeamFree"] }
gate = { of = "SF_GuardLocking", names = ["S_Closed"] }
"""
HELD = ("held", 'holds = "S_Drive AND foot"\nonly_if = "Door"')
ROWS = (
    CLOSED,
    HELD,
    ("dark", 'never = "S_Drive AND NOT S_BeamFree"'),
    ("either", 'holds = "S_Drive AND (hand OR foot) OR beam.Error"\nonly_if = "Door"'),
)
GATE = """[block.%s]
of = "SF_GuardLocking"
why = "a door"
inputs = { Activate = "TRUE", S_GuardMonitoring = "Door", S_SafetyActive = "TRUE", S_GuardLock = "Door", \
UnlockRequest = "Stop", S_StartReset = "FALSE", S_AutoReset = "FALSE", Reset = "Key" }
[outputs]"""


def with_gate(name: str) -> str:
    return WIRING.replace("[outputs]", GATE.replace("\\\n", "") % name, 1).replace(
        '["running"]', f'["running", "{name}"]'
    )


def playing(folder: Path, wiring: str, *rows: tuple[str, str]) -> Machine:
    path = folder / "own.toml"
    path.write_text(f"{ROLES}\n{asked(*(rows or ROWS))}", "utf-8")
    return Machine(wiring, "my.toml", path, folder / "use.toml", leave_out=True, runs=20)


def test_what_a_machine_has_not_is_no_failure(folder: Path) -> None:
    machine = playing(folder, WIRING)
    assert machine.not_asked == {"held": "no mode foot", "dark": "no SF_TestableSafetySensor"}
    found = machine.all(20)
    assert [(one.asked.id, one.word) for one in found] == [("closed", "PROVED"), ("either", "PROVED")]
    assert status(found) == 0
    said = [line for line in lines_of(machine, found, 0.0) if line.startswith("  not asked")]
    assert said == ["  not asked   held: no mode foot", "  not asked   dark: no SF_TestableSafetySensor"]


def test_a_role_is_played_under_another_name(folder: Path) -> None:
    wiring = WIRING.replace("hand", "inching") + '[roles]\nhand = "inching"\n'
    machine = playing(folder, wiring)
    assert machine.questions.rows[1]["holds"] == "(S_Drive AND (inching OR FALSE) OR FALSE)" or (
        machine.questions.rows[1]["holds"] == "S_Drive AND (inching OR FALSE) OR FALSE"
    )
    assert (machine.lacking, {*machine.not_asked}) == ({}, {"held", "dark"})


def test_a_mode_that_plays_no_role_leaves_questions_unjudged(folder: Path) -> None:
    machine = playing(folder, WIRING.replace("hand", "inching"))
    assert machine.lacking == {"held": "foot", "either": "hand"}


@pytest.mark.parametrize("name", ["gate", "door2"])
def test_a_device_that_no_question_names_is_no_pass(name: str, tmp_path: Path) -> None:
    """A wiring that has the device under another name is asked for it, and one of two is not forgotten."""
    machine = playing(tmp_path, with_gate(name), CLOSED, ("open", 'never = "gate.Error AND NOT S_Closed"'))
    assert machine.lacking == {"open": "S_Closed" if name == "gate" else "gate.Error"}
    assert [one.asked.id for one in machine.left_out()] == [f"block {name}"]


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ('hnd = "hand"', "no role 'hnd'; did you mean 'hand'"),
        ('foot = "hnd"', "nothing is 'hnd'; did you mean 'hand'"),
        ('foot = "Key"', "'Key' is no mode"),
        ('gate = "hand"', "'hand' is a mode"),
    ],
)
def test_a_role_that_nobody_can_play_is_refused(row: str, said: str, folder: Path) -> None:
    machine = playing(folder, f"{WIRING}[roles]\n{row}\n")
    with pytest.raises(Unjudged) as caught:
        assert machine.cast
    line = WIRING.count("\n") + 2
    assert f"my.toml:{line}: roles.{row.partition(' ')[0]}: {said}" in caught.value.message


def test_a_question_without_an_answer_in_time_is_said(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def late(*given: object) -> None:
        raise TimeoutError("a question had no answer: timeout")

    monkeypatch.setattr("machines.candidate_invariants.Candidates.thinned", late)
    held = ("held", 'after = "Stop"\nonly_once = "Start"\nholds = "S_Drive"')
    word, how = words(folder, CLOSED, held)["held"]
    why = "no invariant was found: a question had no answer: timeout"
    assert (word, how) == ("UNKNOWN", f"{why}; none in 100 scans, all inputs and scan times")
