"""Response times: from what to what, the longest time in symbols and in an example, and what shows it."""

from __future__ import annotations

from typing import Any

from modeproof.registers.responses import EXPLAINED, bounds, chain_bounds, example_of, theorems_of
from modeproof.registers.rows import Document
from modeproof.report.claims import texts_of
from modeproof.report.part import Part
from modeproof.report.sources import HOLE, Sources, Trouble

ID = "responses"


def part(sources: Sources) -> Part:
    """One entry a document that states response times."""
    stating = [document for document in sources.documents.values() if document.responses.rows]
    unproved = [
        Trouble(HOLE, ID, f"{document.name}: no theorem names {row.id}", "modeproof registers")
        for document in stating
        for row in document.responses.rows
        if not theorems_of(texts_of(sources, document), row)
    ]
    found = [_document(sources, document) for document in stating]
    return Part(ID, "Response times", {"explained": EXPLAINED, "documents": found}, tuple(unproved))


def _document(sources: Sources, document: Document) -> dict[str, Any]:
    return {
        "id": document.name,
        "title": document.about.title,
        "register": document.source("properties"),
        "example": example_of(document),
        "rows": bounds(document, texts_of(sources, document)),
        "chains": chain_bounds(document),
    }
