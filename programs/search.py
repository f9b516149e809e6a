"""The scans after which a program differs, looked for along the pairs from power-up."""

from __future__ import annotations

import time
from collections import defaultdict, deque
from collections.abc import Mapping
from typing import Any

import z3

from programs.product import LIMIT_MS, Owed, Pair, Product
from programs.relations import plain


def way_to(product: Product, doubt: Owed, longest: int, seconds: float) -> list[dict[str, Any]] | None:
    """The fewest scans from power-up to the doubt: inputs of each, parameters in the first.

    None: not found. Raises TimeoutError: a question had no answer.
    """
    distance = _distances(product, doubt.pair)
    start, values = product.start
    if start not in distance:
        return None
    until = time.monotonic() + seconds
    for length in range(distance[start], longest):
        found = _walk(product, doubt, start, values, length, distance, until)
        if found is not None:
            return found
        if time.monotonic() > until:
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


def _walk(
    product: Product,
    doubt: Owed,
    start: Pair,
    values: Mapping[str, Any],
    length: int,
    distance: Mapping[Pair, int],
    until: float,
) -> list[dict[str, Any]] | None:
    solver = z3.Solver()
    solver.set("timeout", LIMIT_MS)
    solver.add(product.assumed)
    inputs = product.binding.reference.input_terms
    symbols = {**product.symbols}

    def fresh(number: int) -> dict[str, Any]:
        return {name: z3.Const(f"{name}@{number}", term.sort()) for name, term in inputs.items()}

    def go(pair: Pair, now: Mapping[str, Any], left: int, read: list[dict[str, Any]]) -> Any:
        if time.monotonic() > until:
            return None
        scan_inputs = fresh(len(read))
        where = [
            *((term, now[name]) for name, term in symbols.items() if not name.startswith("g:")),
            *((term, scan_inputs[name]) for name, term in inputs.items()),
        ]

        def put(term: Any) -> Any:
            return z3.substitute(term, *where)

        solver.push()
        solver.add(put(z3.And(product.binding.reference.steps[pair[0]].premise, product.assumed)))
        if left == 0:
            solver.add(put(z3.Not(doubt.formula)))
            found = [*read, scan_inputs] if product.ask(solver) == z3.sat else None
            result = None
            if found is not None:
                model = solver.model()
                result = [
                    {name: plain(model.eval(term, model_completion=True)) for name, term in scan.items()}
                    for scan in found
                ]
                result[0]["parameters"] = {
                    name: plain(model.eval(term, model_completion=True))
                    for name, term in product.binding.reference.parameter_terms.items()
                }
            solver.pop()
            return result
        after = product.terms_after(pair)
        where_after = [put(after["control"]), *(put(after[f"control {path}"]) for path in product.control)]
        for target in sorted(product.nodes[pair].successors):
            if distance.get(target, length + 1) > left - 1:
                continue
            solver.push()
            solver.add(product.at(where_after, target))
            if product.ask(solver) == z3.sat:
                then = {
                    name: z3.Const(f"{name}@{len(read) + 1}", symbols[name].sort())
                    for name in symbols
                    if not name.startswith("g:")
                }
                solver.add(*[then[name] == put(after[name]) for name in then])
                found = go(target, then, left - 1, [*read, scan_inputs])
                if found is not None:
                    solver.pop()
                    solver.pop()
                    return found
            solver.pop()
        solver.pop()
        return None

    return go(start, values, length, [])  # type: ignore[no-any-return]
