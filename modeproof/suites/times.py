"""Suite `times`: the same time in many small scans, and waits that outlast a counter of 16 bits.

The graph has a few lengths of time only. Two kinds of cases go beyond them:

- pieces: where a scan with some time leads to another state, and the same inputs without time do not, the
  time is sent in pieces: all but a millisecond and then that one, pieces of 10 ms, pieces of no round length.
  Before the last piece the outputs are as before, after it as the graph has them. A program that rounds the
  time of each scan is too slow or too fast.
- long waits: where a state stays as it is however long the inputs are held, they are held for more than
  32,768 ms and for about 65,536 ms, in scans of about a second where the times of the graph are short. A
  program whose timer overflows begins anew.

After each come inputs by which outputs tell the right state from those of the same control state at another
time. That times add up is taken for granted. A time comes in pieces where nothing can happen before it is
over: it is the measure of all times of the graph, and lengths that a program compares time with are multiples
of it; or a time of the graph is one millisecond shorter, and nothing happens in that.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import gcd

from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph
from modeproof.suites.apart import Apart
from modeproof.suites.script import Alphabet, Script, Scripts, Shot, control_state, ways_from_power_up

STATES = 4
"""So many states of a control state have long waits at most, and twice as many have pieces."""
SIGNED, UNSIGNED = 1 << 15, 1 << 16
LONGEST_WAIT = 200
"""Scans; where the longest time of the graph is too short for that, scans last a second or a little more."""


def plan(device: DeviceGraph, columns: Columns) -> Scripts:
    """The cases for one graph; none for a device without time."""
    times = sorted({letter["dt_ms"] for letter in device.alphabet})
    search = _Search(device, columns)
    pieces = list(search.pieces(times)) if times[0] == 0 and len(times) > 1 else []
    waits = list(search.waits(times[-1])) if len(times) > 1 else []
    return Scripts([*pieces, *waits], {"pieces": len(pieces), "long_waits": len(waits)})


def split(time_ms: int) -> list[list[int]]:
    """Ways to send a time in pieces."""
    ways = [[time_ms - 1, 1]]
    for piece in (10, 33):
        if piece < time_ms:
            rest = time_ms % piece
            ways.append([piece] * (time_ms // piece) + ([rest] if rest else []))
    return ways


class _Search:
    def __init__(self, device: DeviceGraph, columns: Columns) -> None:
        self.device, self.columns, self.graph = device, columns, device.graph
        self.apart = Apart(columns, device.seen)
        self.ways = ways_from_power_up(device)
        states = [state for state, way in enumerate(self.ways) if way is not None]
        self.states = sorted(states, key=lambda state: (len(self.ways[state] or ()), state))
        self.control = [control_state(device, state) for state in range(len(self.ways))]
        self.like: dict[tuple[object, ...], list[int]] = {}
        for state in self.states:
            key = (self.control[state], *device.seen[state])
            self.like.setdefault(key, []).append(state)

    def pieces(self, times: Sequence[int]) -> Iterator[Script]:
        """Cases in which a time of the graph comes in pieces."""
        if gcd(*times) == times[1] > 1:
            yield from self._pieces(times[1], 0)
        else:
            for before, time_ms in pairwise(times):
                if before + 1 == time_ms > 1:
                    yield from self._pieces(time_ms, before)

    def _pieces(self, time_ms: int, before_ms: int) -> Iterator[Script]:
        """The cases for one time. Nothing may happen in `before_ms`; with 0 there is no earlier time."""
        alphabet = Alphabet(self.device)
        pairs = [
            (n, later)
            for n, letter in enumerate(self.device.alphabet)
            if letter["dt_ms"] == 0 and (later := alphabet.changed(n, dt_ms=time_ms)) is not None
        ]
        done: dict[tuple[str, str], int] = {}
        for state in self.states:
            seen: set[int] = set()
            for n, later in pairs[state % 7 :] + pairs[: state % 7]:
                after, step = self.graph.next_of[state][later], self.graph.step_of[state][later]
                key = (self.control[state], self.graph.steps[step])
                if self.graph.next_of[state][n] != state or after == state or step in seen:
                    continue
                if before_ms and not self._quiet(state, alphabet.changed(n, dt_ms=before_ms)):
                    continue
                if done.get(key, 0) == 2 * STATES:
                    continue
                seen.add(step)
                done[key] = done.get(key, 0) + 1
                for way in split(time_ms):
                    yield from self._probed(
                        f"in {key[0]}, {time_ms} ms in {len(way)} scans are {time_ms} ms: {key[1]}",
                        state,
                        [*(Shot(n, {"dt_ms": piece}) for piece in way[:-1]), Shot(later, {"dt_ms": way[-1]})],
                        after,
                        others=[state],
                    )

    def _quiet(self, state: int, letter: int | None) -> bool:
        """Whether a scan leaves control state and outputs as they are."""
        if letter is None:
            return False
        after = self.graph.next_of[state][letter]
        same = self.device.seen[after] == self.device.seen[state]
        return same and self.control[after] == self.control[state]

    def waits(self, longest: int) -> Iterator[Script]:
        """Cases in which nothing happens for long."""
        around = UNSIGNED // longest
        scan = longest
        lengths = [length * longest for length in (SIGNED // longest + 2, around - 1, around, around + 1)]
        if around > LONGEST_WAIT:
            scan = -(-1000 // longest) * longest
            lengths = [SIGNED + 2 * longest, *(UNSIGNED - n * longest for n in (2, 1, 0))]
        long = [n for n, letter in enumerate(self.device.alphabet) if letter["dt_ms"] == longest]
        done: dict[str, int] = {}
        for state in self.states:
            control = self.control[state]
            stays = [n for n in long if self.graph.next_of[state][n] == state]
            if not stays or done.get(control, 0) == STATES:
                continue
            done[control] = done.get(control, 0) + 1
            for turn, length in enumerate(lengths):
                letter = stays[(state + turn) * 5 % len(stays)]
                why = f"in {control}, nothing changes for {length:,} ms"
                last = length % scan
                wait = [Shot(letter, {"dt_ms": scan} if scan > longest else {})] * (length // scan)
                wait += [Shot(letter, {"dt_ms": last})] if last else []
                yield from self._probed(why, state, wait, state, others=[])
                for leaving, after in self._out(state):
                    shots = [*wait, Shot(leaving)]
                    yield from self._probed(why, state, shots, after, others=[])

    def _out(self, state: int) -> Iterator[tuple[int, int]]:
        """Where no other time in the control state can be told apart: two inputs that lead out of it."""
        key = (self.control[state], *self.device.seen[state])
        if len(self.like[key]) == 1:
            found: dict[int, int] = {}
            for letter, after in enumerate(self.graph.next_of[state]):
                if after != state and len(found) < 2:
                    found.setdefault(after, letter)
            yield from ((letter, after) for after, letter in found.items())

    def _probed(
        self, why: str, state: int, shots: list[Shot], after: int, others: list[int]
    ) -> Iterator[Script]:
        """The way to a state, the shots, and each sequence that tells the state after them from others."""
        way = self.ways[state] or ()
        key = (self.control[after], *self.device.seen[after])
        probes = {
            self.apart.sequence(after, other) or () for other in [*others, *self.like[key]] if other != after
        }
        for probe in sorted(probes) or [()]:
            yield Script(
                why=why,
                shots=[
                    *(Shot(letter) for letter in way),
                    *shots,
                    *(Shot(self.columns.members[column][0]) for column in probe),
                ],
                about=tuple(range(len(way), len(way) + len(shots))),
            )
