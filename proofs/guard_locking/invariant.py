"""The inductive invariant of the block: true at power-up and after every call, whatever the inputs were."""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.ends import TRUE
from proofs.explorer.invariant import Conjunct
from proofs.guard_locking.devices import BLOCK, chosen
from proofs.guard_locking.observer import NOTHING, SEEN, Seen, sees
from proofs.sentences import Judge
from proofs.theorem import Queries, theorem

LOCKED: Final = "GuardClosedAndLocked"
BEFORE_OPENING: Final = frozenset({"Idle", "Init", "ResetError1", LOCKED})
"""The states in which no start-up inhibit is carried along."""
AT_START_UP: Final = frozenset({"Init", "ResetError1"})
"""The states of a start-up whose inhibit, if it has one, nothing has removed yet."""
AFTER_A_LOSS: Final = frozenset({"SafetyLost", "SafetyReturn", "ResetError2"})


def _wires_are_remembered(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return z3.And(s.reset_before == seen.reset, s.unlock_request_before == seen.request)


def _pending_was_asked(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c != LOCKED:
        return z3.Not(s.request_pending)
    return z3.Implies(s.request_pending, z3.And(seen.asked, chosen(p, "UNLOCK_ON", "latched")))


def _inhibit_is_carried(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c in BEFORE_OPENING:
        starts = seen.starting if c in AT_START_UP else TRUE
        return z3.And(z3.Not(s.start_up_inhibit), starts)
    kept = seen.starting == s.start_up_inhibit
    return z3.Implies(chosen(p, "START_UP_INHIBIT", "until_reset"), kept)


def _inhibit_is_wanted(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return z3.Implies(s.start_up_inhibit, chosen(p, "START_UP_INHIBIT", "until_reset"))


def _nothing_starts_where_enabled(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return z3.Not(seen.starting) if c in ("Idle", LOCKED) else TRUE


def _loss_is_waited_out(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return TRUE if c in AFTER_A_LOSS else z3.Not(seen.lost)


def _guard_comes_back(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c in AFTER_A_LOSS:
        return TRUE
    return z3.Or(chosen(p, "CAUSE_OF_LOSS", "zone"), z3.Not(seen.unguarded))


def _lost_guard_is_known(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c not in AFTER_A_LOSS:
        return z3.Not(s.guard_lost)
    return s.guard_lost == z3.And(chosen(p, "CAUSE_OF_LOSS", "what_was_lost"), seen.unguarded)


INVARIANT: Final = (
    Conjunct("WiresAreRemembered", "what the call before read is what stood there", _wires_are_remembered),
    Conjunct("PendingWasAsked", "a pending request rose at this locked guard", _pending_was_asked),
    Conjunct(
        "InhibitIsCarried", "what started with an inhibit still has it, and nothing else", _inhibit_is_carried
    ),
    Conjunct("InhibitIsWanted", "an inhibit is carried only where it is to be", _inhibit_is_wanted),
    Conjunct("NothingStartsWhereEnabled", "the start-up is over", _nothing_starts_where_enabled),
    Conjunct("LossIsWaitedOut", "a loss is acknowledged before anything else", _loss_is_waited_out),
    Conjunct(
        "GuardComesBack", "a lost guard is closed and locked before it is acknowledged", _guard_comes_back
    ),
    Conjunct("LostGuardIsKnown", "whether it was the guard that was lost", _lost_guard_is_known),
)
JUDGE: Final = Judge(BLOCK, INVARIANT, SEEN, sees, NOTHING)


@theorem(
    clauses=["GL-IN-RESET", "GL-IN-UNLOCKREQUEST", "GL-SEQ-NOTE"], findings=["GLF-02", "GLF-08"], slow=True
)
def every_call_keeps_the_invariant() -> Queries:
    """The invariant of the block is true at power-up, and every call keeps it, with any inputs and any
    parameters.
    """
    yield from JUDGE.initiation()
    yield from JUDGE.consecution()
