"""Terms of a solver as gates of a SAT solver: each value a row of literals, as wide as it must be.

A whole number is in two's complement, with the range in which it is; its width follows from the range, so no
sum overflows. What is constant is folded, and of two gates with the same inputs one is made.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import z3

TRUE, FALSE = 1, -1
"""The literals of the two constants; a literal is a number, denied by its sign."""


class NoGates(Exception):
    """A term that has no gates here: a division, a number without bounds."""


@dataclass(frozen=True)
class Number:
    """A whole number from `low` to `high`: literals in two's complement, the lowest bit first."""

    low: int
    high: int
    bits: tuple[int, ...]

    def bit(self, at: int) -> int:
        """The literal of a bit, also above those that are kept."""
        return self.bits[min(at, len(self.bits) - 1)]


def width(low: int, high: int) -> int:
    """The bits of numbers from `low` to `high` in two's complement."""
    return max(high.bit_length(), (low + 1 if low < 0 else low).bit_length()) + 1


Value = int | Number | tuple[int, ...]
"""The literal of a BOOL, a number, or the literals of a word, the lowest bit first."""


class Gates:
    """Makes gates. add: takes a clause, a row of literals of which one is true."""

    def __init__(self, add: Callable[[list[int]], object]) -> None:
        self.add, self.last = add, TRUE
        self.made: dict[tuple[Any, ...], int] = {}
        add([TRUE])

    def free(self) -> int:
        """A new literal."""
        self.last += 1
        return self.last

    def all_of(self, parts: Iterable[int]) -> int:
        """AND."""
        kept = {part for part in parts if part != TRUE}
        if FALSE in kept or any(-part in kept for part in kept):
            return FALSE
        if len(kept) < 2:
            return kept.pop() if kept else TRUE
        inputs = sorted(kept)
        if (key := ("and", *inputs)) not in self.made:
            out = self.made[key] = self.free()
            for part in inputs:
                self.add([-out, part])
            self.add([out, *(-part for part in inputs)])
        return self.made[key]

    def one_of(self, parts: Iterable[int]) -> int:
        """OR."""
        return -self.all_of(-part for part in parts)

    def unlike(self, left: int, right: int) -> int:
        """XOR."""
        if abs(left) == TRUE or abs(right) == TRUE:
            known, other = (left, right) if abs(left) == TRUE else (right, left)
            return -other if known == TRUE else other
        if abs(left) == abs(right):
            return FALSE if left == right else TRUE
        turned = (left < 0) != (right < 0)
        a, b = sorted((abs(left), abs(right)))
        if (key := ("xor", a, b)) not in self.made:
            out = self.made[key] = self.free()
            for clause in ([-out, a, b], [-out, -a, -b], [out, -a, b], [out, a, -b]):
                self.add(clause)
        return -self.made[key] if turned else self.made[key]

    def choice(self, where: int, yes: int, no: int) -> int:
        """`yes` if `where` is true, else `no`."""
        if where < 0:
            where, yes, no = -where, no, yes
        if where == TRUE or yes == no:
            return yes
        if yes == -no:
            return self.unlike(where, no)
        if abs(yes) == TRUE or yes in (where, -where):
            return self.one_of([where, no]) if yes in (TRUE, where) else self.all_of([-where, no])
        if abs(no) == TRUE or no in (where, -where):
            return self.all_of([where, yes]) if no in (FALSE, where) else self.one_of([-where, yes])
        if turned := yes < 0:
            yes, no = -yes, -no
        key = ("if", where, yes, no)
        if key not in self.made:
            out = self.made[key] = self.free()
            for clause in (
                [-where, -yes, out],
                [-where, yes, -out],
                [where, -no, out],
                [where, no, -out],
                [-yes, -no, out],
                [yes, no, -out],
            ):
                self.add(clause)
        return -self.made[key] if turned else self.made[key]

    # ------------------------------------------------------------ numbers

    def number(self, value: int) -> Number:
        """A constant."""
        bits = tuple(TRUE if value >> at & 1 else FALSE for at in range(width(value, value)))
        return Number(value, value, bits)

    def any_number(self, low: int, high: int) -> Number:
        """A free number within bounds."""
        free = [self.free() for _ in range(width(low, high) - (low >= 0))]
        found = Number(low, high, tuple([*free, FALSE] if low >= 0 else free))
        self.add([self.at_most(self.number(low), found, known=False)])
        self.add([self.at_most(found, self.number(high), known=False)])
        return found

    def at_most(self, left: Number, right: Number, known: bool = True) -> int:
        """`left <= right`. known: their ranges may answer it."""
        if known and left.high <= right.low:
            return TRUE
        if known and left.low > right.high:
            return FALSE
        found, top = TRUE, max(len(left.bits), len(right.bits)) - 1
        for at in range(top + 1):
            a, b = (left.bit(at), right.bit(at)) if at < top else (right.bit(at), left.bit(at))
            found = self.choice(self.unlike(a, b), b, found)
        return found

    def sum(self, left: Number, right: Number) -> Number:
        """Their sum."""
        low, high = left.low + right.low, left.high + right.high
        bits, carry = [], FALSE
        for at in range(width(low, high)):
            a, b = left.bit(at), right.bit(at)
            either = self.unlike(a, b)
            bits.append(self.unlike(either, carry))
            carry = self.choice(either, carry, a)
        return Number(low, high, self._trimmed(low, bits))

    def negative(self, value: Number) -> Number:
        """The number with the other sign."""
        low, high = -value.high, -value.low
        bits, carry = [], TRUE
        for at in range(width(low, high)):
            bit = -value.bit(at)
            bits.append(self.unlike(bit, carry))
            carry = self.all_of([bit, carry])
        return Number(low, high, self._trimmed(low, bits))

    def _trimmed(self, low: int, bits: Sequence[int]) -> tuple[int, ...]:
        return (*bits[:-1], FALSE) if low >= 0 else tuple(bits)

    def same(self, left: Value, right: Value) -> int:
        """Whether two values are equal."""
        if isinstance(left, Number) and isinstance(right, Number):
            if left.high < right.low or right.high < left.low:
                return FALSE
            many = max(len(left.bits), len(right.bits))
            return self.all_of(-self.unlike(left.bit(at), right.bit(at)) for at in range(many))
        if isinstance(left, tuple) and isinstance(right, tuple):
            return self.all_of(-self.unlike(a, b) for a, b in zip(left, right, strict=True))
        assert isinstance(left, int) and isinstance(right, int)
        return -self.unlike(left, right)

    def select(self, where: int, yes: Value, no: Value) -> Value:
        """One of two values of one kind."""
        if where == TRUE or yes is no:
            return yes
        if where == FALSE:
            return no
        if isinstance(yes, Number) and isinstance(no, Number):
            low, high = min(yes.low, no.low), max(yes.high, no.high)
            bits = [self.choice(where, yes.bit(at), no.bit(at)) for at in range(width(low, high))]
            return Number(low, high, tuple(bits))
        if isinstance(yes, tuple) and isinstance(no, tuple):
            return tuple(self.choice(where, a, b) for a, b in zip(yes, no, strict=True))
        assert isinstance(yes, int) and isinstance(no, int)
        return self.choice(where, yes, no)


@dataclass(frozen=True)
class Circuit:
    """Terms in an order in which each comes after its parts: what it is, its parts, a constant."""

    nodes: Sequence[tuple[int, tuple[int, ...], Any]]
    names: Mapping[int, str]
    """The symbols among them."""
    outputs: Mapping[str, int]

    @staticmethod
    def of(terms: Mapping[str, Any]) -> Circuit:
        """The circuit of terms with names. Raises NoGates."""
        numbers: dict[int, int] = {}
        nodes: list[tuple[int, tuple[int, ...], Any]] = []
        names: dict[int, str] = {}
        waiting = list(terms.values())
        while waiting:
            term = waiting[-1]
            if term.get_id() in numbers:
                waiting.pop()
                continue
            children = term.children()
            if left := [child for child in children if child.get_id() not in numbers]:
                waiting += left
                continue
            waiting.pop()
            numbers[term.get_id()] = len(nodes)
            kind, given = term.decl().kind(), None
            if kind == z3.Z3_OP_UNINTERPRETED and not children:
                names[len(nodes)] = term.decl().name()
            elif kind == z3.Z3_OP_ANUM and z3.is_int_value(term):
                given = term.as_long()
            elif kind == z3.Z3_OP_BNUM:
                given = term.as_long(), term.size()
            elif kind in (z3.Z3_OP_EXTRACT, z3.Z3_OP_ZERO_EXT):
                given = tuple(term.params())
            elif kind not in _KINDS or (kind == z3.Z3_OP_DISTINCT and len(children) != 2):
                raise NoGates(f"{term.decl().name()} of {term.sort()}")
            nodes.append((kind, tuple(numbers[child.get_id()] for child in children), given))
        return Circuit(nodes, names, {name: numbers[term.get_id()] for name, term in terms.items()})

    def values(self, gates: Gates, given: Mapping[str, Value]) -> dict[str, Value]:
        """The terms as gates, where the symbols have these values."""
        found: list[Any] = []
        for number, (kind, parts, constant) in enumerate(self.nodes):
            if number in self.names:
                found.append(given[self.names[number]])
            else:
                found.append(_value(gates, kind, [found[part] for part in parts], constant))
        return {name: found[number] for name, number in self.outputs.items()}


_KINDS = {
    *(z3.Z3_OP_TRUE, z3.Z3_OP_FALSE, z3.Z3_OP_AND, z3.Z3_OP_OR, z3.Z3_OP_NOT, z3.Z3_OP_XOR, z3.Z3_OP_IMPLIES),
    *(z3.Z3_OP_ITE, z3.Z3_OP_EQ, z3.Z3_OP_DISTINCT, z3.Z3_OP_LE, z3.Z3_OP_GE, z3.Z3_OP_LT, z3.Z3_OP_GT),
    *(z3.Z3_OP_ADD, z3.Z3_OP_SUB, z3.Z3_OP_UMINUS),
    *(z3.Z3_OP_BAND, z3.Z3_OP_BOR, z3.Z3_OP_BXOR, z3.Z3_OP_BNOT, z3.Z3_OP_CONCAT),
}


def _value(gates: Gates, kind: int, parts: list[Any], given: Any) -> Any:
    match kind:
        case z3.Z3_OP_TRUE:
            return TRUE
        case z3.Z3_OP_FALSE:
            return FALSE
        case z3.Z3_OP_AND:
            return gates.all_of(parts)
        case z3.Z3_OP_OR:
            return gates.one_of(parts)
        case z3.Z3_OP_NOT:
            return -parts[0]
        case z3.Z3_OP_IMPLIES:
            return gates.one_of([-parts[0], parts[1]])
        case z3.Z3_OP_XOR:
            return gates.unlike(parts[0], parts[1])
        case z3.Z3_OP_ITE:
            return gates.select(parts[0], parts[1], parts[2])
        case z3.Z3_OP_EQ:
            return gates.same(parts[0], parts[1])
        case z3.Z3_OP_DISTINCT:
            return -gates.same(parts[0], parts[1])
        case z3.Z3_OP_LE:
            return gates.at_most(parts[0], parts[1])
        case z3.Z3_OP_GE:
            return gates.at_most(parts[1], parts[0])
        case z3.Z3_OP_LT:
            return -gates.at_most(parts[1], parts[0])
        case z3.Z3_OP_GT:
            return -gates.at_most(parts[0], parts[1])
        case z3.Z3_OP_ANUM:
            return gates.number(given)
        case z3.Z3_OP_UMINUS:
            return gates.negative(parts[0])
        case z3.Z3_OP_ADD | z3.Z3_OP_SUB:
            total = parts[0]
            for part in parts[1:]:
                total = gates.sum(total, part if kind == z3.Z3_OP_ADD else gates.negative(part))
            return total
        case z3.Z3_OP_BNUM:
            value, size = given
            return tuple(TRUE if value >> at & 1 else FALSE for at in range(size))
        case z3.Z3_OP_BNOT:
            return tuple(-bit for bit in parts[0])
        case z3.Z3_OP_BAND:
            return tuple(gates.all_of(bits) for bits in zip(*parts, strict=True))
        case z3.Z3_OP_BOR:
            return tuple(gates.one_of(bits) for bits in zip(*parts, strict=True))
        case z3.Z3_OP_BXOR:
            word = parts[0]
            for part in parts[1:]:
                word = tuple(gates.unlike(a, b) for a, b in zip(word, part, strict=True))
            return word
        case z3.Z3_OP_CONCAT:
            return tuple(bit for part in reversed(parts) for bit in part)
        case z3.Z3_OP_EXTRACT:
            high, low = given
            return parts[0][low : high + 1]
        case z3.Z3_OP_ZERO_EXT:
            return parts[0] + (FALSE,) * given[0]
    raise AssertionError(kind)
