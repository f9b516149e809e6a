"""Types of one's own, constants, functions with outputs, pragmas: by hand, and against the translator."""

from __future__ import annotations

import pytest

from modeproof.ground.errors import Unjudged
from programs.readers import attributes
from programs.semantics import terms
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Overflow
from tests.programs.fuzz import difference_of_text, source_of
from tests.programs.generate import program
from tests.programs.small_blocks import BOOL, END, HEAD, INT, given, ready, refusal

# ---------------------------------------------------------------- types


def test_a_subrange_is_owed_and_never_wraps() -> None:
    text = f"{HEAD}VAR_OUTPUT y : INT (0..9); END_VAR y := x;{END}"
    for wrap in (False, True):
        of = ready(text, wrap)
        assert of.scan({"x": 9, "in": False, "on": False}, 10) == {"y": 9}
        with pytest.raises(Overflow, match=r"10 is outside INT \(0\.\.9\)"):
            of.scan({"x": 10, "in": False, "on": False}, 10)


def test_one_calculates_with_a_subrange_as_with_its_base() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR a : INT (0..9) := 9; END_VAR"
    assert given(declared, "y := a * a - a; a := 20 - 15;", [{}, {}]) == [72, 20]


def test_a_type_may_have_a_first_value() -> None:
    types = "TYPE T : INT := 7; E : (a, b, c) := b; R : INT (1..5) := 3; N : T; END_TYPE\n"
    declared = INT + "VAR t : T; u : T := 1; e : E; r : R; l : ARRAY [0..1] OF N; END_VAR"
    body = "IF e = E#b THEN y := t * 1000 + u * 100 + r * 10 + l[1]; END_IF"
    assert given(declared, body, [{}], types) == [7137]


def test_a_conversion_gives_the_number_of_a_member() -> None:
    types = (
        "TYPE E : (lo := 10, mid := 5, hi); END_TYPE F : (p, q) WORD := q;".replace("END_TYPE F", "F")
        + " END_TYPE\n"
    )
    declared = INT + "VAR e : E; f : F; END_VAR"
    body = "y := TO_INT(e) * 10 + TO_INT(f); IF in THEN e := HI; ELSE e := E#mid; END_IF"
    assert given(declared, body, [{}, {"in": True}, {}], types) == [101, 51, 61]


def test_constants_and_their_expressions_are_bounds_and_labels() -> None:
    declared = (
        INT + "VAR CONSTANT n3 : INT := 3; m : INT := n3 * 2 - 1; END_VAR "
        "VAR a : ARRAY [1..n3 + 1] OF INT := [3(m), 9]; z : INT := m / 2; END_VAR"
    )
    body = "CASE x OF n3 + 1: y := a[4]; m..m + 2: y := a[1]; -n3: y := z; ELSE y := 0; END_CASE"
    assert given(declared, body, [{"x": 4}, {"x": 7}, {"x": -3}, {"x": 8}]) == [9, 5, 2, 0]


@pytest.mark.parametrize(
    ("declared", "body", "cause"),
    [
        ("VAR a : INT (1..5); END_VAR", "y := a;", "give it a first value"),
        ("VAR a : ARRAY [0..1] OF INT (1..5); END_VAR", "y := a[0];", "compilers differ here"),
        ("VAR a : INT (5..1) := 2; END_VAR", "y := a;", "5..1 is no range of INT"),
        ("VAR a : WORD (1..5) := 2; END_VAR", "y := 1;", "a range of WORD is not supported"),
        ("VAR a : INT (0..5) := 6; END_VAR", "y := a;", "no value of INT (0..5)"),
        ("VAR a : (p, q, P); END_VAR", "y := 1;", "two members of an enumeration"),
        ("VAR a : (p := 1, q := 1); END_VAR", "y := 1;", "two members of an enumeration"),
        ("VAR a : (p, q); b : (q, r); END_VAR", "IF a = q THEN y := 1; END_IF", "which enumeration is meant"),
        ("VAR a : (p := 5, q := 2); END_VAR", "CASE a OF p..q: y := 1; END_CASE", "numbers of its own"),
        ("VAR a : ARRAY [0..n] OF INT; END_VAR", "y := 1;", "n: a constant is needed here"),
        (
            "VAR CONSTANT c : INT := 20000; END_VAR",
            "CASE x OF c + c: y := 1; END_CASE",
            "40000 is outside INT",
        ),
        ("VAR CONSTANT c : INT := 2 / 0; END_VAR", "y := 1;", "division by zero"),
        (
            "VAR CONSTANT c : BOOL := TRUE; END_VAR VAR a : ARRAY [0..c] OF INT; END_VAR",
            "y := 1;",
            "a number is needed",
        ),
        ("VAR a : INT := 2 + TRUE; END_VAR", "y := 1;", "made of whole numbers"),
        ("", "y := TO_REAL(x);", "conversion TO_REAL is not supported"),
        ("", "IF in AND_THEN x THEN y := 1; END_IF", "AND_THEN of BOOL and INT is not supported"),
        ("VAR c : CTU; END_VAR", "c(RESETS := in);", "CTU has no RESETS"),
    ],
)
def test_what_is_in_doubt_is_refused(declared: str, body: str, cause: str) -> None:
    assert cause in refusal(INT + declared, body)


def test_a_label_of_another_enumeration_is_refused() -> None:
    types = "TYPE E : (a, b); F : (c, d); END_TYPE\n"
    assert "a label of F, and the value is E" in refusal(
        INT + "VAR e : E; f : F; END_VAR", "CASE e OF d: y := 1; END_CASE", types
    )


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("y := x <> 0 AND_THEN 10 / x > 2;", [False, True]),
        ("y := x = 0 OR_ELSE 10 / x > 2;", [True, True]),
    ],
)
def test_the_right_side_counts_only_where_it_must(body: str, expected: list[bool]) -> None:
    assert given(BOOL, body, [{"x": 0}, {"x": 3}]) == expected
    plain = body.replace("_THEN", "").replace("_ELSE", "")
    of = Machine(source := source_of(f"{HEAD}{BOOL}{plain}{END}"), source.units["B"])
    with pytest.raises(Overflow, match="division by zero"):
        of.scan({"x": 0, "in": False, "on": False}, 10)


# ---------------------------------------------------------------- functions

SPLIT = """FUNCTION Split
VAR_INPUT a : INT; END_VAR VAR_OUTPUT half : INT; odd : BOOL; END_VAR VAR_IN_OUT sum : INT; END_VAR
VAR n : INT := 1; END_VAR
half := a / 2; odd := a MOD 2 <> 0; sum := sum + n; n := n + 1;
END_FUNCTION
FUNCTION Half : INT VAR_INPUT a : INT; END_VAR VAR_OUTPUT odd : BOOL; END_VAR
Half := a / 2; odd := a MOD 2 <> 0; END_FUNCTION
"""


def test_a_function_gives_outputs_and_changes_what_is_lent() -> None:
    body = "Split(a := x, half => i, odd => o, sum := n); y := n * 100 + i * 10 + BOOL_TO_INT(o);"
    declared = INT + "VAR o : BOOL; END_VAR"
    assert given(declared, body, [{"x": 7}, {"x": 4}, {"x": 5}], SPLIT) == [131, 220, 321]


def test_a_function_gives_its_result_beside_its_outputs() -> None:
    declared = INT + "VAR o : BOOL; END_VAR"
    assert given(
        declared, "n := Half(a := x, odd => o); y := n * 10 + BOOL_TO_INT(o);", [{"x": 7}], SPLIT
    ) == [31]
    assert given(declared, "Half(x, o); Half(x); y := Half(x) + BOOL_TO_INT(o);", [{"x": 7}], SPLIT) == [4]


@pytest.mark.parametrize(
    ("body", "cause"),
    [
        ("y := Split(a := x, sum := n);", "Split has no result"),
        ("Split(a := x);", "the arguments of Split are a, sum"),
        ("Split(a := x, sum := 3);", "sum of Split is VAR_IN_OUT"),
        ("Split(x, n);", "Split has VAR_IN_OUT"),
        ("y := 1 + Half(a := x, odd => o);", "=> within an expression"),
        ("o := Half(a := x, odd => o);", "Half of Half is of another type"),
        ("FOR i := 1 TO 3 DO Split(a := x, sum := i); END_FOR", "the loop writes its control variable i"),
        ("Nothing(x);", "Nothing is not declared"),
    ],
)
def test_a_function_called_wrongly_is_refused(body: str, cause: str) -> None:
    assert cause in refusal(INT + "VAR o : BOOL; END_VAR", body, SPLIT)


# ---------------------------------------------------------------- pragmas and comments


def test_pragmas_without_a_meaning_and_both_comments_go() -> None:
    body = "{region 'a'} y := /* NOT */ in; // NOT\n{endregion}"
    text = f"{{attribute 'qualified_only'}}\n{HEAD}{BOOL}{body}{END}"
    assert ready(text).scan({"x": 0, "in": True, "on": False}, 10) == {"y": True}


@pytest.mark.parametrize(
    ("pragma", "cause"),
    [
        ("{IF defined (a)}", "pragma {IF defined (a)} may change"),
        ("{attribute 'no_init'}", "attribute 'no_init' may change"),
        ("{attribute 'initialize_on_call'}", "attribute 'initialize_on_call' may change"),
        ("{attribute 'TcCallAfterOutputUpdate'}", "attribute 'TcCallAfterOutputUpdate' may change"),
        ("{attribute 'TcSwapWord'}", "attribute 'TcSwapWord' may change"),
        ("{attribute 'hide' 'TcRetain'}", "pragma {attribute 'hide' 'TcRetain'} may change"),
        ("{attribute 'monitoring' := 'call'}", "attribute 'monitoring' may change"),
        ("{attribute 'symbol' := 'readwrite'}", "attribute 'symbol' lets a client write"),
        ("{attribute 'OPC.UA.DA' := '1'}", "attribute 'OPC.UA.DA' lets a client write"),
    ],
)
def test_a_pragma_that_may_change_something_is_refused(pragma: str, cause: str) -> None:
    assert refusal(BOOL, f"\n{pragma}\ny := in;").startswith(f"b.st:5: {cause}")


@pytest.mark.parametrize("pragma", sorted(attributes.RETAINED))
def test_an_attribute_that_retains_is_read_as_retain(pragma: str) -> None:
    declared = f"VAR {{attribute '{pragma}' := '1'}} {{attribute 'hide'}}\n a, b : INT := 3; c : INT; END_VAR"
    source = source_of(f"{HEAD}{BOOL}{declared} y := a = c;{END}")
    found = {slot.path: slot.initial for slot in terms.slots(source, source.units["B"])}
    assert (found["A"], found["B"], found["C"]) == (None, None, 0)


def test_an_attribute_that_retains_a_block_is_refused() -> None:
    declared = BOOL + "VAR {attribute 'TcRetain' := '1'} t : TON; END_VAR"
    assert "RETAIN: an instance of a block is not supported" in refusal(declared, "y := in;")


@pytest.mark.parametrize(
    "text",
    [
        "{a}" + HEAD + BOOL + "y := in;" + END,
        HEAD + BOOL + "{a} VAR k : BOOL; END_VAR y := k;" + END,
        HEAD + BOOL + "VAR k : BOOL; {a} END_VAR y := k;" + END,
        HEAD + BOOL + "VAR_TEMP {a} k : BOOL; END_VAR y := k;" + END,
        HEAD + BOOL + "VAR CONSTANT {a} k : BOOL := TRUE; END_VAR y := k;" + END,
        "TYPE s : STRUCT {a} k : BOOL; END_STRUCT; END_TYPE " + HEAD + BOOL + "y := in;" + END,
    ],
)
def test_an_attribute_that_retains_nothing_clear_is_refused(text: str) -> None:
    with pytest.raises(Unjudged, match="this attribute retains one variable in VAR or VAR_OUTPUT"):
        source_of(text.replace("{a}", "{attribute 'TcRetain' := '1'}"))


def test_retained_and_persistent_variables_begin_anywhere() -> None:
    for words in ("RETAIN", "PERSISTENT", "RETAIN PERSISTENT", "PERSISTENT RETAIN"):
        source = source_of(f"{HEAD}{BOOL}VAR {words} a : BOOL := TRUE; END_VAR y := a;{END}")
        (found,) = (slot for slot in terms.slots(source, source.units["B"]) if slot.path == "A")
        assert found.initial is None


@pytest.mark.parametrize("seed", range(6))
def test_random_programs_with_all_of_it_agree(seed: int) -> None:
    assert difference_of_text(program(seed), seed, 25, wrap=bool(seed % 2)) == ""
