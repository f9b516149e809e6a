"""A program beside a reference: equal outputs in every scan from power-up, or the scans after which they differ.

Both run on the same inputs. Pairs of control states are found from power-up on; for each pair the relations
between the two memories that hold in all scans seen are kept (equal values, constants, sums that are a
parameter, tables from a number to a value), and what a solver shows not to survive a scan is dropped until
the rest is inductive (Houdini). Then the outputs of every pair must be equal, and the program must stay
within its types. What fails is looked for along the pairs: a real difference is replayed on the plain
reference and on the interpreter before anybody is told; otherwise the answer is UNKNOWN.
"""

from __future__ import annotations

import itertools
import time
from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import z3

from programs.bind import Binding
from programs.symbolic import Obligation, Slot, Translator, constant, in_range, slots, symbol

Values = dict[str, Any]
"""Plain values: `r:` memory of the reference, `p:` memory of the program, `g:` parameters."""
MOST_PAIRS = 2_000
LIMIT_MS = 30_000
"""For one question."""


@dataclass(frozen=True)
class Relation:
    """One candidate: its kind, the two sides, and a constant, a sum or a table."""

    kind: str
    left: str
    right: str = ""
    value: Any = None

    def holds(self, values: Values) -> bool:
        """Whether it is true of plain values."""
        left = values[self.left]
        match self.kind:
            case "constant":
                return bool(left == self.value)
            case "equal":
                return bool(left == values[self.right])
            case "unequal":
                return bool(left != values[self.right])
            case "at most":
                return bool(left <= values[self.right])
            case "at least":
                return bool(left >= self.value)
            case "sum":
                return bool(left + values[self.right] == values[self.value])
            case "least":
                return bool(left == min(values[self.right], values[self.value]))
            case "table":
                return bool(dict(self.value).get(left, values[self.right]) == values[self.right])
        raise AssertionError(self.kind)

    def formula(self, term: Callable[[str], Any]) -> z3.BoolRef:
        """The same as a formula over terms."""
        left = term(self.left)
        match self.kind:
            case "constant":
                return left == _like(left, self.value)  # type: ignore[no-any-return]
            case "equal":
                return left == term(self.right)  # type: ignore[no-any-return]
            case "unequal":
                return left != term(self.right)  # type: ignore[no-any-return]
            case "at most":
                return left <= term(self.right)  # type: ignore[no-any-return]
            case "at least":
                return left >= self.value  # type: ignore[no-any-return]
            case "sum":
                return left + term(self.right) == term(self.value)  # type: ignore[no-any-return]
            case "least":
                age, limit = term(self.right), term(self.value)
                return left == z3.If(age <= limit, age, limit)  # type: ignore[no-any-return]
        right = term(self.right)
        return z3.And(
            [z3.Implies(left == _like(left, key), right == _like(right, value)) for key, value in self.value]
        )

    def __str__(self) -> str:
        match self.kind:
            case "constant":
                return f"{self.left} = {self.value}"
            case "equal":
                return f"{self.left} = {self.right}"
            case "unequal":
                return f"{self.left} <> {self.right}"
            case "at most":
                return f"{self.left} <= {self.right}"
            case "at least":
                return f"{self.left} >= {self.value}"
            case "sum":
                return f"{self.left} + {self.right} = {self.value}"
            case "least":
                return f"{self.left} = min({self.right}, {self.value})"
        return f"{self.right} by {self.left}: " + ", ".join(f"{key}: {value}" for key, value in self.value)


def _like(term: Any, value: Any) -> Any:
    """A plain value as a term of the sort of another one."""
    if z3.is_bool(term):
        return z3.BoolVal(bool(value))
    return z3.BitVecVal(int(value), term.size()) if z3.is_bv(term) else z3.IntVal(int(value))


def _plain(term: Any) -> Any:
    return z3.is_true(term) if z3.is_bool(term) else term.as_long()


Pair = tuple[str, tuple[int, ...]]
"""A control state of the reference, and the values of the program's control variables."""


@dataclass
class Node:
    """A pair: what is known of it."""

    relations: list[Relation]
    successors: set[Pair] = field(default_factory=set)


@dataclass(frozen=True)
class Doubt:
    """What could not be shown of a pair: unequal outputs, or a value out of its type."""

    pair: Pair
    what: str
    violation: Callable[[Product, Pair], z3.BoolRef]
    place: str = ""


@dataclass
class Product:
    """The program and the reference, run together."""

    binding: Binding
    wrap: bool = False
    queries: int = 0
    nodes: dict[Pair, Node] = field(default_factory=dict)

    # ------------------------------------------------------------ the two sides

    @cached_property
    def slots(self) -> dict[str, Slot]:
        """The program's memory without what is bound to inputs and parameters."""
        bound = self.binding.bound_paths
        return {
            slot.path: slot
            for slot in slots(self.binding.source, self.binding.unit)
            if slot.path not in bound
        }

    @cached_property
    def memory(self) -> dict[str, Any]:
        """A symbol for each slot."""
        return {path: symbol(slot.type, f"p.{path}") for path, slot in self.slots.items()}

    @cached_property
    def translated(self) -> Any:
        """One scan of the program over the symbols of both sides."""
        reference = self.binding.reference
        given = {path: self.binding.term(path) for path in self.binding.bound_paths}
        translator = Translator(self.binding.source, self.binding.unit, self.wrap)
        return translator.scan({**self.memory, **given}, reference.input_terms["dt_ms"])

    @cached_property
    def control(self) -> tuple[str, ...]:
        """The slots with few values, all of them written as constants: they split the pairs."""
        found = []
        for path, slot in self.slots.items():
            if slot.type.kind in ("int", "enum") and slot.section != "input" and slot.initial is not None:
                values = _constants(self.translated.after[path], self.memory[path])
                if values is not None and len(values) <= 64:
                    found.append(path)
        return tuple(found)

    @cached_property
    def symbols(self) -> dict[str, Any]:
        """The symbol of every value that relations speak of, control variables left out."""
        reference = self.binding.reference
        return {
            **{f"r:{place}": term for place, term in reference.memory_terms.items()},
            **{f"p:{path}": term for path, term in self.memory.items() if path not in self.control},
            **{f"g:{place}": term for place, term in reference.parameter_terms.items()},
        }

    @cached_property
    def assumed(self) -> z3.BoolRef:
        """The ranges of parameters, and what the binding says of them."""
        parts = [self.binding.reference.ranges, *self.binding.conditions]
        return z3.And(*parts)

    def terms_after(self, pair: Pair) -> dict[str, Any]:
        """Each value after a scan from this pair, over the symbols before it."""
        if pair not in self._after:
            step = self.binding.reference.steps[pair[0]]
            own = self._substituted(pair[1])
            self._after[pair] = {
                **{f"r:{place}": term for place, term in step.after.items()},
                **{f"p:{path}": own["after"][path] for path in self.memory if path not in self.control},
                **{f"g:{place}": term for place, term in self.binding.reference.parameter_terms.items()},
                "control": step.control_after,
                **{f"control {path}": own["after"][path] for path in self.control},
            }
        return self._after[pair]

    _after: dict[Pair, dict[str, Any]] = field(default_factory=dict)
    _own: dict[tuple[int, ...], dict[str, Any]] = field(default_factory=dict)

    def _substituted(self, control: tuple[int, ...]) -> dict[str, Any]:
        """The program's scan with its control variables as constants."""
        if control not in self._own:
            where = [
                (self.memory[path], constant(self.slots[path].type, value))
                for path, value in zip(self.control, control, strict=True)
            ]

            def put(term: Any) -> Any:
                return z3.simplify(z3.substitute(term, *where)) if where else z3.simplify(term)

            scan = self.translated
            self._own[control] = {
                "after": {path: put(scan.after[path]) for path in self.memory},
                "outputs": {name: put(term) for name, term in scan.outputs.items()},
                "obligations": [
                    Obligation(put(owed.formula), owed.text, owed.place) for owed in scan.obligations
                ],
            }
        return self._own[control]

    def differ(self, pair: Pair) -> z3.BoolRef:
        """Some output that is compared is not equal after a scan from this pair."""
        step, own = self.binding.reference.steps[pair[0]], self._substituted(pair[1])["outputs"]
        found = [
            step.outputs[place] != term
            for place, term in self.binding.outputs(own).items()
            if not z3.is_true(z3.simplify(step.outputs[place] == term))
        ]
        return z3.Or(found) if found else z3.BoolVal(False)

    # ------------------------------------------------------------ the fixpoint

    @cached_property
    def start(self) -> tuple[Pair, dict[str, Any]]:
        """The pair at power-up, and each value there as a term; what is RETAIN stays a symbol."""
        reference = self.binding.reference
        control, memory = reference.power_up
        values: dict[str, Any] = {f"r:{place}": memory[place] for place in reference.memory_terms}
        for path, slot in self.slots.items():
            term = self.memory[path] if slot.initial is None else constant(slot.type, slot.initial)
            values[f"p:{path}"] = term
        numbers = tuple(int(self.slots[path].initial or 0) for path in self.control)
        return (control, numbers), values

    def solver(self, pair: Pair) -> z3.Solver:
        """A solver that knows ranges and relations of the pair before a scan."""
        found = z3.Solver()
        found.set("timeout", LIMIT_MS)
        found.add(self.binding.reference.steps[pair[0]].premise, self.assumed)
        for path, slot in self.slots.items():
            if path not in self.control:
                ranged = in_range(slot.type, self.memory[path])
                if not z3.is_true(ranged) and not path.endswith(".age"):
                    found.add(ranged)
                elif path.endswith(".age"):
                    found.add(self.memory[path] >= 0)
        found.add(*[relation.formula(self.symbols.__getitem__) for relation in self.nodes[pair].relations])
        return found

    def fixpoint(self, samples: Mapping[Pair, Sequence[Values]], tell: Callable[[str], None] = lambda text: None) -> None:
        """Find all pairs and their inductive relations. Raises TimeoutError: no answer, or too many pairs."""
        pair, values = self.start
        first = z3.Solver()
        first.add(self.assumed)
        self.nodes = {}
        self._weaken(first, pair, lambda name: values.get(name, self.symbols.get(name)), samples)
        waiting = deque([pair])
        while waiting:
            here = waiting.popleft()
            tell(f"{len(self.nodes)} pairs, {self.queries} questions")
            for changed in self._scan_from(here, samples):
                if changed not in waiting:
                    waiting.append(changed)
            if len(self.nodes) > MOST_PAIRS:
                raise TimeoutError(f"more than {MOST_PAIRS:,} pairs of states")

    def _scan_from(self, pair: Pair, samples: Mapping[Pair, Sequence[Values]]) -> Iterator[Pair]:
        """Follow all scans from a pair; yields each pair that is new or became weaker."""
        after = self.terms_after(pair)
        solver = self.solver(pair)
        where = [after["control"], *(after[f"control {path}"] for path in self.control)]
        known: set[Pair] = set()
        while True:
            solver.push()
            for other in known:
                solver.add(z3.Not(self._is(where, other)))
            answer = self._ask(solver)
            if answer == z3.unsat:
                solver.pop()
                break
            model = solver.model()
            numbers = [_plain(model.eval(term, model_completion=True)) for term in where]
            solver.pop()
            target: Pair = (self.binding.reference.controls[numbers[0]], tuple(numbers[1:]))
            known.add(target)
        self.nodes[pair].successors = known
        for target in sorted(known):
            solver.push()
            solver.add(self._is(where, target))
            if self._weaken(solver, target, after.__getitem__, samples):
                yield target
            solver.pop()

    def _is(self, where: Sequence[Any], pair: Pair) -> z3.BoolRef:
        numbers = (self.binding.reference.controls.index(pair[0]), *pair[1])
        return z3.And([_equal(term, number) for term, number in zip(where, numbers, strict=True)])

    def _ask(self, solver: z3.Solver) -> z3.CheckSatResult:
        self.queries += 1
        answer = solver.check()
        if answer == z3.unknown:
            raise TimeoutError(f"a question had no answer: {solver.reason_unknown()}")
        return answer

    def _weaken(
        self,
        solver: z3.Solver,
        target: Pair,
        term: Callable[[str], Any],
        samples: Mapping[Pair, Sequence[Values]],
    ) -> bool:
        """Drop what does not hold of `target` under the solver's premises; whether anything changed."""
        new = target not in self.nodes
        if new:
            if self._ask(solver) == z3.unsat:
                raise TimeoutError("the ranges cannot hold together")
            model = solver.model()
            seen = [self._values(model, term), *samples.get(target, ())]
            self.nodes[target] = Node(candidates(seen, self.symbols))
        node = self.nodes[target]
        changed = new
        while node.relations:
            solver.push()
            solver.add(z3.Not(z3.And([relation.formula(term) for relation in node.relations])))
            answer = self._ask(solver)
            if answer == z3.unsat:
                solver.pop()
                return changed
            values = self._values(solver.model(), term)
            solver.pop()
            left = [relation for relation in node.relations if relation.holds(values)]
            assert len(left) < len(node.relations)
            node.relations, changed = left, True
        return changed

    def _values(self, model: z3.ModelRef, term: Callable[[str], Any]) -> Values:
        return {name: _plain(model.eval(term(name), model_completion=True)) for name in self.symbols}

    # ------------------------------------------------------------ the verdict

    def doubts(self) -> Iterator[Doubt]:
        """What does not follow from the relations: none means PROVED."""
        for pair in list(self.nodes):
            solver = self.solver(pair)
            solver.push()
            solver.add(self.differ(pair))
            if self._ask(solver) == z3.sat:
                yield Doubt(pair, "an output differs", Product.differ)
            solver.pop()
            for number, owed in enumerate(self._substituted(pair[1])["obligations"]):
                if z3.is_true(owed.formula):
                    continue
                solver.push()
                solver.add(z3.Not(owed.formula))
                if self._ask(solver) == z3.sat:
                    yield Doubt(
                        pair,
                        f"not shown: {owed.text}",
                        lambda product, at, number=number: z3.Not(
                            product._substituted(at[1])["obligations"][number].formula
                        ),
                        f"{owed.place.file}:{owed.place.line}",
                    )
                solver.pop()

    def way_to(self, doubt: Doubt, longest: int, seconds: float) -> list[dict[str, Any]] | None:
        """The fewest scans from power-up to the doubt: inputs of each, parameters in the first; None: not found."""
        distance = self._distances(doubt.pair)
        start, values = self.start
        if start not in distance:
            return None
        until = time.monotonic() + seconds
        for length in range(distance[start], longest):
            found = self._walk(doubt, start, values, length, distance, until)
            if found is not None:
                return found
            if time.monotonic() > until:
                return None
        return None

    def _distances(self, target: Pair) -> dict[Pair, int]:
        before = defaultdict(set)
        for pair, node in self.nodes.items():
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
        self,
        doubt: Doubt,
        start: Pair,
        values: Mapping[str, Any],
        length: int,
        distance: Mapping[Pair, int],
        until: float,
    ) -> list[dict[str, Any]] | None:
        solver = z3.Solver()
        solver.set("timeout", LIMIT_MS)
        solver.add(self.assumed)
        inputs = self.binding.reference.input_terms
        symbols = {**self.symbols}
        names = [*symbols, *(f"p:{path}" for path in self.control)]

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
            solver.add(put(self.binding.reference.steps[pair[0]].premise))
            if left == 0:
                solver.add(put(doubt.violation(self, pair)))
                found = [*read, scan_inputs] if self._ask(solver) == z3.sat else None
                result = None
                if found is not None:
                    model = solver.model()
                    result = [
                        {name: _plain(model.eval(term, model_completion=True)) for name, term in scan.items()}
                        for scan in found
                    ]
                    result[0]["parameters"] = {
                        name: _plain(model.eval(term, model_completion=True))
                        for name, term in self.binding.reference.parameter_terms.items()
                    }
                solver.pop()
                return result
            after = self.terms_after(pair)
            where_after = [put(after["control"]), *(put(after[f"control {path}"]) for path in self.control)]
            for target in sorted(self.nodes[pair].successors):
                if distance.get(target, length + 1) > left - 1:
                    continue
                solver.push()
                solver.add(self._is(where_after, target))
                if self._ask(solver) == z3.sat:
                    then = {name: z3.Const(f"{name}@{len(read) + 1}", symbols[name].sort()) for name in symbols if not name.startswith("g:")}
                    solver.add(*[then[name] == put(after[name]) for name in then])
                    found = go(target, then, left - 1, [*read, scan_inputs])
                    if found is not None:
                        solver.pop()
                        solver.pop()
                        return found
                solver.pop()
            solver.pop()
            return None

        del names
        return go(start, values, length, [])  # type: ignore[no-any-return]


def _equal(term: Any, number: int) -> z3.BoolRef:
    return term == _like(term, number)  # type: ignore[no-any-return]


def _constants(term: Any, own: Any) -> set[int] | None:
    """The values to which a term comes, if each leaf is a constant or the variable itself."""
    found: set[int] = set()
    seen = set()
    waiting = [term]
    while waiting:
        node = waiting.pop()
        if node.get_id() in seen:
            continue
        seen.add(node.get_id())
        if z3.is_int_value(node):
            found.add(node.as_long())
        elif z3.is_app_of(node, z3.Z3_OP_ITE):
            waiting += [node.arg(1), node.arg(2)]
        elif not node.eq(own):
            return None
    return found


def candidates(seen: Sequence[Values], symbols: Mapping[str, Any]) -> list[Relation]:
    """All relations of the known kinds that hold in every sample."""
    groups: dict[str, list[str]] = defaultdict(list)
    for name, term in symbols.items():
        groups[str(term.sort())].append(name)
    found: list[Relation] = []
    first = seen[0]
    for name in symbols:
        if name.startswith("g:"):
            continue
        relation = Relation("constant", name, value=first[name])
        if _all(relation, seen):
            found.append(relation)
    for sort, names in groups.items():
        free = list(names)
        numbers = sort == "Int"
        for left, right in itertools.combinations(free, 2):
            if left.startswith("g:") and right.startswith("g:"):
                continue
            tries = [Relation("equal", left, right)]
            if sort == "Bool":
                tries.append(Relation("unequal", left, right))
            if numbers:
                tries += [Relation("at most", left, right), Relation("at most", right, left)]
            found += [relation for relation in tries if _all(relation, seen)]
        if numbers:
            own = [name for name in free if not name.startswith("g:")]
            found += [Relation("at least", name, value=low) for name in own for low in (0, -1) if _all(Relation("at least", name, value=low), seen)][:200]
            ages = [name for name in own if name.endswith(".age")]
            limits = [name for name in names if name.startswith("g:") or name.endswith(".PT")]
            for left, age, limit in itertools.product(own, ages, limits):
                relation = Relation("least", left, age, limit)
                if left != age and _all(relation, seen):
                    found.append(relation)
            for left, right in itertools.combinations(own, 2):
                for total in names:
                    if total.startswith("g:"):
                        relation = Relation("sum", left, right, total)
                        if _all(relation, seen):
                            found.append(relation)
    keys = [name for name in groups.get("Int", ()) if name.startswith("r:")]
    for left in keys:
        if len({values[left] for values in seen}) > 40:
            continue
        for right in symbols:
            if right.startswith("p:"):
                table: dict[Any, Any] = {}
                if all(table.setdefault(values[left], values[right]) == values[right] for values in seen):
                    found.append(Relation("table", left, right, tuple(sorted(table.items()))))
    return found


def _all(relation: Relation, seen: Iterable[Values]) -> bool:
    return all(relation.holds(values) for values in seen)
