"""Operations on 16-bit words as solver terms: counting bits, taking bytes apart, rotating."""

from collections.abc import Iterable

import z3

BITS = 16


def word(name: str) -> z3.BitVecRef:
    """A free 16-bit word."""
    return z3.BitVec(name, BITS)


def constant(value: int) -> z3.BitVecRef:
    """The word with this value, 0..65535; -1 is FFFFH."""
    return z3.BitVecVal(value, BITS)


def one_of(term: z3.BitVecRef, values: Iterable[int]) -> z3.BoolRef:
    """The word is one of the values."""
    return z3.Or(*[term == value for value in values])


def ones(term: z3.BitVecRef) -> z3.BitVecRef:
    """The number of ones, as a word; neighbours are added in pairs, each time one bit wider."""
    counts = [z3.Extract(i, i, term) for i in range(BITS)]
    while len(counts) > 1:
        wider = [z3.ZeroExt(1, count) for count in counts]
        counts = [left + right for left, right in zip(wider[::2], wider[1::2], strict=True)]
    return z3.ZeroExt(BITS - counts[0].size(), counts[0])


def high(term: z3.BitVecRef) -> z3.BitVecRef:
    """The high byte; of flag word MWn it is memory byte n."""
    return z3.Extract(15, 8, term)


def low(term: z3.BitVecRef) -> z3.BitVecRef:
    """The low byte; of flag word MWn it is memory byte n+1."""
    return z3.Extract(7, 0, term)


def rotated_left(term: z3.BitVecRef, count: z3.BitVecRef) -> z3.BitVecRef:
    """Rotated to the left by 0..15 bits."""
    return (term << count) | z3.LShR(term, BITS - count)
