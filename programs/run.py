"""Runs a program with plain values, scan by scan: what a PLC would do. It knows nothing of solvers.

The clock stands still within a scan. TON, TOF and TP measure from the scan of the edge, in which ET is 0.
Integers and times that leave their range stop the run (`Overflow`), or wrap if the run says so.
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from modeproof.ground.errors import Unjudged
from programs.calls import in_outs, own_arguments
from programs.ready import ready
from programs.standard import arguments, converted_from
from programs.tree import (
    Array,
    Assign,
    Binary,
    Body,
    Call,
    Case,
    Expression,
    For,
    Function,
    If,
    Index,
    Instance,
    Literal,
    Member,
    Name,
    Place,
    Return,
    Scalar,
    Source,
    Stop,
    Type,
    Unary,
    Unit,
)
from programs.types import Types


class Overflow(Unjudged):
    """A value left the range of its type, a divisor was zero, or an index was outside its array."""


class Limit(Overflow):
    """A limit of the reader was met, which is no fault of the program: nothing can be said of it."""


class _Returned(Exception):
    pass


def default(kind: Type, initial: object) -> Any:
    """The value of a variable at power-up: 0, FALSE or the first member where none is declared."""
    if isinstance(kind, Array):
        given = list(initial) if isinstance(initial, tuple) else []
        size = kind.high - kind.low + 1
        return [default(kind.element, value) for value in [*given, *[None] * (size - len(given))]]
    assert isinstance(kind, Scalar)
    return bool(initial or False) if kind.kind == "bool" else int(initial or 0)  # type: ignore[call-overload]


class Frame:
    """The memory of one unit: its variables, and below them those of its instances."""

    def __init__(self, source: Source, unit: Unit) -> None:
        self.source, self.unit = source, unit
        self.types: Types = source.kept.setdefault(id(unit), Types(source, unit))
        self.temporary = {
            key: default(variable.type, variable.initial)
            for key, variable in unit.variables.items()
            if variable.section == "temp"
        }
        """What VAR_TEMP holds when a call begins."""
        self.values: dict[str, Any] = {}
        for key, variable in unit.variables.items():
            kind = variable.type
            if not isinstance(kind, Instance):
                self.values[key] = default(kind, variable.initial)
            elif kind.block.upper() in source.units:
                self.values[key] = Frame(source, source.units[kind.block.upper()])
            else:
                self.values[key] = Standard(kind.block.upper())
        self.state: Any = None
        self.since = 0
        if unit.device is not None:
            self.values |= unit.device.memory()


class Standard:
    """An instance of a standard block: its pins, and what it remembers."""

    def __init__(self, block: str) -> None:
        self.block = block
        self.values: dict[str, Any] = {
            "IN": False, "CLK": False, "S": False, "S1": False, "R": False, "R1": False,
            "PT": 0, "ET": 0, "Q": False, "Q1": False,
        }  # fmt: skip
        self.before = False
        self.since = 0
        self.running = False

    def call(self, now: int) -> None:
        """One call at this time, in ms since power-up."""
        own = self.values
        match self.block:
            case "TON":
                if not own["IN"]:
                    own["ET"], own["Q"] = 0, False
                else:
                    if not self.before:
                        self.since = now
                    own["ET"] = max(0, min(now - self.since, own["PT"]))
                    own["Q"] = now - self.since >= own["PT"]
            case "TOF":
                if own["IN"]:
                    own["ET"], own["Q"], self.running = 0, True, False
                else:
                    if self.before:
                        self.since, self.running = now, True
                    if self.running:
                        own["ET"] = max(0, min(now - self.since, own["PT"]))
                        own["Q"] = now - self.since < own["PT"]
                        self.running = bool(own["Q"])
            case "TP":
                if not self.running and own["IN"] and not self.before:
                    self.since, self.running = now, True
                if self.running:
                    own["ET"] = max(0, min(now - self.since, own["PT"]))
                    own["Q"] = now - self.since < own["PT"]
                    self.running = bool(own["Q"])
                if not self.running and not own["IN"]:
                    own["ET"] = 0
            case "R_TRIG":
                own["Q"] = own["CLK"] and not self.before
            case "F_TRIG":
                own["Q"] = not own["CLK"] and self.before
            case "SR":
                own["Q1"] = own["S1"] or (not own["R"] and own["Q1"])
            case "RS":
                own["Q1"] = not own["R1"] and (own["S"] or own["Q1"])
        self.before = own["IN"] or own["CLK"]


class Machine:
    """A program at power-up. wrap: integers and times wrap as two's complement; else they stop the run."""

    def __init__(self, source: Source, unit: Unit, wrap: bool = False) -> None:
        self.source, self.unit, self.wrap = source, unit, wrap
        self.memory = Frame(source, unit)
        self.now = 0

    def scan(self, inputs: Mapping[str, Any], dt_ms: int) -> dict[str, Any]:
        """One scan, `dt_ms` after the one before: the outputs by their names in the source.

        Raises Overflow with file and line.
        """
        self.now += dt_ms
        for name, value in inputs.items():
            self.memory.values[name.upper()] = value
        self.call(self.memory)
        return {name: self.memory.values[name.upper()] for name in self.unit.of("output")}

    def call(self, frame: Frame) -> None:
        """One call of a unit of the program's own."""
        if frame.unit.device is not None:
            frame.unit.device.call(frame, self.now)
            return
        for key, value in frame.temporary.items():
            frame.values[key] = value if isinstance(value, int) else deepcopy(value)
        with contextlib.suppress(_Returned):
            self.body(frame, frame.unit.body)

    def body(self, frame: Frame, body: Body) -> None:
        for statement in body:
            match statement:
                case Assign(target, value, place):
                    kind = frame.types.of(target)
                    assert isinstance(kind, Scalar)
                    self.store(frame, target, self.ranged(self.value(frame, value, kind), kind, place))
                case If(branches, otherwise, _):
                    chosen = next((inner for asked, inner in branches if self.value(frame, asked)), otherwise)
                    self.body(frame, chosen)
                case Case(subject, clauses, otherwise, _):
                    found = self.value(frame, subject)
                    self.body(frame, self.clause(frame, clauses, found, otherwise))
                case For(control, start, end, step, inner, place):
                    low, high = frame.types.constant(start), frame.types.constant(end)
                    by = 1 if step is None else frame.types.constant(step)
                    if by == 0:
                        raise Overflow(f"{place.file}:{place.line}: FOR by 0 does not end")
                    number = low
                    while number <= high if by > 0 else number >= high:
                        frame.values[control.name.upper()] = number
                        self.body(frame, inner)
                        number += by
                    frame.values[control.name.upper()] = number
                case Call(instance, inputs, outputs, place):
                    self.invoke(frame, instance, inputs, outputs)
                case Return():
                    raise _Returned
                case Stop(text, place):
                    raise Limit(f"{place.file}:{place.line}: not so: {text}; what takes more is not judged")

    def clause(self, frame: Frame, clauses: Any, found: int, otherwise: Body) -> Body:
        for ranges, inner in clauses:
            for low, high in ranges:
                if frame.types.constant(low) <= found <= frame.types.constant(high):
                    return inner  # type: ignore[no-any-return]
        return otherwise

    def invoke(self, frame: Frame, instance: Expression, inputs: Any, outputs: Any) -> None:
        below = self.read(frame, instance)
        pins = below.values
        for name, expression in inputs:
            kind = frame.types.member(frame.types.of(instance), name, instance.place, True)
            assert isinstance(kind, Scalar)
            pins[name.upper()] = self.ranged(self.value(frame, expression, kind), kind, instance.place)
        if isinstance(below, Standard):
            below.call(self.now)
        else:
            self.call(below)
        kept = in_outs(self.source, frame.types.of(instance))
        back = [(name, target) for name, target in inputs if name.upper() in kept]
        for name, target in (*back, *outputs):
            self.store(frame, target, pins[name.upper()])

    # ------------------------------------------------------------ values

    def ranged(self, value: Any, kind: Scalar, place: Place) -> Any:
        """The value in the range of its type."""
        if kind.kind not in ("int", "time") or kind.low <= value <= kind.high:
            return value
        if not self.wrap:
            raise Overflow(
                f"{place.file}:{place.line}: {value} is outside {kind.name}, {kind.low}..{kind.high}"
            )
        return (value - kind.low) % (kind.high - kind.low + 1) + kind.low

    def read(self, frame: Frame, target: Expression) -> Any:
        match target:
            case Name(name, _):
                return frame.values[name.upper()]
            case Member(of, name, _):
                return self.read(frame, of).values[name.upper()]
            case Index(of, _, _):
                return self.read(frame, of)[self.position(frame, target)]
        raise AssertionError(target)

    def store(self, frame: Frame, target: Expression, value: Any) -> None:
        match target:
            case Name(name, _):
                frame.values[name.upper()] = value
            case Member(of, name, _):
                self.read(frame, of).values[name.upper()] = value
            case Index(of, _, _):
                self.read(frame, of)[self.position(frame, target)] = value

    def position(self, frame: Frame, target: Index) -> int:
        kind = frame.types.of(target.of)
        assert isinstance(kind, Array)
        number = int(self.value(frame, target.index))
        if not kind.low <= number <= kind.high:
            place = target.place
            raise Overflow(f"{place.file}:{place.line}: index {number} is outside {kind.low}..{kind.high}")
        return number - kind.low

    def value(self, frame: Frame, expression: Expression, wanted: Scalar | None = None) -> Any:
        """The value of an expression."""
        kept, key = self.source.kept, (id(frame.unit), id(expression), id(wanted))
        if key not in kept:
            kept[key] = ready(frame.types, expression, wanted), expression, wanted
        return kept[key][0](self, frame)

    def worked_out(self, frame: Frame, expression: Expression, wanted: Scalar | None) -> Any:
        """The value of an expression that `ready` leaves to this."""
        if isinstance(expression, Name | Member | Index):
            return self.read(frame, expression)
        kind = frame.types.of(expression, wanted)
        assert isinstance(kind, Scalar)
        match expression:
            case Unary("NOT", operand, _):
                return kind.high ^ self.value(frame, operand, wanted)
            case Unary(_, operand, place):
                return self.ranged(-self.value(frame, operand, wanted), kind, place)
            case Binary():
                return self.binary(frame, expression, kind, wanted)
            case Function():
                return self.function(frame, expression, kind, wanted)
        raise AssertionError(expression)

    def binary(self, frame: Frame, node: Binary, kind: Scalar, wanted: Scalar | None) -> Any:
        first, second = frame.types.pair(node.left, node.right, node.place, wanted)
        left, right = self.value(frame, node.left, first), self.value(frame, node.right, second)
        match node.operator:
            case "+W" | "-W":
                return (left + (right if node.operator == "+W" else -right)) & kind.high
            case "+":
                return self.ranged(left + right, kind, node.place)
            case "-":
                return self.ranged(left - right, kind, node.place)
            case "*":
                return self.ranged(left * right, kind, node.place)
        if right == 0:
            raise Overflow(f"{node.place.file}:{node.place.line}: division by zero")
        quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)
        return self.ranged(quotient if node.operator == "/" else left - right * quotient, kind, node.place)

    def function(self, frame: Frame, node: Function, kind: Scalar, wanted: Scalar | None) -> Any:
        if (unit := frame.types.own_function(node)) is not None:
            return self.own(frame, node, unit)
        given = arguments(node)
        if node.name in ("SHL", "SHR", "ROL", "ROR"):
            value, by = self.value(frame, given[0], wanted), self.value(frame, given[1])
            if not isinstance(given[1], Literal) and not 0 <= by < kind.width:
                place = node.place
                raise Overflow(f"{place.file}:{place.line}: a shift by {by} is outside 0..{kind.width - 1}")
            return _shifted(node.name, value, by, kind)
        if "_TO_" in node.name:
            return self.converted(frame, node, given[0], kind)
        if node.name == "SEL":
            no, yes = (self.value(frame, value, kind) for value in given[1:])
            return yes if self.value(frame, given[0]) else no
        values = [self.value(frame, value, kind) for value in given]
        match node.name:
            case "ABS":
                return self.ranged(abs(values[0]), kind, node.place)
            case "MIN":
                return min(values)
            case "MAX":
                return max(values)
            case "LIMIT":
                return min(max(values[1], values[0]), values[2])
        return values[0]

    def own(self, frame: Frame, node: Function, unit: Unit) -> Any:
        """The result of a FUNCTION of the program's own: it begins anew in each call."""
        called = Frame(self.source, unit)
        for key, expression in own_arguments(node, unit).items():
            kind = unit.variables[key].type
            assert isinstance(kind, Scalar)
            called.values[key] = self.ranged(self.value(frame, expression, kind), kind, node.place)
        self.call(called)
        return called.values[unit.name.upper()]

    def converted(self, frame: Frame, node: Function, argument: Expression, kind: Scalar) -> Any:
        start = converted_from(node.name)
        given = start or frame.types.of(argument)
        value = self.value(frame, argument, start)
        assert isinstance(given, Scalar)
        if kind.kind == "bits":
            return int(value) & kind.high
        if given.kind == "bits" and kind.kind == "int" and value > kind.high:
            signed = given.high <= kind.high - kind.low
            return self.ranged(value - (kind.high - kind.low + 1) if signed else value, kind, node.place)
        return self.ranged(int(value), kind, node.place)


def _shifted(name: str, value: int, by: int, kind: Scalar) -> int:
    match name:
        case "SHL":
            return (value << by) & kind.high
        case "SHR":
            return value >> by
        case "ROL":
            by %= kind.width
            return ((value << by) | (value >> (kind.width - by))) & kind.high
    by %= kind.width
    return ((value >> by) | (value << (kind.width - by))) & kind.high
