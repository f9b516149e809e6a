"""The certificate of proofs of properties: for each property an invariant, and what must be `unsat`.

The questions are over the program as it was translated; of memory only what the property depends on stands in
them. That every value stays within its type is a property of its own, the first, and the others build on it.
What makes a property say something, its trigger, is shown by scans from power-up that are run again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import z3

from modeproof.ground.errors import Unjudged
from programs.certificates.certificate_folder import (
    VERSION,
    Obligation,
    Stored,
    digest,
    empty,
    fill,
    obligation,
    record_in,
    reference_files,
    tools,
)
from programs.certificates.smt_lib import Printer
from programs.invariants.induction import DEEPEST, Proof, System, Unrolled, conjuncts
from programs.properties.property_file import read_questions
from programs.properties.property_verdicts import Found, Judgement, never
from programs.properties.transition_system import Asked, Cell, Scans
from programs.readers.sources import read_sources
from programs.semantics.terms import names_in

FORMAT: Final = "modeproof-property-certificate"
TRUSTED: Final = (
    "the reader and translator of programs",
    "the model of the timers",
    "the path explorer, which reads the blocks",
)
"""Besides the solver."""


# ---------------------------------------------------------------- obligations


def obligations(judgement: Judgement, found: Sequence[tuple[Asked, Proof]]) -> Iterator[Obligation]:
    """For each property what must be `unsat`, so that its proof is one."""
    printer = Printer()
    for number, (asked, proof) in enumerate(found, 1):
        bad = judgement.plainly_bad(asked)
        system = judgement.whole.cone(bad, *proof.lemmas)
        together = [*conjuncts(system.within), *proof.lemmas]
        where = [(term, system.after[path]) for path, term in system.state.items()]
        scan = z3.And(*together, system.assumed, system.inside)
        questions = {}
        for count, part in enumerate(together, 1):
            what = f"the range or invariant {count} of {len(together)}"
            questions[f"not: {what} is true at power-up"] = z3.And(system.first, z3.Not(part))
            questions[f"not: {what} survives a scan"] = z3.And(scan, z3.Not(z3.substitute(part, *where)))
        for last in range(proof.deep):
            facts = _scans(system, proof.lemmas, bad, last, True)
            questions[f"not: scan {last + 1} from power-up has the property"] = z3.And(*facts)
        facts = _scans(system, proof.lemmas, bad, proof.deep - 1, False)
        before = f"{proof.deep - 1} scans with it" if proof.deep > 1 else "what is known"
        questions[f"not: after {before} a scan has the property"] = z3.And(*facts)
        sentence = f"{asked.id}: {asked.text}"
        yield obligation(printer, number, asked.id, sentence.replace("\n", " "), {}, questions)


def _scans(
    system: System, lemmas: Sequence[z3.BoolRef], bad: z3.BoolRef, last: int, from_start: bool
) -> list[z3.BoolRef]:
    """Scans up to number `last`, counted from 0, of which that one alone is without the property."""
    unrolled = Unrolled(system, lemmas, from_start)
    for number in range(last):
        unrolled.add(z3.Not(unrolled.put(bad, number)))
        unrolled.more()
    unrolled.add(unrolled.put(bad, last))
    return unrolled.facts


def pruned(judgement: Judgement, asked: Asked, proof: Proof) -> Proof:
    """The proof over the whole program, with the invariants alone that it needs. Raises TimeoutError.

    A value that no scan changes is an invariant here; the search has put it in the place of its name.
    """
    known = [symbol == value for symbol, value in judgement.whole.constants]
    every = [part for lemma in (*proof.lemmas, *known) for part in conjuncts(lemma)]
    bad = judgement.plainly_bad(asked)
    system = judgement.whole.cone(bad, *proof.lemmas)
    names = {str(term) for term in system.state.values()}
    every = [part for part in every if names_in([part]) <= names]
    where = [(term, system.after[path]) for path, term in system.state.items()]
    scan = [system.within, system.assumed, system.inside]

    def surviving(part: z3.BoolRef) -> list[z3.BoolRef]:
        return _core([*scan, z3.Not(z3.substitute(part, *where))], every, lambda lemma: [lemma])

    last = _scans(system, (), bad, proof.deep - 1, False)
    new = _core(last, every, lambda lemma: _at_each(system, lemma, proof.deep))
    new += surviving(system.within)
    needed: list[z3.BoolRef] = []
    while new:
        part = new.pop()
        if not any(part.eq(other) for other in needed):
            needed.append(part)
            new += surviving(part)
    return replace(proof, lemmas=tuple(needed))


def _at_each(system: System, part: z3.BoolRef, deep: int) -> list[z3.BoolRef]:
    """An invariant before each of so many scans."""
    unrolled = Unrolled(system, [], False)
    for _ in range(deep - 1):
        unrolled.more()
    return [unrolled.put(part, number, False) for number in range(deep)]


def _core(known: Sequence[Any], lemmas: Sequence[Any], put: Any) -> list[Any]:
    """The invariants that make what is known unsatisfiable. Raises TimeoutError: they were not seen to."""
    solver = z3.Solver()
    solver.set("timeout", 60_000)
    solver.add(*known)
    marks = [z3.Bool(f"invariant {number}!") for number in range(len(lemmas))]
    for mark, lemma in zip(marks, lemmas, strict=True):
        solver.add([z3.Implies(mark, formula) for formula in put(lemma)])
    if (answer := solver.check(*marks)) != z3.unsat:
        raise TimeoutError(f"the invariants were not seen to be enough: {answer}")
    names = {str(mark) for mark in solver.unsat_core()}
    return [lemma for mark, lemma in zip(marks, lemmas, strict=True) if str(mark) in names]


# ---------------------------------------------------------------- writing


def write(judgement: Judgement, found: Sequence[Found], properties: Path, folder: Path) -> None:
    """Write the certificate of properties that are all PROVED, into a folder that is new or an older one.

    Raises Unjudged: the folder holds something else, or no certificate can be written.
    """
    try:
        proofs = [(one.asked, _kept(judgement, one)) for one in found]
        texts = {owed.file: owed.text for owed in obligations(judgement, proofs)}
    except (NotImplementedError, TimeoutError) as error:
        raise Unjudged(f"{folder}: no certificate can be written: {error}") from None
    rows = [
        {
            "id": asked.id,
            "by": proof.by,
            "scans": proof.deep,
            "invariants": [lemma.sexpr() for lemma in proof.lemmas],
            "reached_by": [
                {
                    "retained": dict(trace.retained),
                    "scans": [{"dt_ms": dt_ms, "in": dict(inputs)} for dt_ms, inputs in trace.scans],
                }
                for trace in one.reached
            ],
        }
        for one, (asked, proof) in zip(found, proofs, strict=True)
    ]
    empty(folder)
    fill(folder, {**claim(judgement, properties), "proofs": rows}, texts)


def _kept(judgement: Judgement, found: Found) -> Proof:
    """The proof as it will be read again."""
    assert found.proof is not None
    proof = pruned(judgement, found.asked, found.proof)
    lemmas = read_invariants(judgement.whole, [lemma.sexpr() for lemma in proof.lemmas])
    return replace(proof, lemmas=lemmas)


def read_invariants(system: System, texts: Sequence[str]) -> tuple[z3.BoolRef, ...]:
    """Formulas over the memory of a system. Raises ValueError: no such formula."""
    declared = "".join(f"{term.decl().sexpr()}\n" for term in system.state.values())
    found = []
    for text in texts:
        try:
            read = z3.parse_smt2_string(f"{declared}(assert {text})")
        except z3.Z3Exception as error:
            raise ValueError(f"no invariant: {' '.join(str(error).split())[:100]}") from None
        if len(read) != 1:
            raise ValueError(f"not one invariant: {text[:60]}")
        found.append(read[0])
    return tuple(found)


def claim(judgement: Judgement, properties: Path) -> dict[str, Any]:
    """What a certificate is about."""
    cell = judgement.cell
    return {
        "format": FORMAT,
        "version": VERSION,
        "unit": cell.unit.name,
        "wrap": cell.wrap,
        "scan_time_ms": list(cell.scan_time),
        "blocks": {name: block.reference.device.name for name, block in cell.blocks.items()},
        "asked": [[asked.id, asked.sentence, asked.text] for asked in judgement.every],
        "sources": dict(cell.source.files),
        "properties": {str(properties): digest(properties)},
        "reference": reference_of(cell),
        "trusted": list(TRUSTED),
        "tools": tools(),
    }


def reference_of(cell: Cell) -> dict[str, str]:
    """The files of the documents' blocks that a program calls, with their SHA-256."""
    documents = sorted({block.reference.document for block in cell.blocks.values()})
    return {path: known for document in documents for path, known in reference_files(document).items()}


# ---------------------------------------------------------------- reading


@dataclass(frozen=True)
class Kept(Stored):
    """A certificate of properties as it was read."""

    def judgement(self) -> Judgement:
        """The program with its properties, as the files say. Raises Unjudged: they have changed."""
        sources, questions = self.files("sources"), self.files("properties")
        if len(questions) != 1:
            raise self.refuse("it has not one file of properties")
        asked = read_questions(questions[0])
        source = read_sources(sources)
        cell = Cell.of(
            source,
            source.chosen(str(self.record.get("unit"))),
            asked.scan_time,
            self.record.get("wrap") is True,
        )
        found = Judgement(cell, asked.asked(cell), 0.0, lambda text: None)
        self.claims(claim(found, Path(next(iter(self.table("properties"))))))
        return found

    def proofs(self, judgement: Judgement) -> list[tuple[Asked, Proof]]:
        """The proof of each property. Raises Unjudged: one is not there, or has not the form of one."""
        rows = self.record.get("proofs")
        if not isinstance(rows, list) or len(rows) != len(judgement.every):
            raise self.refuse("it has not one proof for each property")
        found = []
        for asked, row in zip(judgement.every, rows, strict=True):
            try:
                deep = row["scans"]
                if row["id"] != asked.id or type(deep) is not int or not 1 <= deep <= DEEPEST:
                    raise ValueError(f"{row['id']} over {deep} scans")
                lemmas = read_invariants(judgement.whole, row["invariants"])
                self._follow(judgement.cell, asked, row["reached_by"])
            except (KeyError, TypeError, ValueError, AttributeError) as error:
                raise self.refuse(f"{asked.id}: not the form of a certificate: {error!r:.200}") from None
            found.append((asked, Proof(deep, lemmas, str(row["by"]))))
        return found

    def _follow(self, cell: Cell, asked: Asked, rows: Sequence[Mapping[str, Any]]) -> None:
        """Run the scans to each trigger. Raises Unjudged: they do not lead there."""
        if len(rows) != len(asked.trigger):
            raise self.refuse(f"{asked.id}: it has not one way to each of its {len(asked.trigger)} triggers")
        for (text, trigger), row in zip(asked.trigger, rows, strict=True):
            scans: Scans = [(int(scan["dt_ms"]), dict(scan["in"])) for scan in row["scans"]]
            retained = dict(row["retained"])
            odd = _outside(cell, retained, scans)
            if odd or cell.run(retained, scans, never(asked, trigger)) is None:
                raise self.refuse(f"{asked.id}: the scans to `{text}` do not lead there{odd}")


def read(folder: Path) -> Kept:
    """The certificate of properties in a folder. Raises Unjudged."""
    return Kept(folder, record_in(folder, FORMAT))


def _outside(cell: Cell, retained: Mapping[str, Any], scans: Scans) -> str:
    """What scans start from or take that the claim is not about; nothing: it is about all of it."""
    low, high = cell.scan_time
    if any(dt_ms < low or dt_ms > (dt_ms if high is None else high) for dt_ms, _ in scans):
        return ": a scan is too short or too long"
    given = [(cell.inputs, inputs) for _, inputs in scans]
    if any(path not in cell.retained for path in retained):
        return ": a value at power-up is not RETAIN"
    for slots, values in [(cell.slots, retained), *given]:
        for path, value in values.items():
            if path not in slots or not slots[path].type.low <= value <= slots[path].type.high:
                return f": {path} is not, or cannot be {value}"
    return ""
