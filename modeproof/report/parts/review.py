"""Review sheet: the judgments that no tool made, as rows for a person with a box, a name and a date."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import Any

from modeproof.registers.rows import Document
from modeproof.report.part import Part
from modeproof.report.sources import Figure, Sources

FILE = "review.csv"
HEADS = (
    "document",
    "kind",
    "id",
    "question",
    "what is to be judged",
    "clauses",
    "accepted (yes/no)",
    "name",
    "date",
    "remark",
)
KINDS = (
    ("paraphrase", "Is each paraphrase what the clause says?"),
    ("finding", "Is each decision the right one where the document is wrong or silent?"),
    ("assumption", "Is each assumption true of the machine at hand?"),
    ("abstraction", "Does each abstraction of the model, and each merged step, hide nothing that matters?"),
    ("property", "Is each property the safety requirement that is meant, and is none missing?"),
)
"""The kinds of judgment, each with its question."""


def part(sources: Sources) -> Part:
    """One table for each document and kind; the same rows as CSV."""
    documents = [_document(document) for document in sources.documents.values()]
    return Part(
        "review",
        "Review sheet",
        {
            "documents": documents,
            "file": FILE,
            "count": sum(len(group["rows"]) for document in documents for group in document["groups"]),
        },
        attachments={FILE: _csv(documents)},
    )


def _document(document: Document) -> dict[str, Any]:
    rows = list(_rows(document))
    groups = []
    for kind, question in KINDS:
        of_kind = [row for row in rows if row["kind"] == kind]
        if of_kind:
            source = of_kind[0]["register"]
            count = Figure(len(of_kind), source)
            groups.append({"kind": kind, "question": question, "count": count, "rows": of_kind})
    return {"id": document.name, "title": document.about.title, "groups": groups}


def _rows(document: Document) -> Iterator[dict[str, Any]]:
    for clause in document.clauses:
        where = "; ".join(filter(None, (clause.pages and f"pages {clause.pages}", clause.figure)))
        yield _row("paraphrase", clause.id, f"clause-{clause.id}", clause.title, clause.text, (), where) | {
            "register": document.source("clauses")
        }
    for finding in document.findings:
        text = f"{finding.title}. Decision: {finding.decision}"
        yield _row("finding", finding.id, f"finding-{finding.id}", finding.title, text, finding.clauses) | {
            "register": document.source("findings")
        }
    for assumption in document.assumptions:
        kind = "assumption" if assumption.kind == "assumption" else "abstraction"
        text = f"{assumption.text} Who ensures it: {assumption.who}. How to check it: {assumption.check}."
        yield _row(
            kind, assumption.id, f"assumption-{assumption.id}", assumption.title, text, assumption.clauses
        ) | {"register": document.source("assumptions")}
    for prop in document.properties:
        text = f"{prop.sentence} Hazard if violated: {prop.hazard}"
        anchor = f"property-{document.name}-{prop.id}"
        yield _row("property", prop.id, anchor, prop.title, text, prop.clauses) | {
            "register": document.source("properties")
        }


def _row(
    kind: str, id: str, anchor: str, title: str, text: str, clauses: tuple[str, ...], where: str = ""
) -> dict[str, Any]:
    return {
        "kind": kind,
        "id": id,
        "anchor": anchor,
        "title": title,
        "text": text,
        "clauses": clauses,
        "where": where,
    }


def _csv(documents: list[dict[str, Any]]) -> bytes:
    """The rows with empty fields for the answer; UTF-8 with a mark at the beginning, as spreadsheets want."""
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow(HEADS)
    for document in documents:
        for group in document["groups"]:
            for row in group["rows"]:
                text = f"{row['title']}: {row['text']}" if row["kind"] == "paraphrase" else row["text"]
                cells = (document["id"], row["kind"], row["id"], group["question"], text)
                writer.writerow([_plain(cell) for cell in (*cells, " ".join(row["clauses"]))] + [""] * 4)
    return out.getvalue().encode("utf-8-sig")


def _plain(text: str) -> str:
    """A cell that no spreadsheet takes for a formula."""
    return f"'{text}" if text.startswith(("=", "+", "-", "@")) else text
