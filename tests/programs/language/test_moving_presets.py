"""Presets of timers: which may change while the timer runs, and that the verdict says so."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.cli import main
from programs.language.tool_differences import LOOP, PRESET, assumed
from tests.programs.fuzz import source_of

HEAD = "FUNCTION_BLOCK B VAR_INPUT a : BOOL; given : TIME; END_VAR VAR_OUTPUT q : BOOL; END_VAR "
END = " END_FUNCTION_BLOCK "
TIMER = "VAR t, u : TON; END_VAR VAR CONSTANT c : TIME := T#5s; END_VAR "
INNER = (
    "FUNCTION_BLOCK I VAR_INPUT a : BOOL; PT : TIME; END_VAR VAR_OUTPUT q : BOOL; END_VAR "
    "VAR t : TP; END_VAR t(IN := a, PT := PT, Q => q); END_FUNCTION_BLOCK "
)


def taken(body: str, before: str = "", steady: tuple[str, ...] = ()) -> list[str]:
    """What is said of timers."""
    source = source_of(f"{before}{HEAD}{TIMER}{body}{END}")
    return [text for text in assumed(source, source.units["B"], steady) if text.startswith(PRESET)]


@pytest.mark.parametrize(
    ("body", "timers"),
    [
        ("t(IN := a, PT := given);", "B.t"),
        ("IF a THEN t(IN := TRUE, PT := T#1s); ELSE t(IN := TRUE, PT := T#2s); END_IF", "B.t"),
        ("IF a THEN t(IN := TRUE, PT := T#1s); ELSE t(IN := TRUE); END_IF", "B.t"),
        ("t(IN := a, PT := c); IF a THEN t.PT := T#3s; END_IF", "B.t"),
        ("t.PT := given; t(IN := a);", "B.t"),
        ("u(IN := a, PT := T#1s, ET => t.PT); t(IN := a);", "B.t"),
        ("t(a, given); u(a, c + T#1s);", "B.t"),
        ("t(IN := a); t(IN := a, PT := c);", "B.t"),
        ("IF a THEN t(IN := a, PT := c); END_IF t(IN := a);", "B.t"),
        ("t.IN := a; t(); t(IN := a, PT := c);", "B.t"),
    ],
)
def test_a_preset_that_may_change_is_said(body: str, timers: str) -> None:
    assert [text.lower() for text in taken(body)] == [f"{PRESET} ({timers})".lower()]


@pytest.mark.parametrize(
    "body",
    [
        "t(IN := a, PT := T#1s); u(IN := a, PT := c + T#1s);",
        "IF a THEN t(IN := TRUE, PT := C); ELSE t(PT := c, IN := FALSE); END_IF",
        "t(IN := a);",
        "t(IN := FALSE); t(IN := a, PT := c); t();",
        "t(IN := TRUE, PT := c); IF a THEN t(IN := FALSE); t(IN := TRUE); END_IF",
        "q := t.PT > T#0s; t(IN := q, PT := c);",
    ],
)
def test_a_preset_that_stays_is_not_said(body: str) -> None:
    assert taken(body) == []


def test_a_parameter_of_the_target_stays() -> None:
    assert taken("t(IN := a, PT := given);", steady=("GIVEN",)) == []
    assert taken("t(IN := a, PT := given * 2);", steady=("GIVEN",)) == []


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("i(a := a, PT := T#1s); j(a := a, PT := T#2s);", False),
        ("i(a := a, PT := T#1s); j(a := a, PT := given);", True),
        ("IF a THEN i(a := a, PT := T#1s); END_IF i(a := FALSE);", True),
        ("i(a := a, PT := T#1s); j.PT := T#1s; j(a := a);", True),
        ("i(a, T#1s);", False),
    ],
)
def test_presets_are_followed_into_blocks(body: str, said: bool) -> None:
    found = taken(f"VAR i, j : I; END_VAR {body}", INNER)
    assert found == [f"{PRESET} (I.T)"] * said


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("FOR i := 0 TO 3 DO q := i > 2; END_FOR q := i = 4;", True),
        ("q := i > 3; FOR i := 0 TO 3 DO q := a; END_FOR", True),
        ("FOR o := 0 TO 3 DO q := a; END_FOR", True),
        ("FOR i := 0 TO 3 DO q := i > 2; END_FOR FOR i := 0 TO 1 DO q := i > 0; END_FOR i := 3;", False),
    ],
)
def test_a_control_variable_read_behind_its_loop_is_said(body: str, said: bool) -> None:
    source = source_of(f"{HEAD}VAR i : INT; END_VAR VAR_OUTPUT o : INT; END_VAR {body}{END}")
    name = "O" if "FOR o" in body else "I"
    assert list(assumed(source, source.units["B"])) == [f"{LOOP} (B.{name})"] * said


def test_every_output_of_a_verdict_says_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, asked, record = (tmp_path / name for name in ("b.st", "b.toml", "b.json"))
    program.write_text(f"{HEAD}{TIMER}t(IN := a, PT := given, Q => q);{END}", "utf-8")
    asked.write_text('[[property]]\nid = "p"\nsentence = "P."\nnever = "q AND NOT a"\n', "utf-8")
    assert main(["prove-program", str(program), "--property", str(asked), "--json", str(record)]) == 0
    assert f"  assumed     {PRESET} (B.T)" in capsys.readouterr().out
    assert f"a tool for which this is not so: {PRESET} (B.T)" in record.read_text("utf-8")
