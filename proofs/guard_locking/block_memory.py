"""What a call leaves for the next one."""

from __future__ import annotations

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.guard_locking.devices import chosen
from proofs.guard_locking.invariant import JUDGE, LOCKED
from proofs.guard_locking.observer import request_edge
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem


def remembers_the_wires(scan: Scanned) -> Obligation:
    i, after = scan.inputs, scan.after
    return TRUE, z3.And(after.reset_before == i.Reset, after.unlock_request_before == i.UnlockRequest)


@theorem(clauses=["GL-IN-RESET", "GL-IN-UNLOCKREQUEST"], findings=["GLF-07"], slow=True)
def every_call_remembers_reset_and_request() -> Queries:
    """Every call, active or not, leaves Reset and UnlockRequest as it read them."""
    yield from JUDGE.in_every_scan(remembers_the_wires)

    def never(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(scan.after.reset_before)

    yield JUDGE.too_strong("nothing is remembered", never, "Idle")


def pending(scan: Scanned) -> Obligation:
    latched = chosen(scan.params, "UNLOCK_ON", "latched")
    stands = z3.And(scan.inputs.UnlockRequest, z3.Or(request_edge(scan), scan.before.request_pending))
    there = TRUE if scan.becomes(LOCKED) else FALSE
    return TRUE, scan.after.request_pending == z3.And(latched, there, stands)


@theorem(clauses=["GL-IN-UNLOCKREQUEST"], findings=["GLF-02"], slow=True)
def a_request_is_pending_only_where_it_is_latched() -> Queries:
    """After every call a request is pending exactly if UNLOCK_ON = latched, the guard is enabled, and
    UnlockRequest is TRUE and rose in this call or was pending before it.
    """
    yield from JUDGE.in_every_scan(pending)

    def never(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(scan.after.request_pending)

    yield JUDGE.too_strong("never", never, LOCKED)


def inhibit(scan: Scanned) -> Obligation:
    wanted = chosen(scan.params, "START_UP_INHIBIT", "until_reset")
    if scan.was("Init") and scan.becomes("WaitForOperator"):
        carried = z3.And(wanted, z3.Not(scan.inputs.S_StartReset))
    elif scan.becomes("Idle", LOCKED):
        carried = FALSE
    else:
        carried = scan.before.start_up_inhibit
    return TRUE, scan.after.start_up_inhibit == carried


@theorem(clauses=["GL-IN-STARTRESET"], findings=["GLF-08", "GLF-21"], slow=True)
def a_start_up_inhibit_is_carried_to_the_first_enable() -> Queries:
    """A start-up that finds the guard not locked leaves its inhibit, if S_StartReset specifies one and
    START_UP_INHIBIT = until_reset, to every call up to the one that enables, or to the end of Activate.
    """
    yield from JUDGE.in_every_scan(inhibit)

    def never(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(scan.after.start_up_inhibit)

    yield JUDGE.too_strong("never", never, "Init")


def guard_lost(scan: Scanned) -> Obligation:
    wanted = chosen(scan.params, "CAUSE_OF_LOSS", "what_was_lost")
    if scan.was(LOCKED) and scan.becomes("SafetyLost"):
        return TRUE, scan.after.guard_lost == wanted
    after_loss = TRUE if scan.becomes("SafetyLost", "SafetyReturn", "ResetError2") else FALSE
    return TRUE, scan.after.guard_lost == z3.And(wanted, after_loss, scan.before.guard_lost)


@theorem(clauses=["GL-IN-RESET", "GL-OUT-ERROR"], findings=["GLF-14"], slow=True)
def what_was_lost_is_remembered_until_its_reset() -> Queries:
    """With CAUSE_OF_LOSS = what_was_lost, after every call the guard counts as lost exactly if an enabled
    guard was lost and the states after a loss have not been left since.
    """
    yield from JUDGE.in_every_scan(guard_lost)

    def never(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(scan.after.guard_lost)

    yield JUDGE.too_strong("never", never, LOCKED)
