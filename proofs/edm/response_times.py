"""How soon the block answers: the bounds of spec/edm/properties.toml, which stand there alone."""

from __future__ import annotations

import z3

from modeproof.registers import Response
from proofs.edm.block_safety import both_are
from proofs.edm.invariant import JUDGE
from proofs.edm.observer import SEEN
from proofs.explorer.scanned import Scanned
from proofs.responses import waits_without_end, within_calls, within_time
from proofs.theorem import Queries, theorem


@theorem(clauses=["EDM-IN-CONTROL-2", "EDM-IN-ACTIVATE"], findings=[], responses=["EDMR-01"], slow=True)
def a_stop_request_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """A stop request, by S_OutControl or Activate, switches S_EDM_Out off within the calls of EDMR-01."""
    yield from within_calls(
        JUDGE,
        row,
        lambda scan: z3.Not(z3.And(scan.inputs.S_OutControl, scan.inputs.Activate)),
        lambda scan: z3.Not(scan.sends.S_EDM_Out),
    )


def _stuck(scan: Scanned, dropped: bool) -> z3.BoolRef:
    """An active call in which the contactors do not show this."""
    return z3.And(scan.inputs.Activate, z3.Not(both_are(scan, dropped)))


@theorem(clauses=["EDM-IN-TIME-1", "EDM-SEQ-4"], findings=["EDMF-06"], responses=["EDMR-02"], slow=True)
def a_contactor_that_does_not_drop_out_is_an_error_in_the_time_of_its_row(row: Response) -> Queries:
    """While the output is off on request and a contactor is not dropped out in any call, the first call that
    comes the times of EDMR-02 after the one that switched off shows Error.
    """
    yield from within_time(
        JUDGE,
        row,
        lambda scan: z3.And(scan.sent.SafetyDemand, _stuck(scan, True)),
        lambda seen: seen.unchanged,
        lambda scan: scan.sends.Error,
    )


@theorem(clauses=["EDM-IN-TIME-1", "EDM-SEQ-5"], findings=["EDMF-08"], responses=["EDMR-03"], slow=True)
def a_contactor_that_does_not_pick_up_is_an_error_in_the_time_of_its_row(row: Response) -> Queries:
    """While the output is on, requested, and a contactor is not picked up in any call, the first call that
    comes the times of EDMR-03 after the one that switched on shows Error and no output.
    """
    yield from within_time(
        JUDGE,
        row,
        lambda scan: z3.And(scan.sent.S_EDM_Out, scan.inputs.S_OutControl, _stuck(scan, False)),
        lambda seen: seen.unchanged,
        lambda scan: z3.And(scan.sends.Error, z3.Not(scan.sends.S_EDM_Out)),
    )


@theorem(clauses=["EDM-IN-CONTROL-3", "EDM-SEQ-3"], findings=["EDMF-04"], responses=["EDMR-04"], slow=True)
def a_start_request_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """With SafetyDemand, both contactors dropped out and a request that was taken back since a reset by
    hand, S_EDM_Out is TRUE within the calls of EDMR-04.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        i = scan.inputs
        wanted = z3.And(scan.sent.SafetyDemand, i.Activate, i.S_OutControl, SEEN.released)
        return z3.And(wanted, both_are(scan, True))

    yield from within_calls(JUDGE, row, asks, lambda scan: scan.sends.S_EDM_Out)


@theorem(clauses=["EDM-OUT-REQUEST"], findings=[], responses=["EDMR-06"], slow=True)
def a_reset_is_waited_for_without_end(row: Response) -> Queries:
    """EDMR-06 has no bound: while nobody presses Reset, a call that shows ResetRequest can be followed by as
    many like it as one likes, whatever time passes.
    """

    yield from waits_without_end(
        JUDGE,
        row,
        lambda scan: z3.And(scan.sent.ResetRequest, z3.Not(scan.inputs.Reset)),
        lambda scan: z3.Not(scan.sends.ResetRequest),
    )
