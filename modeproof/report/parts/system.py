"""The system: devices, words and how data flow, from the declaration of names and nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.replay import has_replay, load_replay
from modeproof.registers.rows import Device, Document, Signal
from modeproof.report.drawing.system_picture import Box, Cable, Wire, block_picture, system_picture
from modeproof.report.part import Part, Picture
from modeproof.report.sources import Sources

OUTSIDE_IN, OUTSIDE_OUT = " from outside", " to outside"
"""Ids of what is outside; no device can have them."""


def part(sources: Sources) -> Part:
    """One entry a document."""
    return Part(
        "system", "System", {"documents": [_document(document) for document in sources.documents.values()]}
    )


def _document(document: Document) -> dict[str, Any]:
    devices = document.interface.devices
    rows = _signals(devices)
    people = _people(document)
    outside = ", ".join([*people, "environment"])
    title = f"System picture of {document.name}: {len(devices)} devices and the signals between them"
    id = f"system-{document.name}"
    if len(devices) == 1:
        (only,) = devices.values()
        title = f"The block {only.id} with its inputs and outputs"
        drawn = block_picture(
            Box(only.id, only.title),
            [_wire(other, other.clauses) for other in only.inputs.values()],
            [_wire(output, output.clauses) for output in only.outputs.values()],
            id=id,
            title=title,
        )
    else:
        drawn = _flow(devices, rows, outside, id, title)
    return {
        "id": document.name,
        "title": document.about.title,
        "register": document.source("interface"),
        "outside": outside,
        "devices": [_device(device) for device in devices.values()],
        "signals": [{key: value for key, value in row.items() if key != "wire"} for row in rows],
        "picture": Picture(title, drawn),
    }


def _people(document: Document) -> list[str]:
    """Who executes steps that are no device's, as replay.toml names them."""
    if not has_replay(document.root, document.name):
        return []
    try:
        nobody = load_replay(document.root, document.name).nobody
    except Unjudged:
        return []
    return sorted(set(nobody.values()) - {"environment"})


def _device(device: Device) -> dict[str, Any]:
    return {
        "id": device.id,
        "title": device.title,
        "module": device.module,
        "published": device.published,
        "states": len(device.states),
        "steps": len(device.steps),
        "parameters": [
            {
                "id": name,
                "type": one.type,
                "range": _range(one),
                "default": "none" if one.default is None else one.default,
                "ours": one.project,
                "clauses": one.clauses,
                "why": one.why,
            }
            for name, one in device.parameters.items()
        ],
    }


def _range(signal: Signal) -> str:
    if signal.values:
        return ", ".join(value or '""' for value in signal.values)
    if signal.minimum is None and signal.maximum is None:
        return ""
    least = "" if signal.minimum is None else str(signal.minimum)
    return f"{least}..{'' if signal.maximum is None else signal.maximum}"


def _signals(devices: Mapping[str, Device]) -> list[dict[str, Any]]:
    """Each signal from where it is output to where it is read; "" is outside."""
    rows = []
    for source in devices.values():
        for name, signal in source.outputs.items():
            readers = [
                declared
                for declared in devices.values()
                if declared.id != source.id and name in declared.inputs
            ]
            for reader in readers:
                rows.append(_row(signal, source.id, reader.id, (signal, reader.inputs[name])))
            if not readers:
                rows.append(_row(signal, source.id, "", (signal,)))
    outputs = {(name, declared.id) for declared in devices.values() for name in declared.outputs}
    for reader in devices.values():
        for name, signal in reader.inputs.items():
            if not any(known == name and device != reader.id for known, device in outputs):
                rows.append(_row(signal, "", reader.id, (signal,)))
    return rows


def _row(signal: Signal, source: str, target: str, said: tuple[Signal, ...]) -> dict[str, Any]:
    clauses = tuple(dict.fromkeys(id for other in said for id in other.clauses))
    return {
        "id": signal.name,
        "type": signal.type,
        "from": source,
        "to": target,
        "tag": ", ".join(dict.fromkeys(other.tag for other in said if other.tag)),
        "ours": any(other.project for other in said),
        "clauses": clauses,
        "why": "; ".join(dict.fromkeys(other.why for other in said)),
        "wire": _wire(signal, clauses),
    }


def _wire(signal: Signal, clauses: tuple[str, ...]) -> Wire:
    return Wire(signal.name, signal.type, signal.tag, clauses)


def _flow(
    devices: Mapping[str, Device], rows: list[dict[str, Any]], outside: str, id: str, title: str
) -> Any:
    cables: dict[tuple[str, str], list[Wire]] = {}
    for row in rows:
        ends = row["from"] or OUTSIDE_IN, row["to"] or OUTSIDE_OUT
        cables.setdefault(ends, []).append(row["wire"])
    used = {end for ends in cables for end in ends}
    boxes = [Box(device.id, device.title) for device in devices.values()]
    if OUTSIDE_IN in used:
        boxes.insert(0, Box(OUTSIDE_IN, f"from outside: {outside}", outside=True))
    if OUTSIDE_OUT in used:
        boxes.append(Box(OUTSIDE_OUT, f"to outside: {outside}", outside=True))
    return system_picture(
        boxes, [Cable(*ends, tuple(wires)) for ends, wires in cables.items()], id=id, title=title
    )
