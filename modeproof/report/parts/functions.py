"""Safety functions: of each the hazard, requirement, evidence, assumptions, and who confirms them."""

from __future__ import annotations

from typing import Any

from modeproof.registers.demands import load_demand_rows
from modeproof.registers.rows import Document
from modeproof.report.bearing import assumptions_of, needed_by
from modeproof.report.claims import Claim, claims
from modeproof.report.part import Part
from modeproof.report.parts.review import sheet
from modeproof.report.sources import DIFFERS, Sources
from modeproof.report.verdicts import ASIDE

ID = "functions"


def part(sources: Sources) -> Part:
    """One row a safety function, by document.

    A requirement is a safety function where the wires of a device show it (it is in demands.toml), or
    where it fails when an assumption about the machine is not true. All others are in the annex.
    """
    rows = {
        (item.document, item.id): row.id
        for row in sheet(sources)
        for item in row.items
        if item.group == "requirement"
    }
    found = [_document(sources, document, rows) for document in sources.documents.values()]
    return Part(ID, "Safety functions", {"documents": found})


def _document(sources: Sources, document: Document, rows: dict[tuple[str, str], str]) -> dict[str, Any]:
    chosen = {name for needs in needed_by(sources, document).values() for name in needs}
    demanded = {row.id for row in load_demand_rows(document.root, document.name).rows}
    chosen |= demanded
    by: dict[str, list[Claim]] = {}
    for claim in claims(sources, document):
        by.setdefault(claim.of.id, []).append(claim)
    return {
        "id": document.name,
        "title": document.about.title,
        "others": len(document.properties) - sum(prop.id in chosen for prop in document.properties),
        "rows": [
            {
                "id": prop.id,
                "title": prop.title,
                "hazard": prop.hazard,
                "demanded": prop.id in demanded,
                "sentence": prop.sentence,
                "clauses": prop.clauses,
                "findings": prop.findings,
                "evidence": _evidence(by.get(prop.id, [])),
                "assumptions": [
                    {"id": row.id, "title": row.title, "who": row.who}
                    for row in assumptions_of(sources, document, prop)
                ],
                "row": rows.get((document.name, prop.id), ""),
            }
            for prop in document.properties
            if prop.id in chosen and prop.kind != "liveness"
        ],
    }


def _evidence(own: list[Claim]) -> dict[str, Any]:
    """Who judged it: the environments in which a search found it true, the proofs, and what is not there."""
    judged = [claim for claim in own if claim.word != ASIDE]
    searched = [claim for claim in judged if claim.shown is not None and claim.shown.status == 0]
    theorems = {theorem.id: theorem for claim in own for theorem in claim.theorems}.values()
    wrong = [f"{claim.environment}: {claim.word}" for claim in judged if claim not in searched]
    wrong += [f"a proof: {word}" for word in sorted({each.word for each in theorems if each.status})]
    failed = any(claim.status == DIFFERS for claim in judged)
    return {
        "good": False if failed else None if wrong or not judged else True,
        "searched": [claim.environment for claim in searched],
        "proved": any(theorem.good for theorem in theorems),
        "wrong": wrong,
        "aside": not judged,
    }
