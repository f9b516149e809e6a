"""Expressions whose value is known when a program is read: bounds, labels, initial values."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from programs.language.tree import (
    SCALARS,
    Binary,
    Expression,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Unary,
    Variable,
)

_WIDEST = SCALARS["LINT"]


@dataclass(frozen=True)
class Known:
    """A value and its type; None: a bare number, which takes the type of its place."""

    value: bool | int
    type: Scalar | None


Lookup = Callable[[Name | Member], Known | None]


def known(expression: Expression, look: Lookup) -> Known:
    """The value of a constant expression. Raises Unjudged: it is none, or it leaves its type."""
    place = expression.place
    match expression:
        case Literal(value, kind, _):
            return Known(value, kind)
        case Name(name, _) | Member(_, name, _):
            found = look(expression)
            if found is None:
                raise place.refuse(f"{name}: a constant is needed here")
            return found
        case Unary("-", operand, _):
            inner = known(operand, look)
            return _number(-int(inner.value), _kind([inner], "-", place), place)
        case Binary(operator, left, right, _) if operator in ("+", "-", "*", "/", "MOD"):
            first, second = known(left, look), known(right, look)
            kind = _kind([first, second], operator, place)
            return _number(_result(operator, int(first.value), int(second.value), place), kind, place)
    raise place.refuse("a constant is needed here")


def constant_of(variable: Variable | None) -> Known | None:
    """The value of a CONSTANT; None: it is none."""
    if variable is None or variable.section != "constant" or not isinstance(variable.initial, int):
        return None
    assert isinstance(variable.type, Scalar)
    return Known(variable.initial, variable.type.base or variable.type)


def _kind(given: list[Known], operator: str, place: Place) -> Scalar | None:
    kinds = [one.type for one in given if one.type is not None]
    numbers = all(kind.kind == "int" for kind in kinds)
    times = operator in "+-" and len(kinds) == len(given) and all(kind.kind == "time" for kind in kinds)
    if not numbers and not times:
        raise place.refuse(f"{operator}: a constant expression is made of whole numbers here")
    return max(kinds, key=lambda kind: (kind.high - kind.low, kind.high), default=None)


def _number(value: int, kind: Scalar | None, place: Place) -> Known:
    within = kind or _WIDEST
    if not within.low <= value <= within.high:
        raise place.refuse(f"{value} is outside {within.name}, {within.low}..{within.high}")
    return Known(value, kind)


def _result(operator: str, left: int, right: int, place: Place) -> int:
    match operator:
        case "+":
            return left + right
        case "-":
            return left - right
        case "*":
            return left * right
    if right == 0:
        raise place.refuse("division by zero in a constant")
    quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)
    return quotient if operator == "/" else left - right * quotient
