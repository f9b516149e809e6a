"""Turns walks in graphs into a vector file (see modeproof.kit.vectors for the form)."""

from __future__ import annotations

import contextlib
import json
import os
import tempfile
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.errors import Unjudged
from modeproof.graph.classes import Members
from modeproof.graph.columns import Columns, merge_columns
from modeproof.graph.device import DeviceGraph
from modeproof.kit.vectors import KIND, VERSION, id_of_text
from modeproof.registers.rows import Device, Signal
from modeproof.suites.tour import Move, covers, every_step, every_transition, walks

_ENCODE = json.JSONEncoder(separators=(",", ":")).encode

SUITES = {
    "tour": (
        every_transition,
        "column",
        "every transition of the specification's graph with merged input columns is taken",
        "the program treats all inputs of a column alike; members take turns, not all are tried",
    ),
    "brief": (
        every_step,
        "next state",
        "from every state of the specification every step to every next state is taken",
        "the program treats all inputs alike that lead from one state by one step to one state",
    ),
}
"""For each suite: what it takes, what besides state and step makes a transition, guarantee, hypothesis."""

Pieces = tuple[str, ...]
"""Signals as they are written, `"name":value` each, in the order of the names."""

Citations = Callable[[str], tuple[tuple[str, ...], tuple[str, ...]]]
"""From the name of a step to the clauses and the findings that it cites."""


@dataclass(frozen=True)
class Stats:
    """What a suite holds: transitions of the merged graphs, inputs that were used of all, cases and scans."""

    states: int
    columns: int
    transitions: int
    inputs_used: int
    inputs: int
    cases: int
    scans: int
    longest: int

    def __str__(self) -> str:
        return (
            f"{self.states:,} states x {self.columns:,} columns: {self.transitions:,} transitions in "
            f"{self.cases:,} cases, {self.scans:,} scans (longest case {self.longest:,}); "
            f"{self.inputs_used:,} of {self.inputs:,} inputs used"
        )


def no_citations(step: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """For graphs whose registers are not at hand."""
    return (), ()


def write_suite(
    path: Path,
    suite: str,
    devices: Sequence[DeviceGraph],
    *,
    citations: Citations = no_citations,
    sources: Mapping[str, str] | None = None,
    generator: str = "modeproof",
) -> Stats:
    """Build a suite of `SUITES` from all graphs of one target and write it as a whole or not at all.

    `sources` are hashes of what the graphs were made from, by relative path. Raises Unjudged when the graphs
    belong to several targets, when the walks do not cover what they must, or when the file cannot be written.
    """
    if suite not in SUITES:
        raise Unjudged(f"no suite {suite!r}; there are: {', '.join(SUITES)}")
    if not devices or len({(one.document, one.device.id) for one in devices}) != 1:
        raise Unjudged("a suite is built from the graphs of one target")
    writer = _Writer(suite, devices, citations)
    for number, device in enumerate(devices):
        writer.add(number, device)
    if not writer.cases:
        raise Unjudged(f"{devices[0].device.id}: the suite would have no cases")
    header = writer.header(dict(sources or {}), generator)
    _write_lines(path, [_line(header), *writer.cases])
    return writer.stats()


class _Writer:
    def __init__(self, suite: str, devices: Sequence[DeviceGraph], citations: Citations) -> None:
        self.suite = suite
        self.device = devices[0]
        self.citations = citations
        self.steps = {name: n for n, name in enumerate(self.device.device.steps)}
        self.transitions: Counter[str] = Counter()
        self.cases: list[str] = []
        self.graphs: list[dict[str, Any]] = []
        self.states = self.columns = self.scans = self.longest = self.inputs = self.used = 0

    def add(self, number: int, device: DeviceGraph) -> None:
        """Walk through one graph."""
        columns = merge_columns(device)
        wanted = SUITES[self.suite][0](columns)
        cases = walks(columns, device.graph.initial, wanted)
        if not covers(columns, device.graph.initial, wanted, cases):
            raise Unjudged(f"{device.name}: the suite {self.suite} does not cover what it must")
        for steps, row in zip(columns.step_of, wanted, strict=True):
            self.transitions.update(device.graph.steps[steps[column]] for column in row)
        self.graphs.append(self._graph(device, columns))
        letters = _Letters(device, columns)
        rows: dict[tuple[Any, ...], Pieces] = {}
        for case in cases:
            self._case(number, device, columns, letters, case, rows)
        self.states += len(columns.next_of)
        self.columns += len(columns.members)
        self.inputs += len(device.alphabet)
        self.used += len(letters.used)

    def _graph(self, device: DeviceGraph, columns: Columns) -> dict[str, Any]:
        graph = device.graph
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
                    self.steps[graph.steps[graph.step_of[before][letter]]],
                    column_of[letter],
                ]
            )
        return {
            "run": device.run,
            "params": dict(device.params),
            "initial": graph.initial,
            "views": list(graph.views),
            "ways": ways,
        }

    def _case(
        self,
        number: int,
        device: DeviceGraph,
        columns: Columns,
        letters: _Letters,
        walk: Sequence[Move],
        known: dict[tuple[Any, ...], Pieces],
    ) -> None:
        rows: list[str] = []
        going_in: list[str] = []
        cited: set[int] = set()
        inputs: Pieces = ()
        outputs: Pieces = ()
        numbers = [self.steps[name] for name in device.graph.steps]
        passed = tuple(device.passed.values())
        for move in walk:
            column = move.column
            values, now_in = letters.next(column)
            to = columns.next_of[move.state][column]
            step = numbers[columns.step_of[move.state][column]]
            cited.add(step)
            key = (to, *[values[one] for one in passed])
            if key not in known:
                known[key] = _pieces(device.wire_outputs(device.expected(to, values)))
            now_out = known[key]
            dt_ms, change = values["dt_ms"], _changed(inputs, now_in)
            going_in.append(f"[{dt_ms},{{{change}}}]")
            rows.append(
                f'{{"dt_ms":{dt_ms},"in":{{{change}}},"out":{{{_changed(outputs, now_out)}}},'
                f'"step":{step},"to":{to},"column":{column}}}'
            )
            inputs, outputs = now_in, now_out
        clauses: set[str] = set()
        findings: set[str] = set()
        names = self.device.device.steps
        for step in cited:
            of_step = self.citations(names[step])
            clauses.update(of_step[0])
            findings.update(of_step[1])
        case = {
            "id": id_of_text(device.device.id, device.params, ",".join(going_in)),
            "clauses": sorted(clauses),
            "basis": f"finding:{','.join(sorted(findings))}" if findings else "document",
            "why": f"a walk through {device.run} that takes transitions no earlier case has taken",
            "timing": "exact",
            "params": dict(device.params),
            "graph": number,
        }
        self.cases.append(f'{_ENCODE(case)[:-1]},"scans":[{",".join(rows)}]}}\n')
        self.scans += len(rows)
        self.longest = max(self.longest, len(rows))

    def header(self, sources: Mapping[str, str], generator: str) -> dict[str, Any]:
        device = self.device.device
        modes = list(self.device.forms.modes)
        return {
            "kind": KIND,
            "version": VERSION,
            "target": device.id,
            "document": self.device.document,
            "protocol": 1,
            "suite": self.suite,
            "relation": "exact",
            "counted_by": SUITES[self.suite][1],
            "guarantees": SUITES[self.suite][2],
            "hypothesis": SUITES[self.suite][3],
            "generator": generator,
            "sources": dict(sorted(sources.items())),
            "cases": len(self.cases),
            "scans": self.scans,
            "states": self.states,
            "columns": self.columns,
            "transitions": sum(self.transitions.values()),
            "inputs": _declare(device.inputs, modes),
            "outputs": _declare(device.outputs, modes),
            "steps": self._steps(device),
            "graphs": self.graphs,
        }

    def _steps(self, device: Device) -> list[dict[str, Any]]:
        rows = []
        for name in device.steps:
            clauses, findings = self.citations(name)
            rows.append(
                {
                    "name": name,
                    "clauses": list(clauses),
                    "findings": list(findings),
                    "transitions": self.transitions[name],
                }
            )
        return rows

    def stats(self) -> Stats:
        return Stats(
            states=self.states,
            columns=self.columns,
            transitions=sum(self.transitions.values()),
            inputs_used=self.used,
            inputs=self.inputs,
            cases=len(self.cases),
            scans=self.scans,
            longest=self.longest,
        )


class _Letters:
    """Gives the inputs of a column in turn, and for an input that stands for a class its members in turn."""

    def __init__(self, device: DeviceGraph, columns: Columns) -> None:
        self._device, self._columns = device, columns
        self._members = Members(device.classes, device.alphabet)
        self._turn = [0] * len(columns.members)
        self.used: set[int] = set()
        self._wire: dict[int, Pieces] = {}

    def next(self, column: int) -> tuple[Mapping[str, Any], Pieces]:
        """The values of the next member, in Python form and as they are written."""
        device = self._device
        members = self._columns.members[column]
        letter = members[self._turn[column] % len(members)]
        self._turn[column] += 1
        values = device.alphabet[letter]
        if letter in self.used and self._members.any_of(letter):
            values = self._members.another(letter)
            return values, _pieces(device.wire_inputs(values))
        if letter not in self._wire:
            self._wire[letter] = _pieces(device.wire_inputs(values))
        self.used.add(letter)
        return values, self._wire[letter]


def _pieces(values: Mapping[str, Any]) -> Pieces:
    return tuple(f"{_ENCODE(name)}:{_ENCODE(values[name])}" for name in sorted(values))


def _changed(before: Pieces, now: Pieces) -> str:
    if not before:
        return ",".join(now)
    return ",".join([new for old, new in zip(before, now, strict=True) if old != new])


def _declare(signals: Mapping[str, Signal], modes: Sequence[int]) -> dict[str, dict[str, Any]]:
    table = {}
    for name, signal in signals.items():
        row: dict[str, Any] = {"type": signal.type}
        if signal.minimum is not None:
            row["min"] = signal.minimum
        if signal.maximum is not None:
            row["max"] = signal.maximum
        if signal.values:
            row["values"] = list(signal.values)
        if signal.type in ("mode", "modes"):
            row["modes"] = list(modes)
        table[name] = row
    return table


def _line(row: Mapping[str, Any]) -> str:
    return _ENCODE(row) + "\n"


def _write_lines(path: Path, lines: Sequence[str]) -> None:
    part = ""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, part = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as stream:
            stream.writelines(lines)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(part, 0o644)
        os.replace(part, path)
        part = ""
    except OSError as error:
        raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        if part:
            with contextlib.suppress(OSError):
                os.unlink(part)
