"""How soon the block answers: the bounds of spec/guard_locking/properties.toml, which stand there alone."""

from __future__ import annotations

import z3

from modeproof.registers import Response
from proofs.explorer.ends import FALSE
from proofs.explorer.scanned import Scanned
from proofs.guard_locking.block_safety import secure
from proofs.guard_locking.devices import chosen
from proofs.guard_locking.invariant import JUDGE
from proofs.guard_locking.observer import request_edge
from proofs.responses import waits_without_end, within_calls
from proofs.theorem import Queries, theorem


def _disabled(scan: Scanned) -> z3.BoolRef:
    return z3.Not(scan.sends.S_GuardLocked)


@theorem(
    clauses=["GL-IN-GUARDMONITORING", "GL-OUT-GUARDLOCKED"], findings=[], responses=["GLR-01"], slow=True
)
def an_open_guard_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """While the guard is open, S_GuardLocked is FALSE within the calls of GLR-01."""
    yield from within_calls(JUDGE, row, lambda scan: z3.Not(scan.inputs.S_GuardMonitoring), _disabled)


@theorem(clauses=["GL-IN-GUARDLOCK", "GL-OUT-GUARDLOCKED"], findings=[], responses=["GLR-02"], slow=True)
def an_unlocked_guard_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """While the guard is not locked, S_GuardLocked is FALSE within the calls of GLR-02."""
    yield from within_calls(JUDGE, row, lambda scan: z3.Not(scan.inputs.S_GuardLock), _disabled)


def _may_unlock(scan: Scanned) -> z3.BoolRef:
    """An active call that finds an enabled guard still secured, the zone safe and a request."""
    i = scan.inputs
    return z3.And(scan.sent.S_GuardLocked, i.Activate, secure(scan), i.S_SafetyActive, i.UnlockRequest)


@theorem(clauses=["GL-IN-UNLOCKREQUEST", "GL-SEQ-3"], findings=["GLF-02"], responses=["GLR-03"], slow=True)
def a_request_that_rises_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """Where a guard is enabled, closed and locked and the zone is safe, a request that rises unlocks within
    the calls of GLR-03.
    """
    yield from within_calls(
        JUDGE,
        row,
        lambda scan: z3.And(_may_unlock(scan), request_edge(scan)),
        lambda scan: scan.sends.S_UnlockGuard,
    )


@theorem(clauses=["GL-IN-UNLOCKREQUEST", "GL-SEQ-3"], findings=["GLF-02"], responses=["GLR-04"], slow=True)
def a_request_that_stands_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """With UNLOCK_ON = level, or latched and a request that rose while the guard was enabled: where the guard
    is enabled, closed and locked and the zone is safe, a request that stands unlocks within the calls of
    GLR-04.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        latched = z3.And(chosen(scan.params, "UNLOCK_ON", "latched"), scan.before.request_pending)
        return z3.And(z3.Or(chosen(scan.params, "UNLOCK_ON", "level"), latched), _may_unlock(scan))

    yield from within_calls(JUDGE, row, asks, lambda scan: scan.sends.S_UnlockGuard)


@theorem(
    clauses=["GL-IN-SAFETYACTIVE", "GL-OUT-UNLOCKGUARD", "GL-OUT-ERROR"],
    findings=["GLF-04", "GLF-10"],
    responses=["GLR-05"],
    slow=True,
)
def a_zone_that_is_lost_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """With ZONE_LOST = error, while the guard is unlocked and the zone is not safe, S_UnlockGuard is FALSE
    and Error TRUE within the calls of GLR-05.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        i = scan.inputs
        strict = chosen(scan.params, "ZONE_LOST", "error")
        return z3.And(strict, scan.sent.S_UnlockGuard, i.Activate, z3.Not(i.S_SafetyActive))

    yield from within_calls(
        JUDGE, row, asks, lambda scan: z3.And(scan.sends.Error, z3.Not(scan.sends.S_UnlockGuard))
    )


@theorem(clauses=["GL-IN-SAFETYACTIVE", "GL-SEQ-3"], findings=[], responses=["GLR-07"], slow=True)
def a_safe_zone_is_waited_for_without_end(row: Response) -> Queries:
    """GLR-07 has no bound: while the zone is not safe, a call that finds a request at an enabled guard can be
    followed by as many like it as one likes, whatever time passes.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        return z3.And(scan.sent.S_GuardLocked, scan.inputs.UnlockRequest, z3.Not(scan.inputs.S_SafetyActive))

    yield from waits_without_end(JUDGE, row, asks, lambda scan: scan.sends.S_UnlockGuard)


@theorem(clauses=["GL-SEQ-5", "GL-IN-RESET"], findings=[], responses=["GLR-08"], slow=True)
def a_bolt_is_waited_for_without_end(row: Response) -> Queries:
    """GLR-08 has no bound: where S_UnlockGuard went, or a loss was reset, a call that finds the guard not
    locked can be followed by as many like it as one likes, whatever time passes, without enable and without
    error.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        waits = scan.was("WaitForOperator", "SafetyReturn")
        return z3.And(scan.inputs.Activate, z3.Not(scan.inputs.S_GuardLock)) if waits else FALSE

    yield from waits_without_end(
        JUDGE, row, asks, lambda scan: z3.Or(scan.sends.S_GuardLocked, scan.sends.Error)
    )
