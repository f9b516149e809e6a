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
from programs.language.calls import function_of, handed_to_block, handed_to_function, in_outs, own_arguments
from programs.language.memory import default
from programs.language.standard_blocks import arguments, conversion, converted_from
from programs.language.tree import (
    MOST_TURNS,
    Array,
    Assign,
    Binary,
    Bit,
    Body,
    Call,
    Case,
    Expression,
    For,
    Function,
    If,
    Index,
    Instance,
    Leave,
    Literal,
    Loop,
    Member,
    Name,
    Place,
    Return,
    Scalar,
    Source,
    Struct,
    Type,
    Unary,
    Unit,
    blocks_in,
)
from programs.language.types import Types
from programs.semantics.interpreter_blocks import Standard
from programs.semantics.interpreter_expressions import ready


class Overflow(Unjudged):
    """A value left the range of its type, a divisor was zero, or an index was outside its array."""


class Limit(Overflow):
    """A limit of the reader was met, which is no fault of the program: nothing can be said of it."""


class _Returned(Exception):
    pass


class _Exit(Exception):
    pass


class _Continue(Exception):
    pass


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
        self.values: dict[str, Any] = {
            key: self.made(variable.type, variable.initial) for key, variable in unit.variables.items()
        }
        self.state: Any = None
        self.since = 0
        if unit.device is not None:
            self.values |= unit.device.memory()

    def made(self, kind: Type, initial: object) -> Any:
        """The first value of a variable, with the instances in it."""
        if isinstance(kind, Instance):
            block = kind.block.upper()
            known = self.source.units.get(block)
            return Standard(block) if known is None else Frame(self.source, known)
        if isinstance(kind, Array) and any(blocks_in(kind)):
            return [self.made(kind.element, None) for _ in range(kind.low, kind.high + 1)]
        if isinstance(kind, Struct) and any(blocks_in(kind)):
            own = dict(initial) if isinstance(initial, tuple) else {}
            return {
                name.upper(): self.made(inner, own.get(name.upper(), value))
                for name, inner, value in kind.members
            }
        return default(kind, initial)


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
            self.memory.values[name.upper()] = deepcopy(value)
        self.call(self.memory)
        return {name: deepcopy(self.memory.values[name.upper()]) for name in self.unit.of("output")}

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
                    given = self.given(frame, value, frame.types.declared(target), place)
                    self.store(frame, target, given)
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
                        self.store(frame, control, number)
                        try:
                            with contextlib.suppress(_Continue):
                                self.body(frame, inner)
                        except _Exit:
                            break
                        number += by
                    else:
                        self.store(frame, control, number)
                case Loop(going, inner, first, place):
                    with contextlib.suppress(_Exit):
                        self.turns(frame, going, inner, first, place)
                case Call():
                    self.invoke(frame, statement)
                case Return():
                    raise _Returned
                case Leave(turn, _):
                    raise _Continue if turn else _Exit

    def turns(self, frame: Frame, going: Expression, inner: Body, first: bool, place: Place) -> None:
        """The turns of WHILE and REPEAT."""
        made = -1 if first else 0
        while made < 0 or self.value(frame, going):
            if made == MOST_TURNS:
                what = f"the loop ends after {MOST_TURNS} turns at most; what takes more is not judged"
                raise Limit(f"{place.file}:{place.line}: not so: {what}")
            with contextlib.suppress(_Continue):
                self.body(frame, inner)
            made += 1

    def clause(self, frame: Frame, clauses: Any, found: int, otherwise: Body) -> Body:
        for ranges, inner in clauses:
            for low, high in ranges:
                if frame.types.constant(low) <= found <= frame.types.constant(high):
                    return inner  # type: ignore[no-any-return]
        return otherwise

    def invoke(self, frame: Frame, call: Call) -> None:
        if (unit := function_of(self.source, frame.unit, call)) is not None:
            self.invoke_function(frame, call, unit)
            return
        below, of = self.read(frame, call.instance), frame.types.of(call.instance)
        assert isinstance(of, Instance)
        inputs, outputs = handed_to_block(self.source, of, call)
        pins = below.values
        for name, expression in inputs:
            kind = frame.types.member(of, name, call.instance.place, True)
            pins[name.upper()] = self.given(frame, expression, kind, call.instance.place)
        kept = in_outs(self.source, of)
        lent = [(key.upper(), self.spot(frame, target)) for key, target in inputs if key.upper() in kept]
        if isinstance(below, Standard):
            below.call(self.now)
        else:
            self.call(below)
        for key, (holder, at) in lent:
            holder[at] = deepcopy(pins[key])
        for name, target in outputs:
            self.store(frame, target, deepcopy(pins[name.upper()]))

    def invoke_function(self, frame: Frame, call: Call, unit: Unit) -> None:
        """A FUNCTION called as a statement: it begins anew, and its outputs go where the call says."""
        inputs, outputs = handed_to_function(unit, call)
        called = Frame(self.source, unit)
        for name, expression in inputs:
            kind = unit.variables[name.upper()].type
            assert isinstance(kind, Scalar)
            called.values[name.upper()] = self.ranged(self.value(frame, expression, kind), kind, call.place)
        self.call(called)
        lent = unit.of("in_out")
        back = [pair for pair in inputs if unit.variables[pair[0].upper()].name in lent]
        for name, target in (*back, *outputs):
            self.store(frame, target, called.values[name.upper()])

    # ------------------------------------------------------------ values

    def ranged(self, value: Any, kind: Scalar, place: Place) -> Any:
        """The value in the range of its type."""
        if kind.kind not in ("int", "time") or kind.low <= value <= kind.high:
            return value
        if not self.wrap or kind.base is not None:
            raise Overflow(
                f"{place.file}:{place.line}: {value} is outside {kind.name}, {kind.low}..{kind.high}"
            )
        return (value - kind.low) % (kind.high - kind.low + 1) + kind.low

    def given(self, frame: Frame, expression: Expression, kind: Type, place: Place) -> Any:
        """The value of an expression for a variable of this type; a structure or an array is copied."""
        if isinstance(kind, Scalar):
            return self.ranged(self.value(frame, expression, kind), kind, place)
        return deepcopy(self.read(frame, expression))

    def spot(self, frame: Frame, target: Expression) -> tuple[Any, Any]:
        """Where a variable is kept: the values among which it is, and its key or number there."""
        match target:
            case Name(name, _):
                return frame.values, name.upper()
            case Member(of, name, _):
                above = self.read(frame, of)
                return (above if isinstance(above, dict) else above.values), name.upper()
            case Index(of, _, _):
                return self.read(frame, of), self.position(frame, target)
        raise AssertionError(target)

    def read(self, frame: Frame, target: Expression) -> Any:
        if isinstance(target, Bit):
            return bool(self.value(frame, target.of) // 2**target.number % 2)
        holder, at = self.spot(frame, target)
        return holder[at]

    def store(self, frame: Frame, target: Expression, value: Any) -> None:
        if isinstance(target, Bit):
            before = self.read(frame, target.of)
            changed = before + (int(value) - before // 2**target.number % 2) * 2**target.number
            self.store(frame, target.of, changed)
            return
        holder, at = self.spot(frame, target)
        holder[at] = value

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
        if isinstance(expression, Name | Member | Index | Bit):
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
        if node.operator in ("AND_THEN", "OR_ELSE"):
            if self.value(frame, node.left) == (node.operator == "OR_ELSE"):
                return node.operator == "OR_ELSE"
            return self.value(frame, node.right)
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
        if conversion(node.name) is not None:
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
        if given.numbers:
            value = given.numbers[value]
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
