"""Walks from power-up through a merged graph.

Suite `tour` takes every transition (state and column) at least once. Suite `brief` takes from every state
every step to every next state once, with one column for each, and is much shorter.

Greedy: while the current state has a transition that was not taken, take it (those that stay in the state
come first); otherwise go a shortest way to the nearest state that has one, or start a new case when that is
shorter from power-up. Nothing here is random, so the same graph gives the same walks. The walks are not the
shortest possible.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass

from modeproof.graph.columns import Columns

CASE_SCANS = 400
"""A case of at least this length ends as soon as its state has nothing left to take."""

RESET_SCANS = 1
"""What a reset costs, in scans."""


@dataclass(frozen=True)
class Move:
    """One scan of a walk: in `state` an input of `column`."""

    state: int
    column: int


def every_transition(columns: Columns) -> list[list[int]]:
    """For each state all columns: what the suite `tour` must take."""
    return [list(range(len(row))) for row in columns.next_of]


def every_step(columns: Columns) -> list[list[int]]:
    """For each state one column for each step and next state: what the suite `brief` must take.

    Where several columns do, states choose different ones.
    """
    wanted = []
    for state, (steps, nexts) in enumerate(zip(columns.step_of, columns.next_of, strict=True)):
        groups: dict[tuple[int, int], list[int]] = {}
        for column, pair in enumerate(zip(steps, nexts, strict=True)):
            groups.setdefault(pair, []).append(column)
        wanted.append([group[state * 7 % len(group)] for group in groups.values()])
    return wanted


def walks(columns: Columns, initial: int, wanted: Sequence[Sequence[int]]) -> list[list[Move]]:
    """Walks from `initial`, each one a case, that take the wanted columns of every state."""
    return _Tour(columns, initial, wanted).walks()


class _Tour:
    def __init__(self, columns: Columns, initial: int, wanted: Sequence[Sequence[int]]) -> None:
        self.next_of = columns.next_of
        self.initial = initial
        self.by_next: list[dict[int, list[int]]] = []
        self.left: list[list[int]] = []
        for state, row in enumerate(columns.next_of):
            ways: dict[int, list[int]] = {}
            for column, after in enumerate(row):
                ways.setdefault(after, []).append(column)
            self.by_next.append(ways)
            # popped from the end: loops first, then the others in the order of the columns
            loops = [column for column in reversed(wanted[state]) if row[column] == state]
            others = [column for column in reversed(wanted[state]) if row[column] != state]
            self.left.append(others + loops)
        self.turn: dict[tuple[int, int], int] = {}
        self.trees: dict[int, tuple[array[int], list[int]]] = {}
        self.near: dict[int, int] = {}

    def walks(self) -> list[list[Move]]:
        cases: list[list[Move]] = []
        walk: list[Move] = []
        state = self.initial
        while True:
            while self.left[state]:
                column = self.left[state].pop()
                walk.append(Move(state, column))
                state = self.next_of[state][column]
            here = self._way_to_nearest(state)
            fresh = self._way_to_nearest(self.initial)
            if fresh is None and here is None:
                break
            nearer = fresh is not None and here is not None and len(fresh) + RESET_SCANS < len(here)
            if here is None or nearer or len(walk) >= CASE_SCANS:
                if fresh is None:
                    break
                cases.append(walk)
                walk, state, here = [], self.initial, fresh
            for after in here:
                walk.append(Move(state, self._column(state, after)))
                state = after
        if walk:
            cases.append(walk)
        return [case for case in cases if case]

    def _column(self, state: int, after: int) -> int:
        """A column that leads from `state` to `after`; the possible ones take turns."""
        ways = self.by_next[state][after]
        turn = self.turn.get((state, after), 0)
        self.turn[state, after] = turn + 1
        return ways[turn % len(ways)]

    def _way_to_nearest(self, state: int) -> list[int] | None:
        """The states on a shortest way to the nearest state with something left; None when there is none."""
        before, order = self._tree(state)
        at = self.near.get(state, 0)
        while at < len(order) and not self.left[order[at]]:
            at += 1
        self.near[state] = at
        if at == len(order):
            return None
        way = []
        to = order[at]
        while to != state:
            way.append(to)
            to = before[to]
        return way[::-1]

    def _tree(self, root: int) -> tuple[array[int], list[int]]:
        """Breadth-first tree from `root`: the state before each state, and all states by distance."""
        if root not in self.trees:
            before = array("l", [-1]) * len(self.next_of)
            before[root] = root
            order = [root]
            for state in order:
                for after in self.by_next[state]:
                    if before[after] == -1:
                        before[after] = state
                        order.append(after)
            self.trees[root] = (before, order)
        return self.trees[root]


def covers(
    columns: Columns, initial: int, wanted: Sequence[Sequence[int]], cases: Sequence[Sequence[Move]]
) -> bool:
    """Whether the cases begin in `initial`, hang together, and take all that is wanted."""
    left = {(state, column) for state, row in enumerate(wanted) for column in row}
    for case in cases:
        state = initial
        for move in case:
            if move.state != state:
                return False
            left.discard((state, move.column))
            state = columns.next_of[state][move.column]
    return not left
