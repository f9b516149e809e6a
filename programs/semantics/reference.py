"""The reference side of a comparison: a shipped device as the path explorer sees it, and as plain Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import z3

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.places import documents
from modeproof.ground.places import root as repository_root
from modeproof.kit.by_name import module_named
from modeproof.registers import Signal, load_interface
from proofs.explorer.device import Device
from proofs.explorer.ends import Fork, Tree, in_terms
from proofs.explorer.explore import explore
from proofs.explorer.records import symbols, terms
from proofs.explorer.scanned import Scanned, Scans, control, scans_of


def targets() -> dict[str, str]:
    """Each published target and its document."""
    root = repository_root()
    found = {}
    for document in documents(root):
        for name, device in load_interface(root, document).devices.items():
            if device.published:
                found[name] = document
    return found


def reference(target: str) -> Reference:
    """The reference implementation of a target. Raises Unjudged for an unknown one."""
    known = targets()
    if target not in known:
        raise Unjudged(f"no target {target!r}; {suggestion(target, known)}")
    module = module_named(f"proofs.{known[target]}.devices")
    device = next(device for device in module.DEVICES if device.name == target)
    return Reference(device, known[target])


Leaves = Mapping[str, Any]
"""Solver terms by the place of the field, such as `elapsed_ms` or `display.shown`."""


def _leaves(record: Any, leave_out: tuple[str, ...]) -> dict[str, Any]:
    found = {}
    for place, leaf in terms(record):
        if place.partition(".")[0] not in leave_out and isinstance(leaf, z3.ExprRef):
            found[place] = leaf
    return found


def tree_value(root: Tree, leaf: Callable[[Any], Any]) -> Any:
    """What `leaf` gives of the end to which the scan comes, as one term."""
    known: dict[int, Any] = {}

    def of(node: Tree | None) -> Any:
        if node is None:
            return None
        if id(node) not in known:
            if isinstance(node, Fork):
                yes, no = of(node.yes), of(node.no)
                if yes is None or no is None or yes.eq(no):
                    known[id(node)] = no if yes is None else yes
                else:
                    known[id(node)] = z3.If(node.question, yes, no)
            else:
                known[id(node)] = leaf(node)
        return known[id(node)]

    return of(root)


@dataclass(frozen=True)
class Step:
    """All scans of the reference from one control state, as terms over its memory and inputs."""

    control: str
    premise: z3.BoolRef
    after: Leaves
    control_after: Any
    """The number of the control state after the scan."""
    outputs: Leaves


@dataclass(frozen=True)
class Reference:
    """A device of a document."""

    device: Device
    document: str

    @cached_property
    def controls(self) -> tuple[str, ...]:
        """The control states, in their order."""
        return tuple(member.value for member in self.device.module.Step)

    def signals(self, group: str) -> Mapping[str, Signal]:
        """The signals of `inputs`, `outputs` or `parameters` by their names in the code."""
        found: Mapping[str, Signal] = getattr(self.device.register, group)
        return {signal.python: signal for signal in found.values()}

    @cached_property
    def parameters(self) -> Any:
        """A Params record with symbols."""
        return self.device.params()

    @cached_property
    def ranges(self) -> z3.BoolRef:
        """What is true of all parameters."""
        parts = [symbol.premise for symbol in symbols(self.parameters)]
        return z3.And(*parts, self.device.parameters_fit(self.parameters))

    def _outside(self, which: str) -> dict[str, Any]:
        record = self.parameters if which == "parameters" else self.device.inputs()
        return _leaves(
            in_terms(record, {**self.device.register.inputs, **self.device.register.parameters}), ()
        )

    @cached_property
    def input_terms(self) -> Leaves:
        """The symbol of each input, and `dt_ms`."""
        return self._outside("inputs")

    @cached_property
    def parameter_terms(self) -> Leaves:
        """The symbol of each parameter; of a set of modes one for each mode, such as `PERMITS_0[3]`."""
        return self._outside("parameters")

    @cached_property
    def steps(self) -> Mapping[str, Step]:
        """The scans from each control state."""
        return {scans.control: self._step(scans) for scans in scans_of(self.device)}

    def _step(self, scans: Scans) -> Step:
        read: Mapping[int, Scanned] = scans.read
        leave = ("params", self.device.control)
        table = {
            key: (_leaves(scan.after, leave), self._output_leaves(scan.sends)) for key, scan in read.items()
        }
        number = {name: z3.IntVal(n) for n, name in enumerate(self.controls)}

        def joined(part: int, place: str) -> Any:
            return tree_value(scans.root, lambda end: table[id(end)][part][place])

        first = next(iter(read.values()))
        made = {place: joined(0, place) for place in _leaves(first.before, leave)}
        outputs = {place: joined(1, place) for place in next(iter(table.values()))[1]}
        where = tree_value(scans.root, lambda end: number[control(self.device, read[id(end)].after)])
        return Step(scans.control, scans.scan.premise, made, where, outputs)

    def _output_leaves(self, record: Any) -> dict[str, Any]:
        found = {}
        signals = self.signals("outputs")
        for name in (field.name for field in fields(record)):
            value = getattr(record, name)
            if isinstance(value, str):
                found[name] = z3.IntVal(signals[name].values.index(value))
            elif isinstance(value, tuple):
                for number, part in enumerate(value):
                    found[f"{name}[{number}]"] = part
            else:
                found[name] = value
        return found

    @cached_property
    def memory_terms(self) -> Leaves:
        """The symbol of each field of memory but the control state."""
        scans = scans_of(self.device)[0]
        return _leaves(next(iter(scans.read.values())).before, ("params", self.device.control))

    @cached_property
    def memory_ranges(self) -> z3.BoolRef:
        """What every scan takes for granted of the memory before it, beside the parameters."""
        state = scans_of(self.device)[0].scan.state
        own = [symbol for symbol in symbols(state) if str(symbol.term).startswith("before.")]
        return z3.And([z3.BoolVal(True), *(symbol.premise for symbol in own)])

    @cached_property
    def power_up(self) -> tuple[str, Leaves]:
        """The control state and the memory at power-up, over the parameters."""
        found = explore(
            self.device.module.power_up, (self.parameters,), self.device.parameters_fit(self.parameters)
        )
        if len(found.paths) != 1 or found.paths[0].raised is not None:
            raise Unjudged(
                f"{self.device.name}: power-up depends on parameters in a way that is not supported"
            )
        state = found.paths[0].result
        record = in_terms(state, {**self.device.register.inputs, **self.device.register.memory})
        return control(self.device, state), _leaves(record, ("params", self.device.control))

    # ------------------------------------------------------------ with plain values

    def plain(self, group: str, values: Mapping[str, Any]) -> dict[str, Any]:
        """Numbers of a solver for `inputs` or `parameters` as values of the code."""
        found: dict[str, Any] = {}
        for name, signal in self.signals(group).items():
            if signal.type == "modes":
                found[name] = tuple(bool(values[f"{name}[{mode}]"]) for mode in range(5))
            else:
                found[name] = signal.values[values[name]] if signal.type == "text" else values[name]
        return found

    def from_wire(self, group: str, values: Mapping[str, Any]) -> dict[str, Any]:
        """Values of a test vector as values of the code."""
        signals = self.signals(group)
        return {name: _from_wire(signals[name], value) for name, value in values.items()}

    def to_wire(self, group: str, values: Mapping[str, Any]) -> dict[str, Any]:
        """Values of the code by the names and in the forms of a test vector."""
        signals = self.signals(group)
        return {name: _to_wire(signals[name], value) for name, value in values.items()}

    def in_code(self, name: str, value: Any) -> Any:
        """The value of a parameter in a register or in TOML as a value of the code."""
        if self.signals("parameters")[name].type != "modes":
            return value
        return tuple(mode in value for mode in range(5))

    def with_defaults(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """These parameters, and the default of each other one that has one."""
        signals = self.signals("parameters")
        defaults = {name: of.default for name, of in signals.items() if of.default is not None}
        return {**{name: self.in_code(name, value) for name, value in defaults.items()}, **values}

    def start(self, parameters: Mapping[str, Any]) -> Any:
        """The state at power-up. Raises ValueError for parameters that the code refuses."""
        return self.device.module.power_up(self.device.module.Params(**parameters))

    def scan(self, state: Any, dt_ms: int, inputs: Mapping[str, Any]) -> tuple[Any, dict[str, Any]]:
        """One scan: the state after it, and the outputs by their names."""
        after, sends = self.device.module.step(state, self.device.module.Inputs(dt_ms, **inputs))
        return after, {name: getattr(sends, name) for name in self.signals("outputs")}

    def plain_memory(self, state: Any) -> tuple[str, dict[str, Any]]:
        """The control state, and every other value of a state by its place."""
        values = {place: leaf for place, leaf in terms(state) if place in self.memory_terms}
        return control(self.device, state), values


def _from_wire(signal: Signal, value: Any) -> Any:
    match signal.type:
        case "word":
            return int(value, 16)
        case "mode":
            return -1 if value is None else value
        case "modes":
            return tuple(mode in value for mode in range(5))
        case "text":
            return value or ""
    return value


def _to_wire(signal: Signal, value: Any) -> Any:
    match signal.type:
        case "word":
            return f"{value:04X}"
        case "mode":
            return None if value == -1 else value
        case "modes":
            return [mode for mode, there in enumerate(value) if there]
        case "text":
            return value or None
    return value
