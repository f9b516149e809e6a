"""The pairs of control states that can be reached from power-up, with relations that every scan keeps.

Pairs are found from power-up on. What a solver shows to be possible in a pair is a new sample of it, and the
relations that no sample contradicts are kept, until every scan keeps them (Houdini). Then those are dropped
that nothing needs.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import z3

from programs.equality.product import Node, Owed, Pair, Product, shown
from programs.invariants.relations import Relation, Values, plain

MOST_PAIRS = 2_000
Samples = Mapping[Pair, Sequence[Values]]
Term = Callable[[str], Any]


@dataclass
class Search:
    """The search for pairs and relations. samples: values of pairs that were met in runs from power-up."""

    product: Product
    samples: Samples
    until: float
    """CPU seconds of the process (`time.process_time`) after which it gives up."""
    tell: Callable[[str], None] = print
    seen: dict[Pair, list[Values]] = field(default_factory=dict)

    def run(self) -> None:
        """Fill the nodes of the product.

        Raises TimeoutError: no answer, too many pairs, or the clock is past `until`.
        """
        product = self.product
        product.nodes = {}
        start, _ = product.start
        self._power_up()
        waiting = deque([start])
        while waiting:
            here = waiting.popleft()
            self.tell(f"{len(product.nodes)} pairs, {product.queries} questions")
            for changed in self._scan_from(here):
                if changed not in waiting:
                    waiting.append(changed)
            if not waiting:
                # A relation may be new where another one was dropped, and then not every way was asked.
                waiting += self._again()
            if len(product.nodes) > MOST_PAIRS:
                raise TimeoutError(f"more than {MOST_PAIRS:,} pairs of states")
            if time.process_time() > self.until:
                raise TimeoutError(f"the time is over at pair {shown(here)}")

    def _power_up(self) -> bool:
        """Drop what does not hold at power-up; whether anything changed."""
        product = self.product
        known = product.solver(product.assumed, product.retained)
        return self._weaken(known, product.start[0], product.at_start)

    def _again(self) -> set[Pair]:
        """The pairs that become weaker when every way into them is asked once more."""
        found = {self.product.start[0]} if self._power_up() else set()
        for pair in list(self.product.nodes):
            found |= set(self._scan_from(pair))
        return found

    def _scan_from(self, pair: Pair) -> Iterator[Pair]:
        """Follow all scans from a pair; yields each pair that is new or became weaker."""
        product = self.product
        both = product.both(pair)
        solver = product.solver(product.premises(pair))
        known: set[Pair] = set()
        solver.push()
        while (model := product.ask(solver)) is not None:
            numbers = [int(plain(model.eval(term, model_completion=True))) for term in both.where]
            target = product.binding.reference.controls[numbers[0]], tuple(numbers[1:])
            known.add(target)
            solver.add(z3.Not(product.at(both.where, target)))
        solver.pop()
        product.nodes[pair].successors = known
        for target in sorted(known):
            solver.push()
            solver.add(product.at(both.where, target))
            if self._weaken(solver, target, both.after.__getitem__):
                yield target
            solver.pop()

    def _weaken(self, solver: z3.Solver, target: Pair, term: Term) -> bool:
        """Drop what does not hold of `target` under the solver's premises; whether anything changed."""
        product, changed = self.product, target not in self.product.nodes
        if changed:
            model = product.ask(solver)
            if model is None:
                raise TimeoutError("the ranges cannot hold together")
            self.seen[target] = [self._values(model, term), *self.samples.get(target, ())]
            product.nodes[target] = Node(product.vocabulary.candidates(self.seen[target]))
        node = product.nodes[target]
        while node.relations:
            solver.push()
            solver.add(z3.Not(z3.And([relation.formula(term) for relation in node.relations])))
            model = product.ask(solver)
            if model is None:
                solver.pop()
                return changed
            self.seen[target].append(self._values(model, term))
            solver.pop()
            before = set(node.relations)
            node.relations, changed = product.vocabulary.candidates(self.seen[target]), True
            assert set(node.relations) != before
        return changed

    def _values(self, model: z3.ModelRef, term: Term) -> Values:
        return {name: plain(model.eval(term(name), model_completion=True)) for name in self.product.symbols}


# ---------------------------------------------------------------- what the proof needs


def prune(product: Product) -> None:
    """Keep only the relations that the proof needs, beginning with equal outputs and going backwards.

    Raises TimeoutError: a question had no answer, or something does not follow at all.
    """
    pruning = _Pruning(product)
    waiting = deque[tuple[Pair, Relation]]()
    for pair in product.nodes:
        waiting += pruning.needs(pair, list(product.owed(pair)))
    before: dict[Pair, list[Pair]] = {pair: [] for pair in product.nodes}
    for pair, node in product.nodes.items():
        for target in node.successors:
            before[target].append(pair)
    while waiting:
        target, relation = waiting.popleft()
        for pair in before[target]:
            waiting += pruning.keeps(pair, target, relation)
    for pair, node in product.nodes.items():
        node.relations = [relation for relation in node.relations if relation in pruning.needed[pair]]


class _Pruning:
    """One solver a pair, in which each relation can be switched on."""

    def __init__(self, product: Product) -> None:
        self.product = product
        self.solvers: dict[Pair, z3.Solver] = {}
        self.marks: dict[Pair, dict[str, Relation]] = {}
        self.needed: dict[Pair, set[Relation]] = {pair: set() for pair in product.nodes}
        for pair, node in product.nodes.items():
            solver = product.solver(product.both(pair).premise)
            self.marks[pair] = {f"relation {n}": relation for n, relation in enumerate(node.relations)}
            for name, relation in self.marks[pair].items():
                solver.add(z3.Implies(z3.Bool(name), relation.formula(product.symbols.__getitem__)))
            self.solvers[pair] = solver

    def needs(self, pair: Pair, owed: Sequence[Owed]) -> list[tuple[Pair, Relation]]:
        """The relations of a pair that are newly needed for what is owed there; relations after it aside."""
        product, both = self.product, self.product.both(pair)
        known = z3.Or([product.at(both.where, target) for target in product.nodes[pair].successors])
        formulas = [part.formula for part in owed[:-1]]
        return [found for formula in (*formulas, known) for found in self._core(pair, z3.Not(formula))]

    def keeps(self, pair: Pair, target: Pair, relation: Relation) -> list[tuple[Pair, Relation]]:
        """Those that are newly needed so that a relation of the target holds after a scan."""
        both = self.product.both(pair)
        after = relation.formula(both.after.__getitem__)
        return self._core(pair, self.product.at(both.where, target), z3.Not(after))

    def _core(self, pair: Pair, *asked: z3.BoolRef) -> list[tuple[Pair, Relation]]:
        solver, marks, needed = self.solvers[pair], self.marks[pair], self.needed[pair]
        solver.push()
        solver.add(*asked)
        fixed = [z3.Bool(name) for name, relation in marks.items() if relation in needed]
        others = [z3.Bool(name) for name, relation in marks.items() if relation not in needed]
        if self.product.ask(solver, *fixed) is None:
            found: list[Relation] = []
        else:
            if self.product.ask(solver, *fixed, *others) is not None:
                raise TimeoutError(f"pair {shown(pair)}: something does not follow from its relations")
            core = {str(mark) for mark in solver.unsat_core()}
            found = [marks[str(mark)] for mark in others if str(mark) in core]
        solver.pop()
        needed.update(found)
        return [(pair, relation) for relation in found]
