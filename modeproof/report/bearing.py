"""What bears on what: the assumptions that a requirement rests on, and the findings that weigh most."""

from __future__ import annotations

from collections.abc import Mapping

from modeproof.registers.rows import Assumption, Document, Finding, Property
from modeproof.registers.runs import Run
from modeproof.report.sources import Sources

OF_THE_MACHINE = "assumption"
"""The kind of an assumption that somebody has to ensure; all others are about the model."""


def rests_on(sources: Sources, document: Document) -> Mapping[str, tuple[tuple[str, str], ...]]:
    """By assumption: the requirements, by environment, whose theorem about the whole system rests on it."""
    found: dict[str, list[tuple[str, str]]] = {}
    for record in sources.of_kind(document.name, "agreement"):
        for row in record.result.get("rows", []):
            for name in row["rests_on"]:
                found.setdefault(name, []).append((row["id"], row["environment"]))
    return {name: tuple(pairs) for name, pairs in found.items()}


def needed_by(sources: Sources, document: Document) -> Mapping[str, tuple[str, ...]]:
    """By assumption about the machine: the requirements that fail in a run without it, or rest on it."""
    runs = {run.id: run for run in document.runs}
    proved = rests_on(sources, document)
    found = {}
    for row in document.assumptions:
        falls = {runs[name].property for name in row.breaks if name in runs}
        own = {name for name, _ in proved.get(row.id, ())}
        needs = tuple(each.id for each in document.properties if each.tla in falls or each.id in own)
        if row.kind == OF_THE_MACHINE:
            found[row.id] = needs
    return found


def assumptions_of(sources: Sources, document: Document, prop: Property) -> tuple[Assumption, ...]:
    """The assumptions about the machine that a requirement needs, or that are about a clause of it."""
    needed = needed_by(sources, document)
    return tuple(
        row
        for row in document.assumptions
        if row.id in needed and (prop.id in needed[row.id] or set(row.clauses) & set(prop.clauses))
    )


def heaviest(sources: Sources) -> list[tuple[Document, Assumption]]:
    """All assumptions about machines, those first on which most requirements and clauses rest."""
    found = []
    for document in sources.documents.values():
        needed = needed_by(sources, document)
        found += [
            ((-len(needed[row.id]) - len(row.breaks), -len(row.clauses)), document, row)
            for row in document.assumptions
            if row.id in needed
        ]
    return [(document, row) for _, document, row in sorted(found, key=lambda entry: entry[0])]


def worst(sources: Sources) -> list[tuple[Document, Finding]]:
    """The safety findings, the worst of each document in turn.

    First those that no drawing can settle and that have a story, then by how many requirements name them.
    """
    turns = []
    for document in sources.documents.values():
        own = [row for row in document.findings if row.severity == "safety"]
        named = {row.id: sum(row.id in prop.findings for prop in document.properties) for row in own}
        own.sort(key=lambda row: (row.drawing_could_settle, row.telling is None, -named[row.id]))
        turns += [(turn, document, row) for turn, row in enumerate(own)]
    return [(document, row) for _, document, row in sorted(turns, key=lambda entry: entry[0])]


def falling(document: Document, finding: Finding) -> tuple[Run, ...]:
    """The runs that show a finding, that of its story first."""
    told = finding.telling.run if finding.telling is not None else ""
    runs = [run for run in document.runs if run.id in finding.evidence]
    return tuple(sorted(runs, key=lambda run: run.id != told))


def hazard_of(document: Document, runs: tuple[Run, ...]) -> str:
    """What a person suffers when the first requirement that fails in these runs fails."""
    hazards = {prop.tla: prop.hazard for prop in document.properties}
    return next((hazards[run.property] for run in runs if run.property in hazards), "")
