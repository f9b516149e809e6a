"""The standard blocks of IEC 61131-3 that a wiring may have: edges, latches, a delay.

Each step takes the memory, the input pins and the time since the call before in ms (>= 0); it returns the
memory and the output pins after the call.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

Pins = Mapping[str, bool | int]


@dataclass(frozen=True, slots=True)
class Memory:
    """``before``: the input whose edges count, in the call before. ``on``: the latch.

    ``elapsed_ms``: since IN rose.
    """

    before: bool = False
    on: bool = False
    elapsed_ms: int = 0


_BEFORE = (Memory(), Memory(before=True))


def r_trig(memory: Memory, pins: Pins, dt_ms: int) -> tuple[Memory, Pins]:
    """Q for one call when CLK rises."""
    clock = bool(pins["CLK"])
    return _BEFORE[clock], {"Q": clock and not memory.before}


def f_trig(memory: Memory, pins: Pins, dt_ms: int) -> tuple[Memory, Pins]:
    """Q for one call when CLK falls; none in the first call."""
    clock = bool(pins["CLK"])
    return _BEFORE[clock], {"Q": memory.before and not clock}


def sr(memory: Memory, pins: Pins, dt_ms: int) -> tuple[Memory, Pins]:
    """A latch; S1 goes before R."""
    on = bool(pins["S1"]) or (memory.on and not pins["R"])
    return Memory(on=on), {"Q1": on}


def rs(memory: Memory, pins: Pins, dt_ms: int) -> tuple[Memory, Pins]:
    """A latch; R1 goes before S."""
    on = not pins["R1"] and (bool(pins["S"]) or memory.on)
    return Memory(on=on), {"Q1": on}


def ton(memory: Memory, pins: Pins, dt_ms: int) -> tuple[Memory, Pins]:
    """Q when IN has been TRUE for PT (ms); the time counts from the call that saw it rise."""
    if not pins["IN"]:
        return Memory(), {"Q": False, "ET": 0}
    elapsed_ms = memory.elapsed_ms + dt_ms if memory.before else 0
    shown_ms = min(elapsed_ms, int(pins["PT"]))
    return Memory(before=True, elapsed_ms=elapsed_ms), {"Q": elapsed_ms >= pins["PT"], "ET": shown_ms}


STEPS: Mapping[str, Callable[[Memory, Pins, int], tuple[Memory, Pins]]] = {
    "R_TRIG": r_trig,
    "F_TRIG": f_trig,
    "SR": sr,
    "RS": rs,
    "TON": ton,
}
"""Each by its name."""
