"""Suite `soak`: so many scans in one go that whatever a program counts beside the specification overflows.

- waits: in every control state nothing changes for 300 scans; in the nearest ones, and in one for each row of
  outputs, for 66,000.
- rounds: for each step a shortest way round that takes it is gone 300 times: as many selections in one
  insertion, as many keys in a row, as many errors; the shortest ways are gone 66,000 times.
- a mixture: the same ways in an order that only looks random, each up to 200 times, 100,000 scans in all.

No reset comes between. After each, a walk takes every step of every control state that can be reached from
there, so that what has overflowed shows.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence

from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph
from modeproof.suites.script import Script, Scripts, Shot, control_state, ways_from_power_up

FEW, MOST = 300, 66_000
"""Beyond 8 bits, and beyond 16 bits."""
LONG_WAITS = 8
"""So many control states have a long wait at least."""
LONGEST_ROUND = 4
"""Scans of a way that is gone more than 65,536 times."""
MIXED, REPEATS, SEED = 100_000, 200, 20_261_122
Way = tuple[int, ...]


def plan(device: DeviceGraph, columns: Columns) -> Scripts:
    """The cases for one graph, the short ones first."""
    return Scripts(sorted(_Soak(device).cases(), key=lambda script: len(script.shots)))


def first(graphs: Sequence[DeviceGraph]) -> list[DeviceGraph]:
    """One graph of a target is enough."""
    return list(graphs[:1])


class _Soak:
    def __init__(self, device: DeviceGraph) -> None:
        self.device, self.graph = device, device.graph
        self.control = [control_state(device, state) for state in range(len(self.graph.views))]
        self.ways = {state: way for state, way in enumerate(ways_from_power_up(device)) if way is not None}
        self.states = sorted(self.ways, key=lambda state: (len(self.ways[state]), state))
        self.shots = [Shot(letter) for letter in range(len(device.alphabet))]
        self.moves = [self._moves(state) for state in range(len(self.control))]

    def _moves(self, state: int) -> dict[tuple[int, int], int]:
        """For each step and next state the first letter that takes it."""
        found: dict[tuple[int, int], int] = {}
        rows = zip(self.graph.step_of[state], self.graph.next_of[state], strict=True)
        for letter, move in enumerate(rows):
            found.setdefault(move, letter)
        return found

    def cases(self) -> Iterator[Script]:
        """Waits, rounds, and the mixture."""
        done: set[str] = set()
        rows: set[object] = set()
        for state in self.states:
            stay = self._stay(state)
            if stay is None or self.control[state] in done:
                continue
            many = len(done) < LONG_WAITS or self.device.seen[state] not in rows
            done.add(self.control[state])
            rows.add(self.device.seen[state])
            yield self._script(
                f"in {self.control[state]}, nothing changes", state, (stay,), MOST if many else FEW
            )
        rounds = self._rounds()
        short = min(rounds, key=lambda round: len(round[2]), default=None)
        for step, state, way in rounds:
            most = len(way) <= LONGEST_ROUND and (step, state, way) == short
            yield self._script(f"the way round that takes {step}", state, way, MOST if most else FEW)
        if rounds:
            yield self._mixture(rounds)

    def _stay(self, state: int) -> int | None:
        """A letter that leaves the state as it is, with time if there is one."""
        stays = [letter for letter, after in enumerate(self.graph.next_of[state]) if after == state]
        return max(
            stays, key=lambda letter: (self.device.alphabet[letter]["dt_ms"] > 0, letter), default=None
        )

    def _rounds(self) -> list[tuple[str, int, Way]]:
        """For each step the shortest way round through a move of it: its name, where it begins, its
        letters."""
        best: dict[int, tuple[int, Way]] = {}
        for state in self.states:
            for (step, after), letter in self.moves[state].items():
                most = len(best[step][1]) - 1 if step in best else len(self.control)
                back = self._back(after, state, most) if after != state and most > 1 else None
                if back is not None:
                    best[step] = (state, (letter, *back))
        return [(self.graph.steps[step], *best[step]) for step in sorted(best)]

    def _back(self, state: int, to: int, within: int) -> Way | None:
        """The letters of a shortest way, of fewer than `within` scans."""
        before: dict[int, tuple[int, int]] = {}
        near, seen = [state], {state}
        for _ in range(within):
            if to in seen:
                way: list[int] = []
                while to != state:
                    to, letter = before[to]
                    way.append(letter)
                return tuple(way[::-1])
            further = []
            for one in near:
                for (_, after), letter in self.moves[one].items():
                    if after not in seen:
                        seen.add(after)
                        before[after] = (one, letter)
                        further.append(after)
            near = further
            if not near:
                return None
        return None

    def _script(self, why: str, state: int, way: Way, count: int) -> Script:
        letters = [*self.ways[state], *(way * count)]
        return self._tailed(
            f"{why}, {count:,} times" if len(way) > 1 else f"{why} for {count:,} scans", letters
        )

    def _mixture(self, rounds: Sequence[tuple[str, int, Way]]) -> Script:
        chosen, state = random.Random(SEED), self.graph.initial
        letters: list[int] = []
        while len(letters) < MIXED:
            _, to, way = rounds[chosen.randrange(len(rounds))]
            there = self._back(state, to, len(self.control) + 1)
            if there is not None:
                letters += [*there, *(way * (1 + chosen.randrange(REPEATS)))]
                state = to
        return self._tailed(f"rounds in an order made from the number {SEED}", letters)

    def _tailed(self, why: str, letters: list[int]) -> Script:
        """With the walk that shows what has overflowed; the case is about this walk."""
        state, begins = self.graph.initial, len(letters)
        for letter in letters:
            state = self.graph.next_of[state][letter]
        taken: set[tuple[str, int]] = set()
        while (way := self._untaken(state, taken)) is not None:
            for letter in way:
                taken.add((self.control[state], self.graph.step_of[state][letter]))
                state = self.graph.next_of[state][letter]
                letters.append(letter)
        return Script(
            why, [self.shots[letter] for letter in letters], about=tuple(range(begins, len(letters)))
        )

    def _untaken(self, state: int, taken: set[tuple[str, int]]) -> Way | None:
        """A shortest way whose last move takes a step that was not taken from its control state."""
        before: dict[int, tuple[int, int]] = {}
        queue, seen = [state], {state}
        for one in queue:
            for (step, after), letter in self.moves[one].items():
                if (self.control[one], step) not in taken:
                    way = [letter]
                    while one != state:
                        one, letter = before[one]
                        way.append(letter)
                    return tuple(way[::-1])
                if after not in seen:
                    seen.add(after)
                    before[after] = (one, letter)
                    queue.append(after)
        return None
