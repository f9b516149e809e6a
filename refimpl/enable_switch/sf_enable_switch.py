"""The enable switch with three channels and three stages: released (0), enabled (1), pressed through (2).

The document shows one signal sequence, steps 0 to 9. States, codes, priorities and whatever the sequence does
not show are decisions of this project: ESF-01 and the findings named below. One call of ``step`` is one call
of the block. In a call the end of Activate goes first, then the end of the mode, then the time of a change,
then the stage that the channels show.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from refimpl.cyclic_block import held, rises
from refimpl.errors import ParameterError, StateError, check_bool, check_int

DISCREPANCY_TIME_MAX_MS = 3_600_000


class Step(Enum):
    """The state of the block. ESF-01"""

    IDLE = "Idle"
    BASIC_MODE = "BasicMode"
    SAFE_MODE = "SafeMode"
    STAGE_0 = "Stage0"
    CHANGE_TO_STAGE_1 = "ChangeToStage1"
    STAGE_1 = "Stage1"
    CHANGE_TO_STAGE_0 = "ChangeToStage0"
    STAGE_2 = "Stage2"
    OPERATION_ERROR = "OperationError"
    OPERATION_ERROR_AT_STAGE_0 = "OperationErrorAtStage0"
    PLAUSIBILITY_ERROR = "PlausibilityError"
    PLAUSIBILITY_ERROR_AT_STAGE_0 = "PlausibilityErrorAtStage0"
    EQUIVALENCE_ERROR = "EquivalenceError"
    EQUIVALENCE_ERROR_AT_STAGE_0 = "EquivalenceErrorAtStage0"
    RESET_ERROR_1 = "ResetError1"
    RESET_ERROR_2 = "ResetError2"
    RESET_ERROR_3 = "ResetError3"


@dataclass(frozen=True, slots=True)
class Params:
    """``DiscrepancyTimeCh1_Ch3_ms``: how long a change between two stages may last, 0..3600000 ms; 0: it has
    to be complete in the call that sees it (ESF-07). ``MODE_ENDS_ERROR``: the end of the mode also ends an
    error (ESF-08). ``AUTO_RESET_ERRORS``: S_AutoReset takes the place of the edge that ends an error
    (ESF-14). Raises ParameterError.
    """

    DiscrepancyTimeCh1_Ch3_ms: int = 0
    MODE_ENDS_ERROR: bool = False
    AUTO_RESET_ERRORS: bool = True

    def __post_init__(self) -> None:
        check_int(
            "DiscrepancyTimeCh1_Ch3_ms",
            self.DiscrepancyTimeCh1_Ch3_ms,
            0,
            DISCREPANCY_TIME_MAX_MS,
            ParameterError,
        )
        check_bool("MODE_ENDS_ERROR", self.MODE_ENDS_ERROR, ParameterError)
        check_bool("AUTO_RESET_ERRORS", self.AUTO_RESET_ERRORS, ParameterError)


@dataclass(frozen=True, slots=True)
class State:
    """Memory between two calls: ``reset_before`` is Reset of the call before, ``elapsed_ms`` the time since
    the call that saw the change begin (0 outside the two states of a change).
    """

    params: Params
    state: Step
    reset_before: bool
    elapsed_ms: int


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one call reads; ``dt_ms`` >= 0 is the time since the call before. Building it checks every field
    and raises InputError; nothing is coerced.
    """

    dt_ms: int
    Activate: bool
    S_SafetyActive: bool
    S_EnableSwitchCh1: bool
    S_EnableSwitchCh2: bool
    S_EnableSwitchCh3: bool
    S_AutoReset: bool
    Reset: bool

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_bool("Activate", self.Activate)
        check_bool("S_SafetyActive", self.S_SafetyActive)
        check_bool("S_EnableSwitchCh1", self.S_EnableSwitchCh1)
        check_bool("S_EnableSwitchCh2", self.S_EnableSwitchCh2)
        check_bool("S_EnableSwitchCh3", self.S_EnableSwitchCh3)
        check_bool("S_AutoReset", self.S_AutoReset)
        check_bool("Reset", self.Reset)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What one call writes. The document has S_EnableSwitchOut and Error; the others are ours (ESF-01).
    ``DiagCode`` is 0..65535.
    """

    Ready: bool
    S_EnableSwitchOut: bool
    SafetyDemand: bool
    ResetRequest: bool
    Error: bool
    DiagCode: int


def power_up(params: Params) -> State:
    """The state before the first call: not active, nothing remembered. ES-SEQ-0"""
    return State(params, Step.IDLE, False, 0)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One call: at most one change of state, and the outputs of the state after it. ES-SEQ-0, ES-NOTE-1"""
    after = _next_state(state, inputs)
    return after, outputs(after)


def outputs(s: State) -> Outputs:
    """The row of each state: flags and code. ES-SEQ-0, ES-SEQ-1, ES-SEQ-3, ES-SEQ-7, ES-NOTE-3, ESF-01"""
    c = s.state
    if c == Step.IDLE:
        return Outputs(False, False, False, False, False, 0x0000)
    if c == Step.BASIC_MODE:
        return Outputs(True, False, False, False, False, 0x8002)
    if c == Step.SAFE_MODE:
        return Outputs(True, False, False, False, False, 0x8004)
    if c == Step.STAGE_0:
        return Outputs(True, False, True, False, False, 0x8802)
    if c == Step.CHANGE_TO_STAGE_1:
        return Outputs(True, False, True, False, False, 0x8812)
    if c == Step.STAGE_1:
        return Outputs(True, True, False, False, False, 0x8000)
    if c == Step.CHANGE_TO_STAGE_0:
        return Outputs(True, False, True, False, False, 0x8822)
    if c == Step.STAGE_2:
        return Outputs(True, False, True, False, False, 0x8832)
    if c == Step.OPERATION_ERROR:
        return Outputs(True, False, False, False, True, 0xC020)
    if c == Step.OPERATION_ERROR_AT_STAGE_0:
        return Outputs(True, False, False, True, True, 0xC420)
    if c == Step.PLAUSIBILITY_ERROR:
        return Outputs(True, False, False, False, True, 0xC030)
    if c == Step.PLAUSIBILITY_ERROR_AT_STAGE_0:
        return Outputs(True, False, False, True, True, 0xC440)
    if c == Step.EQUIVALENCE_ERROR:
        return Outputs(True, False, False, False, True, 0xC050)
    if c == Step.EQUIVALENCE_ERROR_AT_STAGE_0:
        return Outputs(True, False, False, True, True, 0xC450)
    if c == Step.RESET_ERROR_1:
        return Outputs(True, False, False, False, True, 0xC001)
    if c == Step.RESET_ERROR_2:
        return Outputs(True, False, False, False, True, 0xC011)
    return Outputs(True, False, False, False, True, 0xC021)


# ---------------------------------------------------------------- what the channels show


def sees_stage_0(i: Inputs) -> bool:
    """Released: channel 2 alone is TRUE. ES-STAGE-0"""
    if i.S_EnableSwitchCh1 or i.S_EnableSwitchCh3:
        return False
    return i.S_EnableSwitchCh2


def sees_stage_1(i: Inputs) -> bool:
    """Enabled: channels 1 and 3 are TRUE and channel 2 is FALSE. ES-STAGE-1, ESF-05"""
    return i.S_EnableSwitchCh1 and not i.S_EnableSwitchCh2 and i.S_EnableSwitchCh3


def sees_stage_2(i: Inputs) -> bool:
    """Pressed through, or not plugged in: all are FALSE. ES-STAGE-2, ES-SEQ-4, ESF-03"""
    return not i.S_EnableSwitchCh1 and not i.S_EnableSwitchCh2 and not i.S_EnableSwitchCh3


def all_true(i: Inputs) -> bool:
    """Channel 2 contradicts channels 1 and 3. ESF-05"""
    return i.S_EnableSwitchCh1 and i.S_EnableSwitchCh2 and i.S_EnableSwitchCh3


def time_is_over(s: State, i: Inputs) -> bool:
    """The change has lasted for the discrepancy time; equality counts. ES-SEQ-3, ESF-04, ESF-07"""
    return s.elapsed_ms + i.dt_ms >= s.params.DiscrepancyTimeCh1_Ch3_ms


# ---------------------------------------------------------------- one call


def _at(s: State, i: Inputs, control: Step) -> State:
    """In this state after the call, with the timer at 0; Reset is remembered in every call (ESF-10)."""
    return State(s.params, control, i.Reset, 0)


def _next_state(s: State, i: Inputs) -> State:
    """First Activate, then the mode, then what the state waits for. ES-SEQ-0, ES-SEQ-1, ES-SEQ-2

    Without the mode everything but an error ends; an error does so only if the parameter says so (ESF-08).
    """
    if not i.Activate:
        return _at(s, i, Step.IDLE)  # StayIdle, Deactivate
    c = s.state
    if c == Step.IDLE:
        return _at(s, i, Step.BASIC_MODE)  # StartUp
    if c == Step.BASIC_MODE:
        return _basic_mode(s, i)
    if c == Step.SAFE_MODE:
        return _safe_mode(s, i)
    if c == Step.STAGE_0:
        return _stage_0(s, i)
    if c == Step.CHANGE_TO_STAGE_1:
        return _change_to_stage_1(s, i)
    if c == Step.STAGE_1:
        return _stage_1(s, i)
    if c == Step.CHANGE_TO_STAGE_0:
        return _change_to_stage_0(s, i)
    if c == Step.STAGE_2:
        return _stage_2(s, i)
    if s.params.MODE_ENDS_ERROR and not i.S_SafetyActive:
        return _at(s, i, Step.BASIC_MODE)  # ModeEndsError
    if c == Step.OPERATION_ERROR:
        return _faulty(s, i, Step.OPERATION_ERROR_AT_STAGE_0)
    if c == Step.OPERATION_ERROR_AT_STAGE_0:
        return _released(s, i, Step.OPERATION_ERROR, Step.RESET_ERROR_1)
    if c == Step.PLAUSIBILITY_ERROR:
        return _faulty(s, i, Step.PLAUSIBILITY_ERROR_AT_STAGE_0)
    if c == Step.PLAUSIBILITY_ERROR_AT_STAGE_0:
        return _released(s, i, Step.PLAUSIBILITY_ERROR, Step.RESET_ERROR_2)
    if c == Step.EQUIVALENCE_ERROR:
        return _faulty(s, i, Step.EQUIVALENCE_ERROR_AT_STAGE_0)
    if c == Step.EQUIVALENCE_ERROR_AT_STAGE_0:
        return _released(s, i, Step.EQUIVALENCE_ERROR, Step.RESET_ERROR_3)
    if c == Step.RESET_ERROR_1:
        return _reset_error(s, i, Step.OPERATION_ERROR_AT_STAGE_0)
    if c == Step.RESET_ERROR_2:
        return _reset_error(s, i, Step.PLAUSIBILITY_ERROR_AT_STAGE_0)
    if c == Step.RESET_ERROR_3:
        return _reset_error(s, i, Step.EQUIVALENCE_ERROR_AT_STAGE_0)
    raise StateError("state", c, "a Step of the enable switch")


def _basic_mode(s: State, i: Inputs) -> State:
    """Wait for the mode; the channels are not judged. ES-SEQ-1, ES-SEQ-2, ESF-09"""
    if i.S_SafetyActive:
        return _at(s, i, Step.SAFE_MODE)  # SeeSafetyActive
    return _at(s, i, Step.BASIC_MODE)  # AwaitSafetyActive


def _safe_mode(s: State, i: Inputs) -> State:
    """The mode came in the call before: only a released switch may be there. ES-SEQ-2, ESF-02"""
    if not i.S_SafetyActive:
        return _at(s, i, Step.BASIC_MODE)  # LoseSafetyActive
    if sees_stage_0(i):
        return _at(s, i, Step.STAGE_0)  # AcceptStage0
    return _at(s, i, Step.OPERATION_ERROR)  # RefuseStage


def _stage_0(s: State, i: Inputs) -> State:
    """Released: stage 1 enables, anything that is no stage begins a change.

    ES-STAGE-0, ES-SEQ-5, ES-SEQ-6, ES-SEQ-9

    All FALSE is stage 2, never a part of the change (ESF-03).
    """
    if not i.S_SafetyActive:
        return _at(s, i, Step.BASIC_MODE)  # LoseSafetyActive
    if sees_stage_0(i):
        return _at(s, i, Step.STAGE_0)  # StayAtStage0
    if sees_stage_1(i):
        return _at(s, i, Step.STAGE_1)  # Enable
    if sees_stage_2(i):
        return _at(s, i, Step.STAGE_2)  # ReachStage2
    return _at(s, i, Step.CHANGE_TO_STAGE_1)  # BeginChange


def _change_to_stage_1(s: State, i: Inputs) -> State:
    """Out of stage 0, and in no stage yet: the time runs. ES-SEQ-3, ES-SEQ-6, ES-SEQ-9, ESF-04, ESF-07"""
    if not i.S_SafetyActive:
        return _at(s, i, Step.BASIC_MODE)  # LoseSafetyActive
    if time_is_over(s, i):
        return _too_late(s, i)
    if sees_stage_1(i):
        return _at(s, i, Step.STAGE_1)  # Enable
    if sees_stage_0(i):
        return _at(s, i, Step.STAGE_0)  # ReachStage0
    if sees_stage_2(i):
        return _at(s, i, Step.STAGE_2)  # ReachStage2
    return _time_goes_on(s, i)


def _stage_1(s: State, i: Inputs) -> State:
    """Enabled; whatever is not stage 1 turns the enable off in this call. ES-STAGE-1, ES-SEQ-7, ESF-04"""
    if not i.S_SafetyActive:
        return _at(s, i, Step.BASIC_MODE)  # LoseSafetyActive
    if sees_stage_1(i):
        return _at(s, i, Step.STAGE_1)  # StayEnabled
    if sees_stage_0(i):
        return _at(s, i, Step.STAGE_0)  # ReachStage0
    if sees_stage_2(i):
        return _at(s, i, Step.STAGE_2)  # ReachStage2
    return _at(s, i, Step.CHANGE_TO_STAGE_0)  # BeginReturn


def _change_to_stage_0(s: State, i: Inputs) -> State:
    """Out of stage 1 or 2, and in no stage yet: the time runs. ES-SEQ-7, ES-SEQ-8, ES-ORDER-2, ESF-04, ESF-11

    Stage 1 does not come back: it did not come out of stage 0 (ESF-02).
    """
    if not i.S_SafetyActive:
        return _at(s, i, Step.BASIC_MODE)  # LoseSafetyActive
    if time_is_over(s, i):
        return _too_late(s, i)
    if sees_stage_0(i):
        return _at(s, i, Step.STAGE_0)  # ReachStage0
    if sees_stage_2(i):
        return _at(s, i, Step.STAGE_2)  # ReachStage2
    if sees_stage_1(i):
        return _at(s, i, Step.PLAUSIBILITY_ERROR)  # RefuseStage1
    return _time_goes_on(s, i)


def _stage_2(s: State, i: Inputs) -> State:
    """Pressed through: only stage 0 may follow. ES-STAGE-2, ES-SEQ-8, ES-ORDER-2, ESF-02"""
    if not i.S_SafetyActive:
        return _at(s, i, Step.BASIC_MODE)  # LoseSafetyActive
    if sees_stage_0(i):
        return _at(s, i, Step.STAGE_0)  # ReachStage0
    if sees_stage_2(i):
        return _at(s, i, Step.STAGE_2)  # StayAtStage2
    if sees_stage_1(i):
        return _at(s, i, Step.PLAUSIBILITY_ERROR)  # RefuseStage1
    return _at(s, i, Step.CHANGE_TO_STAGE_0)  # BeginReturn


def _time_goes_on(s: State, i: Inputs) -> State:
    """The same change goes on, whichever pattern it shows, and its time is not over.

    ES-SEQ-3, ESF-04, ESF-05
    """
    return State(s.params, s.state, i.Reset, s.elapsed_ms + i.dt_ms)  # AwaitChange


def _too_late(s: State, i: Inputs) -> State:
    """The time of a change is over. All three TRUE: channel 2 is the fault. ES-SEQ-3, ESF-05, ESF-07"""
    if all_true(i):
        return _at(s, i, Step.PLAUSIBILITY_ERROR)  # FindContradiction
    return _at(s, i, Step.EQUIVALENCE_ERROR)  # FindUnequal


# ---------------------------------------------------------------- errors


def _faulty(s: State, i: Inputs, released: Step) -> State:
    """Wait for stage 0; nothing else shows that the cause is gone. ES-SEQ-4, ESF-06"""
    if sees_stage_0(i):
        return _at(s, i, released)  # SeeStage0
    return _at(s, i, s.state)  # AwaitStage0


def _released(s: State, i: Inputs, cause: Step, static: Step) -> State:
    """Stage 0 is there: wait for the reset. ES-SEQ-4, ES-SEQ-5, ES-RESTART, ESF-06, ESF-10

    First the stage, then a Reset that is held, then the edge or S_AutoReset (ESF-14). Without the mode the
    reset leads to where the mode is waited for (ESF-08).
    """
    if not sees_stage_0(i):
        return _at(s, i, cause)  # LoseStage0
    automatic = s.params.AUTO_RESET_ERRORS and i.S_AutoReset
    if held(i.Reset, s.reset_before) and not automatic:
        return _at(s, i, static)  # FindStaticReset
    if rises(i.Reset, s.reset_before) or automatic:
        if i.S_SafetyActive:
            return _at(s, i, Step.STAGE_0)  # LeaveError
        return _at(s, i, Step.BASIC_MODE)  # LeaveError
    return _at(s, i, s.state)  # AwaitReset


def _reset_error(s: State, i: Inputs, released: Step) -> State:
    """A Reset that is held resets nothing; go back once it is released. ES-RESTART, ESF-10"""
    if i.Reset:
        return _at(s, i, s.state)  # AwaitResetReleased
    return _at(s, i, released)  # SeeResetReleased
