"""What a verdict takes as given: what tools do differently with blocks, and what a source leaves open."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any

from programs.language.moving_presets import moving
from programs.language.standard_blocks import BLOCKS
from programs.language.subset import reached
from programs.language.tree import Assign, For, Name, Source, Unit, blocks_in

EDGE = "F_TRIG shows no edge in its first scan; some tools show one if CLK is FALSE then"
COUNT = "counters count on to the limits of their type; some tools stop at PV and at 0"
LOOP = "after FOR its control variable is one step beyond the end; some tools leave another value"
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
    if names := [f"{found.name}.{name}" for found in units for name in _beyond(found)]:
        yield f"{LOOP} ({', '.join(names)})"
    if timers := moving(source, unit, units, steady):
        yield f"{PRESET} ({', '.join(timers)})"


def _beyond(unit: Unit) -> list[str]:
    """The control variables of FOR that somebody reads who is not in such a loop."""
    loops: set[str] = set()
    outside: set[str] = {key for key, variable in unit.variables.items() if variable.section == "output"}

    def walk(node: Any, within: frozenset[str]) -> None:
        if isinstance(node, Name) and node.name.upper() not in within:
            outside.add(node.name.upper())
        if isinstance(node, For):
            loops.add(node.control.name.upper())
            walk((node.start, node.end, node.step), within)
            walk(node.body, within | {node.control.name.upper()})
        elif isinstance(node, tuple):
            for part in node:
                walk(part, within)
        elif isinstance(node, Assign) and isinstance(node.target, Name):
            walk(node.value, within)  # what is written anew is not read
        elif hasattr(node, "place"):
            for part in vars(node).values():
                walk(part, within)

    walk(unit.body, frozenset())
    return sorted(loops & outside)
