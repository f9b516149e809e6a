"""The first page: what was examined, five conclusions with their limits, what weighs most, who signs."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from modeproof.report import review_sheet
from modeproof.report.bearing import falling, hazard_of, heaviest, worst
from modeproof.report.deviations import deviations
from modeproof.report.filing import commit_of
from modeproof.report.part import Part
from modeproof.report.parts import properties, review, verdict
from modeproof.report.snapshot import lines_of
from modeproof.report.sources import Figure, Sources
from modeproof.report.verdicts import ASIDE

ASSUMPTIONS, FINDINGS = 3, 5
"""So many of each are on the first page."""
FOLDER = "build/evidence/"
ENGINES = {"tlc": "TLC", "z3": "Z3", "cvc5": "cvc5", "python": "Python"}
"""The tools whose word the conclusions are, as the page names them."""


def part(sources: Sources) -> Part:
    """What a person reads who reads one page."""
    filing = sources.filing
    return Part(
        "summary",
        "What was examined, and what came out",
        {
            "documents": [
                {
                    "id": document.name,
                    "title": document.about.title,
                    "number": document.about.number,
                    "edition": document.about.edition,
                    "publisher": document.about.publisher,
                }
                for document in sources.documents.values()
            ],
            "day": filing.day,
            "commit": sources.once("commit", lambda: commit_of(sources.root)),
            "tools": _tools(sources),
            "conclusions": _conclusions(sources),
            "assumptions": [
                {
                    "id": row.id,
                    "document": document.name,
                    "title": row.title,
                    "who": row.who,
                    "hazard": hazard_of(
                        document, tuple(run for run in document.runs if run.id in row.breaks)
                    ),
                }
                for document, row in heaviest(sources)[:ASSUMPTIONS]
            ],
            "findings": [
                {
                    "id": row.id,
                    "document": document.name,
                    "title": row.title,
                    "hazard": hazard_of(document, falling(document, row)) or row.consequence,
                }
                for document, row in worst(sources)[:FINDINGS]
            ],
            "answers": review_sheet.tally(review.sheet(sources)),
        },
    )


def _tools(sources: Sources) -> list[dict[str, Any]]:
    """Each engine with its versions, as the evidence names them; caches and the like are in the annex."""
    found: dict[str, set[str]] = {}
    for piece in sources.everything():
        for tool, entry in piece.record["tools"].items():
            if tool in ENGINES:
                version = str(entry["version"])
                number = re.search(r"\d+(\.\d+)+", version)
                found.setdefault(ENGINES[tool], set()).add(number.group() if number else version)
    return [{"tool": tool, "versions": sorted(versions)} for tool, versions in sorted(found.items())]


def _conclusions(sources: Sources) -> dict[str, dict[str, Any]]:
    """The counts of each conclusion and of its limit; the template says them in words."""
    data = verdict.part(sources).data
    groups = {
        group["title"]: verdict.add(document["groups"][place] for document in data["documents"])
        for place, group in enumerate(data["groups"])
    }
    return {
        "required": _required(sources),
        "readings": _readings(sources),
        "program": groups["theorems"] | {"yours": sum(map(len, sources.yours.values()))},
        "agreement": groups["conformance"],
        "faults": _faults(sources, data["documents"]),
    }


def _required(sources: Sources) -> dict[str, Any]:
    """The requirements that were true wherever this lane looked; those that only another lane checks."""
    statuses, aside = [], 0
    for document in sources.documents.values():
        by: dict[str, list[int]] = {prop.id: [] for prop in document.properties}
        for line in lines_of(sources, document):
            if line.verdict != ASIDE:
                by[line.property].append(line.status)
        aside += sum(1 for found in by.values() if not found)
        statuses += [min((one for one in found if one), default=0) for found in by.values() if found]
    return verdict.count(statuses, FOLDER) | {"aside": Figure(aside, "spec/")}


def _readings(sources: Sources) -> dict[str, Any]:
    """The readings that were tried alone: how many break a requirement, and what a drawing could settle."""
    alone = [
        one
        for document in sources.documents.values()
        for one in deviations(sources, document)
        if len(one.readings) == 1 and not one.result.aside
    ]
    safety = [
        row
        for document in sources.documents.values()
        for row in document.findings
        if row.severity == "safety"
    ]
    return verdict.count([one.result.status for one in alone], FOLDER) | {
        "fail": Figure(
            sum(one.result.good is True and one.result.word == "VIOLATED" for one in alone), FOLDER
        ),
        "safety": Figure(len(safety), "spec/"),
        "drawing": Figure(sum(row.drawing_could_settle for row in safety), "spec/"),
    }


def _faults(sources: Sources, documents: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """The requirements that fail with a fault planted for them, and the faults by rule of all campaigns."""
    falls = [properties.fallen(sources, document) for document in sources.documents.values()]
    good, of = (sum(counts) for counts in zip(*falls, strict=True))
    rows = [row for document in documents for row in document["mutants"]]
    killed, different = (sum(row[key].value for row in rows) for key in ("killed", "of"))
    return {
        "good": Figure(good, "spec/"),
        "of": Figure(of, "spec/"),
        "status": 0 if good == of else 2,
        "mutants": Figure(different, FOLDER),
        "noticed": Figure(killed, FOLDER),
        "left": Figure(different - killed, FOLDER),
    }
