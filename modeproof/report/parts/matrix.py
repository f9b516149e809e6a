"""The matrix: clause, action, step, property, theorem, vector, result; orphans first, and as files."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from typing import Any

from modeproof.registers.rows import Document
from modeproof.report.cell_text import for_csv
from modeproof.report.chain import Chain, Link, Traced, traced
from modeproof.report.claims import fault_of_texts
from modeproof.report.junit import junit
from modeproof.report.part import Part
from modeproof.report.sources import DIFFERS, HOLE, Figure, Sources, Trouble

ID = "matrix"
HEADS = (
    *("document", "clause", "kind", "title", "device", "action", "definition", "step", "property"),
    *("theorem", "vector", "finding", "assumption", "result", "lacks"),
)


def part(sources: Sources) -> Part:
    """One table a document; the same as CSV, and the results as JUnit XML."""
    troubles: list[Trouble] = []
    documents = []
    lines: list[list[str]] = []
    for document in sources.documents.values():
        fault = fault_of_texts(sources, document)
        if fault:
            what = f"{document.name}: who cites what cannot be read: {fault}"
            troubles.append(Trouble(HOLE, ID, what, f"modeproof registers --document {document.name}"))
        found = traced(sources, document)
        troubles += _orphans(document, found)
        documents.append(_document(document, found))
        lines += [_line(one) for one in found.chains]
    files = {"matrix.csv": _csv(lines), "junit.xml": junit(sources)}
    return Part(ID, "Traceability matrix", {"documents": documents}, tuple(troubles), attachments=files)


def _orphans(document: Document, found: Traced) -> list[Trouble]:
    """All orphans of a document in one trouble."""
    items = [f"{one.clause.id}: {text}" for one in found.chains for text in one.lacks]
    items += [f"{one.file}: {one.place}: {one.text}" for one in found.astray]
    if not items:
        return []
    more = f" and {len(items) - 1} more" if len(items) > 1 else ""
    command = f"modeproof registers --document {document.name}"
    return [Trouble(DIFFERS, ID, f"{document.name}: orphans: {items[0]}{more}", command, tuple(items))]


def _document(document: Document, found: Traced) -> dict[str, Any]:
    source = document.source("clauses")
    return {
        "id": document.name,
        "title": document.about.title,
        "register": source,
        "count": Figure(len(found.chains), source),
        "shown": Figure(sum(1 for one in found.chains if one.good), source),
        "orphans": sum(1 for one in found.chains if one.lacks) + len(found.astray),
        "astray": [{"file": one.file, "place": one.place, "text": one.text} for one in found.astray],
        "rows": [_row(one) for one in found.chains],
    }


def _row(one: Chain) -> dict[str, Any]:
    return {
        "clause": one.clause.id,
        "kind": one.clause.kind,
        "title": one.clause.title,
        "text": one.clause.text,
        "because": one.clause.because,
        "device": list(one.clause.device),
        "action": list(one.row.action),
        "definition": list(one.row.definition),
        "step": list(one.row.step),
        "property": [_link(each) for each in one.properties],
        "theorem": [_link(each) for each in one.theorems],
        "vector": [_link(each) for each in one.vectors],
        "finding": list(one.row.finding),
        "assumption": list(one.row.assumption),
        "lacks": list(one.lacks),
        "links": len(one.links),
        "word": one.word,
        "good": one.good,
    }


def _link(one: Link) -> dict[str, Any]:
    return {
        "id": one.id,
        "word": Figure(one.word, one.evidence) if one.evidence else None,
        "text": one.word,
        "good": one.good,
    }


def _line(one: Chain) -> list[str]:
    """A row of the CSV: what leads to a result has it behind its name."""

    def results(links: Sequence[Link]) -> str:
        return "; ".join(f"{each.id}: {each.word}" for each in links)

    row = one.row
    named = (row.device, row.action, row.definition, row.step)
    return [
        one.document.name,
        one.clause.id,
        one.clause.kind,
        one.clause.title,
        *("; ".join(names) for names in named),
        results(one.properties),
        results(one.theorems),
        results(one.vectors),
        "; ".join(row.finding),
        "; ".join(row.assumption),
        one.word,
        "; ".join(one.lacks),
    ]


def _csv(lines: Sequence[Sequence[str]]) -> bytes:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\r\n")
    writer.writerow(HEADS)
    writer.writerows([for_csv(cell) for cell in line] for line in lines)
    return out.getvalue().encode("utf-8")
