"""What someone sees who watches the wires of the block alone, for properties that speak of the past.

The same observer as in EDMOpen.tla, written from there. Nothing of the block reads it: it is added to the
proofs as a second machine that takes each call with the block.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final

import z3

from proofs.explorer.ends import FALSE
from proofs.explorer.scanned import Scanned


@dataclass(frozen=True, eq=False)
class Seen:
    """The observer's memory.

    reset, control: Reset and S_OutControl in the call before · unchanged: ms since S_EDM_Out or SafetyDemand
    became TRUE, while it is · released: while SafetyDemand, S_OutControl was FALSE since a reset by hand, or
    there was none.
    """

    reset: z3.BoolRef
    control: z3.BoolRef
    unchanged: z3.ArithRef
    released: z3.BoolRef


SEEN: Final = Seen(
    z3.Bool("seen.reset"), z3.Bool("seen.control"), z3.Int("seen.unchanged"), z3.Bool("seen.released")
)
"""Any memory of the observer before a call."""
NOTHING: Final = Seen(FALSE, FALSE, z3.IntVal(0), FALSE)
"""At power-up nothing was seen."""


def reset_edge(scan: Scanned, seen: Seen = SEEN) -> z3.BoolRef:
    """Reset rises on the wires."""
    return z3.And(scan.inputs.Reset, z3.Not(seen.reset))


def by_hand(scan: Scanned, seen: Seen = SEEN) -> z3.BoolRef:
    """An edge of Reset takes the request for it away, and was needed."""
    needed = z3.Or(scan.sent.Error, z3.Not(scan.inputs.S_StartReset))
    return z3.And(scan.sent.ResetRequest, scan.sends.SafetyDemand, reset_edge(scan, seen), needed)


@cache
def sees(scan: Scanned, seen: Seen = SEEN) -> Seen:
    """The observer's memory after a call."""
    i, sent, sends = scan.inputs, scan.sent, scan.sends
    on = z3.And(sent.S_EDM_Out, sends.S_EDM_Out)
    off = z3.And(sent.SafetyDemand, sends.SafetyDemand)
    since = z3.Or(z3.Not(sent.SafetyDemand), seen.released, z3.Not(i.S_OutControl))
    free = z3.If(by_hand(scan, seen), z3.Not(i.S_OutControl), since)
    return Seen(
        reset=i.Reset,
        control=i.S_OutControl,
        unchanged=z3.If(z3.Or(on, off), seen.unchanged + i.dt_ms, z3.IntVal(0)),
        released=z3.And(sends.SafetyDemand, free),
    )
