"""What this does not show: from the registers first, then the project's own page of limits."""

from __future__ import annotations

from typing import Any

from modeproof.registers.rows import Document
from modeproof.report.part import Part
from modeproof.report.snapshot import lines_of
from modeproof.report.sources import HOLE, Sources, Trouble
from modeproof.report.text import blocks
from modeproof.report.verdicts import ASIDE

PAGE = "docs/limits.md"


def part(sources: Sources) -> Part:
    """What each document's registers leave open, and the page of limits."""
    content = sources.content(PAGE)
    troubles: tuple[Trouble, ...] = ()
    if content is None:
        troubles = (Trouble(HOLE, "limits", f"{PAGE}, which says what no result shows, is not there"),)
    return Part(
        "limits",
        "What this does not show",
        {
            "documents": [_document(sources, one) for one in sources.documents.values()],
            "page": PAGE,
            "text": blocks(content.decode("utf-8", "replace")) if content else [],
        },
        troubles,
    )


def _document(sources: Sources, document: Document) -> dict[str, Any]:
    return {
        "id": document.name,
        "title": document.about.title,
        "assumptions": [
            {"id": one.id, "title": one.title, "text": one.breaks_open}
            for one in document.assumptions
            if one.kind == "assumption" and one.breaks_open
        ],
        "abstractions": [
            {"id": one.id, "title": one.title, "text": one.text, "kind": one.kind}
            for one in document.assumptions
            if one.kind != "assumption"
        ],
        "findings": [
            {"id": one.id, "title": one.title, "text": one.evidence_open}
            for one in document.findings
            if one.evidence_open
        ],
        "drawings": [
            {"id": one.id, "title": one.title, "text": one.decision}
            for one in document.findings
            if one.drawing_could_settle
        ],
        "faults": [
            {"id": one.id, "title": one.title, "text": one.not_detected, "left": one.not_modelled}
            for one in document.faults
            if one.not_detected or one.not_modelled
        ],
        "aside": [
            {"id": line.property, "environment": line.environment}
            for line in lines_of(sources, document)
            if line.verdict == ASIDE
        ],
        "not_available": document.about.not_available,
    }
