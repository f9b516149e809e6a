"""When the guard is unlocked, for how long, and by which request.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in GuardLockingOpen.
"""

from __future__ import annotations

import z3

from proofs.explorer.ends import TRUE
from proofs.explorer.scanned import Scanned
from proofs.guard_locking.block_safety import secure
from proofs.guard_locking.devices import chosen
from proofs.guard_locking.invariant import JUDGE, LOCKED
from proofs.guard_locking.observer import SEEN, request_edge
from proofs.sentences import Obligation, Sentence
from proofs.theorem import Queries, theorem

UNLOCKED = ("GuardOpenAndUnlocked", "GuardClosedButUnlocked")


def unlocks(scan: Scanned) -> z3.BoolRef:
    """S_UnlockGuard rises."""
    return z3.And(z3.Not(scan.sent.S_UnlockGuard), scan.sends.S_UnlockGuard)


def unlock_needs_safe_zone(scan: Scanned) -> Obligation:
    if not scan.becomes(*UNLOCKED):
        return TRUE, z3.Not(scan.sends.S_UnlockGuard)
    return TRUE, z3.Implies(unlocks(scan), scan.inputs.S_SafetyActive)


@theorem(
    clauses=["GL-IN-SAFETYACTIVE", "GL-SEQ-3"],
    findings=["GLF-18"],
    properties=["UnlockNeedsSafeZone"],
    slow=True,
)
def a_guard_is_unlocked_only_with_the_zone_safe() -> Queries:
    """A call in which S_UnlockGuard rises found S_SafetyActive TRUE, under all parameters. (So the property,
    which allows an open guard besides, is met without that.)
    """
    yield from JUDGE.in_every_scan(unlock_needs_safe_zone)
    asked: Sentence = lambda scan: (unlocks(scan), scan.inputs.UnlockRequest)  # noqa: E731
    yield JUDGE.too_strong("and with a request", asked, "WaitForOperator")


def unlocked_only_while_safe(scan: Scanned) -> Obligation:
    strict = chosen(scan.params, "ZONE_LOST", "error")
    return TRUE, z3.Implies(z3.And(strict, scan.sends.S_UnlockGuard), scan.inputs.S_SafetyActive)


@theorem(
    clauses=["GL-IN-SAFETYACTIVE", "GL-OUT-UNLOCKGUARD"],
    findings=["GLF-04", "GLF-10"],
    properties=["UnlockedOnlyWhileSafe"],
    slow=True,
)
def the_guard_is_unlocked_no_longer_than_the_zone_is_safe() -> Queries:
    """With ZONE_LOST = error, after every call with S_UnlockGuard TRUE that very call found S_SafetyActive
    TRUE.
    """
    yield from JUDGE.in_every_scan(unlocked_only_while_safe)

    def anyway(scan: Scanned) -> Obligation:
        return scan.sends.S_UnlockGuard, scan.inputs.S_SafetyActive

    yield JUDGE.too_strong("with tolerated too", anyway, "GuardClosedButUnlocked")


def unlocked_only_while_requested(scan: Scanned) -> Obligation:
    strict = chosen(scan.params, "UNLOCK_ENDS", "with_request")
    return TRUE, z3.Implies(z3.And(strict, scan.sends.S_UnlockGuard), scan.inputs.UnlockRequest)


@theorem(
    clauses=["GL-IN-UNLOCKREQUEST", "GL-OUT-UNLOCKGUARD", "GL-SEQ-3"],
    findings=["GLF-03"],
    properties=["UnlockedOnlyWhileRequested"],
    slow=True,
)
def the_guard_is_unlocked_no_longer_than_it_is_requested() -> Queries:
    """With UNLOCK_ENDS = with_request, after every call with S_UnlockGuard TRUE that very call found
    UnlockRequest TRUE.
    """
    yield from JUDGE.in_every_scan(unlocked_only_while_requested)

    def anyway(scan: Scanned) -> Obligation:
        return scan.sends.S_UnlockGuard, scan.inputs.UnlockRequest

    yield JUDGE.too_strong("with when_closed too", anyway, "GuardOpenAndUnlocked")


def no_error_locks_safe_zone(scan: Scanned) -> Obligation:
    if not scan.was(*UNLOCKED):
        return None
    return TRUE, z3.Implies(
        z3.And(scan.sent.S_UnlockGuard, scan.sends.Error), z3.Not(scan.inputs.S_SafetyActive)
    )


@theorem(
    clauses=["GL-OUT-ERROR", "GL-OUT-UNLOCKGUARD", "GL-IN-GUARDLOCK"],
    findings=["GLF-09", "GLF-16"],
    properties=["NoErrorLocksSafeZone"],
    slow=True,
)
def no_error_takes_the_unlock_signal_away_from_a_safe_zone() -> Queries:
    """Under all parameters a call that ends the unlock signal with an error found S_SafetyActive FALSE."""
    yield from JUDGE.in_every_scan(no_error_locks_safe_zone)

    def nor_ends_it(scan: Scanned) -> Obligation:
        ends = z3.And(scan.sent.S_UnlockGuard, z3.Not(scan.sends.S_UnlockGuard))
        return ends, z3.Not(scan.inputs.S_SafetyActive)

    yield JUDGE.too_strong("nor does anything else", nor_ends_it, "GuardClosedButUnlocked")


def unlock_needs_request(scan: Scanned) -> Obligation:
    asked = z3.Or(scan.inputs.UnlockRequest, z3.Not(scan.inputs.S_GuardMonitoring))
    return TRUE, z3.Implies(unlocks(scan), asked)


@theorem(
    clauses=["GL-IN-UNLOCKREQUEST", "GL-SEQ-3"],
    findings=["GLF-11"],
    properties=["UnlockNeedsRequest"],
    slow=True,
)
def a_closed_guard_is_unlocked_only_on_request() -> Queries:
    """A call in which S_UnlockGuard rises found UnlockRequest TRUE, or the guard open."""
    yield from JUDGE.in_every_scan(unlock_needs_request)
    anew: Sentence = lambda scan: (unlocks(scan), request_edge(scan))  # noqa: E731
    yield JUDGE.too_strong("by an edge", anew, "WaitForOperator")


def request_while_locked(scan: Scanned) -> Obligation:
    if not scan.was(LOCKED):
        return None
    not_level = z3.Not(chosen(scan.params, "UNLOCK_ON", "level"))
    given = z3.And(not_level, scan.sends.S_UnlockGuard)
    return TRUE, z3.Implies(given, z3.Or(request_edge(scan), SEEN.asked))


@theorem(
    clauses=["GL-IN-UNLOCKREQUEST"],
    findings=["GLF-02"],
    properties=["UnlockNeedsRequestWhileLocked"],
    slow=True,
)
def a_locked_guard_is_unlocked_by_a_request_that_rose_while_it_is_locked() -> Queries:
    """With UNLOCK_ON = edge or latched, a call that unlocks an enabled guard found UnlockRequest rising, or
    standing since it rose at this locked guard.
    """
    yield from JUDGE.in_every_scan(request_while_locked)
    yield JUDGE.without(request_while_locked, LOCKED, "PendingWasAsked")


def request_now(scan: Scanned) -> Obligation:
    if not scan.was(LOCKED):
        return None
    given = z3.And(chosen(scan.params, "UNLOCK_ON", "edge"), scan.sends.S_UnlockGuard)
    return TRUE, z3.Implies(given, request_edge(scan))


@theorem(
    clauses=["GL-IN-UNLOCKREQUEST"], findings=["GLF-02"], properties=["UnlockNeedsRequestNow"], slow=True
)
def with_the_edge_the_request_comes_in_the_call_that_unlocks() -> Queries:
    """With UNLOCK_ON = edge, a call that unlocks an enabled guard is the one in which it rises."""
    yield from JUDGE.in_every_scan(request_now)
    anyway: Sentence = lambda scan: (scan.sends.S_UnlockGuard, request_edge(scan))  # noqa: E731
    yield JUDGE.too_strong("whatever unlocks", anyway, LOCKED)


def _asked_safely(scan: Scanned) -> z3.BoolRef:
    i = scan.inputs
    return z3.And(i.Activate, secure(scan), i.UnlockRequest, i.S_SafetyActive)


def _unlocked(scan: Scanned) -> z3.BoolRef:
    return z3.And(scan.sends.S_UnlockGuard, z3.Not(scan.sends.S_GuardLocked))


def held_request_unlocks(scan: Scanned) -> Obligation:
    if not scan.was(LOCKED):
        return None
    return z3.And(chosen(scan.params, "UNLOCK_ON", "level"), _asked_safely(scan)), _unlocked(scan)


@theorem(
    clauses=["GL-IN-UNLOCKREQUEST", "GL-SEQ-3"],
    findings=["GLF-02"],
    properties=["HeldRequestUnlocks"],
    slow=True,
)
def with_the_level_a_request_that_stands_unlocks() -> Queries:
    """With UNLOCK_ON = level, an active call that finds an enabled guard closed and locked, the zone safe and
    UnlockRequest TRUE unlocks it.
    """
    yield from JUDGE.in_every_scan(held_request_unlocks)
    anyway: Sentence = lambda scan: (_asked_safely(scan), _unlocked(scan))  # noqa: E731
    yield JUDGE.too_strong("with the edge too", anyway, LOCKED)


def request_unlocks_at_once(scan: Scanned) -> Obligation:
    if not scan.was(LOCKED):
        return None
    return z3.And(_asked_safely(scan), request_edge(scan)), _unlocked(scan)


@theorem(
    clauses=["GL-IN-UNLOCKREQUEST", "GL-SEQ-3"], findings=[], properties=["RequestUnlocksAtOnce"], slow=True
)
def a_request_that_rises_with_the_zone_safe_unlocks_in_that_call() -> Queries:
    """Under all parameters: an active call that finds an enabled guard closed and locked, the zone safe and
    UnlockRequest rising sets S_UnlockGuard and withdraws S_GuardLocked.
    """
    yield from JUDGE.in_every_scan(request_unlocks_at_once)

    def unsafe(scan: Scanned) -> Obligation:
        return z3.And(scan.inputs.Activate, secure(scan), request_edge(scan)), scan.sends.S_UnlockGuard

    yield JUDGE.too_strong("whatever the zone does", unsafe, LOCKED)


def latched_request_unlocks(scan: Scanned) -> Obligation:
    if not scan.was(LOCKED):
        return None
    waits = z3.And(chosen(scan.params, "UNLOCK_ON", "latched"), scan.before.request_pending)
    return z3.And(waits, _asked_safely(scan)), _unlocked(scan)


@theorem(
    clauses=["GL-IN-UNLOCKREQUEST", "GL-SEQ-3"],
    findings=["GLF-02"],
    properties=["LatchedRequestUnlocks"],
    slow=True,
)
def with_a_latched_request_the_zone_being_safe_unlocks() -> Queries:
    """With UNLOCK_ON = latched, a request that rose at this locked guard and stands unlocks it in the first
    active call that finds the guard closed and locked and the zone safe.
    """
    yield from JUDGE.in_every_scan(latched_request_unlocks)
    anyway: Sentence = lambda scan: (_asked_safely(scan), _unlocked(scan))  # noqa: E731
    yield JUDGE.too_strong("one that rose before", anyway, LOCKED)


def stays_unlocked_while_requested(scan: Scanned) -> Obligation:
    i = scan.inputs
    if not scan.was(*UNLOCKED):
        return None
    return z3.And(i.Activate, i.UnlockRequest, i.S_SafetyActive), scan.sends.S_UnlockGuard


@theorem(
    clauses=["GL-OUT-UNLOCKGUARD", "GL-SEQ-3", "GL-SEQ-4"],
    findings=["GLF-03"],
    properties=["StaysUnlockedWhileRequested"],
    slow=True,
)
def as_long_as_it_is_requested_the_guard_stays_unlocked() -> Queries:
    """An active call with the guard unlocked before it, a request and the zone safe leaves it so."""
    yield from JUDGE.in_every_scan(stays_unlocked_while_requested)
    active: Sentence = lambda scan: (scan.inputs.Activate, scan.sends.S_UnlockGuard)  # noqa: E731
    yield JUDGE.too_strong("as long as it is active", active, "GuardClosedButUnlocked")


def stays_unlocked_while_open(scan: Scanned) -> Obligation:
    i = scan.inputs
    if not scan.was(*UNLOCKED):
        return None
    open_and_safe = z3.And(i.Activate, z3.Not(i.S_GuardMonitoring), i.S_SafetyActive)
    spared = z3.Or(chosen(scan.params, "UNLOCK_ENDS", "when_closed"), i.UnlockRequest)
    return z3.And(open_and_safe, spared), scan.sends.S_UnlockGuard


@theorem(
    clauses=["GL-OUT-UNLOCKGUARD", "GL-SEQ-4"], findings=["GLF-03"], properties=["StaysUnlockedWhileOpen"]
)
def the_bolt_is_not_thrown_while_the_guard_is_open() -> Queries:
    """With UNLOCK_ENDS = when_closed an active call with S_UnlockGuard TRUE before it, the guard open and the
    zone safe leaves it TRUE, with or without a request.
    """
    yield from JUDGE.in_every_scan(stays_unlocked_while_open)

    def unsafe(scan: Scanned) -> Obligation:
        return z3.And(scan.inputs.Activate, z3.Not(scan.inputs.S_GuardMonitoring)), scan.sends.S_UnlockGuard

    yield JUDGE.too_strong("whatever the zone does", unsafe, "GuardOpenAndUnlocked")


def locks_without_request(scan: Scanned) -> Obligation:
    if not scan.was("GuardClosedButUnlocked"):
        return None
    i = scan.inputs
    return z3.And(i.S_GuardMonitoring, z3.Not(i.UnlockRequest)), z3.Not(scan.sends.S_UnlockGuard)


@theorem(
    clauses=["GL-IN-UNLOCKREQUEST", "GL-SEQ-5"],
    findings=["GLF-03"],
    properties=["LocksWithoutRequest"],
    slow=True,
)
def without_a_request_a_closed_guard_is_asked_to_lock() -> Queries:
    """From the state of a guard that is closed but unlocked, a call that finds it closed and no request ends
    with S_UnlockGuard FALSE.
    """
    yield from JUDGE.in_every_scan(locks_without_request)

    def when_open(scan: Scanned) -> Obligation:
        return z3.Not(scan.inputs.UnlockRequest), z3.Not(scan.sends.S_UnlockGuard)

    yield JUDGE.too_strong("an open one too", when_open, "GuardClosedButUnlocked")


def locked_whatever_the_zone(scan: Scanned) -> Obligation:
    if not scan.was(LOCKED):
        return None
    unsafe = z3.Not(scan.inputs.S_SafetyActive)
    return z3.And(scan.inputs.Activate, secure(scan), unsafe), scan.sends.S_GuardLocked


@theorem(
    clauses=["GL-SEQ-2", "GL-IN-SAFETYACTIVE"],
    findings=["GLF-19"],
    properties=["LockedWhateverTheZone"],
    slow=True,
)
def a_locked_guard_stays_enabled_whatever_the_zone_does() -> Queries:
    """An active call that finds an enabled guard closed and locked, and the zone not safe, leaves it enabled,
    with or without a request.
    """
    yield from JUDGE.in_every_scan(locked_whatever_the_zone)

    def safe(scan: Scanned) -> Obligation:
        return z3.And(scan.inputs.Activate, secure(scan)), scan.sends.S_GuardLocked

    yield JUDGE.too_strong("and safe", safe, LOCKED)


def stays_locked(scan: Scanned) -> Obligation:
    if not scan.was(LOCKED):
        return None
    unasked = z3.Not(scan.inputs.UnlockRequest)
    return z3.And(scan.inputs.Activate, secure(scan), unasked), scan.sends.S_GuardLocked


@theorem(clauses=["GL-OUT-GUARDLOCKED", "GL-SEQ-2"], findings=[], properties=["StaysLocked"], slow=True)
def without_a_request_a_locked_guard_stays_enabled() -> Queries:
    """An active call that finds an enabled guard closed and locked, and no request, leaves it enabled."""
    yield from JUDGE.in_every_scan(stays_locked)

    def bolt(scan: Scanned) -> Obligation:
        unasked = z3.Not(scan.inputs.UnlockRequest)
        return z3.And(scan.inputs.Activate, unasked), scan.sends.S_GuardLocked

    yield JUDGE.too_strong("without its lock", bolt, LOCKED)
