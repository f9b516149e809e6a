"""Proofs: every theorem as a sentence, its questions to two solvers, what it rests on, where TLC agrees."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from modeproof.registers.rows import Document
from modeproof.report.claims import theorem_result, theorem_rows
from modeproof.report.part import Part
from modeproof.report.snapshot import as_it_counts
from modeproof.report.sources import Evidence, Figure, Sources
from modeproof.report.verdicts import never_needed, status_of

ID = "proofs"
SOLVERS = ("z3", "cvc5")


def part(sources: Sources) -> Part:
    """One entry a document."""
    return Part(
        ID, "Proofs", {"documents": [_document(sources, document) for document in sources.documents.values()]}
    )


def _document(sources: Sources, document: Document) -> dict[str, Any]:
    rows = [
        _theorem(sources, document, file, one.name, one.sentence)
        for file, one in theorem_rows(sources, document)
    ]
    own = sources.of_kind(document.name, "proof")
    tools: dict[str, list[str]] = {name: [] for name in SOLVERS}
    for proof in own:
        for name in SOLVERS:
            version = str(proof.record["tools"].get(name, {}).get("version", "not recorded"))
            if version not in tools[name]:
                tools[name].append(version)
    folder = f"build/evidence/{document.name}/"
    return {
        "id": document.name,
        "title": document.about.title,
        "theorems": rows,
        "count": Figure(len(own), folder),
        "questions": Figure(sum(len(_queries(proof)) for proof in own), folder),
        "solvers": {name: sorted(versions) for name, versions in tools.items()},
        "never_needed": never_needed([proof.record for proof in own]) if own else [],
        "cores": Figure(sum(1 for proof in own for q in _claims(proof) if q.get("core") is not None), folder),
        "claims": Figure(sum(len(_claims(proof)) for proof in own), folder),
        "agreement": _agreement(sources, document),
        "coverage": _coverage(sources, document),
        "command": f"modeproof prove --document {document.name}",
    }


def _queries(piece: Evidence) -> Sequence[Mapping[str, Any]]:
    found: Sequence[Mapping[str, Any]] = piece.result.get("queries", ())
    return found


def _claims(piece: Evidence) -> list[Mapping[str, Any]]:
    return [query for query in _queries(piece) if query["expected"] == "unsat"]


def _theorem(sources: Sources, document: Document, file: str, name: str, sentence: str) -> dict[str, Any]:
    result = theorem_result(sources, document, name)
    one = result.evidence
    answer = {
        **result.data,
        "file": file,
        "sentence": sentence,
        "clauses": [],
        "findings": [],
        "properties": [],
    }
    if one is None:
        return {**answer, "counts": None, "premises": [], "unused": [], "seconds": None, "remark": ""}
    queries = _queries(one)
    twins = sum(1 for query in queries if query["twin_of"])
    claims = len(_claims(one))
    agree = sum(1 for query in queries if query["z3"] == query["cvc5"] == query["expected"])
    return {
        **answer,
        "sentence": str(one.result.get("sentence", sentence)),
        "remark": str(one.result.get("remark", "")),
        "clauses": list(one.result.get("clauses", ())),
        "findings": list(one.result.get("findings", ())),
        "properties": list(one.result.get("properties", ())),
        "counts": {
            "claims": Figure(claims, one.path),
            "twins": Figure(twins, one.path),
            "examples": Figure(len(queries) - claims - twins, one.path),
            "agree": Figure(agree, one.path),
            "all": Figure(len(queries), one.path),
        },
        "premises": list(one.result.get("premises", ())),
        "unused": list(one.result.get("unused", ())),
        "seconds": one.figure("seconds", unit="s"),
    }


def _agreement(sources: Sources, document: Document) -> dict[str, Any] | None:
    """Model checker and theorems on the whole system, as the comparison recorded it; None: no comparison."""
    found = sources.of_kind(document.name, "agreement")
    if not found:
        return None
    one = found[0]
    record = as_it_counts(one)
    rows = one.result.get("rows", [])
    findings = {each.id for each in document.findings}
    return {
        "word": one.record["verdict"],
        "verdict": one.figure("verdict"),
        "good": {0: True, 1: False}.get(status_of(record)),
        "why": record["reason"],
        "both": Figure(sum(1 for row in rows if row["theorem"]), one.path),
        "all": Figure(len(rows), one.path),
        "rows": [
            {
                "property": row["id"],
                "environment": row["environment"],
                "tlc": Figure(row["tlc"], one.path),
                "runs": list(row["runs"]),
                "proved": Figure(row["proved"] or "not proved", one.path),
                "theorem": row["theorem"],
                "reason": row["reason"],
                "note": row["note"],
                "rests_on": [
                    {"kind": "finding" if name in findings else "assumption", "id": name}
                    for name in row["rests_on"]
                ],
                "good": _agrees(row),
            }
            for row in rows
        ],
    }


def _agrees(row: Mapping[str, Any]) -> bool | None:
    """Whether both say the same; None where only one of them says anything, and why is beside it."""
    if not row["theorem"]:
        return None
    return (row["tlc"], row["proved"]) == ("HOLDS", "PROVED")


def _coverage(sources: Sources, document: Document) -> list[dict[str, Any]]:
    """What of each device's step the feasible paths pass through."""
    return [
        {
            "device": name,
            "states": Figure(of["states"], piece.path),
            "paths": Figure(of["paths"], piece.path),
            **{
                key: {"have": Figure(of[key][0], piece.path), "total": Figure(of[key][1], piece.path)}
                for key in ("lines", "branches", "answers")
            },
            "unreachable": [{"what": each["what"], "why": each["why"]} for each in of["unreachable"]],
            "unexplained": list(of["unexplained"]),
        }
        for piece in sources.of_kind(document.name, "coverage")
        for name, of in piece.result.get("devices", {}).items()
    ]
