"""Finds sequences of inputs that identify a state of a graph by the outputs.

Everything here reads a graph as a program is seen from outside: a scan goes in, outputs come out. What a
state shows of itself before the next scan counts for nothing, so that a program is covered whose outputs
belong to the scan and not to the state (a Mealy machine). States that no sequence tells apart count as one.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from modeproof.graph.columns import Columns
from modeproof.ground.errors import Unjudged

LONGEST = 4
"""A single sequence that tells one state from all others is looked for up to this length."""

Word = tuple[int, ...]
"""A sequence of columns."""


@dataclass(frozen=True)
class Machine:
    """What can be seen of a graph from outside, with states that nothing tells apart taken as one.

    `number_of[s]` is the number of state s of the graph; 0 is that of power-up. From state q an input of
    column c leads to `next_of[q][c]` with the outputs `out_of[q][c]` (numbers of rows of outputs).
    """

    number_of: tuple[int, ...]
    next_of: tuple[tuple[int, ...], ...]
    out_of: tuple[tuple[int, ...], ...]

    @property
    def columns(self) -> range:
        """All columns."""
        return range(len(self.next_of[0]))

    def after(self, state: int, word: Sequence[int]) -> int:
        """The state after these columns."""
        for column in word:
            state = self.next_of[state][column]
        return state

    def apart_at(self, state: int, other: int, word: Sequence[int]) -> int:
        """After how many columns of `word` the outputs of two states differ; 0 when they never do."""
        for length, column in enumerate(word, 1):
            if self.out_of[state][column] != self.out_of[other][column]:
                return length
            state, other = self.next_of[state][column], self.next_of[other][column]
        return 0

    @cached_property
    def cover(self) -> tuple[Word, ...]:
        """For each state a shortest sequence of columns from power-up; beginnings of these are among them."""
        ways: dict[int, Word] = {0: ()}
        queue = deque([0])
        while queue:
            state = queue.popleft()
            for column, after in enumerate(self.next_of[state]):
                if after not in ways:
                    ways[after] = (*ways[state], column)
                    queue.append(after)
        return tuple(ways[state] for state in range(len(self.next_of)))


def machine(columns: Columns, rows: Sequence[Hashable], initial: int) -> Machine:
    """Read a graph from outside; `rows` are the outputs of its states."""
    numbers: dict[Hashable, int] = {}
    row = [numbers.setdefault(outputs, len(numbers)) for outputs in rows]
    every = range(len(columns.members))
    classes = _classes(columns.next_of, row, every, [0] * len(row))
    first: dict[int, int] = {classes[initial]: 0}
    members = [initial]
    for state in members:
        for after in columns.next_of[state]:
            if classes[after] not in first:
                first[classes[after]] = len(members)
                members.append(after)
    return Machine(
        number_of=tuple(first[number] for number in classes),
        next_of=tuple(
            tuple(first[classes[after]] for after in columns.next_of[member]) for member in members
        ),
        out_of=tuple(tuple(row[after] for after in columns.next_of[member]) for member in members),
    )


def _classes(
    next_of: Sequence[Sequence[int]], row: Sequence[int], chosen: Sequence[int], start: list[int]
) -> list[int]:
    """Numbers that two states share exactly when no sequence of `chosen` columns tells them apart."""
    now = start
    while True:
        finer: dict[Hashable, int] = {}
        following = [
            finer.setdefault((now[state], *[(row[after[c]], now[after[c]]) for c in chosen]), len(finer))
            for state, after in enumerate(next_of)
        ]
        if len(finer) == len(set(now)):
            return following
        now = following


def separating_columns(of: Machine) -> list[int]:
    """A few columns that tell every two states apart, greedily chosen, the one that tells most first."""
    chosen: list[int] = []
    states = range(len(of.next_of))
    now = [0] * len(of.next_of)
    while len(set(now)) < len(now):
        best = max(
            of.columns, key=lambda c: len({(now[s], of.out_of[s][c], now[of.next_of[s][c]]) for s in states})
        )
        if best in chosen:
            raise Unjudged("two states of a machine are the same")
        chosen.append(best)
        now = _refined(of, chosen)
    return chosen


def _refined(of: Machine, chosen: Sequence[int]) -> list[int]:
    now = [0] * len(of.next_of)
    while True:
        finer: dict[Hashable, int] = {}
        following = [
            finer.setdefault((now[s], *[(outs[c], now[nexts[c]]) for c in chosen]), len(finer))
            for s, (outs, nexts) in enumerate(zip(of.out_of, of.next_of, strict=True))
        ]
        if len(finer) == len(set(now)):
            return following
        now = following


class Identifiers:
    """For each state sequences of chosen columns that together tell it from every other state."""

    def __init__(self, of: Machine, chosen: Sequence[int]) -> None:
        self.machine, self.chosen = of, tuple(chosen)
        self._alike: list[tuple[Word, list[int], dict[int, int]]] = [
            (word, *self._answers(word)) for word in self._pool()
        ]
        self.words: tuple[tuple[Word, ...], ...] = tuple(self._of(s) for s in range(len(of.next_of)))

    def _of(self, state: int) -> tuple[Word, ...]:
        every = range(len(self.machine.next_of))
        if len(every) == 1:
            return ()
        single = self._single(state, frozenset(every) - {state})
        if single is not None:
            return (single,)
        found: list[Word] = []
        others = (1 << len(every)) - 1 ^ 1 << state
        while others:
            word, left = min(
                ((word, others & like[answer[state]]) for word, answer, like in self._alike),
                key=lambda pair: (pair[1].bit_count(), len(pair[0]), pair[0]),
            )
            if left == others:
                word = between(self.machine, self.chosen, state, others.bit_length() - 1)
                answer, like = self._answers(word)
                left = others & like[answer[state]]
            found.append(word)
            others = left
        return tuple(found)

    def _pool(self) -> Iterator[Word]:
        """Every sequence of one or two chosen columns."""
        for column in self.chosen:
            yield (column,)
            for other in self.chosen:
                yield (column, other)

    def _answers(self, word: Word) -> tuple[list[int], dict[int, int]]:
        """For each state the number of its answer to the word, and for each answer the set of its states."""
        numbers: dict[tuple[int, ...], int] = {}
        answers = []
        sets: dict[int, int] = {}
        for first in range(len(self.machine.next_of)):
            state, outs = first, []
            for column in word:
                outs.append(self.machine.out_of[state][column])
                state = self.machine.next_of[state][column]
            answer = numbers.setdefault(tuple(outs), len(numbers))
            answers.append(answer)
            sets[answer] = sets.get(answer, 0) | 1 << first
        return answers, sets

    def _single(self, state: int, others: frozenset[int]) -> Word | None:
        """A shortest sequence that no other state answers in the same way, if there is a short one."""
        of = self.machine
        level: list[tuple[int, frozenset[int], Word]] = [(state, others, ())]
        seen = set()
        for _ in range(LONGEST):
            deeper = []
            for here, like, word in level:
                for column in self.chosen:
                    out, after = of.out_of[here][column], of.next_of[here][column]
                    still = frozenset(of.next_of[t][column] for t in like if of.out_of[t][column] == out)
                    if not still:
                        return (*word, column)
                    if after not in still and (after, still) not in seen:
                        seen.add((after, still))
                        deeper.append((after, still, (*word, column)))
            level = deeper
        return None


def between(of: Machine, chosen: Sequence[int], state: int, other: int) -> Word:
    """A shortest sequence of chosen columns that tells two states apart. Raises Unjudged where none does."""
    queue: deque[tuple[int, int, Word]] = deque([(state, other, ())])
    seen = {(state, other)}
    while queue:
        a, b, word = queue.popleft()
        for column in chosen:
            if of.out_of[a][column] != of.out_of[b][column]:
                return (*word, column)
            pair = (of.next_of[a][column], of.next_of[b][column])
            if pair not in seen:
                seen.add(pair)
                queue.append((*pair, (*word, column)))
    raise Unjudged("two states of a machine are the same")
