"""A program beside a reference, on the same inputs: one scan of both from each pair of control states.

A pair is a control state of the reference with the values of the program's control variables. What is known
of a pair is a list of relations between the two memories. `owed` says what must hold so that the outputs are
equal for ever; it rests on the pairs and relations alone, not on how they were found.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import z3

from programs.equality.binding import Binding
from programs.invariants.relations import Relation, Vocabulary, like
from programs.semantics.obligations import Obligation
from programs.semantics.terms import Slot, compared_with, constant, in_range, live, slots, symbol
from programs.semantics.translator import Scan, Translator

OUTPUTS = "outputs are equal"
RANGES = "memory stays within its ranges"
NEXT = "the next pair is known and its relations hold"
START = "the relations hold at power-up"
LIMIT_MS = 30_000
"""For one question."""

Pair = tuple[str, tuple[int, ...]]
"""A control state of the reference, and the values of the program's control variables."""


@dataclass
class Node:
    """A pair: what is known of it, and the pairs that one scan leads to."""

    relations: list[Relation]
    successors: set[Pair] = field(default_factory=set)


@dataclass(frozen=True)
class Owed:
    """What must hold in every scan from a pair, over the values before it and the inputs."""

    pair: Pair
    what: str
    formula: z3.BoolRef
    place: str = ""


@dataclass(frozen=True)
class Both:
    """One scan of both from a pair, as terms over the symbols before it.

    premise: what the scan takes for granted but the relations. where: the number of the control state of the
    reference and the control variables after the scan. after: every other value.
    """

    premise: z3.BoolRef
    where: tuple[Any, ...]
    after: Mapping[str, Any]
    outputs: Mapping[str, tuple[Any, Any]]
    """Of the reference and of the program."""
    obligations: tuple[Obligation, ...]


@dataclass
class Product:
    """The program and the reference, run together.

    split: paths of BOOL variables that count as control variables too.
    """

    binding: Binding
    wrap: bool = False
    split: tuple[str, ...] = ()
    queries: int = 0
    nodes: dict[Pair, Node] = field(default_factory=dict)
    _both: dict[tuple[Pair, bool], Both] = field(default_factory=dict)
    _own: dict[tuple[int, ...], Scan] = field(default_factory=dict)

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
    def translated(self) -> Scan:
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
        return (*found, *self.split)

    @cached_property
    def symbols(self) -> dict[str, Any]:
        """The symbol of every value that relations speak of, control variables left out."""
        reference = self.binding.reference
        return {
            **{f"r:{place}": term for place, term in reference.memory_terms.items()},
            **{f"p:{path}": term for path, term in self.memory.items() if path not in self.control},
            **self.parameters,
        }

    @cached_property
    def parameters(self) -> dict[str, Any]:
        """The terms of the parameters, also as the program's inputs have them."""
        terms = {**self.binding.reference.parameter_terms, **self.binding.words}
        return {f"g:{place}": term for place, term in terms.items()}

    @cached_property
    def vocabulary(self) -> Vocabulary:
        """What relations may speak of."""
        signals = self.binding.reference.device.register.memory.values()
        times = {f"r:{signal.python}" for signal in signals if signal.type == "ms"}
        sizes = {
            f"p:{path}": slot.type.high - slot.type.low + 1
            for path, slot in self.slots.items()
            if self.wrap and slot.type.kind in ("int", "time") and not path.endswith(".age")
        }
        sorts = {name: str(term.sort()) for name, term in self.symbols.items()}
        keys = {name for name in sorts if name.startswith("r:") and sorts[name] == "Int"} - times
        limits = compared_with([*self.translated.after.values(), *self.translated.outputs.values()])
        return Vocabulary(sorts, frozenset(keys), sizes, sorted(limits))

    @cached_property
    def assumed(self) -> z3.BoolRef:
        """The ranges of parameters, and what the binding says of them."""
        return z3.And(self.binding.reference.ranges, *self.binding.conditions)

    def both(self, pair: Pair, whole: bool = False) -> Both:
        """One scan from this pair.

        whole: the program as it was translated, its control variables fixed by the premise; else they are
        put in as constants and the terms simplified.
        """
        key = pair, whole
        if key not in self._both:
            reference = self.binding.reference
            step, scan = reference.steps[pair[0]], self.translated if whole else self._specialised(pair[1])
            fixed = [
                _equal(self.memory[path], number)
                for path, number in zip(self.control, pair[1], strict=True)
                if whole
            ]
            self._both[key] = Both(
                z3.And(step.premise, self.assumed, self.within(self.symbols.__getitem__), *fixed),
                (step.control_after, *(scan.after[path] for path in self.control)),
                {
                    **{f"r:{place}": term for place, term in step.after.items()},
                    **{f"p:{path}": scan.after[path] for path in self.memory if path not in self.control},
                    **self.parameters,
                },
                {
                    place: (step.outputs[place], term)
                    for place, term in self.binding.outputs(scan.outputs).items()
                },
                scan.obligations,
            )
        return self._both[key]

    def _specialised(self, control: tuple[int, ...]) -> Scan:
        """The program's scan with its control variables as constants."""
        if control not in self._own:
            where = [
                (self.memory[path], constant(self.slots[path].type, value))
                for path, value in zip(self.control, control, strict=True)
            ]

            def put(term: Any) -> Any:
                return z3.simplify(z3.substitute(term, *where)) if where else z3.simplify(term)

            scan = self.translated
            self._own[control] = Scan(
                {path: put(scan.after[path]) for path in self.memory},
                {name: put(term) for name, term in scan.outputs.items()},
                tuple(Obligation(put(owed.formula), owed.text, owed.place) for owed in scan.obligations),
            )
        return self._own[control]

    # ------------------------------------------------------------ power-up

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

    @cached_property
    def retained(self) -> z3.BoolRef:
        """The RETAIN variables are within their types at power-up; nothing else is known of them."""
        kept = [(slot, self.memory[path]) for path, slot in self.slots.items() if slot.initial is None]
        return z3.And(z3.BoolVal(True), *(in_range(slot.type, term) for slot, term in kept))

    def at_start(self, name: str) -> Any:
        """A value at power-up as a term."""
        return self.start[1].get(name, self.symbols.get(name))

    # ------------------------------------------------------------ what is owed

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

    def at(self, where: Sequence[Any], pair: Pair) -> z3.BoolRef:
        """These control terms have the values of the pair."""
        numbers = (self.binding.reference.controls.index(pair[0]), *pair[1])
        return z3.And([_equal(term, number) for term, number in zip(where, numbers, strict=True)])

    def premises(self, pair: Pair, whole: bool = False) -> z3.BoolRef:
        """What is known before a scan from this pair: ranges, parameters, and the relations found."""
        relations = [relation.formula(self.symbols.__getitem__) for relation in self.nodes[pair].relations]
        return z3.And(self.both(pair, whole).premise, *relations)

    def reaches(self, target: Pair, both: Both) -> z3.BoolRef:
        """After the scan the values are those of this pair, and its relations hold."""
        relations = [relation.formula(both.after.__getitem__) for relation in self.nodes[target].relations]
        return z3.And(self.at(both.where, target), *relations)

    def owed_at_start(self) -> Owed:
        """What must hold at power-up."""
        pair, _ = self.start
        known = z3.And(self.assumed, self.retained)
        relations = [relation.formula(self.at_start) for relation in self.nodes[pair].relations]
        return Owed(pair, START, z3.Implies(known, z3.And(self.within(self.at_start), *relations)))

    def owed(self, pair: Pair, whole: bool = False) -> Iterator[Owed]:
        """All that must hold in every scan from this pair, so that outputs are equal for ever."""
        both = self.both(pair, whole)
        equal = [own == term for own, term in both.outputs.values()]
        yield Owed(pair, OUTPUTS, z3.And(equal))
        for part in both.obligations:
            if whole or not z3.is_true(part.formula):
                yield Owed(pair, part.text, part.formula, f"{part.place.file}:{part.place.line}")
        yield Owed(pair, RANGES, self.within(both.after.__getitem__))
        known = [target for target in sorted(self.nodes[pair].successors) if target in self.nodes]
        goes_on = [self.reaches(target, both) for target in known]
        yield Owed(pair, NEXT, z3.Or(goes_on) if goes_on else z3.BoolVal(False))

    # ------------------------------------------------------------ questions

    def solver(self, *known: z3.BoolRef) -> z3.Solver:
        """A solver that knows this. The plain core: what the full solver would do before costs far more."""
        found = z3.SimpleSolver()
        found.set("timeout", LIMIT_MS)
        found.add(*known)
        return found

    def ask(self, solver: z3.Solver, *assumed: z3.BoolRef) -> z3.ModelRef | None:
        """A model of what the solver knows, or None: there is none. Raises TimeoutError: no answer."""
        self.queries += 1
        answer = solver.check(*assumed)
        if answer == z3.unknown:
            raise TimeoutError(f"a question had no answer: {solver.reason_unknown()}")
        return solver.model() if answer == z3.sat else None

    def doubts(self) -> Iterator[Owed]:
        """What does not follow: none means PROVED.

        Raises TimeoutError: a question had no answer, or a pair has no values.
        """
        start = self.owed_at_start()
        if self.ask(self.solver(z3.Not(start.formula))) is not None:
            yield start
        for pair in list(self.nodes):
            solver = self.solver(self.premises(pair))
            if self.ask(solver) is None:
                raise TimeoutError(f"pair {shown(pair)}: no values fulfil its relations")
            for owed in self.owed(pair):
                solver.push()
                solver.add(z3.Not(owed.formula))
                if self.ask(solver) is not None:
                    yield owed
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
