"""Relations between the memories of a reference and of a program: the candidates for an invariant."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import z3

Values = dict[str, Any]
"""Plain values: `r:` memory of the reference, `p:` memory of the program, `g:` parameters."""


@dataclass(frozen=True)
class Relation:
    """One candidate: its kind, the two sides, and a constant, a sum or a table."""

    kind: str
    left: str
    right: str = ""
    value: Any = None

    def holds(self, values: Values) -> bool:
        """Whether it is true of plain values."""
        left = values[self.left]
        match self.kind:
            case "constant":
                return bool(left == self.value)
            case "equal":
                return bool(left == values[self.right])
            case "unequal":
                return bool(left != values[self.right])
            case "at most":
                return bool(left <= values[self.right])
            case "at least":
                return bool(left >= self.value)
            case "sum":
                return bool(left + values[self.right] == values[self.value])
            case "least":
                return bool(left == min(values[self.right], values[self.value]))
            case "table":
                return bool(dict(self.value).get(left, values[self.right]) == values[self.right])
        raise AssertionError(self.kind)

    def formula(self, term: Callable[[str], Any]) -> z3.BoolRef:
        """The same as a formula over terms."""
        left = term(self.left)
        match self.kind:
            case "constant":
                return left == like(left, self.value)
            case "equal":
                return left == term(self.right)
            case "unequal":
                return left != term(self.right)
            case "at most":
                return left <= term(self.right)
            case "at least":
                return left >= self.value
            case "sum":
                return left + term(self.right) == term(self.value)
            case "least":
                age, limit = term(self.right), term(self.value)
                return left == z3.If(age <= limit, age, limit)
        right = term(self.right)
        return z3.And(
            [z3.Implies(left == like(left, key), right == like(right, value)) for key, value in self.value]
        )

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
            case "least":
                return f"{self.left} = min({self.right}, {self.value})"
        return f"{self.right} by {self.left}: " + ", ".join(f"{key}: {value}" for key, value in self.value)


def like(term: Any, value: Any) -> Any:
    """A plain value as a term of the sort of another one."""
    if z3.is_bool(term):
        return z3.BoolVal(bool(value))
    return z3.BitVecVal(int(value), term.size()) if z3.is_bv(term) else z3.IntVal(int(value))


def plain(term: Any) -> Any:
    return z3.is_true(term) if z3.is_bool(term) else term.as_long()


def candidates(seen: Sequence[Values], symbols: Mapping[str, Any]) -> list[Relation]:
    """All relations of the known kinds that hold in every sample."""
    groups: dict[str, list[str]] = defaultdict(list)
    for name, term in symbols.items():
        groups[str(term.sort())].append(name)
    found: list[Relation] = []
    first = seen[0]
    for name in symbols:
        if name.startswith("g:"):
            continue
        relation = Relation("constant", name, value=first[name])
        if _all(relation, seen):
            found.append(relation)
    for sort, names in groups.items():
        free = list(names)
        numbers = sort == "Int"
        for left, right in itertools.combinations(free, 2):
            if left.startswith("g:") and right.startswith("g:"):
                continue
            tries = [Relation("equal", left, right)]
            if sort == "Bool":
                tries.append(Relation("unequal", left, right))
            if numbers:
                tries += [Relation("at most", left, right), Relation("at most", right, left)]
            found += [relation for relation in tries if _all(relation, seen)]
        if numbers:
            own = [name for name in free if not name.startswith("g:")]
            found += [
                Relation("at least", name, value=low)
                for name in own
                for low in (0, -1)
                if _all(Relation("at least", name, value=low), seen)
            ][:200]
            ages = [name for name in own if name.endswith(".age")]
            limits = [name for name in names if name.startswith("g:") or name.endswith(".PT")]
            for left, age, limit in itertools.product(own, ages, limits):
                relation = Relation("least", left, age, limit)
                if left != age and _all(relation, seen):
                    found.append(relation)
            for left, right in itertools.combinations(own, 2):
                for total in names:
                    if total.startswith("g:"):
                        relation = Relation("sum", left, right, total)
                        if _all(relation, seen):
                            found.append(relation)
    keys = [name for name in groups.get("Int", ()) if name.startswith("r:")]
    for left in keys:
        if len({values[left] for values in seen}) > 40:
            continue
        for right in symbols:
            if right.startswith("p:"):
                table: dict[Any, Any] = {}
                if all(table.setdefault(values[left], values[right]) == values[right] for values in seen):
                    found.append(Relation("table", left, right, tuple(sorted(table.items()))))
    return found


def _all(relation: Relation, seen: Iterable[Values]) -> bool:
    return all(relation.holds(values) for values in seen)
