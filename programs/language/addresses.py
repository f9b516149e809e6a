"""Variables at addresses: AT %I is an input of the program and AT %Q an output.

Compilers count bytes or words in an address. So two variables that share a bit in one of these countings are
refused, and so is memory (%M), which another program or a panel may write.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Final

from programs.language.tree import Place, Scalar, Type, shown

SIZES: Final = {"X": 1, "": 1, "B": 8, "W": 16, "D": 32, "L": 64}
"""Bits by the letter behind the area."""
_ADDRESS = re.compile(r"%([IQ])([XBWDL]?)(\d{1,6})(?:\.(\d+))?", re.IGNORECASE)


@dataclass
class Addresses:
    """The addresses of one program that are taken: for each way to count its bits, and by whom."""

    taken: dict[tuple[str, str, int], str] = field(default_factory=dict)

    def section(self, text: str, kind: Type, name: str, place: Place) -> str:
        """Whether a variable at this address is an input or an output. Raises Unjudged."""
        match = _ADDRESS.fullmatch(text)
        if match is None:
            raise place.refuse(f"AT {text}: inputs (%I) and outputs (%Q) with a number are supported alone")
        area, letter, number, bit = match[1].upper(), match[2].upper(), int(match[3]), match[4]
        size = SIZES[letter]
        if (size == 1) != (bit is not None) or int(bit or 0) > 7:
            raise place.refuse(f"AT {text}: a bit of a byte is %{area}X{number}.0 to %{area}X{number}.7")
        if not isinstance(kind, Scalar) or bits_of(kind) != size:
            raise place.refuse(f"AT {text}: a variable of {size} bits belongs there, and not {shown(kind)}")
        bytewise, wordwise = (8 * number + int(bit or 0), 16 * number + int(bit or 0))
        starts = {"bytes": bytewise, "elements": size * number if size > 1 else bytewise, "words": wordwise}
        for counted, start in starts.items():
            for spot in range(start, start + size):
                other = self.taken.setdefault((area, counted, spot), name)
                if other != name:
                    raise place.refuse(
                        f"{name} and {other} share {area} {spot}, counted in {counted}; compilers count in "
                        "different ways: take other addresses, or none"
                    )
        return "input" if area == "I" else "output"


def bits_of(kind: Scalar) -> int:
    """The bits of a value of this type; 0: it has no size of its own."""
    if kind.kind in ("bool", "bits"):
        return 1 if kind.kind == "bool" else kind.width
    if kind.kind == "time" or (kind.kind == "int" and kind.base is None):
        return (kind.high - kind.low).bit_length()
    return 0
