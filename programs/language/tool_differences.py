"""What tools do differently with the standard blocks, for those that a program uses."""

from __future__ import annotations

from collections.abc import Iterator

from programs.language.standard_blocks import BLOCKS
from programs.language.subset import reached
from programs.language.tree import Source, Unit, blocks_in

EDGE = "F_TRIG shows no edge in its first scan; some tools show one if CLK is FALSE then"
COUNT = "counters count on to the limits of their type; some tools stop at PV and at 0"


def assumed(source: Source, unit: Unit) -> Iterator[str]:
    """One sentence for each such block in a unit or below it."""
    used: set[str] = set()
    for found in reached(source, unit, ()):
        for variable in found.variables.values():
            used |= {block.upper() for block in blocks_in(variable.type)} & set(BLOCKS)
    if "F_TRIG" in used:
        yield EDGE
    if any(name.startswith("CT") for name in used):
        yield COUNT
