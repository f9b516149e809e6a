"""Structures, arrays of several dimensions and arrays of blocks: by the interpreter and by the terms."""

from __future__ import annotations

from typing import Any

import pytest

from modeproof.ground.errors import Unjudged
from programs.language.subset import check
from programs.language.tree import Source
from programs.readers.scl import structured_text
from programs.readers.structured_text.units import read_text
from programs.semantics import terms
from programs.semantics import translator_expressions as values
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Overflow
from tests.programs.fuzz import difference_of_text, difference_of_translator, source_of
from tests.programs.semantics.test_semantics_edges import rows

TYPES = """TYPE
  Point : STRUCT x : INT := 3; y, z : INT; END_STRUCT;
  Row : ARRAY [1..2] OF Point;
  Box : STRUCT corner : Point := (y := 5); side : ARRAY [0..1] OF INT := [7, 8]; on : BOOL; END_STRUCT
END_TYPE
"""
OUT = "VAR_OUTPUT y : INT; END_VAR"
MOVER = """FUNCTION_BLOCK Mover
VAR_INPUT from : Point; list : ARRAY [0..2] OF INT; END_VAR
VAR_OUTPUT to : Point; back : ARRAY [0..2] OF INT; calls : INT; END_VAR
VAR_IN_OUT both : Point; END_VAR
VAR_TEMP work : Point; END_VAR
work.y := work.y + from.y; to := work; to.z := from.z; back := list; back[0] := back[2];
both.x := both.x + to.y; calls := calls + 1;
END_FUNCTION_BLOCK
TYPE Unused : STRUCT a : BOOL; END_STRUCT; END_TYPE
"""


def once(declared: str, body: str, more: str = TYPES, **inputs: Any) -> Any:
    """The output `y` after one scan."""
    return rows(f"{OUT} VAR {declared} END_VAR", body, [(1, inputs)], more=more)[0]


@pytest.mark.parametrize(
    ("declared", "value", "expected"),
    [
        ("p : Point;", "p.x * 100 + p.y", 300),
        ("p : Point := (y := 4, x := 1);", "p.X * 100 + p.Y * 10 + p.z", 140),
        ("b : Box;", "b.corner.x * 100 + b.corner.y * 10 + b.side[1]", 358),
        ("b : Box := (side := [9]);", "b.side[0]", None),
        ("b : ARRAY [0..2] OF Point := [(x := 1), 2((y := 2))];", "b[0].x * 100 + b[1].x * 10 + b[2].y", 132),
        ("a : ARRAY [0..1, 1..3] OF INT := [1, 2, 3, 2(4)];", "a[0,3]*100 + a[1,1]*10 + a[1, 3]", 340),
        ("a : ARRAY [0..1] OF ARRAY [1..2] OF INT := [[1, 2], [3]];", "a[0][2]*10 + a[1][1] + a[1][2]", 23),
        ("a : STRUCT l : ARRAY [-1..0] OF INT := [6, 7]; END_STRUCT;", "a.l[-1] * 10 + a.l[0]", 67),
    ],
)  # fmt: skip
def test_first_values_lie_where_they_belong(declared: str, value: str, expected: int | None) -> None:
    if expected is None:
        with pytest.raises(Unjudged, match="side has first values in its type and here"):
            once(declared, f"y := {value};")
    else:
        assert once(declared, f"y := {value};") == expected


def test_a_structure_is_copied_and_not_shared() -> None:
    body = "p.x := 4; q := p; p.x := 5; r[2] := q; q.x := 6; r[1] := r[2]; r[2].x := 9;"
    assert (
        once("p, q : Point; r : Row;", f"{body} y := p.x * 1000 + q.x * 100 + r[1].x * 10 + r[2].x;") == 5649
    )


def test_an_array_is_copied_and_not_shared() -> None:
    declared = "a, b : ARRAY [0..1] OF ARRAY [0..1] OF INT;"
    body = "a[0, 1] := 4; b := a; a[0][1] := 5; b[1] := b[0]; b[0][1] := 6;"
    assert once(declared, f"{body} y := a[0,1] * 100 + b[0,1] * 10 + b[1,1];") == 564


def test_a_block_takes_and_gives_structures_and_arrays() -> None:
    declared = "m : Mover; p, q : Point; k : Row; l : ARRAY [0..2] OF INT := [1, 2, 3];"
    body = "p.y := 4; p.z := 2; m(from := p, list := l, both := k[2], back => l, to => q); p.y := 0;"
    sum_of = "y := q.y * 1000 + m.to.z * 100 + k[2].x * 10 + l[0] * 1 + m.from.y;"
    assert once(declared, body + sum_of, TYPES + MOVER) == 4000 + 200 + 70 + 3 + 4
    twice = rows(f"{OUT} VAR {declared} END_VAR", body + "y := k[2].x;", [(1, {})] * 2, more=TYPES + MOVER)
    assert twice == [7, 11]


def test_temporary_structures_begin_anew() -> None:
    declared = f"{OUT} VAR_TEMP p : Point; a : ARRAY [0..1] OF Point; END_VAR"
    body = "p.x := p.x + 1; a[1].x := a[1].x + p.x; y := a[1].x;"
    assert rows(declared, body, [(1, {})] * 2, more=TYPES) == [7, 7]


def test_a_free_index_chooses_an_element() -> None:
    body = "r[x].y := 5; y := r[1].y * 10 + r[2].y;"
    got = rows(f"{OUT} VAR r : Row; END_VAR", body, [(1, {"x": 2}), (1, {"x": 1})], more=TYPES)
    assert got == [5, 55]
    with pytest.raises(Overflow, match=r"index 3 is outside 1\.\.2"):
        rows(f"{OUT} VAR r : Row; END_VAR", body, [(1, {"x": 3})], more=TYPES)


def test_each_dimension_has_its_bounds() -> None:
    declared, body = f"{OUT} VAR a : ARRAY [0..1, 5..6] OF INT; END_VAR", "a[x, x + 5] := 1; y := a[1, 6];"
    assert rows(declared, body, [(1, {"x": 1})]) == [1]
    with pytest.raises(Overflow, match=r"index 7 is outside 5\.\.6"):
        rows(declared, body.replace("a[x,", "a[0,"), [(1, {"x": 2})])


def test_timers_in_an_array_keep_their_own_time() -> None:
    declared = f"{OUT} VAR t : ARRAY [0..1] OF TON; i : INT; END_VAR"
    body = (
        "FOR i := 0 TO 1 DO t[i](IN := in, PT := T#10ms); END_FOR "
        "t[1](IN := FALSE); y := BOOL_TO_INT(t[0].Q) * 10 + BOOL_TO_INT(t[1].Q);"
    )
    assert rows(declared, body, [(10, {"in": True})] * 3) == [0, 10, 10]


def test_a_free_index_calls_one_of_the_blocks() -> None:
    more = (
        "FUNCTION_BLOCK Count VAR_INPUT by : INT; END_VAR VAR_OUTPUT n : INT; END_VAR n := n + by; "
        "END_FUNCTION_BLOCK"
    )
    kept = "c : ARRAY [1..3] OF Count; s : STRUCT t : ARRAY [0..1] OF Count; END_STRUCT; got : INT;"
    declared = f"{OUT} VAR {kept} END_VAR"
    body = (
        "IF x >= 1 AND x <= 3 THEN c[x](by := x, n => got); s.t[1](by := 1); END_IF "
        "y := c[1].n * 1000 + c[2].n * 100 + c[3].n * 10 + s.t[1].n + s.t[0].n;"
    )
    scans = [(1, {"x": 2}), (1, {"x": 2}), (1, {"x": 3}), (1, {"x": 0})]
    assert rows(declared, body, scans, more=more) == [201, 402, 433, 433]


def test_retained_structures_may_have_any_values() -> None:
    text = (
        f"{TYPES}FUNCTION_BLOCK B VAR_INPUT i : BOOL; END_VAR {OUT} VAR RETAIN p : Row; END_VAR "
        "y := p[1].x; END_FUNCTION_BLOCK"
    )
    source = source_of(text)
    found = {slot.path: slot.initial for slot in terms.slots(source, source.main())}
    assert found["P[1].X"] is None and found["P[2].Z"] is None


def test_inputs_and_outputs_may_be_structures() -> None:
    text = (
        f"{TYPES}FUNCTION_BLOCK B VAR_INPUT b : Box; k : ARRAY [0..1, 0..1] OF BOOL; END_VAR "
        "VAR_OUTPUT o : Box; n : INT; END_VAR o := b; o.on := k[0, 1]; "
        "n := b.side[0]; END_FUNCTION_BLOCK"
    )
    assert difference_of_text(text, 3, 40) == ""
    machine = Machine(source_of(text), source_of(text).main())
    given = {"CORNER": {"X": 1, "Y": 2, "Z": 3}, "SIDE": [4, 5], "ON": False}
    got = machine.scan({"b": given, "k": [[False, True], [False, False]]}, 1)
    assert got["n"] == 4 and got["o"] == given | {"ON": True}
    assert [slot.path for slot in terms.slots(source_of(text), machine.unit) if slot.given][-1] == "K[1][1]"


@pytest.mark.parametrize(
    ("declared", "body", "cause"),
    [
        ("p, q : Point;", "IF p = q THEN y := 1; END_IF", "this is no single value"),
        ("p : Point; q : STRUCT x, y, z : INT; END_STRUCT;", "p := q;", "is Point, and this is STRUCT"),
        ("a : ARRAY [0..1] OF INT; b : ARRAY [1..2] OF INT;", "a := b;", "OF INT, and this is"),
        ("p : Point;", "p := 1;", "the variable is Point, and this is DINT"),
        ("p : Point;", "y := p;", "INT := Point needs a conversion"),
        ("p : Point;", "y := p.v;", "Point has no v"),
        ("p : Point;", "y := p[1];", "only an array has an index"),
        ("p : Point := (x := 1, X := 2);", "y := 1;", "X is given twice"),
        ("p : Point := (v := 1);", "y := 1;", "v is no member of Point"),
        ("p : Point := (x := 40000);", "y := 1;", "no value of INT"),
        ("p : Point := [1];", "y := 1;", "no value of Point"),
        ("a : ARRAY [0..1] OF INT := [1, 2, 3];", "y := 1;", "more initial values"),
        ("a : ARRAY [0..1, 0..1] OF INT := [5(1)];", "y := 1;", "more initial values"),
        ("a : ARRAY [0..1, 0..1] OF INT := [1, [2, 3]];", "y := 1;", "no value of ARRAY"),
        ("a : ARRAY [0..31] OF ARRAY [0..31] OF INT;", "y := 1;", "at most 1,000 single values"),
        ("t : TON := (PT := T#1s);", "y := 1;", "no value of TON"),
        ("t, u : TON;", "t := u;", "instances of blocks are not assigned"),
        ("t, u : ARRAY [0..1] OF TON;", "t := u;", "instances of blocks are not assigned"),
        ("m : Mover; p : Point;", "m.to.x := 1;", "to is an output of a block and is written"),
        ("m : Mover; p : Box;", "m(both := p);", "both of Mover is of another type"),
        ("m : Mover; p : Point; q : Row;", "m(from := q[1].x, both := p);", "from of Mover is Point"),
        ("k : Pair2; p : Row;", "k(one := p[1], two := p[2]);", "VAR_IN_OUT of Pair2 are the same"),
        ("k : Pair2; m : Mover; p : Point;", "k(one := m.from, two := p);", "not a pin of an instance"),
        ("p : STRUCT a : INT; A : BOOL; END_STRUCT;", "y := 1;", "A is declared twice"),
        ("p : STRUCT a : Missing; END_STRUCT;", "y := 1;", "no type or block 'Missing'"),
        ("a : ARRAY [0..1] OF B;", "y := 1;", "B calls B"),
        ("CONSTANT_ : INT;", "y := x[1,2];", "only an array has an index"),
    ],
)  # fmt: skip
def test_what_is_no_whole_value_is_refused(declared: str, body: str, cause: str) -> None:
    pair = "FUNCTION_BLOCK Pair2 VAR_IN_OUT one, two : Point; END_VAR one.x := two.x; END_FUNCTION_BLOCK\n"
    head = f"{TYPES}{MOVER}{pair}FUNCTION_BLOCK B VAR_INPUT x : INT; END_VAR {OUT}"
    text = f"{head} VAR {declared} END_VAR {body} END_FUNCTION_BLOCK"
    with pytest.raises(Unjudged, match=cause):
        source = source_of(text)
        check(source, source.units["B"])


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("TYPE P : STRUCT a : INT;\nb, c : INT := (1; END_STRUCT; END_TYPE", "b.st:2"),
        ("TYPE P : STRUCT a : INT; END_STRUCT := (a := 2); END_TYPE", "b.st:1: this initial value"),
        (
            "FUNCTION_BLOCK B\nVAR a : INT := [1, 2; END_VAR END_FUNCTION_BLOCK",
            "b.st:2: an initial value has",
        ),
    ],
)
def test_a_broken_declaration_is_refused_with_its_line(text: str, line: str) -> None:
    with pytest.raises(Unjudged) as caught:
        read_text(text, "b.st")
    assert str(caught.value).startswith(line)


@pytest.mark.parametrize("fault", ["shared", "wrong element"])
def test_a_wrong_copy_would_be_noticed(monkeypatch: pytest.MonkeyPatch, fault: str) -> None:
    text = (
        f"{TYPES}FUNCTION_BLOCK B VAR_INPUT x : INT; END_VAR {OUT} VAR p, q : Point; r : Row; END_VAR "
        "p := q; p.x := p.x + 1; IF x = 1 OR x = 2 THEN r[x] := p; END_IF y := q.x + r[1].x; "
        "END_FUNCTION_BLOCK"
    )
    assert difference_of_text(text, 1, 30) == ""
    if fault == "shared":
        for module in ("interpreter", "interpreter_expressions"):
            monkeypatch.setattr(f"programs.semantics.{module}.deepcopy", lambda value: value)
    else:
        monkeypatch.setattr(values.Context, "put", lambda self, places, made, env: env.update(
            {f"{places[0][1]}{leaf}": term for leaf, term in made.items()}))  # fmt: skip
    assert difference_of_text(text, 1, 120) != ""


def test_scl_has_structures_and_types_of_its_own() -> None:
    text = """TYPE "Demand"
VERSION : 0.1
   STRUCT
      "level" : Int := 2;
      on : Bool;
   END_STRUCT;
END_TYPE
FUNCTION_BLOCK "B"
VAR_INPUT x : Int; END_VAR
VAR_OUTPUT y : Int; END_VAR
VAR s : "Demand"; t : Struct a : Int := 4; b : Array[0..1] of Bool; END_STRUCT; END_VAR
BEGIN
   #s.level := #s.level + #t.a; #y := #s.level;
END_FUNCTION_BLOCK
"""
    units = read_text(structured_text(text, "b.scl"), "b.scl")
    source = Source({unit.name.upper(): unit for unit in units}, {"b.scl": ""})
    check(source, source.main())
    assert difference_of_translator(source, source.main(), 1, 5) == ""
    assert Machine(source, source.main()).scan({"x": 0}, 1)["y"] == 6
