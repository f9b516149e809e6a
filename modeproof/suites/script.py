"""What a suite yields: cases as scans of inputs. Ids, outputs, statistics and the header are the writer's."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph

_QUOTED = re.compile(r'"(\w+)"')


@dataclass(frozen=True)
class Shot:
    """One scan of a script: an input of the alphabet, or a request that the adapter must refuse.

    `values` take the place of fields of the letter: other members of its classes, or another time. With
    `settling` the outputs of the scan are not compared.
    """

    letter: int = 0
    values: Mapping[str, Any] = field(default_factory=dict)
    settling: bool = False
    refuse: Mapping[str, Any] | str | None = None


@dataclass(frozen=True)
class Script:
    """One case: why it is there, its shots, and the numbers of those whose steps it is about.

    Without `about` it is about all its steps. `renamed` gives other words for words of the graph, in inputs
    and outputs alike. Without `reset` the case begins before any reset. `judges` says, where refusals are the
    matter, who is judged: the adapter, or the program behind one that must not refuse. With `clauses` it
    cites these, on this `basis`; without, what the steps cite.
    """

    why: str
    shots: Sequence[Shot]
    about: Sequence[int] = ()
    renamed: Mapping[int, int] = field(default_factory=dict)
    reset: bool = True
    judges: str = ""
    clauses: tuple[str, ...] = ()
    basis: str = ""


@dataclass(frozen=True)
class Scripts:
    """The cases of one graph in order, and what the header says of them besides.

    `bound`: so many scans and resets are needed at least for what the suite takes (0: not known).
    """

    cases: Iterable[Script]
    notes: Mapping[str, Any] = field(default_factory=dict)
    bound: int = 0


Plan = Callable[[DeviceGraph, Columns], Scripts]
"""A suite: makes the cases for one graph."""


class Alphabet:
    """The inputs of a graph, found by their values."""

    def __init__(self, device: DeviceGraph) -> None:
        self.letters = device.alphabet
        self._names = sorted(device.alphabet[0])
        self._at = {self._key(letter): n for n, letter in enumerate(device.alphabet)}

    def _key(self, values: Mapping[str, Any]) -> tuple[Any, ...]:
        return tuple(values[name] for name in self._names)

    def find(self, values: Mapping[str, Any]) -> int | None:
        """The number of the letter with these values, if there is one."""
        return self._at.get(self._key(values))

    def changed(self, letter: int, **fields: Any) -> int | None:
        """The letter that differs from `letter` in these fields only, if there is one."""
        return self.find({**self.letters[letter], **fields})


def control_state(device: DeviceGraph, state: int) -> str:
    """The name of the control state of a state of the graph; nothing when the view does not show it."""
    for name in _QUOTED.findall(device.graph.views[state]):
        if name in device.device.states:
            return str(name)
    return ""


def ways_from_power_up(device: DeviceGraph) -> list[tuple[int, ...] | None]:
    """For each state the letters of a shortest way to it; None for one that cannot be reached."""
    before = device.graph.shortest_paths()
    ways: list[tuple[int, ...] | None] = [None] * len(before)
    ways[device.graph.initial] = ()

    def way(state: int) -> tuple[int, ...] | None:
        chain = []
        while ways[state] is None:
            move = before[state]
            if move is None:
                return None
            chain.append((state, move[1]))
            state = move[0]
        for after, letter in reversed(chain):
            ways[after] = (*(ways[state] or ()), letter)
            state = after
        return ways[state]

    for state in range(len(before)):
        way(state)
    return ways
