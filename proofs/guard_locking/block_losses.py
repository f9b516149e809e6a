"""What an error is, what ends it, and what a loss leaves behind.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in GuardLocking and
GuardLockingOpen.
"""

from __future__ import annotations

from typing import Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.guard_locking.block_safety import edge_awaited, secure, static
from proofs.guard_locking.devices import chosen
from proofs.guard_locking.invariant import JUDGE
from proofs.guard_locking.observer import SEEN, reset_edge, sees
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem


def loss_needs_reset(scan: Scanned) -> Obligation:
    return TRUE, z3.Implies(scan.sends.S_GuardLocked, z3.Not(sees(scan).lost))


@theorem(
    clauses=["GL-IN-RESET", "GL-OUT-ERROR"], findings=["GLF-13"], properties=["LossNeedsReset"], slow=True
)
def after_a_loss_nothing_is_enabled_before_an_edge_of_reset() -> Queries:
    """After the guard, its lock or the zone was lost, S_GuardLocked is FALSE after every call until an edge
    of Reset has come with the zone safe, whatever S_AutoReset says (or Activate has ended).
    """
    yield from JUDGE.in_every_scan(loss_needs_reset)
    yield JUDGE.without(loss_needs_reset, "WaitForReset", "LossIsWaitedOut")


def loss_needs_guard_back(scan: Scanned) -> Obligation:
    strict = z3.Not(chosen(scan.params, "CAUSE_OF_LOSS", "zone"))
    return TRUE, z3.Implies(z3.And(strict, scan.sends.S_GuardLocked), z3.Not(sees(scan).unguarded))


@theorem(
    clauses=["GL-IN-RESET", "GL-OUT-ERROR"], findings=["GLF-14"], properties=["LossNeedsGuardBack"], slow=True
)
def after_a_loss_nothing_is_enabled_before_an_edge_of_reset_behind_the_guard() -> Queries:
    """With CAUSE_OF_LOSS = what_was_lost or guard_and_zone, after the loss of an enabled guard S_GuardLocked
    is FALSE after every call until an edge of Reset has found the guard closed and locked, whatever
    S_AutoReset says (or Activate has ended).
    """
    yield from JUDGE.in_every_scan(loss_needs_guard_back)
    yield JUDGE.without(loss_needs_guard_back, "WaitForReset", "GuardComesBack")


def loss_is_an_error(scan: Scanned) -> Obligation:
    if not scan.was("GuardClosedAndLocked"):
        return None
    o = scan.sends
    error = z3.And(o.Error, z3.Not(o.S_GuardLocked), z3.Not(o.S_UnlockGuard), o.DiagCode == 0xC004)
    return z3.And(scan.inputs.Activate, z3.Not(secure(scan))), error


@theorem(
    clauses=["GL-OUT-GUARDLOCKED", "GL-OUT-ERROR"],
    findings=["GLF-05", "GLF-12"],
    properties=["LossIsAnError"],
    slow=True,
)
def the_loss_of_a_locked_guard_is_an_error_in_that_call() -> Queries:
    """An active call that finds an enabled guard open or not locked shows the error and neither enables nor
    unlocks, whatever is requested and whatever the zone does.
    """
    yield from JUDGE.in_every_scan(loss_is_an_error)

    def any_call(scan: Scanned) -> Obligation:
        return scan.inputs.Activate, scan.sends.Error

    yield JUDGE.too_strong("every call", any_call, "GuardClosedAndLocked")


def loss_seen(scan: Scanned) -> z3.BoolRef:
    """What is a loss in each state."""
    i, unsafe = scan.inputs, z3.Not(scan.inputs.S_SafetyActive)
    strict = chosen(scan.params, "ZONE_LOST", "error")
    found = {
        "GuardClosedAndLocked": z3.Not(secure(scan)),
        "GuardClosedButUnlocked": z3.And(unsafe, strict),
        "GuardOpenAndUnlocked": z3.And(unsafe, z3.Or(strict, z3.Not(i.S_GuardMonitoring))),
        "WaitForOperator": z3.And(unsafe, z3.Not(secure(scan))),
        "SafetyReturn": unsafe,
    }
    return next((cause for state, cause in found.items() if scan.was(state)), FALSE)


def error_needs_cause(scan: Scanned) -> Obligation:
    found = z3.And(static(scan), edge_awaited(scan))
    cause = z3.If(scan.sends.DiagCode == 0xC004, loss_seen(scan), found)
    return TRUE, z3.Implies(z3.And(z3.Not(scan.sent.Error), scan.sends.Error), cause)


@theorem(
    clauses=["GL-OUT-ERROR", "GL-IN-SAFETYACTIVE"],
    findings=["GLF-04", "GLF-05", "GLF-07", "GLF-10"],
    properties=["ErrorNeedsCause"],
    slow=True,
)
def an_error_has_a_cause_in_that_call() -> Queries:
    """A call that begins to show an error found a static Reset where an edge is waited for, an enabled guard
    open or not locked, or a zone that is not safe where it must be: while the guard is open, while it is not
    locked and not asked to unlock, and with ZONE_LOST = error while it is unlocked.
    """
    yield from JUDGE.in_every_scan(error_needs_cause)

    def zone(scan: Scanned) -> Obligation:
        return scan.sends.Error, z3.Not(scan.inputs.S_SafetyActive)

    yield JUDGE.too_strong("always the zone", zone, "GuardClosedAndLocked")


RETURNS: Final = {"ResetError1": "Init", "ResetError2": "SafetyReturn", "ResetError3": "WaitForReset"}
"""Where a reset error was found, and leads back to."""


def error_ends_with_cause(scan: Scanned) -> Obligation:
    if not scan.was("SafetyLost", "SafetyReturn", *RETURNS):
        return None
    i = scan.inputs
    if scan.was("SafetyLost"):
        ends = z3.And(i.S_SafetyActive, TRUE if scan.becomes("SafetyReturn") else FALSE)
    elif scan.was("SafetyReturn"):
        ends = z3.And(i.S_SafetyActive, reset_edge(scan), TRUE if scan.becomes("WaitForOperator") else FALSE)
    else:
        back = any(scan.was(error) and scan.becomes(state) for error, state in RETURNS.items())
        ends = z3.And(z3.Not(i.Reset), TRUE if back else FALSE)
    gone = z3.And(scan.sent.Error, i.Activate, z3.Not(scan.sends.Error))
    return TRUE, z3.Implies(gone, ends)


@theorem(
    clauses=["GL-IN-RESET", "GL-OUT-ERROR"],
    findings=["GLF-06", "GLF-07"],
    properties=["ErrorEndsWithCause"],
    slow=True,
)
def an_error_ends_with_its_cause() -> Queries:
    """While Activate stays, a loss is shown until the zone is safe at least, and then until an edge of Reset
    where its message stays; a reset error until Reset is released, and it leads back to where it was found.
    """
    yield from JUDGE.in_every_scan(error_ends_with_cause)

    def for_ever(scan: Scanned) -> Obligation:
        return scan.inputs.Activate, scan.sends.Error

    yield JUDGE.too_strong("it never ends", for_ever, "ResetError2")


def message_until_reset(scan: Scanned) -> Obligation:
    if not scan.was("SafetyLost", "SafetyReturn", "ResetError2"):
        return None
    stays = chosen(scan.params, "MESSAGE_OF_LOSS", "until_reset")
    gone = z3.And(scan.inputs.Activate, z3.Not(scan.sends.Error))
    by_hand = reset_edge(scan) if scan.was("SafetyReturn") else FALSE
    return z3.And(stays, scan.sent.Error), z3.Implies(gone, by_hand)


@theorem(
    clauses=["GL-IN-RESET", "GL-OUT-ERROR"],
    findings=["GLF-06"],
    properties=["MessageUntilReset"],
    slow=True,
)
def the_message_of_a_loss_stays_until_an_edge_of_reset() -> Queries:
    """With MESSAGE_OF_LOSS = until_reset, while Activate stays, a loss is shown until an edge of Reset."""
    yield from JUDGE.in_every_scan(message_until_reset)

    def anyway(scan: Scanned) -> Obligation:
        return z3.And(scan.sent.Error, scan.inputs.Activate), scan.sends.Error

    yield JUDGE.too_strong("with until_safe too", anyway, "SafetyLost")


def loss_of_zone_needs_no_guard(scan: Scanned) -> Obligation:
    if not scan.was("SafetyReturn"):
        return None
    apart = z3.And(z3.Not(chosen(scan.params, "CAUSE_OF_LOSS", "guard_and_zone")), z3.Not(SEEN.unguarded))
    asked = z3.And(scan.inputs.Activate, scan.inputs.S_SafetyActive, reset_edge(scan))
    return z3.And(apart, asked), TRUE if scan.becomes("WaitForOperator") else FALSE


@theorem(
    clauses=["GL-IN-RESET", "GL-OUT-ERROR"],
    findings=["GLF-14"],
    properties=["LossOfZoneNeedsNoGuard"],
    slow=True,
)
def a_loss_of_the_zone_alone_is_reset_with_the_guard_open() -> Queries:
    """But for CAUSE_OF_LOSS = guard_and_zone: where no enabled guard was lost, an edge of Reset in an active
    call with the zone safe ends the error, wherever the guard is.
    """
    yield from JUDGE.in_every_scan(loss_of_zone_needs_no_guard)
    yield JUDGE.without(loss_of_zone_needs_no_guard, "SafetyReturn", "LostGuardIsKnown")
