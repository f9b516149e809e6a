"""SF_TestableSafetySensor: it shows what a safety sensor sees, and tests the sensor while the machine runs.

One call of ``step`` is one cycle: the inputs are read once, at most one transition leads out of the state of
the call before, and the outputs are the row of the state after it. The end of Activate comes first, in every
state; then a static Reset or an expired time, then the loss of the sensor, then what a person or the program
asks for. A name at the start of a comment, such as "SeeDark", is the step as
spec/testable_safety_sensor/interface.toml calls it.

The document prints the codes and their outputs, and no transitions (TSSF-27).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from refimpl.cyclic_block import counted, held, rises
from refimpl.errors import ParameterError, StateError, check_bool, check_int

TIME_MIN_MS = -2_147_483_648
TIME_MAX_MS = 2_147_483_647
"""What a variable of type TIME can hold; the block itself judges what of it is a TestTime."""
TEST_TIME_MAX_MS = 150


class Step(Enum):
    """The state of the block; each has its own DiagCode. TSS-OUT-DIAG"""

    IDLE = "Idle"
    INIT = "Init"
    ESPE_INTERRUPTED_1 = "ESPEInterrupted1"
    WAIT_FOR_RESET_1 = "WaitForReset1"
    EXTERNAL_FUNCTION_TEST = "ExternalFunctionTest"
    ESPE_INTERRUPTED_EXTERNAL_TEST = "ESPEInterruptedExternalTest"
    END_EXTERNAL_TEST = "EndExternalTest"
    ESPE_FREE_NO_TEST = "ESPEFreeNoTest"
    ESPE_INTERRUPTED_2 = "ESPEInterrupted2"
    WAIT_FOR_RESET_2 = "WaitForReset2"
    TEST_REQUEST = "TestRequest"
    TEST_ACTIVE = "TestActive"
    ESPE_FREE_TEST_OK = "ESPEFreeTestOk"
    PARAMETER_ERROR = "ParameterError"
    RESET_ERROR_1 = "ResetError1"
    RESET_ERROR_2 = "ResetError2"
    RESET_ERROR_3 = "ResetError3"
    RESET_ERROR_4 = "ResetError4"
    RESET_ERROR_5 = "ResetError5"
    RESET_ERROR_6 = "ResetError6"
    TEST_ERROR_1_C010 = "TestError1C010"
    TEST_ERROR_1_C410 = "TestError1C410"


@dataclass(frozen=True, slots=True)
class Params:
    """The constants of the block.

    TestTime_ms: how long each phase of a test may last, in milliseconds; any value that a TIME can hold.
    Outside 0..150 the block goes to its own error C000 (TSS-C000, TSS-IN-TESTTIME). AUTO_RESET_ERRORS: TRUE
    lets S_AutoReset end test errors and manual tests too (TSSF-15). Raises ParameterError.
    """

    TestTime_ms: int = 10
    AUTO_RESET_ERRORS: bool = True

    def __post_init__(self) -> None:
        check_int("TestTime_ms", self.TestTime_ms, TIME_MIN_MS, TIME_MAX_MS, ParameterError)
        check_bool("AUTO_RESET_ERRORS", self.AUTO_RESET_ERRORS, ParameterError)


@dataclass(frozen=True, slots=True)
class State:
    """Memory of the block between two calls.

    ``reset_before``, ``start_test_before``, ``sensor_before``: Reset, StartTest and S_OSSD_In as the call
    before read them. ``start_inhibit``: the start-up inhibit is still to be reset, after an interruption
    (TSSF-19). ``elapsed_ms`` >= 0: time in this phase of the test.
    """

    params: Params
    state: Step
    reset_before: bool
    start_test_before: bool
    sensor_before: bool
    start_inhibit: bool
    elapsed_ms: int


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one call reads. Building it checks every field and raises InputError; nothing is coerced.

    ``dt_ms`` >= 0: time since the call before. All others are booleans, with the document's names.
    """

    dt_ms: int
    Activate: bool
    S_OSSD_In: bool
    StartTest: bool
    NoExternalTest: bool
    S_StartReset: bool
    S_AutoReset: bool
    Reset: bool

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_bool("Activate", self.Activate)
        check_bool("S_OSSD_In", self.S_OSSD_In)
        check_bool("StartTest", self.StartTest)
        check_bool("NoExternalTest", self.NoExternalTest)
        check_bool("S_StartReset", self.S_StartReset)
        check_bool("S_AutoReset", self.S_AutoReset)
        check_bool("Reset", self.Reset)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What one call writes, in the order of the document; DiagCode is a word 0..65535."""

    Ready: bool
    S_OSSD_Out: bool
    S_TestOut: bool
    TestPossible: bool
    TestExecuted: bool
    SafetyDemand: bool
    ResetRequest: bool
    Error: bool
    DiagCode: int


def power_up(params: Params) -> State:
    """The state after power-up: not active, and every input was FALSE. TSS-0000, TSS-FN-3"""
    return State(params, Step.IDLE, False, False, False, False, 0)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One call. Edges are remembered whether the block is active or not. TSS-IN-ACTIVATE, TSS-IN-RESET"""
    after = _next_state(state, inputs)
    return after, outputs(after)


def outputs(s: State) -> Outputs:
    """The row of the state, as the document's table prints it.

    TSS-OUT-READY, TSS-OUT-OSSD, TSS-OUT-TESTOUT, TSS-OUT-POSSIBLE, TSS-OUT-EXECUTED, TSS-OUT-DEMAND,
    TSS-OUT-REQUEST, TSS-OUT-ERROR, TSS-OUT-DIAG
    """
    c = s.state
    if c == Step.IDLE or c == Step.INIT:
        return _row_of_start(c)
    if c == Step.ESPE_INTERRUPTED_1 or c == Step.WAIT_FOR_RESET_1:
        return _row_before_test(c)
    if c == Step.ESPE_INTERRUPTED_2 or c == Step.WAIT_FOR_RESET_2:
        return _row_after_test(c)
    if c == Step.EXTERNAL_FUNCTION_TEST:  # TSS-8002
        return Outputs(True, False, True, False, False, False, False, False, 0x8002)
    if c == Step.ESPE_INTERRUPTED_EXTERNAL_TEST:  # TSS-8804
        return Outputs(True, False, True, False, False, True, False, False, 0x8804)
    if c == Step.END_EXTERNAL_TEST:  # TSS-8404
        return Outputs(True, False, True, False, False, False, True, False, 0x8404)
    if c == Step.ESPE_FREE_NO_TEST:  # TSS-8010
        return Outputs(True, True, True, True, False, False, False, False, 0x8010)
    if c == Step.TEST_REQUEST:  # TSS-8020
        return Outputs(True, True, False, False, False, False, False, False, 0x8020)
    if c == Step.TEST_ACTIVE:  # TSS-8030
        return Outputs(True, True, True, False, False, False, False, False, 0x8030)
    if c == Step.ESPE_FREE_TEST_OK:  # TSS-8000
        return Outputs(True, True, True, True, True, False, False, False, 0x8000)
    return _row_of_error(c)


def _row_of_start(c: Step) -> Outputs:
    """TSS-0000 (S_TestOut is TRUE there, TSSF-05), TSS-8401 (ResetRequest is TRUE there, TSSF-30)."""
    if c == Step.IDLE:
        return Outputs(False, False, True, False, False, False, False, False, 0x0000)
    return Outputs(True, False, True, False, False, False, True, False, 0x8401)


def _row_before_test(c: Step) -> Outputs:
    """TSS-8802, TSS-8402"""
    if c == Step.ESPE_INTERRUPTED_1:
        return Outputs(True, False, True, False, False, True, False, False, 0x8802)
    return Outputs(True, False, True, False, False, False, True, False, 0x8402)


def _row_after_test(c: Step) -> Outputs:
    """TSS-8806, TSS-8406"""
    if c == Step.ESPE_INTERRUPTED_2:
        return Outputs(True, False, True, False, True, True, False, False, 0x8806)
    return Outputs(True, False, True, False, True, False, True, False, 0x8406)


def _row_of_error(c: Step) -> Outputs:
    """In every error the enable output is FALSE. TSS-EB-1

    TSS-C000, TSS-C001, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051, TSS-C010, TSS-C410
    """
    if c == Step.PARAMETER_ERROR:
        return Outputs(True, False, True, False, False, False, False, True, 0xC000)
    if c == Step.RESET_ERROR_1:
        return Outputs(True, False, True, False, False, False, False, True, 0xC001)
    if c == Step.RESET_ERROR_2:
        return Outputs(True, False, True, False, False, False, False, True, 0xC011)
    if c == Step.RESET_ERROR_3:
        return Outputs(True, False, True, False, False, False, False, True, 0xC021)
    if c == Step.RESET_ERROR_4:
        return Outputs(True, False, True, False, False, False, False, True, 0xC031)
    if c == Step.RESET_ERROR_5:
        return Outputs(True, False, True, False, False, False, False, True, 0xC041)
    if c == Step.RESET_ERROR_6:
        return Outputs(True, False, True, False, True, False, False, True, 0xC051)
    if c == Step.TEST_ERROR_1_C010:
        return Outputs(True, False, True, False, False, False, False, True, 0xC010)
    return Outputs(True, False, True, False, False, False, True, True, 0xC410)


def _next_state(s: State, i: Inputs) -> State:
    """The end of Activate first, from every state; then what the state says. TSS-IN-ACTIVATE, TSS-0000"""
    if not i.Activate:
        return _to(s, i, Step.IDLE)  # Deactivate, StayIdle
    c = s.state
    if c == Step.IDLE:
        return _to(s, i, Step.INIT)  # BecomeActive
    if c == Step.INIT:
        return _init(s, i)
    if c == Step.ESPE_INTERRUPTED_1:
        return _espe_interrupted1(s, i)
    if c == Step.WAIT_FOR_RESET_1:
        return _wait_for_reset1(s, i)
    if c == Step.EXTERNAL_FUNCTION_TEST:
        return _external_function_test(s, i)
    if c == Step.ESPE_INTERRUPTED_EXTERNAL_TEST:
        return _espe_interrupted_external_test(s, i)
    if c == Step.END_EXTERNAL_TEST:
        return _end_external_test(s, i)
    if c == Step.ESPE_FREE_NO_TEST:
        return _espe_free_no_test(s, i)
    if c == Step.ESPE_INTERRUPTED_2:
        return _espe_interrupted2(s, i)
    if c == Step.WAIT_FOR_RESET_2:
        return _wait_for_reset2(s, i)
    if c == Step.TEST_REQUEST:
        return _test_request(s, i)
    if c == Step.TEST_ACTIVE:
        return _test_active(s, i)
    if c == Step.ESPE_FREE_TEST_OK:
        return _espe_free_test_ok(s, i)
    if c == Step.TEST_ERROR_1_C010:
        return _test_error1_c010(s, i)
    if c == Step.TEST_ERROR_1_C410:
        return _test_error1_c410(s, i)
    return _parameter_or_reset_error(s, i)


def _to(s: State, i: Inputs, c: Step, start_inhibit: bool = False, elapsed_ms: int = 0) -> State:
    """Go to a state, or stay there; what this call read is remembered for the next."""
    return State(s.params, c, i.Reset, i.StartTest, i.S_OSSD_In, start_inhibit, elapsed_ms)


# ---------------------------------------------------------------- what the guards ask


def _reset_rises(s: State, i: Inputs) -> bool:
    """The edge that removes an inhibit or an error. TSS-IN-RESET, TSS-EB-3, TSS-EB-4, TSS-EB-5"""
    return rises(i.Reset, s.reset_before)


def _reset_is_static(s: State, i: Inputs) -> bool:
    """Reset is held or stuck: an error where a reset is waited for, never a reset. TSS-ERR-3, TSSF-24"""
    return held(i.Reset, s.reset_before)


def _test_is_asked_for(s: State, i: Inputs) -> bool:
    """An edge of StartTest in this very call; others are not remembered. TSS-IN-STARTTEST, TSSF-23"""
    return rises(i.StartTest, s.start_test_before)


def _time_is_over(s: State, i: Inputs) -> bool:
    """TestTime has passed in this phase, this call included. TSS-TEST-0, TSS-ERR-1, TSS-ERR-2, TSSF-08"""
    return s.elapsed_ms + i.dt_ms >= s.params.TestTime_ms


def _test_time_fits(s: State) -> bool:
    """TSS-IN-TESTTIME, TSS-ERR-4"""
    return s.params.TestTime_ms >= 0 and s.params.TestTime_ms <= TEST_TIME_MAX_MS


def _restarts_by_itself(s: State, i: Inputs) -> bool:
    """The restart inhibit is switched off, and no start-up inhibit is left.

    TSS-IN-AUTORESET, TSS-FN-2, TSSF-19
    """
    return i.S_AutoReset and not s.start_inhibit


def _error_ends_by_itself(s: State, i: Inputs) -> bool:
    """S_AutoReset ends a test error only where the parameter says so. TSS-EB-3, TSSF-15"""
    return s.params.AUTO_RESET_ERRORS and i.S_AutoReset


# ---------------------------------------------------------------- activation


def _init(s: State, i: Inputs) -> State:
    """The constants are judged, then Reset, then the sensor; then the start-up inhibit ends.

    TSS-8401, TSS-ERR-4, TSS-FN-3, TSS-EB-5, TSS-IN-STARTRESET, TSSF-11
    """
    if not _test_time_fits(s):
        return _to(s, i, Step.PARAMETER_ERROR)  # RefuseTestTime
    if _reset_is_static(s, i) and not i.S_StartReset:
        return _to(s, i, Step.RESET_ERROR_1)  # FindStaticReset1
    if not i.S_OSSD_In:
        return _to(s, i, Step.ESPE_INTERRUPTED_1, start_inhibit=not i.S_StartReset)  # InterruptStart
    if i.S_StartReset or _reset_rises(s, i):
        return _to(s, i, Step.ESPE_FREE_NO_TEST)  # EndStartInhibit
    return _to(s, i, Step.INIT)  # AwaitStartReset


# ---------------------------------------------------------------- interrupted, and free again


def _espe_interrupted1(s: State, i: Inputs) -> State:
    """Before any test: wait until the sensor is free. TSS-8802, TSS-REL-1, TSSF-04, TSSF-19"""
    if not i.S_OSSD_In:
        return _to(s, i, Step.ESPE_INTERRUPTED_1, s.start_inhibit)  # AwaitFree1
    if _restarts_by_itself(s, i):
        return _to(s, i, Step.ESPE_FREE_NO_TEST)  # Restart1
    return _to(s, i, Step.WAIT_FOR_RESET_1, s.start_inhibit)  # BecomeFree1


def _wait_for_reset1(s: State, i: Inputs) -> State:
    """TSS-8402, TSS-REL-1, TSS-EB-4, TSSF-01, TSSF-20, TSSF-21"""
    if _restarts_by_itself(s, i):
        if i.S_OSSD_In:
            return _to(s, i, Step.ESPE_FREE_NO_TEST)  # EndRestartInhibit1
        return _to(s, i, Step.ESPE_INTERRUPTED_1)  # InterruptWait1
    if _reset_is_static(s, i):
        return _to(s, i, Step.RESET_ERROR_2, s.start_inhibit)  # FindStaticReset2
    if not i.S_OSSD_In:
        return _to(s, i, Step.ESPE_INTERRUPTED_1, s.start_inhibit)  # InterruptWait1
    if _reset_rises(s, i):
        return _to(s, i, Step.ESPE_FREE_NO_TEST)  # EndRestartInhibit1
    return _to(s, i, Step.WAIT_FOR_RESET_1, s.start_inhibit)  # AwaitReset1


def _espe_interrupted2(s: State, i: Inputs) -> State:
    """After a test that was passed: wait until the sensor is free. TSS-8806, TSS-REL-1, TSSF-04"""
    if not i.S_OSSD_In:
        return _to(s, i, Step.ESPE_INTERRUPTED_2)  # AwaitFree2
    if i.S_AutoReset:
        return _to(s, i, Step.ESPE_FREE_TEST_OK)  # Restart2
    return _to(s, i, Step.WAIT_FOR_RESET_2)  # BecomeFree2


def _wait_for_reset2(s: State, i: Inputs) -> State:
    """TSS-8406, TSS-REL-1, TSS-EB-4, TSSF-02, TSSF-03, TSSF-20, TSSF-21"""
    if _reset_is_static(s, i) and not i.S_AutoReset:
        return _to(s, i, Step.RESET_ERROR_6)  # FindStaticReset6
    if not i.S_OSSD_In:
        return _to(s, i, Step.ESPE_INTERRUPTED_2)  # InterruptWait2
    if _reset_rises(s, i) or i.S_AutoReset:
        return _to(s, i, Step.ESPE_FREE_TEST_OK)  # EndRestartInhibit2
    return _to(s, i, Step.WAIT_FOR_RESET_2)  # AwaitReset2


# ---------------------------------------------------------------- free, and the test


def _espe_free_no_test(s: State, i: Inputs) -> State:
    """TSS-8010, TSS-FN-1, TSS-IN-OSSD, TSS-TEST-1, TSS-NOTE-4, TSSF-22"""
    if not i.S_OSSD_In:
        return _to(s, i, Step.ESPE_INTERRUPTED_1)  # Interrupt1
    if _test_is_asked_for(s, i):
        return _to(s, i, Step.TEST_REQUEST)  # StartTest1
    return _to(s, i, Step.ESPE_FREE_NO_TEST)  # StayFree1


def _espe_free_test_ok(s: State, i: Inputs) -> State:
    """TSS-8000, TSS-FN-1, TSS-IN-OSSD, TSS-TEST-1, TSS-NOTE-4, TSSF-22"""
    if not i.S_OSSD_In:
        return _to(s, i, Step.ESPE_INTERRUPTED_2)  # Interrupt2
    if _test_is_asked_for(s, i):
        return _to(s, i, Step.TEST_REQUEST)  # StartTest2
    return _to(s, i, Step.ESPE_FREE_TEST_OK)  # StayFree2


def _test_request(s: State, i: Inputs) -> State:
    """The sensor's sender is off: it has to become dark within TestTime. Then the time starts anew.

    TSS-8020, TSS-TEST-1, TSS-TEST-2, TSS-ERR-2, TSSF-06, TSSF-07, TSSF-09
    """
    if _time_is_over(s, i):
        return _to(s, i, _test_error(i))  # ExpireRequest
    if not i.S_OSSD_In:
        return _to(s, i, Step.TEST_ACTIVE)  # SeeDark
    return _to(s, i, Step.TEST_REQUEST, elapsed_ms=_time_so_far(s, i))  # AwaitDark


def _test_active(s: State, i: Inputs) -> State:
    """The sender is on again: the sensor has to become free within TestTime.

    TSS-8030, TSS-TEST-2, TSS-TEST-3, TSS-ERR-1, TSS-FN-5, TSSF-07
    """
    if _time_is_over(s, i):
        return _to(s, i, _test_error(i))  # ExpireActive
    if i.S_OSSD_In:
        return _to(s, i, Step.ESPE_FREE_TEST_OK)  # SeeFree
    return _to(s, i, Step.TEST_ACTIVE, elapsed_ms=_time_so_far(s, i))  # AwaitFree


def _time_so_far(s: State, i: Inputs) -> int:
    """TSS-TEST-0"""
    return counted(s.elapsed_ms, i.dt_ms, s.params.TestTime_ms)


# ---------------------------------------------------------------- a failed test, and the manual test


def _test_error(i: Inputs) -> Step:
    """Cx10: x is 4 with the sensor free and no manual test to be made, 0 otherwise.

    TSS-CX10, TSS-C410, TSS-C010, TSSF-17
    """
    if i.S_OSSD_In and i.NoExternalTest:
        return Step.TEST_ERROR_1_C410
    return Step.TEST_ERROR_1_C010


def _test_error1_c010(s: State, i: Inputs) -> State:
    """It cannot be reset as it is; where a manual test is to be made, an edge of Reset begins it.

    TSS-C010, TSS-CX10, TSS-IN-NOEXT-FALSE, TSSF-13, TSSF-14, TSSF-18
    """
    if _reset_is_static(s, i) and not _error_ends_by_itself(s, i):
        return _to(s, i, Step.RESET_ERROR_3)  # FindStaticReset3
    if not i.NoExternalTest and (_reset_rises(s, i) or _error_ends_by_itself(s, i)):
        return _to(s, i, Step.EXTERNAL_FUNCTION_TEST)  # RequireExternalTest
    return _to(s, i, _test_error(i))  # ShowTestError


def _test_error1_c410(s: State, i: Inputs) -> State:
    """An edge of Reset ends it, and enables. TSS-C410, TSS-EB-2, TSS-EB-3, TSS-IN-NOEXT-TRUE, TSSF-15"""
    if _reset_is_static(s, i) and not _error_ends_by_itself(s, i):
        return _to(s, i, Step.RESET_ERROR_3)  # FindStaticReset3
    ends = _reset_rises(s, i) or _error_ends_by_itself(s, i)
    if ends and i.S_OSSD_In and i.NoExternalTest:
        return _to(s, i, Step.ESPE_FREE_NO_TEST)  # ResetTestError
    if ends and not i.NoExternalTest:
        return _to(s, i, Step.EXTERNAL_FUNCTION_TEST)  # RequireExternalTest
    return _to(s, i, _test_error(i))  # ShowTestError


def _external_function_test(s: State, i: Inputs) -> State:
    """Wait for a person to interrupt the sensor: a falling edge, not darkness. TSS-8002, TSSF-16"""
    if s.sensor_before and not i.S_OSSD_In:
        return _to(s, i, Step.ESPE_INTERRUPTED_EXTERNAL_TEST)  # BeginExternalTest
    return _to(s, i, Step.EXTERNAL_FUNCTION_TEST)  # AwaitExternalTest


def _espe_interrupted_external_test(s: State, i: Inputs) -> State:
    """TSS-8804"""
    if i.S_OSSD_In:
        return _to(s, i, Step.END_EXTERNAL_TEST)  # BecomeFreeExternal
    return _to(s, i, Step.ESPE_INTERRUPTED_EXTERNAL_TEST)  # AwaitFreeExternal


def _end_external_test(s: State, i: Inputs) -> State:
    """The manual test is made; an edge of Reset enables. TSS-8404, TSS-IN-NOEXT-FALSE, TSSF-02, TSSF-31"""
    if _reset_is_static(s, i) and not _error_ends_by_itself(s, i):
        return _to(s, i, Step.RESET_ERROR_4)  # FindStaticReset4
    if not i.S_OSSD_In:
        return _to(s, i, Step.ESPE_INTERRUPTED_EXTERNAL_TEST)  # InterruptExternal
    if _reset_rises(s, i) or _error_ends_by_itself(s, i):
        return _to(s, i, Step.ESPE_FREE_NO_TEST)  # EndManualTest
    return _to(s, i, Step.END_EXTERNAL_TEST)  # AwaitExternalReset


# ---------------------------------------------------------------- the other errors


def _parameter_or_reset_error(s: State, i: Inputs) -> State:
    """No reset helps against a constant out of its range; a reset error ends with Reset, where it was found.

    TSS-C000, TSS-C001, TSS-C011, TSS-C021, TSS-C031, TSS-C041, TSS-C051, TSS-ERR-3, TSSF-12
    """
    c = s.state
    if c == Step.PARAMETER_ERROR:
        if _reset_is_static(s, i):
            return _to(s, i, Step.RESET_ERROR_5)  # FindStaticReset5
        return _to(s, i, Step.PARAMETER_ERROR)  # StayInParameterError
    if i.Reset:
        return _to(s, i, c, s.start_inhibit)  # StayInResetError
    # LeaveResetError
    if c == Step.RESET_ERROR_1:
        return _to(s, i, Step.INIT)
    if c == Step.RESET_ERROR_2:
        return _to(s, i, Step.WAIT_FOR_RESET_1, s.start_inhibit)
    if c == Step.RESET_ERROR_3:
        return _to(s, i, _test_error(i))
    if c == Step.RESET_ERROR_4:
        return _to(s, i, Step.END_EXTERNAL_TEST)
    if c == Step.RESET_ERROR_5:
        return _to(s, i, Step.PARAMETER_ERROR)
    if c == Step.RESET_ERROR_6:
        return _to(s, i, Step.WAIT_FOR_RESET_2)
    raise StateError("state", c, "a Step of the block")
