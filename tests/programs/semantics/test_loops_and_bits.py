"""Loops that end early, and bits of words: by hand, and against the translator."""

from __future__ import annotations

from typing import Any

import pytest
import z3

from programs.language.tree import Bit
from programs.semantics import translator as symbolic
from programs.semantics import translator_expressions as values
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Overflow
from programs.semantics.translator import Left
from tests.programs.fuzz import difference_of_text, source_of
from tests.programs.small_blocks import END, HEAD, INT, given

# ---------------------------------------------------------------- loops


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (
            "n := 0; FOR i := 1 TO 5 DO IF i = x THEN EXIT; END_IF n := n + i; END_FOR y := n * 10 + i;",
            [33, 156],
        ),
        (
            "n := 0; FOR i := 1 TO 5 DO IF i = x THEN CONTINUE; END_IF n := n + i; END_FOR y := n * 10 + i;",
            [126, 156],
        ),
        ("y := 0; FOR i := 1 TO 5 DO IF i = x THEN RETURN; END_IF y := y + i; END_FOR y := 99;", [3, 99]),
        (
            "n := 0; i := 0; WHILE i < 5 DO i := i + 1; IF i = x THEN EXIT; END_IF n := i; END_WHILE y := n;",
            [2, 5],
        ),
        (
            "y := 0; i := 0; WHILE i < 5 DO i := i + 1; IF i = x THEN CONTINUE; END_IF y := y + 1; END_WHILE",
            [4, 5],
        ),
        (
            "y := 0; i := 0; REPEAT i := i + 1; IF i=x THEN CONTINUE; END_IF y := i; UNTIL i > 2 END_REPEAT",
            [2, 3],
        ),
        ("i := 0; REPEAT i := i + 1; IF i = x THEN RETURN; END_IF y := i; UNTIL i >= 5 END_REPEAT", [2, 5]),
        (
            "n := 0; FOR i := 1 TO 3 DO WHILE TRUE DO n := n + 1; EXIT; END_WHILE END_FOR y := n * 10 + i;",
            [34, 34],
        ),
        ("y := 7; FOR i := 1 TO 3 DO CONTINUE; y := 8; END_FOR", [7, 7]),
    ],
)
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
        (
            "VAR_OUTPUT y : BOOL; END_VAR VAR w : WORD; END_VAR",
            "w := INT_TO_WORD(x); y := w.3;",
            [False, True, True],
        ),
        (
            "VAR_OUTPUT y : BOOL; END_VAR VAR w : WORD; END_VAR",
            "w := INT_TO_WORD(x); y := w.%X15;",
            [False, False, True],
        ),
        (
            "VAR_OUTPUT y : WORD; END_VAR",
            "y := 16#FFFF; y.0 := x = 0; y.15 := x = 8;",
            [0x7FFF, 0xFFFE, 0x7FFE],
        ),
        (
            "VAR_OUTPUT y : BYTE; END_VAR VAR a : ARRAY [0..1] OF BYTE; END_VAR",
            "a[1].7 := x = 8; y := a[1];",
            [0, 128, 0],
        ),
        ("VAR_OUTPUT y : LWORD; END_VAR", "y.63 := x = 8; y.1 := TRUE;", [2, 2 + 2**63, 2]),
        ("VAR_OUTPUT y : WORD; END_VAR VAR r : R_TRIG; END_VAR", "r(CLK := x = 8, Q => y.4);", [0, 16, 0]),
    ],
)
def test_a_bit_is_read_and_written(declared: str, body: str, expected: list[Any]) -> None:
    assert given(declared, body, [{"x": 0}, {"x": 8}, {"x": -1}]) == expected


def test_a_bit_beside_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    right = values.Context.assign

    def wrong(self: Any, target: Any, term: Any, env: Any, here: Any) -> None:
        moved = Bit(target.of, target.number ^ 1, target.place) if isinstance(target, Bit) else target
        right(self, moved, term, env, here)

    monkeypatch.setattr(values.Context, "assign", wrong)
    text = f"{HEAD}VAR_OUTPUT y : WORD; END_VAR y.6 := in;{END}"
    assert " the term gives " in difference_of_text(text, 1, 20)
