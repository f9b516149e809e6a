"""One case as a table for a vendor's trace tool (CSV), or as a trace for TLA+ tools (ITF)."""

from __future__ import annotations

import csv
import io
import json
from typing import Any

from modeproof.errors import Unjudged
from modeproof.kit.signals import Signal
from modeproof.kit.vectors import Case, Suite


def as_csv(suite: Suite, case: Case) -> str:
    """A row for each scan: time in ms since the reset, inputs, expected outputs; words in hex, bits 0 and 1.

    Raises Unjudged for a case with requests to be refused: they are messages, not scans.
    """
    _only_scans(case)
    stream = io.StringIO()
    table = csv.writer(stream, lineterminator="\n")
    table.writerow(["time_ms", *suite.inputs, *suite.outputs])
    time_ms = 0
    for scan in case.scans:
        time_ms += scan.dt_ms
        ins = [_cell(scan.inputs[name]) for name in suite.inputs]
        table.writerow([time_ms, *ins, *[_cell(scan.outputs[name]) for name in suite.outputs]])
    return stream.getvalue()


def _cell(value: Any) -> str:
    if type(value) is bool:
        return str(int(value))
    if isinstance(value, list):
        return " ".join(map(str, value))
    return "" if value is None else str(value)


def as_itf(suite: Suite, case: Case) -> str:
    """A trace in the Informal Trace Format: a state for each scan, values as the specification has them.

    `none` of a mode is -1 and an absent text is "", words are numbers. Raises Unjudged as `as_csv`.
    """
    _only_scans(case)
    views = suite.header["graphs"][case.graph]["views"]
    states = []
    time_ms = 0
    for number, scan in enumerate(case.scans):
        time_ms += scan.dt_ms
        row: dict[str, Any] = {"#meta": {"index": number}, "time_ms": _number(time_ms)}
        row |= {f"in_{name}": _itf(suite.inputs[name], scan.inputs[name]) for name in suite.inputs}
        row |= {f"out_{name}": _itf(suite.outputs[name], scan.outputs[name]) for name in suite.outputs}
        row |= {"step": suite.steps[scan.step].name, "view": views[scan.to]}
        states.append(row)
    names = [name for name in states[0] if name != "#meta"]
    meta = {"format": "ITF", "format-description": "https://apalache-mc.org/docs/adr/015adr-trace.html"}
    meta |= {"source": f"{suite.path.name}, {case.id}", "description": case.why}
    return json.dumps({"#meta": meta, "vars": names, "states": states}, indent=1) + "\n"


def _itf(signal: Signal, value: Any) -> Any:
    if signal.type == "word":
        return _number(int(value, 16))
    if signal.type == "mode":
        return _number(-1 if value is None else value)
    if signal.type == "modes":
        return {"#set": [_number(one) for one in value]}
    if signal.type == "text":
        return value or ""
    return value if type(value) is bool else _number(value)


def _number(value: int) -> dict[str, str]:
    return {"#bigint": str(value)}


def _only_scans(case: Case) -> None:
    if case.requests:
        raise Unjudged(f"{case.id}: holds a request that must be refused, which no trace can show")
