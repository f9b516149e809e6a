"""How soon the block answers: the bounds of spec/enable_switch/properties.toml, which stand there alone."""

from __future__ import annotations

import z3

from modeproof.registers import Response
from proofs.enable_switch.invariants import JUDGE
from proofs.enable_switch.observer import sees
from proofs.enable_switch.vocabulary import NONE, STAGE_0, STAGE_1, STAGE_2, in_the_mode, shows
from proofs.explorer.scanned import Scanned
from proofs.responses import waits_without_end, within_calls, within_time
from proofs.theorem import Queries, theorem


def _off(scan: Scanned) -> z3.BoolRef:
    return z3.Not(scan.sends.S_EnableSwitchOut)


@theorem(clauses=["ES-STAGE-0", "ES-SEQ-8"], findings=[], responses=["ESR-01"], slow=True)
def a_released_switch_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """While the channels show stage 0, S_EnableSwitchOut is FALSE within the calls of ESR-01."""
    yield from within_calls(JUDGE, row, lambda scan: shows(scan.inputs, STAGE_0), _off)


@theorem(clauses=["ES-STAGE-2", "ES-SEQ-7"], findings=[], responses=["ESR-02"], slow=True)
def a_squeezed_switch_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """While the channels show stage 2, S_EnableSwitchOut is FALSE within the calls of ESR-02."""
    yield from within_calls(JUDGE, row, lambda scan: shows(scan.inputs, STAGE_2), _off)


@theorem(clauses=["ES-STAGE-1", "ES-SEQ-0", "ES-SEQ-1"], findings=["ESF-04"], responses=["ESR-03"], slow=True)
def the_end_of_stage_1_or_of_the_mode_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """While the channels show anything but stage 1, or S_SafetyActive or Activate is FALSE, S_EnableSwitchOut
    is FALSE within the calls of ESR-03.
    """

    def ended(scan: Scanned) -> z3.BoolRef:
        return z3.Not(z3.And(in_the_mode(scan), shows(scan.inputs, STAGE_1)))

    yield from within_calls(JUDGE, row, ended, _off)


@theorem(clauses=["ES-SEQ-3", "ES-SEQ-8"], findings=["ESF-04", "ESF-07"], responses=["ESR-04"], slow=True)
def channels_that_differ_are_an_error_in_the_time_of_its_row(row: Response) -> Queries:
    """While channels 1 and 3 differ in every call of a block that watches them, the first call that comes the
    times of ESR-04 after the first such call shows Error.
    """
    yield from within_time(
        JUDGE,
        row,
        lambda scan: sees(scan).apart != NONE,
        lambda seen: seen.apart,
        lambda scan: scan.sends.Error,
    )


@theorem(clauses=["ES-SEQ-6"], findings=["ESF-02"], responses=["ESR-05"], slow=True)
def stage_1_out_of_stage_0_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """With the code of stage 0 shown, stage 1 in the mode makes S_EnableSwitchOut TRUE within the calls of
    ESR-05.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        return z3.And(scan.sent.DiagCode == 0x8802, in_the_mode(scan), shows(scan.inputs, STAGE_1))

    yield from within_calls(JUDGE, row, asks, lambda scan: scan.sends.S_EnableSwitchOut)


@theorem(clauses=["ES-SEQ-5"], findings=[], responses=["ESR-06"], slow=True)
def a_reset_is_waited_for_without_end(row: Response) -> Queries:
    """ESR-06 has no bound: at stage 0, without S_AutoReset and while nobody presses Reset, a call that shows
    ResetRequest can be followed by as many like it as one likes, whatever time passes.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        i = scan.inputs
        nobody = z3.Not(z3.Or(i.Reset, i.S_AutoReset))
        return z3.And(scan.sent.ResetRequest, shows(i, STAGE_0), nobody)

    yield from waits_without_end(JUDGE, row, asks, lambda scan: z3.Not(scan.sends.ResetRequest))
