"""The reference implementation as what the demands are asked of, with some parameters fixed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import z3

from modeproof.registers.profiles import CAUTIOUS, value_in
from programs.demands.subject import Step
from programs.equality.replay import Run
from programs.invariants.induction import conjuncts
from programs.semantics.reference import Reference

CONTROL = "before.control"
"""The symbol of the number of the control state."""


@dataclass(frozen=True)
class Implementation:
    """A device of refimpl. fixed: the parameters that have one value, as the code has it; others have any."""

    reference: Reference
    fixed: Mapping[str, Any]

    @staticmethod
    def in_profile(reference: Reference, profile: str) -> Implementation:
        """With the values of a profile for the parameters that choose; a time has it in the letter alone."""
        signals = reference.signals("parameters").items()
        free = {name for name, of in signals if profile == CAUTIOUS and of.type == "ms"}
        chosen = {n: of for n, of in signals if (of.project or of.cautious is not None) and n not in free}
        values = {name: reference.in_code(name, value_in(of, profile)) for name, of in chosen.items()}
        return Implementation(reference, values)

    @cached_property
    def _control(self) -> Any:
        return z3.Int(CONTROL)

    @cached_property
    def state(self) -> Mapping[str, Any]:
        """As `Subject.state`."""
        return {**{str(term): term for term in self.reference.memory_terms.values()}, CONTROL: self._control}

    @cached_property
    def start(self) -> Mapping[str, Any]:
        """As `Subject.start`."""
        control, memory = self.reference.power_up
        terms = self.reference.memory_terms
        found = {str(terms[place]): _in_sort(terms[place], memory[place]) for place in terms}
        return {**found, CONTROL: z3.IntVal(self.reference.controls.index(control))}

    def _joined(self, parts: Mapping[str, Any]) -> Any:
        """The one of these terms that is of the control state at hand."""
        *first, last = self.reference.controls
        found = parts[last]
        for control in reversed(first):
            number = self.reference.controls.index(control)
            found = z3.If(self._control == number, parts[control], found)
        return found

    @cached_property
    def after(self) -> Mapping[str, Any]:
        """As `Subject.after`."""
        found = {}
        for place, term in self.reference.memory_terms.items():
            parts = {name: _in_sort(term, step.after[place]) for name, step in self.reference.steps.items()}
            found[str(term)] = self._joined(parts)
        where = {name: step.control_after for name, step in self.reference.steps.items()}
        return {**found, CONTROL: self._joined(where)}

    @cached_property
    def outputs(self) -> Mapping[str, Any]:
        """As `Subject.outputs`."""
        steps = self.reference.steps
        places = next(iter(steps.values())).outputs
        return {
            place: self._joined({name: _term(step.outputs[place]) for name, step in steps.items()})
            for place in places
        }

    @cached_property
    def fits(self) -> Sequence[z3.BoolRef]:
        """As `Subject.fits`."""
        within = z3.And(self._control >= 0, self._control < len(self.reference.controls))
        return [*conjuncts(self.reference.memory_ranges), within]

    @property
    def inside(self) -> z3.BoolRef:
        """As `Subject.inside`."""
        return z3.BoolVal(True)

    @property
    def conditions(self) -> Sequence[z3.BoolRef]:
        """As `Subject.conditions`."""
        return ()

    @property
    def longest_scan(self) -> int | None:
        """As `Subject.longest_scan`."""
        return None

    def allows(self, parameters: Mapping[str, Any]) -> bool:
        """As `Subject.allows`."""
        return all(parameters[name] == value for name, value in self.fixed.items())

    def run(self, run: Run) -> Iterator[Step]:
        """As `Subject.run`."""
        of = self.reference
        state = of.start(run.parameters)
        for dt_ms, inputs in run.scans:
            state, sends = of.scan(state, dt_ms, inputs)
            control, values = of.plain_memory(state)
            memory = {str(of.memory_terms[place]): _number(of, place, one) for place, one in values.items()}
            memory[CONTROL] = of.controls.index(control)
            yield Step(dt_ms, of.to_wire("inputs", inputs), of.to_wire("outputs", sends), memory)


def _number(of: Reference, place: str, value: Any) -> Any:
    """A value of memory as its term has it."""
    if not isinstance(value, str):
        return value
    signals = of.device.register.memory.values()
    values = next(signal.values for signal in signals if signal.python == place.partition(".")[0])
    return values.index(value)


def _term(value: Any) -> Any:
    if isinstance(value, z3.ExprRef):
        return value
    return z3.BoolVal(value) if isinstance(value, bool) else z3.IntVal(value)


def _in_sort(term: Any, value: Any) -> Any:
    """A value in the sort of a term."""
    if isinstance(value, z3.ExprRef):
        return value
    if z3.is_bool(term):
        return z3.BoolVal(bool(value))
    return z3.BitVecVal(int(value), term.size()) if z3.is_bv(term) else z3.IntVal(int(value))
