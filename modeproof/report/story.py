"""A trace as people read it: for each step who did what, what ran between whom, and what changed.

Made from the walk of a counterexample where there is one (the words on the wires, and what the decided device
does), else from the variables that the evidence itself holds.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import Any

from modeproof.registers.replay import Traces
from modeproof.registers.rows import Document
from modeproof.report.scan_table_cells import Cells, Column

OUTSIDE = ""
"""The id of the lane of all that is no device: user and environment."""
POWER_UP = "power-up"
MOST = 6
"""Of more devices than this not every order is tried."""


@dataclass(frozen=True)
class Lane:
    """A device that takes part, or the outside."""

    id: str
    title: str


@dataclass(frozen=True)
class Message:
    """Signals that changed in one step and run from one lane to another: each name and its new value."""

    source: str
    target: str
    signals: tuple[str, ...]


@dataclass(frozen=True)
class Row:
    """One state of a trace and the step that led to it.

    `cells` are in the order of the story's columns, `changed` the numbers of those that are not what they
    were in the row before, `states` the state of each device, `instead` what a device with no reading
    restored does here.
    """

    step: str
    who: str
    by: str
    cells: tuple[str, ...]
    changed: tuple[int, ...]
    states: Mapping[str, str]
    messages: tuple[Message, ...] = ()
    instead: tuple[str, ...] = ()


@dataclass(frozen=True)
class Story:
    """`constant` says what is the same in every row and is in no column; `full` whether it has wires."""

    lanes: tuple[Lane, ...]
    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    constant: str
    full: bool


def digest_of(trace: Sequence[Mapping[str, Any]]) -> str:
    """SHA-256 of a recorded trace, by which its walk names it."""
    text = json.dumps([sorted(state["variables"].items()) for state in trace], separators=(",", ":"))
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def is_trace(trace: object) -> bool:
    """Whether a trace is whole: states numbered from 1 on, each with the same variables as text."""
    if not isinstance(trace, list) or not trace:
        return False
    for number, state in enumerate(trace, 1):
        if not isinstance(state, Mapping) or not isinstance(state.get("variables"), Mapping):
            return False
        if state.get("number") != number or set(state["variables"]) != set(trace[0]["variables"]):
            return False
        if not all(isinstance(value, str) for value in state["variables"].values()):
            return False
    return True


def _plain(text: str) -> str:
    """A cell without the marks of a page in Markdown."""
    return text.replace("<br>", " ").replace("&nbsp;", " ")


def from_walk(document: Document, traces: Traces, walk: Mapping[str, Any]) -> Story:
    """The story of a walk."""
    cells = Cells(document.interface, traces, walk["tables"])
    rows = walk["rows"]
    names = list(traces.tops[walk["module"]].columns)
    columns = cells.columns(names, list(rows[0]["variables"]))
    shown = [
        [_plain(cells.show(column, row["wires"], row["variables"])) for column in columns] for row in rows
    ]
    present = _present(document, traces, cells, rows[0]["variables"])
    states = [
        {device: str(row["variables"][cells.state_variable(device, row["variables"])]) for device in present}
        for row in rows
    ]
    instead = _instead(traces, cells, walk)
    made = [
        _row(traces, present, row["step"], row["who"], at, shown, states, instead.get(row["at"], ()))
        for at, row in enumerate(rows)
    ]
    with_messages = [
        Row(**{**vars(one), "messages": _messages(document, cells, present, rows[at - 1], rows[at])})
        if at
        else one
        for at, one in enumerate(made)
    ]
    return _story(document, traces, present, columns, with_messages, full=True)


def from_variables(document: Document, traces: Traces | None, trace: Sequence[Mapping[str, Any]]) -> Story:
    """The story of a recorded trace without a walk: its variables in the notation of the specification."""
    names = sorted(trace[0]["variables"])
    step = traces.step if traces is not None else "step"
    columns = [Column(name, name, (name,), "variable") for name in names if name != step]
    shown = [[state["variables"][column.id] for column in columns] for state in trace]
    present: tuple[str, ...] = ()
    cells = Cells(document.interface, traces, {}) if traces is not None else None
    if traces is not None and cells is not None:
        present = _present(document, traces, cells, trace[0]["variables"])
    made = []
    for at, state in enumerate(trace):
        variables = state["variables"]
        taken = variables.get(step, "").strip('"') or ("" if at == 0 else str(state.get("action", "")))
        owner = next(
            (device.id for device in document.interface.devices.values() if taken in device.steps), OUTSIDE
        )
        states = (
            {one: variables[cells.state_variable(one, variables)].strip('"') for one in present}
            if cells is not None
            else {}
        )
        made.append(_row(traces, present, taken, owner, at, shown, [{}] * at + [states], ()))
    return _story(document, traces, present, columns, made, full=False)


def in_flow(document: Document, present: Sequence[str]) -> tuple[str, ...]:
    """The devices side by side so that signals run short ways, with the outside left of all of them."""
    if len(present) > MOST:
        return tuple(present)
    devices = {name: document.interface.devices[name] for name in present}
    ends: list[tuple[str, str]] = []
    for name, device in devices.items():
        for signal in device.inputs:
            sources = [one for one, other in devices.items() if one != name and signal in other.outputs]
            ends += [(source, name) for source in sources or [OUTSIDE]]
        for signal in device.outputs:
            if not any(one != name and signal in other.inputs for one, other in devices.items()):
                ends.append((name, OUTSIDE))

    def length(order: Sequence[str]) -> int:
        place = {one: n for n, one in enumerate((OUTSIDE, *order))}
        # What runs between two devices is followed more often than what comes from outside.
        return sum(
            abs(place[one] - place[other]) * (1 if OUTSIDE in (one, other) else 2) for one, other in ends
        )

    return min(permutations(present), key=length)


def _present(
    document: Document, traces: Traces, cells: Cells, variables: Mapping[str, Any]
) -> tuple[str, ...]:
    """The devices whose state is among the variables."""
    return tuple(
        name
        for name, device in document.interface.devices.items()
        if device.memory and cells.state_variable(name, variables) in variables
    )


def _row(
    traces: Traces | None,
    present: Sequence[str],
    step: str,
    who: str,
    at: int,
    shown: Sequence[Sequence[str]],
    states: Sequence[Mapping[str, str]],
    instead: Sequence[str],
) -> Row:
    lane = who if who in present else OUTSIDE
    by = who
    if at == 0:
        by = ""
    elif traces is not None:
        by = traces.devices[who].short if who in traces.devices else traces.nobody.get(step, "environment")
    return Row(
        step=step or (POWER_UP if at == 0 else ""),
        who=lane,
        by=by,
        cells=tuple(shown[at]),
        changed=tuple(n for n, text in enumerate(shown[at]) if at and text != shown[at - 1][n]),
        states=states[at],
        instead=tuple(instead),
    )


def _messages(
    document: Document,
    cells: Cells,
    present: Sequence[str],
    before: Mapping[str, Any],
    after: Mapping[str, Any],
) -> tuple[Message, ...]:
    """What changed on the wires, by where it comes from and who reads it."""
    runs: dict[tuple[str, str], list[str]] = {}
    devices = {name: document.interface.devices[name] for name in present}
    for name, value in after["wires"].items():
        if before["wires"].get(name) == value:
            continue
        sources = [one for one, device in devices.items() if name in device.outputs]
        readers = [one for one, device in devices.items() if name in device.inputs and one not in sources]
        if not sources and not readers:
            continue
        text = f"{name} {_plain(cells.value(name, value))}"
        for source in sources or [OUTSIDE]:
            for reader in readers or [OUTSIDE]:
                runs.setdefault((source, reader), []).append(text)
    return tuple(Message(*ends, tuple(signals)) for ends, signals in runs.items())


def _instead(traces: Traces, cells: Cells, walk: Mapping[str, Any]) -> dict[int, list[str]]:
    """By state number what the decided device does in its place, and in what its outputs then differ."""
    found: dict[int, list[str]] = {}
    rows = {row["at"]: row for row in walk["rows"]}
    for device, departures in walk["departures"].items():
        short = traces.devices[device].short if device in traces.devices else device
        followed = {one["at"]: one for one in walk["decided"].get(device, ())}
        for departure in departures:
            row = rows[departure["at"]]
            text = f"{short}, as decided: {departure['step']} instead of {row['step']}"
            if departure["step"] == row["step"]:
                text = f"{short}, as decided: {departure['step']} too, but to another end"
            scan = followed.get(departure["at"], {})
            wires = row["wires"]
            differing = [
                f"{name} {_plain(cells.value(name, value))}, not {_plain(cells.value(name, wires[name]))}"
                for name, value in scan.get("outputs", {}).items()
                if name in wires and wires[name] != value
            ]
            found.setdefault(departure["at"], []).append("; ".join([text, *differing]))
    return found


def _story(
    document: Document,
    traces: Traces | None,
    present: Sequence[str],
    columns: Sequence[Column],
    rows: Sequence[Row],
    *,
    full: bool,
) -> Story:
    """The story without the columns that never change."""
    moving = [n for n in range(len(columns)) if len({row.cells[n] for row in rows}) > 1]
    still = [n for n in range(len(columns)) if n not in moving]
    place = {n: at for at, n in enumerate(moving)}
    kept = tuple(
        Row(
            **{
                **vars(row),
                "cells": tuple(row.cells[n] for n in moving),
                "changed": tuple(place[n] for n in row.changed),
            }
        )
        for row in rows
    )
    people = sorted(set(traces.nobody.values()) - {"environment"}) if traces is not None else []
    lanes = [Lane(OUTSIDE, ", ".join([*people, "environment"]))]
    for one in in_flow(document, present):
        short = traces.devices[one].short if traces is not None and one in traces.devices else one
        lanes.append(Lane(one, short))
    constant = ", ".join(f"{columns[n].heading} {rows[-1].cells[n]}" for n in still if columns[n].id != "dt")
    return Story(tuple(lanes), tuple(columns[n].heading for n in moving), kept, constant, full)
