"""What must be `unsat`, so that an invariant of a transition system shows what it is said to show."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import z3

from programs.certificates.certificate_folder import Obligation, obligation
from programs.certificates.smt_lib import Printer
from programs.invariants.induction import Proof, System, Unrolled, conjuncts, in_place, named, places_of
from programs.semantics.terms import names_in


@dataclass(frozen=True)
class Claim:
    """Something that is said to hold in every scan, and its proof. bad: the scans without it."""

    id: str
    text: str
    bad: z3.BoolRef
    proof: Proof


def obligations(whole: System, claims: Sequence[Claim]) -> Iterator[Obligation]:
    """For each claim what must be `unsat`, so that its proof is one."""
    printer = Printer()
    for number, claim in enumerate(claims, 1):
        bad, proof = claim.bad, claim.proof
        system = whole.cone(bad, *proof.lemmas)
        together = [*conjuncts(system.within), *proof.lemmas]
        where = [(term, system.after[path]) for path, term in system.state.items()]
        scan = z3.And(*together, system.assumed, system.inside)
        places = places_of(proof.lemmas)
        questions = {}
        for count, part in enumerate(together, 1):
            what = f"the range or invariant {count} of {len(together)}"
            questions[f"not: {what} is true at power-up"] = z3.And(system.first, z3.Not(part))
            if len(places) == 1:
                questions[f"not: {what} survives a scan"] = z3.And(scan, z3.Not(z3.substitute(part, *where)))
        after = z3.substitute(z3.And(together), *where)
        for at, place in enumerate(places if len(places) > 1 else (), 1):
            what = f"every range and invariant survives a scan from place {at} of {len(places)}"
            questions[f"not: {what}"] = in_place(place, z3.And(scan, z3.Not(after)))
        for last in range(proof.deep):
            facts = _scans(system, proof.lemmas, bad, last, True)
            questions[f"not: scan {last + 1} from power-up has the property"] = z3.And(*facts)
        facts = _scans(system, proof.lemmas, bad, proof.deep - 1, False)
        before = f"{proof.deep - 1} scans with it" if proof.deep > 1 else "what is known"
        first = [(term, named(term, 0)) for term in system.state.values()]
        for at, place in enumerate(places, 1):
            here = f" of place {at}" if len(places) > 1 else ""
            begun = z3.substitute(place, *first)
            questions[f"not: after {before}{here} a scan has the property"] = in_place(begun, z3.And(*facts))
        sentence = f"{claim.id}: {claim.text}"
        yield obligation(printer, number, claim.id, sentence.replace("\n", " "), {}, questions)


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


def pruned(whole: System, bad: z3.BoolRef, proof: Proof) -> Proof:
    """The proof over the whole program, with the invariants alone that it needs. Raises TimeoutError.

    A value that no scan changes is an invariant here; the search has put it in the place of its name.
    """
    known = [symbol == value for symbol, value in whole.constants]
    every = [part for lemma in (*proof.lemmas, *known) for part in conjuncts(lemma)]
    system = whole.cone(bad, *proof.lemmas)
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


def _over_all(whole: System, bad: z3.BoolRef, proof: Proof) -> Proof:
    """The proof over the whole program, with all invariants. As in `pruned`, of what no scan changes too."""
    names = {str(term) for term in whole.cone(bad, *proof.lemmas).state.values()}
    known = [symbol == value for symbol, value in whole.constants if str(symbol) in names]
    return replace(proof, lemmas=(*proof.lemmas, *known))


def _at_each(system: System, part: z3.BoolRef, deep: int) -> list[z3.BoolRef]:
    """An invariant before each of so many scans."""
    unrolled = Unrolled(system, [], False)
    for _ in range(deep - 1):
        unrolled.more()
    return [unrolled.put(part, number, False) for number in range(deep)]


def _core(
    known: Sequence[Any], lemmas: Sequence[Any], put: Callable[[z3.BoolRef], list[z3.BoolRef]]
) -> list[Any]:
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


def kept(whole: System, bad: z3.BoolRef, proof: Proof) -> Proof:
    """A proof as it will be read again. Raises TimeoutError."""
    small = pruned(whole, bad, proof) if len(places_of(proof.lemmas)) == 1 else _over_all(whole, bad, proof)
    return replace(small, lemmas=read_invariants(whole, [lemma.sexpr() for lemma in small.lemmas]))


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
