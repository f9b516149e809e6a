"""Conformance: each complete graph beside the reference implementation, each program under each suite."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.registers.rows import Document
from modeproof.registers.runs import Run
from modeproof.report.claims import LANE
from modeproof.report.part import Part
from modeproof.report.snapshot import as_it_counts
from modeproof.report.sources import DIFFERS, HOLE, Evidence, Figure, Sources
from modeproof.report.verdicts import status_of

ID = "conformance"
RELATIONS = (
    ("exact", "outputs are compared in every scan"),
    ("settled", "inputs are held, outputs are compared at rest; what is forbidden is watched in every scan"),
    ("monitor", "only the safety properties are watched, whatever the structure of steps"),
)


def part(sources: Sources) -> Part:
    """One entry a document: graphs, programs, coverage."""
    found = [_document(sources, one) for one in sources.documents.values()]
    return Part(ID, "Conformance", {"relations": RELATIONS, "documents": found})


def _document(sources: Sources, document: Document) -> dict[str, Any]:
    every = sources.of_kind(document.name, "conformance")
    compared: dict[str, list[Evidence]] = {}
    programs = []
    for one in every:
        if "implementation_states" in one.result:
            compared.setdefault(str(one.result["run"]).rpartition("/")[2], []).append(one)
        else:
            programs.append(one)
    return {
        "id": document.name,
        "title": document.about.title,
        "graphs": [
            _graph(sources, document, run, compared.get(run.id, []))
            for run in document.runs
            if run.graph is not None
        ],
        "programs": [_program(document, one) for one in programs],
    }


def _graph(sources: Sources, document: Document, run: Run, compared: list[Evidence]) -> dict[str, Any]:
    assert run.graph is not None
    printed = sources.evidence[document.name].get(run.id)
    return {
        "run": run.id,
        "device": run.graph.device,
        "aside": LANE not in run.lanes,
        "strength": run.strength,
        "states": None if printed is None else printed.figure("result", "graph", "states"),
        "edges": None if printed is None else printed.figure("result", "graph", "edges"),
        "command": f"modeproof conform {run.graph.device} --builtin refimpl --document {document.name}",
        "compared": [
            {
                **_verdict(one),
                "implementation": one.result.get("implementation", ""),
                "implementation_states": one.figure("result", "implementation_states"),
                "replayed": one.figure("result", "replayed"),
                "transitions": one.figure("result", "transitions"),
                "class_scans": one.figure("result", "class_scans"),
                "classes": _counts(one, "classes"),
                "not_compared": list(one.result.get("not_compared", ())),
                "difference_count": one.figure("result", "difference_count"),
                "steps": _covered(one, "covered"),
            }
            for one in compared
        ],
    }


def _program(document: Document, one: Evidence) -> dict[str, Any]:
    says = one.result.get("says")
    return {
        **_verdict(one),
        "id": one.id,
        "target": one.result.get("target", one.result.get("device", "")),
        "program": one.result.get("adapter", one.result.get("implementation", "")),
        "suite": one.result.get("suite", ""),
        "relation": one.result.get("relation", ""),
        "says": says if isinstance(says, Mapping) else None,
        "cases": one.figure("result", "cases"),
        "scans": one.figure("result", "scans"),
        "seconds": one.figure("seconds", unit="s"),
        "unobserved": list(one.result.get("unobserved", ())),
        "not_compared": list(one.result.get("not_compared", ())),
        "steps": _covered(one, "covered"),
        "clauses": _covered(one, "clauses"),
        "command": one.record["command"],
    }


def _verdict(one: Evidence) -> dict[str, Any]:
    record = as_it_counts(one)
    return {
        "word": one.record["verdict"],
        "verdict": one.figure("verdict"),
        "good": {0: True, DIFFERS: False, HOLE: None}[status_of(record)],
        "why": record["reason"],
    }


def _counts(one: Evidence, key: str) -> list[dict[str, Any]]:
    return [{"id": name, "count": Figure(count, one.path)} for name, count in one.result.get(key, {}).items()]


def _covered(one: Evidence, key: str) -> list[dict[str, Any]]:
    """By step or clause: of how many transitions how many were taken; what is not complete comes first."""
    rows = [
        {"id": name, "have": Figure(have, one.path), "total": Figure(total, one.path), "full": have == total}
        for name, (have, total) in one.result.get(key, {}).items()
    ]
    return sorted(rows, key=lambda row: bool(row["full"]))
