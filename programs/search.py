"""The fewest scans from power-up to a state, looked for along the pairs."""

from __future__ import annotations

import time
from collections import defaultdict, deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import z3

from programs.product import LIMIT_MS, Owed, Pair, Product
from programs.relations import plain

Numbers = Mapping[str, Any]
"""Plain values of a solver."""


@dataclass(frozen=True)
class Way:
    """Scans from power-up: the inputs of each (with `dt_ms`), the parameters, the first RETAIN values."""

    scans: tuple[Numbers, ...]
    parameters: Numbers
    retained: Numbers


def shortest(product: Product, doubts: Sequence[Owed], longest: int, seconds: float) -> Way | None:
    """The fewest scans from power-up of which the last does not do what is owed; None: not found.

    longest: most scans that are tried. seconds: of CPU. Raises TimeoutError: a question had no answer.
    """
    until = time.process_time() + seconds
    distances = {doubt.pair: _distances(product, doubt.pair) for doubt in doubts}
    for length in range(longest):
        for doubt in doubts:
            walk = _Walk(product, distances[doubt.pair], z3.Not(doubt.formula), until)
            found = walk.of(length)
            if found is not None:
                return found
            if time.process_time() > until:
                return None
    return None


def way_to(product: Product, pair: Pair, longest: int, seconds: float) -> Way | None:
    """The fewest scans from power-up to a pair; None: not found. Raises TimeoutError."""
    until = time.process_time() + seconds
    distance = _distances(product, pair)
    start, _ = product.start
    for length in range(distance.get(start, longest), longest):
        found = _Walk(product, distance, None, until).of(length)
        if found is not None:
            return found
        if time.process_time() > until:
            return None
    return None


def _distances(product: Product, target: Pair) -> dict[Pair, int]:
    before = defaultdict(set)
    for pair, node in product.nodes.items():
        for successor in node.successors:
            before[successor].add(pair)
    found = {target: 0}
    waiting = deque([target])
    while waiting:
        here = waiting.popleft()
        for pair in before[here]:
            if pair not in found:
                found[pair] = found[here] + 1
                waiting.append(pair)
    return found


@dataclass
class _Walk:
    """All ways of one length. goal: what the inputs of one more scan must fulfil; None: no more scan."""

    product: Product
    distance: Mapping[Pair, int]
    goal: z3.BoolRef | None
    until: float

    def of(self, length: int) -> Way | None:
        start, _ = self.product.start
        if self.distance.get(start, length + 1) > length:
            return None
        self.solver = z3.SimpleSolver()
        self.solver.set("timeout", LIMIT_MS)
        self.solver.add(self.product.assumed, self.product.retained)
        first = {name: self.product.at_start(name) for name in self.product.symbols}
        return self._go(start, first, length, [])

    def _go(self, pair: Pair, now: Numbers, left: int, read: list[dict[str, Any]]) -> Way | None:
        if time.process_time() > self.until:
            return None
        if left == 0 and self.goal is None:
            return self._found(read)
        product, solver, inputs = self.product, self.solver, self.product.binding.reference.input_terms
        given = {name: z3.Const(f"{name}@{len(read)}", term.sort()) for name, term in inputs.items()}
        where = [
            *((term, now[name]) for name, term in product.symbols.items() if not name.startswith("g:")),
            *((term, given[name]) for name, term in inputs.items()),
        ]

        def put(terms: Iterable[Any]) -> list[Any]:
            return [z3.substitute(term, *where) for term in terms]

        both = product.both(pair)
        solver.push()
        solver.add(*put([both.premise]))
        found = None
        if left == 0:
            solver.add(*put([self.goal]))
            found = self._found([*read, given])
        else:
            after = dict(zip(both.after, put(both.after.values()), strict=True))
            control = put(both.where)
            for target in sorted(product.nodes[pair].successors):
                if self.distance.get(target, left) > left - 1:
                    continue
                solver.push()
                solver.add(product.at(control, target))
                if product.ask(solver) is not None:
                    then = {
                        name: z3.Const(f"{name}@{len(read) + 1}", term.sort())
                        for name, term in product.symbols.items()
                        if not name.startswith("g:")
                    }
                    solver.add(*[then[name] == after[name] for name in then])
                    found = self._go(target, then, left - 1, [*read, given])
                solver.pop()
                if found is not None:
                    break
        solver.pop()
        return found

    def _found(self, read: Sequence[Mapping[str, Any]]) -> Way | None:
        model = self.product.ask(self.solver)
        if model is None:
            return None

        def numbers(terms: Mapping[str, Any]) -> Numbers:
            return {name: plain(model.eval(term, model_completion=True)) for name, term in terms.items()}

        kept = {
            path: self.product.memory[path]
            for path, slot in self.product.slots.items()
            if slot.initial is None
        }
        parameters = self.product.binding.reference.parameter_terms
        return Way(tuple(map(numbers, read)), numbers(parameters), numbers(kept))
