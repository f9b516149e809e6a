"""SF_GuardLocking V1.0: monitors a guard that is closed and locked, and unlocks it on request.

``step`` is one call of the block: every input is read once, at most one transition is taken out of the state
that the call before left behind, and the outputs are the row of the state after it (GL-SEQ-NOTE). The block
has no timer. States and codes are the family's (GLF-01); the document prints outputs and a diagram.

The parameters choose between readings; the defaults are the letter of the page (GLF-02, GLF-03, GLF-04,
GLF-06, GLF-08, GLF-14).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from refimpl.cyclic_block import held, rises
from refimpl.errors import ParameterError, StateError, check_bool, check_int, check_text

EDGE = "edge"
LATCHED = "latched"
LEVEL = "level"
ERROR = "error"
TOLERATED = "tolerated"
UNTIL_RESET = "until_reset"
UNTIL_OPENED = "until_opened"
WHAT_WAS_LOST = "what_was_lost"
GUARD_AND_ZONE = "guard_and_zone"
ZONE = "zone"
WITH_REQUEST = "with_request"
WHEN_CLOSED = "when_closed"
UNTIL_SAFE = "until_safe"


class Step(Enum):
    """The states of the block. GL-OUT-DIAGCODE, GLF-01"""

    IDLE = "Idle"
    INIT = "Init"
    GUARD_CLOSED_AND_LOCKED = "GuardClosedAndLocked"
    WAIT_FOR_RESET = "WaitForReset"
    WAIT_FOR_OPERATOR = "WaitForOperator"
    GUARD_OPEN_AND_UNLOCKED = "GuardOpenAndUnlocked"
    GUARD_CLOSED_BUT_UNLOCKED = "GuardClosedButUnlocked"
    SAFETY_RETURN = "SafetyReturn"
    RESET_ERROR1 = "ResetError1"
    RESET_ERROR2 = "ResetError2"
    RESET_ERROR3 = "ResetError3"
    SAFETY_LOST = "SafetyLost"


@dataclass(frozen=True, slots=True)
class Params:
    """Readings between which a developer chooses. Raises ParameterError.

    UNLOCK_ON: what unlocks a locked guard, the edge of UnlockRequest in that very call, an edge that came
    while the guard is locked and has stood since, or the level (GLF-02). UNLOCK_ENDS: the unlock signal ends
    with the request, or not before the guard is closed (GLF-03). ZONE_LOST: S_SafetyActive FALSE
    while the guard is closed but unlocked is an error, or tolerated until the guard opens (GLF-04).
    START_UP_INHIBIT: it lasts until an edge of Reset, or a guard that is not locked at start-up ends it
    (GLF-08). CAUSE_OF_LOSS: after a loss an edge of Reset is taken once what was lost is back, the zone or
    the guard with its lock; or only with both; or with the zone safe alone (GLF-14). MESSAGE_OF_LOSS: Error
    stays TRUE until that edge, or until the zone is safe (GLF-06).
    """

    UNLOCK_ON: str = LATCHED
    UNLOCK_ENDS: str = WITH_REQUEST
    ZONE_LOST: str = ERROR
    START_UP_INHIBIT: str = UNTIL_RESET
    CAUSE_OF_LOSS: str = WHAT_WAS_LOST
    MESSAGE_OF_LOSS: str = UNTIL_RESET

    def __post_init__(self) -> None:
        check_text("UNLOCK_ON", self.UNLOCK_ON, (EDGE, LATCHED, LEVEL), ParameterError)
        check_text("UNLOCK_ENDS", self.UNLOCK_ENDS, (WITH_REQUEST, WHEN_CLOSED), ParameterError)
        check_text("ZONE_LOST", self.ZONE_LOST, (ERROR, TOLERATED), ParameterError)
        check_text("START_UP_INHIBIT", self.START_UP_INHIBIT, (UNTIL_RESET, UNTIL_OPENED), ParameterError)
        causes = (WHAT_WAS_LOST, GUARD_AND_ZONE, ZONE)
        check_text("CAUSE_OF_LOSS", self.CAUSE_OF_LOSS, causes, ParameterError)
        check_text("MESSAGE_OF_LOSS", self.MESSAGE_OF_LOSS, (UNTIL_RESET, UNTIL_SAFE), ParameterError)


@dataclass(frozen=True, slots=True)
class State:
    """Memory of the block between two calls.

    ``reset_before`` and ``unlock_request_before`` are the inputs of the call before. ``request_pending``: an
    edge of UnlockRequest came while the guard is locked, and it stands since. ``start_up_inhibit``: the guard
    was not locked at start-up, and the start-up inhibit has not been removed. ``guard_lost``: what was lost
    is the guard or its lock, which must be back before an edge of Reset is taken.
    """

    params: Params
    state: Step
    reset_before: bool
    unlock_request_before: bool
    request_pending: bool
    start_up_inhibit: bool
    guard_lost: bool


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one call reads, by the document's names; dt_ms >= 0 is not used. Building it raises InputError;

    nothing is coerced.
    """

    dt_ms: int
    Activate: bool
    S_GuardMonitoring: bool
    S_SafetyActive: bool
    S_GuardLock: bool
    UnlockRequest: bool
    S_StartReset: bool
    S_AutoReset: bool
    Reset: bool

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_bool("Activate", self.Activate)
        check_bool("S_GuardMonitoring", self.S_GuardMonitoring)
        check_bool("S_SafetyActive", self.S_SafetyActive)
        check_bool("S_GuardLock", self.S_GuardLock)
        check_bool("UnlockRequest", self.UnlockRequest)
        check_bool("S_StartReset", self.S_StartReset)
        check_bool("S_AutoReset", self.S_AutoReset)
        check_bool("Reset", self.Reset)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What one call writes; DiagCode is a word of the project's own, as the document prints none (GLF-01)."""

    Ready: bool
    S_GuardLocked: bool
    S_UnlockGuard: bool
    Error: bool
    DiagCode: int


def power_up(params: Params) -> State:
    """The state before the first call: not active, every input FALSE. GL-SEQ-0, GL-IN-DEFAULT"""
    return State(params, Step.IDLE, False, False, False, False, False)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One call: the end of Activate first, then the transition of the state. GL-IN-ACTIVATE, GL-SEQ-NOTE"""
    went_to = _next_step(state, inputs)
    after = State(
        state.params,
        went_to,
        inputs.Reset,
        inputs.UnlockRequest,
        _pending_after(state, inputs, went_to),
        _inhibit_after(state, inputs, went_to),
        _guard_lost_after(state, went_to),
    )
    return after, outputs(after)


def outputs(s: State) -> Outputs:
    """The row of a state.

    GL-OUT-READY, GL-OUT-GUARDLOCKED, GL-OUT-UNLOCKGUARD, GL-OUT-ERROR, GL-OUT-DIAGCODE, GL-SEQ-0

    Enabled is one state only; unlocked are the two of an opened or openable guard (GLF-03). Where the message
    of a loss stays, the state that waits for its edge of Reset shows it (GLF-06).
    """
    c = s.state
    if c == Step.IDLE:
        return Outputs(False, False, False, False, 0x0000)
    if c == Step.GUARD_CLOSED_AND_LOCKED:
        return Outputs(True, True, False, False, 0x8000)
    if c == Step.INIT:
        return Outputs(True, False, False, False, 0x8001)
    if c == Step.WAIT_FOR_RESET:
        return Outputs(True, False, False, False, 0x8003)
    if c == Step.WAIT_FOR_OPERATOR:
        return Outputs(True, False, False, False, 0x8011)
    if c == Step.GUARD_OPEN_AND_UNLOCKED:
        return Outputs(True, False, True, False, 0x8012)
    if c == Step.GUARD_CLOSED_BUT_UNLOCKED:
        return Outputs(True, False, True, False, 0x8013)
    if c == Step.SAFETY_RETURN:
        return Outputs(True, False, False, s.params.MESSAGE_OF_LOSS == UNTIL_RESET, 0x8014)
    if c == Step.RESET_ERROR1:
        return Outputs(True, False, False, True, 0xC001)
    if c == Step.RESET_ERROR2:
        return Outputs(True, False, False, True, 0xC002)
    if c == Step.RESET_ERROR3:
        return Outputs(True, False, False, True, 0xC003)
    return Outputs(True, False, False, True, 0xC004)


def _next_step(s: State, i: Inputs) -> Step:
    """The state after a call."""
    if not i.Activate:
        return Step.IDLE  # Deactivate, StayInactive
    if s.state == Step.IDLE:
        return _idle()
    if s.state == Step.INIT:
        return _init(s, i)
    if s.state == Step.GUARD_CLOSED_AND_LOCKED:
        return _guard_closed_and_locked(s, i)
    if s.state == Step.GUARD_CLOSED_BUT_UNLOCKED:
        return _guard_closed_but_unlocked(s, i)
    if s.state == Step.GUARD_OPEN_AND_UNLOCKED:
        return _guard_open_and_unlocked(s, i)
    if s.state == Step.WAIT_FOR_OPERATOR:
        return _wait_for_operator(s, i)
    if s.state == Step.WAIT_FOR_RESET:
        return _wait_for_reset(s, i)
    if s.state == Step.SAFETY_LOST:
        return _safety_lost(i)
    if s.state == Step.SAFETY_RETURN:
        return _safety_return(s, i)
    if s.state == Step.RESET_ERROR1:
        return _reset_error1(i)
    if s.state == Step.RESET_ERROR2:
        return _reset_error2(i)
    if s.state == Step.RESET_ERROR3:
        return _reset_error3(i)
    raise StateError("state", s.state, "a Step of SF_GuardLocking")


def _idle() -> Step:
    """Activate starts the block up; nothing else is looked at in that call. GL-IN-ACTIVATE, GL-SEQ-1"""
    return Step.INIT  # StartUp


def _init(s: State, i: Inputs) -> Step:
    """Start-up: with a start-up inhibit the enable needs an edge of Reset.

    GL-IN-STARTRESET, GL-SEQ-1, GL-SEQ-2

    A Reset that does not move is an error where an edge is waited for (GLF-07).
    """
    if not i.S_StartReset and held(i.Reset, s.reset_before):
        return Step.RESET_ERROR1  # FindStaticResetAtStartUp
    if not (i.S_GuardMonitoring and i.S_GuardLock):
        return Step.WAIT_FOR_OPERATOR  # FindGuardNotLocked
    if i.S_StartReset:
        return Step.GUARD_CLOSED_AND_LOCKED  # StartWithoutInhibit
    if rises(i.Reset, s.reset_before):
        return Step.GUARD_CLOSED_AND_LOCKED  # RemoveStartUpInhibit
    return Step.INIT  # AwaitStartReset


def _guard_closed_and_locked(s: State, i: Inputs) -> Step:
    """Enabled: a loss comes before a request, and a request counts only with the zone safe.

    GL-IN-GUARDMONITORING, GL-IN-GUARDLOCK, GL-IN-SAFETYACTIVE, GL-SEQ-2, GL-SEQ-3, GLF-05, GLF-12, GLF-19
    """
    if not (i.S_GuardMonitoring and i.S_GuardLock):
        return Step.SAFETY_LOST  # LoseGuard
    if i.S_SafetyActive and _requested(s, i):
        return Step.GUARD_CLOSED_BUT_UNLOCKED  # Unlock
    return Step.GUARD_CLOSED_AND_LOCKED  # StayLocked


def _requested(s: State, i: Inputs) -> bool:
    """Whether a request to unlock the locked guard is there, by UNLOCK_ON. GL-IN-UNLOCKREQUEST, GLF-02"""
    if s.params.UNLOCK_ON == LEVEL:
        return i.UnlockRequest
    if s.params.UNLOCK_ON == LATCHED and s.request_pending:
        return i.UnlockRequest
    return rises(i.UnlockRequest, s.unlock_request_before)


def _ends(s: State, i: Inputs) -> bool:
    """The unlock signal ends with the request, open or closed. GL-IN-UNLOCKREQUEST, GL-SEQ-3, GLF-03"""
    return s.params.UNLOCK_ENDS == WITH_REQUEST and not i.UnlockRequest


def _guard_closed_but_unlocked(s: State, i: Inputs) -> Step:
    """The guard can be opened: the zone must stay safe, and the request must stand.

    GL-IN-UNLOCKREQUEST, GL-IN-SAFETYACTIVE, GL-SEQ-3, GL-SEQ-4, GL-SEQ-5, GLF-04
    """
    if not i.S_SafetyActive and s.params.ZONE_LOST == ERROR:
        return Step.SAFETY_LOST  # LoseZoneWhileClosed
    if _ends(s, i):
        return Step.WAIT_FOR_OPERATOR  # WithdrawRequest
    if not i.S_GuardMonitoring:
        return Step.GUARD_OPEN_AND_UNLOCKED  # OpenGuard
    if not i.UnlockRequest:
        return Step.WAIT_FOR_OPERATOR  # WithdrawRequest
    return Step.GUARD_CLOSED_BUT_UNLOCKED  # StayUnlocked


def _guard_open_and_unlocked(s: State, i: Inputs) -> Step:
    """The guard is open: the zone must be safe, and the request must stand, unless UNLOCK_ENDS spares it.

    GL-OUT-UNLOCKGUARD, GL-IN-UNLOCKREQUEST, GL-SEQ-4, GLF-03, GLF-04, GLF-09
    """
    if not i.S_SafetyActive and s.params.ZONE_LOST == ERROR:
        return Step.SAFETY_LOST  # LoseZoneWhileOpen
    if not i.S_SafetyActive and not i.S_GuardMonitoring:
        return Step.SAFETY_LOST  # LoseZoneWhileOpen
    if _ends(s, i):
        return Step.WAIT_FOR_OPERATOR  # WithdrawWhileOpen
    if i.S_GuardMonitoring:
        return Step.GUARD_CLOSED_BUT_UNLOCKED  # CloseGuard
    return Step.GUARD_OPEN_AND_UNLOCKED  # StayOpen


def _wait_for_operator(s: State, i: Inputs) -> Step:
    """Not enabled and not unlocked: open, ask again, or close and lock.

    GL-IN-UNLOCKREQUEST, GL-IN-GUARDLOCK, GL-SEQ-5, GLF-03, GLF-10, GLF-11

    With the zone not safe a guard that keeps nobody out is an error; a request counts by its level here.
    """
    if not i.S_SafetyActive and not (i.S_GuardMonitoring and i.S_GuardLock):
        return Step.SAFETY_LOST  # FindZoneUnprotected
    if not i.S_GuardMonitoring and not _ends(s, i):
        return Step.GUARD_OPEN_AND_UNLOCKED  # FollowOpenGuard
    if i.UnlockRequest and i.S_SafetyActive:
        return Step.GUARD_OPEN_AND_UNLOCKED  # UnlockOnRequest
    if i.S_GuardMonitoring and i.S_GuardLock:
        return Step.WAIT_FOR_RESET  # SeeGuardLocked
    return Step.WAIT_FOR_OPERATOR  # AwaitOperator


def _wait_for_reset(s: State, i: Inputs) -> Step:
    """Closed and locked again: the restart inhibit, and a start-up inhibit that is still to be removed.

    GL-IN-AUTORESET, GL-IN-STARTRESET, GL-IN-RESET, GL-OUT-GUARDLOCKED, GLF-07, GLF-08, GLF-12
    """
    alone = i.S_AutoReset and not s.start_up_inhibit
    if not alone and held(i.Reset, s.reset_before):
        return Step.RESET_ERROR3  # FindStaticResetAtRestart
    if not (i.S_GuardMonitoring and i.S_GuardLock):
        return Step.WAIT_FOR_OPERATOR  # LoseGuardAgain
    if alone:
        return Step.GUARD_CLOSED_AND_LOCKED  # RestartWithoutInhibit
    if rises(i.Reset, s.reset_before):
        return Step.GUARD_CLOSED_AND_LOCKED  # RemoveRestartInhibit
    return Step.WAIT_FOR_RESET  # AwaitReset


def _safety_lost(i: Inputs) -> Step:
    """The guard, its lock or the zone was lost: first the zone must be safe. GL-OUT-ERROR, GLF-06, GLF-09"""
    if i.S_SafetyActive:
        return Step.SAFETY_RETURN  # SeeZoneSafe
    return Step.SAFETY_LOST  # StaySafetyLost


def _safety_return(s: State, i: Inputs) -> Step:
    """Then an edge of Reset, whatever S_AutoReset says, with the guard back (CAUSE_OF_LOSS).

    GL-IN-RESET, GLF-06, GLF-13, GLF-14
    """
    if held(i.Reset, s.reset_before):
        return Step.RESET_ERROR2  # FindStaticResetAfterError
    if not i.S_SafetyActive:
        return Step.SAFETY_LOST  # LoseZoneAgain
    guard_too = s.guard_lost or s.params.CAUSE_OF_LOSS == GUARD_AND_ZONE
    if guard_too and not (i.S_GuardMonitoring and i.S_GuardLock):
        return Step.SAFETY_RETURN  # AwaitAcknowledgment
    if rises(i.Reset, s.reset_before):
        return Step.WAIT_FOR_OPERATOR  # AcknowledgeError
    return Step.SAFETY_RETURN  # AwaitAcknowledgment


def _reset_error1(i: Inputs) -> Step:
    """Until Reset is released; a new edge is needed then. GL-IN-RESET, GLF-07"""
    if i.Reset:
        return Step.RESET_ERROR1  # StayInResetError
    return Step.INIT  # ReleaseReset


def _reset_error2(i: Inputs) -> Step:
    """Until Reset is released; a new edge is needed then. GL-IN-RESET, GLF-07"""
    if i.Reset:
        return Step.RESET_ERROR2  # StayInResetError
    return Step.SAFETY_RETURN  # ReleaseReset


def _reset_error3(i: Inputs) -> Step:
    """Until Reset is released; a new edge is needed then. GL-IN-RESET, GLF-07"""
    if i.Reset:
        return Step.RESET_ERROR3  # StayInResetError
    return Step.WAIT_FOR_RESET  # ReleaseReset


def _pending_after(s: State, i: Inputs, went_to: Step) -> bool:
    """With UNLOCK_ON latched: the request rose while the guard is locked, and stands. GLF-02"""
    if s.params.UNLOCK_ON != LATCHED or went_to != Step.GUARD_CLOSED_AND_LOCKED:
        return False
    return i.UnlockRequest and (s.request_pending or not s.unlock_request_before)


def _inhibit_after(s: State, i: Inputs, went_to: Step) -> bool:
    """A start-up that finds the guard not locked leaves its inhibit for the first enable. GLF-08"""
    if went_to == Step.IDLE or went_to == Step.GUARD_CLOSED_AND_LOCKED:
        return False
    if s.state == Step.INIT and went_to == Step.WAIT_FOR_OPERATOR:
        return s.params.START_UP_INHIBIT == UNTIL_RESET and not i.S_StartReset
    return s.start_up_inhibit


def _guard_lost_after(s: State, went_to: Step) -> bool:
    """With CAUSE_OF_LOSS what_was_lost: the enabled guard was lost, up to its edge of Reset. GLF-14"""
    if s.params.CAUSE_OF_LOSS != WHAT_WAS_LOST:
        return False
    if went_to == Step.SAFETY_LOST and s.state == Step.GUARD_CLOSED_AND_LOCKED:
        return True
    after_loss = went_to == Step.SAFETY_LOST or went_to == Step.SAFETY_RETURN or went_to == Step.RESET_ERROR2
    return s.guard_lost and after_loss
