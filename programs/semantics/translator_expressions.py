"""Expressions of a program as solver terms."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import z3

from programs.language.calls import own_arguments
from programs.language.memory import leaves
from programs.language.standard_blocks import arguments, conversion, converted_from
from programs.language.tree import (
    Array,
    Binary,
    Bit,
    Expression,
    Function,
    Index,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Type,
    Unary,
    Unit,
)
from programs.language.types import Types
from programs.semantics.obligations import Obliged
from programs.semantics.terms import (
    FALSE,
    TRUE,
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

_BITS: Mapping[str, Callable[[Any, Any], Any]] = {
    "AND": operator.and_, "OR": operator.or_, "XOR": operator.xor,
    "<": z3.ULT, "<=": z3.ULE, ">": z3.UGT, ">=": z3.UGE, "+W": operator.add, "-W": operator.sub,
}  # fmt: skip
_PLAIN: Mapping[str, Callable[[Any, Any], Any]] = {
    "=": operator.eq, "<>": operator.ne, "<": operator.lt, "<=": operator.le, ">": operator.gt,
    ">=": operator.ge, "AND": both, "OR": either, "XOR": z3.Xor,
}  # fmt: skip


MOST_PLACES = 1000
"""What a free index may choose from."""


def frame(unit: Unit) -> str:
    """What is before the names of a FUNCTION's own variables while it is called; it never calls itself."""
    return f"{unit.name.upper()}()."


Places = list[tuple[z3.BoolRef, str]]
"""Paths, and when each of them is meant."""


@dataclass(frozen=True)
class Context:
    """Where a body is: the translator, the types of its unit, and the path above its variables.

    root: the path above the globals.
    """

    translator: Obliged
    types: Types
    above: str
    root: str

    def places(self, target: Expression, env: Env, here: z3.BoolRef) -> Places:
        """Where a variable is: its path, or with a free index each path that it may have and when.

        The conditions exclude each other; the last path stands for every index that is left.
        """
        match target:
            case Name(name, _):
                own = self.types.unit.variables[name.upper()].section != "external"
                return [(TRUE, f"{self.above if own else self.root}{name.upper()}")]
            case Member(of, name, _):
                return [(there, f"{path}.{name.upper()}") for there, path in self.places(of, env, here)]
            case Index(of, index, place):
                array = self.types.of(of)
                assert isinstance(array, Array)
                number = z3.simplify(self.value(index, env, here))
                self.bounds(array, number, place, here)
                found = [
                    (both(there, at), f"{path}[{n}]")
                    for there, path in self.places(of, env, here)
                    for n in range(array.low, array.high + 1)
                    if not z3.is_false(at := z3.simplify(number == n))
                ]
                if len(found) > MOST_PLACES:
                    raise place.refuse(f"this may be one of more than {MOST_PLACES:,} variables")
                return found or [(FALSE, f"{self.places(of, env, here)[0][1]}[{array.low}]")]
        raise target.place.refuse("a variable is needed here")

    def read(self, places: Places, leaf: str, env: Env) -> Any:
        """The value there; leaf: the end of the path of one single value."""
        found = self.term(f"{places[-1][1]}{leaf}", env)
        for there, path in reversed(places[:-1]):
            found = choose(there, self.term(f"{path}{leaf}", env), found)
        return found

    def term(self, path: str, env: Env) -> Any:
        """What has this path, which may be a constant."""
        if path in env:
            return env[path]
        own = path[len(self.above) :]
        variable = self.types.unit.variables[re.split(r"[.\[]", own)[0]]
        assert variable.section == "constant"
        known = singles(variable.type, variable.name.upper(), variable.initial)
        return next(constant(kind, value) for place, kind, value in known if place == own)

    def put(self, places: Places, terms: Mapping[str, Any], env: Env) -> None:
        """Give what is there new values, by the ends of their paths."""
        for there, path in places:
            for leaf, term in terms.items():
                env[f"{path}{leaf}"] = choose(there, term, env[f"{path}{leaf}"])

    def assign(self, target: Expression, terms: Mapping[str, Any], env: Env, here: z3.BoolRef) -> None:
        """Give a target its new value, by the ends of the paths in it."""
        if isinstance(target, Bit):
            string = self.value(target.of, env, here)
            mask = z3.BitVecVal(1 << target.number, string.size())
            changed = z3.simplify(z3.If(terms[""], string | mask, string & ~mask))
            self.assign(target.of, {"": changed}, env, here)
        else:
            self.put(self.places(target, env, here), terms, env)

    def handed(
        self, expression: Expression, kind: Type, place: Place, env: Env, here: z3.BoolRef
    ) -> Mapping[str, Any]:
        """The value of an expression for a variable of this type, by the ends of the paths in it."""
        if isinstance(kind, Scalar):
            given = self.types.of(expression, kind)
            term = self.value(expression, env, here, kind)
            return {"": self.translator.fitted(term, given, kind, place, here)}
        where = self.places(expression, env, here)
        return {leaf: self.read(where, leaf, env) for leaf in leaves(kind)}

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
            case Name() | Member() | Index():
                return self.read(self.places(expression, env, here), "", env)
            case Bit(of, number, _):
                return z3.Extract(number, number, self.value(of, env, here)) == 1
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

    def binary(self, node: Binary, kind: Scalar, env: Env, here: z3.BoolRef, wanted: Scalar | None) -> Any:
        if node.operator in ("AND_THEN", "OR_ELSE"):
            left = self.value(node.left, env, here)
            if node.operator == "AND_THEN":
                return both(left, self.value(node.right, env, both(here, left)))
            return either(left, self.value(node.right, env, both(here, negated(left))))
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
        if conversion(node.name) is not None:
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
        """The result of a FUNCTION of the program's own."""
        inner = self.called(own_arguments(node, unit), unit, node.place, env, here)
        return inner[f"{frame(unit)}{unit.name.upper()}"]

    def called(
        self, arguments: Mapping[str, Expression], unit: Unit, place: Place, env: Env, here: z3.BoolRef
    ) -> Env:
        """All variables after a call of a FUNCTION with these arguments: it begins anew in each call.

        Its own are below `frame`; the others are those of `env`, of which it may have written globals.
        """
        inner, above = dict(env), frame(unit)
        for key, variable in unit.variables.items():
            if variable.section != "external":
                own = singles(variable.type, f"{above}{key}", variable.initial)
                inner |= {path: constant(kind, value) for path, kind, value in own}
        for key, expression in arguments.items():
            terms = self.handed(expression, unit.variables[key].type, place, env, here)
            inner |= {f"{above}{key}{leaf}": term for leaf, term in terms.items()}
        self.translator.call(unit, above, inner, here, self.root)
        return inner

    def converted(
        self, node: Function, argument: Expression, kind: Scalar, env: Env, here: z3.BoolRef
    ) -> Any:
        start = converted_from(node.name)
        given = start or self.types.of(argument)
        term = self.value(argument, env, here, start)
        assert isinstance(given, Scalar)
        term = self.translator.widened(term, self.types.of(argument, start), given)
        if given.numbers:
            place, *others = enumerate(given.numbers)
            found = z3.IntVal(place[1])
            for number, value in others:
                found = z3.If(term == number, z3.IntVal(value), found)
            term = found
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
