"""The four ranges of Table 2 as solver terms, taken from the shipped `encode` and `decode` path by path."""

from collections.abc import Callable
from typing import Final

import z3

from proofs.explorer.explore import explore
from proofs.explorer.values import Word
from proofs.words import constant, one_of, word
from refimpl.mode_selection import code_tables

FLAG_WORD: Final = {"RE": "MW01", "SE": "MW03", "CH": "MW05", "SW": "MW07"}
"""Each range with its flag word; the bus variable beside it uses the same range."""

MODES: Final = (0, 1, 2, 3, 4)
NO_PATH: Final = 0x7FFF
"""The value of a term where no path of the code applies; no mode and no code word, so that a claim on it
fails.
"""


def codes(name: str) -> tuple[int, ...]:
    """The shipped range: five words, the position is the mode."""
    table: tuple[int, ...] = getattr(code_tables, name)
    return table


def accepted(name: str) -> tuple[int, ...]:
    """The words that the reader of this range does not refuse: zero (nothing is said) and the five codes."""
    return (code_tables.ZERO, *codes(name))


def mode_of(name: str, term: z3.BitVecRef) -> z3.BitVecRef:
    """The mode that the shipped `decode` reads from the word in this range; FFFFH (-1) when it is none of
    its codes.
    """
    return mode_by(codes(name), term)


def mode_by(table: tuple[int, ...], term: z3.BitVecRef) -> z3.BitVecRef:
    """As `mode_of`, for a table given by its five words."""
    return _term(code_tables.decode, table, Word(term))


def word_of(name: str, mode: z3.BitVecRef) -> z3.BitVecRef:
    """The word that the shipped `encode` writes for the mode, zero for none (FFFFH)."""
    return _term(code_tables.encode, codes(name), Word(mode, signed=True))


def is_code(name: str, term: z3.BitVecRef) -> z3.BoolRef:
    """The word means a mode in this range, by the shipped `decode`."""
    return mode_of(name, term) != code_tables.NONE


def is_accepted(name: str, term: z3.BitVecRef) -> z3.BoolRef:
    """The word is zero or means a mode in this range."""
    return z3.Or(term == code_tables.ZERO, is_code(name, term))


def free_mode(name: str) -> tuple[z3.BitVecRef, z3.BoolRef]:
    """A free mode and the premise that it is one of 0..4."""
    term = word(name)
    return term, one_of(term, MODES)


def _term(
    function: Callable[[tuple[int, ...], int], int], table: tuple[int, ...], symbol: Word
) -> z3.BitVecRef:
    """The function as one term: its result on each path, `NO_PATH` elsewhere and where it raises."""
    term: z3.BitVecRef = constant(NO_PATH)
    for path in explore(function, (table, symbol)).paths:
        if path.raised is None:
            term = z3.If(path.condition, constant(path.result), term)
    return term
