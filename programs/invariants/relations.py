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
KINDS = (
    "constant",
    "equal",
    "unequal",
    "at most",
    "at least",
    "up to",
    "sum",
    "sum modulo",
    "least",
    "table",
)


@dataclass(frozen=True)
class Relation:
    """One candidate: its kind, the two sides, and a constant, a third name, or the rows of a table.

    A row is a value of the left side, and that of the right one or the name of the parameter that gives it.
    """

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
            case "up to":
                return bool(left <= self.value)
            case "sum":
                return bool(left + right == values[self.value])
            case "sum modulo":
                total, size = self.value
                return bool((left + right - values[total]) % size == 0)
            case "least":
                return bool(left == min(right, values[self.value]))
            case "table":
                return any(
                    left == key and right == (values[to] if isinstance(to, str) else to)
                    for key, to in self.value
                )
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
            case "up to":
                return left <= self.value
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
                    z3.And(
                        left == like(left, key),
                        right == (term(to) if isinstance(to, str) else like(right, to)),
                    )
                    for key, to in self.value
                ]
                return z3.Or(rows)
        raise AssertionError(self.kind)

    @property
    def names(self) -> tuple[str, ...]:
        """The values that it speaks of."""
        match self.kind:
            case "sum" | "least":
                others = [self.value]
            case "sum modulo":
                others = [self.value[0]]
            case "table":
                others = [to for _, to in self.value if isinstance(to, str)]
            case _:
                others = []
        return tuple(name for name in (self.left, self.right, *others) if name)

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
            case "up to":
                return f"{self.left} <= {self.value}"
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

    sizes: of the program's numbers that wrap, how many values each has. limits: numbers with which the
    program compares, from the smallest on.
    """

    sorts: Mapping[str, str]
    keys: Collection[str] = ()
    sizes: Mapping[str, int] | None = None
    limits: Sequence[int] = ()

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
        return [*found, *self._numeric(numbers), *self._tables(stand_for, moving)]

    def _numeric(self, numbers: Mapping[str, Column]) -> list[Relation]:
        found = []
        own = [name for name in numbers if not is_parameter(name)]
        for name in own:
            least = min(numbers[name])
            low = next((low for low in (1, 0, -1) if low <= least), None)
            if low is not None:
                found.append(Relation("at least", name, value=low))
            high = next((limit for limit in self.limits if limit >= max(numbers[name])), None)
            if high is not None:
                found.append(Relation("up to", name, value=high))
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
        limits = [name for name in numbers if is_parameter(name) or name.endswith(".PT")]
        for left, time, limit in itertools.product(own, own, limits):
            rows = zip(numbers[left], numbers[time], numbers[limit], strict=True)
            if left != time != limit != left and all(
                value == min(since, most) for value, since, most in rows
            ):
                found.append(Relation("least", left, time, limit))
        return found

    def _tables(self, columns: Mapping[str, Column], moving: Mapping[str, Column]) -> list[Relation]:
        found = []
        parameters = [name for name in moving if is_parameter(name)]
        for left in columns:
            if left not in self.keys:
                continue
            for right, column in columns.items():
                if not right.startswith("p:") or right == left:
                    continue
                among = {name: moving[name] for name in parameters if self.sorts[name] == self.sorts[right]}
                table = _table(columns[left], column, among)
                if table is not None:
                    found.append(Relation("table", left, right, table))
        return found


def _table(
    keys: Column, values: Column, parameters: Mapping[str, Column]
) -> tuple[tuple[Any, Any], ...] | None:
    """What each key goes with: a value, else a parameter that had the value each time; None: neither."""
    met: dict[Any, list[int]] = {}
    for number, key in enumerate(keys):
        met.setdefault(key, []).append(number)
    if len(met) > MOST_KEYS:
        return None
    found = []
    for key, numbers in sorted(met.items()):
        value = values[numbers[0]]
        if any(values[number] != value for number in numbers):
            value = next(
                (name for name, column in parameters.items() if all(column[n] == values[n] for n in numbers)),
                None,
            )
            if value is None:
                return None
        found.append((key, value))
    return tuple(found)


def is_parameter(name: str) -> bool:
    return name.startswith("g:")


def _rank(name: str) -> tuple[int, str]:
    return "grp".index(name[0]), name
