"""Assumptions: what is taken for granted, who must ensure it, how to check it, what breaks without it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.registers.rows import Assumption, Document
from modeproof.registers.runs import Run
from modeproof.report.bearing import rests_on
from modeproof.report.claims import Result, result_of, steps_of
from modeproof.report.part import Part
from modeproof.report.sources import HOLE, Sources, Trouble

ID = "assumptions"


def part(sources: Sources) -> Part:
    """One entry a document."""
    troubles: list[Trouble] = []
    found = [_document(sources, document, troubles) for document in sources.documents.values()]
    return Part(ID, "Assumptions and abstractions", {"documents": found}, tuple(troubles))


def _document(sources: Sources, document: Document, troubles: list[Trouble]) -> dict[str, Any]:
    runs = {run.id: run for run in document.runs}
    rests = rests_on(sources, document)
    shown: list[Result] = []
    rows = []
    for assumption in document.assumptions:
        breaking = [result_of(sources, document, runs[name]) for name in assumption.breaks if name in runs]
        shown += breaking
        rows.append(_row(document, assumption, breaking, runs, rests.get(assumption.id, ())))
        if not assumption.breaks and not assumption.breaks_open.strip():
            where = f"{document.name}: {assumption.id}"
            what = f"{where}: no run shows what breaks without it, and no reason is given"
            troubles.append(Trouble(HOLE, ID, what, "modeproof registers"))
    return {
        "id": document.name,
        "title": document.about.title,
        "register": document.source("assumptions"),
        "assumptions": rows,
    }


def _row(
    document: Document,
    assumption: Assumption,
    breaking: list[Result],
    runs: Mapping[str, Run],
    claims: tuple[tuple[str, str], ...],
) -> dict[str, Any]:
    hazards = {each.tla: each for each in document.properties}
    return {
        "id": assumption.id,
        "title": assumption.title,
        "text": assumption.text,
        "kind": assumption.kind,
        "clauses": list(assumption.clauses),
        "who": assumption.who,
        "check": assumption.check,
        "open": assumption.breaks_open,
        "breaks": [
            {
                **each.data,
                "falls": runs[each.id].property,
                "property": hazards[runs[each.id].property].id if runs[each.id].property in hazards else None,
                "hazard": hazards[runs[each.id].property].hazard if runs[each.id].property in hazards else "",
                "steps": steps_of(each),
                "strength": runs[each.id].strength,
            }
            for each in breaking
        ],
        "rests": [{"property": name, "environment": environment} for name, environment in claims],
    }
