"""Expressions made ready for many scans: names and types are looked up once, and not in each scan.

What is frequent is done here; the rest is left to the interpreter.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

from programs.language.tree import Binary, Expression, Instance, Literal, Member, Name, Scalar, Unary
from programs.language.types import Types

if TYPE_CHECKING:
    from programs.semantics.interpreter import Frame, Machine

Ready = Callable[["Machine", "Frame"], Any]
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
            return lambda machine, frame: frame.values[key]
        case Member(Name(name, _) as instance, pin, _) if isinstance(types.of(instance), Instance):
            of, key = name.upper(), pin.upper()
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
