"""Tool confidence: versions and hashes, known unsoundness judged one by one, which engines check which."""

from __future__ import annotations

from typing import Any

from modeproof.errors import Unjudged
from modeproof.registers.tools import SOURCE, Check, ToolProblem, load_tools
from modeproof.report.conditions import Met, judged
from modeproof.report.part import Part
from modeproof.report.snapshot import as_it_counts
from modeproof.report.sources import DIFFERS, HOLE, NOTE, Figure, Sources, Trouble
from modeproof.report.verdicts import status_of

ID = "confidence"


def part(sources: Sources) -> Part:
    """Tools, cross-checks, problems. Without the register the tools alone, and that it is missing."""
    data: dict[str, Any] = {"tools": _tools(sources), "checks": [], "problems": [], "register": SOURCE}
    if sources.content(SOURCE) is None:
        trouble = Trouble(NOTE, ID, f"{SOURCE} is missing: no known problem of the tools is judged")
        return Part(ID, "Tool confidence", data, (trouble,))
    try:
        register = load_tools(sources.root)
    except Unjudged as error:
        trouble = Trouble(HOLE, ID, f"known problems of the tools cannot be read: {error.message}")
        return Part(ID, "Tool confidence", data, (trouble,))
    troubles: list[Trouble] = []
    data["checks"] = [_check(sources, one) for one in register.checks]
    data["problems"] = [_problem(sources, one, troubles) for one in register.problems]
    return Part(ID, "Tool confidence", data, tuple(troubles))


def _tools(sources: Sources) -> list[dict[str, Any]]:
    """Each version of each tool, and how much evidence was made with it."""
    made: dict[tuple[str, str, str], list[str]] = {}
    for one in sources.everything():
        for name, entry in one.record["tools"].items():
            key = (str(name), str(entry["version"]), str(entry["sha256"] or ""))
            made.setdefault(key, []).append(one.path)
    return [
        {
            "id": name,
            "version": Figure(version, paths[0]),
            "sha256": Figure(digest, paths[0]) if digest else None,
            "files": Figure(len(paths), "build/evidence/"),
        }
        for (name, version, digest), paths in sorted(made.items())
    ]


def _check(sources: Sources, one: Check) -> dict[str, Any]:
    statuses = [
        status_of(as_it_counts(each)) for each in sources.everything() if each.record["kind"] == one.kind
    ]
    good = None if not statuses or 2 in statuses else True
    return {
        "engine": one.engine,
        "by": one.by,
        "kind": one.kind,
        "good": False if DIFFERS in statuses else good,
        "as_expected": Figure(sum(1 for status in statuses if not status), "build/evidence/"),
        "all": Figure(len(statuses), "build/evidence/"),
    }


def _problem(sources: Sources, one: ToolProblem, troubles: list[Trouble]) -> dict[str, Any]:
    conditions = [judged(sources, each) for each in one.holds]
    for each in conditions:
        if each.good is False:
            what = f"{one.id}, {one.title}: the judgement does not stand: {each.says}: {each.found}"
            troubles.append(Trouble(DIFFERS, ID, what, f"look at {SOURCE}"))
    return {
        "id": one.id,
        "tool": one.tool,
        "title": one.title,
        "references": [one.reference, *one.also],
        "what": one.what,
        "affects": one.affects,
        "judgement": one.judgement,
        "because": one.because,
        "good": _all(conditions),
        "conditions": [
            {"good": each.good, "says": each.says, "found": each.found, "figure": each.figure}
            for each in conditions
        ],
    }


def _all(conditions: list[Met]) -> bool | None:
    """Whether every condition holds; None where there is none, or one that cannot be judged."""
    if any(one.good is False for one in conditions):
        return False
    return True if conditions and all(one.good for one in conditions) else None
