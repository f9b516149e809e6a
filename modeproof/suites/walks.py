"""Suites that walk through the whole graph: each column of a walk becomes one of its inputs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from modeproof.graph.classes import Members
from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph
from modeproof.ground.errors import Unjudged
from modeproof.suites import wp
from modeproof.suites.bound import lower_bound
from modeproof.suites.identify import machine
from modeproof.suites.script import Plan, Script, Scripts, Shot
from modeproof.suites.tour import Move, covers, walks

NEW = "takes transitions no earlier case has taken"
TELLING = "ends each new transition with inputs that tell the state it led to from all others"


def covering(wanted: Callable[[Columns], list[list[int]]], bounded: bool = False) -> Plan:
    """A suite that takes the `wanted` columns of every state. `bounded`: it states the least cost of that."""

    def plan(device: DeviceGraph, columns: Columns) -> Scripts:
        initial, chosen = device.graph.initial, wanted(columns)
        cases = walks(columns, initial, chosen)
        if not covers(columns, initial, chosen, cases):
            raise Unjudged(f"{device.name}: the walks do not cover what they must")
        bound = lower_bound(columns, initial) if bounded else 0
        return Scripts(_scripts(device, columns, cases, NEW), {"ways": _ways(device, columns)}, bound)

    return plan


def telling(device: DeviceGraph, columns: Columns) -> Scripts:
    """The suite `wp`; the header says for which programs it leaves no freedom.

    `number_of` numbers the states as outputs tell them apart.
    """
    initial = device.graph.initial
    seen = machine(columns, device.seen, initial)
    complete = {
        "states": len(seen.next_of),
        "extra_states": 0,
        "columns": len(columns.members),
        "number_of": list(seen.number_of),
    }
    cases = wp.walks(columns, initial, device.seen)
    notes = {"ways": _ways(device, columns), "complete": complete}
    return Scripts(_scripts(device, columns, cases, TELLING), notes)


def _scripts(
    device: DeviceGraph, columns: Columns, cases: Sequence[Sequence[Move]], why: str
) -> Iterator[Script]:
    letters = _Letters(device, columns)
    for walk in cases:
        shots = [letters.next(move.column) for move in walk]
        yield Script(f"a walk through {device.run} that {why}", shots)


def _ways(device: DeviceGraph, columns: Columns) -> list[Any]:
    """For each state the last scan of a shortest way to it, and the state before that; None for no way."""
    graph = device.graph
    steps = {name: n for n, name in enumerate(device.device.steps)}
    column_of = {letter: c for c, members in enumerate(columns.members) for letter in members}
    ways: list[Any] = []
    for state, move in enumerate(graph.shortest_paths()):
        if move is None:
            ways.append(None)
            continue
        before, letter = move
        values = device.alphabet[letter]
        ways.append(
            [
                before,
                values["dt_ms"],
                device.wire_inputs(values),
                device.wire_outputs(device.expected(state, values)),
                steps[graph.steps[graph.step_of[before][letter]]],
                column_of[letter],
            ]
        )
    return ways


class _Letters:
    """Gives the inputs of a column in turn, and for an input that stands for a class its members in turn."""

    def __init__(self, device: DeviceGraph, columns: Columns) -> None:
        self._columns = columns
        self._members = Members(device.classes, device.alphabet)
        self._turn = [0] * len(columns.members)
        self._used: dict[int, Shot] = {}

    def next(self, column: int) -> Shot:
        """The scan with the next member."""
        members = self._columns.members[column]
        letter = members[self._turn[column] % len(members)]
        self._turn[column] += 1
        shot = self._used.get(letter)
        if shot is None:
            shot = self._used[letter] = Shot(letter)
        elif self._members.any_of(letter):
            return Shot(letter, self._members.another(letter))
        return shot
