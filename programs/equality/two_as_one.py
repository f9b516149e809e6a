"""Two programs as one in the place of a program and its reference: the product that `product` searches.

The reference is what gives TRUE in every scan, and the outputs of the program say whether both give the same.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType, SimpleNamespace
from typing import Any, cast

import z3

from programs.equality.binding import Binding
from programs.equality.product import Product
from programs.equality.replay import Difference, Replayed, Run, steps
from programs.equality.two_programs import CLOCK, NEW, OLD, Pair
from programs.invariants.relations import Vocabulary
from programs.language.tree import Scalar, Source, Unit
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Overflow
from programs.semantics.reference import Step
from programs.semantics.terms import TRUE, Slot, in_range, slots, symbol
from programs.semantics.value_paths import put, whole
from programs.semantics.value_paths import steps as parts_of

STATE = "both"
"""The one state of a reference that remembers nothing."""
RUNS, LENGTH = 60, 40


@dataclass(frozen=True)
class Same:
    """What gives TRUE for every output, in the place of a reference. It remembers nothing."""

    pair: Pair
    controls = (STATE,)
    memory_terms: Mapping[str, Any] = field(default_factory=dict)
    memory_ranges = TRUE
    power_up = STATE, MappingProxyType[str, Any]({})
    document = ""

    @cached_property
    def device(self) -> Any:
        """No register."""
        return SimpleNamespace(name=self.pair.old.name, register=SimpleNamespace(memory={}))

    @cached_property
    def slots(self) -> dict[str, Slot]:
        """The inputs, without the time since the scan before."""
        every = slots(self.pair.source, self.pair.unit)
        return {
            slot.path: slot for slot in every if slot.given and not (slot.path == CLOCK and self.pair.clock)
        }

    def is_constant(self, path: str) -> bool:
        """Whether an input keeps its first value."""
        return parts_of(path)[0] in self.pair.constant

    def _terms(self, constant: bool) -> dict[str, Any]:
        return {
            path: symbol(slot.type, f"in.{path}")
            for path, slot in self.slots.items()
            if self.is_constant(path) == constant
        }

    @cached_property
    def input_terms(self) -> dict[str, Any]:
        """The symbol of each input, and `dt_ms`."""
        return {**self._terms(False), "dt_ms": z3.Int("dt_ms")}

    @cached_property
    def parameter_terms(self) -> dict[str, Any]:
        """The symbol of each input that keeps its first value."""
        return self._terms(True)

    @cached_property
    def ranges(self) -> z3.BoolRef:
        """What is true of these."""
        terms = self.parameter_terms.items()
        return z3.And(TRUE, *(in_range(self.slots[path].type, term) for path, term in terms))

    @cached_property
    def steps(self) -> Mapping[str, Step]:
        """Its one scan."""
        terms = self.input_terms
        dt_ms = terms["dt_ms"]
        parts = [in_range(slot.type, terms[path]) for path, slot in self.slots.items() if path in terms]
        if self.pair.clock is not None and isinstance(self.pair.clock.type, Scalar):
            parts.append(in_range(self.pair.clock.type, dt_ms))
        outputs = {name: TRUE for name, _, _ in self.pair.compared}
        return {STATE: Step(STATE, z3.And(dt_ms >= 0, *parts), {}, z3.IntVal(0), outputs)}

    def signals(self, group: str) -> Mapping[str, Any]:
        """The names of a group, each with its kind."""
        if group == "outputs":
            return {name: SimpleNamespace(type="bool") for name, _, _ in self.pair.compared}
        wanted = group == "parameters"
        return {
            path: SimpleNamespace(type=slot.type.kind)
            for path, slot in self.slots.items()
            if self.is_constant(path) == wanted
        }

    def plain(self, group: str, values: Mapping[str, Any]) -> dict[str, Any]:
        """Numbers of a solver."""
        return {path: values[path] for path in self.signals(group)}

    def with_defaults(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """What is not given is zero, or what of its type is next to it."""
        kinds = {path: self.slots[path].type for path in self.signals("parameters")}
        return {path: values.get(path, min(max(0, kind.low), kind.high)) for path, kind in kinds.items()}

    def start(self, parameters: Mapping[str, Any]) -> None:
        """It has no memory."""

    def scan(self, state: None, dt_ms: int, inputs: Mapping[str, Any]) -> tuple[None, dict[str, bool]]:
        """One scan."""
        return None, dict.fromkeys(self.signals("outputs"), True)

    def plain_memory(self, state: None) -> tuple[str, dict[str, Any]]:
        """Nothing."""
        return STATE, {}


@dataclass(frozen=True)
class Beside:
    """Both programs as one, in the place of a binding."""

    pair: Pair

    @cached_property
    def reference(self) -> Same:
        """What gives TRUE."""
        return Same(self.pair)

    @cached_property
    def unit(self) -> Unit:
        """Both programs."""
        return self.pair.unit

    @property
    def source(self) -> Source:
        """The units of both."""
        return self.pair.source

    @cached_property
    def bound_paths(self) -> tuple[str, ...]:
        """All inputs."""
        return tuple(slot.path for slot in slots(self.source, self.unit) if slot.given)

    def term(self, path: str) -> Any:
        """The symbol of an input."""
        of = self.reference
        return (
            of.input_terms["dt_ms"]
            if path == CLOCK and self.pair.clock
            else {**of.input_terms, **of.parameter_terms}[path]
        )

    words: Mapping[str, Any] = field(default_factory=dict)
    conditions: tuple[z3.BoolRef, ...] = ()

    @cached_property
    def compared(self) -> tuple[str, ...]:
        """The outputs that are compared, each single value."""
        return tuple(name for name, _, _ in self.pair.compared)

    @cached_property
    def steady(self) -> frozenset[str]:
        """The inputs that keep their first value."""
        return self.pair.constant

    def outputs(self, own: Mapping[str, Any]) -> dict[str, Any]:
        """Whether both give the same, for each output."""
        return {name: own[f"SAME_{number}"] for number, name in enumerate(self.compared)}

    def plain_outputs(self, own: Mapping[str, Any]) -> dict[str, Any]:
        """The same with plain values."""
        return self.outputs(own)

    def plain_inputs(
        self, inputs: Mapping[str, Any], parameters: Mapping[str, Any], dt_ms: int
    ) -> dict[str, Any]:
        """Values as the interpreter takes them."""
        clock = {CLOCK: dt_ms} if self.pair.clock is not None else {}
        return whole(self.unit, {**inputs, **parameters, **clock})

    def fixed_parameters(self) -> dict[str, Any]:
        """None."""
        return {}

    def allows(self, parameters: Mapping[str, Any]) -> bool:
        """Whether these are values of the inputs that keep their first value."""
        of = self.reference
        wanted = of.signals("parameters")
        kinds = {path: of.slots[path].type for path in wanted}
        return set(parameters) == set(wanted) and all(
            kind.low <= parameters[path] <= kind.high for path, kind in kinds.items()
        )

    @cached_property
    def longest_scan(self) -> int | None:
        """The longest time between scans that an input for it can hold, in ms."""
        kind = self.pair.clock.type if self.pair.clock is not None else None
        return kind.high if isinstance(kind, Scalar) else None


class ProductOfTwo(Product):
    """As `Product`, with tables from the numbers and words of both programs."""

    @cached_property
    def vocabulary(self) -> Vocabulary:
        """What relations may speak of."""
        keys = {
            f"p:{path}"
            for path, slot in self.slots.items()
            if slot.type.kind in ("int", "enum", "bits") and not path.endswith(".age")
        }
        return replace(super().vocabulary, keys=frozenset(keys & self.symbols.keys()))


def product_of(pair: Pair, wrap: bool, split: tuple[str, ...] = ()) -> Product:
    """Both programs as one, beside what gives TRUE. split: as of a product."""
    return ProductOfTwo(cast(Binding, Beside(pair)), wrap, split)


def random_runs(product: Product, seed: int = 1) -> Difference | Replayed:
    """Random scans of both from power-up: the first difference, else what was met."""
    values, replayed = random.Random(seed), Replayed()
    of = cast(Same, product.binding.reference)
    kept = [slot for slot in product.every_slot.values() if slot.initial is None]
    times = [ms for ms in (0, 1, 10, 20, 100, 500, 5_000) if ms <= (product.binding.longest_scan or ms)]
    for number in range(RUNS):
        parameters = {path: _value(values, of.slots[path]) for path in of.signals("parameters")}
        retained = {slot.path: _value(values, slot) for slot in kept}
        steady = values.choice((0.5, 0.8, 0.95))
        now: dict[str, Any] = {}
        scans = []
        for _ in range(LENGTH):
            for path in of.signals("inputs"):
                if path not in now or values.random() > steady:
                    now[path] = _value(values, of.slots[path])
            scans.append((values.choice(times), dict(now)))
        replayed.cases, replayed.scans = replayed.cases + 1, replayed.scans + len(scans)
        run = Run(parameters, scans, retained)
        for step in steps(product.binding, product.wrap, run, f"random run {number + 1}"):
            if isinstance(step, Difference):
                return step
            replayed.met.append(step)
    return replayed


def _value(values: random.Random, slot: Slot) -> Any:
    kind = slot.type
    if kind.kind == "bool":
        return values.random() < 0.5
    near = [value for value in (0, 1, 2, 10, 100, 1000) if kind.low <= value <= kind.high]
    return values.choice([*near, kind.low, kind.high, values.randint(kind.low, kind.high)])


def shown_scans(pair: Pair, wrap: bool, run: Run) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """After each scan the outputs of the new program and of the old one, until one of them stops."""
    of, machine = Beside(pair), Machine(pair.source, pair.unit, wrap)
    for path, value in run.retained.items():
        put(machine.memory, path, value)
    for dt_ms, inputs in run.scans:
        try:
            machine.scan(of.plain_inputs(inputs, run.parameters, dt_ms), dt_ms)
        except Overflow:
            return
        frames = machine.memory.values[NEW].values, machine.memory.values[OLD].values
        rows: tuple[dict[str, Any], dict[str, Any]] = ({}, {})
        for key, other in pair.outputs.items():
            for row, frame, own in zip(rows, frames, (key, other), strict=True):
                row[pair.new.variables[key].name] = frame[own]
        yield rows
