"""Explorer: every exported graph, to be walked in the page; and the properties that speak of its device.

The page decides nothing by itself: each step is looked up in the graph that was compared.
"""

from __future__ import annotations

import gzip
import json
import zlib
from typing import Any

from modeproof.registers.citations import ids_of
from modeproof.registers.profiles import strength_of
from modeproof.registers.rows import Device, Document, Property
from modeproof.registers.runs import Run
from modeproof.registers.tla import closure
from modeproof.report.claims import LANE, texts_of
from modeproof.report.codes import codes_of
from modeproof.report.part import Part
from modeproof.report.sources import DIFFERS, HOLE, Evidence, Figure, Sources, Trouble

ID = "explorer"
FORMAT = 1
"""The form of an export that the page understands."""
ABOUT = "explorer-about"


def part(sources: Sources) -> Part:
    """One entry a graph, and one a device; the graphs themselves are payload."""
    troubles: list[Trouble] = []
    payload: dict[str, bytes] = {}
    graphs = [
        _graph(sources, document, run, troubles, payload)
        for document in sources.documents.values()
        for run in document.runs
        if run.graph is not None
    ]
    devices = {
        f"{document.name}/{device.id}": _device(sources, document, device)
        for document in sources.documents.values()
        for device in document.interface.devices.values()
        if any(graph["document"] == document.name and graph["device"] == device.id for graph in graphs)
    }
    payload[ABOUT] = _json(
        {"devices": devices, "graphs": {graph["id"]: graph["checked"] for graph in graphs}}
    )
    return Part(ID, "Trace explorer", {"graphs": graphs, "devices": devices}, tuple(troubles), payload)


def _json(value: Any) -> bytes:
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False).encode("utf-8")


def _graph(
    sources: Sources, document: Document, run: Run, troubles: list[Trouble], payload: dict[str, bytes]
) -> dict[str, Any]:
    """A row of the table of graphs; `shown` says whether the page carries the graph."""
    assert run.graph is not None
    device = document.interface.devices[run.graph.device]
    compared = next(
        (
            piece
            for piece in sources.of_kind(document.name, "conformance")
            if piece.result.get("run") == f"{document.name}/{run.id}" and "states" in piece.result
        ),
        None,
    )
    content, trouble = _export(sources, document, run, compared)
    id = f"{document.name}-{run.id}"
    if trouble is not None:
        troubles.append(trouble)
    if content is not None:
        payload[f"graph-{id}"] = content
    figures = {
        key: None if compared is None else compared.figure("result", key)
        for key in ("states", "inputs", "transitions")
    }
    checked = sources.evidence[document.name].get(run.id)
    return {
        "id": id,
        "document": document.name,
        "title": document.about.title,
        "run": run.id,
        "device": device.id,
        "says": device.title,
        "strength": strength_of(document.root, run),
        "parameters": dict(run.graph.params),
        "register": document.source("runs"),
        **figures,
        "verdict": None if compared is None else Figure(compared.record["verdict"], compared.path),
        "good": None if compared is None or compared.changed else bool(compared.record["as_expected"]),
        "shown": content is not None,
        "checked": [
            prop.id
            for prop in document.properties
            if checked is not None and not checked.changed and _holds(prop, run, checked)
        ],
    }


def _holds(prop: Property, run: Run, checked: Evidence) -> bool:
    """Whether the run that printed the graph checked the property on it, and it holds."""
    return bool({prop.id, prop.tla} & set(run.properties)) and checked.record["as_expected"] is True


def _export(
    sources: Sources, document: Document, run: Run, compared: Evidence | None
) -> tuple[bytes | None, Trouble | None]:
    """The export's text, or why there is none."""
    name = f"{document.name}/{run.id}"
    remedy = f"modeproof verify --document {document.name}"
    made = [] if compared is None else list(compared.result.get("artefacts", {}))
    if compared is None and LANE not in run.lanes:
        return None, None
    if compared is None or not made:
        what = "no comparison of its graph is recorded" if compared is None else "its graph was not exported"
        return None, Trouble(HOLE, ID, f"{name}: {what}", remedy)
    path = made[0]
    packed = sources.content(path)
    if packed is None:
        return None, Trouble(HOLE, ID, f"{name}: {path} is not there", remedy)
    if path in compared.changed:
        return None, Trouble(DIFFERS, ID, f"{name}: {path} is not what the comparison wrote", remedy)
    try:
        content = gzip.decompress(packed)
        found = json.loads(content)
    except (OSError, EOFError, zlib.error, ValueError):
        found = None
    if not isinstance(found, dict) or found.get("format") != FORMAT:
        return None, Trouble(HOLE, ID, f"{name}: {path} is no graph of format {FORMAT}", remedy)
    if (found.get("document"), found.get("run")) != (document.name, run.id):
        return None, Trouble(DIFFERS, ID, f"{name}: {path} is the graph of another run", remedy)
    return content, None


def _device(sources: Sources, document: Document, device: Device) -> dict[str, Any]:
    """What the page says about a device beside its graph."""
    codes = codes_of(sources, document)
    signals = {**device.memory, **device.inputs, **device.outputs}
    return {
        "document": document.name,
        "device": device.id,
        "title": device.title,
        "signals": {name: {"type": one.type, "why": one.why} for name, one in signals.items()},
        "codes": {
            name: {"says": codes[name].says, "words": codes[name].words} for name in signals if name in codes
        },
        "actions": _actions(sources, document, device),
        "properties": [
            {
                "id": prop.id,
                "title": prop.title,
                "sentence": prop.sentence,
                "hazard": prop.hazard,
                "of": OF[prop.kind],
                "clauses": list(prop.clauses),
            }
            for prop in document.properties
            if device.id in _speaks_of(sources, document, prop)
        ],
    }


OF = {
    "invariant": "each state",
    "action": "each transition",
    "liveness": "what comes in the end",
    "refinement": "the whole behaviour",
}
"""What a property of a kind speaks of."""


def _actions(sources: Sources, document: Document, device: Device) -> dict[str, dict[str, list[str]]]:
    """The clauses and findings that each action of the device cites in the specification."""
    ids = ids_of(document)
    found: dict[str, str] = {}
    for module in closure(texts_of(sources, document).modules, device.module):
        for definition in module.definitions:
            if definition.name in device.steps:
                found.setdefault(definition.name, definition.comment)
    cited = {step: ids.read(found.get(step, "")) for step in device.steps}
    return {
        step: {"clauses": list(clauses), "findings": list(findings)}
        for step, (clauses, findings, _) in cited.items()
    }


def _speaks_of(sources: Sources, document: Document, prop: Property) -> set[str]:
    """The devices of a property: those that its text reaches; of several, those whose clauses it cites."""
    texts = texts_of(sources, document).modules
    reached = {module.name for module in closure(texts, prop.module)}
    devices = {of.id for of in document.interface.devices.values() if of.module in reached}
    if len(devices) < 2:
        return devices
    cited = {of for clause in document.clauses if clause.id in prop.clauses for of in clause.device}
    return devices & cited
