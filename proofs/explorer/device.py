"""A device's `step` from each of its control states, on symbolic memory, inputs and parameters.

Names, types and ranges come from the document's interface register. The control state is a plain value in
each run, everything else is symbolic: words over all 65536 values, levels and modes over -1..4, times without
limit. Free symbols are called `before.x` (memory), `in.x` (inputs), `set.x` (parameters).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from enum import Enum
from types import MappingProxyType, ModuleType
from typing import Any, Final

import z3

from modeproof.registers import Device as Register
from modeproof.registers import Signal
from proofs.explorer import lint
from proofs.explorer.errors import ConcretizationError
from proofs.explorer.explore import Exploration, Path, StandIn, conjunction, disjunction, explore
from proofs.explorer.records import unvalidated
from proofs.explorer.values import Opaque, flag, number, text, word

WORD_MAX: Final = 0xFFFF
MODES: Final = 5
LOGIC: Final = "ALL"
"""Words and unbounded integers in one query; SMT-LIB has no smaller name for it."""


@dataclass(frozen=True)
class Device:
    """A device of a document: its module, its names, and what the interface register does not say.

    parameters_fit: from a Params record with symbols, what its constructor demands beyond the single ranges.
    memory: templates for fields of State whose type is a record. stand_ins: see `StandIn`.
    """

    module: ModuleType
    register: Register
    parameters_fit: Callable[[Any], z3.BoolRef] = lambda params: z3.BoolVal(True)
    memory: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    stand_ins: tuple[StandIn, ...] = ()

    @property
    def name(self) -> str:
        """The id in the interface register."""
        return self.register.id

    @property
    def control(self) -> str:
        """The field of State that holds the control state."""
        for signal in self.register.memory.values():
            if signal.type == "text":
                return signal.python
        raise ConcretizationError(f"{self.name}: no memory of type text says the control state")

    def params(self) -> Any:
        """A Params record with a symbol for each parameter."""
        return unvalidated(self.module.Params, self._record(self.register.parameters, "set"))

    def inputs(self) -> Any:
        """An Inputs record with a symbol for each input and for the elapsed time."""
        values = self._record(self.register.inputs, "in")
        return unvalidated(self.module.Inputs, {"dt_ms": number("in.dt_ms", 0), **values})

    def state(self, control: Enum, params: Any) -> Any:
        """A State record in this control state, with a symbol for every other field."""
        signals = {signal.python: signal for signal in self.register.memory.values()}
        values: dict[str, Any] = {}
        for declared in fields(self.module.State):
            if declared.name == "params":
                values[declared.name] = params
            elif declared.name == self.control:
                values[declared.name] = control
            elif declared.name in self.memory:
                values[declared.name] = self.memory[declared.name]
            else:
                values[declared.name] = symbol_of(signals[declared.name], f"before.{declared.name}")
        return unvalidated(self.module.State, values)

    def _record(self, signals: Mapping[str, Signal], prefix: str) -> dict[str, Any]:
        return {signal.python: symbol_of(signal, f"{prefix}.{signal.python}") for signal in signals.values()}


def symbol_of(signal: Signal, name: str) -> Any:
    """The symbol, or tuple of symbols, for a signal of the interface register. Raises ConcretizationError."""
    if signal.type == "bool":
        return flag(name)
    if signal.type == "word":
        return word(name)
    if signal.type == "mode":
        return number(name, -1, MODES - 1)
    if signal.type == "modes":
        return tuple(flag(f"{name}.{mode}") for mode in range(MODES))
    if signal.type == "text":
        return text(name, signal.values)
    if signal.type == "function":
        return Opaque(name)
    if signal.type == "ms" or signal.type == "int":
        low, high = signal.minimum or 0, signal.maximum
        if is_word(signal):
            return word(name, low, high or 0)
        return number(name, low, high)
    raise ConcretizationError(f"{name}: no symbol for type {signal.type!r}")


def is_word(signal: Signal) -> bool:
    """Whether the signal is a vector of 16 bits for the solver: a word, or a number that fits into one."""
    low, high = signal.minimum or 0, signal.maximum
    return signal.type == "word" or (
        signal.type == "int" and low >= 0 and high is not None and high <= WORD_MAX
    )


@dataclass(frozen=True)
class Scan:
    """All scans of a device that begin in one control state."""

    control: Enum
    state: Any
    inputs: Any
    exploration: Exploration

    @property
    def premise(self) -> z3.BoolRef:
        """All ranges, and what the parameters must fulfil."""
        return self.exploration.premise

    @property
    def paths(self) -> tuple[Path, ...]:
        """Every feasible path; the result of each is the pair (State, Outputs)."""
        return self.exploration.paths


def scans(device: Device) -> tuple[Scan, ...]:
    """Explore `step` from every control state, in the order of the module's Step.

    The code is linted first. The result is kept as long as the code that `step` reaches stays the same.
    Within `judging` they are the scans given there. Raises ExplorationError: LintError for what no symbolic
    value can notice, or a path that returns no pair.
    """
    if device.name in _JUDGED:
        return _JUDGED[device.name][1]
    reach = lint.reach_of(device.module.step, stand_ins=[stand_in.name for stand_in in device.stand_ins])
    reach.refuse_faults()
    key = (device.name, device.module.__name__, reach.fingerprint)
    if key not in _EXPLORED:
        _EXPLORED[key] = tuple(explored_from(device, control) for control in device.module.Step)
    return _EXPLORED[key]


_EXPLORED: dict[object, tuple[Scan, ...]] = {}
_JUDGED: dict[str, tuple[Device, tuple[Scan, ...]]] = {}


@contextmanager
def judging(device: Device, found: Sequence[Scan]) -> Iterator[None]:
    """Inside, what theorems say of the device of this name is said of this one, and of these scans alone.

    For a device that is not the shipped one: a theorem is then a question about it. What the theorem says of
    other control states is not asked.
    """
    before = _JUDGED.get(device.name)
    _JUDGED[device.name] = device, tuple(found)
    try:
        yield
    finally:
        if before is None:
            del _JUDGED[device.name]
        else:
            _JUDGED[device.name] = before


def judged(device: Device) -> Device:
    """The device that theorems about `device` speak of: itself, but within `judging`."""
    return _JUDGED[device.name][0] if device.name in _JUDGED else device


def explored_from(device: Device, control: Enum) -> Scan:
    """Explore `step` from one control state; nothing is linted and nothing kept."""
    params, inputs = device.params(), device.inputs()
    state = device.state(control, params)
    exploration = explore(
        device.module.step, (state, inputs), device.parameters_fit(params), device.stand_ins
    )
    for path in exploration.paths:
        what = path.result
        right = isinstance(what, tuple) and len(what) == 2 and isinstance(what[0], device.module.State)
        if path.raised is None and not (right and isinstance(what[1], device.module.Outputs)):
            raise ConcretizationError(f"{device.name}: from {control.value} step returned {what!r}, no pair")
    return Scan(control, state, inputs, exploration)


# ---------------------------------------------------------------- exhaustive and disjoint


def some_path(conditions: Sequence[z3.BoolRef]) -> z3.BoolRef:
    """At least one of the conditions holds."""
    return disjunction(conditions)


def no_two_paths(conditions: Sequence[z3.BoolRef]) -> z3.BoolRef:
    """No two of the conditions hold together: each path against the rest, in one formula.

    Said of halves, and of halves of halves: none of the first half together with one of the second. Paths
    that stand side by side have most of their answers in common, so that a solver has little to try.
    """
    overlaps: list[z3.BoolRef] = []
    _any_of(conditions, overlaps)
    return z3.Not(disjunction(overlaps))


def _any_of(conditions: Sequence[z3.BoolRef], overlaps: list[z3.BoolRef]) -> z3.BoolRef:
    """A formula that one of the conditions holds. Overlaps among the conditions are added to the list."""
    if len(conditions) == 1:
        return conditions[0]
    half = len(conditions) // 2
    first, second = _any_of(conditions[:half], overlaps), _any_of(conditions[half:], overlaps)
    overlaps.append(conjunction([first, second]))
    return disjunction([first, second])
