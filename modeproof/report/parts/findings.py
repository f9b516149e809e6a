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
    found = [_document(sources, document, troubles) for document in sources.documents.values()]
    return Part(ID, "Findings in the documents", {"documents": found}, tuple(troubles))


def _document(sources: Sources, document: Document, troubles: list[Trouble]) -> dict[str, Any]:
    runs = {run.id: run for run in document.runs}
    sentences = {one.name: one.sentence for _, one in theorem_rows(sources, document)}
    clauses = {clause.id for clause in document.clauses}
    shown: list[Result] = []
    findings = []
    for finding in document.findings:
        rows = []
        for name in finding.evidence:
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
        findings.append(_finding(document, finding, rows))
        if not finding.evidence and not finding.evidence_open.strip():
            what = f"{document.name}: {finding.id} names no evidence and does not say why"
            troubles.append(Trouble(HOLE, ID, what, "modeproof registers"))
    every = deviations(sources, document)
    shown += [row.result for row in every]
    return {
        "id": document.name,
        "title": document.about.title,
        "register": document.source("findings"),
        "findings": findings,
        "alone": [_deviation(document, row) for row in every if len(row.readings) == 1],
        "together": [_deviation(document, row) for row in every if len(row.readings) > 1],
    }


def _finding(document: Document, finding: Finding, evidence: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "id": finding.id,
        "title": finding.title,
        "class": finding.severity,
        "clauses": list(finding.clauses),
        "says": finding.says,
        "readings": list(finding.readings),
        "consequence": finding.consequence,
        "decision": finding.decision,
        "tries": list(finding.tries),
        "parameter": finding.parameter,
        "drawing": finding.drawing_could_settle,
        "evidence": evidence,
        "open": finding.evidence_open,
        "properties": [each.id for each in document.properties if finding.id in each.findings],
    }


def _evidence(result: Result, runs: Mapping[str, Run], sentences: Mapping[str, str]) -> dict[str, Any]:
    run = runs.get(result.id)
    if run is None:
        return {"kind": "theorem", **result.data, "sentence": sentences.get(result.id, "")}
    return {
        "kind": "run",
        **result.data,
        "violates": run.property,
        "environment": run.environment,
        "strength": run.strength,
        "steps": steps_of(result),
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
        "reached": _reached(deviation.result),
        "steps": steps_of(deviation.result),
        "environment": deviation.run.environment,
        "strength": deviation.run.strength,
        "seconds": None
        if deviation.result.evidence is None
        else deviation.result.evidence.figure("seconds", unit="s"),
    }


def _reached(result: Result) -> list[str]:
    """What a run of witnesses has reached under the readings."""
    return [] if result.evidence is None else list(result.evidence.result.get("reached", ()))
