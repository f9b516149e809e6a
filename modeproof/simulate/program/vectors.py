"""A play as a vector file of one case: what one device read and wrote, for `modeproof conform --vectors`."""

from __future__ import annotations

import json
from typing import Any

WHY = "Played by hand in the page of modeproof simulate, from power-up."


def played(
    about: dict[str, Any], id: str, params: dict[str, Any], lines: list[dict[str, Any]], took: list[list[str]]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Header and case of what a device did since power-up; the case has no id yet.

    `lines` are the scans of this device alone, whole, and `took` the step and the state of each. Raises
    ValueError where there is no scan.
    """
    if not lines:
        raise ValueError(f"{id} has not been called yet")
    row = about["devices"][id]
    names = [*row["steps"]]
    states = row["states"]
    transitions = dict.fromkeys(names, 0)
    scans: list[dict[str, Any]] = []
    known: dict[str, int] = {}
    before: dict[str, dict[str, Any]] = {"in": {}, "out": {}}
    cited: set[str] = set()
    for line, (step, state) in zip(lines, took, strict=True):
        column = known.setdefault(json.dumps(line["in"]), len(known))
        changes = {side: _changes(before[side], line[side]) for side in ("in", "out")}
        number = names.index(step)
        scan = {
            "dt_ms": line["dt_ms"],
            **changes,
            "step": number,
            "to": states.index(state),
            "column": column,
        }
        scans.append(scan)
        transitions[step] += 1
        cited |= {*row["steps"][step]}
        before = {"in": line["in"], "out": line["out"]}
    graph = {"run": "played", "params": params, "initial": 0, "views": states}
    clauses = sorted(name for name in cited if name in about["clauses"])
    header = {
        "kind": "modeproof-vectors", "version": 1, "target": id, "document": about["document"], "protocol": 1,
        "suite": "played", "relations": ["exact", "monitor"], "pace": "fast", "counted_by": "next state",
        "shrink": "prefix", "guarantees": "one run is as it was played in the page", "hypothesis": "none",
        "does_not_show": "anything beyond this one run", "generator": "modeproof", "cases": 1,
        "scans": len(scans), "states": len(states), "columns": len(known),
        "transitions": sum(transitions.values()), **row["vectors"],
        "steps": [_step(about, name, row["steps"][name], transitions[name]) for name in names],
        "graphs": [graph], "texts": {name: about["texts"][name] for name in sorted(cited)},
    }  # fmt: skip
    case = {"clauses": clauses, "basis": "protocol", "why": WHY, "timing": "exact", "params": params}
    return header, {**case, "graph": 0, "scans": scans}


def hashed(case: dict[str, Any]) -> str:
    """The text whose hash is the id of the case, as modeproof/kit/ids.py has it."""
    going_in = [[scan["dt_ms"], _sorted(scan["in"])] for scan in case["scans"]]
    return json.dumps([_sorted(case["params"]), going_in], separators=(",", ":"))


def written(header: dict[str, Any], case: dict[str, Any], digest: str) -> str:
    """The file; `digest` is the SHA-256 of `hashed`, in hex digits."""
    rows = [header, {"id": f"{header['target']}-{digest[:12]}", **case}]
    return "".join([json.dumps(row, separators=(",", ":")) + "\n" for row in rows])


def _changes(before: dict[str, Any], now: dict[str, Any]) -> dict[str, Any]:
    return {name: now[name] for name in sorted(now) if name not in before or before[name] != now[name]}


def _sorted(values: dict[str, Any]) -> dict[str, Any]:
    return {name: values[name] for name in sorted(values)}


def _step(about: dict[str, Any], name: str, ids: list[str], transitions: int) -> dict[str, Any]:
    clauses = [id for id in ids if id in about["clauses"]]
    findings = [id for id in ids if id not in about["clauses"]]
    return {"name": name, "clauses": clauses, "findings": findings, "transitions": transitions}
