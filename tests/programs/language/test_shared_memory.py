"""Globals: one memory for all units, and whose it is when a program is judged."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.language import shared_memory
from programs.language.shared_memory import completed
from programs.language.subset import check
from programs.language.tree import Unit
from programs.readers.sources import read_sources
from programs.semantics.interpreter import Machine
from programs.semantics.terms import slots
from tests.programs.fuzz import difference_of_text, source_of

SHARED = """VAR_GLOBAL CONSTANT Most : INT := 7; END_VAR
VAR_GLOBAL
  Count : INT; Ready, Asked AT %IX0.0 : BOOL; Row : ARRAY [0..2] OF INT := [1, 2, 3];
  Delay : TON; Lamp AT %QX0.0 : BOOL; Flag AT %MX4.0 : BOOL;
END_VAR
""".replace("Ready, Asked AT", "Ready : BOOL; Asked AT")
UNITS = """FUNCTION Add : INT
VAR_INPUT Count : INT; END_VAR
Row[0] := (Row[0] + Count) MOD 100; Add := Row[0];
END_FUNCTION
FUNCTION Top : INT
VAR_INPUT x : INT; END_VAR
Top := MIN(x, Most) + Row[1];
END_FUNCTION
FUNCTION_BLOCK Counter
VAR_EXTERNAL Count : INT; END_VAR
VAR_INPUT up : BOOL; END_VAR
VAR_IN_OUT kept : INT; END_VAR
IF up AND Count < Most THEN Count := Count + 1; END_IF
kept := Count; Delay(IN := Count > 3, PT := T#20ms);
END_FUNCTION_BLOCK
PROGRAM Main
VAR_INPUT up : BOOL; by : INT; END_VAR
VAR one, two : Counter; old : INT; END_VAR
one(up := up AND Ready, kept := old);
IF Asked THEN two(up := TRUE, kept := Row[2]); END_IF
Add(Count := by MOD 100, Add => Count); Count := Top(Count) MOD 10;
Flag := Flag XOR Ready; Lamp := Delay.Q OR Flag;
IF by = 0 THEN RETURN; END_IF
Row[1] := Count;
END_PROGRAM
"""


def whole(text: str) -> Unit:
    """The main unit of a text with its globals."""
    source = source_of(text)
    unit = completed(source, source.main())
    check(source, unit)
    return unit


@pytest.mark.parametrize("seed", [1, 2])
def test_translator_and_interpreter_agree_on_globals(seed: int) -> None:
    assert difference_of_text(SHARED + UNITS, seed, 150) == ""


def test_what_nobody_writes_is_an_input() -> None:
    unit = whole(SHARED + UNITS)
    assert {*unit.of("input")} == {"up", "by", "Ready", "Asked"}
    assert {*unit.of("output")} == {"Count", "Row", "Lamp", "Flag"}
    assert unit.variables["DELAY"].section == "var"


def test_memory_of_the_controller_may_have_been_kept() -> None:
    unit = whole(SHARED + UNITS)
    kept = {slot.path for slot in slots(source_of(SHARED + UNITS), unit) if slot.initial is None}
    assert kept == {"FLAG"}
    for word, section in (("VAR_GLOBAL RETAIN", {"COUNT"}), ("VAR_GLOBAL", set())):
        text = f"{word} Count : INT; END_VAR PROGRAM P Count := 1 - Count; END_PROGRAM"
        unit = whole(text)
        assert {slot.path for slot in slots(source_of(text), unit) if slot.initial is None} == section
    text = "PROGRAM P VAR a AT %MW0 : INT := 4; b AT %MW8 : INT; END_VAR a := b; END_PROGRAM"
    unit = whole(text)
    assert unit.variables["A"].initial == 4 and not unit.variables["A"].retained
    assert unit.variables["B"].section == "input"


def test_an_external_without_its_global_has_any_value() -> None:
    text = "PROGRAM P VAR_EXTERNAL a, b : BOOL; END_VAR a := a OR b; END_PROGRAM"
    unit = whole(text)
    assert unit.variables["A"].retained and unit.variables["B"].section == "input"
    assert any("a is declared in no file that is given" in note for note in unit.notes)


def test_lists_with_one_name_in_both_are_told_apart(tmp_path: Path) -> None:
    for name in ("One", "Two"):
        text = f"<TcPlcObject><GVL Name='{name}'><Declaration>VAR_GLOBAL x : INT; END_VAR"
        (tmp_path / f"{name}.TcGVL").write_text(f"{text}</Declaration></GVL></TcPlcObject>", "utf-8")
    program = tmp_path / "p.st"
    program.write_text("PROGRAM P VAR x : INT; END_VAR One.x := Two.x; x := One.x; END_PROGRAM", "utf-8")
    source = read_sources([*sorted(tmp_path.glob("*.TcGVL")), program])
    unit = completed(source, source.chosen(None))
    check(source, unit)
    assert [*unit.of("input")] == ["Two__x"] and [*unit.of("output")] == ["One__x"]
    questions = tmp_path / "q.toml"
    questions.write_text(
        '[[property]]\nid = "same"\nsentence = "The one follows."\nalways = "One.x = Two.x AND x = One.x"',
        "utf-8",
    )
    assert main(["prove-program", str(tmp_path), "--property", str(questions)]) == 0
    program.write_text("PROGRAM P x := 1; END_PROGRAM", "utf-8")
    with pytest.raises(Unjudged, match=r"(?i)x: which global is meant. ONE\.X or TWO\.X"):
        read_sources([*sorted(tmp_path.glob("*.TcGVL")), program])


GLOBALS = "VAR_GLOBAL a, b : INT; END_VAR VAR_GLOBAL i AT %IX0.0 : BOOL; m AT %MW0 : INT; END_VAR\n"
REFUSED = {
    "an input is written": ("PROGRAM P i := TRUE; END_PROGRAM", "i is at %IX0.0, an input, and is written"),
    "two programs write": (
        "PROGRAM P a := 1; END_PROGRAM PROGRAM Other a := 2; END_PROGRAM",
        "a is written by Other too, which P does not call",
    ),
    "two programs at one address": (
        "PROGRAM P m := 1; END_PROGRAM PROGRAM Other VAR z AT %MB1 : BYTE; END_VAR z := 2; END_PROGRAM",
        "z of Other and m share M 8",
    ),
    "a function in an expression": (
        "FUNCTION F : INT VAR_INPUT x : INT; END_VAR a := x; F := x; END_FUNCTION "
        "PROGRAM P b := a + F(x := 1); END_PROGRAM",
        "F writes A: call it as a statement",
    ),
    "two ways to one": (
        "FUNCTION_BLOCK B VAR_IN_OUT x : INT; END_VAR x := 1; a := 2; END_FUNCTION_BLOCK "
        "PROGRAM P VAR c : B; END_VAR c(x := a); END_PROGRAM",
        "B uses A, and this call lends it",
    ),
    "another type": ("PROGRAM P VAR_EXTERNAL a : DINT; END_VAR a := 1; END_PROGRAM", "a is DINT here"),
    "a member and a global": (
        "TYPE E : (a, z); END_TYPE PROGRAM P VAR e : E; END_VAR e := a; END_PROGRAM",
        "a is a global and a member of E",
    ),
    "an instance that nobody calls": (
        "VAR_GLOBAL t : TON; END_VAR PROGRAM P VAR q : BOOL; END_VAR q := t.Q; END_PROGRAM",
        "t: no unit that belongs to P calls it",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_clear_is_refused(name: str) -> None:
    text, cause = REFUSED[name]
    with pytest.raises(Unjudged, match=cause):
        source = source_of(GLOBALS + text)
        unit = completed(source, source.chosen("P"))
        check(source, unit)


# ---------------------------------------------------------------- what must not be PROVED

WIRED = """VAR_GLOBAL Guard : BOOL; Stopped : BOOL; Run : BOOL; Mode AT %MX0.0 : BOOL; END_VAR
FUNCTION_BLOCK Stop IF NOT Guard THEN Stopped := TRUE; END_IF END_FUNCTION_BLOCK
PROGRAM P
VAR s : Stop; END_VAR
Mode := Mode;
s(); Run := NOT Stopped;
END_PROGRAM
"""
ASKED = {
    "the order of the calls": (
        "never",
        "Run AND NOT Guard",
        0,
        ("s(); Run := NOT Stopped;", "Run := NOT Stopped; s();"),
    ),
    "an input may change": ("never", "Run", 1, ("", "")),
    "memory may have been kept": ("never", "Mode", 1, ("", "")),
    "it begins at its first value": ("never", "Mode", 0, ("%MX0.0 : BOOL", "%MX0.0 : BOOL := FALSE")),
    "retained": ("never", "Run AND NOT Stopped AND FALSE OR Stopped AND Run", 0, ("", "")),
}


@pytest.mark.parametrize("name", ASKED)
def test_properties_are_asked_without_outputs(name: str, tmp_path: Path) -> None:
    form, asked, status, (old, new) = ASKED[name]
    program, questions = tmp_path / "p.st", tmp_path / "q.toml"
    questions.write_text(f'[[property]]\nid = "x"\nsentence = "So."\n{form} = "{asked}"\n', "utf-8")
    text = WIRED if name == "the order of the calls" else WIRED.replace(old, new)
    program.write_text(text, "utf-8")
    assert main(["prove-program", str(program), "--property", str(questions)]) == status
    if name == "the order of the calls":
        program.write_text(text.replace(old, new), "utf-8")
        assert main(["prove-program", str(program), "--property", str(questions)]) == 1


def test_a_unit_that_cannot_be_read_might_write(tmp_path: Path) -> None:
    text = "<TcPlcObject><POU Name='Far'><Declaration>PROGRAM Far VAR r : REAL; END_VAR</Declaration>"
    text += "<Implementation><ST>{}; r := 1.0;</ST></Implementation></POU></TcPlcObject>"
    (tmp_path / "p.st").write_text(WIRED, "utf-8")
    for body, cause in (("Run := TRUE", "FAR might write .*RUN"), ("x := TRUE", "")):
        (tmp_path / "Far.TcPOU").write_text(text.format(body), "utf-8")
        source = read_sources([tmp_path / "Far.TcPOU", tmp_path / "p.st"])
        if cause:
            with pytest.raises(Unjudged, match=cause):
                completed(source, source.chosen("P"))
        else:
            assert completed(source, source.chosen("P")).whole


def test_a_global_taken_for_memory_would_be_noticed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(shared_memory._Uses, "written", lambda self, units: {"GUARD", "STOPPED", "RUN"})
    with pytest.raises(AssertionError):
        test_properties_are_asked_without_outputs("an input may change", tmp_path)


TASK = """PROGRAM P VAR t : TON; n : INT; q AT %QX0.0 : BOOL; END_VAR
IF n < 9 THEN n := n + 1; END_IF t(IN := TRUE, PT := T#50ms); q := t.Q;
END_PROGRAM
CONFIGURATION c RESOURCE r ON PLC TASK slow (INTERVAL := T#{}ms, PRIORITY := 0); PROGRAM p0 WITH slow : P;
END_RESOURCE END_CONFIGURATION
"""


@pytest.mark.parametrize(
    ("ms", "times", "status"), [(20, "", 0), (60, "", 1), (20, "scan_time_ms = [1, 60]", 1)]
)
def test_the_interval_of_a_task_is_the_scan_time(ms: int, times: str, status: int, tmp_path: Path) -> None:
    program, questions = tmp_path / "p.st", tmp_path / "q.toml"
    program.write_text(TASK.format(ms), "utf-8")
    asked = '[[property]]\nid = "x"\nsentence = "It is off for three scans."\nnever = "q AND n < 4"\n'
    questions.write_text(f"{times}\n{asked}", "utf-8")
    assert main(["prove-program", str(program), "--property", str(questions)]) == status


MOVES = """VAR_GLOBAL g : INT; END_VAR
FUNCTION F
VAR_IN_OUT x : INT; END_VAR
x := 7; g := 1;
END_FUNCTION
PROGRAM P
VAR_INPUT on : BOOL; END_VAR
VAR_OUTPUT first, second : INT; END_VAR
VAR a : ARRAY [0..1] OF INT; END_VAR
g := 0;
IF on THEN F(x := a[g]); END_IF
first := a[0]; second := a[1];
END_PROGRAM
"""


def test_what_is_lent_is_where_it_was_before_the_call() -> None:
    source = source_of(MOVES)
    unit = completed(source, source.main())
    shown = Machine(source, unit).scan({"on": True}, 1)
    assert (shown["first"], shown["second"]) == (7, 0)
    assert difference_of_text(MOVES, 1, 20) == ""
