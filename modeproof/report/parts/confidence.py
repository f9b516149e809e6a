"""Tool confidence: versions and hashes, known unsoundness judged one by one, which engines check which."""

from __future__ import annotations

from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.tools import SOURCE, Check, ToolProblem, load_tools
from modeproof.report.conditions import Met, judged
from modeproof.report.part import Part
from modeproof.report.snapshot import as_it_counts
from modeproof.report.sources import DIFFERS, HOLE, NOTE, Figure, Sources, Trouble, version_of
from modeproof.report.verdicts import status_of

ID = "confidence"


def part(sources: Sources) -> Part:
    """Tools, cross-checks, problems. Without the register the tools alone, and that it is missing."""
    data: dict[str, Any] = {"tools": _tools(sources), "checks": [], "problems": [], "register": SOURCE}
    none = Trouble(NOTE, ID, f"{SOURCE} states none: no known problem of the tools is judged")
    if sources.content(SOURCE) is None:
        return Part(ID, "Tool confidence", data, (none,))
    try:
        register = load_tools(sources.root)
    except Unjudged as error:
        trouble = Trouble(HOLE, ID, f"known problems of the tools cannot be read: {error.message}")
        return Part(ID, "Tool confidence", data, (trouble,))
    if not register.problems:
        return Part(ID, "Tool confidence", data, (none,))
    troubles: list[Trouble] = []
    data["checks"] = [_check(sources, check) for check in register.checks]
    data["problems"] = [_problem(sources, problem, troubles) for problem in register.problems]
    return Part(ID, "Tool confidence", data, tuple(troubles))


def _tools(sources: Sources) -> list[dict[str, Any]]:
    """Each version of each tool, and how much evidence was made with it."""
    made: dict[tuple[str, str, str], list[str]] = {}
    for piece in sources.everything():
        for name, entry in piece.record["tools"].items():
            key = (str(name), *version_of(name, entry))
            made.setdefault(key, []).append(piece.path)
    return [
        {
            "id": name,
            "version": Figure(version, paths[0]),
            "sha256": Figure(digest, paths[0]) if digest else None,
            "files": Figure(len(paths), "build/evidence/"),
        }
        for (name, version, digest), paths in sorted(made.items())
    ]


def _check(sources: Sources, check: Check) -> dict[str, Any]:
    statuses = [
        status_of(as_it_counts(each)) for each in sources.everything() if each.record["kind"] == check.kind
    ]
    good = None if not statuses or 2 in statuses else True
    return {
        "engine": check.engine,
        "by": check.by,
        "kind": check.kind,
        "good": False if DIFFERS in statuses else good,
        "as_expected": Figure(sum(1 for status in statuses if not status), "build/evidence/"),
        "all": Figure(len(statuses), "build/evidence/"),
    }


def _problem(sources: Sources, problem: ToolProblem, troubles: list[Trouble]) -> dict[str, Any]:
    conditions = [judged(sources, each) for each in problem.holds]
    for each in conditions:
        if each.good is False:
            what = f"{problem.id}, {problem.title}: the judgement is not true here: {each.says}: {each.found}"
            troubles.append(Trouble(DIFFERS, ID, what, f"look at {SOURCE}"))
    return {
        "id": problem.id,
        "tool": problem.tool,
        "title": problem.title,
        "references": [problem.reference, *problem.also],
        "what": problem.what,
        "affects": problem.affects,
        "judgement": problem.judgement,
        "because": problem.because,
        "good": _all(conditions),
        "conditions": [
            {"good": each.good, "says": each.says, "found": each.found, "figure": each.figure}
            for each in conditions
        ],
    }


def _all(conditions: list[Met]) -> bool | None:
    """Whether every condition holds; None where there is none, or one that cannot be judged."""
    if any(condition.good is False for condition in conditions):
        return False
    return True if conditions and all(condition.good for condition in conditions) else None
