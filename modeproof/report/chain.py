"""From clause to result: each clause with all that cites it, and what the evidence says of that."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from modeproof.registers.matrix import Row, matrix_of, orphans
from modeproof.registers.rows import Clause, Document, Problem
from modeproof.report.claims import Claim, citations_of, claims, texts_of, theorem_result
from modeproof.report.snapshot import as_it_counts
from modeproof.report.sources import DIFFERS, HOLE, Sources
from modeproof.report.verdicts import ASIDE, status_of


@dataclass(frozen=True)
class Link:
    """What a clause leads to, in one word, with the file of the evidence; `good` as of a verdict."""

    id: str
    word: str
    good: bool | None
    evidence: str = ""


@dataclass(frozen=True)
class Chain:
    """One clause: its row of the matrix, what its properties, theorems and vectors come to, what it lacks."""

    document: Document
    clause: Clause
    row: Row
    properties: tuple[Link, ...]
    theorems: tuple[Link, ...]
    vectors: tuple[Link, ...]
    lacks: tuple[str, ...]

    @property
    def links(self) -> tuple[Link, ...]:
        """All that has a result."""
        return (*self.properties, *self.theorems, *self.vectors)

    @property
    def status(self) -> int:
        """DIFFERS where it lacks something or a result is not as expected; HOLE where one is not there."""
        if self.lacks or any(link.good is False for link in self.links):
            return DIFFERS
        return HOLE if any(link.good is None and link.word != ASIDE for link in self.links) else 0

    @property
    def word(self) -> str:
        """The result in plain words."""
        if self.lacks:
            return "orphan"
        if not self.links:
            return (
                "nothing to show"
                if self.clause.kind in ("not modelled", "assumption")
                else "no result of its own"
            )
        return {0: "as expected", DIFFERS: "not as expected", HOLE: "not there"}[self.status]

    @property
    def good(self) -> bool | None:
        """As expected, not as expected, or (None) nothing can be said."""
        if self.status == DIFFERS:
            return False
        return True if self.links and not self.status else None


@dataclass(frozen=True)
class Traced:
    """The matrix of one document; `astray` is work that no clause asks for."""

    chains: tuple[Chain, ...]
    astray: tuple[Problem, ...]


def traced(sources: Sources, document: Document) -> Traced:
    """The matrix with results: orphans first, then what is not as expected, then the register's order."""
    return sources.once(f"traced {document.name}", lambda: _traced(sources, document))


def _traced(sources: Sources, document: Document) -> Traced:
    cited = citations_of(sources, document)
    rows = matrix_of(document, cited)
    problems = orphans(document, rows, cited, texts_of(sources, document))
    ids = {declared.id for declared in document.clauses}
    lacking: dict[str, list[str]] = {}
    for problem in problems:
        if problem.place in ids:
            lacking.setdefault(problem.place, []).append(problem.text)
    by_property: dict[str, list[Claim]] = {}
    for claim in claims(sources, document):
        by_property.setdefault(claim.of.id, []).append(claim)
    vectors = _vectors(sources, document)
    chains = [
        Chain(
            document,
            clause,
            row,
            tuple(_property(name, by_property.get(name, ())) for name in row.property),
            tuple(_theorem(sources, document, name) for name in row.theorem),
            tuple(_vector(name, vectors) for name in row.vector),
            tuple(lacking.get(clause.id, ())),
        )
        for clause, row in zip(document.clauses, rows, strict=True)
    ]
    order = {DIFFERS: 1, HOLE: 2, 0: 3}
    chains.sort(key=lambda one: 0 if one.lacks else order[one.status])
    return Traced(tuple(chains), tuple(problem for problem in problems if problem.place not in ids))


def _property(name: str, own: Iterable[Claim]) -> Link:
    """The worst of its verdicts over all environments."""
    found = sorted(own, key=lambda one: {DIFFERS: 0, HOLE: 1, 0: 2}[one.status])
    if not found:
        return Link(name, "not there", None)
    worst = found[0]
    if worst.status == 0:
        worst = next((claim for claim in found if claim.good), worst)
    evidence = worst.shown.evidence if worst.shown is not None else None
    return Link(name, worst.word, worst.good, "" if evidence is None else evidence.path)


def _theorem(sources: Sources, document: Document, name: str) -> Link:
    one = theorem_result(sources, document, name)
    return Link(name, one.word, one.good, "" if one.evidence is None else one.evidence.path)


def _vectors(sources: Sources, document: Document) -> Mapping[tuple[str, str], Link]:
    """By target and step: what the programs that were run against vectors came to."""
    found: dict[tuple[str, str], Link] = {}
    for piece in sources.of_kind(document.name, "conformance"):
        if "suite" not in piece.result:
            continue
        status = status_of(as_it_counts(piece))
        for step, (have, total) in piece.result.get("covered", {}).items():
            good = False if status == DIFFERS else True if not status and have == total and total else None
            open_word = "of another text" if piece.changed else "not in full" if not status else "not judged"
            word = str(piece.record["verdict"]) if good is not None else open_word
            key = str(piece.result.get("target", "")), str(step)
            before = found.get(key)
            if before is None or good is False or (good and before.good is None):
                found[key] = Link(f"{key[0]}/{step}", f"{word} ({piece.result['suite']})", good, piece.path)
    return found


def _vector(name: str, known: Mapping[tuple[str, str], Link]) -> Link:
    target, _, step = name.partition("/tour:")
    one = known.get((target, step))
    return Link(name, "not there", None) if one is None else Link(name, one.word, one.good, one.evidence)
