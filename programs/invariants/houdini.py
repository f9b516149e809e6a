"""Invariants of a transition system: single facts and clauses of two facts.

The candidates hold in all samples; a solver drops what does not survive a scan until the rest is inductive
(Houdini).
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import z3

from programs.invariants.induction import LIMIT_MS, System, limits, named
from programs.invariants.relations import like

MOST_FACTS = 260
MOST_CLAUSES = 12_000


@dataclass
class Houdini:
    """The inductive facts and clauses among those that hold in all samples."""

    system: System
    limits: Sequence[int] = ()
    """Numbers that times are compared with."""
    values: Mapping[str, Sequence[int]] = field(default_factory=dict)
    """All values of those that have few."""
    facts: list[z3.BoolRef] = field(default_factory=list)
    clauses: list[tuple[int, ...]] = field(default_factory=list)
    """Facts by their number, counted from 1; a negative number is that fact denied."""
    rounds: int = 0
    singly: bool = False
    """Ask about each clause alone: many small questions in the place of few large ones."""
    further: Callable[[z3.ModelRef], Iterable[Sequence[bool]]] | None = None
    """The facts in states that follow the one before the scan of an answer."""
    _made: dict[tuple[bool, tuple[int, ...]], z3.BoolRef] = field(default_factory=dict)

    def lemmas(self) -> list[z3.BoolRef]:
        """What was found."""
        return [self._formula(clause) for clause in self.clauses]

    def _formula(self, clause: tuple[int, ...]) -> z3.BoolRef:
        parts = [
            self.facts[abs(number) - 1] if number > 0 else z3.Not(self.facts[abs(number) - 1])
            for number in clause
        ]
        return parts[0] if clause[0] == clause[1] else z3.Or(parts)

    def find(self, samples: Sequence[Mapping[str, Any]], until: float) -> None:
        """Keep what is inductive. Raises TimeoutError: no answer, or the clock is past `until`."""
        tries = list(_facts(self.system.state, samples, self.limits, self.values))[:MOST_FACTS]
        self.facts = [formula for formula, _ in tries]
        self._made.clear()
        everywhere = (1 << len(samples)) - 1
        masks = [sum(1 << n for n, sample in enumerate(samples) if true(sample)) for _, true in tries]
        literals = [(n, mask) for n, mask in enumerate(masks, 1)]
        literals += [(-n, everywhere & ~mask) for n, mask in enumerate(masks, 1)]
        self.clauses = [(n, n) for n, mask in literals if mask == everywhere]
        useful = [(n, mask) for n, mask in literals if mask not in (0, everywhere)]
        pairs = (
            (left, right)
            for (left, mask), (right, other) in itertools.combinations(useful, 2)
            if mask | other == everywhere and abs(left) != abs(right)
        )
        self.clauses += itertools.islice(pairs, MOST_CLAUSES)
        self.thin(until)

    def thin(self, until: float) -> None:
        """Drop what does not hold at power-up or does not survive a scan. Raises TimeoutError like `find`."""
        self._drop_at_start()
        self._drop_after_a_scan(until)

    def _solver(self) -> z3.Solver:
        found = z3.Solver()
        found.set(**limits(LIMIT_MS))
        return found

    def _drop_at_start(self) -> None:
        solver = self._solver()
        solver.add(self.system.first)
        self._drop(solver, self.facts)

    def _drop_after_a_scan(self, until: float) -> None:
        system = self.system
        there = {path: named(term, "after") for path, term in system.state.items()}
        where = [(term, there[path]) for path, term in system.state.items()]
        base = self._solver()
        base.add(system.within, system.assumed, system.inside)
        base.add([there[path] == term for path, term in system.after.items()])
        then = [z3.substitute(fact, *where) for fact in self.facts]
        while self.clauses:
            if time.process_time() > until:
                raise TimeoutError("the time for invariants is over")
            base.push()
            base.add([self._formula(clause) for clause in self.clauses])
            changed = self._drop(base, then)
            base.pop()
            if not changed:
                return

    def _denied(self, facts: Sequence[z3.BoolRef], clause: tuple[int, ...]) -> z3.BoolRef:
        """That a clause is false; made once for the facts at hand and once for those after a scan."""
        key = facts is self.facts, clause
        if key not in self._made:
            parts = [z3.Not(facts[n - 1]) if n > 0 else facts[-n - 1] for n in dict.fromkeys(clause)]
            self._made[key] = parts[0] if len(parts) == 1 else z3.And(parts)
        return self._made[key]

    def _keep(self, value: Sequence[bool]) -> None:
        """The clauses that are true where the facts are so."""
        self.clauses = [
            clause
            for clause in self.clauses
            if any(value[n - 1] if n > 0 else not value[-n - 1] for n in clause)
        ]

    def _drop(self, solver: z3.Solver, facts: Sequence[z3.BoolRef]) -> bool:
        """Drop the clauses over `facts` that do not follow; whether there were any."""
        known = len(self.clauses)
        if self.singly:
            asked = list(self.clauses)
            while asked:
                if self._drop_some(solver, facts, [asked.pop()]):
                    left = set(self.clauses)
                    asked = [clause for clause in asked if clause in left]
        else:
            while self.clauses and self._drop_some(solver, facts, self.clauses):
                pass
        return len(self.clauses) < known

    def _drop_some(
        self, solver: z3.Solver, facts: Sequence[z3.BoolRef], asked: Sequence[tuple[int, ...]]
    ) -> bool:
        """Ask about clauses, and drop all that are false in the answer; whether there was one."""
        self.rounds += 1
        parts = [self._denied(facts, clause) for clause in asked]
        answer = solver.check(z3.Or(parts))
        if answer == z3.unknown:
            raise TimeoutError(f"a question had no answer: {solver.reason_unknown()}")
        if answer == z3.unsat:
            return False
        model = solver.model()
        self._keep([z3.is_true(model.eval(fact, model_completion=True)) for fact in facts])
        if self.further is not None and facts is not self.facts:
            for following in self.further(model):
                self._keep(following)
        return True


def _facts(
    state: Mapping[str, Any],
    samples: Sequence[Mapping[str, Any]],
    limits: Sequence[int],
    values: Mapping[str, Sequence[int]],
) -> Any:
    """Facts with a test for plain values, those about few values first."""
    numbers = []
    for path, term in state.items():
        if z3.is_bool(term):
            yield term, lambda sample, path=path: bool(sample[path])
            continue
        seen = set(values.get(path, ())) or {sample[path] for sample in samples}
        if len(seen) <= 24:
            for value in sorted(seen):
                yield (
                    term == like(term, value),
                    lambda sample, path=path, value=value: sample[path] == value,
                )
        elif z3.is_int(term):
            numbers.append(path)
    for path in numbers:
        for limit in limits:
            yield (
                state[path] >= limit,
                lambda sample, path=path, limit=limit: sample[path] >= limit,
            )
    for left, right in itertools.permutations(numbers, 2):
        yield (
            state[left] <= state[right],
            lambda sample, left=left, right=right: sample[left] <= sample[right],
        )
