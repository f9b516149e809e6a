"""Variables at addresses: AT %I is an input of the program, AT %Q an output, AT %M memory of the controller.

Compilers count bytes or words in an address. So two variables that share a bit in one of these countings are
refused. An address that the tool chooses (`%I*`) is one of its own.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Final

from programs.language.tree import Place, Scalar, Type, shown

SIZES: Final = {"X": 1, "": 1, "B": 8, "W": 16, "D": 32, "L": 64}
"""Bits by the letter behind the area."""
ANYWHERE: Final = "999999999"
"""The number of an address that the tool chooses (`%I*`), which the grammar does not know."""
_ADDRESS = re.compile(r"%([IQM])([XBWDL]?)(\d{1,6})(?:\.(\d+))?", re.IGNORECASE)


def area_of(text: str, kind: Type, place: Place) -> str:
    """I, Q or M, of an address that fits the type of its variable. Raises Unjudged."""
    if text[2:] == ANYWHERE:
        return text[1].upper()
    match = _ADDRESS.fullmatch(text)
    if match is None:
        raise place.refuse(f"AT {text}: %I, %Q and %M with a number or * are supported alone")
    area, letter, number, bit = match[1].upper(), match[2].upper(), int(match[3]), match[4]
    size = SIZES[letter]
    if (size == 1) != (bit is not None) or int(bit or 0) > 7:
        raise place.refuse(f"AT {text}: a bit of a byte is %{area}X{number}.0 to %{area}X{number}.7")
    if not isinstance(kind, Scalar) or bits_of(kind) != size:
        raise place.refuse(f"AT {text}: a variable of {size} bits belongs there, and not {shown(kind)}")
    return area


@dataclass
class Addresses:
    """The addresses that are taken: for each way to count the bits, and by whom."""

    taken: dict[tuple[str, str, int], str] = field(default_factory=dict)

    def take(self, text: str, name: str, place: Place, alone: bool = True) -> None:
        """Refuse an address of which another variable has a bit. alone: and so it is taken."""
        match = _ADDRESS.fullmatch(text)
        if match is None:
            return  # the tool chooses another one for each variable
        area, size, number, bit = match[1].upper(), SIZES[match[2].upper()], int(match[3]), int(match[4] or 0)
        bytewise = 8 * number + bit
        starts = {
            "bytes": bytewise,
            "elements": size * number if size > 1 else bytewise,
            "words": 16 * number + bit,
        }
        for counted, start in starts.items():
            for spot in range(start, start + size):
                other = self.taken.get((area, counted, spot), name)
                if other != name:
                    raise place.refuse(
                        f"{name} and {other} share {area} {spot}, counted in {counted}; compilers count in "
                        "different ways: take other addresses, or none"
                    )
                if alone:
                    self.taken[area, counted, spot] = name


def bits_of(kind: Scalar) -> int:
    """The bits of a value of this type; 0: it has no size of its own."""
    if kind.kind in ("bool", "bits"):
        return 1 if kind.kind == "bool" else kind.width
    if kind.kind == "time" or (kind.kind == "int" and kind.base is None):
        return (kind.high - kind.low).bit_length()
    return 0
