"""Scope: which papers, what of them was available, what is modelled, and what was left out and why."""

from __future__ import annotations

from typing import Any

from modeproof.registers.rows import Document
from modeproof.report.part import Part
from modeproof.report.sources import Sources


def part(sources: Sources) -> Part:
    """One entry a document."""
    return Part("scope", "Scope", {"documents": [_document(one) for one in sources.documents.values()]})


def _document(document: Document) -> dict[str, Any]:
    about = document.about
    return {
        "id": document.name,
        "title": about.title,
        "number": about.number,
        "edition": about.edition,
        "publisher": about.publisher,
        "sha256": about.sha256,
        "available": about.available,
        "not_available": about.not_available,
        "not_endorsed": about.not_endorsed,
        "register": document.source("document"),
        "devices": [
            {"id": one.id, "title": one.title, "published": one.published}
            for one in document.interface.devices.values()
        ],
        "clauses": len(document.clauses),
        "left_out": [
            {"id": one.id, "title": one.title, "because": one.because}
            for one in document.clauses
            if one.because
        ],
    }
