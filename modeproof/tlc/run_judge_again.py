"""Judges a run once more from the figures in its evidence, with the judge that TLC's own output had."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from modeproof.registers.cfg import parse_cfg
from modeproof.registers.made import cfg_text
from modeproof.registers.profiles import strength_of
from modeproof.registers.runs import Run
from modeproof.tlc.messages import Counts, Log, TraceState
from modeproof.tlc.process import Outcome
from modeproof.tlc.rests import declaration_sha256
from modeproof.tlc.run_judge import REACHED, VIOLATED, judge


def declared(run: Run) -> dict[str, Any]:
    """What the result of a run repeats of its declaration."""
    result: dict[str, Any] = {
        "run": run.kind,
        "module": run.module,
        "cfg": run.config,
        "readings": list(run.readings),
        "lanes": list(run.lanes),
        "properties": list(run.properties),
        "workers": run.workers,
        "heap_mb": run.heap_mb,
        "timeout_s": run.timeout_s,
        "declaration": declaration_sha256(run),
        "pins": {"distinct": run.distinct, "generated": run.generated, "trace_length": run.trace_length},
    }
    if run.property:
        result["property"] = run.property
    if run.kind == "WIT":
        result["witnesses"] = list(run.witnesses)
    return result


def doubt(place: Path, run: Run, record: Mapping[str, Any]) -> str:
    """What evidence that is as expected says otherwise than its own figures and its declaration do.

    Empty where they agree. Raises Unjudged when the cfg of the run cannot be read.
    """
    head = {"expected": run.expect, "environment": run.environment, "strength": strength_of(place, run)}
    for said, meant in ((record, head), (record["result"], declared(run))):
        for name, value in meant.items():
            if said.get(name) != value:
                return f"it says {name} = {said.get(name)!r}, and runs.toml {value!r}"
    text = cfg_text(place, run)
    digest = hashlib.sha256(text.encode("utf-8")).hexdigest()
    found = judge(run, parse_cfg(text, f"{run.name}: {run.config}"), digest, _outcome(record))
    if (found.verdict, found.as_expected) != (record["verdict"], True):
        return f"its figures give {found.verdict}{found.reason and f', {found.reason}'}"
    return ""


def _outcome(record: Mapping[str, Any]) -> Outcome:
    """What TLC must have said for these figures."""
    result, violated = record["result"], record["verdict"] == VIOLATED
    counts = tuple(result.get(name) for name in ("generated", "distinct", "queue"))
    trace = [TraceState(state["number"], state["action"], "", ()) for state in result.get("trace", ())]
    name = str(result.get("violated", ""))
    status = result.get("exit_status")
    log = Log(
        version=str(record["tools"].get("tlc", {}).get("version", "")),
        counts=None if None in counts else Counts(*counts),
        final=None not in counts,
        initial=result.get("initial"),
        success=status == 0,
        finished=True,
        started=True,
        violations=[("deadlock" if name == "deadlock" else "property", name)] if violated else [],
        initially=violated and None in counts,
        trace=trace if len(trace) == result.get("trace_length", 0) else [],
        tags=dict(result.get("printed", {})),
    )
    reached = result.get("reached", ()) if record["verdict"] == REACHED else ()
    return Outcome(
        status=-1 if status is None else status,
        seconds=record["seconds"],
        timed_out=bool(result.get("timed_out")),
        log=log,
        command=(),
        printed=frozenset(f'<<"REACHED", "{name}">>'.encode() for name in reached),
    )
