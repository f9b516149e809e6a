"""Each rule of the language at its edge, by the interpreter and by the terms."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import z3

from modeproof.ground.errors import Unjudged
from programs.language.subset import check
from programs.readers.structured_text.units import read_text
from programs.semantics import interpreter_blocks as run_standard
from programs.semantics import terms
from programs.semantics import translator as symbolic
from programs.semantics import translator_expressions as values
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Overflow
from programs.semantics.terms import slots
from tests.programs.fuzz import difference_of_text, difference_of_translator, source_of
from tests.programs.generate import program

KITCHEN = Path(__file__).with_name("kitchen.st").read_text("utf-8")
Scans = list[tuple[int, dict[str, Any]]]


def rows(declared: str, body: str, scans: Scans, wrap: bool = False, more: str = "") -> list[Any]:
    """The output `y` after each scan; the terms give the same."""
    head = f"{more}\nFUNCTION_BLOCK B\nVAR_INPUT x : INT; in : BOOL; END_VAR\n{declared}"
    source = source_of(f"{head}\n{body}\nEND_FUNCTION_BLOCK\n")
    unit = source.main()
    check(source, unit)
    assert difference_of_translator(source, unit, 1, 12, wrap) == ""
    machine = Machine(source, unit, wrap)
    return [machine.scan({"x": 0, "in": False} | inputs, dt_ms)["y"] for dt_ms, inputs in scans]


def once(kind: str, value: str, declared: str = "", wrap: bool = False, **inputs: Any) -> Any:
    """The value of an expression of this type in one scan."""
    return rows(f"VAR_OUTPUT y : {kind}; END_VAR {declared}", f"y := {value};", [(1, inputs)], wrap)[0]


# ---------------------------------------------------------------- ranges


@pytest.mark.parametrize(
    ("kind", "low", "high"),
    [
        ("SINT", -128, 127),
        ("USINT", 0, 255),
        ("INT", -32768, 32767),
        ("UINT", 0, 65535),
        ("DINT", -(2**31), 2**31 - 1),
        ("UDINT", 0, 2**32 - 1),
        ("LINT", -(2**63), 2**63 - 1),
        ("ULINT", 0, 2**64 - 1),
    ],
)
def test_integers_stop_or_wrap_at_both_ends(kind: str, low: int, high: int) -> None:
    declared = f"VAR top : {kind} := {high}; bottom : {kind} := {low}; END_VAR"
    assert once(kind, f"top + {kind}#1", declared, wrap=True) == low
    assert once(kind, f"bottom - {kind}#1", declared, wrap=True) == high
    for value in (f"top + {kind}#1", f"bottom - {kind}#1"):
        with pytest.raises(Overflow, match=f"outside {kind}"):
            once(kind, value, declared)


def test_a_time_stops_or_wraps_after_24_days() -> None:
    declared = "VAR long : TIME := T#24d20h31m23s647ms; END_VAR"
    assert once("TIME", "long", declared) == 2**31 - 1
    assert once("TIME", "long + T#1ms", declared, wrap=True) == -(2**31)
    with pytest.raises(Overflow, match="outside TIME"):
        once("TIME", "long + T#1ms", declared)


def test_bit_strings_lose_what_is_shifted_out() -> None:
    assert once("WORD", "SHL(w, 4)", "VAR w : WORD := 16#F001; END_VAR") == 0x0010
    assert once("WORD", "ROL(w, 4)", "VAR w : WORD := 16#F001; END_VAR") == 0x001F
    assert once("WORD", "ROL(w, 20)", "VAR w : WORD := 16#F001; END_VAR") == 0x001F
    assert once("WORD", "SHR(NOT w, 15)", "VAR w : WORD := 16#F001; END_VAR") == 0
    assert once("BYTE", "WORD_TO_BYTE(w)", "VAR w : WORD := 16#1234; END_VAR") == 0x34


@pytest.mark.parametrize(
    ("name", "whole"), [("SHL", 0x1230), ("SHR", 0x0912), ("ROL", 0x1239), ("ROR", 0x3912)]
)
def test_a_shift_by_a_variable_stays_below_the_width(name: str, whole: int) -> None:
    declared = "VAR w : WORD := 16#9123; END_VAR"
    assert once("WORD", f"{name}(w, x)", declared, x=4) == whole
    assert once("WORD", f"{name}(w, x)", declared, x=0) == 0x9123
    for by in (-1, 16):
        with pytest.raises(Overflow, match=f"a shift by {by} is outside 0..15"):
            once("WORD", f"{name}(w, x)", declared, x=by)


def test_a_word_as_a_number_has_its_bits() -> None:
    assert once("INT", "WORD_TO_INT(w)", "VAR w : WORD := 16#FFFF; END_VAR") == -1
    assert once("DINT", "WORD_TO_DINT(w)", "VAR w : WORD := 16#FFFF; END_VAR") == 65535
    assert once("INT", "WORD_TO_INT(16#FFFF)") == -1
    assert once("INT", "BYTE_TO_INT(NOT 16#0F)") == 0xF0
    assert once("WORD", "INT_TO_WORD(x)", x=-2) == 0xFFFE


def test_the_smallest_number_has_no_opposite() -> None:
    for value in ("-x", "ABS(x)", "x / -1"):
        assert once("INT", value, wrap=True, x=-32768) == -32768
        with pytest.raises(Overflow, match="32768 is outside INT"):
            once("INT", value, x=-32768)


# ---------------------------------------------------------------- division, indexes, AND


@pytest.mark.parametrize("operator", ["/", "MOD"])
def test_a_divisor_of_zero_stops_even_where_numbers_wrap(operator: str) -> None:
    for wrap in (False, True):
        with pytest.raises(Overflow, match="division by zero"):
            once("INT", f"7 {operator} x", wrap=wrap)


def test_mod_has_the_sign_of_its_first_operand() -> None:
    assert [once("INT", "x MOD 3", x=x) for x in (-4, 4)] == [-1, 1]
    assert [once("INT", "x MOD -3", x=x) for x in (-4, 4)] == [-1, 1]


def test_and_looks_at_both_sides() -> None:
    with pytest.raises(Overflow, match="division by zero"):
        once("BOOL", "x <> 0 AND 10 / x > 1", x=0)
    with pytest.raises(Overflow, match="index 0 is outside"):
        once("BOOL", "x >= 1 AND list[x]", "VAR list : ARRAY [1..2] OF BOOL; END_VAR", x=0)


def test_both_values_of_a_choice_are_computed() -> None:
    with pytest.raises(Overflow, match="division by zero"):
        once("INT", "SEL(in, 1, 10 / x)", x=0)


@pytest.mark.parametrize(("number", "inside"), [(1, False), (2, True), (4, True), (5, False)])
@pytest.mark.parametrize("body", ["y := list[x];", "list[x] := 5; y := 1;"])
def test_an_index_is_inside_at_both_bounds(number: int, inside: bool, body: str) -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR list : ARRAY [2..4] OF INT; END_VAR"
    scans: Scans = [(1, {"x": number})]
    if inside:
        rows(declared, body, scans)
    else:
        with pytest.raises(Overflow, match=f"index {number} is outside 2..4"):
            rows(declared, body, scans)


# ---------------------------------------------------------------- loops, cases, calls


def test_a_loop_leaves_its_variable_one_step_further() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR i, s : INT; END_VAR"
    for header, sum, last in (
        ("1 TO 3", 6, 4),
        ("3 TO 1", 0, 3),
        ("3 TO 1 BY -1", 6, 0),
        ("1 TO 4 BY 2", 4, 5),
    ):
        body = f"s := 0; FOR i := {header} DO s := s + i; END_FOR y := s * 10 + i;"
        assert rows(declared, body, [(1, {})]) == [sum * 10 + last]


def test_the_first_case_that_fits_is_taken() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR"
    body = "CASE x OF 1..3: y := 1; 3, 5: y := 2; -2..-1: y := 3; ELSE y := 4; END_CASE"
    given: Scans = [(1, {"x": x}) for x in (0, 1, 3, 4, 5, -1, -2, -3)]
    assert rows(declared, body, given) == [4, 1, 1, 4, 2, 3, 3, 4]


def test_a_case_without_else_changes_nothing() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR"
    assert rows(declared, "CASE x OF 1: y := 7; END_CASE", [(1, {"x": 1}), (1, {"x": 2})]) == [7, 7]


def test_the_order_of_calls_counts() -> None:
    declared = "VAR_OUTPUT y : BOOL; END_VAR VAR edge : R_TRIG; END_VAR"
    given: Scans = [(1, {"in": True}), (1, {"in": True})]
    assert rows(declared, "edge(CLK := in); y := edge.Q;", given) == [True, False]
    assert rows(declared, "y := edge.Q; edge(CLK := in);", given) == [False, True]


def test_a_block_that_is_not_called_stands_still() -> None:
    declared = "VAR_OUTPUT y : TIME; END_VAR VAR t : TON; END_VAR"
    body = "IF x = 1 THEN t(IN := in, PT := T#1s); END_IF y := t.ET;"
    given: Scans = [(10, {"x": called, "in": True}) for called in (1, 1, 0, 0, 1)]
    assert rows(declared, body, given) == [0, 10, 10, 10, 40]


def test_an_input_of_a_block_keeps_its_value() -> None:
    declared = "VAR_OUTPUT y : BOOL; END_VAR VAR t : TON; END_VAR"
    body = "IF in THEN t(IN := TRUE, PT := T#5ms); END_IF t(); y := t.Q;"
    assert rows(declared, body, [(10, {"in": True}), (10, {"in": False})]) == [False, True]


def test_blocks_below_one_another_keep_their_own_memory() -> None:
    more = """FUNCTION_BLOCK Deep
VAR_INPUT up : BOOL; END_VAR VAR_OUTPUT n : INT; END_VAR VAR e : R_TRIG; END_VAR
e(CLK := up); IF e.Q THEN n := n + 1; END_IF END_FUNCTION_BLOCK
FUNCTION_BLOCK Middle VAR_INPUT up : BOOL; END_VAR VAR_OUTPUT n : INT; END_VAR VAR one, two : Deep; END_VAR
one(up := up); two(up := NOT up); n := 10 * one.n + two.n; END_FUNCTION_BLOCK"""
    declared = "VAR_OUTPUT y : INT; END_VAR VAR a, b : Middle; END_VAR"
    body = "a(up := in); IF in THEN b(up := in); END_IF y := 100 * a.n + b.n;"
    given: Scans = [(1, {"in": on}) for on in (False, True, False, True)]
    assert rows(declared, body, given, more=more) == [100, 1110, 1210, 2210]


def test_return_in_a_block_ends_only_that_block() -> None:
    more = """FUNCTION_BLOCK Inner VAR_INPUT in : BOOL; END_VAR VAR_OUTPUT n : INT; END_VAR
n := 1; IF in THEN RETURN; END_IF n := 2; END_FUNCTION_BLOCK"""
    declared = "VAR_OUTPUT y : INT; END_VAR VAR b : Inner; END_VAR"
    given: Scans = [(1, {"in": True}), (1, {"in": False})]
    assert rows(declared, "b(in := in); y := b.n * 10 + 5;", given, more=more) == [15, 25]


def test_a_temporary_array_begins_anew() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR_TEMP z : ARRAY [1..2] OF INT := [4, 5]; END_VAR"
    assert rows(declared, "z[1] := z[1] + z[2]; y := z[1];", [(1, {})] * 2) == [9, 9]


# ---------------------------------------------------------------- timers and memory


def timed(block: str, times: list[tuple[int, bool, int]]) -> list[tuple[bool, int]]:
    """Q and ET of a timer for rows of elapsed time, IN, and PT in ms."""
    declared = "VAR_OUTPUT y : DINT; END_VAR VAR_INPUT pt : TIME; END_VAR VAR t : " + block + "; END_VAR"
    body = "t(IN := in, PT := pt); y := 0; IF t.Q THEN y := 1000000; END_IF y := y + TIME_TO_DINT(t.ET);"
    given: Scans = [(dt, {"in": on, "pt": pt}) for dt, on, pt in times]
    return [(value >= 1000000, value % 1000000) for value in rows(declared, body, given)]


def test_a_timer_of_zero_ms_is_on_at_once() -> None:
    assert timed("TON", [(5, True, 0), (5, False, 0)]) == [(True, 0), (False, 0)]
    assert timed("TOF", [(5, True, 0), (5, False, 0)]) == [(True, 0), (False, 0)]
    assert timed("TP", [(5, True, 0), (5, True, 0)]) == [(False, 0), (False, 0)]


def test_a_timer_that_starts_on_does_not_wait_longer() -> None:
    assert timed("TON", [(50, True, 20), (19, True, 20), (1, True, 20)]) == [
        (False, 0),
        (False, 19),
        (True, 20),
    ]


def test_a_changed_time_counts_at_once() -> None:
    assert timed("TON", [(1, True, 50), (20, True, 50), (5, True, 10)]) == [
        (False, 0),
        (False, 20),
        (True, 10),
    ]


COUNT = "VAR_OUTPUT y : INT; END_VAR VAR i : INT; END_VAR i := 0; y := 0;"


def test_while_asks_before_each_turn_and_repeat_after() -> None:
    count = f"{COUNT} WHILE i < x DO i := i + 1; y := y + i; END_WHILE"
    assert rows(count, "", [(1, {"x": x}) for x in (0, 1, 4)]) == [0, 1, 10]
    count = f"{COUNT} REPEAT i := i + 1; y := y + i; UNTIL i >= x END_REPEAT"
    assert rows(count, "", [(1, {"x": x}) for x in (0, 1, 4)]) == [1, 1, 10]


@pytest.mark.parametrize(
    "loop", ["WHILE i < x DO i := i + 1; END_WHILE", "REPEAT i := i + 1; UNTIL i >= x END_REPEAT"]
)
def test_a_loop_must_end_after_32_turns(loop: str) -> None:
    most = 32 + loop.startswith("REPEAT")
    assert rows(f"{COUNT} {loop} y := i;", "", [(1, {"x": most})]) == [most]
    with pytest.raises(Overflow, match="the loop ends after 32 turns at most"):
        rows(f"{COUNT} {loop} y := i;", "", [(1, {"x": most + 1})])


def test_a_loop_in_which_nothing_ends_is_owed() -> None:
    source = source_of(f"FUNCTION_BLOCK B VAR_INPUT x : INT; END_VAR {COUNT} "
        "WHILE x > 0 DO y := 1; END_WHILE END_FUNCTION_BLOCK")  # fmt: skip
    memory = {slot.path: terms.symbol(slot.type, slot.path) for slot in slots(source, source.main())}
    owed = symbolic.Translator(source, source.main()).scan(memory, z3.Int("dt")).obligations
    assert [part.text for part in owed] == ["the loop ends after 32 turns at most"]
    assert z3.is_true(z3.simplify(z3.substitute(owed[0].formula, (memory["X"], z3.IntVal(0)))))
    assert z3.is_false(z3.simplify(z3.substitute(owed[0].formula, (memory["X"], z3.IntVal(1)))))


def test_a_pulse_is_not_started_again_while_it_lasts() -> None:
    given = [(5, True, 20), (5, False, 20), (5, True, 20), (5, True, 20), (5, True, 20)]
    assert [q for q, _ in timed("TP", given)] == [True, True, True, True, False]


def test_an_off_delay_begins_anew_with_each_edge() -> None:
    given = [(5, True, 20), (5, False, 20), (15, False, 20), (1, True, 20), (1, False, 20), (19, False, 20)]
    assert [q for q, _ in timed("TOF", given)] == [True] * 6
    assert timed("TOF", [*given, (1, False, 20)])[-1] == (False, 20)


def test_a_falling_edge_needs_a_scan_before() -> None:
    declared = "VAR_OUTPUT y : BOOL; END_VAR VAR t : F_TRIG; END_VAR"
    assert rows(
        declared, "t(CLK := in); y := t.Q;", [(1, {"in": on}) for on in (False, True, False, False)]
    ) == [
        False,
        False,
        True,
        False,
    ]


def test_set_wins_in_sr_and_reset_in_rs() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR s : SR; r : RS; END_VAR"
    body = "s(S1 := in, R := in); r(S := in, R1 := in); y := BOOL_TO_INT(s.Q1) + 2 * BOOL_TO_INT(r.Q1);"
    assert rows(declared, body, [(1, {"in": True}), (1, {"in": False})]) == [1, 1]


def test_what_is_retained_has_any_value_at_power_up() -> None:
    declared = "VAR_OUTPUT y : INT; END_VAR VAR RETAIN k : INT := 3; END_VAR VAR n : INT; END_VAR"
    source = source_of(f"FUNCTION_BLOCK B {declared} y := k + n; END_FUNCTION_BLOCK")
    initial = {slot.path: slot.initial for slot in slots(source, source.main())}
    assert initial == {"Y": 0, "K": None, "N": 0}


# ---------------------------------------------------------------- traps of the grammar


def test_every_name_of_a_list_is_declared() -> None:
    (unit,) = read_text(
        "FUNCTION_BLOCK B VAR a, b , c : BOOL := TRUE; END_VAR a := b; END_FUNCTION_BLOCK", "b.st"
    )
    assert {key: variable.initial for key, variable in unit.variables.items()} == {
        "A": True,
        "B": True,
        "C": True,
    }


@pytest.mark.parametrize(
    "body",
    [
        "y := 1; (* (* *) y := 2; // *)",
        "(* one (* two *) three *) y := 1;",
        "y := 1; (* // (* *)",
    ],
)
def test_a_comment_in_a_comment_is_refused(body: str) -> None:
    with pytest.raises(Unjudged, match=r"b\.st:2: "):
        read_text(f"FUNCTION_BLOCK B VAR_OUTPUT y : INT; END_VAR\n{body}\nEND_FUNCTION_BLOCK", "b.st")


@pytest.mark.parametrize(
    "body",
    [
        "y := 1",
        "y = 1;",
        "IF TRUE THEN y := 1;",
        "y := 1; END_IF",
        "y := (1;",
        "y := 1 2;",
        "VAR z : INT; y := 1;",
        "y := 16#G;",
    ],
)
def test_no_part_of_a_broken_text_is_read(body: str) -> None:
    text = f"FUNCTION_BLOCK B VAR_OUTPUT y : INT; END_VAR\n{body}\nEND_FUNCTION_BLOCK"
    with pytest.raises(Unjudged):
        source = source_of(text)
        check(source, source.main())


# ---------------------------------------------------------------- random programs, and planted slips


@pytest.mark.parametrize("seed", range(3))
def test_random_programs_do_the_same_as_terms(seed: int) -> None:
    assert difference_of_text(program(seed), seed, 12, wrap=bool(seed % 2)) == ""


@pytest.mark.deep
@pytest.mark.parametrize("seed", range(100, 108))
def test_more_random_programs_do_the_same_as_terms(seed: int) -> None:
    assert difference_of_text(program(seed), seed, 40, wrap=bool(seed % 2)) == ""


def timer(name: str, change: Callable[[str, dict[str, Any]], None]) -> Callable[..., None]:
    """The standard blocks, with one that does something else."""

    def wrong(block: str, path: str, env: dict[str, Any]) -> None:
        terms.standard_call(block, path, env)
        if block == name:
            change(path, env)

    return wrong


def put(pin: str, term: Callable[[Callable[[str], Any]], Any]) -> Callable[[str, dict[str, Any]], None]:
    """A change of one pin to a term over the pins."""
    return lambda path, env: env.__setitem__(f"{path}.{pin}", term(lambda name: env[f"{path}.{name}"]))


def late(self: Any, now: int, right: Any = run_standard.Standard.call) -> None:
    """A standard block whose clock runs within a scan."""
    self.since -= 1
    right(self, now)


def fresh(self: Any, now: int, right: Any = run_standard.Standard.call) -> None:
    """A standard block that forgets its input."""
    self.before = False
    right(self, now)


def short(kind: Any, term: Any, low: int, high: int) -> Any:
    """A range of CASE without its upper end."""
    return z3.And(term >= low, term < high) if low < high else term == low


BLOCKS: dict[str, tuple[str, str, Callable[[Callable[[str], Any]], Any]]] = {
    "TOF is off a scan early": ("TOF", "Q", lambda pin: z3.And(pin("Q"), pin("age") + 1 < pin("PT"))),
    "TP starts again": ("TP", "running", lambda pin: z3.BoolVal(False)),
    "ET is not limited": ("TON", "ET", lambda pin: z3.If(pin("IN"), pin("age"), 0)),
    "an edge in each scan": ("R_TRIG", "Q", lambda pin: pin("CLK")),
    "an edge in the first scan": ("F_TRIG", "Q", lambda pin: z3.Not(pin("CLK"))),
    "reset wins in SR": ("SR", "Q1", lambda pin: z3.And(pin("Q1"), z3.Not(pin("R")))),
}
SLIPS: dict[str, tuple[Any, str, Any]] = {
    **{
        name: (symbolic, "standard_call", timer(block, put(pin, term)))
        for name, (block, pin, term) in BLOCKS.items()
    },
    "division rounds down": (values, "truncated", lambda left, right: left / right),
    "a range without its upper end": (symbolic, "between", short),
    "the last branch is taken": (symbolic, "merge", lambda env, condition, yes, no: env.update(no)),
    "the element before": (values, "choose", lambda condition, yes, no: no),
    "nothing is owed": (symbolic.Translator, "owe", lambda self, formula, text, place: None),
    "temporary variables have no value": (symbolic, "singles", lambda kind, path, value: ()),
    "the clock runs within a scan": (run_standard.Standard, "call", late),
    "the interpreter forgets an input": (run_standard.Standard, "call", fresh),
}


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", SLIPS)
def test_a_planted_slip_is_noticed(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    module, attribute, wrong = SLIPS[name]
    monkeypatch.setattr(module, attribute, wrong)
    try:
        found = difference_of_text(KITCHEN, 1, 150)
    except (KeyError, AssertionError):  # a value that is not there
        found = "none" * (name == "temporary variables have no value")
    assert found != ""


def test_an_output_may_be_an_array() -> None:
    declared = "VAR_OUTPUT y : INT; z : ARRAY [1..2] OF INT; END_VAR"
    assert rows(declared, "z[2] := x; y := z[2];", [(1, {"x": 4})]) == [4]
