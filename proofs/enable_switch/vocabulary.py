"""The words that the theorems use: stages, groups of states, and what a call finds."""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.scanned import Scanned

NONE: Final = -1
"""No stage was seen; no time is running."""
TIMED: Final = ("ChangeToStage1", "ChangeToStage0")
FAULTY: Final = ("OperationError", "PlausibilityError", "EquivalenceError")
RELEASED: Final = tuple(f"{step}AtStage0" for step in FAULTY)
RESET_ERRORS: Final = ("ResetError1", "ResetError2", "ResetError3")
ERRORS: Final = FAULTY + RELEASED + RESET_ERRORS

Pattern = tuple[bool, bool, bool]
"""Channels 1, 2 and 3."""
STAGE_0: Final[Pattern] = (False, True, False)
STAGE_1: Final[Pattern] = (True, False, True)
STAGE_2: Final[Pattern] = (False, False, False)
PATTERNS: Final[tuple[Pattern, ...]] = tuple(
    (first, second, third) for first in (False, True) for second in (False, True) for third in (False, True)
)


def shows(inputs: Any, pattern: Pattern) -> z3.BoolRef:
    """The channels show this pattern."""
    found = (inputs.S_EnableSwitchCh1, inputs.S_EnableSwitchCh2, inputs.S_EnableSwitchCh3)
    return z3.And(
        *[channel if wanted else z3.Not(channel) for channel, wanted in zip(found, pattern, strict=True)]
    )


def stage_of(inputs: Any) -> z3.ArithRef:
    """The stage that the channels show, or NONE."""
    return z3.If(
        shows(inputs, STAGE_0), 0, z3.If(shows(inputs, STAGE_1), 1, z3.If(shows(inputs, STAGE_2), 2, NONE))
    )


def automatic(scan: Scanned) -> z3.BoolRef:
    """S_AutoReset takes the place of the edge (ESF-14)."""
    return z3.And(scan.params.AUTO_RESET_ERRORS, scan.inputs.S_AutoReset)


def in_the_mode(scan: Scanned) -> z3.BoolRef:
    """The call finds the block activated and the mode active."""
    return z3.And(scan.inputs.Activate, scan.inputs.S_SafetyActive)
