"""Merges inputs that no state of the graph tells apart into one column."""

from __future__ import annotations

from array import array
from dataclasses import dataclass

from modeproof.graph.device import DeviceGraph


@dataclass(frozen=True)
class Columns:
    """`members[c]` are the inputs of column c, ascending; `step_of[s][c]` and `next_of[s][c]` as in Graph."""

    members: tuple[tuple[int, ...], ...]
    step_of: tuple[array[int], ...]
    next_of: tuple[array[int], ...]

    @property
    def transitions(self) -> int:
        """States times columns."""
        return len(self.members) * len(self.next_of)


def merge_columns(device: DeviceGraph) -> Columns:
    """Two inputs share a column when in every state they take the same step to the same state.

    Inputs that are passed on to an output keep a column for each of their values. The columns are in the
    order of their first members.
    """
    graph = device.graph
    steps: array[int] = array("l")
    nexts: array[int] = array("l")
    for step_row, next_row in zip(graph.step_of, graph.next_of, strict=True):
        steps.extend(step_row)
        nexts.extend(next_row)
    width = len(graph.inputs)
    groups: dict[tuple[object, ...], list[int]] = {}
    for n, values in enumerate(device.alphabet):
        passed = tuple(values[name] for name in device.passed.values())
        groups.setdefault((steps[n::width].tobytes(), nexts[n::width].tobytes(), passed), []).append(n)
    members = tuple(tuple(group) for group in groups.values())
    firsts = [group[0] for group in members]
    return Columns(
        members=members,
        step_of=tuple(array("l", [row[n] for n in firsts]) for row in graph.step_of),
        next_of=tuple(array("l", [row[n] for n in firsts]) for row in graph.next_of),
    )
