"""Assumptions: what is taken for granted, who must ensure it, how to check it, what breaks without it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.registers.rows import Assumption, Document
from modeproof.registers.runs import Run
from modeproof.report.claims import Result, result_of, steps_of
from modeproof.report.part import Part
from modeproof.report.sources import HOLE, Sources, Trouble

ID = "assumptions"


def part(sources: Sources) -> Part:
    """One entry a document."""
    troubles: list[Trouble] = []
    found = [_document(sources, one, troubles) for one in sources.documents.values()]
    return Part(ID, "Assumptions and abstractions", {"documents": found}, tuple(troubles))


def _document(sources: Sources, document: Document, troubles: list[Trouble]) -> dict[str, Any]:
    runs = {one.id: one for one in document.runs}
    rests = _rests_on(sources, document)
    shown: list[Result] = []
    rows = []
    for one in document.assumptions:
        breaking = [result_of(sources, document, runs[name]) for name in one.breaks if name in runs]
        shown += breaking
        rows.append(_row(document, one, breaking, runs, rests.get(one.id, ())))
        if not one.breaks and not one.breaks_open.strip():
            what = (
                f"{document.name}: {one.id}: neither a run shows what breaks without it, nor is it said why"
            )
            troubles.append(Trouble(HOLE, ID, what, "modeproof registers"))
    return {
        "id": document.name,
        "title": document.about.title,
        "register": document.source("assumptions"),
        "assumptions": rows,
    }


def _row(
    document: Document,
    one: Assumption,
    breaking: list[Result],
    runs: Mapping[str, Run],
    claims: tuple[tuple[str, str], ...],
) -> dict[str, Any]:
    hazards = {each.tla: each for each in document.properties}
    return {
        "id": one.id,
        "title": one.title,
        "text": one.text,
        "kind": one.kind,
        "clauses": list(one.clauses),
        "who": one.who,
        "check": one.check,
        "open": one.breaks_open,
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


def _rests_on(sources: Sources, document: Document) -> Mapping[str, tuple[tuple[str, str], ...]]:
    """By assumption: the properties of the whole system, by environment, whose theorem rests on it."""
    found: dict[str, list[tuple[str, str]]] = {}
    for record in sources.of_kind(document.name, "agreement"):
        for row in record.result.get("rows", []):
            for name in row["rests_on"]:
                found.setdefault(name, []).append((row["id"], row["environment"]))
    return {name: tuple(pairs) for name, pairs in found.items()}
