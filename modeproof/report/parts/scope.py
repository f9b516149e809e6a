"""Scope: which papers, what of them was available, what is modelled, and what was left out and why."""

from __future__ import annotations

from typing import Any

from modeproof.registers.rows import Device, Document
from modeproof.report.part import Part
from modeproof.report.sources import Figure, Sources

LEFT_OUT = "not modelled"


def part(sources: Sources) -> Part:
    """One entry a document."""
    return Part(
        "scope", "Scope", {"documents": [_document(document) for document in sources.documents.values()]}
    )


def _document(document: Document) -> dict[str, Any]:
    about = document.about
    kinds = dict.fromkeys(clause.kind for clause in document.clauses)
    clauses = document.source("clauses")
    return {
        "id": document.name,
        "title": about.title,
        "number": about.number,
        "edition": about.edition,
        "publisher": about.publisher,
        "seed": about.seed,
        "sha256": Figure(about.sha256, document.source("clauses")),
        "available": about.available,
        "not_available": about.not_available,
        "not_endorsed": about.not_endorsed,
        "sources": about.sources,
        "register": document.source("clauses"),
        "devices": [
            _device(device, document.source("interface")) for device in document.interface.devices.values()
        ],
        "clauses": Figure(len(document.clauses), clauses),
        "kinds": [
            {"kind": kind, "count": Figure(sum(clause.kind == kind for clause in document.clauses), clauses)}
            for kind in kinds
        ],
        "left_out": [
            {"id": clause.id, "title": clause.title, "because": clause.because}
            for clause in document.clauses
            if clause.kind == LEFT_OUT or clause.because
        ],
    }


def _device(device: Device, register: str) -> dict[str, Any]:
    groups = (device.memory, device.inputs, device.outputs, device.parameters)
    names = ("memory", "inputs", "outputs", "parameters")
    return {
        "id": device.id,
        "title": device.title,
        "module": device.module,
        "published": device.published,
        "states": Figure(len(device.states), register),
        "steps": Figure(len(device.steps), register),
        **{name: Figure(len(group), register) for name, group in zip(names, groups, strict=True)},
    }
