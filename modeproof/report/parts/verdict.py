"""Verdicts: all documents in one table, then each property by environment."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from modeproof.registers.rows import Document
from modeproof.report.campaigns import KINDS, id_of
from modeproof.report.claims import result_of
from modeproof.report.part import Part
from modeproof.report.snapshot import as_it_counts, lines_of, mutants_of
from modeproof.report.sources import Evidence, Figure, Sources
from modeproof.report.verdicts import ASIDE, NOT_AS_DECLARED, Line, status_of

GROUPS: tuple[tuple[str, str, Callable[[Evidence], bool]], ...] = (
    ("theorems", "PROVED", lambda one: one.record["kind"] == "proof"),
    ("negatives", "the other reading fails, as predicted", lambda one: one.result.get("run") == "NEG"),
    ("witnesses", "REACHED", lambda one: one.result.get("run") == "WIT"),
    ("graphs", "complete", lambda one: one.result.get("run") == "OPEN"),
    ("conformance", "EQUAL or CONFORMS", lambda one: one.record["kind"] == "conformance"),
    ("registers", "EQUAL", lambda one: one.record["kind"] == "registers"),
)
"""What is counted together: its title, what is good, and which evidence belongs to it."""
ASIDE_OF_TABLE = ("registers",)
"""What every document has once: counted for all together only."""


def part(sources: Sources) -> Part:
    """Documents by environment and by kind of evidence; each property with verdict and strength."""
    documents = [_document(sources, document) for document in sources.documents.values()]
    return Part(
        "verdict",
        "Verdicts by environment",
        {
            "groups": [
                {"title": title, "good": good, "column": title not in ASIDE_OF_TABLE}
                for title, good, _ in GROUPS
            ],
            "documents": documents,
        },
    )


def _document(sources: Sources, document: Document) -> dict[str, Any]:
    lines = lines_of(sources, document)
    environments = list(dict.fromkeys(line.environment for line in lines))
    marks: dict[str, int] = {}
    for line in lines:
        if line.status == 0 and line.verdict != ASIDE:
            marks.setdefault(line.strength, len(marks) + 1)
    folder = f"build/evidence/{document.name}/"
    evidence = list(sources.evidence[document.name].values())
    return {
        "id": document.name,
        "title": document.about.title,
        "folder": folder,
        "environments": [
            {
                "id": name,
                **count(
                    [line.status for line in lines if _counted(line) and line.environment == name], folder
                ),
            }
            for name in environments
        ],
        "groups": [
            count([status_of(as_it_counts(record)) for record in evidence if of(record)], folder)
            for *_, of in GROUPS
        ],
        "aside": [run.id for run in document.runs if result_of(sources, document, run).word == ASIDE],
        "mutants": _mutants(sources, document.name),
        "columns": environments,
        "rows": _rows(sources, document, lines, environments, marks),
        "strengths": [{"mark": mark, "text": text} for text, mark in marks.items()],
        "status": min((line.status for line in lines if line.status), default=0),
    }


def _counted(line: Line) -> bool:
    return line.verdict != ASIDE


def count(statuses: Sequence[int], folder: str) -> dict[str, Any]:
    """How many of how many are as expected, and the worst status of the others."""
    return {
        "good": Figure(sum(1 for status in statuses if not status), folder),
        "of": Figure(len(statuses), folder),
        "status": min((status for status in statuses if status), default=0),
    }


def add(cells: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """The counts of several documents together."""
    every = list(cells)
    return {
        **{key: Figure(sum(cell[key].value for cell in every), "build/evidence/") for key in ("good", "of")},
        "status": min((cell["status"] for cell in every if cell["status"]), default=0),
    }


def _mutants(sources: Sources, document: str) -> list[dict[str, Any]]:
    """KILLED of those that behave differently, for each judge, by evidence of the present text."""
    found = mutants_of(sources, document)
    rows = []
    for kind, (_, judge, _) in KINDS.items():
        counts = found.get(judge, {})
        different = sum(counts.get(word, 0) for word in ("KILLED", "SURVIVED", "UNMEASURED"))
        if different:
            path = sources.evidence[document][id_of(kind)].path
            killed = Figure(counts.get("KILLED", 0), path)
            rows.append({"judge": judge, "killed": killed, "of": Figure(different, path)})
    return rows


def _rows(
    sources: Sources, document: Document, lines: Sequence[Line], columns: Sequence[str], marks: dict[str, int]
) -> list[dict[str, Any]]:
    by = {(line.property, line.environment): line for line in lines}
    titles = {prop.id: prop.title for prop in document.properties}
    worst_first = sorted(
        dict.fromkeys(line.property for line in lines),
        key=lambda id: min(line.status or 3 for line in lines if line.property == id),
    )
    return [
        {
            "id": id,
            "title": titles[id],
            "cells": [_cell(sources, document.name, by.get((id, column)), marks) for column in columns],
        }
        for id in worst_first
    ]


def _cell(sources: Sources, name: str, line: Line | None, marks: dict[str, int]) -> dict[str, Any] | None:
    if line is None:
        return None
    source = sources.evidence[name].get(line.run)
    return {
        "environment": line.environment,
        "verdict": line.verdict.rstrip("?"),
        "status": line.status,
        "aside": line.verdict == ASIDE,
        "strength": line.strength,
        "why": _why(line, source),
        "mark": marks.get(line.strength) if not line.status else None,
        "run": line.run,
        "distinct": Figure(line.distinct, source.path) if source and line.distinct is not None else None,
    }


def _why(line: Line, source: Evidence | None) -> str:
    """Why a property is not as expected: the reason that its evidence gives."""
    if not line.status:
        return ""
    reason = "" if source is None or source.changed else str(source.record["reason"])
    return f"not as declared: {reason}" if line.verdict == NOT_AS_DECLARED else reason or line.strength
