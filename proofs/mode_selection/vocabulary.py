"""Words, modes, levels and the outputs of the EKS as solver terms, for sentences about the four devices."""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.ends import FALSE
from proofs.mode_selection.ranges import codes
from proofs.words import constant

LEVELS: Final = range(5)
NONE: Final = -1

# ---------------------------------------------------------------- words and modes


def code(name: str, mode: z3.ArithRef) -> z3.BitVecRef:
    """The word of the mode in a range of Table 2; zero for none."""
    if z3.is_int_value(mode):
        known = mode.as_long()
        return constant(codes(name)[known] if known in LEVELS else 0)
    term: z3.BitVecRef = constant(0)
    for number, word in enumerate(codes(name)):
        term = z3.If(mode == number, constant(word), term)
    return term


def mode(name: str, word: z3.BitVecRef) -> z3.ArithRef:
    """The mode that the word means in a range of Table 2; -1 for none."""
    if z3.is_bv_value(word):
        known, listed = word.as_long(), codes(name)
        return z3.IntVal(listed.index(known) if known in listed else NONE)
    term: z3.ArithRef = z3.IntVal(NONE)
    for number, known in enumerate(codes(name)):
        term = z3.If(word == constant(known), z3.IntVal(number), term)
    return term


def permits(params: Any, level: z3.ArithRef, selected: z3.ArithRef) -> z3.BoolRef:
    """This machine permits the mode to the level; none permits nothing. EKS-T2-2, E-47"""
    if z3.is_int_value(level):
        return _permits_own(params, level.as_long(), selected)
    return z3.Or(*[z3.And(level == own, _permits_own(params, own, selected)) for own in LEVELS])


def _permits_own(params: Any, level: int, selected: z3.ArithRef) -> z3.BoolRef:
    if level not in LEVELS:
        return FALSE
    row = getattr(params, f"PERMITS_{level}")
    if z3.is_int_value(selected):
        known = selected.as_long()
        return row[known] if known in LEVELS else FALSE
    return z3.Or(*[z3.And(selected == number, row[number]) for number in range(level + 1)])


def is_mode(term: z3.ArithRef) -> z3.BoolRef:
    """One of the five modes or levels."""
    return z3.And(term >= 0, term <= LEVELS[-1])


# ---------------------------------------------------------------- the five outputs of the EKS


def vector(record: Any) -> tuple[z3.BoolRef, ...]:
    """The outputs of the EKS by level."""
    return record.A, record.B, record.C, record.D, record.STR


def only(flags: tuple[z3.BoolRef, ...], level: int) -> z3.BoolRef:
    """This output is set and no other."""
    return z3.And(*[flag if number == level else z3.Not(flag) for number, flag in enumerate(flags)])


def only_of(flags: tuple[z3.BoolRef, ...], level: z3.ArithRef) -> z3.BoolRef:
    """The output of the level is set and no other."""
    return z3.Or(*[z3.And(level == number, only(flags, number)) for number in LEVELS])


def one_set(flags: tuple[z3.BoolRef, ...]) -> z3.BoolRef:
    """Exactly one output is set."""
    return z3.Or(*[only(flags, level) for level in LEVELS])


def none_set(flags: tuple[z3.BoolRef, ...]) -> z3.BoolRef:
    """No output is set."""
    return z3.Not(z3.Or(*flags))


def all_set(flags: tuple[z3.BoolRef, ...]) -> z3.BoolRef:
    """All five outputs are set."""
    return z3.And(*flags)


def several_set(flags: tuple[z3.BoolRef, ...]) -> z3.BoolRef:
    """Two outputs or more are set."""
    return z3.Or(*[z3.And(flags[a], flags[b]) for a in LEVELS for b in LEVELS if a < b])
