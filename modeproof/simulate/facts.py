"""What the page says, from the registers: names, clauses, findings, faults, recorded counterexamples."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import documents
from modeproof.registers.citations import citations, read_sources
from modeproof.registers.profiles import profiles_of
from modeproof.registers.replay import has_replay, load_replay
from modeproof.registers.rows import Device, Document, Signal
from modeproof.simulate import reasons, recorded
from modeproof.simulate.step_marks import labelled
from modeproof.suites.demands import declare, declare_parameters

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
        devices[device.id] = {**_device(document, device), "steps": steps}
        copies[device.id] = _copy(document, device)
    told = reasons.of_document(document, {device: row["steps"] for device, row in devices.items()})
    used |= reasons.cited(told)
    traces = load_replay(document.root, document.name) if has_replay(document.root, document.name) else None
    runs = recorded.shown(document)
    texts = {clause.id: clause.text for clause in document.clauses if clause.id in used}
    texts |= {finding.id: finding.title for finding in document.findings if finding.id in used}
    return {
        "document": document.name,
        "title": document.about.title,
        "module": f"{REFERENCE}.{document.name}.",
        "devices": devices,
        "labelled": copies,
        "readings": _readings(document),
        "reasons": told,
        "texts": texts,
        "clauses": [clause.id for clause in document.clauses if clause.id in used],
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
        "recorded": runs,
        "findings": recorded.findings(document, [run["run"] for run in runs]),
    }


def _device(document: Document, device: Device) -> dict[str, Any]:
    groups = {"inputs": device.inputs, "outputs": device.outputs, "parameters": device.parameters}
    rows = {name: {of.name: _signal(of) for of in group.values()} for name, group in groups.items()}
    profiles = profiles_of(device)
    modes = list(document.interface.constants.get("MODES", ()))
    declared = {
        "inputs": declare(device.inputs, modes),
        "outputs": declare(device.outputs, modes),
        "parameters": declare_parameters(device, modes),
        **({"profiles": profiles} if profiles else {}),
    }
    about = {"title": device.title, "profiles": profiles, "states": list(device.states)}
    return {**about, "published": device.published, "vectors": declared, **rows}


def _signal(of: Signal) -> dict[str, Any]:
    row: dict[str, Any] = {"type": of.type, "why": of.why, "values": list(of.values)}
    if of.default is not None:
        row["default"] = of.default
    return row


def _source(document: Document, device: str) -> tuple[Path, str]:
    path = document.root / REFERENCE / document.name / f"{device}.py"
    try:
        return path, path.read_text(encoding="utf-8")
    except OSError as error:
        raise Unjudged(f"{path}: {error.strerror}; the page runs this file") from None


def _copy(document: Document, device: Device, edited: str = "") -> str:
    """The functions that tell the steps. Raises Unjudged where a step is marked nowhere."""
    path, source = _source(document, device.id)
    text, told = labelled(edited or source, device.steps)
    if missing := sorted(set(device.steps) - told):
        raise Unjudged(f"{path}: no line is marked with the step {missing[0]}")
    return text


def _readings(document: Document) -> dict[str, Any]:
    """Programs of other readings: the shipped text with the edits of scenes/<document>/stories.toml.

    Raises Unjudged where no finding tries the reading, or a text to be edited does not stand there just once.
    """
    path = document.root / "scenes" / document.name / "stories.toml"
    if not path.is_file():
        return {}
    tried = {name for finding in document.findings for name in finding.tries}
    made: dict[str, Any] = {}
    for reading in tomllib.loads(path.read_text(encoding="utf-8")).get("reading", ()):
        id, device = reading["id"], document.interface.devices[reading["device"]]
        if id not in tried:
            raise Unjudged(f"{path}: {id}: no finding tries this reading")
        file, source = _source(document, device.id)
        for edit in reading["edit"]:
            if source.count(edit["old"]) != 1:
                raise Unjudged(f"{path}: {id}: {file.name} does not hold just once: {edit['old']!r}")
            source = source.replace(edit["old"], edit["new"])
        made[id] = {"device": device.id, "source": source, "labelled": _copy(document, device, source)}
    return made


def scenes(place: Path) -> list[str]:
    """The documents whose devices are drawn as one cell; the others have a card for each block."""
    return [name for name in documents(place) if (place / "scenes" / name / "cell.html.j2").is_file()]


def stories(place: Path, names: Sequence[str]) -> list[dict[str, Any]]:
    """The stories of the documents, in the order of scenes/<document>/stories.toml."""
    told: list[dict[str, Any]] = []
    for name in names:
        path = place / "scenes" / name / "stories.toml"
        if path.is_file():
            told += tomllib.loads(path.read_text(encoding="utf-8"))["story"]
    return told
