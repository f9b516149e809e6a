"""Whether cases leave a program of so many states any freedom: judged from the cases alone.

A case is columns of inputs and the outputs that must come. Take any program with at most n states that treats
all inputs of a column alike and passes. Then:

- n sequences whose outputs differ pairwise after the same further columns lead to n different states of the
  program, and it has no others;
- where a case comes to a state by a column not known yet, what follows rules out each of the n states that is
  known to answer otherwise; when one is left, the column leads there;
- what is known of one sequence to a state is known of every other one to it.

This is repeated until nothing new is found. If then every column is known in every state, the program can
be nothing but what the cases say. The numbers of states that the cases carry are used as a hint which n
sequences to take, and are compared at the end; nothing rests on them. Neither the graph nor how the cases
were made is looked at.
"""

from __future__ import annotations

from array import array
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

SHORT = 64
"""Cases up to this length are kept as a tree, in which the n sequences are looked for."""


@dataclass
class Track:
    """One case: for each scan its column, the number of its outputs, and the number of the state after it."""

    columns: array[int] = field(default_factory=lambda: array("l"))
    outputs: array[int] = field(default_factory=lambda: array("l"))
    states: array[int] = field(default_factory=lambda: array("l"))

    def add(self, column: int, outputs: int, state: int) -> None:
        """Add a scan."""
        self.columns.append(column)
        self.outputs.append(outputs)
        self.states.append(state)


def gaps(tracks: Sequence[Track], states: int, columns: int) -> list[str]:
    """What a program of at most `states` states that passes is still free to do; nothing if it is not.

    States are numbered from 0, which is that of power-up; columns from 0.
    """
    return _Reasoning(tracks, states, columns).run()


class _Reasoning:
    """Places are nodes of the tree (0 is power-up), or states: -1 less their number."""

    def __init__(self, tracks: Sequence[Track], states: int, columns: int) -> None:
        self.tracks, self.states, self.columns = tracks, states, columns
        self.problems: list[str] = []
        self.children: list[dict[int, tuple[int, int]]] = [{}]
        self.chosen: list[int] = []
        self.out: dict[tuple[int, int], int] = {}
        self.next: dict[tuple[int, int], int] = {}
        self.answered: list[dict[int, int]] = [{} for _ in range(columns)]
        self.known = [0] * columns
        self.left: dict[tuple[int, int], int] = {}
        self.waiting: dict[tuple[int, int], list[tuple[int, int]]] = {}
        self.every = (1 << states) - 1
        self.by_node: dict[int, int] = {}

    def run(self) -> list[str]:
        if self._tree() and self._all_apart():
            self._know()
            self._follow()
            self._judge()
        return self.problems

    # ------------------------------------------------------------------------------------ the n states

    def _tree(self) -> bool:
        """Put short cases into a tree, and choose a node for each state."""
        hints = {0: 0}
        for track in self.tracks:
            if len(track.columns) > SHORT:
                continue
            node = 0
            for column, outputs, state in zip(track.columns, track.outputs, track.states, strict=True):
                if column not in self.children[node]:
                    self.children[node][column] = (outputs, len(self.children))
                    hints[len(self.children)] = state
                    self.children.append({})
                known, node = self.children[node][column]
                if known != outputs:
                    self.problems.append("two cases begin alike and expect different outputs")
                    return False
        first = {0: 0}  # cases are followed from power-up, so power-up represents its state
        for node, state in hints.items():  # the node with the most columns represents a state
            if state and len(self.children[node]) > len(self.children[first.setdefault(state, node)]):
                first[state] = node
        self.chosen = [first.get(state, -1) for state in range(self.states)]
        if -1 in self.chosen or len(first) != self.states:
            self.problems.append(f"short cases come to {len(first)} states, not to {self.states}")
            return False
        self.by_node = {node: -1 - state for state, node in enumerate(self.chosen)}
        return True

    def _all_apart(self) -> bool:
        for state in range(self.states):
            for other in range(state):
                if not self._apart(self.chosen[state], self.chosen[other]):
                    self.problems.append(f"no case tells the states {other} and {state} apart")
                    return False
        return True

    def _apart(self, state: int, other: int) -> bool:
        mine, theirs = self.children[state], self.children[other]
        common = [column for column in mine if column in theirs]
        return any(mine[c][0] != theirs[c][0] for c in common) or any(
            self._apart(mine[c][1], theirs[c][1]) for c in common
        )

    # ----------------------------------------------------------------------------------- what is known

    def _know(self) -> None:
        """What the tree shows at the chosen nodes."""
        for state, node in enumerate(self.chosen):
            for column, (outputs, child) in self.children[node].items():
                self._answers(state, column, outputs)
                if child in self.by_node:
                    self.next[state, column] = -1 - self.by_node[child]

    def _absorb(self, state: int, node: int) -> None:
        """What the tree shows at a node that turned out to be in `state`."""
        if node in self.by_node:
            return
        self.by_node[node] = -1 - state
        mine = self.children[self.chosen[state]]
        for column, (outputs, child) in self.children[node].items():
            self._answers(state, column, outputs)
            after = self.next.get((state, column))
            if after is not None:
                self._absorb(after, child)
            elif child in self.by_node:
                self._learn(state, column, -1 - self.by_node[child])
            elif column in mine:
                self._join(mine[column][1], child)
            else:
                mine[column] = (outputs, child)

    def _join(self, node: int, other: int) -> None:
        """Two nodes are in the same unknown state, so what the tree shows at one holds at the other."""
        mine = self.children[node]
        for column, (outputs, child) in self.children[other].items():
            if column not in mine:
                mine[column] = (outputs, child)
            elif mine[column][0] != outputs:
                self.problems.append("two cases come to one state and expect different outputs")
            else:
                self._join(mine[column][1], child)

    def _learn(self, state: int, column: int, after: int) -> None:
        """A column leads from a state to another one."""
        self.next[state, column] = after
        child = self.children[self.chosen[state]].get(column)
        if child is not None:
            self._absorb(after, child[1])

    def _answers(self, state: int, column: int, outputs: int) -> None:
        if self.out.setdefault((state, column), outputs) != outputs:
            self.problems.append(f"state {state}, column {column}: different outputs are expected")
        answered = self.answered[column]
        answered[outputs] = answered.get(outputs, 0) | 1 << state
        self.known[column] |= 1 << state

    def _step(self, place: int, column: int) -> tuple[int, int] | None:
        """Outputs and place after a column; None when no case tells them."""
        if place < 0:
            state = -1 - place
            after = self.next.get((state, column))
            if after is not None:
                return self.out[state, column], -1 - after
            place = self.chosen[state]
        found = self.children[place].get(column)
        if found is None:
            return None
        return found[0], self.by_node.get(found[1], found[1])

    def _still(self, states: int, track: Track, at: int) -> int:
        """Those of a set of states that may answer the rest of a case as it must be answered."""
        if at == len(track.columns):
            return states
        column, outputs = track.columns[at], track.outputs[at]
        states &= self.answered[column].get(outputs, 0) | ~self.known[column]
        if states & (states - 1) == 0:
            return states
        places: list[tuple[int, int]] = []
        rest = states
        while rest:
            bit = rest & -rest
            places.append((bit, -bit.bit_length()))
            rest ^= bit
        kept = 0
        for n in range(at, len(track.columns)):
            column, outputs = track.columns[n], track.outputs[n]
            following = []
            for bit, place in places:
                found = self._step(place, column)
                if found is None:
                    kept |= bit
                elif found[0] == outputs:
                    following.append((bit, found[1]))
            places = following
            if not places or (len(places) == 1 and not kept) or len({place for _, place in places}) == 1:
                break
        for bit, _ in places:
            kept |= bit
        return kept

    # ------------------------------------------------------------------------------------ the reasoning

    def _follow(self) -> None:
        """Follow every case as far as it is known where it is, until nothing new is found."""
        queue = deque((n, 0, 0) for n in range(len(self.tracks)))
        while queue and not self.problems:
            while queue:
                n, at, state = queue.popleft()
                stopped = self._along(self.tracks[n], at, state)
                if stopped is None:
                    continue
                at, state = stopped
                column = self.tracks[n].columns[at]
                self.waiting.setdefault((state, column), []).append((n, at))
                queue.extendleft(self._resolve(state, column, [(n, at)]))
            for state, column in list(self.waiting):  # what was found since may decide these
                queue.extend(self._resolve(state, column, self.waiting[state, column]))

    def _along(self, track: Track, at: int, state: int) -> tuple[int, int] | None:
        """Follow a case from a known state. Returns where its state stops being known, or None at its end."""
        for n in range(at, len(track.columns)):
            column = track.columns[n]
            self._answers_once(state, column, track.outputs[n])
            after = self.next.get((state, column))
            if after is None:
                return n, state
            state = after
        return None

    def _answers_once(self, state: int, column: int, outputs: int) -> None:
        if self.out.get((state, column)) != outputs:
            self._answers(state, column, outputs)

    def _resolve(self, state: int, column: int, seen: list[tuple[int, int]]) -> list[tuple[int, int, int]]:
        """Rule out states by what follows. When a single state is left, return the cases that can go on."""
        left = self.left.get((state, column), self.every)
        for n, at in seen:
            left = self._still(left, self.tracks[n], at + 1)
        self.left[state, column] = left
        if left == 0:
            self.problems.append(f"state {state}, column {column}: no state can follow as the cases say")
            return []
        if left & (left - 1):
            return []
        after = left.bit_length() - 1
        self._learn(state, column, after)
        hints = {self.tracks[n].states[at] for n, at in self.waiting[state, column]}
        if hints != {after}:
            self.problems.append(f"state {state}, column {column}: leads to {after}, the cases say {hints}")
        return [(n, at + 1, after) for n, at in self.waiting.pop((state, column))]

    def _judge(self) -> None:
        missing = [
            (state, column)
            for state in range(self.states)
            for column in range(self.columns)
            if (state, column) not in self.next
        ]
        if missing:
            state, column = missing[0]
            taken = (state, column) in self.out
            self.problems.append(
                f"{len(missing):,} of {self.states * self.columns:,} transitions are not settled; the first: "
                f"state {state}, column {column}: {'where it leads' if taken else 'never taken'}"
            )


def numbered(cases: Iterable[Iterable[tuple[int, object, int]]]) -> list[Track]:
    """Tracks of cases whose outputs are any objects with equality."""
    numbers: dict[object, int] = {}
    tracks = []
    for case in cases:
        track = Track()
        for column, outputs, state in case:
            track.add(column, numbers.setdefault(outputs, len(numbers)), state)
        tracks.append(track)
    return tracks
