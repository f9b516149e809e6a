"""What someone sees who watches the wires of the block alone, for properties that speak of the past.

The same observer as in EnableSwitchOrder.tla, with times that do not stop at a limit. Nothing of the block
reads it: it is added to the proofs as a second machine that takes each call with the block.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final

import z3

from proofs.enable_switch.vocabulary import NONE, in_the_mode, stage_of
from proofs.explorer.ends import FALSE
from proofs.explorer.scanned import Scanned


@dataclass(frozen=True, eq=False)
class Seen:
    """The observer's memory.

    last_stage: the last stage seen in this run of the mode, since the last error; -1 none · apart: ms for
    which channels 1 and 3 have differed by now, -1 where they do not · contrary: the same for all three
    channels TRUE · last_reset: Reset in the call before.
    """

    last_stage: z3.ArithRef
    apart: z3.ArithRef
    contrary: z3.ArithRef
    last_reset: z3.BoolRef


SEEN: Final = Seen(
    z3.Int("seen.last_stage"), z3.Int("seen.apart"), z3.Int("seen.contrary"), z3.Bool("seen.last_reset")
)
"""Any memory of the observer before a call."""

NOTHING: Final = Seen(z3.IntVal(NONE), z3.IntVal(NONE), z3.IntVal(NONE), z3.BoolVal(False))
"""Before the first call nothing was seen."""


@cache
def sees(scan: Scanned, seen: Seen = SEEN) -> Seen:
    """The observer's memory after a call."""
    i = scan.inputs
    watched = FALSE if scan.was("Idle", "BasicMode") else in_the_mode(scan)
    stage = stage_of(i)
    unequal = z3.And(watched, i.S_EnableSwitchCh1 != i.S_EnableSwitchCh3)
    all_true = z3.And(watched, i.S_EnableSwitchCh1, i.S_EnableSwitchCh2, i.S_EnableSwitchCh3)
    return Seen(
        last_stage=z3.If(
            z3.Or(z3.Not(watched), scan.sends.Error), NONE, z3.If(stage == NONE, seen.last_stage, stage)
        ),
        apart=_lasted(scan, unequal, seen.apart),
        contrary=_lasted(scan, all_true, seen.contrary),
        last_reset=i.Reset,
    )


def _lasted(scan: Scanned, lasts: z3.BoolRef, was: z3.ArithRef) -> z3.ArithRef:
    """The time of what lasts; it begins with 0."""
    return z3.If(lasts, z3.If(was == NONE, 0, was + scan.inputs.dt_ms), NONE)
