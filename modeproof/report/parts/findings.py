"""Findings by class: where a document is wrong or silent, what that does, what was decided, the story."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.registers.profiles import strength_of
from modeproof.registers.rows import Document, Finding
from modeproof.registers.runs import Run
from modeproof.registers.standing import CLASSES as CLASSES_OF_ALL
from modeproof.report.claims import NOT_THERE, Result, result_of, steps_of, theorem_result, theorem_rows
from modeproof.report.part import Part
from modeproof.report.sources import HOLE, Sources, Trouble
from modeproof.report.verdicts import ASIDE

ID = "findings"
MOST = 2
"""So many counterexamples of a finding are named on paper."""
CLASSES = (
    ("safety", False, "A property of ours falls, no demand excludes it, and no drawing can settle it"),
    ("safety", True, "A property of ours falls, no demand excludes it, and a drawing could settle it"),
    *((name, None, CLASSES_OF_ALL[name]) for name in ("hazard", "open", "decided", "untried")),
)
"""Class, whether a drawing could settle it (None: either), and what that is called; the worst first."""


def part(sources: Sources) -> Part:
    """One entry a document: its findings, those of safety that no drawing can settle first."""
    troubles: list[Trouble] = []
    found = [_document(sources, document, troubles) for document in sources.documents.values()]
    play = "../" * (2 if sources.filing.documents else 1) + "simulate.html"  # a chosen one lies deeper
    return Part(
        ID, "Findings", {"classes": CLASSES, "most": MOST, "documents": found, "play": play}, tuple(troubles)
    )


def _document(sources: Sources, document: Document, troubles: list[Trouble]) -> dict[str, Any]:
    runs = {run.id: run for run in document.runs}
    sentences = {one.name: one.sentence for _, one in theorem_rows(sources, document)}
    clauses = {clause.id for clause in document.clauses}
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
            rows.append(_evidence(document, result, runs, sentences))
        findings.append(_finding(document, finding, rows))
        if not finding.evidence and not finding.evidence_open.strip():
            what = f"{document.name}: {finding.id} names no evidence and does not say why"
            troubles.append(Trouble(HOLE, ID, what, "modeproof registers"))
    return {
        "id": document.name,
        "title": document.about.title,
        "register": document.source("findings"),
        "findings": findings,
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
        "shown": _shown([row for row in evidence if row["kind"] != "clause"]),
        "open": finding.evidence_open,
        "story": "" if finding.telling is None else finding.telling.story,
        "properties": [each.id for each in document.properties if finding.id in each.findings],
    }


def _shown(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """The shortest ways to the harm, how many runs and theorems more are as expected, and what is not."""
    good = [row for row in rows if row["good"]]
    falls = [row for row in good if row.get("steps") is not None]
    falls.sort(key=lambda row: int(row["steps"].value))
    return {
        "falls": falls[:MOST],
        "runs": sum(row["kind"] == "run" for row in good) - len(falls[:MOST]),
        "proofs": sum(row["kind"] == "theorem" for row in good),
        "aside": sum(row["word"] == ASIDE for row in rows),
        "missing": sum(row["word"] == NOT_THERE for row in rows),
        "wrong": [row for row in rows if not row["good"] and row["word"] not in (ASIDE, NOT_THERE)],
    }


def _evidence(
    document: Document, result: Result, runs: Mapping[str, Run], sentences: Mapping[str, str]
) -> dict[str, Any]:
    run = runs.get(result.id)
    if run is None:
        return {"kind": "theorem", **result.data, "sentence": sentences.get(result.id, "")}
    return {
        "kind": "run",
        **result.data,
        "violates": run.property,
        "environment": run.environment,
        "strength": strength_of(document.root, run),
        "steps": steps_of(result),
    }
