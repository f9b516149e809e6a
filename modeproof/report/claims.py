"""What the evidence says of each property in each environment: by which runs, by which theorems, in one word.

Nothing stands for something that is missing: a run that is declared and has no evidence is a hole, and so is
one whose evidence is of another text.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.citations import Citation, citations, read_sources
from modeproof.registers.citations import Sources as Texts
from modeproof.registers.python_source import PythonTheorem
from modeproof.registers.rows import Document, Property
from modeproof.registers.runs import Run
from modeproof.report.sources import DIFFERS, HOLE, Evidence, Figure, Sources
from modeproof.report.verdicts import ASIDE, POSITIVE

NOT_THERE = "not there"
LANE = "full"
"""The lane that a report is about: what `verify` runs. What only another lane runs is no hole."""
UNDECIDED = ("INCONCLUSIVE", "UNJUDGED", "UNMEASURED")


@dataclass(frozen=True)
class Result:
    """What one run or theorem says; `evidence` is None where there is none."""

    id: str
    evidence: Evidence | None
    note: str = ""
    aside: bool = False
    """It belongs to another lane: that there is no evidence is no hole."""

    @property
    def word(self) -> str:
        """The verdict, or that it is not there."""
        if self.evidence is None:
            return ASIDE if self.aside else NOT_THERE
        return str(self.evidence.record["verdict"])

    @property
    def verdict(self) -> Figure | None:
        """The verdict with its source."""
        return None if self.evidence is None else self.evidence.figure("verdict")

    @property
    def status(self) -> int:
        """0 as expected or of another lane; DIFFERS; HOLE where missing, undecided, of another text."""
        if self.evidence is None:
            return 0 if self.aside else HOLE
        if self.evidence.changed or self.word in UNDECIDED:
            return HOLE
        return 0 if self.evidence.record["as_expected"] else DIFFERS

    @property
    def good(self) -> bool | None:
        """As expected, not as expected, or (None) neither can be said."""
        return None if self.evidence is None else {0: True, DIFFERS: False}.get(self.status)

    @property
    def why(self) -> str:
        """What is wrong with it, in plain words; empty where nothing is."""
        if self.evidence is None:
            return "" if self.aside else self.note or "no evidence"
        if self.evidence.changed:
            return f"the evidence is of another text of {self.evidence.changed[0]}"
        return str(self.evidence.record["reason"])

    @property
    def data(self) -> dict[str, Any]:
        """As parts show it."""
        return {"id": self.id, "word": self.word, "good": self.good, "verdict": self.verdict, "why": self.why}


@dataclass(frozen=True)
class Claim:
    """One property in one environment. `runs` check it, the one declared first is the strongest.

    `theorems` prove it of the shipped code; `because` says why none does, where the proofs say so.
    """

    of: Property
    environment: str
    runs: tuple[Result, ...]
    theorems: tuple[Result, ...]
    because: str

    @property
    def shown(self) -> Result | None:
        """The run whose verdict counts: the worst of those that there are, else the one declared first."""
        there = [run for run in self.runs if run.evidence is not None]
        bad = [one for one in there if one.status == DIFFERS] or [one for one in there if one.status]
        declared = [run for run in self.runs if not run.aside] or list(self.runs)
        return next(iter([*bad, *there, *declared]), None)

    @property
    def status(self) -> int:
        """0; DIFFERS where a run or a theorem is not as expected; HOLE where none judges it."""
        every = [result for result in (self.shown, *self.theorems) if result is not None]
        if self.shown is None:
            return HOLE
        return min((result.status for result in every if result.status), default=0)

    @property
    def good(self) -> bool | None:
        """As expected, not as expected, or (None) neither can be said."""
        if self.shown is None or self.shown.evidence is None:
            return None
        return {0: True, DIFFERS: False}.get(self.status)

    @property
    def word(self) -> str:
        """The verdict of the run whose verdict counts.

        Where another property of the same run failed first, nothing is known of this one: INCONCLUSIVE.
        """
        if self.shown is None or self.shown.evidence is None:
            return NOT_THERE if self.shown is None else self.shown.word
        fell = self.shown.evidence.result.get("violated")
        if self.shown.word == "VIOLATED" and fell and fell != self.of.tla:
            return "INCONCLUSIVE"
        return self.shown.word

    @property
    def engines(self) -> tuple[str, ...]:
        """The engines that agree that it holds."""
        found = []
        if any(run.word == "HOLDS" and run.good for run in self.runs):
            found.append("TLC")
        if any(theorem.word == "PROVED" and theorem.good for theorem in self.theorems):
            found += ["Z3", "cvc5"]
        return tuple(found)

    @property
    def disagreement(self) -> str:
        """What two engines say against each other; empty where they do not."""
        good = [run for run in (*self.runs, *self.theorems) if run.word in ("HOLDS", "PROVED")]
        bad = [run for run in (*self.runs, *self.theorems) if run.word == "VIOLATED"]
        if not good or not bad:
            return ""
        return f"{good[0].id} says {good[0].word}, {bad[0].id} says {bad[0].word}"


def claims(sources: Sources, document: Document) -> tuple[Claim, ...]:
    """Every property of the document in every environment, in the order of the register."""
    return sources.once(f"claims {document.name}", lambda: tuple(_claims(sources, document)))


def _claims(sources: Sources, document: Document) -> Iterator[Claim]:
    named = theorems_of(sources, document)
    agreed = agreement(sources, document)
    for prop in document.properties:
        for environment in prop.environments:
            runs = [
                result_of(sources, document, run)
                for run in document.runs
                if run.kind in POSITIVE and run.environment == environment and prop.tla in run.properties
                if not run.readings
            ]
            row = agreed.get((prop.id, environment))
            if row is None:
                theorems, because = named.get(prop.id, ()), ""
            else:
                theorems, because = (row[0],) if row[0] else (), row[1]
            yield Claim(
                prop,
                environment,
                tuple(runs),
                tuple(theorem_result(sources, document, name) for name in theorems),
                because,
            )


def result_of(sources: Sources, document: Document, run: Run) -> Result:
    """What a declared run says."""
    lanes = " and ".join(run.lanes)
    evidence = sources.evidence[document.name].get(run.id)
    return Result(run.id, evidence, f"a run of lane {lanes}", LANE not in run.lanes)


def steps_of(result: Result) -> Figure | None:
    """The steps of the counterexample that a run found; None where it found none.

    A trace of one state takes no step.
    """
    if result.evidence is None or not result.evidence.result.get("trace"):
        return None
    return Figure(int(result.evidence.result["trace_length"]) - 1, result.evidence.path)


def theorem_result(sources: Sources, document: Document, theorem: str) -> Result:
    """What there is of a theorem."""
    return Result(theorem, sources.evidence[document.name].get(theorem), "no evidence")


def theorems_of(sources: Sources, document: Document) -> Mapping[str, tuple[str, ...]]:
    """The names of the theorems that prove each property, by the property's id."""
    found: dict[str, list[str]] = {}
    for module in texts_of(sources, document).proofs:
        for theorem in module.theorems:
            for name in theorem.properties:
                found.setdefault(name, []).append(theorem.name)
    return {name: tuple(theorems) for name, theorems in found.items()}


def theorem_rows(sources: Sources, document: Document) -> Iterator[tuple[str, PythonTheorem]]:
    """Every theorem of the document with its file, in the order of the files."""
    for module in texts_of(sources, document).proofs:
        for theorem in module.theorems:
            yield module.file, theorem


def agreement(sources: Sources, document: Document) -> Mapping[tuple[str, str], tuple[str, str]]:
    """By property and environment: the theorem that proves it of the whole system, or why none does."""
    found = sources.of_kind(document.name, "agreement")
    rows = found[0].result.get("rows", []) if found else []
    return {(row["id"], row["environment"]): (str(row["theorem"]), str(row["reason"])) for row in rows}


def texts_of(sources: Sources, document: Document) -> Texts:
    """Specification, reference implementation and proofs of a document as texts, read once."""
    return _texts(sources, document)[0]


def fault_of_texts(sources: Sources, document: Document) -> str:
    """Why the texts of a document cannot be read; empty where they can."""
    return _texts(sources, document)[1]


def _texts(sources: Sources, document: Document) -> tuple[Texts, str]:
    def read() -> tuple[Texts, str]:
        try:
            texts = read_sources(document)
        except Unjudged as error:
            return Texts({}, (), ()), error.message
        every = (texts.modules.values(), texts.refimpl, texts.proofs)
        for file in (module.file for modules in every for module in modules):
            sources.content(file)
        return texts, ""

    return sources.once(f"texts {document.name}", read)


def citations_of(sources: Sources, document: Document) -> tuple[Citation, ...]:
    """Who cites what, found once."""
    return sources.once(
        f"citations {document.name}", lambda: citations(document, texts_of(sources, document))
    )
