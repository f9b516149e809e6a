"""The matrix: clause, action, step, property, theorem, vector, result; orphans first, and as files."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from typing import Any

from modeproof.registers.rows import Document
from modeproof.report.chain import Chain, Link, Traced, traced
from modeproof.report.claims import fault_of_texts
from modeproof.report.junit import junit
from modeproof.report.part import Part
from modeproof.report.sources import DIFFERS, HOLE, Figure, Sources, Trouble, few

ID = "matrix"
HEADS = (
    *("document", "clause", "kind", "title", "device", "action", "definition", "step", "property"),
    *("theorem", "vector", "finding", "assumption", "result", "lacks"),
)

FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""What a formula of a spreadsheet begins with."""


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
        lines += [_line(chain) for chain in found.chains]
    files = {"matrix.csv": _csv(lines), "junit.xml": junit(sources)}
    return Part(ID, "Traceability matrix", {"documents": documents}, tuple(troubles), attachments=files)


def _orphans(document: Document, found: Traced) -> list[Trouble]:
    """All orphans of a document in one trouble."""
    items = [f"{chain.clause.id}: {text}" for chain in found.chains for text in chain.lacks]
    items += [f"{problem.file}: {problem.place}: {problem.text}" for problem in found.astray]
    if not items:
        return []
    command = f"modeproof registers --document {document.name}"
    return [Trouble(DIFFERS, ID, f"{document.name}: orphans: {few(items, 1)}", command, tuple(items))]


def _document(document: Document, found: Traced) -> dict[str, Any]:
    source = document.source("clauses")
    return {
        "id": document.name,
        "title": document.about.title,
        "register": source,
        "count": Figure(len(found.chains), source),
        "shown": Figure(sum(1 for chain in found.chains if chain.good), source),
        "orphans": sum(1 for chain in found.chains if chain.lacks) + len(found.astray),
        "astray": [
            {"file": problem.file, "place": problem.place, "text": problem.text} for problem in found.astray
        ],
        "rows": [_row(chain) for chain in found.chains],
    }


def _row(chain: Chain) -> dict[str, Any]:
    return {
        "clause": chain.clause.id,
        "kind": chain.clause.kind,
        "title": chain.clause.title,
        "text": chain.clause.text,
        "because": chain.clause.because,
        "device": list(chain.clause.device),
        "action": list(chain.row.action),
        "definition": list(chain.row.definition),
        "step": list(chain.row.step),
        "property": [_link(each) for each in chain.properties],
        "theorem": [_link(each) for each in chain.theorems],
        "vector": [_link(each) for each in chain.vectors],
        "finding": list(chain.row.finding),
        "assumption": list(chain.row.assumption),
        "lacks": list(chain.lacks),
        "links": len(chain.links),
        "word": chain.word,
        "good": chain.good,
    }


def _link(link: Link) -> dict[str, Any]:
    return {
        "id": link.id,
        "word": Figure(link.word, link.evidence) if link.evidence else None,
        "text": link.word,
        "good": link.good,
    }


def _line(chain: Chain) -> list[str]:
    """A row of the CSV: what leads to a result has it behind its name."""

    def results(links: Sequence[Link]) -> str:
        return "; ".join(f"{each.id}: {each.word}" for each in links)

    row = chain.row
    named = (row.device, row.action, row.definition, row.step)
    return [
        chain.document.name,
        chain.clause.id,
        chain.clause.kind,
        chain.clause.title,
        *("; ".join(names) for names in named),
        results(chain.properties),
        results(chain.theorems),
        results(chain.vectors),
        "; ".join(row.finding),
        "; ".join(row.assumption),
        chain.word,
        "; ".join(chain.lacks),
    ]


def _csv(lines: Sequence[Sequence[str]]) -> bytes:
    """The lines, in which no spreadsheet takes a cell for a formula."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\r\n")
    writer.writerow(HEADS)
    writer.writerows([f"'{cell}" if cell.startswith(FORMULA) else cell for cell in line] for line in lines)
    return out.getvalue().encode("utf-8")
