"""What the page says, from the registers: names, clauses, findings, faults, recorded counterexamples."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build
from modeproof.registers.citations import citations, read_sources
from modeproof.registers.replay import Traces, has_replay, load_replay
from modeproof.registers.rows import Device, Document, Signal
from modeproof.report.cells import Cells
from modeproof.report.story import digest_of
from modeproof.simulate.steps import labelled

REFERENCE = "refimpl"


def of_document(document: Document) -> dict[str, Any]:
    """One document. Raises Unjudged where the code of a device cannot be read."""
    cited = {
        f"{citation.name}": citation
        for citation in citations(document, read_sources(document))
        if citation.kind == "definition" and citation.room == "spec"
    }
    devices, copies, used = {}, {}, set()
    for device in document.interface.devices.values():
        steps = {}
        for step in device.steps:
            citation = cited.get(f"{device.module}!{step}")
            steps[step] = [*citation.clauses, *citation.findings] if citation else []
            used |= {*steps[step]}
        devices[device.id] = {**_device(device), "steps": steps}
        copies[device.id] = _copy(document, device)
    traces = load_replay(document.root, document.name) if has_replay(document.root, document.name) else None
    texts = {clause.id: clause.text for clause in document.clauses if clause.id in used}
    texts |= {finding.id: finding.title for finding in document.findings if finding.id in used}
    return {
        "title": document.about.title,
        "module": f"{REFERENCE}.{document.name}.",
        "devices": devices,
        "labelled": copies,
        "texts": texts,
        "says": {} if traces is None else {name: of.says for of in traces.words for name in of.signals},
        "faults": [
            {
                "id": fault.id,
                "kind": fault.kind,
                "title": fault.title,
                "model": fault.model,
                "detected_by": list(fault.detected_by),
                "not_detected": fault.not_detected,
                "falls": [{"property": fall.property, "needs": fall.needs} for fall in fault.falls],
            }
            for fault in document.faults
        ],
        "recorded": _recorded(document, traces),
    }


def _device(device: Device) -> dict[str, Any]:
    groups = {"inputs": device.inputs, "outputs": device.outputs, "parameters": device.parameters}
    rows = {name: {of.name: _signal(of) for of in group.values()} for name, group in groups.items()}
    return {"title": device.title, "published": device.published, **rows}


def _signal(of: Signal) -> dict[str, Any]:
    row: dict[str, Any] = {"type": of.type, "why": of.why, "values": list(of.values)}
    if of.default is not None:
        row["default"] = of.default
    return row


def _copy(document: Document, device: Device) -> str:
    """The functions that tell the steps. Raises Unjudged where a step is marked nowhere."""
    path = document.root / REFERENCE / document.name / f"{device.id}.py"
    try:
        text, told = labelled(path.read_text(encoding="utf-8"), device.steps)
    except OSError as error:
        raise Unjudged(f"{path}: {error.strerror}; the page runs this file") from None
    if missing := sorted(set(device.steps) - told):
        raise Unjudged(f"{path}: no line is marked with the step {missing[0]}")
    return text


def _recorded(document: Document, traces: Traces | None) -> list[dict[str, Any]]:
    """The counterexamples whose evidence and walk are there and belong together, by finding."""
    found = []
    for run in document.runs:
        walk = None if traces is None else _walk(document, run.id)
        if traces is None or walk is None:
            continue
        cells = Cells(document.interface, traces, walk["tables"])
        first = walk["rows"][0]["variables"]
        variables = {
            name: cells.state_variable(name, first)
            for name, device in document.interface.devices.items()
            if device.memory and cells.state_variable(name, first) in first
        }
        found.append(
            {
                "run": run.id,
                "property": run.property,
                "says": next((p.sentence for p in document.properties if p.tla == run.property), ""),
                "findings": [
                    [
                        f.id,
                        f.title,
                        f.telling.story if f.telling and f.telling.run == run.id else f.consequence,
                    ]
                    for f in document.findings
                    if run.id in f.evidence
                ],
                "rows": [
                    {
                        "step": row["step"],
                        "who": row["who"] or traces.nobody.get(row["step"], ""),
                        "wires": row["wires"],
                        "states": {name: row["variables"][of] for name, of in variables.items()},
                    }
                    for row in walk["rows"]
                ],
            }
        )
    return found


def _walk(document: Document, run: str) -> dict[str, Any] | None:
    """The walk of a run, if its evidence is as expected and the walk is of this very trace."""
    place = document.root
    try:
        record = evidence.read(evidence.evidence_path(place, document.name, run))
        walk = json.loads((build(place) / "walks" / document.name / f"{run}.json").read_bytes())
    except (Unjudged, OSError, ValueError):
        return None
    trace = record["result"].get("trace")
    same = isinstance(walk, dict) and trace and walk.get("trace_sha256") == digest_of(trace)
    return walk if same and record["as_expected"] else None


def stories(place: Path, names: Sequence[str]) -> list[dict[str, Any]]:
    """The stories of the documents, in the order of scenes/<document>/stories.toml."""
    told: list[dict[str, Any]] = []
    for name in names:
        path = place / "scenes" / name / "stories.toml"
        if path.is_file():
            told += tomllib.loads(path.read_text(encoding="utf-8"))["story"]
    return told
