"""Proofs about a transition system, and the shortest way to what must not be.

A property is shown by k-induction, with invariants that were found before, or by z3's Spacer, whose own
invariant is asked again. A counterexample is looked for scan by scan from power-up: the first is a shortest.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import z3

from programs.invariants.relations import plain
from programs.semantics.terms import names_in

LIMIT_MS = 20_000
"""For one question, on a machine that does nothing else."""
UNITS_A_SECOND = 5_000_000
"""What z3 counts of its own work; by this a limit does not depend on what else the machine does."""
PATIENCE = 10
"""So many times a limit may a question take by the clock, whatever z3 counts."""
DEEPEST = 3
"""Scans of one induction step."""


@dataclass(frozen=True)
class System:
    """A scan over the symbols of memory and inputs.

    start: each value at power-up, None for any.
    """

    state: Mapping[str, Any]
    inputs: Mapping[str, Any]
    start: Mapping[str, Any]
    after: Mapping[str, Any]
    assumed: z3.BoolRef
    """What holds in every scan: the ranges of inputs and of the scan time."""
    inside: z3.BoolRef
    """What holds in every scan that is followed by another one: values stay within their types."""
    within: z3.BoolRef
    """The ranges of memory: shown with the invariant, not taken for granted."""

    def cone(self, *terms: Any) -> System:
        """The system without the values on which neither these terms nor its premises depend."""
        known: set[str] = set()
        waiting = [*(names_in([term]) for term in terms), names_in([self.assumed, self.inside])]
        by_name = {str(term): path for path, term in self.state.items()}
        while waiting:
            for name in waiting.pop():
                path = by_name.get(name)
                if path is not None and path not in known:
                    known.add(path)
                    waiting.append(self._names(path))
        kept = {path: term for path, term in self.state.items() if path in known}
        own = {str(term) for term in kept.values()}
        within = z3.And([z3.BoolVal(True), *(part for part, names in self._ranges if names <= own)])
        return System(
            kept,
            self.inputs,
            {path: self.start[path] for path in kept},
            {path: self.after[path] for path in kept},
            self.assumed,
            self.inside,
            within,
        )

    def _names(self, path: str) -> set[str]:
        """The symbols on which a value after a scan depends."""
        if path not in self._read:
            self._read[path] = names_in([self.after[path]])
        return self._read[path]

    @cached_property
    def _read(self) -> dict[str, set[str]]:
        return {}

    @cached_property
    def _ranges(self) -> list[tuple[z3.BoolRef, set[str]]]:
        return [(part, names_in([part])) for part in conjuncts(self.within)]

    @cached_property
    def constants(self) -> list[tuple[Any, Any]]:
        """The values that every scan leaves as they are at power-up, each with that value."""
        found: list[tuple[Any, Any]] = []
        after = dict(self.after)
        while True:
            new = []
            for path, term in after.items():
                value = self.start[path]
                if value is not None:
                    own = z3.simplify(z3.substitute(term, (self.state[path], value)))
                    if own.eq(value):
                        new.append((path, value))
            if not new:
                return found
            where = [(self.state[path], value) for path, value in new]
            found += where
            gone = {path for path, _ in new}
            after = {
                path: z3.simplify(z3.substitute(term, *where))
                for path, term in after.items()
                if path not in gone
            }

    def without_constants(self) -> System:
        """The system with these values in the place of their symbols."""
        gone = {str(symbol) for symbol, _ in self.constants}

        def put(term: Any) -> Any:
            return z3.simplify(z3.substitute(term, *self.constants)) if self.constants else term

        kept = {path: term for path, term in self.state.items() if str(term) not in gone}
        return System(
            kept,
            self.inputs,
            {path: self.start[path] for path in kept},
            {path: put(self.after[path]) for path in kept},
            put(self.assumed),
            put(self.inside),
            put(self.within),
        )

    @cached_property
    def first(self) -> z3.BoolRef:
        """The memory at power-up: what begins with any value is within its range, the rest is what it is."""
        known = {path: value for path, value in self.start.items() if value is not None}
        free = {str(term) for path, term in self.state.items() if path not in known}
        ranges = [part for part in conjuncts(self.within) if names_in([part]) <= free]
        return z3.And([*ranges, *(self.state[path] == value for path, value in known.items())])


@dataclass(frozen=True)
class Way:
    """Scans from power-up: the values at power-up, and the inputs of each scan."""

    start: Mapping[str, Any]
    scans: tuple[Mapping[str, Any], ...]


class Unrolled:
    """Scans one after the other in one solver, from power-up or from anywhere."""

    def __init__(self, system: System, lemmas: Sequence[z3.BoolRef], from_start: bool) -> None:
        self.system, self.lemmas = system, lemmas
        self.solver = z3.Solver()
        self.solver.set(**limits(LIMIT_MS))
        self.facts: list[z3.BoolRef] = []
        """What the solver was told."""
        self.states: list[dict[str, Any]] = []
        self.read: list[dict[str, Any]] = []
        self._at({path: named(term, 0) for path, term in system.state.items()})
        if from_start:
            self.add(self.put(system.first, 0, False))

    def add(self, *facts: z3.BoolRef) -> None:
        """Tell the solver."""
        self.facts += facts
        self.solver.add(*facts)

    def _at(self, state: dict[str, Any]) -> None:
        self.states.append(state)
        number = len(self.states) - 1
        self.read.append({name: named(term, number) for name, term in self.system.inputs.items()})
        self.add(self.put(self.system.within, number, False))
        self.add(*(self.put(lemma, number, False) for lemma in self.lemmas))
        self.add(self.put(self.system.assumed, number))

    def put(self, term: Any, number: int, scan: bool = True) -> Any:
        """A term over the values before scan `number`, counted from 0, and its inputs."""
        where = [(self.system.state[path], new) for path, new in self.states[number].items()]
        if scan:
            where += [(self.system.inputs[name], new) for name, new in self.read[number].items()]
        return z3.substitute(term, *where)

    def more(self) -> None:
        """One scan more."""
        number = len(self.states) - 1
        state = {path: named(term, number + 1) for path, term in self.system.state.items()}
        self.add(*(new == self.put(self.system.after[path], number) for path, new in state.items()))
        self.add(self.put(self.system.inside, number))
        self._at(state)

    def ask(self, *extra: Any) -> z3.CheckSatResult:
        """Whether there are such scans. Raises TimeoutError: no answer."""
        answer = self.solver.check(*extra)
        if answer == z3.unknown:
            raise TimeoutError(f"a question had no answer: {self.solver.reason_unknown()}")
        return answer

    def way(self) -> Way:
        """The scans of the last answer."""
        model = self.solver.model()

        def values(terms: Mapping[str, Any]) -> dict[str, Any]:
            return {name: plain(model.eval(term, model_completion=True)) for name, term in terms.items()}

        return Way(values(self.states[0]), tuple(values(read) for read in self.read))


def shortest(system: System, bad: z3.BoolRef, most: int, until: float) -> tuple[Way | None, int]:
    """The fewest scans from power-up to `bad`, or how many scans were looked at without meeting it."""
    unrolled = Unrolled(system.cone(bad), [], True)
    for number in range(most):
        if number:
            unrolled.more()
        if time.process_time() > until:
            return None, number
        try:
            if unrolled.ask(unrolled.put(bad, number)) == z3.sat:
                return unrolled.way(), number + 1
        except TimeoutError:
            return None, number
        unrolled.add(z3.Not(unrolled.put(bad, number)))
    return None, most


# ---------------------------------------------------------------- proofs


@dataclass(frozen=True)
class Proof:
    """`bad` does not come about in the first `deep` scans, nor after `deep` scans without it."""

    deep: int
    lemmas: Sequence[z3.BoolRef]
    by: str


def induction(system: System, bad: z3.BoolRef, lemmas: Sequence[z3.BoolRef], until: float) -> Proof | None:
    """A proof by k-induction; None: there is none with few scans."""
    for deep in range(1, DEEPEST + 1):
        if time.process_time() > until:
            return None
        proof = Proof(deep, lemmas, f"induction over {deep} scan{'s' * (deep > 1)}")
        try:
            if holds_up(system, bad, proof):
                return proof
        except TimeoutError:
            return None
    return None


def holds_up(system: System, bad: z3.BoolRef, proof: Proof) -> bool:
    """Whether a proof is one: asked anew, from the system alone. Raises TimeoutError: no answer."""
    small = system.cone(bad, *proof.lemmas)
    if not is_inductive(small, proof.lemmas):
        return False
    places = places_of(proof.lemmas)
    for known in [[place] for place in places] + [None]:
        unrolled = Unrolled(small, proof.lemmas, known is None)
        unrolled.add(*(unrolled.put(part, 0, False) for part in known or ()))
        for number in range(proof.deep):
            if number:
                unrolled.more()
            last = number == proof.deep - 1
            if (known is None or last) and unrolled.ask(unrolled.put(bad, number)) != z3.unsat:
                return False
            unrolled.add(z3.Not(unrolled.put(bad, number)))
    return True


def is_inductive(system: System, lemmas: Sequence[z3.BoolRef]) -> bool:
    """The lemmas and the ranges of memory hold at power-up and survive every scan. Raises TimeoutError."""
    together = z3.And([system.within, *lemmas])
    where = [(term, system.after[path]) for path, term in system.state.items()]
    after, scan = z3.substitute(together, *where), z3.And(together, system.assumed, system.inside)
    for known, then in (
        (system.first, together),
        *((z3.And(place, scan), after) for place in places_of(lemmas)),
    ):
        solver = z3.Solver()
        solver.set(**limits(3 * LIMIT_MS))
        solver.add(known, z3.Not(then))
        answer = solver.check()
        if answer == z3.unknown:
            raise TimeoutError(f"a question had no answer: {solver.reason_unknown()}")
        if answer == z3.sat:
            return False
    return True


def places_of(lemmas: Sequence[z3.BoolRef]) -> list[z3.BoolRef]:
    """The places of an invariant by places: what is in one of them is asked of each alone. TRUE: it has none."""
    for lemma in lemmas:
        if z3.is_or(lemma) and lemma.num_args() > 1:
            names = [{str(symbol) for symbol, _ in said_by(part)} for part in lemma.children()]
            if names[0] and all(one == names[0] for one in names):
                return list(lemma.children())
    return [z3.BoolVal(True)]


def in_place(place: z3.BoolRef, formula: z3.BoolRef) -> z3.BoolRef:
    """A formula in a place, with the values there for their names; the formula itself where the place is TRUE."""
    where = said_by(place)
    return z3.And(place, z3.simplify(z3.substitute(formula, *where))) if where else formula


def said_by(place: z3.BoolRef) -> list[tuple[Any, Any]]:
    """The symbols and values of a place; nothing if it says something else."""
    found = []
    for part in conjuncts(place):
        pair = sorted(part.children(), key=lambda side: bool(names_in([side])), reverse=True)
        if not z3.is_eq(part) or not z3.is_const(pair[0]) or names_in(pair[1:]) or not names_in(pair[:1]):
            return []
        found.append((pair[0], pair[1]))
    return found


def spacer(system: System, bad: z3.BoolRef, lemmas: Sequence[z3.BoolRef], seconds: float) -> Proof | None:
    """A proof by z3's Spacer, whose invariant was asked again; None: it has none in that time."""
    small = system.cone(bad, *lemmas)
    invariant = spacer_invariant(small, bad, lemmas, seconds)
    if invariant is None:
        return None
    proof = Proof(1, [*lemmas, invariant], "an invariant of z3's Spacer")
    try:
        return proof if holds_up(system, bad, proof) else None
    except (z3.Z3Exception, TimeoutError):
        return None


def spacer_invariant(
    small: System, bad: z3.BoolRef, lemmas: Sequence[z3.BoolRef], seconds: float
) -> z3.BoolRef | None:
    """An invariant that excludes `bad`, as z3's Spacer says; None: it says nothing in that time."""
    fixed = z3.Fixedpoint()
    fixed.set(engine="spacer", **limits(seconds * 1000))
    order = list(small.state)
    known = z3.Function("known", *(small.state[path].sort() for path in order), z3.BoolSort())
    wrong = z3.Function("wrong", z3.BoolSort())
    fixed.register_relation(known, wrong)
    fixed.declare_var(*small.state.values(), *small.inputs.values())
    here = known(*(small.state[path] for path in order))
    fixed.rule(here, [small.first])
    premises = [here, small.within, small.assumed, *lemmas]
    fixed.rule(known(*(small.after[path] for path in order)), [*premises, small.inside])
    fixed.rule(wrong(), [*premises, bad])
    try:
        if fixed.query(wrong()) != z3.unsat:
            return None
        return _interpretation(fixed.get_answer(), known, [small.state[path] for path in order])
    except z3.Z3Exception:
        return None


def _interpretation(answer: Any, known: Any, terms: Sequence[Any]) -> z3.BoolRef:
    """What the answer says of `known`, over these terms. Raises z3.Z3Exception: it says nothing of it."""
    waiting = [answer]
    while waiting:
        node = waiting.pop()
        if z3.is_quantifier(node):
            body = node.body()
            if z3.is_eq(body) and z3.is_app(body.arg(0)) and body.arg(0).decl().eq(known):
                places = {
                    z3.get_var_index(argument): term
                    for argument, term in zip(body.arg(0).children(), terms, strict=True)
                }
                found: z3.BoolRef = z3.substitute_vars(body.arg(1), *(places[n] for n in range(len(terms))))
                return found
            waiting.append(body)
        elif z3.is_app(node):
            waiting += node.children()
    raise z3.Z3Exception("no invariant in the answer")


# ---------------------------------------------------------------- small


def limits(ms: float) -> dict[str, int]:
    """A limit of z3 that is the same on a busy machine, in ms of one that is not."""
    most = (1 << 32) - 1
    units, clock = int(ms / 1000 * UNITS_A_SECOND), int(PATIENCE * ms)
    return {"rlimit": max(1, min(units, most)), "timeout": max(1, min(clock, most))}


def named(term: Any, number: object) -> Any:
    """A symbol of the same sort, for another scan."""
    return z3.Const(f"{term}@{number}", term.sort())


def conjuncts(term: Any) -> list[Any]:
    """The parts of an AND of ANDs; a term that is none is its only part."""
    if z3.is_and(term):
        return [part for child in term.children() for part in conjuncts(child)]
    return [term]
