"""What the demands are asked of: a program, or the reference implementation itself, on the same wires.

A subject gives one scan as terms, and can be run with plain values. Parameters that the program takes, and
inputs that are constant during a run, are memory that no scan changes and that has any value at power-up.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import z3

from modeproof.registers import Signal
from programs.demands.expressions import Items, Text
from programs.equality.product import Product
from programs.equality.replay import Run
from programs.invariants.induction import Way, conjuncts
from programs.invariants.relations import like
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Limit, Overflow
from programs.semantics.reference import Reference
from programs.semantics.terms import TRUE, in_range, names_in
from programs.semantics.value_paths import memory_of, put
from proofs.explorer.records import symbols


@dataclass(frozen=True)
class Step:
    """One plain scan: the wires, the memory by the names of its symbols, or why it stops."""

    dt_ms: int
    inputs: Mapping[str, Any]
    outputs: Mapping[str, Any]
    memory: Mapping[str, Any]
    stopped: str = ""


class Subject(Protocol):
    """A program or a reference in one scan. Names of memory are those of the symbols."""

    @property
    def reference(self) -> Reference:
        """The target whose wires it has."""

    @property
    def state(self) -> Mapping[str, Any]:
        """The symbols of memory."""

    @property
    def start(self) -> Mapping[str, Any]:
        """Each value at power-up; None: any."""

    @property
    def after(self) -> Mapping[str, Any]:
        """Each value after a scan."""

    @property
    def outputs(self) -> Mapping[str, Any]:
        """The outputs by their places, in the sorts of the reference."""

    @property
    def fits(self) -> Sequence[z3.BoolRef]:
        """The ranges of memory."""

    @property
    def inside(self) -> z3.BoolRef:
        """What keeps it within its types."""

    @property
    def fixed(self) -> Mapping[str, Any]:
        """The parameters that have one value, as the code has them."""

    @property
    def conditions(self) -> Sequence[z3.BoolRef]:
        """Further ranges of inputs and parameters."""

    @property
    def longest_scan(self) -> int | None:
        """The longest scan that it can take, in ms; None: any."""

    def allows(self, parameters: Mapping[str, Any]) -> bool:
        """Whether it takes these parameters."""

    def run(self, run: Run) -> Iterator[Step]:
        """The scans with plain values."""


@dataclass(frozen=True)
class Program:
    """A program that is bound to a target."""

    product: Product

    @property
    def reference(self) -> Reference:
        """The target."""
        return self.product.binding.reference

    @cached_property
    def state(self) -> Mapping[str, Any]:
        """As `Subject.state`."""
        return {f"p.{path}": term for path, term in self.product.memory.items()}

    @cached_property
    def start(self) -> Mapping[str, Any]:
        """As `Subject.start`."""
        slots = self.product.slots.items()
        return {
            f"p.{path}": None if slot.initial is None else like(self.state[f"p.{path}"], slot.initial)
            for path, slot in slots
        }

    @cached_property
    def after(self) -> Mapping[str, Any]:
        """As `Subject.after`."""
        return {f"p.{path}": self.product.translated.after[path] for path in self.product.slots}

    @cached_property
    def outputs(self) -> Mapping[str, Any]:
        """As `Subject.outputs`."""
        return self.product.binding.outputs(self.product.translated.outputs)

    @cached_property
    def fits(self) -> Sequence[z3.BoolRef]:
        """As `Subject.fits`."""
        found = []
        for path, slot in self.product.slots.items():
            term = self.state[f"p.{path}"]
            found.append(term >= 0 if path.endswith(".age") else in_range(slot.type, term))
        return [part for part in found if not z3.is_true(part)]

    @cached_property
    def inside(self) -> z3.BoolRef:
        """As `Subject.inside`."""
        owed = [z3.simplify(one.formula) for one in self.product.translated.obligations]
        return z3.And([TRUE, *(formula for formula in owed if not z3.is_true(formula))])

    @property
    def fixed(self) -> Mapping[str, Any]:
        """As `Subject.fixed`."""
        return self.product.binding.fixed_parameters()

    @property
    def conditions(self) -> Sequence[z3.BoolRef]:
        """As `Subject.conditions`; no page speaks of another value of a parameter that is ours."""
        binding = self.product.binding
        return (*binding.conditions, *binding.fixing(self._own))

    @cached_property
    def _own(self) -> dict[str, Any]:
        """The parameters that are ours, that no profile has another value of, and that the program takes."""
        binding = self.product.binding
        signals = binding.reference.signals("parameters")
        free = {name: signals[name] for name in binding.free_parameters}
        return {name: of.default for name, of in free.items() if of.project and of.cautious is None}

    @property
    def longest_scan(self) -> int | None:
        """As `Subject.longest_scan`."""
        return self.product.binding.longest_scan

    def allows(self, parameters: Mapping[str, Any]) -> bool:
        """As `Subject.allows`."""
        of = self.reference
        usual = all(parameters[name] == of.in_code(name, value) for name, value in self._own.items())
        return usual and self.product.binding.allows(parameters)

    def run(self, run: Run) -> Iterator[Step]:
        """As `Subject.run`."""
        binding = self.product.binding
        machine = Machine(binding.source, binding.unit, self.product.wrap)
        for path, value in run.retained.items():
            put(machine.memory, path, value)
        for dt_ms, inputs in run.scans:
            given = self.reference.to_wire("inputs", inputs)
            try:
                own = machine.scan(binding.plain_inputs(inputs, run.parameters, dt_ms), dt_ms)
            except Limit:
                raise
            except Overflow as error:
                yield Step(dt_ms, given, {}, {}, error.message)
                return
            sends = self.reference.to_wire("outputs", binding.plain_outputs(own))
            yield Step(
                dt_ms, given, sends, {f"p.{path}": value for path, value in memory_of(machine).items()}
            )


@dataclass(frozen=True)
class Wires:
    """The wires of a subject, as the demands name them."""

    subject: Subject
    constant: Sequence[str] = ()

    @cached_property
    def steady(self) -> dict[str, Any]:
        """The symbols of free parameters and of constant inputs, by the names of the symbols."""
        of = self.subject.reference
        signals = of.signals("parameters")
        free = [
            term
            for place, term in of.parameter_terms.items()
            if place.partition("[")[0] in signals and place.partition("[")[0] not in self.subject.fixed
        ]
        held = [term for place, term in of.input_terms.items() if place.partition("[")[0] in self.constant]
        return {str(term): term for term in (*free, *held)}

    @cached_property
    def inputs(self) -> dict[str, Any]:
        """The symbols that have a new value in each scan, `dt_ms` included."""
        terms = self.subject.reference.input_terms.values()
        return {str(term): term for term in terms if str(term) not in self.steady}

    @property
    def dt_ms(self) -> Any:
        """The symbol of the time since the scan before."""
        return self.subject.reference.input_terms["dt_ms"]

    @cached_property
    def known(self) -> list[tuple[Any, Any]]:
        """Each parameter that has one value, with it."""
        of, found = self.subject.reference, []
        for name, value in self.subject.fixed.items():
            signal = of.signals("parameters")[name]
            if signal.type == "modes":
                found += [
                    (of.parameter_terms[f"{name}[{n}]"], z3.BoolVal(one)) for n, one in enumerate(value)
                ]
            else:
                number = signal.values.index(value) if signal.type == "text" else value
                found.append((of.parameter_terms[name], like(of.parameter_terms[name], number)))
        return found

    def put(self, term: Any) -> Any:
        """A term with these values in it."""
        return z3.simplify(z3.substitute(term, *self.known)) if self.known else z3.simplify(term)

    @cached_property
    def ranges(self) -> tuple[list[z3.BoolRef], list[z3.BoolRef]]:
        """The ranges of what is steady, and those of the rest."""
        of, device = self.subject.reference, self.subject.reference.device
        parts = [symbol.premise for record in (of.parameters, device.inputs()) for symbol in symbols(record)]
        parts += [device.parameters_fit(of.parameters), *self.subject.conditions]
        parts = [part for whole in parts for part in conjuncts(self.put(whole)) if not z3.is_true(part)]
        held = [part for part in parts if names_in([part]) <= {*self.steady}]
        return held, [part for part in parts if not names_in([part]) <= {*self.steady}]

    def values(self, group: str, terms: Mapping[str, Any]) -> dict[str, Any]:
        """The signals of a group by the names of the demands, as values of expressions."""
        signals = self.subject.reference.signals(group)
        return {
            signal.name: as_value(signal, name, terms)
            for name, signal in signals.items()
            if signal.type != "function" and (name in terms or f"{name}[0]" in terms)
        }

    @cached_property
    def terms(self) -> dict[str, Any]:
        """The inputs and outputs."""
        outputs = {place: self.put(term) for place, term in self.subject.outputs.items()}
        return {
            **self.values("inputs", self.subject.reference.input_terms),
            **self.values("outputs", outputs),
        }

    @cached_property
    def parameters(self) -> dict[str, Any]:
        """The parameters."""
        terms = {place: self.put(term) for place, term in self.subject.reference.parameter_terms.items()}
        return self.values("parameters", terms)

    def run_of(self, way: Way) -> Run:
        """Scans that a solver found, as values of the code."""
        of = self.subject.reference
        start = {**{str(term): value for term, value in self.known}, **way.start}

        def named(terms: Mapping[str, Any], *tables: Mapping[str, Any]) -> dict[str, Any]:
            found = {}
            for place, term in terms.items():
                values = [table[str(term)] for table in tables if str(term) in table]
                found[place] = values[0] if values else 0 if not z3.is_bool(term) else False
            return found

        parameters = of.plain("parameters", named(of.parameter_terms, way.start)) | dict(self.subject.fixed)
        scans = []
        for read in way.scans:
            values = named(of.input_terms, read, way.start)
            scans.append((int(values["dt_ms"]), of.plain("inputs", values)))
        kept = {
            name.removeprefix("p."): start[name]
            for name, value in self.subject.start.items()
            if value is None and name in way.start
        }
        return Run(parameters, scans, kept)


def as_value(signal: Signal, name: str, terms: Mapping[str, Any]) -> Any:
    """A signal as a value of expressions."""
    if signal.type == "modes":
        return Items(tuple((terms[f"{name}[{mode}]"], mode) for mode in range(5)))
    return Text(terms[name], tuple(signal.values)) if signal.type == "text" else terms[name]


def plain_value(signal: Signal, value: Any) -> Any:
    """A wire value as a value of expressions."""
    match signal.type:
        case "word":
            return int(value, 16)
        case "mode":
            return -1 if value is None else value
        case "modes":
            return Items(tuple((mode in value, mode) for mode in range(5)))
        case "text":
            text = value or ""
            return Text(signal.values.index(text) if text in signal.values else -1, tuple(signal.values))
    return value
