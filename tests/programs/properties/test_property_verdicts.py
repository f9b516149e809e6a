"""Properties of a program that calls the documents' blocks: proved, refuted by scans, or neither."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest
import z3

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.commands.prove_properties import judged, status, text_of
from programs.invariants import induction
from programs.language.tree import Source
from programs.properties import property_verdicts as property
from programs.properties.property_file import read_questions
from programs.properties.property_verdicts import Found, Judgement
from programs.properties.transition_system import Cell, Judge
from programs.readers.structured_text.units import read_text

ROOT = Path(__file__).parents[3]
CELL, PROPERTIES = ROOT / "examples/st/cell.st", ROOT / "examples/st/cell.toml"
MODE = """(* 1. The mode. None is valid while the switch moves. *)
automatic := S_KeyAutomatic AND NOT S_KeySetup;
setup := S_KeySetup AND NOT S_KeyAutomatic;
settledAutomatic(IN := automatic, PT := T#100ms, Q => S_AutomaticMode);
settledSetup(IN := setup, PT := T#100ms, Q => S_SetupMode);
"""
SLOW = "S_SlowSpeed := S_DriveEnable AND S_SetupMode;\n"
EDM = """edm(Activate := TRUE, S_OutControl := running.Q1, S_EDM1 := S_Contactor1, S_EDM2 := S_Contactor2,
    S_StartReset := FALSE, Reset := Reset, MonitoringTime := T#200ms);
"""
START = "startEdge(CLK := Start);\n"
FAULTS: dict[str, tuple[str, list[tuple[str, str]]]] = {
    "the mode is one scan old": ("drive-in-a-mode", [(MODE, ""), ("END_PROGRAM", MODE + "END_PROGRAM")]),
    "the contactors are called too early": (
        "drive-in-a-mode",
        [(EDM, ""), ("(* 4. What", EDM + "(* 4. What")],
    ),
    "the speed is one scan old": (
        "setup-is-slow",
        [(SLOW, ""), ("(* 2. The guard", SLOW + "(* 2. The guard")],
    ),
    "both modes at once": ("one-mode", [(" AND NOT S_KeySetup", ""), (" AND NOT S_KeyAutomatic", "")]),
    "the guard without its lock": ("drive-guarded", [("AND guard.S_GuardLocked", "AND S_GuardClosed")]),
    "a channel for the enable switch": ("drive-held", [("enable.S_EnableSwitchOut", "S_Channel1")]),
    "the demand for the output": ("drive-rear", [("barrier.S_OSSD_Out", "NOT barrier.SafetyDemand")]),
    "a reset that starts": ("restart-behind", [(START, "startEdge(CLK := Start OR Reset);\n")]),
    "a start that is held": ("restart-behind", [("S := startEdge.Q AND", "S := (Start OR Reset) AND")]),
    "the way around the guard": ("drive-guarded", [("S_OutControl := running.Q1", "S_OutControl := Start")]),
    "a time that is too long": ("contactors-watched", [("T#200ms", "T#2s")]),
    "an unlock request for standstill": (
        "no-unlock-in-motion",
        [("S_UnlockGuard := guard.S_UnlockGuard", "S_UnlockGuard := UnlockRequest")],
    ),
}  # fmt: skip


def silent(text: str) -> None:
    """Nothing is told."""


def changed(folder: Path, edits: list[tuple[str, str]]) -> Path:
    """The cell with these edits."""
    text = CELL.read_text("utf-8")
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path = folder / "cell.st"
    path.write_text(text, "utf-8")
    return path


def asked_alone(folder: Path, name: str) -> Path:
    """The file of properties with this one alone."""
    head, *rows = PROPERTIES.read_text("utf-8").split("[[property]]\n")
    (row,) = [row for row in rows if f'id = "{name}"' in row]
    path = folder / "cell.toml"
    path.write_text(f"{head}[[property]]\n{row}", "utf-8")
    return path


def of_cell(folder: Path, edits: list[tuple[str, str]], name: str) -> tuple[Cell, Found]:
    """The verdict on one property of the changed cell."""
    judgement, found = judged([changed(folder, edits)], asked_alone(folder, name), None, False, 60, silent)
    assert [verdict.word for verdict in found[:1]] == ["PROVED"]
    return judgement.cell, found[1]


def replayed(cell: Cell, found: Found) -> int:
    """The scans of a refuted property, after they broke it once more in the last scan and not before."""
    assert found.word == "REFUTED" and found.trace is not None
    machine, judge = cell.machine(found.trace.retained), Judge(found.asked)
    broken = []
    for dt_ms, inputs in found.trace.scans:
        machine.scan(cell.plain_inputs(inputs), dt_ms)
        broken.append(judge.broken(machine, dt_ms))
    assert broken.pop() and not any(broken)
    return len(found.trace.scans)


@pytest.mark.deep
def test_every_property_of_the_example_is_proved() -> None:
    judgement, found = judged([CELL], PROPERTIES, None, False, 60, silent)
    cell = judgement.cell
    assert {verdict.word for verdict in found} == {"PROVED"} and len(found) == 11
    assert min(max(len(way.scans) for way in one.reached) for one in found if one.asked.trigger) >= 2
    assert "SF_EDM" in {name.upper() for name in cell.blocks}


@pytest.mark.sampled(6)
@pytest.mark.parametrize("name", FAULTS)
def test_a_wiring_fault_is_refuted_by_scans(name: str, tmp_path: Path) -> None:
    id, edits = FAULTS[name]
    cell, found = of_cell(tmp_path, edits, id)
    assert 3 <= replayed(cell, found) <= 20


# ---------------------------------------------------------------- small programs


def verdict(
    body: str, row: str, declared: str = "", times: str = "[1, 10]", wrap: bool = False, seconds: float = 20
) -> list[Found]:
    """The verdicts on a program with the inputs a, b: BOOL, n: INT and the outputs q, r: BOOL, m: INT."""
    return small(body, row, declared, times, wrap, seconds).all()


def small(
    body: str, row: str, declared: str = "", times: str = "[1, 10]", wrap: bool = False, seconds: float = 20
) -> Judgement:
    """What judges that program."""
    text = (
        "PROGRAM P\nVAR_INPUT a, b : BOOL; n : INT; END_VAR VAR_OUTPUT q, r : BOOL; m : INT; END_VAR\n"
        f"{declared}\n{body}\nEND_PROGRAM\n"
    )
    source = Source({unit.name.upper(): unit for unit in read_text(text, "p.st")}, {"p.st": ""})
    questions = asked(f"scan_time_ms = {times}\n[[property]]\nid = 'x'\nsentence = 's'\n{row}\n")
    cell = Cell.of(source, source.main(), questions.scan_time, wrap)
    return Judgement(cell, questions.asked(cell), seconds, silent)


def asked(text: str) -> Any:
    """The properties of a text."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "p.toml")
        path.write_text(text, "utf-8")
        return read_questions(path)


def words(found: list[Found]) -> list[str]:
    """The verdicts in words."""
    return [one.word for one in found]


def test_an_output_that_comes_a_scan_late_is_refuted() -> None:
    late = verdict("q := r; r := a;", "holds = 'q'\nonly_if = 'a'")
    assert words(late) == ["PROVED", "REFUTED"] and len(late[1].trace.scans) == 2  # type: ignore[union-attr]
    assert words(verdict("r := a; q := r;", "holds = 'q'\nonly_if = 'a'")) == ["PROVED", "PROVED"]


def test_a_counter_is_proved_for_ever_by_induction() -> None:
    body = "IF a AND m < 5 THEN m := m + 1; END_IF"
    assert words(verdict(body, "always = 'm <= 5'")) == ["PROVED", "PROVED"]
    found = verdict(body, "always = 'm < 5'")[1]
    assert found.word == "REFUTED" and len(found.trace.scans) == 5  # type: ignore[union-attr]


def test_a_value_out_of_its_type_proves_nothing() -> None:
    found = verdict("m := m + 1; q := a;", "holds = 'q'\nonly_if = 'a'", seconds=2)
    assert found[0].word != "PROVED" and found[1].word == "UNKNOWN"
    found = verdict("m := n + 1; q := a;", "holds = 'q'\nonly_if = 'a'")
    assert words(found) == ["REFUTED", "UNKNOWN"] and "outside INT" in found[0].trace.stopped  # type: ignore[union-attr]
    assert words(verdict("m := n + 1; q := a;", "holds = 'q'\nonly_if = 'a'", wrap=True))[1] == "PROVED"


def test_a_bound_is_never_called_a_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(property, "induction", lambda *given: None)
    monkeypatch.setattr(property, "spacer", lambda *given: None)
    monkeypatch.setattr(property, "MOST_SCANS", 9)
    found = verdict("IF a AND m < 60 THEN m := m + 1; END_IF", "always = 'm < 60'")
    assert words(found)[1] == "HOLDS" and found[1].scans == 9 and status(found) == 2


def test_a_long_way_comes_from_a_random_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(property, "LENGTH", 80)
    found = verdict("IF a AND m < 60 THEN m := m + 1; END_IF", "always = 'm < 60'", seconds=1)[1]
    assert found.word == "REFUTED" and len(found.trace.scans) >= 60  # type: ignore[union-attr]


def test_a_property_that_can_never_speak_is_said() -> None:
    found = verdict("q := a AND NOT a;", "holds = 'q'\nonly_if = 'b'")
    assert words(found) == ["PROVED", "EMPTY"] and "can never be true" in found[1].how and status(found) == 2
    never = verdict("q := FALSE; r := a;", "never = 'q AND r'")
    assert words(never)[1] == "EMPTY" and "`q`" in never[1].how
    ever = verdict("IF b AND FALSE THEN q := TRUE; END_IF", "after = 'q'\nwithin_ms = 5\nholds = 'r'")
    assert words(ever)[1] == "EMPTY"


@pytest.mark.parametrize(
    "row",
    [
        "holds = 'q'\nonly_if = 'TRUE'",
        "never = 'q AND NOT q'",
        "always = 'q OR NOT q'",
        "after = 'a'\nwithin_ms = 5\nholds = 'q OR NOT q'",
    ],
)
def test_a_property_that_nothing_can_break_is_empty(row: str) -> None:
    found = verdict("q := a;", row)
    assert words(found) == ["PROVED", "EMPTY"] and "no values" in found[1].how and status(found) == 2


def test_a_property_that_this_program_cannot_break_is_proved() -> None:
    assert words(verdict("q := a; r := NOT a;", "never = 'q AND r'"))[1] == "PROVED"


@pytest.mark.parametrize(("limit", "word"), [(29, "REFUTED"), (30, "PROVED")])
def test_a_time_limit_is_exact(limit: int, word: str) -> None:
    declared = "VAR t : TON; END_VAR"
    body = "t(IN := a, PT := T#20ms); q := t.Q;"
    found = verdict(body, f"after = 'a'\nwithin_ms = {limit}\nholds = 'q OR NOT a'", declared, "[1, 11]")
    assert words(found)[1] == word


def test_a_start_without_its_cause_is_refuted() -> None:
    row = "after = 'NOT a'\nholds = 'q'\nonly_once = 'b'"
    latched = "q := a AND (b OR q);"
    assert words(verdict(latched, row))[1] == "PROVED"
    found = verdict("r := r OR b; q := a AND r;", row)[1]
    assert found.word == "REFUTED" and len(found.trace.scans) == 3  # type: ignore[union-attr]


@pytest.mark.parametrize("section", ["VAR RETAIN", "VAR {attribute 'TcRetain' := '1'}"])
def test_any_value_is_retained_at_power_up(section: str) -> None:
    found = verdict("q := kept;", "holds = 'q'\nonly_if = 'a'", f"{section} kept : BOOL; END_VAR")
    assert words(found)[1] == "REFUTED" and found[1].trace.retained == {"KEPT": True}  # type: ignore[union-attr]


def test_an_array_of_inputs_is_replayed() -> None:
    declared = "VAR_INPUT i : ARRAY [1..3] OF BOOL; END_VAR"
    assert words(verdict("q := i[2];", "never = 'i[1] AND q'", declared))[1] == "REFUTED"


# ---------------------------------------------------------------- the documents' blocks

GUARD = (
    "g(Activate := TRUE, S_GuardMonitoring := a, S_SafetyActive := TRUE, S_GuardLock := a, "
    "UnlockRequest := FALSE, S_StartReset := TRUE, S_AutoReset := TRUE, Reset := FALSE); "
)
SWITCH = (
    "e(Activate := TRUE, S_OutControl := a, S_EDM1 := b, S_EDM2 := b, S_StartReset := TRUE, Reset := FALSE,"
    " MonitoringTime := T#20ms); "
)


def test_a_block_measures_the_time_since_its_call() -> None:
    declared = "VAR e : SF_EDM; END_VAR"
    judge = small(f"IF n = 1 THEN {SWITCH} END_IF q := e.Error;", "never = 'q'", declared)
    machine = judge.cell.machine({})
    scans = [
        (10, 1, False, True),
        (10, 1, False, True),
        (10, 1, True, True),
        (15, 0, True, True),
        (5, 1, True, True),
    ]
    rows = [machine.scan({"a": a, "b": b, "n": n}, dt) for dt, n, a, b in scans]
    assert [row["q"] for row in rows] == [False, False, False, False, True]


@pytest.mark.parametrize("often", [1, 2])
def test_blocks_as_terms_agree_with_the_reference(often: int) -> None:
    from tests.programs.fuzz import difference_of_translator

    declared = "VAR e : SF_EDM; g : SF_GuardLocking; END_VAR"
    body = f"IF n > 0 THEN {SWITCH * often} END_IF {GUARD} q := e.S_EDM_Out; r := g.S_GuardLocked;"
    judge = small(body, "never = 'q'", declared)
    assert difference_of_translator(judge.cell.source, judge.cell.unit, 3, 120) == ""


def test_a_block_with_another_time_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    from programs.semantics import document_blocks as blocks
    from tests.programs.fuzz import difference_of_translator

    right = blocks.Block.terms

    def wrong(self: Any, path: str, env: dict[str, Any]) -> None:
        env[f"{path}.age"] = env[f"{path}.age"] + 1
        right(self, path, env)

    monkeypatch.setattr(blocks.Block, "terms", wrong)
    good = SWITCH.replace(":= b", ":= NOT e.S_EDM_Out")
    judge = small(f"{good} q := e.S_EDM_Out;", "never = 'q'", "VAR e : SF_EDM; END_VAR")
    assert "E.elapsed_ms" in difference_of_translator(judge.cell.source, judge.cell.unit, 3, 60)


def test_an_own_block_goes_before_the_document() -> None:
    text = (
        "FUNCTION_BLOCK SF_EDM VAR_INPUT x : BOOL; END_VAR VAR_OUTPUT y : BOOL; END_VAR y := x;\n"
        "END_FUNCTION_BLOCK\n"
        "PROGRAM P VAR_INPUT a : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR VAR e : SF_EDM; END_VAR\n"
        "e(x := a, y => q); END_PROGRAM"
    )
    source = Source({unit.name.upper(): unit for unit in read_text(text, "p.st")}, {})
    cell = Cell.of(source, source.units["P"])
    assert cell.blocks == {} and cell.machine({}).scan({"a": True}, 1) == {"q": True}


@pytest.mark.parametrize(
    ("declared", "body", "cause"),
    [
        ("VAR e : SF_EDM; t : TIME; END_VAR", "e(MonitoringTime := t);", "t: a constant is needed here"),
        ("VAR e : SF_EDM; END_VAR", "e(MonitoringTime := T#1s + T#1s);", "so it needs a constant"),
        ("VAR e : SF_EDM; END_VAR", "e(MonitoringTime := T#1s); e();", "other values in another call"),
        ("VAR e : SF_EDM; END_VAR", "e(MonitoringTime := T#1s); E();", "other values in another call"),
        ("VAR e : SF_EDM; END_VAR", "e.MonitoringTime := T#1s; e();", "is a parameter: give it in the call"),
        ("VAR e : SF_EDM; END_VAR", "e(MonitoringTime := T#2h);", "MonitoringTime_ms"),
        ("VAR e : SF_EDM; END_VAR", "e(S_EDM3 := a);", "has no S_EDM3; did you mean 'S_EDM2'"),
        ("VAR e : SF_EDN; END_VAR", "q := a;", "no type or block 'SF_EDN' is known"),
        ("VAR e : HMI; END_VAR", "q := a;", "no type or block 'HMI' is known"),
    ],
)  # fmt: skip
def test_a_block_that_is_called_wrongly_is_refused(declared: str, body: str, cause: str) -> None:
    with pytest.raises(Unjudged, match=cause) as caught:
        small(body, "never = 'q'", declared)
    assert caught.value.message.startswith("p.st:")


# ---------------------------------------------------------------- what would make a verdict worthless


def test_terms_that_are_wrong_refute_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    from programs.semantics import terms
    from programs.semantics import translator as symbolic

    right = terms.standard_call

    def wrong(block: str, path: str, env: dict[str, Any]) -> None:
        right(block, path, env)
        env[f"{path}.Q"] = z3.Not(env[f"{path}.Q"])

    monkeypatch.setattr(symbolic, "standard_call", wrong)
    found = verdict("t(CLK := a); q := t.Q;", "holds = 'q'\nonly_if = 'a'", "VAR t : R_TRIG; END_VAR")[1]
    assert found.word == "UNKNOWN" and "do not break it when they are run" in found.how


def test_a_wrong_invariant_proves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    judge = small("IF a AND m < 5 THEN m := m + 1; END_IF", "always = 'm < 5'")
    bad, m = judge.bad(judge.asked[0]), judge.system.state["M"]
    for lemma in (m < 3, m >= 1, m <= 4):
        assert not induction.holds_up(judge.system, bad, induction.Proof(1, [lemma], ""))
    good = judge.bad(small("", "always = 'm <= 5'").asked[0])
    assert induction.holds_up(judge.system, good, induction.Proof(1, [m <= 5], ""))
    monkeypatch.setattr(induction, "_interpretation", lambda *given: m <= 4)
    assert induction.spacer(judge.system, good, [], 10) is None


def test_what_a_block_takes_for_granted_is_owed() -> None:

    judge = small(f"{SWITCH} q := e.S_EDM_Out;", "holds = 'q'\nonly_if = 'a'", "VAR e : SF_EDM; END_VAR")
    bad, elapsed = judge.bad(judge.asked[0]), judge.system.state["E.elapsed_ms"]
    assert "E.elapsed_ms >= 0" in str(judge.system.within)
    (block,) = judge.cell.blocks.values()
    narrow = z3.And(block.reference.memory_ranges, block.reference.memory_terms["elapsed_ms"] <= 5)
    block.reference.__dict__["memory_ranges"] = narrow
    try:
        again = small(f"{SWITCH} q := e.S_EDM_Out;", "holds = 'q'\nonly_if = 'a'", "VAR e : SF_EDM; END_VAR")
        proof = induction.Proof(1, [elapsed >= 0], "")
        assert induction.holds_up(judge.system, bad, proof)
        assert not induction.holds_up(again.system, bad, proof)
    finally:
        del block.reference.__dict__["memory_ranges"]


def test_invariants_of_two_facts_are_found() -> None:
    body = "IF n = 1 THEN m := 1; q := a; ELSIF n = 2 THEN m := 2; q := FALSE; ELSE r := m = 2 AND q; END_IF"
    judge = small(body, "never = 'r'")
    assert any("Q" in str(lemma) and "M" in str(lemma) for lemma in judge.lemmas)
    assert induction.is_inductive(judge.system, judge.lemmas)


# ---------------------------------------------------------------- the file and the command


@pytest.mark.parametrize(
    ("row", "cause"),
    [
        ("never = 'qq'", "p.toml:3: qq is not declared; did you mean 'q'"),
        ("never = 'q AND'", "p.toml:3: 'q AND'"),
        ("never = 'q; r := TRUE'", "one expression is needed"),
        ("never = 'n + 1 > 5'", "a value here could leave its type"),
        ("never = 'm'", "a value of kind bool is needed here"),
        ("never = 'z'", "z is VAR_TEMP"),
        ("never = 'q'\nalways = 'r'", "a property is `never`, `always`"),
        ("nevr = 'q'", "unknown key 'nevr'; did you mean 'never'"),
        ("holds = 'q'", "a property is `never`, `always`"),
        ("after = 'q'\nholds = 'r'\nwithin_ms = -1", "within_ms is 0 or more"),
        ("after = 'q'\nholds = 'r'\nwithin_ms = '1'", "within_ms is a number"),
        ("never = 5", "never is a text"),
        ("never = 'q'\n[[property]]\nid = 'x'\nsentence = ''\nnever = 'q'", "two properties have the id 'x'"),
        ("never = 'q'\n[[property]]\nid = 'y'\nnever = 'q'", "say it in a sentence"),
        ("never = 'q'\n[[property]]\nnever = 'q'", "each [[property]] has an id"),
        ("never = 'q'\n[other]", "unknown key 'other'"),
    ],
)
def test_a_property_that_cannot_be_read_is_refused(row: str, cause: str) -> None:
    with pytest.raises(Unjudged) as caught:
        small("q := a;", row, "VAR_TEMP z : BOOL; END_VAR")
    assert cause in caught.value.message and "\n" not in caught.value.message


@pytest.mark.parametrize("times", ["5", "[5, 1]", "[-1, 1]", "[]", "[1, 2, 3]", "[1.5]", "'x'"])
def test_scan_times_that_cannot_be_are_refused(times: str) -> None:
    with pytest.raises(Unjudged, match="scan_time_ms"):
        small("q := a;", "never = 'q'", times=times)


def test_a_time_limit_needs_the_longest_scan() -> None:
    with pytest.raises(Unjudged, match="needs scan_time_ms"):
        small("q := a;", "after = 'a'\nwithin_ms = 5\nholds = 'q'", times="[1]")


def test_the_command_prints_and_writes_the_scans(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, properties, record = (tmp_path / name for name in ("p.st", "p.toml", "out.json"))
    head = "PROGRAM P VAR_INPUT a : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR VAR r : BOOL; END_VAR"
    program.write_text(f"{head}\nq := r; r := a; END_PROGRAM\n", "utf-8")
    properties.write_text(
        "[[property]]\nid = 'late'\nsentence = 'q is a.'\nholds = 'q'\nonly_if = 'a'\n", "utf-8"
    )
    asked = ["prove-program", str(program), "--property", str(properties)]
    assert main([*asked, "--json", str(record)]) == 1
    said = capsys.readouterr().out
    assert "REFUTED: late: q is a.\n" in said and "shortest    yes: nothing breaks it within 1 scans" in said
    assert "  scan 2      after 0 ms: a=0\n              gives q=1, [q]=1\n" in said
    written = json.loads(record.read_text("utf-8"))["verdicts"]
    assert [row["verdict"] for row in written] == ["PROVED", "REFUTED"] and len(
        written[1]["trace"]["scans"]
    ) == 2
    assert {"properties", "trusted", "not_shown"} <= set(json.loads(record.read_text("utf-8")))
    both = [*asked, "--target", "sf_edm"]
    for wrong in (both, asked[:2], [*asked, "--binding", "b.toml"], [*asked[:3], str(tmp_path / "no.toml")]):
        assert main(wrong) == 2
        assert capsys.readouterr().err.count("\n") == 1


def test_each_property_is_a_case_of_junit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, properties, junit = (tmp_path / name for name in ("p.st", "p.toml", "out.xml"))
    head = "PROGRAM P VAR_INPUT a : BOOL; END_VAR VAR_OUTPUT q : BOOL; END_VAR"
    program.write_text(f"{head}\nq := FALSE; END_PROGRAM\n", "utf-8")
    rows = [("off", "never = 'q'"), ("on", "always = 'q'"), ("empty", "holds = 'q'\nonly_if = 'a'")]
    properties.write_text(
        "".join(f"[[property]]\nid = '{name}'\nsentence = 'x<y'\n{text}\n" for name, text in rows), "utf-8"
    )
    assert main(["prove-program", str(program), "--property", str(properties), "--junit", str(junit)]) == 1
    suite = ElementTree.parse(junit).getroot()[0]
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("4", "1", "1")
    told = {case.get("name"): [part.tag for part in case if part.tag != "properties"] for case in suite}
    assert told == {"types": ["system-out"], "off": ["system-out"], "on": ["failure"], "empty": ["error"]}
    assert "scan 1" in (suite[2].findtext("failure") or "")


def test_the_text_names_blocks_and_scan_times() -> None:
    judge = small(f"{SWITCH} q := a;", "holds = 'q'\nonly_if = 'a'", "VAR e : SF_EDM; END_VAR")
    text = "\n".join(text_of(judge.cell, judge.all(), 1.0))
    assert "sf_edm (edm)" in text and "of 1 to 10 ms" in text and "PROVED: x: s" in text
