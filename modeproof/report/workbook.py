"""The matrix as a workbook of linked tables: each sheet a table, each id a link to its row in another sheet.

Nothing in it is a formula; the same sources give the same bytes.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

import xlsxwriter

from modeproof.registers.rows import Document
from modeproof.report.cell_text import for_xml
from modeproof.report.chain import Chain, traced
from modeproof.report.claims import (
    Said,
    citations_of,
    claims,
    proved,
    said,
    steps_of,
    theorem_rows,
)
from modeproof.report.sources import Evidence, Sources

CREATED = datetime(2000, 1, 1)
"""So that the file tells nothing of when it was made."""
LONGEST = 32_000
"""A cell of a workbook holds no more characters."""
CLAUSES, REQUIREMENTS, MEASURES = "Clauses", "Requirements", "Measures"
VERIFICATION, FINDINGS, ASSUMPTIONS, LINKS = "Verification", "Findings", "Assumptions", "Links"

_PROOF = ("evidence", "SHA-256")
HEADS = {
    CLAUSES: (
        *("document", "clause", "kind", "title", "in our words", "device", "not modelled because"),
        *("result", "lacks", "links"),
    ),
    REQUIREMENTS: (
        *("document", "property", "environment", "sentence", "hazard if violated", "verdict"),
        *("as expected", "strength", "engines that agree", "run", "clauses", "findings", *_PROOF),
    ),
    MEASURES: ("document", "name", "room", "kind", "device", "clauses", "findings", "file"),
    VERIFICATION: (
        *("document", "id", "kind", "what", "verdict", "as expected", "why not", "environment"),
        *("strength", "distinct states", "steps", "seconds", "command", *_PROOF),
    ),
    FINDINGS: (
        *("document", "finding", "class", "title", "what is printed", "readings", "on a machine"),
        *("decision", "switch", "a drawing could settle it", "clauses", "shown by"),
    ),
    ASSUMPTIONS: (
        *("document", "assumption", "kind", "title", "text", "who ensures it", "how to check it"),
        *("clauses", "without it"),
    ),
    LINKS: ("document", "clause", "leads to", "id", "result", "evidence"),
}
"""The columns of each sheet."""
WIDE = 44
WIDTHS = {
    **dict.fromkeys(("links", "steps", "seconds", "distinct states"), 10),
    **dict.fromkeys(("document", "clause", "kind", "device", "class", "finding", "assumption"), 17),
    **dict.fromkeys(("verdict", "as expected", "environment", "result", "leads to", "room", "SHA-256"), 15),
    **dict.fromkeys(("a drawing could settle it", "engines that agree", "switch", "findings"), 19),
    **dict.fromkeys(("title", "property", "run", "clauses", "lacks", "why not", "who ensures it"), 30),
}
"""In characters; any other column is WIDE."""


@dataclass(frozen=True)
class Ref:
    """A cell that leads to the row `id` of another sheet, where there is one."""

    sheet: str
    id: str
    text: str


@dataclass
class Sheet:
    """One table; `ids` names each row, "" for one that nothing names."""

    name: str
    heads: Sequence[str]
    rows: list[Sequence[Any]] = field(default_factory=list)
    ids: list[str] = field(default_factory=list)

    def add(self, id: str, *cells: Any) -> None:
        """Add a row."""
        self.ids.append(id)
        self.rows.append(cells)


def workbook(sources: Sources) -> bytes:
    """The file."""
    sheets = _sheets(sources)
    places = {
        (sheet.name, id): number + 2
        for sheet in sheets
        for number, id in reversed(list(enumerate(sheet.ids)))
        if id
    }
    content = io.BytesIO()
    options = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}
    book = xlsxwriter.Workbook(content, options)
    book.set_properties(
        {
            "title": "modeproof: linked tables",
            "comments": f"Made from evidence {sources.digest[:16]}. It certifies nothing.",
            "created": CREATED,
        }
    )
    plain = book.add_format({"text_wrap": True, "valign": "top"})
    link = book.add_format({"font_color": "#0a4fa3", "underline": 1, "text_wrap": True, "valign": "top"})
    head = book.add_format({"bold": True, "text_wrap": True, "valign": "top"})
    for sheet in sheets:
        _write(book.add_worksheet(sheet.name), sheet, places, plain, link, head)
    book.close()
    return content.getvalue()


def _write(
    page: Any, sheet: Sheet, places: dict[tuple[str, str], int], plain: Any, link: Any, head: Any
) -> None:
    columns = [{"header": text, "header_format": head} for text in sheet.heads]
    page.add_table(
        0,
        0,
        max(1, len(sheet.rows)),
        len(columns) - 1,
        {"columns": columns, "name": f"t{sheet.name}", "style": "Table Style Light 1"},
    )
    for number, head_text in enumerate(sheet.heads):
        page.set_column(number, number, WIDTHS.get(head_text, WIDE))
    page.freeze_panes(1, 2)
    page.set_landscape()
    page.repeat_rows(0)
    page.fit_to_pages(1, 0)
    for row, cells in enumerate(sheet.rows, 1):
        for column, cell in enumerate(cells):
            if isinstance(cell, Ref):
                text, place = _text(cell.text), places.get((cell.sheet, cell.id))
                if place is None:
                    page.write_string(row, column, text, plain)
                else:
                    page.write_url(row, column, f"internal:'{cell.sheet}'!A{place}", link, text)
            elif isinstance(cell, bool) or not isinstance(cell, (int, float)):
                page.write_string(row, column, _text(cell), plain)
            else:
                page.write_number(row, column, cell, plain)


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (list, tuple)):
        value = ", ".join(map(str, value))
    return for_xml("" if value is None else str(value))[:LONGEST]


def _sheets(sources: Sources) -> list[Sheet]:
    sheets = {name: Sheet(name, heads) for name, heads in HEADS.items()}
    for document in sources.documents.values():
        _clauses(sheets, sources, document)
        _requirements(sheets[REQUIREMENTS], sources, document)
        _measures(sheets[MEASURES], sources, document)
        _verification(sheets[VERIFICATION], sources, document)
        _findings(sheets[FINDINGS], document)
        _assumptions(sheets[ASSUMPTIONS], document)
    return list(sheets.values())


def _id(document: Document, name: str) -> str:
    return f"{document.name}/{name}"


def _proof(one: Evidence | None) -> tuple[str, str]:
    return ("", "") if one is None else (one.path, one.sha256)


def _expected(good: bool | None) -> str:
    return {True: "yes", False: "no"}.get(good, "not judged") if good is not None else "not judged"


def _clauses(sheets: dict[str, Sheet], sources: Sources, document: Document) -> None:
    for chain in traced(sources, document).chains:
        clause, id = chain.clause, _id(document, chain.clause.id)
        links = list(_links(document, chain))
        shown: Any = Ref(LINKS, id, str(len(links))) if links else 0
        sheets[CLAUSES].add(
            id, document.name, clause.id, clause.kind, clause.title, clause.text, clause.device,
            clause.because, chain.word, "; ".join(chain.lacks), shown,
        )  # fmt: skip
        for number, (what, ref, result, evidence) in enumerate(links):
            sheets[LINKS].add(
                id if number == 0 else "",
                document.name,
                Ref(CLAUSES, id, clause.id),
                what,
                ref,
                result,
                evidence,
            )


def _links(document: Document, chain: Chain) -> list[tuple[str, Ref, str, str]]:
    """Everything that a clause leads to: what it is, the cell, its result, its evidence."""
    row = chain.row
    found: list[tuple[str, Ref, str, str]] = []
    for what, names in (("action", row.action), ("definition", row.definition), ("step", row.step)):
        found += [(what, Ref(MEASURES, _id(document, name), name), "", "") for name in names]
    for what, sheet, links in (
        ("property", REQUIREMENTS, chain.properties),
        ("theorem", VERIFICATION, chain.theorems),
    ):
        found += [(what, Ref(sheet, _id(document, one.id), one.id), one.word, one.evidence) for one in links]
    for one in chain.vectors:
        target = one.evidence.rpartition("/")[2].removesuffix(".json")
        found.append(("vector", Ref(VERIFICATION, _id(document, target), one.id), one.word, one.evidence))
    found += [("finding", Ref(FINDINGS, _id(document, name), name), "", "") for name in row.finding]
    found += [("assumption", Ref(ASSUMPTIONS, _id(document, name), name), "", "") for name in row.assumption]
    return found


def _requirements(sheet: Sheet, sources: Sources, document: Document) -> None:
    known: set[str] = set()
    for claim in claims(sources, document):
        one, shown = claim.of, claim.shown
        evidence = None if shown is None else shown.evidence
        sheet.add(
            "" if one.id in known else _id(document, one.id),
            document.name,
            one.id,
            claim.environment,
            one.sentence,
            one.hazard,
            claim.word,
            _expected(claim.good),
            "" if evidence is None else evidence.record["strength"],
            claim.engines,
            "" if shown is None else Ref(VERIFICATION, _id(document, shown.id), shown.id),
            one.clauses,
            one.findings,
            *_proof(evidence),
        )
        known.add(one.id)


def _measures(sheet: Sheet, sources: Sources, document: Document) -> None:
    rooms = {"spec": "specification", "refimpl": "implementation"}
    for one in citations_of(sources, document):
        if one.kind == "definition" and one.room in rooms and (one.clauses or one.findings):
            sheet.add(
                _id(document, one.name), document.name, one.name, rooms[one.room], one.kind, one.device,
                one.clauses, one.findings, one.file,
            )  # fmt: skip


def _verification(sheet: Sheet, sources: Sources, document: Document) -> None:
    for run in document.runs:
        one = said(sources, document, run)
        what = f"falls: {run.property}" if run.property else ", ".join(run.properties)
        _verified(sheet, document, one, "run", what, run.environment, run.strength)
    for _, theorem in theorem_rows(sources, document):
        one = proved(sources, document, theorem.name)
        _verified(sheet, document, one, "theorem", theorem.sentence, "", "")
    for found in sources.of_kind(document.name, "conformance"):
        program = f"{found.result.get('device', found.result.get('target', ''))}: "
        program += str(found.result.get("adapter", found.result.get("implementation", "")))
        _verified(sheet, document, Said(found.id, found), "conformance", program, "", "")


def _verified(
    sheet: Sheet, document: Document, one: Said, kind: str, what: str, environment: str, strength: str
) -> None:
    evidence, steps = one.evidence, steps_of(one)
    record = {} if evidence is None else evidence.record
    sheet.add(
        _id(document, one.id),
        document.name,
        one.id,
        kind,
        what,
        one.word,
        _expected(one.good),
        one.why,
        environment,
        record.get("strength", strength),
        None if evidence is None else evidence.result.get("distinct"),
        None if steps is None else steps.value,
        record.get("seconds"),
        record.get("command", ""),
        *_proof(evidence),
    )


def _findings(sheet: Sheet, document: Document) -> None:
    for one in document.findings:
        first = one.evidence[0] if one.evidence else ""
        shown: Any = Ref(VERIFICATION, _id(document, first), ", ".join(one.evidence))
        sheet.add(
            _id(document, one.id), document.name, one.id, one.severity, one.title, one.says,
            "; ".join(f"({number}) {text}" for number, text in enumerate(one.readings, 1)),
            one.consequence, one.decision, one.switches, one.drawing_could_settle, one.clauses,
            shown if first else one.evidence_open,
        )  # fmt: skip


def _assumptions(sheet: Sheet, document: Document) -> None:
    for one in document.assumptions:
        first = one.breaks[0] if one.breaks else ""
        shown: Any = Ref(VERIFICATION, _id(document, first), ", ".join(one.breaks))
        sheet.add(
            _id(document, one.id), document.name, one.id, one.kind, one.title, one.text, one.who, one.check,
            one.clauses, shown if first else one.breaks_open,
        )  # fmt: skip
