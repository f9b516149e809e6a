"""Suite `wp`: every transition, and after it inputs that tell the state that it led to from all others.

A program with at most n states that treats all inputs of a column alike and passes is equal to the graph, n
being the number of states of the graph that outputs can tell apart. Why:

1. To each state q of the graph leads a shortest way. After it come, from power-up, the sequences that tell q
   from every other state, and those that tell the others from q. So the program has a state of its own for
   each way; and by n these are all that it has.
2. For the transitions that later cases go along, a case goes the way to q, takes the column, and then each
   of the sequences of the state q' that must come. The program's state answers these like none but the state
   at the end of the way to q'; so by 1 it is that one.
3. Every other transition into a state that one sequence tells from all others is taken in a walk along
   transitions of 2, or along those that were found right in this way before; and the sequence follows it.
4. The transitions into other states are taken in rounds, one for each sequence of the state, each round in
   the same order. What a walk rests on was taken before in the same order, so that the first is found right
   by itself, and each other one by those before it.

So every transition leads where it must. `modeproof vectors lint` does this reasoning again, from the file
alone (modeproof.suites.complete).
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Hashable, Iterator, Sequence

from modeproof.graph.columns import Columns
from modeproof.suites.identify import Identifiers, Machine, Word, machine, separating_columns
from modeproof.suites.tour import CASE_SCANS, RESET_SCANS, Move

Left = list[list[int]]
"""For each state the columns that are still to be taken, the next one last."""


def walks(columns: Columns, initial: int, rows: Sequence[Hashable]) -> list[list[Move]]:
    """The cases of the suite for one graph; `rows` are the outputs of its states."""
    cases = []
    for word in words(machine(columns, rows, initial)):
        state = initial
        case = []
        for column in word:
            case.append(Move(state, column))
            state = columns.next_of[state][column]
        cases.append(case)
    return cases


def words(of: Machine) -> list[Word]:
    """The cases as sequences of columns from power-up."""
    return _Build(of).words()


class _Build:
    def __init__(self, of: Machine) -> None:
        self.of = of
        self.identify = Identifiers(of, separating_columns(of)).words
        most = max(map(len, self.identify))
        self.by_number = [
            [state for state, sequences in enumerate(self.identify) if len(sequences) == number]
            for number in range(1, most + 1)
        ]
        self.used = self._used()
        self.ways: list[dict[int, list[int]]] = []
        for row, used in zip(of.next_of, self.used, strict=True):
            ways: dict[int, list[int]] = {}
            for column in sorted(used):
                ways.setdefault(row[column], []).append(column)
            self.ways.append(ways)
        self.turn: dict[tuple[int, int], int] = {}
        self.trees: dict[int, tuple[array[int], list[int]]] = {}

    def _used(self) -> list[set[int]]:
        """For each state the columns that walks go along: in sequences of its own, and one to each state."""
        of = self.of
        used: list[set[int]] = [set() for _ in of.next_of]
        for way in of.cover[1:]:
            used[of.after(0, way[:-1])].add(way[-1])
        for first, sequences in enumerate(self.identify):
            for word in sequences:
                state = first
                for column in word:
                    used[state].add(column)
                    state = of.next_of[state][column]
        for row, chosen in zip(of.next_of, used, strict=True):
            reached = {row[column] for column in chosen}
            for column, after in enumerate(row):
                if after not in reached:
                    reached.add(after)
                    chosen.add(column)
        return used

    def words(self) -> list[Word]:
        every = [*_longest(self._from_power_up()), *self._once(), *self._in_rounds()]
        return [word for word in dict.fromkeys(every) if word]

    # ------------------------------------------------------------------------------------ from power-up

    def _from_power_up(self) -> Iterator[Word]:
        of = self.of
        for state, way in enumerate(of.cover):
            for word in self._answers(state):
                yield (*way, *word)
            for column in self.used[state]:
                yield (*way, column)
                for word in self.identify[of.next_of[state][column]]:
                    yield (*way, column, *word)

    def _answers(self, state: int) -> set[Word]:
        """Its own sequences, and those sequences of each other state that tell the two apart."""
        of = self.of
        found = {word[:n] for word in self.identify[state] for n in range(1, len(word) + 1)}
        for sequences in self.by_number:
            for other in sequences:
                if other != state:
                    needed = [
                        word[:length]
                        for word in self.identify[other]
                        if (length := of.apart_at(other, state, word))
                    ]
                    if found.isdisjoint(needed):
                        found.update(needed[0][:n] for n in range(1, len(needed[0]) + 1))
        return found

    # ------------------------------------------------------------------------------------------- walks

    def _left(self, wanted: Callable[[int], bool]) -> Left:
        return [
            [c for c in reversed(self.of.columns) if c not in used and wanted(len(self.identify[row[c]]))]
            for row, used in zip(self.of.next_of, self.used, strict=True)
        ]

    def _once(self) -> list[Word]:
        """Walks with the transitions into states that need one sequence at most."""
        walk = _Walk(self)

        def take(state: int, column: int) -> None:
            after = self.of.next_of[state][column]
            walk.go(column, *[c for word in self.identify[after] for c in word])
            self.ways[state].setdefault(after, []).append(column)

        walk.nearest(self._left(lambda needed: needed <= 1), take)
        return walk.cases

    def _in_rounds(self) -> list[Word]:
        """Walks with the other transitions, a round for each of their sequences, always in one order."""
        order: list[tuple[int, int]] = []
        walk = _Walk(self)

        def take(state: int, column: int) -> None:
            order.append((state, column))
            walk.go(column, *self.identify[self.of.next_of[state][column]][0])

        walk.nearest(self._left(lambda needed: needed > 1), take)
        cases = walk.cases
        turn = 1
        while order:
            order = [
                transition
                for transition in order
                if len(self.identify[self.of.next_of[transition[0]][transition[1]]]) > turn
            ]
            walk = _Walk(self)
            for state, column in order:
                walk.go_to(state)
                walk.go(column, *self.identify[self.of.next_of[state][column]][turn])
            walk.end()
            cases += walk.cases
            turn += 1
        return cases

    def column(self, state: int, after: int) -> int:
        """A column found right that leads from `state` to `after`; those that do take turns."""
        ways = self.ways[state][after]
        turn = self.turn.get((state, after), 0)
        self.turn[state, after] = turn + 1
        return ways[turn % len(ways)]

    def tree(self, root: int) -> tuple[array[int], list[int]]:
        """Breadth-first tree from `root`: the state before each state, and all states by distance."""
        if root not in self.trees:
            before = array("l", [-1]) * len(self.of.next_of)
            before[root] = root
            order = [root]
            for state in order:
                for after in self.ways[state]:
                    if before[after] == -1:
                        before[after] = state
                        order.append(after)
            self.trees[root] = (before, order)
        return self.trees[root]


class _Walk:
    """Cases while they are made: `word` is the one that has begun, `state` where it is."""

    def __init__(self, build: _Build) -> None:
        self.build = build
        self.cases: list[Word] = []
        self.word: list[int] = []
        self.state = 0

    def go(self, *columns: int) -> None:
        """Take these columns."""
        self.word += columns
        self.state = self.build.of.after(self.state, columns)

    def end(self) -> None:
        """End the case and begin another one."""
        self.cases.append(tuple(self.word))
        self.word, self.state = [], 0

    def go_to(self, state: int) -> None:
        """Go a shortest way to a state, from here or from power-up, whichever is shorter."""
        here, fresh = self._way(self.state, state), self._way(0, state)
        assert fresh is not None, "every state can be reached"
        if here is None or len(self.word) >= CASE_SCANS or len(fresh) + RESET_SCANS < len(here):
            self.end()
            here = fresh
        for after in here:
            self.go(self.build.column(self.state, after))

    def nearest(self, left: Left, take: Callable[[int, int], None]) -> None:
        """Take all that is left, always the nearest."""
        near: dict[int, int] = {}

        def found(root: int) -> int | None:
            order = self.build.tree(root)[1]
            at = near.get(root, 0)
            while at < len(order) and not left[order[at]]:
                at += 1
            near[root] = at
            return order[at] if at < len(order) else None

        while True:
            while left[self.state]:
                take(self.state, left[self.state].pop())
            here, fresh = found(self.state), found(0)
            if fresh is None:
                break
            if here is None or self._distance(0, fresh) + RESET_SCANS < self._distance(self.state, here):
                self.end()
                here = fresh
            self.go_to(here)
        self.end()

    def _distance(self, root: int, to: int) -> int:
        way = self._way(root, to)
        return len(way or ())

    def _way(self, root: int, to: int) -> list[int] | None:
        before = self.build.tree(root)[0]
        if before[to] == -1:
            return None
        way = []
        while to != root:
            way.append(to)
            to = before[to]
        return way[::-1]


def _longest(found: Iterator[Word]) -> list[Word]:
    """The words without those that are the beginning of another word."""
    every = sorted(set(found))
    return [
        word
        for word, following in zip(every, [*every[1:], ()], strict=True)
        if following[: len(word)] != word
    ]
