"""Relations between the memories of a reference and of a program: the candidates for an invariant.

They are read off values that were met: what all of them fulfil is a candidate. Values that are always equal
form a class, and one of each class stands for the rest, so that there are few candidates; a new value splits
a class.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import z3

Values = dict[str, Any]
"""Plain values: `r:` memory of the reference, `p:` memory of the program, `g:` parameters."""
Column = tuple[Any, ...]
"""The values of one name in all samples."""

MOST_KEYS = 24
"""Entries of a table; more say that the one value does not determine the other."""
KINDS = ("constant", "equal", "unequal", "at most", "at least", "sum", "sum modulo", "least", "table")


@dataclass(frozen=True)
class Relation:
    """One candidate: its kind, the two sides, and a constant, a third name, or the rows of a table."""

    kind: str
    left: str
    right: str = ""
    value: Any = None

    def holds(self, values: Values) -> bool:
        """Whether it is true of plain values."""
        left, right = values[self.left], values[self.right] if self.right else None
        match self.kind:
            case "constant":
                return bool(left == self.value)
            case "equal":
                return bool(left == right)
            case "unequal":
                return bool(left != right)
            case "at most":
                return bool(left <= right)
            case "at least":
                return bool(left >= self.value)
            case "sum":
                return bool(left + right == values[self.value])
            case "sum modulo":
                total, size = self.value
                return bool((left + right - values[total]) % size == 0)
            case "least":
                return bool(left == min(right, values[self.value]))
            case "table":
                return (left, right) in self.value
        raise AssertionError(self.kind)

    def formula(self, term: Callable[[str], Any]) -> z3.BoolRef:
        """The same as a formula over terms."""
        left, right = term(self.left), term(self.right) if self.right else None
        match self.kind:
            case "constant":
                return left == like(left, self.value)
            case "equal":
                return left == right
            case "unequal":
                return left != right
            case "at most":
                return left <= right
            case "at least":
                return left >= self.value
            case "sum":
                return left + right == term(self.value)
            case "sum modulo":
                total, size = self.value
                return (left + right - term(total)) % size == 0
            case "least":
                limit = term(self.value)
                return left == z3.If(right <= limit, right, limit)
            case "table":
                rows = [
                    z3.And(left == like(left, key), right == like(right, value)) for key, value in self.value
                ]
                return z3.Or(rows)
        raise AssertionError(self.kind)

    @property
    def names(self) -> tuple[str, ...]:
        """The values that it speaks of."""
        third = {"sum": self.value, "least": self.value}.get(self.kind)
        if self.kind == "sum modulo":
            third = self.value[0]
        return tuple(name for name in (self.left, self.right, third) if name)

    def __str__(self) -> str:
        match self.kind:
            case "constant":
                return f"{self.left} = {self.value}"
            case "equal":
                return f"{self.left} = {self.right}"
            case "unequal":
                return f"{self.left} <> {self.right}"
            case "at most":
                return f"{self.left} <= {self.right}"
            case "at least":
                return f"{self.left} >= {self.value}"
            case "sum":
                return f"{self.left} + {self.right} = {self.value}"
            case "sum modulo":
                return f"{self.left} + {self.right} = {self.value[0]} modulo {self.value[1]}"
            case "least":
                return f"{self.left} = min({self.right}, {self.value})"
        return f"{self.left}, {self.right}: " + ", ".join(f"{key}, {value}" for key, value in self.value)


def like(term: Any, value: Any) -> Any:
    """A plain value as a term of the sort of another one."""
    if z3.is_bool(term):
        return z3.BoolVal(bool(value))
    return z3.BitVecVal(int(value), term.size()) if z3.is_bv(term) else z3.IntVal(int(value))


def plain(term: Any) -> Any:
    return z3.is_true(term) if z3.is_bool(term) else term.as_long()


@dataclass(frozen=True)
class Vocabulary:
    """What relations may speak of. sorts: the sort of each name. keys: names that tables may begin with.

    sizes: of the program's numbers that wrap, how many values each has.
    """

    sorts: Mapping[str, str]
    keys: Collection[str] = ()
    sizes: Mapping[str, int] | None = None

    def candidates(self, seen: Sequence[Values]) -> list[Relation]:
        """The relations of all kinds that hold in every sample, without those that follow from others."""
        columns: dict[str, Column] = {name: tuple(values[name] for values in seen) for name in self.sorts}
        found, moving = [], {}
        for name, column in columns.items():
            if all(value == column[0] for value in column):
                if not is_parameter(name):
                    found.append(Relation("constant", name, value=column[0]))
            else:
                moving[name] = column
        numbers: dict[str, Column] = {}
        stand_for: dict[str, Column] = {}
        classes: dict[tuple[str, Column], str] = {}
        for name in sorted(moving, key=_rank):
            sort, column = self.sorts[name], moving[name]
            first = classes.get((sort, column))
            opposite = tuple(not value for value in column) if sort == "Bool" else ()
            if first is not None:
                found.append(Relation("equal", name, first))
            elif (sort, opposite) in classes:
                found.append(Relation("unequal", name, classes[sort, opposite]))
            else:
                classes[sort, column] = name
                stand_for[name] = column
                if sort == "Int":
                    numbers[name] = column
        found = [relation for relation in found if not all(map(is_parameter, relation.names))]
        return [*found, *self._numeric(numbers), *self._tables(stand_for)]

    def _numeric(self, numbers: Mapping[str, Column]) -> list[Relation]:
        found = []
        own = [name for name in numbers if not is_parameter(name)]
        for name in own:
            least = min(numbers[name])
            low = next((low for low in (1, 0, -1) if low <= least), None)
            if low is not None:
                found.append(Relation("at least", name, value=low))
        for left, right in itertools.permutations(numbers, 2):
            if is_parameter(left) and is_parameter(right):
                continue
            if all(first <= second for first, second in zip(numbers[left], numbers[right], strict=True)):
                found.append(Relation("at most", left, right))
        for left, right in itertools.combinations(own, 2):
            sums = [first + second for first, second in zip(numbers[left], numbers[right], strict=True)]
            for total, column in numbers.items():
                if total in (left, right):
                    continue
                apart = [first - second for first, second in zip(sums, column, strict=True)]
                size = (self.sizes or {}).get(total, 0)
                if not any(apart):
                    found.append(Relation("sum", left, right, total))
                elif size and not any(rest % size for rest in apart):
                    found.append(Relation("sum modulo", left, right, (total, size)))
        ages = [name for name in own if name.endswith(".age")]
        limits = [name for name in numbers if is_parameter(name) or name.endswith(".PT")]
        for left, age, limit in itertools.product(own, ages, limits):
            rows = zip(numbers[left], numbers[age], numbers[limit], strict=True)
            if left != age and all(value == min(since, most) for value, since, most in rows):
                found.append(Relation("least", left, age, limit))
        return found

    def _tables(self, columns: Mapping[str, Column]) -> list[Relation]:
        found = []
        for left in columns:
            if left not in self.keys:
                continue
            for right, column in columns.items():
                if not right.startswith("p:"):
                    continue
                table: dict[Any, Any] = {}
                pairs = zip(columns[left], column, strict=True)
                told = all(table.setdefault(key, value) == value for key, value in pairs)
                if told and len(table) <= MOST_KEYS:
                    found.append(Relation("table", left, right, tuple(sorted(table.items()))))
        return found


def is_parameter(name: str) -> bool:
    return name.startswith("g:")


def _rank(name: str) -> tuple[int, str]:
    return "grp".index(name[0]), name
