"""Values of expressions, and where variables are kept: the part of the interpreter that statements use.

Names and types are looked up once, and not in each scan: `ready` does so for what is frequent.
"""

from __future__ import annotations

import operator
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from copy import deepcopy
from typing import Any, Final

from modeproof.ground.errors import Unjudged
from programs.language.calls import own_arguments
from programs.language.standard_blocks import arguments, conversion, converted_from
from programs.language.tree import (
    Array,
    Binary,
    Bit,
    Expression,
    Function,
    Index,
    Instance,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Source,
    Type,
    Unary,
    Unit,
)
from programs.language.types import Types
from programs.semantics.memory_of_units import Frame


class Overflow(Unjudged):
    """A value left the range of its type, a divisor was zero, or an index was outside its array."""


class Limit(Overflow):
    """A limit of the reader was met, which is no fault of the program: nothing can be said of it."""


class Evaluator(ABC):
    """Computes expressions. wrap: integers and times wrap as two's complement; else they stop the run."""

    def __init__(self, source: Source, wrap: bool) -> None:
        self.source, self.wrap = source, wrap

    @abstractmethod
    def call(self, frame: Frame) -> None:
        """One call of a unit of the program's own."""

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
                return frame.holder(name.upper()), name.upper()
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
        called = Frame(self.source, unit, frame.shared)
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


Ready = Callable[[Evaluator, Frame], Any]
"""Gives the value of one expression."""
COMPARE: Final = ("=", "<>", "<", "<=", ">", ">=")
OPERATORS: Final[Mapping[str, Callable[[Any, Any], Any]]] = {
    "=": operator.eq, "<>": operator.ne, "<": operator.lt, "<=": operator.le, ">": operator.gt,
    ">=": operator.ge, "AND": operator.and_, "OR": operator.or_, "XOR": operator.xor,
}  # fmt: skip
"""What needs no range. Both operands are computed first."""


def ready(types: Types, expression: Expression, wanted: Scalar | None) -> Ready:
    """What gives the value of an expression of this unit; a bare number takes the type that is wanted."""
    if (member := types.enum_member(expression)) is not None:
        return _constant(member[1])
    kind = types.of(expression, wanted)
    match expression:
        case Literal(value, _, _):
            return _constant(bool(value) if isinstance(kind, Scalar) and kind.kind == "bool" else int(value))
        case Name(name, _):
            key = name.upper()
            if key in types.unit.of_keys("external"):
                return lambda machine, frame: frame.shared[key]
            return lambda machine, frame: frame.values[key]
        case Member(Name(name, _) as instance, pin, _) if isinstance(types.of(instance), Instance):
            of, key = name.upper(), pin.upper()
            if of in types.unit.of_keys("external"):
                return lambda machine, frame: frame.shared[of].values[key]
            return lambda machine, frame: frame.values[of].values[key]
        case Unary("NOT", operand, _) if isinstance(kind, Scalar) and kind.kind == "bool":
            inner = ready(types, operand, wanted)
            return lambda machine, frame: not inner(machine, frame)
        case Binary(sign, left, right, place) if sign in OPERATORS:
            first, second = types.pair(left, right, place, None if sign in COMPARE else wanted)
            one, other = ready(types, left, first), ready(types, right, second)
            do = OPERATORS[sign]
            return lambda machine, frame: do(one(machine, frame), other(machine, frame))
    return lambda machine, frame: machine.worked_out(frame, expression, wanted)


def _constant(value: Any) -> Ready:
    return lambda machine, frame: value
