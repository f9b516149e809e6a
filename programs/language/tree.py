"""The language into which PLC programs are read: types, expressions, statements, program units.

Integers have their IEC 61131-3 ranges, bit strings their width, times are whole milliseconds. Every node
knows its line.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, Protocol

from modeproof.ground.errors import Unjudged, suggestion


@dataclass(frozen=True)
class Place:
    """A line of a source file."""

    file: str
    line: int

    def refuse(self, text: str) -> Unjudged:
        """The refusal of what is there, in one line."""
        return Unjudged(f"{self.file}:{self.line}: {text}")


@dataclass(frozen=True)
class Scalar:
    """A type of single values. kind: bool, bits, int, time or enum; `low` and `high` are its range."""

    name: str
    kind: str
    low: int = 0
    high: int = 1
    names: tuple[str, ...] = ()
    """Of an enumeration. Its values are their places, counted from 0."""
    numbers: tuple[int, ...] = ()
    """Of an enumeration with numbers of its own: what a conversion gives."""
    base: Scalar | None = None
    """Of a subrange: the type in which one calculates with it."""
    start: int = field(default=0, compare=False)
    """The value of a variable of this type that is declared without one."""

    @property
    def width(self) -> int:
        """Bits of a bit string."""
        return self.high.bit_length()

    def member(self, name: str) -> int | None:
        """The place of a member of an enumeration; None: it has no such member."""
        names = {known.upper(): number for number, known in enumerate(self.names)}
        return names.get(name.upper())

    def starting(self, value: int) -> Scalar:
        """This type with another first value."""
        return replace(self, start=value)


@dataclass(frozen=True)
class Array:
    """An array with bounds that are known; `low` and `high` are both inside."""

    low: int
    high: int
    element: Type


@dataclass(frozen=True)
class Struct:
    """A structure: the names, types and initial values of its members."""

    name: str
    members: tuple[tuple[str, Type, object], ...]

    def member(self, name: str) -> Type | None:
        """The type of a member; None: there is none of this name."""
        return next((kind for own, kind, _ in self.members if own.upper() == name.upper()), None)


@dataclass(frozen=True)
class Instance:
    """An instance of a function block, the program's own or one of the standard."""

    block: str


Type = Scalar | Array | Struct | Instance


def root_of(target: Any) -> str:
    """The variable of which a target is a part, in upper case."""
    while not isinstance(target, Name):
        target = target.of
    return target.name.upper()


def blocks_in(kind: Type) -> Iterator[str]:
    """The blocks of which a variable of this type has instances."""
    match kind:
        case Instance(block):
            yield block
        case Array(_, _, element):
            yield from blocks_in(element)
        case Struct(_, members):
            for _, member, _ in members:
                yield from blocks_in(member)


def shown(kind: Type) -> str:
    """A type in a message."""
    match kind:
        case Array(low, high, element):
            return f"ARRAY [{low}..{high}] OF {shown(element)}"
        case Instance(block):
            return block
    return kind.name


MOST_TURNS: Final = 32
"""Of WHILE and REPEAT: that no more are needed is part of the proof."""


def _integers() -> dict[str, Scalar]:
    found = {}
    for prefix, bits in (("S", 8), ("", 16), ("D", 32), ("L", 64)):
        found[f"{prefix}INT"] = Scalar(f"{prefix}INT", "int", -(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
        found[f"U{prefix}INT"] = Scalar(f"U{prefix}INT", "int", 0, 2**bits - 1)
    return found


BOOL: Final = Scalar("BOOL", "bool")
TIME: Final = Scalar("TIME", "time", -(2**31), 2**31 - 1)
SCALARS: Final[Mapping[str, Scalar]] = {
    "BOOL": BOOL,
    "SAFEBOOL": BOOL,
    **{
        f"{prefix}{name}": Scalar(name, "bits", 0, 2**bits - 1)
        for prefix in ("", "SAFE")
        for name, bits in (("BYTE", 8), ("WORD", 16), ("DWORD", 32), ("LWORD", 64))
    },
    **_integers(),
    **{f"SAFE{name}": kind for name, kind in _integers().items()},
    "TIME": TIME,
    "SAFETIME": TIME,
}
"""The types of single values by their names. Safety types are those of their values."""


# ---------------------------------------------------------------- expressions


@dataclass(frozen=True)
class Literal:
    """A value that is in the source; `type` is None for a bare number, which takes that of its place."""

    value: bool | int
    type: Scalar | None
    place: Place


@dataclass(frozen=True)
class Name:
    """A variable."""

    name: str
    place: Place


@dataclass(frozen=True)
class Member:
    """A variable of an instance, a member of a structure or an enumeration (`Colour.Red`, `Colour#Red`)."""

    of: Expression
    name: str
    place: Place


@dataclass(frozen=True)
class Index:
    """An element of an array."""

    of: Expression
    index: Expression
    place: Place


@dataclass(frozen=True)
class Bit:
    """A bit of a bit string; 0 is the lowest."""

    of: Expression
    number: int
    place: Place


@dataclass(frozen=True)
class Unary:
    """NOT or -."""

    operator: str
    operand: Expression
    place: Place


@dataclass(frozen=True)
class Binary:
    """AND OR XOR, comparison, + - * / MOD; +W and -W of bit strings, which wrap.

    AND_THEN and OR_ELSE look at the right side only where the left one leaves it open.
    """

    operator: str
    left: Expression
    right: Expression
    place: Place


@dataclass(frozen=True)
class Function:
    """A call of a function; arguments by position, or by their names."""

    name: str
    arguments: tuple[tuple[str, Expression], ...]
    place: Place


Expression = Literal | Name | Member | Index | Bit | Unary | Binary | Function
Target = Name | Member | Index | Bit


# ---------------------------------------------------------------- statements


@dataclass(frozen=True)
class Assign:
    """A value for a variable."""

    target: Expression
    value: Expression
    place: Place


@dataclass(frozen=True)
class If:
    """The first branch whose condition is true, else the last body."""

    branches: tuple[tuple[Expression, Body], ...]
    otherwise: Body
    place: Place


@dataclass(frozen=True)
class Case:
    """The first clause that has the value; each clause lists single values and ranges (low, high)."""

    subject: Expression
    clauses: tuple[tuple[tuple[tuple[Expression, Expression], ...], Body], ...]
    otherwise: Body
    place: Place


@dataclass(frozen=True)
class For:
    """A loop whose bounds are constants."""

    control: Name
    start: Expression
    end: Expression
    step: Expression | None
    body: Body
    place: Place


@dataclass(frozen=True)
class Loop:
    """WHILE, and REPEAT, whose first turn is always made (`first`); `going`: another turn is made."""

    going: Expression
    body: Body
    first: bool
    place: Place


@dataclass(frozen=True)
class Call:
    """A call of an instance or of a FUNCTION: its inputs, and where outputs go (`=>`).

    Inputs without names are given in the order in which they are declared.
    """

    instance: Expression
    inputs: tuple[tuple[str, Expression], ...]
    outputs: tuple[tuple[str, Expression], ...]
    place: Place


@dataclass(frozen=True)
class Return:
    """The end of this call of the unit."""

    place: Place


@dataclass(frozen=True)
class Leave:
    """EXIT: the end of the innermost loop; CONTINUE (`turn`): the end of this turn of it."""

    turn: bool
    place: Place


Statement = Assign | If | Case | For | Loop | Call | Return | Leave
Body = tuple[Statement, ...]


# ---------------------------------------------------------------- program units


@dataclass(frozen=True)
class Variable:
    """One declared variable.

    section: input, output, in_out, var, temp or constant; external: the memory is one that all units share.
    """

    name: str
    type: Type
    section: str
    initial: object
    """bool, int, or a tuple: of the elements of an array, or of the names (in upper case) and values of the
    members of a structure; None: the default of its type."""
    place: Place
    retained: bool = False
    """It may hold any value at power-up, such as that from before."""
    address: str = ""
    """Where it lies, such as %MW4; empty: at no address of its own."""
    group: str = ""
    """Of a global: the list that declares it, by which it may be called."""


@dataclass(frozen=True)
class Task:
    """When programs run: the ms between two scans (None: it is not said), and the programs in order."""

    name: str
    interval_ms: int | None
    programs: tuple[str, ...]
    place: Place


class Device(Protocol):
    """A block that is not written in the language, such as a reference implementation."""

    def memory(self) -> Mapping[str, Any]:
        """What it remembers beside its pins, at power-up."""

    def call(self, frame: Any, now: int) -> None:
        """One call with plain values, `now` ms after power-up."""

    def slots(self, path: str) -> Iterator[Any]:
        """What it remembers beside its pins, as slots below this path."""

    def terms(self, path: str, env: dict[str, Any]) -> None:
        """One call as terms."""


@dataclass(frozen=True)
class Unit:
    """A PROGRAM, FUNCTION_BLOCK or FUNCTION: its variables in order, and what one call of it does."""

    name: str
    kind: str
    variables: Mapping[str, Variable]
    body: Body
    place: Place
    enumerations: Mapping[str, Scalar] = field(default_factory=dict)
    device: Device | None = None
    """What carries out a call in the place of a body."""
    namespace: str = ""
    using: tuple[tuple[str, Place], ...] = ()
    """The namespaces whose names its file uses, and where it says so."""
    fresh: bool = True
    """VAR_TEMP, and all of a FUNCTION, has its first value when a call begins; else none (`undefined`)."""
    notes: tuple[str, ...] = ()
    """What the source leaves open and was taken as said here, one sentence each."""
    others_call: tuple[str, ...] = ()
    """Its methods and properties, which are not read: they do nothing where nobody names them."""
    whole: bool = False
    """Whether the globals are its own variables: it is the one that is judged."""

    def of(self, *sections: str) -> dict[str, Variable]:
        """The variables of these sections, by the names in the source."""
        return {one.name: one for one in self.variables.values() if one.section in sections}

    def of_keys(self, section: str) -> dict[str, Variable]:
        """The variables of a section, by their names in upper case."""
        return {key: one for key, one in self.variables.items() if one.section == section}


@dataclass(frozen=True)
class Source:
    """All units that were read, by their names in upper case: IEC names do not depend on case."""

    units: Mapping[str, Unit]
    files: Mapping[str, str]
    """The SHA-256 of each file."""
    refused: Mapping[str, Unjudged] = field(default_factory=dict)
    """Units and types that are there and cannot be read, by their names in upper case."""
    tasks: tuple[Task, ...] = ()
    words: Mapping[str, frozenset[str]] = field(default_factory=dict)
    """All words, in upper case, of what is refused, by its name."""
    kept: dict[Any, Any] = field(default_factory=dict, init=False, compare=False, repr=False)
    """What the interpreter has made ready of these units, by their identity."""

    def find(self, name: str) -> Unit | None:
        """The unit with this name; None: there is none. Raises Unjudged: it cannot be read."""
        if name.upper() in self.refused:
            raise self.refused[name.upper()]
        return self.units.get(name.upper())

    def main(self) -> Unit:
        """The unit that no other has an instance of; of several the one PROGRAM. Raises Unjudged."""
        for refusal in self.refused.values():
            raise refusal
        used = {
            block.upper()
            for unit in self.units.values()
            for variable in unit.variables.values()
            for block in blocks_in(variable.type)
        }
        found = [unit for name, unit in self.units.items() if name not in used and unit.kind != "function"]
        programs = [unit for unit in found if unit.kind == "program"]
        if len(programs) == 1:
            return programs[0]
        if len(found) != 1:
            names = ", ".join(unit.name for unit in found) or "none"
            files = ", ".join(self.files)
            raise Unjudged(f"{files}: which program is meant? {names}; choose with --unit NAME")
        return found[0]

    def chosen(self, unit: str | None) -> Unit:
        """The unit of this name; None: the one that no other has an instance of. Raises Unjudged."""
        if unit is None:
            return self.main()
        if (found := self.find(unit)) is not None:
            return found
        names = [found.name for found in self.units.values()]
        raise Unjudged(f"{', '.join(self.files)}: no unit {unit!r}; {suggestion(unit, names)}")
