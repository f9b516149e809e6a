"""Findings: where a document is wrong or silent, what that does, what was decided, what shows it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.registers.rows import Document, Finding
from modeproof.registers.runs import Run
from modeproof.report.claims import Result, result_of, steps_of, theorem_result, theorem_rows
from modeproof.report.deviations import Deviation, deviations
from modeproof.report.part import Part
from modeproof.report.sources import HOLE, Sources, Trouble

ID = "findings"


def part(sources: Sources) -> Part:
    """One entry a document: its findings, and what each reading does when it alone is restored."""
    troubles: list[Trouble] = []
    found = [_document(sources, one, troubles) for one in sources.documents.values()]
    return Part(ID, "Findings in the documents", {"documents": found}, tuple(troubles))


def _document(sources: Sources, document: Document, troubles: list[Trouble]) -> dict[str, Any]:
    runs = {one.id: one for one in document.runs}
    sentences = {one.name: one.sentence for _, one in theorem_rows(sources, document)}
    clauses = {one.id for one in document.clauses}
    shown: list[Result] = []
    findings = []
    for one in document.findings:
        rows = []
        for name in one.evidence:
            if name in clauses:
                rows.append({"kind": "clause", "id": name})
                continue
            result = (
                result_of(sources, document, runs[name])
                if name in runs
                else theorem_result(sources, document, name)
            )
            shown.append(result)
            rows.append(_evidence(result, runs, sentences))
        findings.append(_finding(document, one, rows))
        if not one.evidence and not one.evidence_open.strip():
            what = f"{document.name}: {one.id} names no evidence and does not say why"
            troubles.append(Trouble(HOLE, ID, what, "modeproof registers"))
    every = deviations(sources, document)
    shown += [one.result for one in every]
    return {
        "id": document.name,
        "title": document.about.title,
        "register": document.source("findings"),
        "findings": findings,
        "alone": [_deviation(document, one) for one in every if len(one.readings) == 1],
        "together": [_deviation(document, one) for one in every if len(one.readings) > 1],
    }


def _finding(document: Document, one: Finding, evidence: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "id": one.id,
        "title": one.title,
        "class": one.severity,
        "clauses": list(one.clauses),
        "says": one.says,
        "readings": list(one.readings),
        "consequence": one.consequence,
        "decision": one.decision,
        "switches": list(one.switches),
        "drawing": one.drawing_could_settle,
        "evidence": evidence,
        "open": one.evidence_open,
        "properties": [each.id for each in document.properties if one.id in each.findings],
    }


def _evidence(one: Result, runs: Mapping[str, Run], sentences: Mapping[str, str]) -> dict[str, Any]:
    run = runs.get(one.id)
    if run is None:
        return {"kind": "theorem", **one.data, "sentence": sentences.get(one.id, "")}
    return {
        "kind": "run",
        **one.data,
        "violates": run.property,
        "environment": run.environment,
        "strength": run.strength,
        "steps": steps_of(one),
    }


def _deviation(document: Document, one: Deviation) -> dict[str, Any]:
    falls = next((each for each in document.properties if one.run.property in (each.tla, each.id)), None)
    return {
        **one.result.data,
        "readings": list(one.readings),
        "findings": [{"id": each.id, "title": each.title} for each in one.findings],
        "falls": one.run.property,
        "property": None if falls is None else falls.id,
        "hazard": "" if falls is None else falls.hazard,
        "harmless": one.harmless,
        "reached": _reached(one.result),
        "steps": steps_of(one.result),
        "environment": one.run.environment,
        "strength": one.run.strength,
        "seconds": None if one.result.evidence is None else one.result.evidence.figure("seconds", unit="s"),
    }


def _reached(one: Result) -> list[str]:
    """What a run of witnesses has reached under the readings."""
    return [] if one.evidence is None else list(one.evidence.result.get("reached", ()))
