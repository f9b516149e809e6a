"""How soon the block does what its inputs ask for, and for what alone: at once, or within five calls."""

from __future__ import annotations

from typing import Final

import z3

from modeproof.registers import Response
from proofs.explorer.device import LOGIC
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.guard_locking.block_safety import secure, start_up_inhibited
from proofs.guard_locking.devices import BLOCK, chosen
from proofs.guard_locking.invariant import JUDGE, LOCKED
from proofs.guard_locking.observer import SEEN, request_edge, reset_edge
from proofs.responses import needs_all
from proofs.sentences import Judge, Obligation
from proofs.theorem import Queries, claim, theorem

FROM_ANYWHERE: Final = Judge(BLOCK, ())
"""No invariant: from any memory."""

CALLS: Final = {
    "GuardClosedAndLocked": (0, 0),
    "WaitForReset": (1, 2),
    "WaitForOperator": (3, 2),
    "GuardClosedButUnlocked": (3, 4),
    "GuardOpenAndUnlocked": (5, 4),
    "Init": (1, 2),
    "Idle": (3, 2),
    "ResetError1": (3, 2),
    "ResetError2": (5, 4),
    "ResetError3": (3, 2),
    "SafetyReturn": (3, 4),
    "SafetyLost": (5, 4),
}
"""How many quiet calls lead to the enable, when Reset was FALSE and when it was TRUE in the call before."""


def guard_must_be_back(scan: Scanned) -> z3.BoolRef:
    """An edge of Reset after a loss needs the guard closed and locked."""
    lost = z3.And(chosen(scan.params, "CAUSE_OF_LOSS", "what_was_lost"), SEEN.unguarded)
    return z3.Or(chosen(scan.params, "CAUSE_OF_LOSS", "guard_and_zone"), lost)


def answers_at_once(scan: Scanned) -> Obligation:
    """A call that stays has not seen what its state waits for."""
    i = scan.inputs
    guard, zone, request, reset = i.S_GuardMonitoring, i.S_SafetyActive, i.UnlockRequest, i.Reset
    guard_too = guard_must_be_back(scan)
    ends = z3.And(chosen(scan.params, "UNLOCK_ENDS", "with_request"), z3.Not(request))
    due = z3.And(i.S_AutoReset, z3.Not(start_up_inhibited(scan)))
    waits = {
        "Init": z3.And(secure(scan), z3.Not(i.S_StartReset), z3.Not(reset)),
        LOCKED: z3.And(secure(scan), z3.Not(z3.And(request_edge(scan), zone))),
        "GuardClosedButUnlocked": z3.And(guard, request),
        "GuardOpenAndUnlocked": z3.And(z3.Not(guard), zone, z3.Not(ends)),
        "WaitForOperator": z3.And(z3.Or(guard, ends), z3.Not(secure(scan)), zone, z3.Not(request)),
        "WaitForReset": z3.And(secure(scan), z3.Not(reset), z3.Not(due)),
        "SafetyReturn": z3.And(zone, z3.Or(z3.Not(reset), z3.And(guard_too, z3.Not(secure(scan))))),
        "SafetyLost": z3.Not(zone),
        "ResetError1": reset,
        "ResetError2": reset,
        "ResetError3": reset,
        "Idle": FALSE,
    }
    state = control(BLOCK, scan.before)
    return i.Activate, waits[state] if scan.becomes(state) else TRUE


@theorem(
    clauses=["GL-IN-RESET", "GL-IN-AUTORESET", "GL-IN-STARTRESET", "GL-WARN-2", "GL-SEQ-2"],
    findings=["GLF-15"],
    properties=["AnswersAtOnce"],
    slow=True,
)
def a_call_that_stays_has_not_seen_what_it_waits_for() -> Queries:
    """An active call that ends in the state in which it began has seen nothing that this state waits for:
    so an edge of Reset enables at once where it may.
    """
    yield from JUDGE.in_every_scan(answers_at_once)

    def leaves(scan: Scanned) -> Obligation:
        return scan.inputs.Activate, FALSE if scan.becomes("WaitForReset") else TRUE

    yield JUDGE.too_strong("it never stays", leaves, "WaitForReset")


ERRORS: Final = ("SafetyLost", "ResetError1", "ResetError2", "ResetError3")
"""Why a call ends in one of them, `an_error_has_a_cause_in_that_call` says."""


def leaves_for_a_cause(scan: Scanned) -> Obligation:
    """A call that leaves its state without an error has seen why."""
    state = control(BLOCK, scan.before)
    if scan.becomes(state, *ERRORS):
        return None
    i, edge, secured = scan.inputs, reset_edge(scan), secure(scan)
    guard, zone, request = i.S_GuardMonitoring, i.S_SafetyActive, i.UnlockRequest
    opened = z3.Not(guard)
    kept = z3.Or(zone, chosen(scan.params, "ZONE_LOST", "tolerated"))
    guard_too = guard_must_be_back(scan)
    ends = z3.And(chosen(scan.params, "UNLOCK_ENDS", "with_request"), z3.Not(request))
    alone = z3.And(i.S_AutoReset, z3.Not(start_up_inhibited(scan)))
    locked, unlocked = scan.sends.S_GuardLocked, scan.sends.S_UnlockGuard
    causes = {
        "Init": z3.If(locked, z3.And(secured, z3.Or(i.S_StartReset, edge)), z3.Not(secured)),
        LOCKED: z3.And(secured, request, zone),
        "GuardClosedButUnlocked": z3.And(
            kept, z3.If(unlocked, opened, z3.Or(ends, z3.And(guard, z3.Not(request))))
        ),
        "GuardOpenAndUnlocked": z3.And(z3.If(unlocked, guard, ends), z3.Or(zone, z3.And(kept, guard))),
        "WaitForOperator": z3.If(
            unlocked,
            z3.And(zone, z3.Or(request, opened)),
            z3.And(secured, z3.Not(z3.And(request, zone))),
        ),
        "WaitForReset": z3.If(locked, z3.And(secured, z3.Or(edge, alone)), z3.Not(secured)),
        "SafetyReturn": z3.And(edge, zone, z3.Implies(guard_too, secured)),
        "SafetyLost": zone,
        "ResetError1": z3.Not(i.Reset),
        "ResetError2": z3.Not(i.Reset),
        "ResetError3": z3.Not(i.Reset),
        "Idle": TRUE,
    }
    return i.Activate, causes[state]


@theorem(
    clauses=[
        "GL-SEQ-2",
        "GL-SEQ-3",
        "GL-SEQ-4",
        "GL-SEQ-5",
        "GL-IN-RESET",
        "GL-IN-UNLOCKREQUEST",
        "GL-OUT-UNLOCKGUARD",
    ],
    findings=["GLF-04", "GLF-11", "GLF-12", "GLF-14"],
    properties=["LeavesForACause"],
    slow=True,
)
def a_call_that_leaves_its_state_has_seen_why() -> Queries:
    """An active call that ends in another state, and in no error, has seen what that step is for: the guard
    open, closed or not secured, the request or its end, the edge of Reset or that none is needed, the zone
    safe again, Reset released.
    """
    yield from JUDGE.in_every_scan(leaves_for_a_cause)

    def by_edge(scan: Scanned) -> Obligation:
        said = leaves_for_a_cause(scan)
        return None if said is None else (said[0], reset_edge(scan))

    yield JUDGE.too_strong("only by an edge of Reset", by_edge, "WaitForReset")


def calls_left(scan: Scanned, before: bool) -> z3.ArithRef:
    """The number of CALLS for the memory before or after the call."""
    memory = scan.before if before else scan.after
    released, pressed = CALLS[control(BLOCK, memory)]
    return z3.If(memory.reset_before, z3.IntVal(pressed), z3.IntVal(released))


def quiet(scan: Scanned) -> z3.BoolRef:
    """Active, closed, locked, safe, no request; and Reset is not what it was in the call before."""
    i = scan.inputs
    calm = z3.And(i.Activate, secure(scan), i.S_SafetyActive, z3.Not(i.UnlockRequest))
    return z3.And(calm, i.Reset != scan.before.reset_before)


def comes_closer(scan: Scanned) -> Obligation:
    if scan.was(LOCKED):
        return quiet(scan), TRUE if scan.becomes(LOCKED) else FALSE
    return quiet(scan), calls_left(scan, before=False) < calls_left(scan, before=True)


@theorem(
    clauses=["GL-IN-RESET", "GL-IN-STARTRESET", "GL-IN-AUTORESET", "GL-SEQ-2"],
    findings=["GLF-07", "GLF-13"],
    properties=["EnablesAgain"],
    responses=["GLR-06"],
    slow=True,
)
def the_block_enables_again_within_five_calls(row: Response) -> Queries:
    """From any state and memory: while the guard is closed and locked, the zone safe and nobody asks, and
    Reset changes in every call, each call lowers a number that is five at most and zero only where the block
    enables, and there it stays. S_StartReset and S_AutoReset may be anything.
    """
    yield from FROM_ANYWHERE.in_every_scan(comes_closer)
    yield needs_all(FROM_ANYWHERE, row, calls_left)
    for scans in FROM_ANYWHERE.scans():
        scan = next(iter(scans.read.values()))
        left = calls_left(scan, before=True)
        ends = left == 0 if scans.control == LOCKED else z3.And(left >= 1, left <= row.calls)
        yield from claim(f"the number in {scans.control}", FROM_ANYWHERE.premises(scans), ends, LOGIC)

    def faster(scan: Scanned) -> Obligation:
        return quiet(scan), TRUE if scan.becomes(LOCKED) else FALSE

    yield FROM_ANYWHERE.too_strong("one call is enough", faster, "SafetyReturn")

    def held(scan: Scanned) -> Obligation:
        said = comes_closer(scan)
        i = scan.inputs
        calm = z3.And(i.Activate, secure(scan), i.S_SafetyActive, z3.Not(i.UnlockRequest))
        return None if said is None else (calm, said[1])

    yield FROM_ANYWHERE.too_strong("with a Reset that is held", held, "SafetyReturn")


def lets_in(scan: Scanned) -> Obligation:
    if not scan.was("WaitForOperator"):
        return None
    i = scan.inputs
    return z3.And(i.Activate, i.S_SafetyActive, i.UnlockRequest), scan.sends.S_UnlockGuard


@theorem(
    clauses=["GL-IN-UNLOCKREQUEST", "GL-OUT-UNLOCKGUARD"],
    findings=["GLF-09", "GLF-11"],
    properties=["EntryIsGranted"],
    slow=True,
)
def who_asks_where_nothing_is_enabled_gets_in_at_once() -> Queries:
    """Where the block waits for its operator, an active call with the zone safe and a request unlocks,
    wherever the guard is; where it is enabled, a request that rises does
    (a_request_that_rises_with_the_zone_safe_unlocks_in_that_call).
    """
    yield from JUDGE.in_every_scan(lets_in)

    def unasked(scan: Scanned) -> Obligation:
        return z3.And(scan.inputs.Activate, scan.inputs.S_SafetyActive), scan.sends.S_UnlockGuard

    yield JUDGE.too_strong("without a request", unasked, "WaitForOperator")
