"""Words as whole numbers, for a search that is better with those; a proof found so is asked again over words.

Where a system only compares words and takes one or the other, nothing but their order matters. Each run over
words is then one over numbers, so an invariant over numbers is one over words.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import z3

from programs.invariants.induction import Proof, System, holds_up, spacer_invariant

_ORDERS = {
    z3.Z3_OP_ULEQ: lambda left, right: left <= right,
    z3.Z3_OP_ULT: lambda left, right: left < right,
    z3.Z3_OP_UGEQ: lambda left, right: left >= right,
    z3.Z3_OP_UGT: lambda left, right: left > right,
}
_BACK: Mapping[int, Any] = {
    z3.Z3_OP_LE: z3.ULE,
    z3.Z3_OP_LT: z3.ULT,
    z3.Z3_OP_GE: z3.UGE,
    z3.Z3_OP_GT: z3.UGT,
    z3.Z3_OP_EQ: lambda left, right: left == right,
}


class NoNumbers(Exception):
    """A word is calculated with, or an invariant cannot be said over words."""


def spacer_over_numbers(
    system: System, bad: z3.BoolRef, lemmas: Sequence[z3.BoolRef], seconds: float
) -> Proof | None:
    """A proof by z3's Spacer over numbers, whose invariant was asked again over words; None: it has none in
    that time, or more is done with words than to compare them.
    """
    small, numbers = system.cone(bad, *lemmas), Numbers()
    if not any(map(z3.is_bv, (*small.state.values(), *small.inputs.values()))):
        return None
    try:
        over = numbers.system(small), numbers.forth(bad), [numbers.forth(lemma) for lemma in lemmas]
        invariant = spacer_invariant(*over, seconds)
        if invariant is None:
            return None
        by = "an invariant of z3's Spacer, found with numbers in the place of words"
        proof = Proof(1, [*lemmas, numbers.back(invariant)], by)
        return proof if holds_up(system, bad, proof) else None
    except (NoNumbers, z3.Z3Exception, TimeoutError):
        return None


@dataclass
class Numbers:
    """A system with its words as numbers. words: for the name of each number the word that it stands for."""

    words: dict[str, Any] = field(default_factory=dict)
    _known: dict[int, tuple[Any, Any]] = field(default_factory=dict)

    def system(self, of: System) -> System:
        """The same system over numbers. Raises NoNumbers."""
        state = {path: self.forth(term) for path, term in of.state.items()}
        inputs = {name: self.forth(term) for name, term in of.inputs.items()}
        return System(
            state,
            inputs,
            {path: None if value is None else self.forth(value) for path, value in of.start.items()},
            {path: self.forth(term) for path, term in of.after.items()},
            z3.And(self.forth(of.assumed), *self._ranges(inputs)),
            self.forth(of.inside),
            z3.And(self.forth(of.within), *self._ranges(state)),
        )

    def _ranges(self, terms: Mapping[str, Any]) -> Iterator[z3.BoolRef]:
        for term in terms.values():
            if (word := self.words.get(str(term))) is not None:
                yield z3.And(term >= 0, term < 1 << word.size())

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
            return Sum({str(part): 1})
        if not any(isinstance(child, Sum) for child in children):
            return rebuilt(part, children)
        kind = part.decl().kind()
        sums = [Sum.of(child) for child in children]
        if kind == z3.Z3_OP_MUL and len(sums) == 2:
            left, right = sums if not sums[0].words else reversed(sums)
            if not left.words:
                return right.times(left.more)
        if kind == z3.Z3_OP_ADD:
            return functools.reduce(Sum.plus, sums)
        if kind == z3.Z3_OP_SUB:
            return functools.reduce(Sum.plus, [sums[0], *(one.times(-1) for one in sums[1:])])
        if kind == z3.Z3_OP_UMINUS:
            return sums[0].times(-1)
        if kind in (z3.Z3_OP_EQ, z3.Z3_OP_LE, z3.Z3_OP_LT, z3.Z3_OP_GE, z3.Z3_OP_GT):
            return self._compared(kind, sums[0].plus(sums[1].times(-1)))
        raise NoNumbers(f"{part.decl()}")

    def _compared(self, kind: int, sum: Sum) -> Any:
        """What says of words that a sum is 0, at most 0, and so on."""
        plus = [self.words[name] for name, factor in sum.words.items() if factor == 1]
        minus = [self.words[name] for name, factor in sum.words.items() if factor == -1]
        if len(plus) + len(minus) != len([factor for factor in sum.words.values() if factor]):
            raise NoNumbers("a word times a number")
        match len(plus), len(minus):
            case 0, 0:
                return z3.simplify(_compare(kind, z3.IntVal(sum.more), z3.IntVal(0)))
            case 1, 0:
                return _beside(kind, plus[0], -sum.more)
            case 0, 1:
                return _beside(_TURNED.get(kind, kind), minus[0], sum.more)
            case 1, 1 if abs(sum.more) <= 1:
                # a - b <= -1 is a < b, and a - b < 1 is a <= b; the other way about with >=
                shift = {(z3.Z3_OP_LE, 1): z3.Z3_OP_LT, (z3.Z3_OP_LT, -1): z3.Z3_OP_LE}
                shift |= {(z3.Z3_OP_GE, -1): z3.Z3_OP_GT, (z3.Z3_OP_GT, 1): z3.Z3_OP_GE}
                known = kind if not sum.more else shift.get((kind, sum.more))
                if known is not None:
                    return _BACK[known](plus[0], minus[0])
        raise NoNumbers("words that are added")


_TURNED = {
    z3.Z3_OP_LE: z3.Z3_OP_GE,
    z3.Z3_OP_LT: z3.Z3_OP_GT,
    z3.Z3_OP_GE: z3.Z3_OP_LE,
    z3.Z3_OP_GT: z3.Z3_OP_LT,
}


def _compare(kind: int, left: Any, right: Any) -> Any:
    return {
        z3.Z3_OP_EQ: left == right,
        z3.Z3_OP_LE: left <= right,
        z3.Z3_OP_LT: left < right,
        z3.Z3_OP_GE: left >= right,
        z3.Z3_OP_GT: left > right,
    }[kind]


def _beside(kind: int, word: Any, number: int) -> Any:
    """A word beside a whole number, which may be none that a word can have."""
    most = (1 << word.size()) - 1
    if 0 <= number <= most:
        return _BACK[kind](word, z3.BitVecVal(number, word.size()))
    return z3.simplify(_compare(kind, z3.IntVal(0 if number > most else most), z3.IntVal(number)))


@dataclass(frozen=True)
class Sum:
    """A sum of numbers that stand for words, each with its factor, and of one more."""

    words: Mapping[str, int]
    more: int = 0

    @staticmethod
    def of(value: Any) -> Sum:
        """A sum, or a number. Raises NoNumbers: another term."""
        if isinstance(value, Sum):
            return value
        if z3.is_int_value(value):
            return Sum({}, value.as_long())
        raise NoNumbers(f"{value} beside a word")

    def plus(self, other: Sum) -> Sum:
        """Both together."""
        names = dict.fromkeys((*self.words, *other.words))
        words = {name: self.words.get(name, 0) + other.words.get(name, 0) for name in names}
        return Sum({name: factor for name, factor in words.items() if factor}, self.more + other.more)

    def times(self, factor: int) -> Sum:
        """So many of it."""
        return Sum({name: factor * own for name, own in self.words.items()}, factor * self.more)


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
