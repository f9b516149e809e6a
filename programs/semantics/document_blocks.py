"""The documents' blocks as function blocks of a program: each call is a scan of the reference implementation.

A program may declare an instance of a published block by the document's name, such as `edm : SF_EDM`, unless
it has a block of that name itself. Inputs, outputs and parameters are the pins; `_ms` at the end of a name is
left out. A parameter has one value for each instance. A block measures the time since its call before.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any

import z3

from modeproof.ground.errors import Unjudged
from modeproof.registers import Signal
from programs.language.calls import function_of, handed_to_block, inner_bodies
from programs.language.memory import elements
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import (
    BOOL,
    SCALARS,
    TIME,
    Assign,
    Body,
    Call,
    Expression,
    Instance,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Source,
    Unary,
    Unit,
    Variable,
    blocks_in,
)
from programs.language.types import Types
from programs.semantics.reference import Reference, reference, targets
from programs.semantics.terms import INT, Env, Slot, choose

CONTROL, AGE = "control", "age"
"""What a block remembers beside its memory: the number of its control state, and the time since its call."""


def _pin(name: str, signal: Signal) -> tuple[str, Scalar] | None:
    """The name and the type of a pin; None: values of that kind have none in Structured Text here."""
    kinds = {"bool": BOOL, "word": SCALARS["WORD"], "ms": TIME}
    if signal.type == "text":
        return name, Scalar(name, "enum", 0, len(signal.values) - 1, tuple(signal.values))
    if signal.type not in kinds:
        return None
    return name.removesuffix("_ms"), kinds[signal.type]


@dataclass(frozen=True)
class Block:
    """A reference implementation as a block. `unit.device` is one of these."""

    reference: Reference

    @cached_property
    def pins(self) -> Mapping[str, tuple[str, str]]:
        """Each pin in upper case: its group in interface.toml and its name in the code."""
        found = {}
        for group in ("inputs", "parameters", "outputs"):
            for name, signal in self.reference.signals(group).items():
                if (pin := _pin(name, signal)) is not None:
                    found[pin[0].upper()] = (group, name)
        return found

    @cached_property
    def fixed(self) -> Mapping[str, Any]:
        """The parameters that have no pin, with their defaults: sets of modes."""
        signals = self.reference.signals("parameters")
        defaults = self.reference.with_defaults({})
        return {name: defaults[name] for name, signal in signals.items() if _pin(name, signal) is None}

    def unit(self) -> Unit:
        """The block with its pins and no body."""
        place = Place(f"spec/{self.reference.document}/interface.toml", 1)
        variables = {}
        for group, section in (("inputs", "input"), ("parameters", "input"), ("outputs", "output")):
            for name, signal in self.reference.signals(group).items():
                if (pin := _pin(name, signal)) is None:
                    continue
                default = signal.default
                if signal.type == "text":
                    default = signal.values.index(signal.default)
                initial = None if group != "parameters" else default
                variables[pin[0].upper()] = Variable(pin[0], pin[1], section, initial, place)
        return Unit(self.reference.device.name, "function block", variables, (), place, {}, device=self)

    # ------------------------------------------------------------ with plain values

    def start(self, values: Mapping[str, Any]) -> Any:
        """The state at power-up, with the parameters on the pins. Raises ValueError for wrong ones."""
        return self.reference.start({**self.fixed, **self._code("parameters", values)})

    def call(self, frame: Any, now: int) -> None:
        """One call at this time, in ms since power-up."""
        if frame.state is None:
            frame.state = self.start(frame.values)
        inputs = self._code("inputs", frame.values)
        frame.state, outputs = self.reference.scan(frame.state, now - frame.since, inputs)
        frame.since = now
        control, memory = self.reference.plain_memory(frame.state)
        frame.values |= memory | {CONTROL: self.reference.controls.index(control)}
        for pin, (group, name) in self.pins.items():
            if group == "outputs":
                frame.values[pin] = outputs[name]

    def _code(self, group: str, values: Mapping[str, Any]) -> dict[str, Any]:
        signals = self.reference.signals(group)
        found = {}
        for pin, (where, name) in self.pins.items():
            if where == group:
                signal = signals[name]
                found[name] = signal.values[values[pin]] if signal.type == "text" else values[pin]
        return found

    def memory(self) -> dict[str, Any]:
        """The memory at power-up by the names of its slots."""
        found = {slot.path.removeprefix("."): slot.initial for slot in self.slots("")}
        del found[AGE]
        return found

    # ------------------------------------------------------------ as terms

    def slots(self, path: str) -> Iterator[Slot]:
        """What the block remembers beside its pins."""
        control, memory = self.reference.power_up
        numbers = Scalar("control", "enum", 0, len(self.reference.controls) - 1, self.reference.controls)
        yield Slot(f"{path}.{CONTROL}", numbers, self.reference.controls.index(control), "var")
        yield Slot(f"{path}.{AGE}", INT, 0, "var")
        for place, term in memory.items():
            if z3.is_bool(term):
                yield Slot(f"{path}.{place}", BOOL, z3.is_true(term), "var")
            else:
                if not z3.is_int_value(term):
                    raise Unjudged(f"{self.reference.device.name}: {place} at power-up is no number")
                yield Slot(f"{path}.{place}", INT, term.as_long(), "var")

    def ranges(self, path: str, symbols: Env) -> z3.BoolRef:
        """What each call takes for granted of the memory before it: it is owed by every proof."""
        known = self.reference.memory_terms.items()
        where = [(symbol, symbols[f"{path}.{place}"]) for place, symbol in known]
        control, age = symbols[f"{path}.{CONTROL}"], symbols[f"{path}.{AGE}"]
        own = z3.substitute(self.reference.memory_ranges, *where)
        return z3.And(own, control >= 0, control < len(self.reference.controls), age >= 0)

    def terms(self, path: str, env: Env) -> None:
        """One call, in `env`."""
        reference = self.reference
        where = [(symbol, env[f"{path}.{place}"]) for place, symbol in reference.memory_terms.items()]
        symbols = {**reference.input_terms, **reference.parameter_terms}
        where += [
            (symbols[name], env[f"{path}.{pin}"])
            for pin, (group, name) in self.pins.items()
            if group != "outputs"
        ]
        where += [
            (symbols[f"{name}[{mode}]"], z3.BoolVal(there))
            for name, modes in self.fixed.items()
            for mode, there in enumerate(modes)
        ]
        where.append((reference.input_terms["dt_ms"], env[f"{path}.{AGE}"]))
        control = env[f"{path}.{CONTROL}"]
        known: dict[str, Any] = {}
        steps = [reference.steps[name] for name in reference.controls]
        for number, step in reversed(list(enumerate(steps))):
            made = {place: step.after[place] for place in reference.memory_terms}
            made |= {
                pin: step.outputs[name] for pin, (group, name) in self.pins.items() if group == "outputs"
            }
            made[CONTROL] = step.control_after
            for name, term in made.items():
                there = z3.substitute(term, *where)
                at = z3.simplify(control == number)
                known[name] = choose(at, there, known[name]) if name in known else there
        for name, term in known.items():
            env[f"{path}.{name}"] = z3.simplify(term)
        env[f"{path}.{AGE}"] = z3.IntVal(0)


@cache
def block(name: str) -> Block | None:
    """The published block of this name, without regard to case and underscores; None: it is none."""
    known = {target.replace("_", ""): target for target in targets()}
    target = known.get(name.lower().replace("_", ""))
    if target is None:
        return None
    of = reference(target)
    groups = (of.signals(group) for group in ("inputs", "outputs", "parameters"))
    if any(
        _pin(pin, signal) is None and (signal.type != "modes" or signal.default is None)
        for signals in groups
        for pin, signal in signals.items()
    ):
        return None
    return Block(of)


def with_blocks(source: Source) -> Source:
    """The source with each published block that it has an instance of and does not bring itself.

    Raises Unjudged: it brings the block, and that cannot be read.
    """
    units = dict(source.units)
    for unit in source.units.values():
        for variable in unit.variables.values():
            for name in blocks_in(variable.type):
                key = name.upper()
                if key in units or key in BLOCKS or (found := block(key)) is None:
                    continue
                if key in source.refused:
                    raise source.refused[key]  # it is there, and the published one is another
                units[key] = found.unit()
    return replace(source, units=units)


def instances(source: Source, unit: Unit, above: str = "") -> Iterator[tuple[str, Block]]:
    """The path of each instance of a published block in a unit, and the block."""
    for key, variable in unit.variables.items():
        for path, kind, _ in elements(variable.type, f"{above}{key}", None):
            below = source.units.get(kind.block.upper()) if isinstance(kind, Instance) else None
            if below is not None and isinstance(below.device, Block):
                yield path, below.device
            elif below is not None:
                yield from instances(source, below, f"{path}.")


# ---------------------------------------------------------------- parameters


def check_parameters(source: Source, unit: Unit) -> None:
    """Refuse a parameter of a block that is no constant, has two values, or one that the block refuses.

    Raises Unjudged with file and line.
    """
    types = Types(source, unit)
    given: dict[str, dict[str, int]] = {}
    for target in _targets(unit.body):
        if isinstance(target, Member) and isinstance(kind := types.of(target.of), Instance):
            found = source.units.get(kind.block.upper())
            device = None if found is None else found.device
            if isinstance(device, Block) and device.pins[target.name.upper()][0] == "parameters":
                raise target.place.refuse(f"{target.name} is a parameter: give it in the call, as a constant")
    for call in _calls(unit.body):
        if function_of(source, unit, call) is not None:
            continue
        kind = types.of(call.instance)
        own = source.units.get(kind.block.upper()) if isinstance(kind, Instance) else None
        device = None if own is None else own.device
        if not isinstance(device, Block) or not isinstance(kind, Instance):
            continue
        values = {}
        for name, expression in handed_to_block(source, kind, call)[0]:
            group, _ = device.pins[name.upper()]
            if group == "parameters":
                values[name.upper()] = _constant(types, name, expression)
        instance = _shown(call.instance)
        before = given.setdefault(instance.upper(), values)
        if before != values:
            raise call.place.refuse(f"{instance}: its parameters have other values in another call")
        whole = {key: variable.initial for key, variable in device.unit().variables.items()} | values
        for key, (group, _) in device.pins.items():
            if group == "parameters" and whole[key] is None:
                raise call.place.refuse(f"{instance}: parameter {key} has no default; give it a value")
        try:
            device.start(whole)
        except (ValueError, TypeError) as error:
            raise call.place.refuse(f"{instance}: {error}") from None


def _shown(expression: Expression) -> str:
    return expression.name if isinstance(expression, Name | Member) else "block"


def _constant(types: Types, name: str, expression: Expression) -> int:
    match expression:
        case Literal() | Unary("-", Literal(), _) | Name():
            return types.constant(expression)
        case Member() if types.enum_member(expression) is not None:
            return types.constant(expression)
    raise expression.place.refuse(f"{name} is a parameter, so it needs a constant")


def _targets(body: Body) -> Iterator[Expression]:
    """What is written otherwise than by handing it to a call."""
    for statement in body:
        if isinstance(statement, Assign):
            yield statement.target
        if isinstance(statement, Call):
            yield from (target for _, target in statement.outputs)
        for inner in inner_bodies(statement):
            yield from _targets(inner)


def _calls(body: Body) -> Iterator[Call]:
    for statement in body:
        if isinstance(statement, Call):
            yield statement
        for inner in inner_bodies(statement):
            yield from _calls(inner)
