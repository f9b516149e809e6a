"""Inputs that tell two states of a graph apart by outputs: partition refinement, then the way back down."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from modeproof.graph.columns import Columns


class Apart:
    """Knows for every two states a shortest sequence of columns after which their outputs differ.

    `rows` gives what can be seen of each state. `rounds` holds the partition after sequences of each length;
    in the last one two states share a number exactly when no sequence tells them apart.
    """

    def __init__(self, columns: Columns, rows: Sequence[Hashable]) -> None:
        self._next = columns.next_of
        numbers: dict[Hashable, int] = {}
        self.rounds = [[numbers.setdefault(row, len(numbers)) for row in rows]]
        while True:
            before = self.rounds[-1]
            finer: dict[Hashable, int] = {}
            now = [
                finer.setdefault((before[state], tuple([before[after] for after in row])), len(finer))
                for state, row in enumerate(self._next)
            ]
            if len(finer) == len(set(before)):
                return
            self.rounds.append(now)

    def sequence(self, state: int, other: int) -> tuple[int, ...] | None:
        """Columns after which the outputs differ; empty when they differ already, None when they never do."""
        if self.rounds[-1][state] == self.rounds[-1][other]:
            return None
        found: list[int] = []
        while self.rounds[0][state] == self.rounds[0][other]:
            level = next(n for n, part in enumerate(self.rounds) if part[state] != part[other])
            finer = self.rounds[level - 1]
            rows = zip(self._next[state], self._next[other], strict=True)
            column = next(c for c, (a, b) in enumerate(rows) if finer[a] != finer[b])
            found.append(column)
            state, other = self._next[state][column], self._next[other][column]
        return tuple(found)
