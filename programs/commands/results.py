"""What `prove-program` leaves behind: a difference as a vector file, and the record of a run."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from modeproof.ground.places import build
from modeproof.kit.files import write_json
from modeproof.kit.ids import case_id
from modeproof.kit.vectors import KIND, VERSION
from modeproof.registers import Signal
from programs.equality.binding import Binding
from programs.equality.replay import Difference


def write_record(place: Path, record: Mapping[str, Any], also: Path | None) -> None:
    """Write the record of a run below `build`, and to a file that was asked for. Raises Unjudged."""
    path = build(place) / "programs" / f"{record.get('target', 'properties')}-{record['unit']}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    write_json(path, record)
    if also is not None:
        write_json(also, record)


# ---------------------------------------------------------------- a difference as a vector


def vector_of(difference: Difference, binding: Binding) -> str:
    """The scans of a difference with what the reference gives, as a vector file that the kit can run."""
    reference, register = binding.reference, binding.reference.device.register
    state = reference.start(difference.parameters)
    params = reference.to_wire("parameters", difference.parameters)
    rows: list[dict[str, Any]] = []
    before = dict[str, Any](), dict[str, Any]()
    for dt_ms, given in difference.scans:
        state, sends = reference.scan(state, dt_ms, given)
        now = reference.to_wire("inputs", given), reference.to_wire("outputs", sends)
        going_in, out = (
            {name: value for name, value in part.items() if name not in old or old[name] != value}
            for part, old in zip(now, before, strict=True)
        )
        rows.append({"dt_ms": dt_ms, "in": going_in, "out": out, "step": 0, "to": 0, "column": 0})
        before = now
    header = {
        "kind": KIND,
        "version": VERSION,
        "target": reference.device.name,
        "document": reference.document,
        "protocol": 1,
        "suite": "difference",
        "relations": ["exact"],
        "shrink": "prefix",
        "guarantees": f"one case, after which {binding.unit.name} differed from the reference",
        "hypothesis": "none",
        "does_not_show": "everything else",
        "generator": "modeproof prove-program",
        "cases": 1,
        "scans": len(rows),
        "inputs": {name: _declared(signal) for name, signal in register.inputs.items()},
        "outputs": {name: _declared(signal) for name, signal in register.outputs.items()},
        "parameters": {
            name: {**_declared(signal), "default": signal.default}
            for name, signal in register.parameters.items()
        },
        "steps": [{"name": "a scan of the difference", "clauses": [], "findings": [], "transitions": 0}],
        "graphs": [{"run": "none", "params": params, "initial": 0, "views": ["not known"]}],
    }
    case = {
        "id": case_id(reference.device.name, params, [(row["dt_ms"], row["in"]) for row in rows]),
        "clauses": [],
        "basis": "document",
        "why": f"a difference of {binding.unit.name}, found by {difference.found_by}",
        "params": params,
        "graph": 0,
        "scans": rows,
    }
    return "".join(json.dumps(row, ensure_ascii=False) + "\n" for row in (header, case))


def _declared(signal: Signal) -> dict[str, Any]:
    found: dict[str, Any] = {"type": signal.type}
    if signal.values:
        found["values"] = list(signal.values)
    if signal.minimum is not None:
        found["min"] = signal.minimum
    if signal.maximum is not None:
        found["max"] = signal.maximum
    return found
