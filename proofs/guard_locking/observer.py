"""What someone sees who watches the wires of the block alone, for properties that speak of the past.

The same observer as in GuardLockingOpen.tla, written from there. Nothing of the block reads it: it is added
to the proofs as a second machine that takes each call with the block.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final

import z3

from proofs.explorer.scanned import Scanned


@dataclass(frozen=True, eq=False)
class Seen:
    """The observer's memory.

    reset, request: Reset and UnlockRequest in the call before · asked: UnlockRequest rose while the guard is
    locked, and is TRUE since · starting: since Activate came nothing was enabled, and no call of a start-up
    without inhibit was seen · lost: the guard, its lock or the zone was lost, and no edge of Reset has
    acknowledged it · unguarded: an enabled guard was lost, and no edge of Reset has come with it closed and
    locked.
    """

    reset: z3.BoolRef
    request: z3.BoolRef
    asked: z3.BoolRef
    starting: z3.BoolRef
    lost: z3.BoolRef
    unguarded: z3.BoolRef


SEEN: Final = Seen(
    *(z3.Bool(f"seen.{name}") for name in ("reset", "request", "asked", "starting", "lost", "unguarded"))
)
"""Any memory of the observer before a call."""
NOTHING: Final = Seen(*[z3.BoolVal(False)] * 6)
"""At power-up nothing was seen."""


def reset_edge(scan: Scanned, seen: Seen = SEEN) -> z3.BoolRef:
    """Reset rises on the wires."""
    return z3.And(scan.inputs.Reset, z3.Not(seen.reset))


def request_edge(scan: Scanned, seen: Seen = SEEN) -> z3.BoolRef:
    """UnlockRequest rises on the wires."""
    return z3.And(scan.inputs.UnlockRequest, z3.Not(seen.request))


@cache
def sees(scan: Scanned, seen: Seen = SEEN) -> Seen:
    """The observer's memory after a call."""
    i, sent, sends = scan.inputs, scan.sent, scan.sends
    free = z3.And(sent.DiagCode == 0x8001, i.S_StartReset)
    acknowledged = z3.And(sent.DiagCode == 0x8014, i.S_SafetyActive, reset_edge(scan, seen))
    behind = z3.And(i.S_GuardMonitoring, i.S_GuardLock, acknowledged)
    gone = z3.And(sent.S_GuardLocked, sends.DiagCode == 0xC004)
    return Seen(
        reset=i.Reset,
        request=i.UnlockRequest,
        asked=z3.And(sends.S_GuardLocked, i.UnlockRequest, z3.Or(request_edge(scan, seen), seen.asked)),
        starting=z3.And(
            sends.Ready,
            z3.Not(sends.S_GuardLocked),
            z3.Or(z3.Not(sent.Ready), z3.And(seen.starting, z3.Not(free))),
        ),
        lost=z3.And(sends.Ready, z3.Or(sends.DiagCode == 0xC004, z3.And(seen.lost, z3.Not(acknowledged)))),
        unguarded=z3.And(sends.Ready, z3.Or(gone, z3.And(seen.unguarded, z3.Not(behind)))),
    )
