"""Words as numbers: what is said back over words is true of the same words, or it is not said."""

from __future__ import annotations

import itertools
from typing import Any

import pytest
import z3

from programs.invariants.induction import System
from programs.invariants.word_numbers import NoNumbers, Numbers, spacer_over_numbers

A, B = z3.BitVec("a", 2), z3.BitVec("b", 2)
COMPARED = ("==", "<=", "<", ">=", ">")


def compared(sign: str, left: Any, right: Any) -> Any:
    return {
        "==": left == right,
        "<=": left <= right,
        "<": left < right,
        ">=": left >= right,
        ">": left > right,
    }[sign]


@pytest.mark.parametrize("sign", COMPARED)
def test_what_is_said_back_is_true_of_the_same_words(sign: str) -> None:
    numbers, said = Numbers(), 0
    a, b = numbers.forth(A), numbers.forth(B)
    for more in range(-5, 6):
        for left in (a, -1 * a, a + -1 * b, b - a, a - b + 1, 2 * a - a):
            over_numbers = z3.Not(compared(sign, left, z3.IntVal(more)))
            try:
                over_words = numbers.back(over_numbers)
            except NoNumbers:
                continue
            said += 1
            for x, y in itertools.product(range(4), repeat=2):
                one = z3.substitute(over_numbers, (a, z3.IntVal(x)), (b, z3.IntVal(y)))
                other = z3.substitute(over_words, (A, z3.BitVecVal(x, 2)), (B, z3.BitVecVal(y, 2)))
                assert z3.simplify(one).eq(z3.simplify(other)), (over_numbers, x, y)
    assert said > 30


def relay(add: int) -> tuple[System, z3.BoolRef]:
    """A word goes over two places, `add` more each time; bad: the second was never the input or zero."""
    word = {name: z3.BitVec(name, 16) for name in ("first", "second", "seen", "given")}
    turn = z3.Int("turn")
    given, first = word["given"], word["first"]
    state = {**{name: word[name] for name in ("first", "second", "seen")}, "turn": turn}
    zero = z3.BitVecVal(0, 16)
    after = {
        "first": z3.If(turn == 0, given, first),
        "second": z3.If(turn == 1, first + add if add else first, word["second"]),
        "seen": z3.If(turn == 0, given, word["seen"]),
        "turn": z3.If(turn == 0, z3.IntVal(1), z3.IntVal(0)),
    }
    start = {"first": zero, "second": zero, "seen": zero, "turn": z3.IntVal(0)}
    true = z3.BoolVal(True)
    system = System(state, {"given": given}, start, after, true, true, z3.And(turn >= 0, turn <= 1))
    return system, z3.And(turn == 0, word["second"] != word["seen"])


def test_an_invariant_over_numbers_is_one_over_words() -> None:
    system, bad = relay(0)
    proof = spacer_over_numbers(system, bad, [], 60)
    assert proof is not None and "numbers" in proof.by


def test_a_word_that_is_calculated_with_is_no_number() -> None:
    system, bad = relay(1)
    with pytest.raises(NoNumbers):
        Numbers().system(system)
    assert spacer_over_numbers(system, bad, [], 60) is None
