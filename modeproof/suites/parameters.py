"""Suite `parameters`: the program at other values of its parameters, and after `reset` without any.

A short walk through each graph takes every step of every control state at every time that has passed there.
The graphs are those of the OPEN runs and those that TLC makes besides (see modeproof.suites.at), so that each
choice is there with each other. Each is walked with ticks of another length: then the times are odd, or a few
milliseconds, or do not fit 16 bits, or their sums do not, or they are the longest that the interface allows.
Where the parameters are the defaults they are not sent, and of others only those that differ.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph
from modeproof.suites.at import scalable, scaled, tick_of, whole
from modeproof.suites.script import Script, Scripts, Shot, control_state
from modeproof.suites.tour import walks
from modeproof.tlc.tla_values import canonical, parse

TICKS_MS = (7, 16_001, 1 << 16, 1, 1 << 15, 251)
"""Lengths of a tick: odd; sums above 16 bits; as many ms as 16 bits do not tell from 0; the least; and
others."""


def variants(graphs: Sequence[DeviceGraph]) -> list[DeviceGraph]:
    """The graphs as they are walked: the first with every length of a tick, the others in turn with one."""
    found: list[DeviceGraph] = []
    turn = 0
    for graph in graphs:
        found.append(_sent(graph))
        if not scalable(graph):
            continue
        tick, device = tick_of(graph), graph.device
        given = whole(device, graph.params)
        times = [(of.maximum, given[name]) for name, of in device.parameters.items() if of.type == "ms"]
        longest = min((most * tick // value for most, value in times if most and value > 0), default=1 << 16)
        ticks = [*TICKS_MS, longest] if graph is graphs[0] else [TICKS_MS[turn % len(TICKS_MS)]]
        turn += graph is not graphs[0]
        found += [_sent(scaled(graph, Fraction(tick_ms, tick))) for tick_ms in ticks if tick_ms <= longest]
    return found


def _sent(graph: DeviceGraph) -> DeviceGraph:
    """With the parameters that differ from the defaults."""
    defaults = whole(graph.device, {})
    return replace(graph, params={name: v for name, v in graph.params.items() if v != defaults[name]})


def plan(device: DeviceGraph, columns: Columns) -> Scripts:
    """The cases for one graph."""
    wanted = one_of_each(device, columns)
    shown = ", ".join(f"{name}={value}" for name, value in device.params.items()) or "all by default"
    return Scripts(
        Script(
            f"parameters {shown}: a walk that takes every step of every control state at every time",
            [Shot(columns.members[move.column][0]) for move in walk],
        )
        for walk in walks(columns, device.graph.initial, wanted)
    )


def one_of_each(device: DeviceGraph, columns: Columns) -> list[list[int]]:
    """For each state the columns so that each step is taken from each control state at each time in it.

    What it leaves in flags of the memory counts as another step.
    """
    graph, memory = device.graph, device.device.memory
    clocks = [n for n, of in enumerate(memory.values()) if of.type == "ms"]
    flags = [n for n, of in enumerate(memory.values()) if of.type == "bool"]
    views = [parse(view) for view in graph.views]
    lengths = [device.alphabet[members[0]]["dt_ms"] for members in columns.members]
    states = range(len(views))
    control = [control_state(device, state) for state in states]
    time, left = ([tuple(canonical(view[n]) for n in kind) for view in views] for kind in (clocks, flags))
    seen: set[Any] = set()
    wanted: list[list[int]] = []
    for state in states:
        chosen = []
        rows = zip(columns.step_of[state], columns.next_of[state], lengths, strict=True)
        for column, (step, after, length) in enumerate(rows):
            key = (control[state], time[state], step, control[after], left[after], length)
            if key not in seen:
                seen.add(key)
                chosen.append(column)
        wanted.append(chosen)
    return wanted
