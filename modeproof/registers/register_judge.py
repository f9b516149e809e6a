"""Judges the registers of a document. It finds contradictions, unknown ids, orphans and differing names."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.places import documents
from modeproof.registers.citations import citations, read_sources, unresolved
from modeproof.registers.crosscheck import cross_check
from modeproof.registers.document_page import check_document_page
from modeproof.registers.killers import check_killers, ways_to_fall
from modeproof.registers.load import load_document
from modeproof.registers.machine_pins import check_machine_pins
from modeproof.registers.matrix import Row, matrix_of, orphans
from modeproof.registers.names import check_names
from modeproof.registers.pins import check_pins
from modeproof.registers.readings import check_readings, check_tops
from modeproof.registers.refuting import check_refuting
from modeproof.registers.responses import check_responses
from modeproof.registers.rooms import check_imports, check_no_document_known, check_order
from modeproof.registers.rows import Document, Problem
from modeproof.registers.tables import check_pages
from modeproof.registers.vector_files import check_vectors
from modeproof.registers.views import check_views


@dataclass(frozen=True)
class Judgement:
    """The matrix of a document and all that is wrong; as expected means no problem and at least one row."""

    document: str
    rows: tuple[Row, ...]
    problems: tuple[Problem, ...]
    citations: int
    unresolved: int
    falls: Counter[str]
    """How many properties are broken by a negative, by an edit, or are true by construction."""

    @property
    def as_expected(self) -> bool:
        """Whether nothing is wrong."""
        return bool(self.rows) and not self.problems


def judge(document: Document) -> Judgement:
    """Judge one document. Raises Unjudged when a file that it names cannot be read."""
    sources = read_sources(document)
    cited = citations(document, sources)
    rows = matrix_of(document, cited)
    lost = unresolved(document, cited)
    problems = [
        *cross_check(document, sources),
        *check_readings(document, sources.modules),
        *check_tops(document, sources.modules),
        *check_views(document, sources.modules),
        *(faults := check_responses(document, sources)),
        *(() if faults else check_document_page(document, sources)),
        *lost,
        *orphans(document, rows, cited, sources),
        *check_names(document, sources),
        *check_pins(document, sources),
        *check_killers(document, sources),
        *check_refuting(document, sources),
    ]
    count = sum(len(citation.clauses) + len(citation.findings) for citation in cited)
    falls = Counter(found.kind for found in ways_to_fall(document, sources).values())
    return Judgement(document.name, rows, tuple(problems), count, len(lost), falls)


def judge_tree(root: Path) -> list[Problem]:
    """What concerns no single document: the walls between rooms, and rendered tables in pages."""
    loaded = [load_document(root, name) for name in documents(root)]
    return [
        *check_imports(root),
        *check_order(root),
        *check_no_document_known(root, [document.interface for document in loaded], loaded),
        *check_pages(root, loaded),
        *check_vectors(root),
        *check_machine_pins(root),
    ]


def check_document(root: Path, name: str) -> list[Problem]:
    """Load and judge one document and the tree around it; an empty list when nothing is wrong.

    Raises Unjudged with one line when a register or a file that it names cannot be read.
    """
    return [*judge(load_document(root, name)).problems, *judge_tree(root)]


def matrix(document: Document) -> tuple[Row, ...]:
    """The matrix alone."""
    return matrix_of(document, citations(document, read_sources(document)))
