"""Variables at addresses: inputs and outputs of a program, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from programs.language.shared_memory import completed
from programs.language.subset import check
from programs.semantics.interpreter import Machine
from tests.programs.fuzz import difference_of_translator, source_of

PROGRAM = """PROGRAM Press
VAR
  Start AT %IX0.0 : BOOL; Stop AT %I0.1 : BOOL; Speed AT %IW2 : INT;
  Run AT %QX0.0 : BOOL; Code AT %QW2 : WORD;
  slow : BOOL;
END_VAR
slow := Speed < 100;
Run := (Start OR Run) AND NOT Stop AND slow;
Code := SEL(Run, 16#0001, 16#8000);
END_PROGRAM
"""
PROPERTIES = """[[property]]
id = "stop"
sentence = "Stop stops."
never = "Run AND Stop"

[[property]]
id = "fast"
sentence = "It never runs fast."
never = "Run AND Speed > 99"
"""


def test_inputs_and_outputs_are_those_of_the_program() -> None:
    source = source_of(PROGRAM)
    check(source, source.main())
    unit, of = source.main(), Machine(source, source.main())
    assert list(unit.of("input")) == ["Start", "Stop", "Speed"] and list(unit.of("output")) == ["Run", "Code"]
    assert of.scan({"Start": True, "Stop": False, "Speed": 5}, 1) == {"Run": True, "Code": 0x8000}
    assert of.scan({"Start": False, "Stop": False, "Speed": 99}, 1) == {"Run": True, "Code": 0x8000}
    assert of.scan({"Start": True, "Stop": False, "Speed": 100}, 1) == {"Run": False, "Code": 1}
    assert difference_of_translator(source, unit, 1, 20) == ""


@pytest.mark.parametrize(("wrong", "status"), [("", 0), ("NOT Stop AND ", 1), (" AND slow", 1)])
def test_properties_are_asked_for_every_input(wrong: str, status: int, tmp_path: Path) -> None:
    program, properties, out = (tmp_path / name for name in ("press.st", "press.toml", "out.json"))
    program.write_text(PROGRAM.replace(wrong, "") if wrong else PROGRAM, "utf-8")
    properties.write_text(PROPERTIES, "utf-8")
    given = ["prove-program", str(program), "--property", str(properties), "--json", str(out)]
    assert main(given) == status
    words = [row["verdict"] for row in json.loads(out.read_text("utf-8"))["verdicts"]]
    assert words.count("REFUTED") == status and set(words) <= {"PROVED", "REFUTED"}


def declared(text: str, kind: str = "PROGRAM", section: str = "VAR") -> str:
    """A unit with these variables."""
    outputs = "VAR_OUTPUT q : BOOL; END_VAR"
    return f"{kind} P\n{section} {text} END_VAR\n{outputs}\nq := TRUE;\nEND_{kind}\n"


def written(text: str, names: str = "ab") -> str:
    """A program that writes these of its variables, each with itself."""
    body = " ".join(f"{name} := {name};" for name in names)
    return declared(text).replace("q := TRUE;", f"q := TRUE; {body}")


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        (declared("a AT %KX0.0 : BOOL;"), "syntax error at"),
        (declared("a AT %IX0.0.1 : BOOL;"), "with a number or . are supported alone"),
        (declared("a AT %IX0 : BOOL;"), "a bit of a byte is %IX0.0 to %IX0.7"),
        (declared("a AT %IX0.8 : BOOL;"), "a bit of a byte"),
        (declared("a AT %IW0.1 : WORD;"), "a bit of a byte"),
        (declared("a AT %IW0 : BOOL;"), "a variable of 16 bits belongs there, and not BOOL"),
        (declared("a AT %ID0 : INT;"), "a variable of 32 bits belongs there, and not INT"),
        (declared("a AT %IW0 : ARRAY [0..1] OF BOOL;"), "a variable of 16 bits belongs there"),
        (declared("a, b AT %IX0.0 : BOOL;"), "one alone, has an address"),
        (declared("a AT %IX0.0 : BOOL;", "FUNCTION_BLOCK"), "in VAR of a PROGRAM"),
        (declared("a AT %IX0.0 : BOOL;", section="VAR_INPUT"), "in VAR of a PROGRAM"),
        (written("a AT %QX0.0 : BOOL; b AT %Q0.0 : BOOL;"), "b and a share Q 0"),
        (written("a AT %QW0 : WORD; b AT %QX1.0 : BOOL;"), "b and a share Q 8, counted in bytes"),
        (written("a AT %MW0 : WORD; b AT %MW1 : WORD;"), "b and a share M 8, counted in bytes"),
        (written("a AT %QD1 : DWORD; b AT %QW2 : WORD;"), "b and a share Q 16, counted in bytes"),
        (written("a AT %QX2.0 : BOOL; b AT %QW2 : WORD;"), "b and a share Q 16, counted in bytes"),
        (written("a AT %MX2.0 : BOOL; b AT %MW2 : WORD;", "a"), "b and a share M 16, counted in bytes"),
    ],
)
def test_what_has_no_clear_place_is_refused(text: str, cause: str) -> None:
    with pytest.raises(Unjudged, match=cause):
        source = source_of(text)
        completed(source, source.main())


def test_an_input_is_not_written() -> None:
    with pytest.raises(Unjudged, match="Start is an input and is written"):
        source = source_of(PROGRAM.replace("slow := Speed", "Start := FALSE; slow := Speed"))
        check(source, source.main())


def test_addresses_apart_are_taken() -> None:
    text = "a AT %QW0 : WORD; b AT %QW4 : INT; c AT %QX20.7 : BOOL; d AT %IW0 : WORD; e AT %IX0.0 : BOOL;"
    source = source_of(written(text, "abc"))
    unit = completed(source, source.main())
    check(source, unit)
    assert [*unit.of("output")] == ["a", "b", "c", "q"] and [*unit.of("input")] == ["d", "e"]


def test_a_program_has_no_instances() -> None:
    outer = "PROGRAM Outer VAR p : Press; END_VAR VAR_OUTPUT q : BOOL; END_VAR p(); q := p.Run; END_PROGRAM"
    source = source_of(PROGRAM + outer)
    with pytest.raises(Unjudged, match="p: Press is a PROGRAM, which has no instances"):
        check(source, source.units["OUTER"])
