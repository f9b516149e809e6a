"""Words as whole numbers, for a search that is better with those; a proof found so is asked again over words.

Where a system only compares words and takes one or the other, nothing but their order matters. Each run over
words is then one over numbers, so an invariant over numbers is one over words.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import z3

from programs.invariants.induction import System

_ORDERS = {
    z3.Z3_OP_ULEQ: lambda left, right: left <= right,
    z3.Z3_OP_ULT: lambda left, right: left < right,
    z3.Z3_OP_UGEQ: lambda left, right: left >= right,
    z3.Z3_OP_UGT: lambda left, right: left > right,
}
_BACK = {
    z3.Z3_OP_LE: z3.ULE,
    z3.Z3_OP_LT: z3.ULT,
    z3.Z3_OP_GE: z3.UGE,
    z3.Z3_OP_GT: z3.UGT,
    z3.Z3_OP_EQ: lambda left, right: left == right,
    z3.Z3_OP_DISTINCT: lambda left, right: left != right,
}


class NoNumbers(Exception):
    """A word is calculated with, or an invariant cannot be said over words."""


@dataclass
class Numbers:
    """A system with its words as numbers. words: for the name of each number the word that it stands for."""

    words: dict[str, Any] = field(default_factory=dict)
    _known: dict[int, tuple[Any, Any]] = field(default_factory=dict)

    def system(self, of: System) -> System:
        """The same system over numbers. Raises NoNumbers."""
        return System(
            {path: self.forth(term) for path, term in of.state.items()},
            {name: self.forth(term) for name, term in of.inputs.items()},
            {path: None if value is None else self.forth(value) for path, value in of.start.items()},
            {path: self.forth(term) for path, term in of.after.items()},
            self.forth(of.assumed),
            self.forth(of.inside),
            self.forth(of.within),
        )

    def forth(self, term: Any) -> Any:
        """A term over numbers. Raises NoNumbers."""
        return self._mapped(term, self._known, self._forth)

    def back(self, term: Any) -> Any:
        """A term over words. Raises NoNumbers."""
        return self._mapped(term, {}, self._back)

    def _mapped(self, term: Any, known: dict[int, tuple[Any, Any]], one: Any) -> Any:
        waiting = [term]
        while waiting:
            part = waiting[-1]
            missing = [child for child in part.children() if child.get_id() not in known]
            if missing and part.get_id() not in known:
                waiting += missing
                continue
            waiting.pop()
            if part.get_id() not in known:
                known[part.get_id()] = (
                    part,
                    one(part, [known[child.get_id()][1] for child in part.children()]),
                )
        return known[term.get_id()][1]

    def _forth(self, part: Any, children: list[Any]) -> Any:
        kind = part.decl().kind()
        if z3.is_bv_value(part):
            return z3.IntVal(part.as_long())
        if z3.is_bv(part) and z3.is_const(part):
            number = z3.Int(f"{part} as a number")
            self.words[str(number)] = part
            return number
        if kind == z3.Z3_OP_BV2INT:
            return children[0]
        if kind in _ORDERS:
            return _ORDERS[kind](*children)
        if z3.is_bv(part) and kind != z3.Z3_OP_ITE:
            raise NoNumbers(f"{part.decl()}")
        if any(map(z3.is_bv, part.children())) and kind not in (z3.Z3_OP_EQ, z3.Z3_OP_ITE, z3.Z3_OP_DISTINCT):
            raise NoNumbers(f"{part.decl()}")
        return rebuilt(part, children)

    def _back(self, part: Any, children: list[Any]) -> Any:
        if z3.is_const(part) and str(part) in self.words:
            return self.words[str(part)]
        sizes = {child.size() for child in children if z3.is_bv(child)}
        if not sizes:
            return rebuilt(part, children)
        kind = part.decl().kind()
        if kind not in _BACK or len(children) != 2 or len(sizes) > 1:
            raise NoNumbers(f"{part.decl()}")
        left, right = (_word(child, *sizes) for child in children)
        return _BACK[kind](left, right)


def _word(value: Any, size: int) -> Any:
    """A number that a word is compared with, as a word."""
    if z3.is_bv(value):
        return value
    if z3.is_int_value(value) and 0 <= value.as_long() < 1 << size:
        return z3.BitVecVal(value.as_long(), size)
    raise NoNumbers(f"{value}")


def rebuilt(part: Any, children: Iterable[Any]) -> Any:
    """The same operation on other terms."""
    children = list(children)
    if not children:
        return part
    kind = part.decl().kind()
    match kind:
        case z3.Z3_OP_EQ:
            return children[0] == children[1]
        case z3.Z3_OP_ITE:
            return z3.If(*children)
        case z3.Z3_OP_DISTINCT:
            return z3.Distinct(*children)
        case z3.Z3_OP_AND:
            return z3.And(children)
        case z3.Z3_OP_OR:
            return z3.Or(children)
    return part.decl()(*children)
