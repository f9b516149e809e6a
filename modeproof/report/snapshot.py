"""How things are, in a form that two reports can be compared by: verdicts, counts, mutants, pins, tools."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from modeproof.registers.rows import Document
from modeproof.registers.runs import reasons_of
from modeproof.report.campaigns import KINDS, campaign
from modeproof.report.claims import LANE
from modeproof.report.sources import Evidence, Sources
from modeproof.report.verdicts import ASIDE, POSITIVE, Line, PropertyRow, Record, property_lines

COUNTS = ("distinct", "generated", "states", "transitions", "scans", "cases", "clauses", "citations")
"""What is counted in the result of a piece of evidence and is the same whenever it is made."""
_PINNED = ("distinct", "generated", "trace_length", "cfg_sha256")


def as_it_counts(piece: Evidence) -> Record:
    """The record of a piece of evidence; of one that is stale, that nothing is known now."""
    if not piece.changed:
        return piece.record
    reason = f"its evidence ({piece.record['verdict']}) is of another text of {piece.changed[0]}"
    return {**piece.record, "verdict": "UNJUDGED", "as_expected": False, "reason": reason, "strength": reason}


def machine_rows(piece: Evidence) -> list[dict[str, Any]]:
    """The verdict on each property of a machine; UNJUDGED where its evidence does not count."""
    record = as_it_counts(piece)
    stale = bool(piece.changed) or "contradicts itself" in record["reason"]
    rows = piece.result.get("verdicts", [])
    return [{**row, "verdict": "UNJUDGED", "how": record["reason"]} if stale else dict(row) for row in rows]


def lines_of(sources: Sources, document: Document) -> list[Line]:
    """Each property in each environment; UNJUDGED where this lane declares a run and none has evidence."""
    rows = [PropertyRow(prop.id, prop.tla, prop.environments) for prop in document.properties]
    records = [as_it_counts(record) for record in sources.evidence[document.name].values()]
    runs = [run for run in document.runs if run.kind in POSITIVE and not run.readings]
    declared = {run.id: {(name, run.environment) for name in run.properties} for run in runs}
    here: dict[tuple[str, str], str] = {}
    for run in runs:
        if LANE in run.lanes:
            for name in run.properties:
                here.setdefault((name, run.environment), run.id)
    tla_of = {prop.id: prop.tla for prop in document.properties}
    found = []
    for line in property_lines(rows, records, declared):
        lost = here.get((tla_of[line.property], line.environment))
        if line.verdict == ASIDE and lost:
            why = f"no evidence of {lost}"
            line = replace(line, verdict="UNJUDGED", status=2, strength=why, run="")
        found.append(line)
    return found


def mutants_of(sources: Sources, document: str) -> dict[str, dict[str, int]]:
    """How many planted faults have which verdict, by judge, of each campaign that is of the present texts."""
    found = {}
    for kind, (_, judge, _) in KINDS.items():
        one = campaign(sources, document, kind)
        if one is not None and not one.evidence.changed:
            found[judge] = dict(sorted(one.counts()[""].items()))
    return found


def pins_of(document: Document) -> dict[str, dict[str, str]]:
    """The pins of each run as runs.toml has them."""
    pins: dict[str, dict[str, str]] = {}
    for run in document.runs:
        graph = {name: getattr(run.graph, name) for name in ("states", "edges")} if run.graph else {}
        own = {name: getattr(run, name) for name in _PINNED} | graph
        pins[run.id] = {name: str(value) for name, value in own.items() if value is not None}
    return pins


def snapshot(sources: Sources) -> dict[str, Any]:
    """All that the next report will be compared with."""
    verdicts: dict[str, str] = {}
    results: dict[str, Any] = {}
    mutants: dict[str, Any] = {}
    pins: dict[str, Any] = {}
    for name, document in sources.documents.items():
        for line in lines_of(sources, document):
            verdicts[f"{name}: {line.property} ({line.environment})"] = line.verdict.rstrip("?")
        for record in sources.evidence[name].values():
            results[f"{name}/{record.id}"] = {
                "verdict": record.record["verdict"],
                "counts": _counts(record.result),
            }
        mutants |= {f"{name}, by {judge}": of for judge, of in mutants_of(sources, name).items()}
        pins |= {f"{name}/{run}": of for run, of in pins_of(document).items()}
    for name, piece in sources.machines.items():
        if piece is not None:
            verdicts |= {f"{name}: {row['id']}": row["verdict"] for row in machine_rows(piece)}
            results[f"{name}/{piece.id}"] = {"verdict": piece.record["verdict"], "counts": {}}
    tools: dict[str, list[str]] = {}
    for piece in sources.everything():
        for tool, entry in piece.record["tools"].items():
            version = str(entry["version"])
            if version not in tools.setdefault(str(tool), []):
                tools[str(tool)].append(version)
    return {
        "verdicts": verdicts,
        "results": results,
        "mutants": mutants,
        "pins": pins,
        "moved": {name: list(reasons_of(sources.root, name)) for name in sources.documents},
        "tools": {tool: sorted(versions) for tool, versions in sorted(tools.items())},
    }


def _counts(result: Mapping[str, Any]) -> dict[str, int]:
    found = {key: result[key] for key in COUNTS if isinstance(result.get(key), int)}
    if isinstance(result.get("graph"), Mapping):
        found |= {key: result["graph"][key] for key in ("states", "edges") if key in result["graph"]}
    if isinstance(result.get("queries"), list):
        found["queries"] = len(result["queries"])
    return found
