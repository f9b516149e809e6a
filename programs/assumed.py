"""What a verdict takes as given: what tools do differently with blocks, and what a source leaves open."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from programs.check import reached
from programs.presets import moving
from programs.standard import BLOCKS
from programs.tree import Source, Unit, blocks_in

EDGE = "F_TRIG shows no edge in its first scan; some tools show one if CLK is FALSE then"
COUNT = "counters count on to the limits of their type; some tools stop at PV and at 0"
PRESET = "a PT that changes while its timer runs counts at once; some tools keep that of the start"


def assumed(source: Source, unit: Unit, steady: Collection[str] = ()) -> Iterator[str]:
    """One sentence for each such block in a unit or below it, and for what its reader noted.

    steady: the inputs of the unit that keep their value as long as it runs, in upper case.
    """
    used: set[str] = set()
    units = list(reached(source, unit, ()))
    for found in units:
        yield from found.notes
        for variable in found.variables.values():
            used |= {block.upper() for block in blocks_in(variable.type)} & set(BLOCKS)
    if "F_TRIG" in used:
        yield EDGE
    if any(name.startswith("CT") for name in used):
        yield COUNT
    if timers := moving(source, unit, units, steady):
        yield f"{PRESET} ({', '.join(timers)})"
