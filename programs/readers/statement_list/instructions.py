"""Instructions of statement list with resolved operands, and the memory that they use."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from programs.language.tree import SCALARS, Place, Scalar

BYTE, WORD, DWORD = SCALARS["BYTE"], SCALARS["WORD"], SCALARS["DWORD"]
INT, DINT = SCALARS["INT"], SCALARS["DINT"]
WRITES = ("T", "=", "S", "R", "FP", "FN")
Label = tuple[int, int]
"""A call and the number of an instruction in it; -1: its end."""


@dataclass(frozen=True)
class Access:
    """A piece of memory: area (I, Q, M, DBn, Ln), byte, bit, width 1, 8, 16 or 32."""

    area: str
    byte: int
    bit: int
    width: int

    @property
    def first(self) -> int:
        """Its first bit, counted from that of the area."""
        return 8 * self.byte + self.bit

    @property
    def last(self) -> int:
        return self.first + self.width - 1

    def overlaps(self, other: Access) -> bool:
        """Whether they share memory."""
        return self.area == other.area and self.first <= other.last and other.first <= self.last

    @property
    def name(self) -> str:
        """As a name of a variable."""
        letter = {1: "X", 8: "B", 16: "W", 32: "D"}[self.width]
        return f"{self.area}_{letter}{self.byte}" + (f"_{self.bit}" if self.width == 1 else "")

    def __str__(self) -> str:
        return self.name.replace("_", " ")


@dataclass(frozen=True)
class Fixed:
    """A constant of 1 to 32 bits, and how it is written."""

    value: int
    width: int
    text: str


Operand = Access | Fixed


@dataclass(frozen=True)
class Step:
    """An instruction with resolved operands; `label`: where it jumps to, or what it marks."""

    op: str
    place: Place
    operands: tuple[Operand, ...] = ()
    label: Label | None = None
    leaves: bool = False
    """It ends a block: the status is that after BE."""

    def accesses(self) -> Iterator[Access]:
        """The memory that it uses."""
        return (one for one in self.operands if isinstance(one, Access))

    def writes(self) -> Iterator[Access]:
        """The memory that it changes."""
        changed = self.operands[-1:] if self.op == "copy" else self.operands if self.op in WRITES else ()
        return (one for one in changed if isinstance(one, Access))


@dataclass(frozen=True)
class Cells:
    """The pieces of memory as variables."""

    names: Mapping[Access, str]
    types: Mapping[Access, Scalar]
