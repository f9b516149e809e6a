"""Expressions of a program as solver terms."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import z3

from programs.calls import own_arguments
from programs.run import default
from programs.standard import arguments, converted_from
from programs.terms import (
    Env,
    both,
    choose,
    constant,
    either,
    negated,
    rotated,
    shifted,
    singles,
    truncated,
)
from programs.tree import (
    Array,
    Binary,
    Expression,
    Function,
    Index,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Unary,
    Unit,
)
from programs.types import Types

if TYPE_CHECKING:
    from programs.symbolic import Translator

_BITS: Mapping[str, Callable[[Any, Any], Any]] = {
    "AND": operator.and_, "OR": operator.or_, "XOR": operator.xor,
    "<": z3.ULT, "<=": z3.ULE, ">": z3.UGT, ">=": z3.UGE, "+W": operator.add, "-W": operator.sub,
}  # fmt: skip
_PLAIN: Mapping[str, Callable[[Any, Any], Any]] = {
    "=": operator.eq, "<>": operator.ne, "<": operator.lt, "<=": operator.le, ">": operator.gt,
    ">=": operator.ge, "AND": both, "OR": either, "XOR": z3.Xor,
}  # fmt: skip


@dataclass(frozen=True)
class Context:
    """Where a body stands: the translator, the types of its unit, and the path above its variables."""

    translator: Translator
    types: Types
    above: str

    def path(self, target: Expression, env: Env, here: z3.BoolRef) -> str:
        """The path of a target without a free index."""
        match target:
            case Name(name, _):
                return f"{self.above}{name.upper()}"
            case Member(of, name, _):
                return f"{self.path(of, env, here)}.{name.upper()}"
        raise target.place.refuse("an element of an array is not supported here")

    def store(self, target: Expression, term: Any, env: Env, here: z3.BoolRef) -> None:
        """Give a target its new value."""
        if isinstance(target, Index):
            array = self.types.of(target.of)
            assert isinstance(array, Array)
            base, index = self.path(target.of, env, here), z3.simplify(self.value(target.index, env, here))
            self.bounds(array, index, target.place, here)
            for number in range(array.low, array.high + 1):
                key = f"{base}[{number}]"
                env[key] = choose(z3.simplify(index == number), term, env[key])
        else:
            env[self.path(target, env, here)] = term

    def bounds(self, array: Array, index: Any, place: Place, here: z3.BoolRef) -> None:
        inside = z3.simplify(z3.And(index >= array.low, index <= array.high))
        if not z3.is_true(inside):
            self.translator.owe(
                z3.Implies(here, inside), f"an index stays within {array.low}..{array.high}", place
            )

    def value(self, expression: Expression, env: Env, here: z3.BoolRef, wanted: Scalar | None = None) -> Any:
        """The term of an expression."""
        if (member := self.types.enum_member(expression)) is not None:
            return z3.IntVal(member[1])
        kind = self.types.of(expression, wanted)
        match expression:
            case Literal(value, _, _):
                assert isinstance(kind, Scalar)
                return constant(kind, value)
            case Name(name, _):
                variable = self.types.unit.variables[name.upper()]
                if variable.section == "constant" and isinstance(kind, Scalar):
                    return constant(kind, default(kind, variable.initial))
                return env[self.path(expression, env, here)]
            case Member():
                return env[self.path(expression, env, here)]
            case Index(of, index, place):
                return self.element(of, z3.simplify(self.value(index, env, here)), place, env, here)
        assert isinstance(kind, Scalar)
        match expression:
            case Unary("NOT", operand, _):
                term = self.value(operand, env, here, wanted)
                return negated(term) if kind.kind == "bool" else ~term
            case Unary(_, operand, place):
                return self.translator.ranged(-self.value(operand, env, here, wanted), kind, place, here)
            case Binary():
                return self.binary(expression, kind, env, here, wanted)
            case Function():
                return self.function(expression, kind, env, here, wanted)
        raise AssertionError(expression)

    def element(self, of: Expression, index: Any, place: Place, env: Env, here: z3.BoolRef) -> Any:
        array = self.types.of(of)
        assert isinstance(array, Array) and isinstance(of, Name | Member)
        self.bounds(array, index, place, here)
        variable = self.types.unit.variables.get(of.name.upper()) if isinstance(of, Name) else None
        if variable is not None and variable.section == "constant" and isinstance(array.element, Scalar):
            values = default(array, variable.initial)
            terms = [constant(array.element, value) for value in values]
        else:
            base = self.path(of, env, here)
            terms = [env[f"{base}[{number}]"] for number in range(array.low, array.high + 1)]
        found = terms[-1]
        for number, term in reversed(list(zip(range(array.low, array.high), terms, strict=False))):
            found = choose(z3.simplify(index == number), term, found)
        return found

    def binary(self, node: Binary, kind: Scalar, env: Env, here: z3.BoolRef, wanted: Scalar | None) -> Any:
        compares = node.operator in ("=", "<>", "<", "<=", ">", ">=")
        first, second = self.types.pair(node.left, node.right, node.place, None if compares else wanted)
        left, right = self.value(node.left, env, here, first), self.value(node.right, env, here, second)
        if first.kind == "bits":
            wider = first if first.width >= second.width else second
            left, right = (
                self.translator.widened(left, first, wider),
                self.translator.widened(right, second, wider),
            )
            if node.operator in _BITS:
                return _BITS[node.operator](left, right)
        if node.operator in _PLAIN:
            return _PLAIN[node.operator](left, right)
        match node.operator:
            case "+":
                return self.translator.ranged(left + right, kind, node.place, here)
            case "-":
                return self.translator.ranged(left - right, kind, node.place, here)
            case "*":
                return self.translator.ranged(left * right, kind, node.place, here)
        if not (z3.is_int_value(right) and right.as_long() != 0):
            self.translator.owe(z3.Implies(here, right != 0), "no division by zero", node.place)
        quotient = truncated(left, right)
        term = quotient if node.operator == "/" else left - right * quotient
        return self.translator.ranged(term, kind, node.place, here)

    def function(
        self, node: Function, kind: Scalar, env: Env, here: z3.BoolRef, wanted: Scalar | None
    ) -> Any:
        if (unit := self.types.own_function(node)) is not None:
            return self.own(node, unit, env, here)
        given = arguments(node)
        if node.name in ("SHL", "SHR", "ROL", "ROR"):
            term = self.value(given[0], env, here, wanted)
            if not isinstance(given[1], Literal):
                number = self.value(given[1], env, here)
                inside = z3.And(number >= 0, number < kind.width)
                text = f"a shift stays within 0..{kind.width - 1}"
                self.translator.owe(z3.Implies(here, inside), text, node.place)
                return shifted(node.name, term, z3.Int2BV(number, kind.width))
            by = self.types.constant(given[1])
            if node.name in ("ROL", "ROR"):
                return rotated(term, by if node.name == "ROL" else -by)
            return term << by if node.name == "SHL" else z3.LShR(term, by)
        if "_TO_" in node.name:
            return self.converted(node, given[0], kind, env, here)
        if node.name == "SEL":
            no, yes = (self.value(value, env, here, kind) for value in given[1:])
            return choose(self.value(given[0], env, here), yes, no)
        values = [self.value(value, env, here, kind) for value in given]
        match node.name:
            case "ABS":
                return self.translator.ranged(
                    z3.If(values[0] < 0, -values[0], values[0]), kind, node.place, here
                )
            case "MIN":
                return z3.If(values[0] <= values[1], values[0], values[1])
            case "MAX":
                return z3.If(values[0] >= values[1], values[0], values[1])
            case "LIMIT":
                low = z3.If(values[1] < values[0], values[0], values[1])
                return z3.If(low > values[2], values[2], low)
        return values[0]

    def own(self, node: Function, unit: Unit, env: Env, here: z3.BoolRef) -> Any:
        """The result of a FUNCTION of the program's own: it begins anew in each call."""
        inner: Env = {}
        for key, variable in unit.variables.items():
            start = default(variable.type, variable.initial)
            inner |= {path: constant(kind, value) for path, kind, value in singles(variable.type, key, start)}
        for key, expression in own_arguments(node, unit).items():
            kind = unit.variables[key].type
            assert isinstance(kind, Scalar)
            term = self.value(expression, env, here, kind)
            inner[key] = self.translator.fitted(term, self.types.of(expression, kind), kind, node.place, here)
        self.translator.call(unit, "", inner, here)
        return inner[unit.name.upper()]

    def converted(
        self, node: Function, argument: Expression, kind: Scalar, env: Env, here: z3.BoolRef
    ) -> Any:
        start = converted_from(node.name)
        given = start or self.types.of(argument)
        term = self.value(argument, env, here, start)
        assert isinstance(given, Scalar)
        term = self.translator.widened(term, self.types.of(argument, start), given)
        if given.kind == "bool" and kind.kind != "bool":
            term = z3.If(term, constant(kind, 1), constant(kind, 0))
            return term
        if given.kind == "bits" and kind.kind == "bits":
            if given.width < kind.width:
                return z3.ZeroExt(kind.width - given.width, term)
            return z3.Extract(kind.width - 1, 0, term)
        if given.kind == "bits":
            signed = (
                kind.kind == "int"
                and kind.low < 0
                and given.high <= kind.high - kind.low
                and given.high > kind.high
            )
            return self.translator.ranged(z3.BV2Int(term, is_signed=signed), kind, node.place, here)
        if kind.kind == "bits":
            return z3.Int2BV(term, kind.width)
        return self.translator.ranged(term, kind, node.place, here)
