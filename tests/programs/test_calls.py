"""FUNCTIONs of a program's own, and variables that are lent to a block."""

from __future__ import annotations

import pytest

from modeproof.ground.errors import Unjudged
from programs.run import Overflow
from tests.programs.test_semantics_edges import Scans, rows

ADD = """FUNCTION Add2 : INT
VAR_INPUT a, b : INT; END_VAR VAR t : INT := 3; END_VAR
IF a > 5 THEN Add2 := 7; RETURN; END_IF
t := t + a; Add2 := t + b;
END_FUNCTION"""
BUMP = """FUNCTION_BLOCK Bump
VAR_INPUT by : INT; END_VAR VAR_IN_OUT z : INT; END_VAR VAR_OUTPUT old : INT; END_VAR
old := z; z := z + by; END_FUNCTION_BLOCK"""


def test_a_function_begins_anew_in_each_call() -> None:
    declared, body = "VAR_OUTPUT y : INT; END_VAR", "y := Add2(x, 4) + Add2(b := Add2(1, 0), a := x / 2);"
    given: Scans = [(1, {"x": x}) for x in (2, 2, 20)]
    assert rows(declared, body, given, more=ADD) == [17, 17, 14]


def test_a_function_stops_where_it_leaves_its_type() -> None:
    with pytest.raises(Overflow, match="outside INT"):
        rows("VAR_OUTPUT y : INT; END_VAR", "y := Add2(1, x);", [(1, {"x": 32767})], more=ADD)


def test_a_lent_variable_is_changed() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR b, c : Bump; v : INT := 1; END_VAR"
    body = "b(z := v, by := 2); IF in THEN c(by := x, z := v); END_IF y := 10 * v + b.old;"
    assert rows(declared, body, [(1, {}), (1, {"in": True, "x": 4})], more=BUMP) == [31, 93]


@pytest.mark.parametrize(
    ("body", "cause"),
    [
        ("y := Add2(x);", "the arguments of Add2 are a, b"),
        ("y := Add2(a := x, c := x);", "the arguments of Add2 are a, b"),
        ("y := Add2(in, x);", "a of Add2 is of another type"),
        ("y := Loop(x);", "Loop calls Loop"),
        ("y := Kept(x);", "e: a FUNCTION has inputs and plain variables here"),
        ("b(by := 1);", "z of Bump is VAR_IN_OUT: give it a single variable"),
        ("b(z := x + 1);", "give it a single variable"),
        ("b(z := x);", "x is an input and is written"),
        ("b(z := d);", "z of Bump is of another type"),
        ("two(p := v, q := v);", "two VAR_IN_OUT of Two are the same variable"),
        ("y := b.z;", "Bump has no z"),
    ],
)
def test_what_is_lent_or_called_wrongly_is_refused(body: str, cause: str) -> None:
    more = f"""{ADD}
{BUMP}
FUNCTION Loop : INT VAR_INPUT a : INT; END_VAR Loop := Loop(a); END_FUNCTION
FUNCTION Kept : INT VAR_INPUT a : INT; END_VAR VAR e : R_TRIG; END_VAR Kept := a; END_FUNCTION
FUNCTION_BLOCK Two VAR_IN_OUT p, q : INT; END_VAR p := q; END_FUNCTION_BLOCK"""
    declared = "VAR_OUTPUT y : INT; END_VAR VAR b : Bump; two : Two; v : INT; d : DINT; END_VAR"
    with pytest.raises(Unjudged, match=cause.replace("(", r"\(")):
        rows(declared, body, [], more=more)
