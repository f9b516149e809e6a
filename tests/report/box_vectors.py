"""The published sequences of the toy document `box`, written by hand."""

from __future__ import annotations

import gzip
import json
from pathlib import Path
from typing import Any

from modeproof.registers.vector_files import seal

FILE = "vectors/box/sequences.jsonl.gz"
SHUTS, WAITS = "box-0123456789ab", "box-ba9876543210"
FLOW = '[tables]\nCODE = ["0F0F", "0F10"]\n\n[[flow]]\ndevice = "box"\n'
STEPS = ("Close", "Wait", "Stay")
BOOL = {"type": "bool"}


def scan(dt_ms: int, step: str, to: int, asked: dict[str, Any], answered: dict[str, Any]) -> dict[str, Any]:
    """One scan: what changed since the one before."""
    return {"dt_ms": dt_ms, "in": asked, "out": answered, "step": STEPS.index(step), "to": to, "column": 0}


def case(id: str, why: str, *scans: dict[str, Any], **changes: Any) -> dict[str, Any]:
    """One case of the box, demanded by the document, but for the changes."""
    fields = {"id": id, "clauses": ["BX-1-1"], "basis": "document", "why": why, "timing": "exact"}
    return {**fields, "params": {"T_HOLD_ms": 1}, "graph": 0, "scans": list(scans), **changes}


FIRST = scan(10, "Wait", 0, {"door": False}, {"LAMP": False, "SPARE": False, "WORD": "0000"})
CASES = (
    case(
        SHUTS,
        "The door comes and the box shuts.",
        FIRST,
        scan(20, "Close", 1, {"door": True}, {"LAMP": True, "WORD": "0F10"}),
        scan(0, "Stay", 1, {"door": False}, {}),
    ),
    case(WAITS, "No door comes.", FIRST, clauses=["BX-1-1", "BX-1-2"], basis="finding:E-01"),
)


def header(**changes: Any) -> dict[str, Any]:
    """The first line, but for the changes."""
    return {
        "kind": "modeproof-vectors",
        "version": 1,
        "target": "box",
        "document": "box",
        "suite": "sequences",
        "guarantees": "the diagrams of the box are walked",
        "does_not_show": "anything else",
        "cases": len(CASES),
        "inputs": {"door": BOOL},
        "outputs": {"WORD": {"type": "word"}, "LAMP": BOOL, "SPARE": BOOL},
        "steps": [{"name": one, "clauses": [], "findings": [], "transitions": 1} for one in STEPS],
        "graphs": [
            {"run": "OPEN_Box", "params": {}, "initial": 0, "views": ['<<"Open", 0>>', '<<"Shut", 1>>']}
        ],
        **changes,
    }


def put_vectors(root: Path, *cases: dict[str, Any], **changes: Any) -> Path:
    """Write the sequences of the box and its diagrams, and seal them; returns the file."""
    (root / "spec/box/sequences.toml").write_text(FLOW)
    lines = [header(**{"cases": len(cases or CASES), **changes}), *(cases or CASES)]
    path = root / FILE
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress("".join(json.dumps(one) + "\n" for one in lines).encode()))
    seal(root, ["box"])
    return path
