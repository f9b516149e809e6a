"""An invariant by places: a place is where some values of memory, such as a control state, are what they are.

From power-up on a solver is asked for a scan that leaves what is known of the place where it ends; what it
finds is joined to that. Known of a place is the range of each other value, and which of them are equal or in
order. In the end no scan leaves it, so that it is an invariant.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import z3

from programs.invariants.induction import LIMIT_MS, System, limits, named
from programs.invariants.relations import like, plain
from programs.semantics.terms import compared_with

MOST_NUMBER = 64
"""A number that can be above it, or below it with the other sign, has no bound there."""
PATIENCE = 3
"""So often a number may grow by itself before it is taken to go on."""
Place = tuple[Any, ...]
Terms = Mapping[str, Any]


@dataclass
class Known:
    """What is known of the values in a place: their ranges, None: no bound; pairs of names that are equal,
    and of numbers that are in order.
    """

    low: dict[str, Any]
    high: dict[str, Any]
    equal: list[tuple[str, str]]
    at_most: list[tuple[str, str]]

    grown: dict[str, int] = field(default_factory=dict)
    """How often a number became greater in a scan that stays in the place."""

    def join(self, values: Mapping[str, Any], stays: bool, stops: Sequence[int]) -> None:
        """Also these values are possible. stays: after a scan that begins in this place, too; what grows in
        such scans goes on to the next of the numbers at which anything stops.
        """
        for name, low in self.low.items():
            value = values[name]
            if low is not None and value < low:
                self.low[name] = value if value >= -MOST_NUMBER else None
            if (high := self.high[name]) is not None and value > high:
                if stays and not isinstance(value, bool):
                    self.grown[name] = self.grown.get(name, 0) + 1
                    if self.grown[name] > PATIENCE:
                        value = next((stop for stop in stops if stop >= value), MOST_NUMBER + 1)
                self.high[name] = value if value <= MOST_NUMBER else None
        self.equal = [pair for pair in self.equal if values[pair[0]] == values[pair[1]]]
        self.at_most = [pair for pair in self.at_most if values[pair[0]] <= values[pair[1]]]

    def facts(self, terms: Terms) -> Iterator[z3.BoolRef]:
        """The same over terms, without what follows from the rest."""
        single = {name for name, low in self.low.items() if low is not None and low == self.high[name]}
        for name, low in self.low.items():
            term, high = terms[name], self.high[name]
            if name in single:
                yield term if z3.is_bool(term) and low else term == like(term, low)
            elif z3.is_int(term):
                if low is not None:
                    yield term >= low
                if high is not None:
                    yield term <= high
        first: dict[str, str] = {}
        for one, other in self.equal:
            if one not in single and other not in first and one not in first:
                first[other] = one
                yield terms[one] == terms[other]
        for one, other in self.at_most:
            left, right = self.high[one], self.low[other]
            if one in first or other in first or (left is not None and right is not None and left <= right):
                continue
            if self.high[one] is None or self.high[other] is None:
                yield terms[one] <= terms[other]


@dataclass
class Located:
    """Looks for such an invariant. places: the names of memory whose values make a place."""

    system: System
    places: Sequence[str]
    tell: Callable[[str], None] = lambda text: None
    known: dict[Place, Known] = field(default_factory=dict)
    after: dict[Place, dict[Place, None]] = field(default_factory=dict)
    """For each place those that a scan can lead to, as far as it is known."""
    queries: int = 0

    def __post_init__(self) -> None:
        state = self.system.state
        self.rest = [name for name in state if name not in self.places]
        self.steady = {name for name in self.rest if self.system.after[name].eq(state[name])}
        pairs = [
            (one, other)
            for one, other in itertools.combinations(self.rest, 2)
            if not {one, other} <= self.steady
        ]
        self.alike = [(one, other) for one, other in pairs if state[one].sort() == state[other].sort()]
        self.ordered = [
            pair
            for one, other in pairs
            if z3.is_int(state[one]) and z3.is_int(state[other])
            for pair in ((one, other), (other, one))
        ]
        self.stops = sorted(compared_with(system_terms(self.system)))
        self.then = {name: named(term, "then") for name, term in state.items()}

    def find(self, until: float) -> None:
        """Raises TimeoutError."""
        system, waiting = self.system, dict[Place, None]()
        first = self._solver(system.first)
        self._leaving(None, first, system.state, waiting, until)
        scan = [self.then[name] == term for name, term in system.after.items()]
        solver = self._solver(system.within, system.assumed, system.inside, *scan)
        while waiting:
            place = next(iter(waiting))
            del waiting[place]
            self.tell(f"{len(self.known)} places, {len(waiting)} to be asked again")
            solver.push()
            solver.add(self._here(place, system.state), *self.known[place].facts(system.state))
            self._leaving(place, solver, self.then, waiting, until)
            solver.pop()

    def lemmas(self) -> list[z3.BoolRef]:
        """What was found."""
        state = self.system.state
        found = [z3.Or([self._here(place, state) for place in self.known])]
        for place, known in self.known.items():
            if facts := list(known.facts(state)):
                found.append(z3.Implies(self._here(place, state), z3.And(facts)))
        return found

    def _solver(self, *facts: z3.BoolRef) -> z3.Solver:
        found = z3.Solver()
        found.set(**limits(LIMIT_MS))
        found.add(*facts)
        return found

    def _here(self, place: Place, terms: Terms) -> z3.BoolRef:
        pairs = zip(self.places, place, strict=True)
        return z3.And([terms[name] == like(terms[name], value) for name, value in pairs])

    def _leaving(
        self,
        start: Place | None,
        solver: z3.Solver,
        terms: Terms,
        waiting: dict[Place, None],
        until: float,
    ) -> None:
        """Join all that a solver finds beside what is known of where a scan ends. start: where it begins;
        None: before power-up.
        """
        ends = {} if start is None else self.after.setdefault(start, {})
        solver.push()
        solver.add([z3.Not(self._here(place, terms)) for place in ends])
        while (values := self._answer(solver, terms, until)) is not None:
            place = tuple(values[name] for name in self.places)
            ends[place] = None
            solver.add(z3.Not(self._here(place, terms)))
            if place not in self.known:
                self.known[place] = self._first(values)
                waiting[place] = None
        solver.pop()
        for place in ends:
            solver.push()
            solver.add(self._here(place, terms))
            while True:
                known = self.known[place]
                solver.add(z3.Not(z3.And([z3.BoolVal(True), *known.facts(terms)])))
                values = self._answer(solver, terms, until)
                if values is None:
                    break
                known.join(values, place == start, self.stops)
                waiting[place] = None
            solver.pop()

    def _first(self, values: Mapping[str, Any]) -> Known:
        low: dict[str, Any] = {}
        high: dict[str, Any] = {}
        for name in self.rest:
            low[name] = high[name] = values[name]
            if name in self.steady:
                boolean = z3.is_bool(self.system.state[name])
                low[name], high[name] = (False, True) if boolean else (None, None)
        return Known(
            low,
            high,
            [pair for pair in self.alike if values[pair[0]] == values[pair[1]]],
            [pair for pair in self.ordered if values[pair[0]] <= values[pair[1]]],
        )

    def _answer(self, solver: z3.Solver, terms: Terms, until: float) -> dict[str, Any] | None:
        """Values that a solver finds; None: there are none. Raises TimeoutError."""
        if time.process_time() > until:
            raise TimeoutError("the time for an invariant is over")
        self.queries += 1
        answer = solver.check()
        if answer == z3.unknown:
            raise TimeoutError(f"a question had no answer: {solver.reason_unknown()}")
        if answer == z3.unsat:
            return None
        model = solver.model()
        return {name: plain(model.eval(term, model_completion=True)) for name, term in terms.items()}


def system_terms(system: System) -> list[Any]:
    """What a scan makes of memory, and what is assumed."""
    return [*system.after.values(), system.assumed, system.within]
