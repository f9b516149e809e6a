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
            "documents": [_document(sources, document) for document in sources.documents.values()],
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
            {"id": assumption.id, "title": assumption.title, "text": assumption.breaks_open}
            for assumption in document.assumptions
            if assumption.kind == "assumption" and assumption.breaks_open
        ],
        "abstractions": [
            {"id": assumption.id, "title": assumption.title, "text": assumption.text, "kind": assumption.kind}
            for assumption in document.assumptions
            if assumption.kind != "assumption"
        ],
        "findings": [
            {"id": finding.id, "title": finding.title, "text": finding.evidence_open}
            for finding in document.findings
            if finding.evidence_open
        ],
        "drawings": [
            {"id": finding.id, "title": finding.title, "text": finding.decision}
            for finding in document.findings
            if finding.drawing_could_settle
        ],
        "faults": [
            {"id": fault.id, "title": fault.title, "text": fault.not_detected, "left": fault.not_modelled}
            for fault in document.faults
            if fault.not_detected or fault.not_modelled
        ],
        "aside": [
            {"id": line.property, "environment": line.environment}
            for line in lines_of(sources, document)
            if line.verdict == ASIDE
        ],
        "not_available": document.about.not_available,
    }
