"""A verdict in words and as JSON."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from modeproof.kit.errors import Unjudged
from modeproof.kit.judge import CONFORMS, Difference, Verdict
from modeproof.kit.vectors import Case

LONGEST_SHOWN = 40


def as_text(verdict: Verdict, again: str = "") -> str:
    """What is printed at the end; `again` is the command that runs the one case again."""
    lines = []
    if verdict.difference is not None:
        lines += _difference(verdict.difference)
        if again:
            lines += ["", f"again:   {again}"]
        lines.append("")
    seen = sum(have for have, _ in verdict.covered.values())
    total = sum(all_ for _, all_ in verdict.covered.values())
    rate = f", {verdict.scans / verdict.seconds:,.0f} scans a second" if verdict.seconds > 0.05 else ""
    lines.append(
        f"{verdict.target} {verdict.adapter}: {verdict.cases:,} of {verdict.cases_total:,} cases passed, "
        f"{verdict.scans:,} scans, {seen:,} of {total:,} transitions, {verdict.seconds:.1f} s{rate}"
    )
    if verdict.word == CONFORMS:
        missed = [f"{name} {have}/{all_}" for name, (have, all_) in verdict.covered.items() if have < all_]
        if missed:
            lines.append("not covered: " + ", ".join(missed))
    if verdict.unobserved:
        lines.append("not observed, so not judged: " + ", ".join(verdict.unobserved))
    word = (
        f"{verdict.word}({verdict.relation}, {verdict.suite})" if verdict.word == CONFORMS else verdict.word
    )
    lines.append(f"{word}: {verdict.reason}" if verdict.reason else word)
    return "\n".join(lines)


def _difference(found: Difference) -> list[str]:
    clauses = ", ".join(found.clauses) or "none cited"
    findings = f"; our decisions: {', '.join(found.findings)}" if found.findings else ""
    lines = [
        f"case {found.case.id}, scan {found.scan} of {len(found.case.scans)}",
        f"why:     {found.case.why}",
        f"step:    {found.step} (clauses: {clauses}{findings})",
        "",
        f"{'output':<20} {'expected':<20} got",
    ]
    for name, wanted in found.expected.items():
        lines.append(f"{name:<20} {json.dumps(wanted):<20} {json.dumps(found.got[name])}")
    lines += ["", *_way(found)]
    return lines


def _way(found: Difference) -> list[str]:
    case = found.shortest
    if found.confirmed:
        title = f"shortest way there ({len(case.scans)} scans; it shows a difference too):"
    else:
        title = (
            f"shortest way there ({len(case.scans)} scans; alone it shows NO difference, see the whole case):"
        )
    lines = [title, f"  reset {json.dumps(dict(case.params))}"]
    before: Mapping[str, Any] = {}
    first = max(0, len(case.scans) - LONGEST_SHOWN)
    if first:
        lines.append(f"  ... {first} scans")
        before = case.scans[first - 1].inputs
    for n, scan in enumerate(case.scans[first:], first + 1):
        if scan.request is not None:
            text = scan.request if isinstance(scan.request, str) else json.dumps(scan.request)
            lines.append(f"  request {n}, to be refused: {text}")
            continue
        changed = {name: value for name, value in scan.inputs.items() if before.get(name, _NEW) != value}
        inputs = (
            ", ".join(f"{name}={json.dumps(value)}" for name, value in changed.items()) or "inputs as before"
        )
        lines.append(f"  scan {n}: +{scan.dt_ms} ms, {inputs}{'' if scan.compared else ' (settling)'}")
        before = scan.inputs
    return lines


_NEW = object()


def as_record(verdict: Verdict) -> dict[str, Any]:
    """The verdict for machines."""
    found = verdict.difference
    return {
        "verdict": verdict.word,
        "status": verdict.status,
        "target": verdict.target,
        "suite": verdict.suite,
        "relation": verdict.relation,
        "adapter": verdict.adapter,
        "cases": verdict.cases,
        "cases_total": verdict.cases_total,
        "scans": verdict.scans,
        "seconds": round(verdict.seconds, 3),
        "unobserved": list(verdict.unobserved),
        "covered": {name: list(pair) for name, pair in verdict.covered.items()},
        "reason": verdict.reason,
        "difference": None
        if found is None
        else {
            "case": found.case.id,
            "why": found.case.why,
            "scan": found.scan,
            "step": found.step,
            "clauses": list(found.clauses),
            "findings": list(found.findings),
            "basis": found.case.basis,
            "expected": dict(found.expected),
            "got": dict(found.got),
            "shortest": _scans(found.shortest),
            "shortest_confirmed": found.confirmed,
        },
    }


def _scans(case: Case) -> dict[str, Any]:
    scans = [
        {"dt_ms": scan.dt_ms, "in": scan.inputs, "out": scan.outputs}
        if scan.request is None
        else {"refuse": scan.request}
        for scan in case.scans
    ]
    return {"id": case.id, "params": dict(case.params), "scans": scans}


def write_json(path: Path, record: Mapping[str, Any]) -> None:
    """Write a record as a whole or not at all. Raises Unjudged when that is not possible."""
    part = ""
    try:
        handle, part = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(json.dumps(record, indent=1, ensure_ascii=False, allow_nan=False) + "\n")
        os.replace(part, path)
    except OSError as error:
        if part and os.path.exists(part):
            os.unlink(part)
        raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None
