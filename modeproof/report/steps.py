"""What each step of a device cites: the clauses and findings named over its action in the specification."""

from __future__ import annotations

from dataclasses import dataclass

from modeproof.registers.citations import Citation, citations, read_sources
from modeproof.registers.rows import Device, Document
from modeproof.report.sources import Sources


@dataclass(frozen=True)
class Cited:
    """Clauses and findings in the order in which they are named."""

    clauses: tuple[str, ...] = ()
    findings: tuple[str, ...] = ()


def cited(sources: Sources, document: Document) -> tuple[Citation, ...]:
    """Every citation of a document, read once for all parts."""
    key = f"citations of {document.name}"
    if key not in sources.cache:
        sources.cache[key] = citations(document, read_sources(document))
    found: tuple[Citation, ...] = sources.cache[key]
    return found


def of_steps(sources: Sources, document: Document, device: Device) -> dict[str, Cited]:
    """By step of the device; a step whose action cites nothing has an empty row."""
    by_name = {
        citation.name: Cited(citation.clauses, citation.findings)
        for citation in cited(sources, document)
        if citation.kind == "definition" and citation.room == "spec"
    }
    return {step: by_name.get(f"{device.module}!{step}", Cited()) for step in device.steps}
