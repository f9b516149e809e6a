"""What someone sees who watches the wires of the F-PLC alone, for properties that speak of the past.

The same observer as in FplcOpen.tla, written from there. Nothing of the F-PLC reads it: it is added to the
proofs as a second machine that takes each scan with the F-PLC.
"""

# ruff: noqa: SIM300 -- the names of words are upper case
from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final

import z3

from proofs.explorer.scanned import Scanned
from proofs.mode_selection.vocabulary import NONE, all_set, code, mode, none_set, one_set, vector

INSERTION: Final = frozenset({"PulseOnes", "PulseZeros", "OneOutput"})
REMOVAL: Final = frozenset({"Clear", "AwaitZeros"})
SETTLING: Final = frozenset({"Settle"})


@dataclass(frozen=True, eq=False)
class Seen:
    """The observer's memory.

    cleared: one output, LA and both words zero, since LA was last off and the last echo was taken back ·
    pulse: with LA, 0 no pulse, 1 all outputs seen, 2 then none · selected: then MW03 showed this mode, with
    MW07 still zero (-1 none) · echoed: then MW05 showed it · waited: ms since LA was seen, or all outputs
    (E-38), until one output is accepted; or since the removal began, or Settle.
    """

    cleared: z3.BoolRef
    pulse: z3.ArithRef
    selected: z3.ArithRef
    echoed: z3.BoolRef
    waited: z3.ArithRef


SEEN: Final = Seen(
    z3.Bool("seen.cleared"),
    z3.Int("seen.pulse"),
    z3.Int("seen.selected"),
    z3.Bool("seen.echoed"),
    z3.Int("seen.waited"),
)
"""Any memory of the observer before a scan."""

NOTHING: Final = Seen(z3.BoolVal(False), z3.IntVal(0), z3.IntVal(NONE), z3.BoolVal(False), z3.IntVal(0))
"""At power-up nothing was seen."""


@cache
def sees(scan: Scanned, seen: Seen = SEEN) -> Seen:
    """The observer's memory after a scan of the F-PLC."""
    i, flags = scan.inputs, vector(scan.inputs)
    present = z3.And(i.LA, one_set(flags))
    zeros = z3.And(present, i.MW03 == 0, i.MW07 == 0)
    ended = z3.And(scan.sent.MW05 != 0, scan.sends.MW05 == 0)
    standing = z3.And(present, seen.selected != NONE, i.MW03 == code("SE", seen.selected))
    chosen = z3.If(z3.And(seen.cleared, present, i.MW07 == 0), mode("SE", i.MW03), z3.IntVal(NONE))
    return Seen(
        cleared=z3.And(z3.Not(ended), z3.Or(zeros, z3.And(present, seen.cleared))),
        pulse=z3.If(
            z3.Not(i.LA),
            0,
            z3.If(all_set(flags), 1, z3.If(z3.And(seen.pulse == 1, none_set(flags)), 2, seen.pulse)),
        ),
        selected=z3.If(ended, NONE, z3.If(standing, seen.selected, chosen)),
        echoed=z3.And(
            z3.Not(ended), standing, z3.Or(seen.echoed, scan.sent.MW05 == code("CH", seen.selected))
        ),
        waited=_waited(scan, seen),
    )


def _waited(scan: Scanned, seen: Seen) -> z3.ArithRef:
    """Time goes on in the insertion, the removal and Settle, and starts anew where the next one begins."""
    within = any(scan.was(*stretch) and scan.becomes(*stretch) for stretch in (INSERTION, REMOVAL, SETTLING))
    if not within:
        return z3.IntVal(0)
    if scan.was("PulseOnes") and not scan.becomes("PulseOnes"):
        return z3.If(scan.params.T_SEQ_FROM == FROM_ONES, 0, seen.waited + scan.inputs.dt_ms)
    return seen.waited + scan.inputs.dt_ms


FROM_LA: Final = 0
FROM_ONES: Final = 1
"""The values of T_SEQ_FROM in terms: their places in interface.toml."""
