"""How soon the block does what its inputs ask for: at once where it waits, else within four calls."""

from __future__ import annotations

from typing import Final

import z3

from modeproof.registers import Response
from proofs.edm.block_safety import both_are
from proofs.edm.devices import BLOCK
from proofs.edm.invariant import JUDGE
from proofs.edm.observer import SEEN
from proofs.edm.rows import FROM_ANYWHERE
from proofs.explorer.device import LOGIC
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.responses import needs_all
from proofs.sentences import Obligation
from proofs.theorem import Queries, claim, theorem


def switches_on_at_once(scan: Scanned) -> Obligation:
    may = z3.And(scan.sent.SafetyDemand, scan.inputs.Activate, both_are(scan, True), SEEN.released)
    return TRUE, z3.Implies(z3.And(may, scan.inputs.S_OutControl), scan.sends.S_EDM_Out)


@theorem(
    clauses=["EDM-IN-CONTROL-3", "EDM-OUT-EDM-2", "EDM-SEQ-3", "EDM-SEQ-5"],
    findings=["EDMF-12"],
    properties=["SwitchesOnAtOnce"],
    slow=True,
)
def what_may_switch_on_does_in_that_call() -> Queries:
    """With SafetyDemand, both feedbacks TRUE, and a request of a control that was released since a reset by
    hand, S_EDM_Out is TRUE after the call.
    """
    yield from JUDGE.in_every_scan(switches_on_at_once)
    yield JUDGE.without(switches_on_at_once, "OutputDisable", "StopWasSeen")


ON: Final = "OutputEnable"
OFF: Final = "OutputDisable"


def calls_left(scan: Scanned, before: bool) -> z3.ArithRef:
    """How many quiet calls lead to the output, from the memory before or after the call: four at most."""
    memory = scan.before if before else scan.after
    state = control(BLOCK, memory)
    if state == ON:
        return z3.IntVal(0)
    if state == OFF:
        return z3.If(memory.stop_seen, z3.IntVal(1), z3.IntVal(2))
    if state in ("Idle", "InitError") or state.startswith("ResetError"):
        return z3.If(memory.reset_before, z3.IntVal(3), z3.IntVal(4))
    return z3.If(memory.reset_before, z3.IntVal(3), z3.IntVal(2))


def quiet(scan: Scanned) -> z3.BoolRef:
    """What everybody does once the causes are gone.

    Active; the contactors follow the output; Reset is not what it was in the call before; S_OutControl is
    TRUE with the output on, or off on request once it was FALSE, and else FALSE.
    """
    i = scan.inputs
    follow = both_are(scan, not scan.was(ON))
    wanted: z3.BoolRef = scan.before.stop_seen if scan.was(OFF) else TRUE if scan.was(ON) else FALSE
    return z3.And(i.Activate, follow, i.Reset != scan.before.reset_before, i.S_OutControl == wanted)


def comes_closer(scan: Scanned) -> Obligation:
    if scan.was(ON):
        return quiet(scan), TRUE if scan.becomes(ON) else FALSE
    return quiet(scan), calls_left(scan, before=False) < calls_left(scan, before=True)


@theorem(
    clauses=["EDM-IN-START-2", "EDM-IN-RESET-1", "EDM-IN-RESET-2", "EDM-OUT-EDM-2", "EDM-SEQ-2", "EDM-SEQ-6"],
    findings=["EDMF-04", "EDMF-07"],
    properties=["EnablesAgain"],
    responses=["EDMR-05"],
    slow=True,
)
def the_output_is_on_again_within_four_calls(row: Response) -> Queries:
    """From any state and memory: while the contactors follow, Reset changes in every call, and S_OutControl
    asks for the output once it was FALSE, each call lowers a number that is four at most and zero only where
    the output is on, and there it stays; for all times and parameters, and any S_StartReset.
    """
    yield from FROM_ANYWHERE.in_every_scan(comes_closer)
    yield needs_all(FROM_ANYWHERE, row, calls_left)
    for scans in FROM_ANYWHERE.scans():
        scan = next(iter(scans.read.values()))
        left = calls_left(scan, before=True)
        ends = left == 0 if scans.control == ON else z3.And(left >= 1, left <= row.calls)
        yield from claim(f"the number in {scans.control}", FROM_ANYWHERE.premises(scans), ends, LOGIC)

    def faster(scan: Scanned) -> Obligation:
        return quiet(scan), TRUE if scan.becomes(ON) else FALSE

    yield FROM_ANYWHERE.too_strong("one call is enough", faster, "EDMError33")

    def not_taken_back(scan: Scanned) -> Obligation:
        i = scan.inputs
        given = z3.And(i.Activate, both_are(scan, True), i.Reset != scan.before.reset_before, i.S_OutControl)
        return given, TRUE if scan.becomes(ON) else FALSE

    yield FROM_ANYWHERE.too_strong("with a request that was never taken back", not_taken_back, OFF)
