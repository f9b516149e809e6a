"""A program beside a reference: equal outputs in every scan from power-up, or what could not be shown.

Both run on the same inputs. Pairs of control states are found from power-up on; for each pair the relations
between the two memories that hold in all scans seen are kept (equal values, constants, sums that are a
parameter, tables from a number to a value), and what a solver shows not to survive a scan is dropped until
the rest is inductive (Houdini). Then the outputs of every pair must be equal, and the program must stay
within its types.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import z3

from programs.bind import Binding
from programs.relations import Relation, Values, candidates, like, plain
from programs.symbolic import Obligation, Translator
from programs.terms import Slot, constant, in_range, live, slots, symbol

MOST_PAIRS = 2_000
LIMIT_MS = 30_000
"""For one question."""
OUTPUTS = "outputs are equal"


Pair = tuple[str, tuple[int, ...]]
"""A control state of the reference, and the values of the program's control variables."""


@dataclass
class Node:
    """A pair: what is known of it."""

    relations: list[Relation]
    successors: set[Pair] = field(default_factory=set)


@dataclass(frozen=True)
class Owed:
    """What must hold in every scan from a pair, over the values before it and the inputs."""

    pair: Pair
    what: str
    formula: z3.BoolRef
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
    def every_slot(self) -> dict[str, Slot]:
        """The program's memory without what is bound to inputs and parameters."""
        bound = self.binding.bound_paths
        return {
            slot.path: slot
            for slot in slots(self.binding.source, self.binding.unit)
            if slot.path not in bound
        }

    @cached_property
    def slots(self) -> dict[str, Slot]:
        """The memory on which outputs or obligations can come to depend, in this scan or a later one."""
        scan = self.translated
        every = {path: (f"p.{path}", scan.after[path]) for path in self.every_slot}
        kept = live([*scan.outputs.values(), *(owed.formula for owed in scan.obligations)], every)
        return {path: slot for path, slot in self.every_slot.items() if path in kept}

    @cached_property
    def memory(self) -> dict[str, Any]:
        """A symbol for each slot."""
        return {path: symbol(slot.type, f"p.{path}") for path, slot in self.slots.items()}

    @cached_property
    def translated(self) -> Any:
        """One scan of the program over the symbols of both sides."""
        reference = self.binding.reference
        given = {path: self.binding.term(path) for path in self.binding.bound_paths}
        every = {path: symbol(slot.type, f"p.{path}") for path, slot in self.every_slot.items()}
        translator = Translator(self.binding.source, self.binding.unit, self.wrap)
        return translator.scan({**every, **given}, reference.input_terms["dt_ms"])

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
        """A solver that knows the premises of a pair."""
        found = z3.Solver()
        found.set("timeout", LIMIT_MS)
        found.add(self.premises(pair))
        return found

    def fixpoint(
        self, samples: Mapping[Pair, Sequence[Values]], until: float, tell: Callable[[str], None] = print
    ) -> None:
        """Find all pairs and their inductive relations.

        Raises TimeoutError: no answer, too many pairs, or the clock (`time.monotonic`) is past `until`.
        """
        pair, values = self.start
        first = z3.Solver()
        first.set("timeout", LIMIT_MS)
        first.add(self.assumed)
        self.nodes = {}
        self._weaken(first, pair, self._at_start(values), samples)
        waiting = deque([pair])
        while waiting:
            here = waiting.popleft()
            tell(f"{len(self.nodes)} pairs, {self.queries} questions")
            for changed in self._scan_from(here, samples):
                if changed not in waiting:
                    waiting.append(changed)
            if len(self.nodes) > MOST_PAIRS:
                raise TimeoutError(f"more than {MOST_PAIRS:,} pairs of states")
            if time.monotonic() > until:
                raise TimeoutError(f"the time is over at pair {shown(here)}")

    def _scan_from(self, pair: Pair, samples: Mapping[Pair, Sequence[Values]]) -> Iterator[Pair]:
        """Follow all scans from a pair; yields each pair that is new or became weaker."""
        after = self.terms_after(pair)
        solver = self.solver(pair)
        where = [after["control"], *(after[f"control {path}"] for path in self.control)]
        known: set[Pair] = set()
        while True:
            solver.push()
            for other in known:
                solver.add(z3.Not(self.at(where, other)))
            answer = self.ask(solver)
            if answer == z3.unsat:
                solver.pop()
                break
            model = solver.model()
            numbers = [plain(model.eval(term, model_completion=True)) for term in where]
            solver.pop()
            target: Pair = (self.binding.reference.controls[numbers[0]], tuple(numbers[1:]))
            known.add(target)
        self.nodes[pair].successors = known
        for target in sorted(known):
            solver.push()
            solver.add(self.at(where, target))
            if self._weaken(solver, target, after.__getitem__, samples):
                yield target
            solver.pop()

    def at(self, where: Sequence[Any], pair: Pair) -> z3.BoolRef:
        numbers = (self.binding.reference.controls.index(pair[0]), *pair[1])
        return z3.And([_equal(term, number) for term, number in zip(where, numbers, strict=True)])

    def ask(self, solver: z3.Solver) -> z3.CheckSatResult:
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
            if self.ask(solver) == z3.unsat:
                raise TimeoutError("the ranges cannot hold together")
            model = solver.model()
            seen = [self._values(model, term), *samples.get(target, ())]
            self.nodes[target] = Node(candidates(seen, self.symbols))
        node = self.nodes[target]
        changed = new
        while node.relations:
            solver.push()
            solver.add(z3.Not(z3.And([relation.formula(term) for relation in node.relations])))
            answer = self.ask(solver)
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
        return {name: plain(model.eval(term(name), model_completion=True)) for name in self.symbols}

    # ------------------------------------------------------------ the verdict

    def premises(self, pair: Pair) -> z3.BoolRef:
        """What is known before a scan from this pair: ranges, parameters, and the relations found."""
        relations = [relation.formula(self.symbols.__getitem__) for relation in self.nodes[pair].relations]
        ranges = self.binding.reference.steps[pair[0]].premise
        return z3.And(ranges, self.assumed, self.within(self.symbols.__getitem__), *relations)

    def within(self, term: Callable[[str], Any]) -> z3.BoolRef:
        """The memory of the program is within its types, and that of the reference within its ranges."""
        parts = []
        for path, slot in self.slots.items():
            if path in self.control:
                continue
            if path.endswith(".age"):
                parts.append(term(f"p:{path}") >= 0)
            else:
                parts.append(in_range(slot.type, term(f"p:{path}")))
        reference = self.binding.reference
        where = [(symbol, term(f"r:{place}")) for place, symbol in reference.memory_terms.items()]
        return z3.And(*parts, z3.substitute(reference.memory_ranges, *where))

    def reaches(self, target: Pair, where: Sequence[Any], term: Callable[[str], Any]) -> z3.BoolRef:
        """The values are those of this pair, and its relations hold."""
        relations = [relation.formula(term) for relation in self.nodes[target].relations]
        return z3.And(self.at(where, target), *relations)

    def owed_at_start(self) -> Owed:
        """What must hold at power-up."""
        pair, values = self.start
        retained = [
            in_range(slot.type, self.memory[path])
            for path, slot in self.slots.items()
            if slot.initial is None
        ]
        known = z3.And(self.assumed, *retained)
        relations = [relation.formula(self._at_start(values)) for relation in self.nodes[pair].relations]
        there = z3.And(self.within(self._at_start(values)), *relations)
        return Owed(pair, "the relations hold at power-up", z3.Implies(known, there))

    def _at_start(self, values: Mapping[str, Any]) -> Callable[[str], Any]:
        return lambda name: values.get(name, self.symbols.get(name))

    def owed(self, pair: Pair) -> Iterator[Owed]:
        """All that must hold in every scan from this pair, so that outputs are equal for ever."""
        yield Owed(pair, OUTPUTS, z3.Not(self.differ(pair)))
        for part in self._substituted(pair[1])["obligations"]:
            if not z3.is_true(part.formula):
                yield Owed(pair, part.text, part.formula, f"{part.place.file}:{part.place.line}")
        after = self.terms_after(pair)
        where = [after["control"], *(after[f"control {path}"] for path in self.control)]
        yield Owed(pair, "memory stays within its ranges", self.within(after.__getitem__))
        known = [target for target in sorted(self.nodes[pair].successors) if target in self.nodes]
        goes_on = [self.reaches(target, where, after.__getitem__) for target in known]
        yield Owed(pair, "the next pair is known and its relations hold", z3.Or(goes_on))

    def doubts(self) -> Iterator[Owed]:
        """What does not follow: none means PROVED. It rests on the pairs and relations alone, not on how
        they were found. Raises TimeoutError: a question had no answer, or a pair has no values.
        """
        start = self.owed_at_start()
        solver = z3.Solver()
        solver.set("timeout", LIMIT_MS)
        solver.add(z3.Not(start.formula))
        if self.ask(solver) == z3.sat:
            yield start
        for pair in list(self.nodes):
            solver = self.solver(pair)
            if self.ask(solver) == z3.unsat:
                raise TimeoutError(f"pair {shown(pair)}: no values fulfil its relations")
            for one in self.owed(pair):
                solver.push()
                solver.add(z3.Not(one.formula))
                if self.ask(solver) == z3.sat:
                    yield one
                solver.pop()


def shown(pair: Pair) -> str:
    """A pair in one word or two."""
    return f"{pair[0]} / {' '.join(map(str, pair[1])) or '-'}"


def _equal(term: Any, number: int) -> z3.BoolRef:
    return term == like(term, number)


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
