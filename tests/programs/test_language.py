"""Loops that end early, bits, counters, types of one's own, functions: by hand, and against the translator."""

from __future__ import annotations

from typing import Any

import pytest
import z3

from modeproof.ground.errors import Unjudged
from programs import run, symbolic, terms, values
from programs.check import check
from programs.run import Machine, Overflow
from programs.symbolic import Left
from programs.tree import Bit
from tests.programs.fuzz import difference_of_text, source_of
from tests.programs.generate import program

HEAD = "FUNCTION_BLOCK B\nVAR_INPUT x : INT; in, on : BOOL; END_VAR\n"
END = "\nEND_FUNCTION_BLOCK\n"


def ready(text: str, wrap: bool = False) -> Machine:
    """The block B of a text, looked at; the translator agrees with the interpreter in random scans."""
    source = source_of(text)
    check(source, source.units["B"])
    assert difference_of_text(text, 1, 60, wrap) == ""
    return Machine(source, source.units["B"], wrap)


def given(declared: str, body: str, scans: list[dict[str, Any]], before: str = "") -> list[Any]:
    """The output `y` after each scan."""
    of = ready(f"{before}{HEAD}{declared}\n{body}{END}")
    start = {"x": 0, "in": False, "on": False}
    return [of.scan(start | inputs, 10)["y"] for inputs in scans]


def refusal(declared: str, body: str, before: str = "") -> str:
    """Why a text is refused."""
    with pytest.raises(Unjudged) as caught:
        source = source_of(f"{before}{HEAD}{declared}\n{body}{END}")
        check(source, source.units["B"])
    return caught.value.message


INT = "VAR_OUTPUT y : INT; END_VAR VAR i, n : INT; END_VAR "
BOOL = "VAR_OUTPUT y : BOOL; END_VAR "

# ---------------------------------------------------------------- loops


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("n := 0; FOR i := 1 TO 5 DO IF i = x THEN EXIT; END_IF n := n + i; END_FOR y := n * 10 + i;", [33, 156]),
        ("n := 0; FOR i := 1 TO 5 DO IF i = x THEN CONTINUE; END_IF n := n + i; END_FOR y := n * 10 + i;", [126, 156]),
        ("y := 0; FOR i := 1 TO 5 DO IF i = x THEN RETURN; END_IF y := y + i; END_FOR y := 99;", [3, 99]),
        ("n := 0; i := 0; WHILE i < 5 DO i := i + 1; IF i = x THEN EXIT; END_IF n := n + 1; END_WHILE y := n;", [2, 5]),
        ("n := 0; i := 0; WHILE i < 5 DO i := i + 1; IF i = x THEN CONTINUE; END_IF n := n + 1; END_WHILE y := n;", [4, 5]),
        ("n := 0; i := 0; REPEAT i := i + 1; IF i = x THEN CONTINUE; END_IF n := n + 1; UNTIL i >= 3 END_REPEAT y := n;", [2, 3]),
        ("i := 0; REPEAT i := i + 1; IF i = x THEN RETURN; END_IF y := i; UNTIL i >= 5 END_REPEAT", [2, 5]),
        ("n := 0; FOR i := 1 TO 3 DO WHILE TRUE DO n := n + 1; EXIT; END_WHILE END_FOR y := n * 10 + i;", [34, 34]),
        ("y := 7; FOR i := 1 TO 3 DO CONTINUE; y := 8; END_FOR", [7, 7]),
    ],
)  # fmt: skip
def test_a_loop_ends_where_it_says(body: str, expected: list[int]) -> None:
    assert given(INT, body, [{"x": 3}, {"x": 0}]) == expected


def test_a_loop_may_make_its_last_turn() -> None:
    body = "i := 0; WHILE i < x DO i := i + 1; END_WHILE y := i;"
    assert given(INT, body, [{"x": 32}]) == [32]
    source = source_of(f"{HEAD}{INT}{body}{END}")
    with pytest.raises(Overflow, match="ends after 32 turns"):
        Machine(source, source.units["B"]).scan({"x": 33, "in": False, "on": False}, 10)


def test_exit_read_as_continue_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = symbolic.Translator.statement

    def wrong(self: Any, at: Any, statement: Any, env: Any, here: Any) -> Left:
        left = right(self, at, statement, env, here)
        return Left(left.returned, z3.BoolVal(False), left.ended)

    monkeypatch.setattr(symbolic.Translator, "statement", wrong)
    body = "n := 0; FOR i := 1 TO 5 DO IF i = x THEN EXIT; END_IF n := n + i; END_FOR y := n;"
    assert " the term gives " in difference_of_text(f"{HEAD}{INT}{body}{END}", 1, 60)


# ---------------------------------------------------------------- bits


@pytest.mark.parametrize(
    ("declared", "body", "expected"),
    [
        ("VAR_OUTPUT y : BOOL; END_VAR VAR w : WORD; END_VAR", "w := INT_TO_WORD(x); y := w.3;", [False, True, True]),
        ("VAR_OUTPUT y : BOOL; END_VAR VAR w : WORD; END_VAR", "w := INT_TO_WORD(x); y := w.%X15;", [False, False, True]),
        ("VAR_OUTPUT y : WORD; END_VAR", "y := 16#FFFF; y.0 := x = 0; y.15 := x = 8;", [0x7FFF, 0xFFFE, 0x7FFE]),
        ("VAR_OUTPUT y : BYTE; END_VAR VAR a : ARRAY [0..1] OF BYTE; END_VAR", "a[1].7 := x = 8; y := a[1];", [0, 128, 0]),
        ("VAR_OUTPUT y : LWORD; END_VAR", "y.63 := x = 8; y.1 := TRUE;", [2, 2 + 2**63, 2]),
        ("VAR_OUTPUT y : WORD; END_VAR VAR r : R_TRIG; END_VAR", "r(CLK := x = 8, Q => y.4);", [0, 16, 0]),
    ],
)  # fmt: skip
def test_a_bit_is_read_and_written(declared: str, body: str, expected: list[Any]) -> None:
    assert given(declared, body, [{"x": 0}, {"x": 8}, {"x": -1}]) == expected


def test_a_bit_beside_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = values.Context.store

    def wrong(self: Any, target: Any, term: Any, env: Any, here: Any) -> None:
        moved = Bit(target.of, target.number ^ 1, target.place) if isinstance(target, Bit) else target
        right(self, moved, term, env, here)

    monkeypatch.setattr(values.Context, "store", wrong)
    text = f"{HEAD}VAR_OUTPUT y : WORD; END_VAR y.6 := in;{END}"
    assert " the term gives " in difference_of_text(text, 1, 20)


# ---------------------------------------------------------------- counters


def counted(block: str, pins: str, of: str, scans: str, preset: str = "2") -> list[Any]:
    """The output of a counter; each word of `scans` has a digit for `in` and for `on`."""
    kind = "INT" if of == "CV" else "BOOL"
    declared = f"VAR_OUTPUT y : {kind}; END_VAR VAR c : {block}; END_VAR"
    rows = [{"in": word[0] == "1", "on": word[1] == "1"} for word in scans.split()]
    return given(declared, f"c({pins}, PV := {preset}); y := c.{of};", rows)


def test_counters_count_edges() -> None:
    up, down = "CU := in, R := on", "CD := in, LD := on"
    assert counted("CTU", up, "CV", "10 10 00 10 00 10 11 11 10 00 10") == [1, 1, 1, 2, 2, 3, 0, 0, 0, 0, 1]
    assert counted("CTU", up, "Q", "10 10 00 10 00 11") == [False, False, False, True, True, False]
    assert counted("CTD", down, "CV", "01 10 00 10 00 10 01") == [2, 1, 1, 0, 0, -1, 2]
    assert counted("CTD", down, "Q", "00 01 10 00 10 10") == [True, False, False, False, True, True]


def test_both_edges_together_count_nothing() -> None:
    pins = "CU := in, CD := on"
    assert counted("CTUD", pins, "CV", "11 00 10 00 01 00 01 00 11 01 10") == [
        0,
        0,
        1,
        1,
        0,
        0,
        -1,
        -1,
        -1,
        -1,
        0,
    ]
    assert counted("CTUD", pins, "QU", "10 00 10 11", "1") == [True, True, True, True]
    assert counted("CTUD", pins, "QD", "00 10 00 01", "1") == [True, False, False, True]


def test_reset_goes_before_load_and_both_before_edges() -> None:
    assert counted("CTUD", "CU := in, R := on, LD := in", "CV", "10 00 10 11 00") == [2, 2, 2, 0, 0]


def test_a_counter_has_the_older_names_of_pins_too() -> None:
    assert counted("CTU", "CU := in, RESET := on", "CV", "10 00 10 01") == [1, 1, 2, 0]
    assert counted("CTD", "CD := in, LOAD := on", "CV", "01 10") == [2, 1]


@pytest.mark.parametrize(
    ("block", "first", "pins", "limit"),
    [("CTU", 32766, "CU := in", 32767), ("CTD", -32767, "CD := in", -32768), ("CTUD_DINT", 2**31 - 2, "CU := in", 2**31 - 1)],
)  # fmt: skip
def test_a_counter_stands_still_at_its_limit(block: str, first: int, pins: str, limit: int) -> None:
    kind = "DINT" if block.endswith("DINT") else "INT"
    text = (
        f"{HEAD}VAR_OUTPUT y : {kind}; END_VAR VAR c : {block}; END_VAR c({pins}, PV := 2); y := c.CV;{END}"
    )
    of = ready(text)
    of.memory.values["C"].values["CV"] = first
    scans = [{"x": 0, "in": number % 2 == 0, "on": False} for number in range(5)]
    assert [of.scan(inputs, 10)["y"] for inputs in scans] == [limit] * 5


def test_another_rule_for_both_edges_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = run.Standard.count

    def wrong(self: Any, own: Any) -> None:
        edges = own["CU"] and own["CD"] and not self.up and not self.down
        right(self, own)
        own["CV"] += int(edges)

    monkeypatch.setattr(run.Standard, "count", wrong)
    text = f"{HEAD}VAR_OUTPUT y : INT; END_VAR VAR c : CTUD; END_VAR c(CU := in, CD := on); y := c.CV;{END}"
    assert " the term gives " in difference_of_text(text, 2, 60)


def test_a_counter_without_a_limit_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = terms.BLOCKS["CTD_UDINT"]
    text = f"{HEAD}VAR_OUTPUT y : UDINT; END_VAR VAR c : CTD_UDINT; END_VAR c(CD := in); y := c.CV;{END}"
    assert difference_of_text(text, 1, 60) == ""
    other = {**terms.BLOCKS, "CTD_UDINT": (right[0], terms.BLOCKS["CTD"][1])}
    monkeypatch.setattr(terms, "BLOCKS", other)
    assert " is 0, the term gives -1" in difference_of_text(text, 1, 60)


# ---------------------------------------------------------------- arguments without names


def test_inputs_are_given_in_the_order_of_declaration() -> None:
    below = (
        "FUNCTION_BLOCK L VAR_INPUT a : INT; END_VAR VAR_INPUT b, c : INT; END_VAR VAR_OUTPUT q, r : INT; "
        "END_VAR q := a * 100 + b * 10 + c; r := a; END_FUNCTION_BLOCK\n"
    )
    declared = INT + "VAR l : L; END_VAR"
    assert given(declared, "l(x, 2, 3); y := l.q;", [{"x": 1}], below) == [123]
    assert given(declared, "l(x, 2, 3, n, y); y := y + n;", [{"x": 1}], below) == [124]
    for body, cause in (
        ("l(x, 2);", "2 arguments without names; the inputs are a, b, c"),
        ("l(x, 2, 3, n);", "4 arguments without names"),
        ("l(x, b := 2, c := 3);", "arguments with names and without"),
        ("l(a := 1, a := 2);", "a of L is given twice"),
    ):
        assert cause in refusal(declared, body, below)


def test_a_standard_block_takes_arguments_without_names() -> None:
    assert given(BOOL + "VAR t : TON; e : TIME; END_VAR", "t(in, T#10ms, y, e);", [{"in": True}] * 2) == [
        False,
        True,
    ]
    assert given(BOOL + "VAR s : SR; END_VAR", "s(in, on); y := s.Q1;", [{"in": True, "on": True}]) == [True]
    assert given(BOOL + "VAR s : RS; END_VAR", "s(in, on); y := s.Q1;", [{"in": True, "on": True}]) == [False]


def test_where_the_order_is_in_doubt_names_are_needed() -> None:
    lent = (
        "FUNCTION_BLOCK L VAR_INPUT a : INT; END_VAR VAR_IN_OUT b : INT; END_VAR b := a; END_FUNCTION_BLOCK\n"
    )
    mixed = (
        "FUNCTION_BLOCK L VAR_OUTPUT q : INT; END_VAR VAR_INPUT a : INT; END_VAR q := a; END_FUNCTION_BLOCK\n"
    )
    assert "has VAR_IN_OUT, or outputs before inputs" in refusal(INT + "VAR l : L; END_VAR", "l(x, n);", lent)
    assert "outputs before inputs" in refusal(INT + "VAR l : L; END_VAR", "l(x);", mixed)


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
        "VAR a : ARRAY [1..n3 + 1] OF INT := [n3(m), 9]; z : INT := m / 2; END_VAR"
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
        ("VAR CONSTANT c : INT := 20000; END_VAR", "CASE x OF c + c: y := 1; END_CASE", "40000 is outside INT"),
        ("VAR CONSTANT c : INT := 2 / 0; END_VAR", "y := 1;", "division by zero"),
        ("VAR CONSTANT c : BOOL := TRUE; END_VAR VAR a : ARRAY [0..c] OF INT; END_VAR", "y := 1;", "a number is needed"),
        ("VAR a : INT := 2 + TRUE; END_VAR", "y := 1;", "made of whole numbers"),
        ("", "y := TO_REAL(x);", "conversion TO_REAL is not supported"),
        ("", "IF in AND_THEN x THEN y := 1; END_IF", "AND_THEN of BOOL and INT is not supported"),
        ("VAR c : CTU; END_VAR", "c(RESETS := in);", "CTU has no RESETS"),
    ],
)  # fmt: skip
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
    text = f"{{attribute 'qualified_only'}}\n{HEAD}{{region 'a'}}{BOOL} y := /* NOT */ in; // NOT\n{{endregion}}{END}"
    assert ready(text).scan({"x": 0, "in": True, "on": False}, 10) == {"y": True}


@pytest.mark.parametrize(
    "pragma", ["{IF defined (a)}", "{attribute 'no_init'}", "{attribute 'initialize_on_call'}"]
)
def test_a_pragma_that_may_change_something_is_refused(pragma: str) -> None:
    assert refusal(BOOL, f"\n{pragma}\ny := in;").startswith(f"b.st:5: pragma {pragma}")


def test_retained_and_persistent_variables_begin_anywhere() -> None:
    for words in ("RETAIN", "PERSISTENT", "RETAIN PERSISTENT", "PERSISTENT RETAIN"):
        source = source_of(f"{HEAD}{BOOL}VAR {words} a : BOOL := TRUE; END_VAR y := a;{END}")
        (found,) = (slot for slot in terms.slots(source, source.units["B"]) if slot.path == "A")
        assert found.initial is None


@pytest.mark.parametrize("seed", range(6))
def test_random_programs_with_all_of_it_agree(seed: int) -> None:
    assert difference_of_text(program(seed), seed, 25, wrap=bool(seed % 2)) == ""
