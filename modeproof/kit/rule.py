"""Cases that are not stored but made while they are judged, from a table and a rule in the header.

A graph of the header has under `rule`: `letters` (each time, inputs, column), the first `sub` of which are
the sub-alphabet; for each state the `next` state and the `step` by letter, its `rows` of outputs, the letters
of the way to it under `cover` (null for a state that has no part in this), and under `identify` sequences of
letters. A case goes the way to a state, takes none, one or two letters of the sub-alphabet, and then one of
the sequences of the state that it has come to. That is all of them, in this order, each once.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Any

STEPS = 2
"""So many letters of the sub-alphabet at most: one more than the states that a program may have besides."""
Word = tuple[int, ...]


def words(rule: Mapping[str, Any]) -> Iterator[Word]:
    """Every case as letters."""
    nexts, identify = rule["next"], rule["identify"]
    letters = range(rule["sub"])
    made: set[Word] = set()
    for state, way in enumerate(rule["cover"]):
        if way is None:
            continue
        for length in range(STEPS + 1):
            for middle in itertools.product(letters, repeat=length):
                after = state
                for letter in middle:
                    after = nexts[after][letter]
                for sequence in identify[after]:
                    word = (*way, *middle, *sequence)
                    if word not in made:
                        made.add(word)
                        yield word


class Table:
    """Makes the scans of words; what repeats is made once."""

    def __init__(self, rule: Mapping[str, Any], initial: int) -> None:
        self._rule, self._initial = rule, initial
        self._known: dict[tuple[int, int], tuple[Any, ...]] = {}

    def scans(self, word: Word) -> list[tuple[Any, ...]]:
        """For each letter: time, inputs, outputs, step, state after it, column."""
        state, found = self._initial, []
        for letter in word:
            key = (state, letter)
            if key not in self._known:
                self._known[key] = self._scan(state, letter)
            one = self._known[key]
            found.append(one)
            state = one[4]
        return found

    def _scan(self, state: int, letter: int) -> tuple[Any, ...]:
        rule = self._rule
        dt_ms, inputs, column = rule["letters"][letter]
        after = rule["next"][state][letter]
        outputs = dict(rule["rows"][after])
        for output, given in rule["passed"].items():
            outputs[output] = inputs[given]
        return dt_ms, inputs, outputs, rule["step"][state][letter], after, column
