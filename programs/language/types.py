"""Types within a unit: what every name and expression is, and the refusal of what is not in the subset."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from modeproof.ground.errors import suggestion
from programs.language.calls import own_arguments
from programs.language.constants import Known, constant_of, known
from programs.language.standard_blocks import BLOCKS, FUNCTIONS, SHIFTS, arguments, conversion
from programs.language.tree import (
    BOOL,
    SCALARS,
    TIME,
    Array,
    Binary,
    Bit,
    Expression,
    Function,
    Index,
    Instance,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Source,
    Struct,
    Type,
    Unary,
    Unit,
)

_COMPARE = ("=", "<>", "<", "<=", ">", ">=")


@dataclass(frozen=True)
class Types:
    """The types within one unit."""

    source: Source
    unit: Unit
    known: dict[Any, tuple[Any, Any]] = field(default_factory=dict, compare=False, repr=False)
    """What was found for an expression, by its identity; the expression is kept, so no other gets it."""

    def enum_member(self, expression: Expression) -> tuple[Scalar, int] | None:
        """The enumeration and the number of a name that is a member of one and no variable."""
        if not isinstance(expression, Name | Member):
            return None
        key = ("member", id(expression))
        if key not in self.known:
            self.known[key] = expression, self._enum_member(expression)
        return self.known[key][1]  # type: ignore[no-any-return]

    def _enum_member(self, expression: Expression) -> tuple[Scalar, int] | None:
        if isinstance(expression, Name) and expression.name.upper() not in self.unit.variables:
            found = {
                kind: number
                for kind in self._enumerations()
                if (number := kind.member(expression.name)) is not None
            }
            if len(found) > 1:
                shown = " or ".join(f"{kind.name}.{expression.name}" for kind in found)
                raise expression.place.refuse(f"{expression.name}: which enumeration is meant? {shown}")
            return next(iter(found.items()), None)
        if isinstance(expression, Member) and isinstance(expression.of, Name):
            for kind in self._enumerations():
                number = kind.member(expression.name)
                if kind.name.upper() == expression.of.name.upper() and number is not None:
                    variable = self.unit.variables.get(kind.name.upper())
                    if variable is not None and isinstance(variable.type, Instance):
                        raise expression.place.refuse(f"{kind.name} is a type and an instance; rename one")
                    return kind, number
        return None

    def _enumerations(self) -> Iterator[Scalar]:
        for kind in (*self.unit.enumerations.values(), *(v.type for v in self.unit.variables.values())):
            if isinstance(kind, Scalar) and kind.kind == "enum":
                yield kind

    def of(self, expression: Expression, wanted: Scalar | None = None) -> Type:
        """The type of an expression; a bare number takes the type that is wanted.

        One calculates with a subrange as with its base.
        """
        found = self.declared(expression, (wanted and wanted.base) or wanted)
        return found.base if isinstance(found, Scalar) and found.base is not None else found

    def declared(self, expression: Expression, wanted: Scalar | None = None) -> Type:
        """The type of an expression; that of a variable as it is declared."""
        key = id(expression), id(wanted)
        if key not in self.known:
            self.known[key] = (expression, wanted), self._of(expression, wanted)
        return self.known[key][1]  # type: ignore[no-any-return]

    def _of(self, expression: Expression, wanted: Scalar | None) -> Type:
        kind: Type | None
        if (member := self.enum_member(expression)) is not None:
            return member[0]
        match expression:
            case Literal(value, None, place):
                kind = wanted if wanted is not None and wanted.kind in ("int", "bits") else SCALARS["DINT"]
                if wanted is BOOL and value in (0, 1):
                    kind = BOOL
                self.fits(int(value), kind, place)
                return kind
            case Literal(_, kind, _):
                assert kind is not None
                return kind
            case Name(name, place):
                variable = self.unit.variables.get(name.upper())
                if variable is None and name.upper() in self.source.refused:
                    raise self.source.refused[name.upper()]  # such as a data block that cannot be read
                if variable is None:
                    known = [found.name for found in self.unit.variables.values()]
                    raise place.refuse(f"{name} is not declared; {suggestion(name, known)}")
                return variable.type
            case Member(of, name, place):
                return self.member(self.of(of), name, place)
            case Index(of, index, place):
                kind = self.of(of)
                if not isinstance(kind, Array):
                    raise place.refuse("only an array has an index")
                self.scalar(index, place, ("int",))
                return kind.element
            case Bit(of, number, place):
                string = self.scalar(of, place, ("bits",))
                if number >= string.width:
                    raise place.refuse(f"bit {number} is outside {string.name}, 0..{string.width - 1}")
                return BOOL
            case Unary(operator, operand, place):
                kinds = ("bool", "bits") if operator == "NOT" else ("int", "time")
                return self.scalar(operand, place, kinds, wanted)
            case Binary():
                return self.binary(expression, wanted)
            case Function():
                return self.function(expression, wanted)
        raise AssertionError(expression)

    def fits(self, value: int, kind: Scalar, place: Place) -> None:
        """Refuse a number outside the range of its type."""
        if kind.kind in ("int", "bits") and not kind.low <= value <= kind.high:
            raise place.refuse(f"{value} is outside {kind.name}, {kind.low}..{kind.high}")

    def member(self, kind: Type, name: str, place: Place, lent: bool = False) -> Type:
        """The type of a variable of an instance; lent: VAR_IN_OUT as well, which only a call may give."""
        if isinstance(kind, Struct):
            found = kind.member(name)
            if found is None:
                members = [own for own, _, _ in kind.members]
                raise place.refuse(f"{kind.name} has no {name}; {suggestion(name, members)}")
            return found
        if not isinstance(kind, Instance):
            raise place.refuse(f".{name}: only a structure or an instance of a block has members here")
        if kind.block.upper() in BLOCKS:
            known: dict[str, Type] = {
                key: value for group in BLOCKS[kind.block.upper()] for key, value in group.items()
            }
        else:
            unit = self.source.units[kind.block.upper()]
            sections = ("input", "output", "in_out") if lent else ("input", "output")
            known = {name: variable.type for name, variable in unit.of(*sections).items()}
        for key, found in known.items():
            if key.upper() == name.upper():
                return found
        raise place.refuse(f"{kind.block} has no {name}; {suggestion(name, known)}")

    def scalar(
        self, expression: Expression, place: Place, kinds: tuple[str, ...], wanted: Scalar | None = None
    ) -> Scalar:
        """The type of an expression that must be of one of these kinds."""
        kind = self.of(expression, wanted)
        if not isinstance(kind, Scalar) or kind.kind not in kinds:
            shown = kind.name if isinstance(kind, Scalar) else "no single value"
            raise place.refuse(f"a value of kind {' or '.join(kinds)} is needed here, and this is {shown}")
        return kind

    def pair(
        self, left: Expression, right: Expression, place: Place, wanted: Scalar | None
    ) -> tuple[Scalar, Scalar]:
        """The types of two operands; a bare number takes that of the other."""
        every = ("bool", "bits", "int", "time", "enum")
        if isinstance(left, Literal) and left.type is None:
            second = self.scalar(right, place, every, wanted)
            return self.scalar(left, place, every, second), second
        first = self.scalar(left, place, every, wanted)
        return first, self.scalar(right, place, every, first)

    def binary(self, node: Binary, wanted: Scalar | None) -> Scalar:
        if node.operator in _COMPARE:
            first, second = self.pair(node.left, node.right, node.place, None)
            if first.kind != second.kind or (first.kind == "enum" and first != second):
                raise node.place.refuse(f"{first.name} and {second.name} are not compared")
            if first.kind in ("bool", "enum") and node.operator not in ("=", "<>"):
                raise node.place.refuse(f"{node.operator} needs numbers")
            return BOOL
        first, second = self.pair(node.left, node.right, node.place, wanted)
        kinds = {first.kind, second.kind}
        if node.operator in ("AND_THEN", "OR_ELSE") and kinds == {"bool"}:
            return BOOL
        if node.operator in ("AND", "OR", "XOR", "+W", "-W"):
            if kinds == {"bool"} or kinds == {"bits"}:
                return max(first, second, key=lambda kind: kind.high)
        elif node.operator in ("+", "-", "*", "/", "MOD"):
            if kinds == {"int"}:
                wider = max(first, second, key=lambda kind: (kind.high - kind.low, kind.high))
                if min(first.low, second.low) < wider.low or max(first.high, second.high) > wider.high:
                    raise node.place.refuse(
                        f"{node.operator} of {first.name} and {second.name}: compilers differ; convert one"
                    )
                return wider
            if kinds == {"time"} and node.operator in "+-":
                return TIME
            if (first.kind, second.kind) == ("time", "int") and node.operator in "*/":
                return TIME
        advice = "; use BOOL_TO_INT" if kinds == {"bool"} and node.operator in ("+", "-") else ""
        raise node.place.refuse(f"{node.operator} of {first.name} and {second.name} is not supported{advice}")

    def function(self, node: Function, wanted: Scalar | None) -> Scalar:
        place = node.place
        if (unit := self.own_function(node)) is not None:
            return self.own(node, unit)
        ends = conversion(node.name)
        if node.name not in FUNCTIONS and ends is None:
            raise place.refuse(f"function {node.name} is not supported")
        values = arguments(node)
        if node.name == "ABS":
            return self.scalar(values[0], place, ("int",), wanted)
        if node.name in ("MIN", "MAX"):
            first, second = self.pair(values[0], values[1], place, wanted)
            if first != second or first.kind not in ("int", "time"):
                raise place.refuse(f"{node.name} needs two values of one type")
            return first
        if node.name == "LIMIT":
            kinds = [self.scalar(value, place, ("int", "time"), wanted) for value in values]
            if len(set(kinds)) != 1:
                raise place.refuse("LIMIT needs three values of one type")
            return kinds[0]
        if node.name == "SEL":
            self.scalar(values[0], place, ("bool",))
            first, second = self.pair(values[1], values[2], place, wanted)
            if first != second:
                raise place.refuse("SEL needs two values of one type")
            return first
        if node.name in SHIFTS:
            self.scalar(values[1], place, ("int",))
            kind = self.scalar(values[0], place, ("bits",), wanted)
            by = values[1].value if isinstance(values[1], Literal) else 0
            if node.name in ("SHL", "SHR") and by >= kind.width:
                raise place.refuse(
                    f"{node.name} of {kind.name} by {by}: compilers differ from {kind.width} on"
                )
            return kind
        if ends is None:  # MOVE
            return self.scalar(values[0], place, ("bool", "bits", "int", "time", "enum"), wanted)
        start, end = ends
        if end not in SCALARS or (start not in SCALARS and start):
            raise place.refuse(f"conversion {node.name} is not supported")
        return self.conversion(node, values[0], SCALARS.get(start), SCALARS[end])

    def own_function(self, node: Function) -> Unit | None:
        """The FUNCTION of the program's own that is called; None: it is one of the standard."""
        found = self.source.find(node.name)
        return found if found is not None and found.kind == "function" else None

    def own(self, node: Function, unit: Unit) -> Scalar:
        """The type of the result of a FUNCTION, after a look at its arguments."""
        if unit.name.upper() not in unit.variables:
            raise node.place.refuse(f"{unit.name} has no result: call it as a statement")
        if unit.of("in_out"):
            raise node.place.refuse(f"{unit.name} has VAR_IN_OUT: it is called as a statement here")
        for key, expression in own_arguments(node, unit).items():
            wanted = unit.variables[key].type
            assert isinstance(wanted, Scalar)
            given, wanted = self.of(expression, wanted), wanted.base or wanted
            alike = isinstance(given, Scalar) and given.kind == wanted.kind
            if not alike or (wanted.kind == "enum" and given != wanted):
                raise node.place.refuse(f"{unit.variables[key].name} of {unit.name} is of another type")
            assert isinstance(given, Scalar)
            if wanted.kind == "bits" and given.high > wanted.high:
                raise node.place.refuse(f"{unit.variables[key].name} := {given.name} needs a conversion")
        result = unit.variables[unit.name.upper()].type
        assert isinstance(result, Scalar)
        return result.base or result

    def conversion(self, node: Function, value: Expression, start: Scalar | None, end: Scalar) -> Scalar:
        given = self.scalar(value, node.place, ("bool", "bits", "int", "time", "enum"), start)
        if start is not None and (
            given.kind != start.kind or not start.low <= given.low <= given.high <= start.high
        ):
            raise node.place.refuse(f"{node.name} of a {given.name}")
        if given.kind != end.kind and "bool" in (given.kind, end.kind) and end.kind == "bool":
            raise node.place.refuse(f"{node.name} is not supported; compare with 0")
        return end

    def constant(self, expression: Expression) -> int:
        """The value of a member of an enumeration or of a constant expression."""
        if (member := self.enum_member(expression)) is not None:
            return member[1]
        return int(known(expression, self.look).value)

    def look(self, name: Name | Member) -> Known | None:
        """The value of a CONSTANT of this unit."""
        return constant_of(self.unit.variables.get(name.name.upper())) if isinstance(name, Name) else None
