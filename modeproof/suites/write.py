"""Writes a suite: ids, outputs, compaction, statistics, header (see modeproof.kit.vectors for the form)."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.graph.columns import merge_columns
from modeproof.graph.device import DeviceGraph
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.evidence.files import write_lines
from modeproof.kit.vectors import KIND, VERSION, id_of_text
from modeproof.registers.profiles import profiles_of
from modeproof.registers.rows import Device
from modeproof.suites.demands import declare, declare_parameters
from modeproof.suites.kinds import SUITES
from modeproof.suites.rows import Pieces, Rows, changed
from modeproof.suites.script import Script

ADAPTER = "adapter"
_ENCODE = json.JSONEncoder(separators=(",", ":")).encode
_SORTED = json.JSONEncoder(sort_keys=True, separators=(",", ":")).encode


class NoCases(Unjudged):
    """A suite that has nothing to try in these graphs: no time passes, or the document declares nothing."""


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
    texts: Mapping[str, str] | None = None,
) -> Stats:
    """Build a suite of `SUITES` from all graphs of one target and write it as a whole or not at all.

    `texts` is what clauses and findings say in our words. Raises Unjudged when the graphs belong to several
    targets, when the walks do not cover what they must, or when the file cannot be written.
    """
    if suite not in SUITES:
        raise Unjudged(f"no suite {suite!r}; {suggestion(suite, SUITES)}")
    if not devices or len({(device.document, device.device.id) for device in devices}) != 1:
        raise Unjudged("a suite is built from the graphs of one target")
    devices = SUITES[suite].variants(devices)
    writer = _Writer(suite, devices, citations)
    for number, device in enumerate(devices):
        writer.add(number, device)
    if not writer.cases:
        raise NoCases(f"{devices[0].device.id} {suite}: the suite would have no cases")
    header = writer.header()
    header["texts"] = _cited_texts(header, texts or {})
    write_lines(path, [_line(header), *writer.cases])
    return writer.stats()


class _Writer:
    def __init__(self, suite: str, devices: Sequence[DeviceGraph], citations: Citations) -> None:
        self.suite, self.kind = suite, SUITES[suite]
        self.device = devices[0]
        self.citations = citations
        self.steps = {name: n for n, name in enumerate(self.device.device.steps)}
        self.transitions: Counter[str] = Counter()
        self.cases: list[str] = []
        self.graphs: list[dict[str, Any]] = []
        self.states = self.columns = self.scans = self.longest = self.inputs = self.used = self.bound = 0
        self.ids: set[str] = set()

    def add(self, number: int, device: DeviceGraph) -> None:
        """Write the cases of one graph."""
        graph, columns = device.graph, merge_columns(device)
        self.states += len(columns.next_of)
        self.columns += len(columns.members)
        self.inputs += len(device.alphabet)
        column_of = {letter: c for c, members in enumerate(columns.members) for letter in members}
        seen: set[tuple[int, int, int]] = set()
        used: set[int] = set()
        scripts = self.kind.plan(device, columns)
        rows = Rows(device)
        for script in scripts.cases:
            self._case(number, rows, script, column_of, seen, used)
        self.transitions.update(graph.steps[step] for _, step, _ in seen)
        self.used += len(used)
        self.bound += scripts.bound
        about = {
            "run": device.run,
            "params": dict(device.params),
            "initial": graph.initial,
            "views": list(graph.views),
        }
        self.graphs.append({**about, **scripts.notes})

    def _case(
        self,
        number: int,
        known: Rows,
        script: Script,
        column_of: Mapping[int, int],
        seen: set[tuple[int, int, int]],
        used: set[int],
    ) -> None:
        device, graph = known.device, known.device.graph
        rows: list[str] = []
        going_in: list[str] = []
        cited: set[str] = set()
        inputs: Pieces = ()
        outputs: Pieces = ()
        state = graph.initial
        by_column = self.kind.counted_by == "column"
        for n, shot in enumerate(script.shots):
            if shot.refuse is not None:
                request = _SORTED(shot.refuse)
                rows.append(f'{{"refuse":{request}}}')
                going_in.append(f'["refuse",{request}]')
                continue
            before, state = state, graph.next_of[state][shot.letter]
            step = graph.step_of[before][shot.letter]
            column = column_of[shot.letter]
            seen.add((before, step, column if by_column else state))
            used.add(shot.letter)
            if not script.about or n in script.about:
                cited.add(graph.steps[step])
            now_in, now_out = known.pieces(shot, state, script.renamed)
            dt_ms = shot.values.get("dt_ms", device.alphabet[shot.letter]["dt_ms"])
            change = changed(inputs, now_in)
            going_in.append(f"[{dt_ms},{{{change}}}]")
            settling = ',"settling":true' if shot.settling else ""
            rows.append(
                f'{{"dt_ms":{dt_ms},"in":{{{change}}},"out":{{{changed(outputs, now_out)}}},'
                f'"step":{self.steps[graph.steps[step]]},"to":{state},"column":{column}'
                f"{settling}}}"
            )
            inputs, outputs = now_in, now_out
        clauses, findings = self._cited(cited)
        params = dict(device.params) if script.reset else {}
        id = id_of_text(device.device.id, params, ",".join(going_in))
        if id in self.ids or (not script.reset and self.cases):
            return  # only the first case of all stands before any reset
        self.ids.add(id)
        case = {
            "id": id,
            "clauses": clauses,
            "basis": f"finding:{','.join(findings)}" if findings else "document",
            "why": script.why,
            "timing": "exact",
            "params": params,
            "graph": number,
        }
        if script.judges:
            case["judges"] = script.judges
        if script.clauses:
            case.update(clauses=sorted(set(script.clauses)), basis=script.basis)
        if script.judges == ADAPTER:
            case.update(clauses=[], basis="protocol")
        if not script.reset:
            case["reset"] = False
        self.cases.append(f'{_ENCODE(case)[:-1]},"scans":[{",".join(rows)}]}}\n')
        self.scans += sum(shot.refuse is None for shot in script.shots)
        self.longest = max(self.longest, len(rows))

    def _cited(self, steps: Iterable[str]) -> tuple[list[str], list[str]]:
        """The clauses and the findings of these steps."""
        clauses: set[str] = set()
        findings: set[str] = set()
        for step in steps:
            of_step = self.citations(step)
            clauses.update(of_step[0])
            findings.update(of_step[1])
        return sorted(clauses), sorted(findings)

    def header(self) -> dict[str, Any]:
        device = self.device.device
        modes = list(self.device.forms.modes)
        kind = self.kind
        return {
            "kind": KIND,
            "version": VERSION,
            "target": device.id,
            "document": self.device.document,
            "protocol": 1,
            "suite": self.suite,
            "relations": list(kind.relations),
            "pace": "fast" if kind.fast else "slow",
            "counted_by": kind.counted_by,
            "shrink": "graph" if all("ways" in graph for graph in self.graphs) else "prefix",
            "guarantees": kind.guarantees,
            "hypothesis": kind.hypothesis,
            "does_not_show": kind.does_not_show + _codes(self.device.codes),
            "generator": "modeproof",
            "cases": len(self.cases),
            "scans": self.scans,
            **({"lower_bound": self.bound} if self.bound else {}),
            "states": self.states,
            "columns": self.columns,
            "transitions": sum(self.transitions.values()),
            "inputs": declare(device.inputs, modes),
            "outputs": declare(device.outputs, modes),
            "parameters": declare_parameters(device, modes),
            **({"profiles": profiles} if (profiles := profiles_of(device)) else {}),
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


def _codes(names: Sequence[str]) -> str:
    """What is not shown of outputs whose values the document does not give."""
    return (
        f"; unless they are compared: {', '.join(names)}, for states are told apart without" if names else ""
    )


def _cited_texts(header: Mapping[str, Any], texts: Mapping[str, str]) -> dict[str, str]:
    """What is said of everything that the steps cite."""
    cited = {id for step in header["steps"] for id in (*step["clauses"], *step["findings"])}
    return {id: texts[id] for id in sorted(cited) if id in texts}


def _line(row: Mapping[str, Any]) -> str:
    return _ENCODE(row) + "\n"
