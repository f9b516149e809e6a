"""Traces for people: every counterexample, and every sequence of the documents, as a sequence diagram and as
a scan table, step by step.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.replay import Traces, has_replay, load_replay
from modeproof.registers.rows import Document
from modeproof.registers.runs import Run
from modeproof.report.claims import LANE
from modeproof.report.part import Part
from modeproof.report.sequences import REMEDY, Published, Sequence, published
from modeproof.report.sources import HOLE, NOTE, Evidence, Figure, Sources, Trouble
from modeproof.report.story import Story, digest_of, from_variables, from_walk, is_trace

ID = "traces"
COUNTEREXAMPLE, SEQUENCE = "counterexample", "sequence"
"""The kinds of traces, as the page offers them."""


def part(sources: Sources) -> Part:
    """An index of all traces, the shortest of each finding as a table, and all of them for the viewer."""
    troubles: list[Trouble] = []
    stories: dict[str, Any] = {}
    documents = [_document(sources, document, troubles, stories) for document in sources.documents.values()]
    text = json.dumps(stories, ensure_ascii=False, separators=(",", ":"))
    return Part(
        ID,
        "Traces",
        {"documents": documents},
        tuple(troubles),
        {"trace-stories": text.encode("utf-8")} if stories else {},
    )


def anchor(document: str, run: str) -> str:
    """The link of a trace."""
    return f"trace-{document}-{run}"


def _document(
    sources: Sources, document: Document, troubles: list[Trouble], stories: dict[str, Any]
) -> dict[str, Any]:
    traces = _traces(document)
    rows: list[dict[str, Any]] = []
    told: dict[str, Story] = {}
    without, cut = [], []
    for run in document.runs:
        one = sources.evidence[document.name].get(run.id)
        if run.kind != "NEG" and (one is None or not one.result.get("trace")):
            continue
        if one is None:
            if LANE in run.lanes:
                cut.append(run.id)
            continue
        trace: Any = one.result.get("trace")
        if not is_trace(trace) or len(trace) != one.result.get("trace_length", len(trace)):
            cut.append(run.id)
            continue
        story = _story(sources, document, traces, one)
        if not story.full:
            without.append(run.id)
        told[run.id] = story
        rows.append(_index_row(document, run, one, story))
        stories[anchor(document.name, run.id)] = _told(rows[-1], story)
    if cut:
        what = f"{document.name}: {len(cut)} negative runs without a whole counterexample in their evidence"
        remedy = f"modeproof verify --document {document.name}"
        troubles.append(Trouble(HOLE, ID, f"{what}: {', '.join(cut)}", remedy, tuple(cut)))
    if without:
        what = f"{document.name}: {len(without)} traces show variables, not what is on the wires"
        remedy = f"modeproof walks --document {document.name}"
        troubles.append(Trouble(NOTE, ID, what, remedy, tuple(without)))
    return {
        "id": document.name,
        "title": document.about.title,
        "traces": rows,
        "witnesses": [
            {"run": run.id, "reached": len(run.witnesses)} for run in document.runs if run.kind == "WIT"
        ],
        "shortest": _shortest(document, told),
        "sequences": [_published(document, one, troubles, stories) for one in published(sources, document)],
    }


def _published(
    document: Document, of: Published, troubles: list[Trouble], stories: dict[str, Any]
) -> dict[str, Any]:
    """The sequences of one target as rows, the first of them as a table."""
    if of.hole:
        what = f"{document.name}: the sequences of {of.target} cannot be shown: {of.hole}"
        troubles.append(Trouble(HOLE, ID, what, REMEDY))
    for sequence in of.sequences:
        stories[anchor(document.name, sequence.id)] = _told_sequence(document, sequence)
    return {
        "target": of.target,
        "guarantees": of.guarantees,
        "does_not_show": of.does_not_show,
        "hole": of.hole,
        "remedy": REMEDY if of.hole else "",
        "cases": [
            {
                "id": anchor(document.name, sequence.id),
                "case": sequence.id,
                "why": sequence.why,
                "basis": sequence.basis,
                "finding": sequence.finding,
                "clauses": list(sequence.clauses),
                "parameters": sequence.parameters,
                "scans": Figure(len(sequence.story.rows) - 1, of.path),
            }
            for sequence in of.sequences
        ],
        "first": [
            {
                "id": anchor(document.name, sequence.id),
                "case": sequence.id,
                "why": sequence.why,
                **_on_paper(sequence.story),
            }
            for sequence in of.sequences[:1]
        ],
    }


def _told_sequence(document: Document, sequence: Sequence) -> dict[str, Any]:
    """What the viewer reads of one sequence."""
    return {
        "kind": SEQUENCE,
        "document": document.name,
        "run": sequence.id,
        "property": [],
        "findings": [sequence.finding] if sequence.finding else [],
        "why": sequence.why,
        "basis": sequence.basis,
        "clauses": list(sequence.clauses),
        "parameters": sequence.parameters,
        **_drawn(sequence.story),
    }


def _drawn(story: Story) -> dict[str, Any]:
    return {
        "lanes": [asdict(lane) for lane in story.lanes],
        "columns": story.columns,
        "constant": story.constant,
        "rows": [asdict(row) for row in story.rows],
    }


def _traces(document: Document) -> Traces | None:
    if not has_replay(document.root, document.name):
        return None
    try:
        return load_replay(document.root, document.name)
    except Unjudged:
        return None


def _story(sources: Sources, document: Document, traces: Traces | None, piece: Evidence) -> Story:
    trace = piece.result["trace"]
    walk = None if traces is None else _walk(sources, document, piece)
    if traces is not None and walk is not None and walk["module"] in traces.tops:
        return from_walk(document, traces, walk)
    return from_variables(document, traces, trace)


def _walk(sources: Sources, document: Document, piece: Evidence) -> dict[str, Any] | None:
    """The walk of this very trace, made with the specification as it is, else None."""
    path = f"build/walks/{document.name}/{piece.id}.json"
    try:
        content = (sources.root / path).read_bytes()
        walk = json.loads(content)
    except (OSError, ValueError):
        return None
    whole = {"module", "rows", "decided", "departures", "tables", "inputs", "trace_sha256"}
    if not isinstance(walk, dict) or not whole <= set(walk):
        return None
    if walk["trace_sha256"] != digest_of(piece.result["trace"]):
        return None
    if len(walk["rows"]) != len(piece.result["trace"]):
        return None
    for name, digest in walk["inputs"].items():
        if piece.record["inputs"].get(name, digest) != digest:
            return None
    sources.content(path)  # from now on one of the files that the report rests on
    return walk


def _index_row(document: Document, run: Run, piece: Evidence, story: Story) -> dict[str, Any]:
    findings = [
        found.id for found in document.findings if run.id in found.evidence or found.id in run.findings
    ]
    return {
        "id": anchor(document.name, run.id),
        "document": document.name,
        "run": run.id,
        "property": str(piece.result.get("violated") or run.property),
        "verdict": piece.figure("verdict"),
        "steps": Figure(len(story.rows) - 1, piece.path),
        "findings": findings,
        "assumptions": [row.id for row in document.assumptions if run.id in row.breaks],
        "clauses": list(run.clauses),
        "environment": run.environment,
        "loop": str(piece.result.get("loop") or ""),
        "wires": story.full,
    }


def _told(row: Mapping[str, Any], story: Story) -> dict[str, Any]:
    """What the viewer reads of one trace."""
    kept = ("document", "run", "property", "findings", "assumptions", "environment", "loop", "wires")
    return {"kind": COUNTEREXAMPLE, **{key: row[key] for key in kept}, **_drawn(story)}


def _shortest(document: Document, told: Mapping[str, Story]) -> list[dict[str, Any]]:
    """For each finding the shortest trace that shows it, each trace once with all its findings."""
    of_run: dict[str, list[str]] = {}
    for finding in document.findings:
        shown = [run for run in finding.evidence if run in told]
        if shown:
            of_run.setdefault(min(shown, key=lambda run: (len(told[run].rows), run)), []).append(finding.id)
    return [
        {"id": anchor(document.name, run), "run": run, "findings": findings, **_on_paper(told[run])}
        for run, findings in of_run.items()
    ]


def _on_paper(story: Story) -> dict[str, Any]:
    """A story as a table that needs no script."""
    return {
        "columns": story.columns,
        "constant": story.constant,
        "rows": [
            {
                "step": row.step,
                "by": row.by,
                "cells": [{"text": text, "changed": n in row.changed} for n, text in enumerate(row.cells)],
                "instead": row.instead,
            }
            for row in story.rows
        ],
    }
