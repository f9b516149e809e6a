"""The readings that were tried: what fails when a device follows another reading than the decided one."""

from __future__ import annotations

from typing import Any

from modeproof.registers.profiles import strength_of
from modeproof.registers.rows import Document
from modeproof.report.claims import Result, steps_of
from modeproof.report.deviations import Deviation, deviations
from modeproof.report.part import Part
from modeproof.report.sources import Sources

ID = "readings"


def part(sources: Sources) -> Part:
    """One entry a document: each reading tried alone, then several together."""
    found = [_document(sources, document) for document in sources.documents.values()]
    return Part(ID, "Readings tried", {"documents": found})


def _document(sources: Sources, document: Document) -> dict[str, Any]:
    every = deviations(sources, document)
    return {
        "id": document.name,
        "title": document.about.title,
        "alone": [_deviation(document, row) for row in every if len(row.readings) == 1],
        "together": [_deviation(document, row) for row in every if len(row.readings) > 1],
    }


def _deviation(document: Document, deviation: Deviation) -> dict[str, Any]:
    falls = next(
        (each for each in document.properties if deviation.run.property in (each.tla, each.id)), None
    )
    return {
        **deviation.result.data,
        "readings": list(deviation.readings),
        "findings": [{"id": each.id, "title": each.title} for each in deviation.findings],
        "falls": deviation.run.property,
        "property": None if falls is None else falls.id,
        "hazard": "" if falls is None else falls.hazard,
        "harmless": deviation.harmless,
        "holding": deviation.holding,
        "also": [one.data for one in deviation.also],
        "reached": _reached(deviation.result),
        "steps": steps_of(deviation.result),
        "environment": deviation.run.environment,
        "strength": strength_of(document.root, deviation.run),
        "seconds": None
        if deviation.result.evidence is None
        else deviation.result.evidence.figure("seconds", unit="s"),
    }


def _reached(result: Result) -> list[str]:
    """What a run of witnesses has reached under the readings."""
    return [] if result.evidence is None else list(result.evidence.result.get("reached", ()))
