"""Expressions of demands over terms of a solver: what is known is computed, the rest becomes a term.

A value is a plain bool, number or text of Python, a term, a `Text`, or a list (`Items`). So the same code
runs with plain values. The notation is that of modeproof.kit.demands, whose `Watch` is another reading of it.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, reduce
from typing import Any

import z3

from modeproof.ground.errors import Unjudged


@dataclass(frozen=True)
class Text:
    """One of a signal's texts: their number in its list, -1 for an empty one that is not in it."""

    term: Any
    values: tuple[str, ...]

    def number(self, text: str) -> int | None:
        """The number of a text; None: this can never be that text."""
        return self.values.index(text) if text in self.values else None if text else -1


@dataclass(frozen=True)
class Items:
    """A list. Each entry has the condition under which it is there."""

    entries: tuple[tuple[Any, Any], ...]

    @staticmethod
    def of(values: Sequence[Any]) -> Items:
        """A list of these values."""
        return Items(tuple((True, value) for value in values))

    @property
    def whole(self) -> bool:
        """Whether every entry is there."""
        return all(there is True for there, _ in self.entries)

    @property
    def length(self) -> Any:
        """How many entries are there."""
        return total([there for there, _ in self.entries])

    def ranked(self) -> list[tuple[Any, Any, Any]]:
        """Each entry: whether it is there, its place in the list, its value."""
        found, place = [], 0
        for there, value in self.entries:
            found.append((there, place, value))
            place = plus(place, number(there))
        return found


# ---------------------------------------------------------------- terms that are known are computed


def negated(value: Any) -> Any:
    """NOT."""
    return not value if isinstance(value, bool) else z3.Not(value)


def every(*values: Any) -> Any:
    """AND."""
    left = [value for value in values if value is not True]
    if any(value is False for value in left):
        return False
    return True if not left else left[0] if len(left) == 1 else z3.And(left)


def some(*values: Any) -> Any:
    """OR."""
    left = [value for value in values if value is not False]
    if any(value is True for value in left):
        return True
    return False if not left else left[0] if len(left) == 1 else z3.Or(left)


def _is_bool(value: Any) -> bool:
    return isinstance(value, bool | z3.BoolRef)


def _is_number(value: Any) -> bool:
    return type(value) is int or isinstance(value, z3.ArithRef)


def number(value: Any) -> Any:
    """A value as a number, as Python has it. Raises TypeError: it is none."""
    if isinstance(value, bool):
        return int(value)
    if isinstance(value, z3.BoolRef):
        return z3.If(value, z3.IntVal(1), z3.IntVal(0))
    if isinstance(value, z3.BitVecRef):
        return z3.BV2Int(value)
    if _is_number(value):
        return value
    raise TypeError(f"{value} is no number")


def plus(left: Any, right: Any) -> Any:
    """The sum."""
    if type(right) is int and right == 0:
        return left
    return right if type(left) is int and left == 0 else left + right


def total(values: Sequence[Any]) -> Any:
    """The sum of numbers and bools."""
    return reduce(plus, (number(value) for value in values), 0)


def true(value: Any) -> Any:
    """Whether a value counts as true."""
    if _is_bool(value):
        return value
    if isinstance(value, Items):
        return some(*(there for there, _ in value.entries))
    if isinstance(value, Text):
        return negated(equal(value, ""))
    return negated(equal(value, 0)) if not isinstance(value, str) else bool(value)


def _alike(left: Any, right: Any) -> tuple[Any, Any]:
    """Both in one sort."""
    if isinstance(left, Text) and isinstance(right, str):
        return left, Text(left.number(right), left.values)
    if isinstance(right, Text) and isinstance(left, str):
        return Text(right.number(left), right.values), right
    if _is_bool(left) and _is_bool(right):
        return left, right
    words = [isinstance(side, z3.BitVecRef) for side in (left, right)]
    if any(words):
        if all(words):
            return left, right
        word, other = (left, right) if words[0] else (right, left)
        if type(other) is int and 0 <= other < 1 << word.size():
            other = z3.BitVecVal(other, word.size())
            return (word, other) if words[0] else (other, word)
    return number(left), number(right)


def equal(left: Any, right: Any) -> Any:
    """Whether two values are the same."""
    if isinstance(left, Items) and isinstance(right, Items):
        rows = [
            some(negated(there), equal(value, nth(right, place)[0])) for there, place, value in left.ranked()
        ]
        return every(equal(left.length, right.length), *rows)
    if isinstance(left, Items) or isinstance(right, Items):
        return False
    if isinstance(left, str) and isinstance(right, str):
        return left == right
    if isinstance(left, str | Text) != isinstance(right, str | Text):
        return False
    one, other = _alike(left, right)
    if isinstance(one, z3.ArithRef) and z3.is_app_of(one, z3.Z3_OP_BV2INT) and type(other) is int:
        return False  # a word is never this number
    if isinstance(other, z3.ArithRef) and z3.is_app_of(other, z3.Z3_OP_BV2INT) and type(one) is int:
        return False
    if isinstance(one, Text):
        if one.values != other.values:
            raise TypeError("texts of two signals are compared")
        if one.term is None or other.term is None:
            return False
        one, other = one.term, other.term
    if not isinstance(one, z3.ExprRef) and not isinstance(other, z3.ExprRef):
        return one == other
    if one is True or other is True:
        return other if one is True else one
    if one is False or other is False:
        return negated(other if one is False else one)
    return one == other


def choose(condition: Any, yes: Any, no: Any) -> Any:
    """One of two values."""
    if isinstance(condition, bool):
        return yes if condition else no
    if yes is no:
        return yes
    if isinstance(yes, Items) and isinstance(no, Items):
        if yes.whole and no.whole and len(yes.entries) == len(no.entries):
            pairs = zip(yes.entries, no.entries, strict=True)
            return Items.of([choose(condition, one, other) for (_, one), (_, other) in pairs])
        return Items(
            (
                *((every(condition, there), value) for there, value in yes.entries),
                *((every(negated(condition), there), value) for there, value in no.entries),
            )
        )
    one, other = _alike(yes, no)
    if isinstance(one, Text):
        if one.values != other.values or one.term is None or other.term is None:
            raise TypeError("texts of two signals are joined")
        return Text(choose(condition, one.term, other.term), one.values)
    if _is_bool(one):
        if one is True or other is False:
            return some(condition, other) if one is True else every(condition, one)
        if one is False or other is True:
            return every(negated(condition), other) if one is False else some(negated(condition), one)
    return z3.If(condition, one, other)


def nth(items: Items, place: Any) -> tuple[Any, Any]:
    """The entry at a place, and whether there is one."""
    if type(place) is int and items.whole:
        there = -len(items.entries) <= place < len(items.entries)
        return (items.entries[place][1] if there else 0), there
    place = choose(less(place, 0), plus(number(place), items.length), number(place))
    found: Any = None
    known: Any = False
    for there, at, value in items.ranked():
        here = every(there, equal(place, at))
        found = value if found is None else choose(here, value, found)
        known = some(known, here)
    return (0 if found is None else found), known


def less(left: Any, right: Any, or_equal: bool = False) -> Any:
    """Whether the left value is smaller."""
    one, other = _alike(left, right)
    if isinstance(one, z3.BitVecRef) and isinstance(other, z3.BitVecRef):
        return z3.ULE(one, other) if or_equal else z3.ULT(one, other)
    one, other = number(one), number(other)
    return one <= other if or_equal else one < other


def within(value: Any, items: Any) -> Any:
    """Whether a list has a value."""
    if not isinstance(items, Items):
        raise TypeError("`in` needs a list")
    return some(*(every(there, equal(one, value)) for there, one in items.entries))


# ---------------------------------------------------------------- functions


def _count(values: Sequence[Any]) -> Any:
    return total([true(value) for value in values])


def _index(items: Items, value: Any) -> Any:
    found: Any = -1
    for there, place, one in reversed(items.ranked()):
        found = choose(every(there, equal(one, value)), place, found)
    return found


def _extreme(values: Sequence[Any], most: bool) -> tuple[Any, Any]:
    """The largest or smallest, and whether there is one."""
    entries = values[0].entries if len(values) == 1 else Items.of(values).entries
    if all(_is_bool(value) for _, value in entries):
        if most:
            best = some(*(every(there, value) for there, value in entries))
        else:
            best = every(*(some(negated(there), value) for there, value in entries))
        return best, some(*(there for there, _ in entries))
    found: Any = 0
    known: Any = False
    for there, value in entries:
        better = less(found, value) if most else less(value, found)
        found = choose(every(there, some(negated(known), better)), value, found)
        known = some(known, there)
    return found, known


# ---------------------------------------------------------------- expressions


@cache
def parsed(text: str) -> ast.expr:
    """The expression of a text that the kit has accepted."""
    return ast.parse(text, mode="eval").body


class Evaluation:
    """Evaluates expressions in one scan. `wrong`: the conditions under which one of them has no value."""

    def __init__(self, names: Mapping[str, Any]) -> None:
        self.names = dict(names)
        self.wrong: list[Any] = []

    def value(self, text: str, where: str, here: Any = True) -> Any:
        """What an expression gives, looked at where `here` is true.

        Raises Unjudged: it is none of those that can be put into terms.
        """
        try:
            return self._of(parsed(text), here)
        except (TypeError, AttributeError, KeyError, IndexError, z3.Z3Exception) as error:
            raise Unjudged(f"{where}: {error}: {text}") from None

    def _owe(self, here: Any, known: Any) -> None:
        wrong = every(here, negated(known))
        if wrong is not False:
            self.wrong.append(wrong)

    def _of(self, node: ast.expr, here: Any) -> Any:
        """The value of an expression that is looked at where `here` is true."""
        match node:
            case ast.Constant(value):
                return value
            case ast.Name(id):
                return self.names[id]
            case ast.List(elements):
                return Items.of([self._of(element, here) for element in elements])
            case ast.BoolOp(operator, values):
                return self._joined(isinstance(operator, ast.And), values, here)
            case ast.UnaryOp(ast.Not(), operand):
                return negated(true(self._of(operand, here)))
            case ast.UnaryOp(_, operand):
                return -number(self._of(operand, here))
            case ast.BinOp(left, operator, right):
                one, other = self._of(left, here), self._of(right, here)
                if isinstance(one, Items) and isinstance(other, Items) and isinstance(operator, ast.Add):
                    return Items((*one.entries, *other.entries))
                one, other = number(one), number(other)
                return one + other if isinstance(operator, ast.Add) else one - other
            case ast.IfExp(test, body, orelse):
                asked = true(self._of(test, here))
                if isinstance(asked, bool):
                    return self._of(body if asked else orelse, here)
                yes = self._of(body, every(here, asked))
                return choose(asked, yes, self._of(orelse, every(here, negated(asked))))
            case ast.Subscript(of, place):
                found, known = nth(self._of(of, here), self._of(place, here))
                self._owe(here, known)
                return found
            case ast.Compare(left, operators, rights):
                return self._compared(left, operators, rights, here)
            case ast.Call(ast.Name(function), arguments):
                return self._call(function, [self._of(argument, here) for argument in arguments], here)
        raise TypeError(f"{type(node).__name__} is not for demands")

    def _joined(self, conjunction: bool, nodes: Sequence[ast.expr], here: Any) -> Any:
        first = self._of(nodes[0], here)
        if len(nodes) == 1:
            return first
        goes_on = true(first) if conjunction else negated(true(first))
        if goes_on is False:
            return first
        rest = self._joined(conjunction, nodes[1:], every(here, goes_on))
        return choose(goes_on, rest, first)

    def _compared(
        self, left: ast.expr, operators: Sequence[ast.cmpop], rights: Sequence[ast.expr], here: Any
    ) -> Any:
        one, found = self._of(left, here), True
        for operator, right in zip(operators, rights, strict=True):
            other = self._of(right, every(here, found))
            found = every(found, COMPARE[type(operator)](one, other))
            one = other
        return found

    def _call(self, function: str, values: Sequence[Any], here: Any) -> Any:
        match function:
            case "count":
                return _count(values)
            case "index":
                return _index(*values)
            case "len":
                return values[0].length
            case "sum":
                entries = values[0].entries
                return total([choose(there, number(value), 0) for there, value in entries])
        found, known = _extreme(values, function == "max")
        self._owe(here, known)
        return found


COMPARE: Mapping[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: equal,
    ast.NotEq: lambda left, right: negated(equal(left, right)),
    ast.Lt: less,
    ast.LtE: lambda left, right: less(left, right, True),
    ast.Gt: lambda left, right: less(right, left),
    ast.GtE: lambda left, right: less(right, left, True),
    ast.In: within,
    ast.NotIn: lambda value, items: negated(within(value, items)),
}
