"""The fewest scans from power-up to a state, looked for along the pairs."""

from __future__ import annotations

import time
from collections import defaultdict, deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import z3

from programs.equality.product import LIMIT_MS, Owed, Pair, Product
from programs.invariants.relations import plain

Numbers = Mapping[str, Any]
"""Plain values of a solver."""
Route = tuple[Pair, ...]
"""Pairs from that of power-up on."""


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
            walk = _Walk(_Unrolled(product), distances[doubt.pair], z3.Not(doubt.formula), until)
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
        found = _Walk(_Unrolled(product), distance, None, until).of(length)
        if found is not None:
            return found
        if time.process_time() > until:
            return None
    return None


def through(
    product: Product, doubts: Sequence[Owed], known: Mapping[Pair, Route], longest: int, seconds: float
) -> Way | None:
    """Scans from power-up of which the last does not do what is owed, by way of each pair; None: not found.

    The way leads to one pair, then by as few pairs as possible to every other one; if that is not enough, by
    way of a second one. known: the pairs on a way to each pair that scans are known to take. longest,
    seconds, TimeoutError: see `shortest`. What is found is seldom the shortest, but it may be long: what a
    program does wrong may show long after it was done.
    """
    until = time.process_time() + seconds
    goals = {
        doubt.pair: z3.Not(z3.And([of.formula for of in doubts if of.pair == doubt.pair])) for doubt in doubts
    }
    line = _Unrolled(product)
    dead: set[Route] = set()
    for route in _routes(product, known, longest, until):
        while line.pairs != route[: len(line.pairs)]:
            line.back()
        for target in route[len(line.pairs) :]:
            if (*line.pairs, target) in dead or not line.go(target):
                dead.add((*line.pairs, target))
                break
        else:
            if route[-1] in goals and (found := line.way(goals[route[-1]])) is not None:
                return found
    return None


def _routes(product: Product, known: Mapping[Pair, Route], longest: int, until: float) -> Iterator[Route]:
    """Ways by one pair, then by two, each once and behind its beginnings; none after `until`."""
    start, _ = product.start
    paths = {pair: _paths(product, pair) for pair in product.nodes}
    heads = {pair: known.get(pair, path) for pair, path in paths[start].items()}
    told: set[Route] = set()
    for head in sorted(heads.values(), key=len, reverse=True):
        for tail in paths[head[-1]].values():
            if time.process_time() > until:
                return
            yield from _prefixes((*head, *tail[1:]), longest, told)
    for head in sorted(heads.values(), key=len, reverse=True):
        for middle in paths[head[-1]].values():
            for tail in paths[middle[-1]].values():
                if time.process_time() > until:
                    return
                yield from _prefixes((*head, *middle[1:], *tail[1:]), longest, told)


def _prefixes(route: Route, longest: int, told: set[Route]) -> Iterator[Route]:
    if route[:longest] not in told:
        for length in range(1, min(len(route), longest) + 1):
            if route[:length] not in told:
                told.add(route[:length])
                yield route[:length]


def _paths(product: Product, start: Pair) -> dict[Pair, Route]:
    """The fewest pairs from one to each other one."""
    found: dict[Pair, Route] = {start: (start,)}
    waiting = deque([start])
    while waiting:
        here = waiting.popleft()
        for pair in sorted(product.nodes[here].successors):
            if pair not in found:
                found[pair] = (*found[here], pair)
                waiting.append(pair)
    return found


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

    line: _Unrolled
    distance: Mapping[Pair, int]
    goal: z3.BoolRef | None
    until: float

    def of(self, left: int) -> Way | None:
        """A way of so many more scans."""
        line = self.line
        if self.distance.get(line.pairs[-1], left + 1) > left or time.process_time() > self.until:
            return None
        if left == 0:
            return line.way(self.goal)
        for target in sorted(line.product.nodes[line.pairs[-1]].successors):
            if self.distance.get(target, left) <= left - 1 and line.go(target):
                found = self.of(left - 1)
                if found is not None:
                    return found
                line.back()
        return None


class _Unrolled:
    """Scans from power-up along pairs, as terms in one solver."""

    def __init__(self, product: Product) -> None:
        self.product = product
        self.solver = z3.SimpleSolver()
        self.solver.set("timeout", LIMIT_MS)
        self.solver.add(product.assumed, product.retained)
        self.pairs: Route = (product.start[0],)
        self._now: list[Numbers] = [{name: product.at_start(name) for name in product.symbols}]
        self._read: list[dict[str, Any]] = []
        self._next: list[_Next] = []

    def go(self, target: Pair) -> bool:
        """One more scan, which leads to this pair; False: none does, and nothing has changed."""
        following, product = self._following(), self.product
        self.solver.push()
        self.solver.add(following.premise, product.at(following.where, target))
        if product.ask(self.solver) is None:
            self.solver.pop()
            return False
        then = {
            name: z3.Const(f"{name}@{len(self.pairs)}", term.sort())
            for name, term in product.symbols.items()
            if not name.startswith("g:")
        }
        self.solver.add(*[then[name] == following.after[name] for name in then])
        self.pairs = (*self.pairs, target)
        self._now.append(then)
        return True

    def back(self) -> None:
        """Without the last scan."""
        self.solver.pop()
        self.pairs = self.pairs[:-1]
        self._now.pop()
        del self._next[len(self.pairs) :], self._read[len(self.pairs) :]

    def way(self, goal: z3.BoolRef | None) -> Way | None:
        """These scans, and one more whose inputs fulfil the goal, with plain values; None: there is none."""
        self.solver.push()
        if goal is not None:
            following = self._following()
            self.solver.add(following.premise, self._put(goal))
        model = self.product.ask(self.solver)
        self.solver.pop()
        if model is None:
            return None

        def numbers(terms: Mapping[str, Any]) -> Numbers:
            return {name: plain(model.eval(term, model_completion=True)) for name, term in terms.items()}

        product, read = self.product, self._read[: len(self.pairs) - (goal is None)]
        kept = {path: product.memory[path] for path, slot in product.slots.items() if slot.initial is None}
        parameters = product.binding.reference.parameter_terms
        return Way(tuple(map(numbers, read)), numbers(parameters), numbers(kept))

    def _following(self) -> _Next:
        """The scan that comes next, over the values that this one leaves."""
        if len(self._next) < len(self.pairs):
            inputs = self.product.binding.reference.input_terms
            number = len(self._read)
            self._read.append(
                {name: z3.Const(f"{name}@{number}", term.sort()) for name, term in inputs.items()}
            )
            both = self.product.both(self.pairs[-1])
            self._next.append(
                _Next(
                    self._put(both.premise),
                    [self._put(term) for term in both.where],
                    {name: self._put(term) for name, term in both.after.items()},
                )
            )
        return self._next[-1]

    def _put(self, term: Any) -> Any:
        """A term over the values before a scan and its inputs, for the scan that comes next."""
        product, now, given = self.product, self._now[-1], self._read[-1]
        inputs = product.binding.reference.input_terms
        where = [
            *((symbol, now[name]) for name, symbol in product.symbols.items() if not name.startswith("g:")),
            *((symbol, given[name]) for name, symbol in inputs.items()),
        ]
        return z3.substitute(term, *where)


@dataclass(frozen=True)
class _Next:
    """One scan as terms: what it takes for granted, the control states after it, and the other values."""

    premise: z3.BoolRef
    where: Sequence[Any]
    after: Mapping[str, Any]
