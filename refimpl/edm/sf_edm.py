"""SF_EDM V2.0: switches contactors, and watches that their feedback contacts follow.

One call of ``step`` is one call of the block: it takes at most one transition out of the state of the call
before, and the outputs are the row of the state after it. A contactor that is dropped out, which is its
initial state, shows TRUE at S_EDM1 or S_EDM2, one that is picked up FALSE (EDM-IN-EDM-1).

States and DiagCodes are ours, after the family's (EDMF-01): the document has the inputs, the outputs and a
sequence of signals.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from refimpl.cyclic_block import counted, rises
from refimpl.errors import ParameterError, StateError, check_bool, check_int, check_text

MONITORING_TIME_MAX_MS = 3_600_000
STOP_FIRST = "stop_first"
AT_ONCE = "at_once"


class Step(Enum):
    """The state that a call left. EDM-INST-1, EDMF-01"""

    IDLE = "Idle"
    INIT = "Init"
    OUTPUT_DISABLE = "OutputDisable"
    OUTPUT_ENABLE = "OutputEnable"
    RESET_ERROR_1 = "ResetError1"
    INIT_ERROR = "InitError"
    EDM_ERROR_11 = "EDMError11"
    EDM_ERROR_12 = "EDMError12"
    EDM_ERROR_13 = "EDMError13"
    EDM_ERROR_21 = "EDMError21"
    EDM_ERROR_22 = "EDMError22"
    EDM_ERROR_23 = "EDMError23"
    EDM_ERROR_31 = "EDMError31"
    EDM_ERROR_32 = "EDMError32"
    EDM_ERROR_33 = "EDMError33"
    RESET_ERROR_11 = "ResetError11"
    RESET_ERROR_12 = "ResetError12"
    RESET_ERROR_13 = "ResetError13"
    RESET_ERROR_21 = "ResetError21"
    RESET_ERROR_22 = "ResetError22"
    RESET_ERROR_23 = "ResetError23"
    RESET_ERROR_31 = "ResetError31"
    RESET_ERROR_32 = "ResetError32"
    RESET_ERROR_33 = "ResetError33"


ERRORS = (
    (Step.EDM_ERROR_11, 0xC010, Step.RESET_ERROR_11, 0xC011),
    (Step.EDM_ERROR_12, 0xC020, Step.RESET_ERROR_12, 0xC021),
    (Step.EDM_ERROR_13, 0xC030, Step.RESET_ERROR_13, 0xC031),
    (Step.EDM_ERROR_21, 0xC040, Step.RESET_ERROR_21, 0xC041),
    (Step.EDM_ERROR_22, 0xC050, Step.RESET_ERROR_22, 0xC051),
    (Step.EDM_ERROR_23, 0xC060, Step.RESET_ERROR_23, 0xC061),
    (Step.EDM_ERROR_31, 0xC070, Step.RESET_ERROR_31, 0xC071),
    (Step.EDM_ERROR_32, 0xC080, Step.RESET_ERROR_32, 0xC081),
    (Step.EDM_ERROR_33, 0xC090, Step.RESET_ERROR_33, 0xC091),
)
"""The nine errors about contactors with their codes, and the state of each in which Reset is held.

1n: not dropped out when the output is asked for; 2n: not dropped out in time; 3n: not picked up in time;
n1 the first contactor, n2 the second, n3 both. EDMF-01
"""


@dataclass(frozen=True, slots=True)
class Params:
    """MonitoringTime_ms: longest time for the contactors to change over, 0..3600000 ms, 0 if it is not set.

    AFTER_RESET: what S_OutControl must do after a reset by hand, ``"at_once"`` nothing, which is the letter
    of the page, or ``"stop_first"``, the cautious value, be FALSE before it counts. EDM-IN-TIME-1,
    EDM-IN-TIME-2, EDM-IN-RESET-4, EDMF-04. Raises ParameterError.
    """

    MonitoringTime_ms: int = 0
    AFTER_RESET: str = AT_ONCE

    def __post_init__(self) -> None:
        check_int("MonitoringTime_ms", self.MonitoringTime_ms, 0, MONITORING_TIME_MAX_MS, ParameterError)
        check_text("AFTER_RESET", self.AFTER_RESET, (STOP_FIRST, AT_ONCE), ParameterError)


@dataclass(frozen=True, slots=True)
class State:
    """Memory between two calls: the state, and the two inputs whose edges count.

    ``stop_seen``: in OutputDisable S_OutControl counts (EDMF-04); FALSE elsewhere. ``elapsed_ms`` runs in
    OutputDisable and OutputEnable and stops at MonitoringTime_ms; elsewhere it is 0. EDM-INST-1
    """

    params: Params
    state: Step
    reset_before: bool
    out_control_before: bool
    stop_seen: bool
    elapsed_ms: int


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one call reads, and the milliseconds since the call before (>= 0). Nothing is coerced.

    Raises InputError.
    """

    dt_ms: int
    Activate: bool
    S_OutControl: bool
    S_EDM1: bool
    S_EDM2: bool
    S_StartReset: bool
    Reset: bool

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_bool("Activate", self.Activate)
        check_bool("S_OutControl", self.S_OutControl)
        check_bool("S_EDM1", self.S_EDM1)
        check_bool("S_EDM2", self.S_EDM2)
        check_bool("S_StartReset", self.S_StartReset)
        check_bool("Reset", self.Reset)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What one call writes: the row of the state that it leaves; DiagCode is a word 0..65535."""

    Ready: bool
    S_EDM_Out: bool
    SafetyDemand: bool
    ResetRequest: bool
    Error: bool
    DiagCode: int


def power_up(params: Params) -> State:
    """Inactive, all inputs as their initial values. EDM-OUT-READY-1, EDM-SEQ-0, EDM-IN-TIME-2"""
    return State(params, Step.IDLE, False, False, False, 0)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One call. First of all comes the end of Activate, then the state decides.

    EDM-IN-ACTIVATE, EDM-INST-1
    """
    if state.state == Step.IDLE:
        after = _idle(state, inputs)
    elif not inputs.Activate:
        after = _enter(state, inputs, Step.IDLE)  # Deactivate
    elif state.state == Step.INIT:
        after = _init(state, inputs)
    elif state.state == Step.RESET_ERROR_1 or state.state == Step.INIT_ERROR:
        after = _start_error(state, inputs)
    elif state.state == Step.OUTPUT_DISABLE:
        after = _output_disable(state, inputs)
    elif state.state == Step.OUTPUT_ENABLE:
        after = _output_enable(state, inputs)
    else:
        after = _error(state, inputs)
    return after, outputs(after)


def outputs(s: State) -> Outputs:
    """The row of the state.

    Inactive, nothing shows (EDM-OUT-READY-1); else Ready does (EDM-OUT-READY-2). The contactors are switched
    in one state alone (EDM-OUT-EDM-1, EDM-OUT-EDM-2). The safety function is requested where the output is
    off and no error and no inhibit is the reason (EDM-OUT-DEMAND, EDMF-03); a reset is required where an
    edge of Reset is waited for (EDM-OUT-REQUEST, EDMF-02). EDM-OUT-ERROR, EDM-OUT-DIAG, EDMF-01
    """
    if s.state == Step.IDLE:
        return Outputs(False, False, False, False, False, 0x0000)
    if s.state == Step.INIT:
        return Outputs(True, False, False, True, False, 0x8401)
    if s.state == Step.OUTPUT_DISABLE:
        return Outputs(True, False, True, False, False, 0x8810)
    if s.state == Step.OUTPUT_ENABLE:
        return Outputs(True, True, False, False, False, 0x8000)
    if s.state == Step.RESET_ERROR_1:
        return Outputs(True, False, False, False, True, 0xC001)
    if s.state == Step.INIT_ERROR:
        return Outputs(True, False, False, False, True, 0xC100)
    for error, code, reset_error, reset_code in ERRORS:
        if s.state == error:
            return Outputs(True, False, False, True, True, code)
        if s.state == reset_error:
            return Outputs(True, False, False, False, True, reset_code)
    raise StateError("state", s.state, "a Step of SF_EDM")


# ---------------------------------------------------------------------------------------- what a call leaves


def _leave(s: State, i: Inputs, after: Step, stop_seen: bool, elapsed_ms: int) -> State:
    """Every call remembers the two inputs whose edges count. EDM-IN-RESET-1"""
    return State(s.params, after, i.Reset, i.S_OutControl, stop_seen, elapsed_ms)


def _enter(s: State, i: Inputs, after: Step) -> State:
    """Another state, with the timer at 0. EDM-INST-1"""
    return _leave(s, i, after, False, 0)


def _stay(s: State, i: Inputs) -> State:
    """The same state, in which no time counts. EDM-INST-1"""
    return _leave(s, i, s.state, False, 0)


def _disable(s: State, i: Inputs, counts: bool) -> State:
    """To the output off on request; the monitoring time starts. EDM-SEQ-2, EDM-SEQ-4, EDM-SEQ-6, EDMF-14"""
    return _leave(s, i, Step.OUTPUT_DISABLE, counts, 0)


def _disable_by_hand(s: State, i: Inputs) -> State:
    """The same after an edge of Reset: a request that stands does not count. EDM-IN-RESET-4, EDMF-04"""
    return _disable(s, i, s.params.AFTER_RESET == AT_ONCE or not i.S_OutControl)


# ---------------------------------------------------------------------------------------- what a call sees


def _time_is_over(s: State, i: Inputs) -> bool:
    """MonitoringTime has passed since the state was entered; from then on in every call.

    EDM-IN-TIME-1, EDMF-08, EDMF-09
    """
    return s.elapsed_ms + i.dt_ms >= s.params.MonitoringTime_ms


def _both_dropped_out(i: Inputs) -> bool:
    """Both contactors show their initial state. EDM-IN-EDM-1, EDM-IN-EDM-2"""
    return i.S_EDM1 and i.S_EDM2


def _both_picked_up(i: Inputs) -> bool:
    """Both contactors show the switched state. EDM-IN-EDM-1"""
    return not i.S_EDM1 and not i.S_EDM2


# ---------------------------------------------------------------------------------------- states


def _idle(s: State, i: Inputs) -> State:
    """Wait for Activate. EDM-IN-ACTIVATE, EDM-SEQ-0, EDM-SEQ-1"""
    if i.Activate:
        return _enter(s, i, Step.INIT)  # Initialize
    return _stay(s, i)  # StayIdle


def _init(s: State, i: Inputs) -> State:
    """The start-up inhibit, if S_StartReset leaves one, and its reset by hand.

    EDM-IN-START-1, EDM-IN-START-2, EDM-IN-START-3, EDM-IN-RESET-2, EDM-IN-RESET-3, EDM-SEQ-1, EDM-SEQ-2

    Reset that is held is an error (EDMF-10), and so is one that rises together with S_OutControl (EDMF-11);
    both only where Reset is waited for.
    """
    if i.S_StartReset:
        return _disable(s, i, True)  # StartWithoutInhibit
    if not i.Reset:
        return _stay(s, i)  # AwaitReset
    if s.reset_before:
        return _enter(s, i, Step.RESET_ERROR_1)  # FindStaticReset
    if rises(i.S_OutControl, s.out_control_before):
        return _enter(s, i, Step.INIT_ERROR)  # FindTwoEdges
    return _disable_by_hand(s, i)  # RemoveInhibit


def _start_error(s: State, i: Inputs) -> State:
    """Wait until Reset is let go; then a fresh edge is needed. EDM-IN-RESET-1, EDMF-10, EDMF-11"""
    if i.Reset:
        return _stay(s, i)  # AwaitRelease
    return _enter(s, i, Step.INIT)  # ReturnToInit


def _output_disable(s: State, i: Inputs) -> State:
    """The output is off: contactors drop out in time and stay so, then a request switches on in its call.

    EDM-IN-TIME-1, EDM-SEQ-2, EDM-SEQ-4, EDM-SEQ-6; EDM-IN-CONTROL-1, EDM-IN-CONTROL-3, EDM-IN-EDM-2,
    EDM-SEQ-3, EDM-SEQ-5, EDMF-05
    """
    requested = i.S_OutControl and s.stop_seen
    if _both_dropped_out(i):
        if requested:
            return _enter(s, i, Step.OUTPUT_ENABLE)  # EnableOutput
    elif _time_is_over(s, i):
        return _not_dropped_out_in_time(s, i)  # MissDropOut
    elif requested:
        return _not_dropped_out_at_request(s, i)  # RefuseRequest
    elapsed_ms = counted(s.elapsed_ms, i.dt_ms, s.params.MonitoringTime_ms)
    return _leave(s, i, Step.OUTPUT_DISABLE, s.stop_seen or not i.S_OutControl, elapsed_ms)  # StayDisabled


def _not_dropped_out_at_request(s: State, i: Inputs) -> State:
    """EDM-IN-EDM-2, EDMF-01, EDMF-05"""
    if i.S_EDM2:
        return _enter(s, i, Step.EDM_ERROR_11)  # RefuseRequest
    if i.S_EDM1:
        return _enter(s, i, Step.EDM_ERROR_12)  # RefuseRequest
    return _enter(s, i, Step.EDM_ERROR_13)  # RefuseRequest


def _not_dropped_out_in_time(s: State, i: Inputs) -> State:
    """EDM-IN-TIME-1, EDMF-01"""
    if i.S_EDM2:
        return _enter(s, i, Step.EDM_ERROR_21)  # MissDropOut
    if i.S_EDM1:
        return _enter(s, i, Step.EDM_ERROR_22)  # MissDropOut
    return _enter(s, i, Step.EDM_ERROR_23)  # MissDropOut


def _output_enable(s: State, i: Inputs) -> State:
    """The output is on: contactors pick up in time and stay so; a stop request switches off in its call.

    EDM-IN-TIME-1, EDM-SEQ-3, EDM-SEQ-5; EDM-IN-CONTROL-2, EDM-SEQ-4. A contactor that did not follow is an
    error also in the call of the stop (EDMF-06).
    """
    if _time_is_over(s, i) and not _both_picked_up(i):
        return _not_picked_up_in_time(s, i)  # MissPickUp
    if not i.S_OutControl:
        return _disable(s, i, True)  # DisableOutput
    elapsed_ms = counted(s.elapsed_ms, i.dt_ms, s.params.MonitoringTime_ms)
    return _leave(s, i, Step.OUTPUT_ENABLE, False, elapsed_ms)  # StayEnabled


def _not_picked_up_in_time(s: State, i: Inputs) -> State:
    """EDM-IN-TIME-1, EDMF-01"""
    if not i.S_EDM2:
        return _enter(s, i, Step.EDM_ERROR_31)  # MissPickUp
    if not i.S_EDM1:
        return _enter(s, i, Step.EDM_ERROR_32)  # MissPickUp
    return _enter(s, i, Step.EDM_ERROR_33)  # MissPickUp


def _error(s: State, i: Inputs) -> State:
    """One of the nine errors, or Reset that is held in it. EDM-IN-RESET-1, EDM-OUT-ERROR, EDM-SEQ-6"""
    for error, _, reset_error, _ in ERRORS:
        if s.state == error:
            return _edm_error(s, i, reset_error)
        if s.state == reset_error:
            return _reset_error(s, i, error)
    raise StateError("state", s.state, "a Step of SF_EDM")


def _edm_error(s: State, i: Inputs, reset_error: Step) -> State:
    """A contactor did not follow: reset by an edge once both have dropped out; Reset must not be held.

    EDM-IN-RESET-1, EDM-IN-RESET-3, EDM-IN-RESET-4, EDM-SEQ-5, EDM-SEQ-6, EDMF-07, EDMF-10
    """
    if not i.Reset:
        return _stay(s, i)  # StayInError
    if s.reset_before:
        return _enter(s, i, reset_error)  # FindStaticResetInError
    if not _both_dropped_out(i):
        return _stay(s, i)  # StayInError
    return _disable_by_hand(s, i)  # ResetError


def _reset_error(s: State, i: Inputs, error: Step) -> State:
    """Wait until Reset is let go; then the error waits for a fresh edge. EDM-IN-RESET-1, EDMF-10"""
    if i.Reset:
        return _stay(s, i)  # AwaitReleaseInError
    return _enter(s, i, error)  # ReturnToError
