"""Review sheet: the judgments that no tool made, the most important first, for a person to answer."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence

from modeproof.ground.evidence import sha256
from modeproof.registers.rows import Assumption, Clause, Document, Finding, Property
from modeproof.registers.runs import Run
from modeproof.report.bearing import OF_THE_MACHINE, falling, hazard_of
from modeproof.report.claims import result_of, steps_of
from modeproof.report.part import Part
from modeproof.report.parts.scope import LEFT_OUT
from modeproof.report.review_sheet import (
    ANSWERS,
    HEADS,
    NAME,
    QUESTIONS,
    Item,
    Row,
    Trace,
    read_answers,
    sheet_file,
    tally,
)
from modeproof.report.sources import Sources

MOST = 150
"""So many rows at most: where there would be more, those of the least important groups are put together."""
ALONE = ("safety", "hazard", "assumption")
"""The groups whose entries are alone as long as any others can be put together."""


def part(sources: Sources) -> Part:
    """The rows by group; the same as a file. Raises Unjudged where the given answers are no review sheet."""
    rows = sheet(sources)
    groups = [
        {"id": group, "question": question, "rows": of}
        for group, question in QUESTIONS.items()
        if (of := [row for row in rows if row.items[0].group == group])
    ]
    data = {
        "groups": groups,
        "several": len(sources.documents) > 1,
        "answers": ANSWERS,
        "heads": HEADS,
        "file": NAME,
        "tally": tally(rows),
        "from": None
        if (path := sources.filing.answers) is None
        else {"name": path.name, "sha256": sha256(path)},
    }
    return Part("review", "Review sheet", data, attachments={NAME: sheet_file(rows)})


def sheet(sources: Sources) -> tuple[Row, ...]:
    """The rows with the answers that the caller gives, made once."""
    return sources.once("review", lambda: _answered(sources))


def _answered(sources: Sources) -> tuple[Row, ...]:
    rows = rows_of(list(_items(sources)))
    if sources.filing.answers is None:
        return rows
    given = read_answers(sources.filing.answers, [row.id for row in rows])
    return tuple(Row(row.id, row.text, row.items, given.get(row.id)) for row in rows)


def rows_of(items: Sequence[Item], most: int = MOST) -> tuple[Row, ...]:
    """At most so many rows, as long as a row a group and document is enough of putting together.

    Groups are put together from the least important on: first by kind, then whole; those of ALONE last.
    """
    keys: tuple[Callable[[Item], str], ...] = (
        lambda item: f"{item.document} {item.id}",
        lambda item: f"{item.document} {item.group}: {item.kind}".removesuffix(": "),
        lambda item: f"{item.document} {item.group}",
    )
    level = dict.fromkeys(QUESTIONS, 0)
    found: dict[str, list[Item]] = {}
    steps = [
        (to, group)
        for late in (False, True)
        for to in (1, 2)
        for group in reversed(QUESTIONS)
        if (group in ALONE) == late
    ]
    for to, group in [(0, ""), *steps]:
        level |= {group: to} if group else {}
        found = {}
        for item in sorted(items, key=lambda item: list(QUESTIONS).index(item.group)):
            found.setdefault(keys[level[item.group]](item), []).append(item)
        if len(found) <= most:
            break
    return tuple(Row(id, _fingerprint(of), tuple(of)) for id, of in found.items())


def _fingerprint(items: Sequence[Item]) -> str:
    judged = [(item.id, item.title, item.readings, item.decision, item.consequence) for item in items]
    return hashlib.sha256(repr(judged).encode("utf-8")).hexdigest()[:12]


def _items(sources: Sources) -> Iterator[Item]:
    """Every entry of every register that a person has to judge, once."""
    for document in sources.documents.values():
        yield from (_finding(sources, document, row) for row in document.findings)
        yield from (_assumption(sources, document, row) for row in document.assumptions)
        yield from (_requirement(document, row) for row in document.properties)
        yield from (_clause(document, row) for row in document.clauses)


def _finding(sources: Sources, document: Document, row: Finding) -> Item:
    group = row.severity if row.severity != "safety" else "drawing" if row.drawing_could_settle else "safety"
    figures = {clause.id: clause.figure for clause in document.clauses}
    drawing = next((figures[id] for id in row.clauses if figures.get(id)), "the drawings")
    drawing = f"Figure {drawing}" if drawing.isdigit() else drawing
    return Item(
        group,
        document.name,
        drawing if group == "drawing" else "",
        row.id,
        f"finding-{row.id}",
        row.title,
        row.readings,
        row.decision,
        row.consequence,
        _traces(sources, document, falling(document, row)),
    )


def _assumption(sources: Sources, document: Document, row: Assumption) -> Item:
    runs = tuple(run for run in document.runs if run.id in row.breaks)
    return Item(
        "assumption" if row.kind == OF_THE_MACHINE else "model",
        document.name,
        row.who if row.kind == OF_THE_MACHINE else "",
        row.id,
        f"assumption-{row.id}",
        row.title,
        (row.text,),
        f"Who ensures it: {row.who}. How to check it: {row.check}.",
        hazard_of(document, runs) or f"no run shows it: {row.breaks_open}",
        _traces(sources, document, runs),
    )


def _requirement(document: Document, row: Property) -> Item:
    devices = {device.module: name for name, device in document.interface.devices.items()}
    of = max((module for module in devices if row.module.startswith(module)), key=len, default="")
    return Item(
        "requirement",
        document.name,
        devices.get(of, "all devices together"),
        row.id,
        f"property-{document.name}-{row.id}",
        row.title,
        (),
        row.sentence,
        row.hazard,
    )


def _clause(document: Document, row: Clause) -> Item:
    where = "; ".join(filter(None, (row.pages and f"pages {row.pages}", row.figure)))
    text = f"{row.text} ({where})" if where else row.text
    kind = row.kind if row.kind == LEFT_OUT else "modelled"
    return Item("clause", document.name, kind, row.id, f"clause-{row.id}", row.title, (), text)


def _traces(sources: Sources, document: Document, runs: Sequence[Run]) -> tuple[Trace, ...]:
    """The counterexamples among these runs: those that must fail."""
    return tuple(
        Trace(run.id, steps_of(result_of(sources, document, run))) for run in runs if run.kind == "NEG"
    )
