"""Symbolic values: flags, words, numbers and texts that the code may compare, and nothing else.

A *symbol* (`Flag`, `Word`, `Number`, `Text`) is a solver term with its range. While the code runs, a *proxy*
stands for each symbol. Comparing proxies gives a symbolic truth value; asking for that truth (`if`, `and`,
`or`, `not`) takes a decision. Everything that would need the value itself raises ConcretizationError, and the
run remembers it, so that a `try` in the code cannot hide it.

Not noticed by any proxy: `is`, `isinstance`, `type(x)`, and `match` on None, True or False. For these there
is `lint`.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, NoReturn, Protocol

import z3

WORD_BITS = 16


class Run(Protocol):
    """What a proxy needs of the run that it belongs to."""

    def decide(self, question: z3.BoolRef) -> bool:
        """The truth of the question on this path."""

    def refuse(self, why: str) -> NoReturn:
        """Remember the refusal and raise ConcretizationError."""

    def spoken(self) -> None:
        """Remember that a symbolic value was turned into text, which only an error message may do."""

    def made(self, make: Callable[[Any, Any], Any], left: Any, right: Any) -> Any:
        """What `make` makes of two terms; every run of the same code asks for it again."""


# ---------------------------------------------------------------- symbols


@dataclass(frozen=True)
class Flag:
    """A free boolean."""

    term: z3.BoolRef

    @property
    def premise(self) -> z3.BoolRef:
        """Its range: everything."""
        return z3.BoolVal(True)

    def proxy(self, run: Run) -> Proxy:
        """What stands for it in a run."""
        return FlagProxy(self.term, run)

    def python(self, value: z3.ExprRef) -> bool:
        """The Python value of a value of the solver."""
        return bool(z3.is_true(value))


@dataclass(frozen=True)
class Word:
    """A 16-bit word low..high as a bit vector, or, `signed`, a number -32768..32767.

    Words can be compared, and joined bit by bit; adding them is refused, for the sum might be no word.
    """

    term: z3.BitVecRef
    low: int = 0
    high: int = 0xFFFF
    signed: bool = False

    @property
    def premise(self) -> z3.BoolRef:
        """Its range."""
        if self.signed or (self.low, self.high) == (0, 0xFFFF):
            return z3.BoolVal(True)
        return z3.And(z3.UGE(self.term, self.low), z3.ULE(self.term, self.high))

    def proxy(self, run: Run) -> Proxy:
        """What stands for it in a run."""
        return WordProxy(self.term, run, self.signed)

    def python(self, value: z3.ExprRef) -> int:
        """The Python value of a value of the solver."""
        number: int = value.as_signed_long() if self.signed else value.as_long()
        return number


@dataclass(frozen=True)
class Number:
    """An integer low..high; None means no upper limit. Levels, modes and times."""

    term: z3.ArithRef
    low: int
    high: int | None

    @property
    def premise(self) -> z3.BoolRef:
        """Its range."""
        if self.high is None:
            return self.term >= self.low
        return z3.And(self.term >= self.low, self.term <= self.high)

    def proxy(self, run: Run) -> Proxy:
        """What stands for it in a run."""
        return NumberProxy(self.term, run)

    def python(self, value: z3.ExprRef) -> int:
        """The Python value of a value of the solver."""
        number: int = value.as_long()
        return number


@dataclass(frozen=True)
class Text:
    """One of the given texts; its term is the position in the list."""

    term: z3.ArithRef
    values: tuple[str, ...]

    @property
    def premise(self) -> z3.BoolRef:
        """Its range."""
        return z3.And(self.term >= 0, self.term < len(self.values))

    def proxy(self, run: Run) -> Proxy:
        """What stands for it in a run."""
        return TextProxy(self.term, run, self.values)

    def python(self, value: z3.ExprRef) -> str:
        """The Python value of a value of the solver."""
        return self.values[int(value.as_long())]


Symbol = Flag | Word | Number | Text


@dataclass(frozen=True)
class Opaque:
    """A value that the code may hand on and must not look at, such as a function that is a parameter."""

    name: str


# ---------------------------------------------------------------- proxies


class Proxy:
    """A symbolic value in a run. Everything that a kind of value does not allow is refused here."""

    __slots__ = ("_run", "term")

    what = "a symbolic value"

    def __init__(self, term: z3.ExprRef, run: Run) -> None:
        self.term = term
        self._run = run

    def __repr__(self) -> str:
        self._run.spoken()
        return f"<symbolic {self.term}>"

    def __getattr__(self, name: str) -> NoReturn:
        self._run.refuse(f"{self.what} is asked for its attribute {name!r}; only compare it")

    def _number(self, other: object) -> z3.ExprRef:
        self._run.refuse(f"{self.what} is compared with {_shown(other)}")

    def __eq__(self, other: object) -> FlagProxy:  # type: ignore[override]
        return FlagProxy(self._run.made(operator.eq, self.term, self._number(other)), self._run)

    def __ne__(self, other: object) -> FlagProxy:  # type: ignore[override]
        return FlagProxy(self._run.made(operator.ne, self.term, self._number(other)), self._run)


@cache
def _constant(make: Callable[[Any], Any], value: bool | int) -> Any:
    """A plain value as a term."""
    return make(value)


def _word(value: int) -> z3.BitVecNumRef:
    return z3.BitVecVal(value, WORD_BITS)


def _shown(value: object) -> str:
    return value.what if isinstance(value, Proxy) else f"{value!r} ({type(value).__name__})"


def _refusal(name: str, advice: str) -> Callable[..., NoReturn]:
    def refused(self: Proxy, *_: object, **__: object) -> NoReturn:
        self._run.refuse(f"{self.what} is used in {name}; {advice}")

    return refused


REFUSED = {
    "bool()": ("__bool__", "write a comparison instead, such as x != 0"),
    "hash()": ("__hash__", "compare with == instead of looking it up"),
    "int()": ("__int__", "keep the value as it is"),
    "float()": ("__float__", "times are whole numbers"),
    "complex()": ("__complex__", "keep the value as it is"),
    "an index": ("__index__", "write one comparison for each position"),
    "round()": ("__round__", "times are whole numbers"),
    "trunc()": ("__trunc__", "times are whole numbers"),
    "floor()": ("__floor__", "times are whole numbers"),
    "ceil()": ("__ceil__", "times are whole numbers"),
    "len()": ("__len__", "only compare it"),
    "a loop": ("__iter__", "only compare it"),
    "in": ("__contains__", "compare with == instead"),
    "[]": ("__getitem__", "only compare it"),
    "a call": ("__call__", "only compare it"),
    "str()": ("__str__", "texts are for error messages alone"),
    "a format": ("__format__", "texts are for error messages alone"),
    "bytes()": ("__bytes__", "only compare it"),
    "abs()": ("__abs__", "compare and subtract"),
    "~": ("__invert__", "only compare it"),
    "unary -": ("__neg__", "subtract"),
    "unary +": ("__pos__", "leave it out"),
    "divmod()": ("__divmod__", "only +, - and comparisons"),
    "reflected divmod()": ("__rdivmod__", "only +, - and comparisons"),
    "copying": ("__reduce_ex__", "hand the value on itself"),
    **{
        sign: (f"__{name}__", f"{advice}")
        for sign, name, advice in (
            ("<", "lt", "compare with =="),
            ("<=", "le", "compare with =="),
            (">", "gt", "compare with =="),
            (">=", "ge", "compare with =="),
        )
    },
    **{
        f"{side} {sign}".strip(): (f"__{mark}{name}__", "only comparisons, and + and - of numbers")
        for sign, name in (
            ("+", "add"),
            ("-", "sub"),
            ("*", "mul"),
            ("/", "truediv"),
            ("//", "floordiv"),
            ("%", "mod"),
            ("**", "pow"),
            ("<<", "lshift"),
            (">>", "rshift"),
            ("&", "and"),
            ("|", "or"),
            ("^", "xor"),
            ("@", "matmul"),
        )
        for side, mark in (("", ""), ("reflected", "r"))
    },
}
"""What a value refuses unless its kind allows it: how a reader would call it, the method, what to write."""

for _name, (_method, _advice) in REFUSED.items():
    setattr(Proxy, _method, _refusal(_name, _advice))


class FlagProxy(Proxy):
    """A symbolic truth value: may be decided on, and compared with another one."""

    __slots__ = ()
    what = "a symbolic flag"

    def __bool__(self) -> bool:
        return self._run.decide(self.term)

    def _number(self, other: object) -> z3.ExprRef:
        if isinstance(other, FlagProxy):
            return other.term
        if type(other) is bool:
            return _constant(z3.BoolVal, other)
        return super()._number(other)


class WordProxy(Proxy):
    """A symbolic word: compared, and joined by `&`, `|`, `^`, which are exact on words."""

    __slots__ = ("_signed",)
    what = "a symbolic word"

    def __init__(self, term: z3.BitVecRef, run: Run, signed: bool) -> None:
        super().__init__(term, run)
        self._signed = signed

    def _number(self, other: object) -> z3.ExprRef:
        if isinstance(other, WordProxy) and other._signed == self._signed:
            return other.term
        low, high = (-0x8000, 0x7FFF) if self._signed else (0, 0xFFFF)
        if type(other) is int and low <= other <= high:
            return _constant(_word, other)
        return super()._number(other)

    def _ordered(
        self, other: object, signed: Callable[[Any, Any], Any], unsigned: Callable[[Any, Any], Any]
    ) -> FlagProxy:
        order = signed if self._signed else unsigned
        return FlagProxy(self._run.made(order, self.term, self._number(other)), self._run)

    def __lt__(self, other: object) -> FlagProxy:
        return self._ordered(other, operator.lt, z3.ULT)

    def __le__(self, other: object) -> FlagProxy:
        return self._ordered(other, operator.le, z3.ULE)

    def __gt__(self, other: object) -> FlagProxy:
        return self._ordered(other, operator.gt, z3.UGT)

    def __ge__(self, other: object) -> FlagProxy:
        return self._ordered(other, operator.ge, z3.UGE)

    def _joined(self, make: Callable[[Any, Any], Any], other: object) -> WordProxy:
        return WordProxy(self._run.made(make, self.term, self._number(other)), self._run, self._signed)

    def __and__(self, other: object) -> WordProxy:
        return self._joined(operator.and_, other)

    def __or__(self, other: object) -> WordProxy:
        return self._joined(operator.or_, other)

    def __xor__(self, other: object) -> WordProxy:
        return self._joined(operator.xor, other)

    __rand__ = __and__
    __ror__ = __or__
    __rxor__ = __xor__


class NumberProxy(Proxy):
    """A symbolic integer: compared, added, subtracted; as exact as Python's own."""

    __slots__ = ()
    what = "a symbolic number"

    def _number(self, other: object) -> z3.ExprRef:
        if isinstance(other, NumberProxy):
            return other.term
        if type(other) is int:
            return _constant(z3.IntVal, other)
        return super()._number(other)

    def _ordered(self, order: Callable[[Any, Any], Any], other: object) -> FlagProxy:
        return FlagProxy(self._run.made(order, self.term, self._number(other)), self._run)

    def _sum(self, make: Callable[[Any, Any], Any], left: Any, right: Any) -> NumberProxy:
        return NumberProxy(self._run.made(make, left, right), self._run)

    def __lt__(self, other: object) -> FlagProxy:
        return self._ordered(operator.lt, other)

    def __le__(self, other: object) -> FlagProxy:
        return self._ordered(operator.le, other)

    def __gt__(self, other: object) -> FlagProxy:
        return self._ordered(operator.gt, other)

    def __ge__(self, other: object) -> FlagProxy:
        return self._ordered(operator.ge, other)

    def __add__(self, other: object) -> NumberProxy:
        return self._sum(operator.add, self.term, self._number(other))

    def __sub__(self, other: object) -> NumberProxy:
        return self._sum(operator.sub, self.term, self._number(other))

    def __rsub__(self, other: object) -> NumberProxy:
        return self._sum(operator.sub, self._number(other), self.term)

    def __neg__(self) -> NumberProxy:
        return NumberProxy(-self.term, self._run)

    __radd__ = __add__


class TextProxy(Proxy):
    """A symbolic text: compared with texts that it can be."""

    __slots__ = ("_values",)
    what = "a symbolic text"

    def __init__(self, term: z3.ArithRef, run: Run, values: tuple[str, ...]) -> None:
        super().__init__(term, run)
        self._values = values

    def _number(self, other: object) -> z3.ExprRef:
        if isinstance(other, TextProxy) and other._values == self._values:
            return other.term
        if type(other) is str and other in self._values:
            return _constant(z3.IntVal, self._values.index(other))
        return super()._number(other)


for _kind in (
    FlagProxy,
    WordProxy,
    NumberProxy,
    TextProxy,
):  # a class that defines == loses the inherited hash
    _kind.__hash__ = Proxy.__hash__  # type: ignore[method-assign]


# ---------------------------------------------------------------- free symbols by name


def flag(name: str) -> Flag:
    """A free boolean with this name."""
    return Flag(z3.Bool(name))


def word(name: str, low: int = 0, high: int = 0xFFFF) -> Word:
    """A free word low..high with this name."""
    return Word(z3.BitVec(name, WORD_BITS), low, high)


def number(name: str, low: int, high: int | None = None) -> Number:
    """A free integer low..high with this name; None means no upper limit."""
    return Number(z3.Int(name), low, high)


def text(name: str, values: tuple[str, ...]) -> Text:
    """A free choice among the texts with this name."""
    return Text(z3.Int(name), values)
