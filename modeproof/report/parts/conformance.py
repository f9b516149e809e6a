"""Conformance: each complete graph beside the reference implementation, each program under each suite; and
what users judged, which counts for nothing here.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.registers.profiles import strength_of
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
    found = [_document(sources, document) for document in sources.documents.values()]
    yours = [
        _yours(sources.documents[name], piece) for name, of in sources.yours.items() for piece in of.values()
    ]
    return Part(ID, "Conformance", {"relations": RELATIONS, "documents": found, "yours": yours})


def _yours(document: Document, piece: Evidence) -> dict[str, Any]:
    """A user's program, or a log of one."""
    log = piece.result.get("log")
    if not isinstance(log, Mapping):
        return {**_program(document, piece), "name": piece.result.get("name", piece.id), "log": None}
    lines = {"accepted": piece.figure("result", "accepted"), "lines": piece.figure("result", "log", "lines")}
    return {
        **_verdict(piece),
        "id": piece.id,
        "name": str(log["name"]),
        "target": piece.result.get("target", ""),
        "log": lines,
        "command": piece.record["command"],
    }


def _document(sources: Sources, document: Document) -> dict[str, Any]:
    every = sources.of_kind(document.name, "conformance")
    compared: dict[str, list[Evidence]] = {}
    programs = []
    for piece in every:
        if "implementation_states" in piece.result:
            compared.setdefault(str(piece.result["run"]).rpartition("/")[2], []).append(piece)
        else:
            programs.append(piece)
    return {
        "id": document.name,
        "title": document.about.title,
        "graphs": [
            _graph(sources, document, run, compared.get(run.id, []))
            for run in document.runs
            if run.graph is not None
        ],
        "programs": [_program(document, program) for program in programs],
    }


def _graph(sources: Sources, document: Document, run: Run, compared: list[Evidence]) -> dict[str, Any]:
    assert run.graph is not None
    printed = sources.evidence[document.name].get(run.id)
    return {
        "run": run.id,
        "device": run.graph.device,
        "aside": LANE not in run.lanes,
        "strength": strength_of(document.root, run),
        "states": None if printed is None else printed.figure("result", "graph", "states"),
        "edges": None if printed is None else printed.figure("result", "graph", "edges"),
        "command": f"modeproof conform {run.graph.device} --builtin refimpl --document {document.name}",
        "compared": [
            {
                **_verdict(piece),
                "implementation": piece.result.get("implementation", ""),
                "implementation_states": piece.figure("result", "implementation_states"),
                "replayed": piece.figure("result", "replayed"),
                "transitions": piece.figure("result", "transitions"),
                "class_scans": piece.figure("result", "class_scans"),
                "classes": _counts(piece, "classes"),
                "not_compared": list(piece.result.get("not_compared", ())),
                "difference_count": piece.figure("result", "difference_count"),
                "steps": _covered(piece, "covered"),
            }
            for piece in compared
        ],
    }


def _program(document: Document, piece: Evidence) -> dict[str, Any]:
    says = piece.result.get("says")
    return {
        **_verdict(piece),
        "id": piece.id,
        "target": piece.result.get("target", piece.result.get("device", "")),
        "program": piece.result.get("adapter", piece.result.get("implementation", "")),
        "suite": piece.result.get("suite", ""),
        "relation": piece.result.get("relation", ""),
        "says": says if isinstance(says, Mapping) else None,
        "cases": piece.figure("result", "cases"),
        "scans": piece.figure("result", "scans"),
        "seconds": piece.figure("seconds", unit="s"),
        "unobserved": list(piece.result.get("unobserved", ())),
        "not_compared": list(piece.result.get("not_compared", ())),
        "steps": _covered(piece, "covered"),
        "clauses": _covered(piece, "clauses"),
        "command": piece.record["command"],
    }


def _verdict(piece: Evidence) -> dict[str, Any]:
    record = as_it_counts(piece)
    return {
        "word": piece.record["verdict"],
        "verdict": piece.figure("verdict"),
        "good": {0: True, DIFFERS: False, HOLE: None}[status_of(record)],
        "why": record["reason"],
    }


def _counts(piece: Evidence, key: str) -> list[dict[str, Any]]:
    return [
        {"id": name, "count": Figure(count, piece.path)} for name, count in piece.result.get(key, {}).items()
    ]


def _covered(piece: Evidence, key: str) -> list[dict[str, Any]]:
    """By step or clause: of how many transitions how many were taken; what is not complete comes first."""
    rows = [
        {
            "id": name,
            "have": Figure(have, piece.path),
            "total": Figure(total, piece.path),
            "full": have == total,
        }
        for name, (have, total) in piece.result.get(key, {}).items()
    ]
    return sorted(rows, key=lambda row: bool(row["full"]))
