"""Each theorem about the sensor block falls to a fault planted in a copy of its code."""

from __future__ import annotations

import pytest
import z3

from proofs.testable_safety_sensor import (
    rows,
    sensor_answers,
    sensor_errors,
    sensor_response,
    sensor_safety,
    sensor_test,
    step_paths,
)
from proofs.testable_safety_sensor.devices import SENSOR
from proofs.testable_safety_sensor.sensor_safety import JUDGE
from tests.proofs.block import Planted, decided, named, wrong_answers
from tests.refimpl.testable_safety_sensor.printed_rows import ORDER, state_of
from tests.refimpl.testable_safety_sensor.printed_rows import rows as printed

ANYWHERE = sensor_response.JUDGE


_state = JUDGE.after_a_scan
ROW_8402 = "Outputs(True, False, True, False, False, False, True, False, 0x8402)"
FORGETS = ("return State(s.params, c, i.Reset,", "return State(s.params, c, i.Reset and i.Activate,")
LEVEL = ("return rises(i.Reset, s.reset_before)", "return i.Reset")
EXPIRES = "    if _time_is_over(s, i):\n        return _to(s, i, _test_error(i))  # ExpireActive\n"
FREE_FIRST = (EXPIRES, EXPIRES.replace("(s, i):", "(s, i) and not i.S_OSSD_In:"))
FAULTS = [
    Planted(
        "CodeTellsItsOutputs",
        JUDGE,
        "ESPEInterrupted1",
        _state(rows.code_tells_its_outputs),
        [(ROW_8402, ROW_8402.replace("True, False, 0x", "False, False, 0x"))],
    ),
    Planted(
        "EnableMeansNothingPending",
        JUDGE,
        "ESPEInterrupted1",
        _state(rows.enable_means_nothing_pending),
        [(ROW_8402, ROW_8402.replace("True, False, True", "True, True, True", 1))],
    ),
    Planted(
        "TestOutOnlyInTestRequest",
        JUDGE,
        "TestRequest",
        _state(rows.test_out_only_in_test_request),
        [
            ("False, False, False, 0x8030", "False, False, False, 0x8020"),
            (
                "(True, True, True, False, False, False, False, False, 0x8020)",
                "(True, True, False, False, False, False, False, False, 0x8030)",
            ),
        ],
    ),
    Planted(
        "PowerUpIsSafe",
        JUDGE,
        "Init",
        lambda scan: (z3.Not(scan.inputs.Activate), rows.power_up_is_safe(scan)),
        [
            (
                "Outputs(False, False, True, False, False, False, False, False, 0x0000)",
                "Outputs(True, False, True, False, False, False, False, False, 0x0000)",
            )
        ],
    ),
    Planted(
        "EdgesAreRemembered",
        JUDGE,
        "Init",
        lambda scan: (z3.BoolVal(True), scan.after.reset_before == scan.inputs.Reset),
        [FORGETS],
    ),
    Planted(
        "EnableNeedsFreeSensor",
        JUDGE,
        "WaitForReset2",
        sensor_safety.enable_needs_free_sensor,
        [
            (
                "if not i.S_OSSD_In:\n        return _to(s, i, Step.ESPE_INTERRUPTED_2)  # InterruptWait2",
                "if not i.S_OSSD_In and not i.Reset:\n        return _to(s, i, Step.ESPE_INTERRUPTED_2)",
            )
        ],
    ),
    Planted(
        "MaskedTimeIsBounded",
        JUDGE,
        "TestActive",
        _state(sensor_safety.masked_time_is_bounded),
        [("s.elapsed_ms + i.dt_ms >= s.params.TestTime_ms", "s.elapsed_ms + i.dt_ms > s.params.TestTime_ms")],
    ),
    Planted(
        "SenderOffIsBounded",
        JUDGE,
        "TestRequest",
        _state(sensor_safety.sender_off_bounded),
        [
            (
                "    if _time_is_over(s, i):\n        return _to(s, i, _test_error(i))  # ExpireRequest\n",
                "    if _time_is_over(s, i) and not i.S_OSSD_In:\n        return _to(s, i, _test_error(i))\n",
            )
        ],
    ),
    Planted(
        "InactiveAtOnce",
        JUDGE,
        "WaitForReset1",
        sensor_safety.inactive_at_once,
        [("if not i.Activate:", "if not i.Activate and not i.Reset:")],
    ),
    Planted(
        "NoRestartByItself",
        JUDGE,
        "ESPEInterrupted2",
        sensor_safety.no_restart_by_itself,
        [
            (
                "if i.S_AutoReset:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
                "if i.S_AutoReset or i.S_StartReset:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
            )
        ],
    ),
    Planted(
        "FailedTestNeedsReset",
        JUDGE,
        "TestError1C410",
        sensor_safety.failed_test_needs_reset,
        [("return s.params.AUTO_RESET_ERRORS and i.S_AutoReset", "return i.S_AutoReset")],
    ),
    Planted(
        "StartInhibitHolds",
        JUDGE,
        "WaitForReset1",
        sensor_safety.start_inhibit_holds,
        [("return i.S_AutoReset and not s.start_inhibit", "return i.S_AutoReset")],
    ),
    Planted(
        "SwitchedOffInhibitEnds",
        JUDGE,
        "Init",
        sensor_safety.switched_off_inhibit_ends,
        [("if _reset_is_static(s, i) and not i.S_StartReset:", "if _reset_is_static(s, i):")],
    ),
    Planted(
        "ResetOnlyWhereRequested",
        JUDGE,
        "ESPEInterrupted2",
        sensor_safety.reset_only_where_requested,
        [
            (
                "if i.S_AutoReset:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
                "if i.S_AutoReset or _reset_rises(s, i):\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
            )
        ],
    ),
    Planted(
        "DemandIsShown",
        JUDGE,
        "EndExternalTest",
        sensor_safety.demand_is_shown,
        [
            (
                "return _to(s, i, Step.ESPE_INTERRUPTED_EXTERNAL_TEST)  # InterruptExternal",
                "return _to(s, i, Step.EXTERNAL_FUNCTION_TEST)",
            )
        ],
    ),
    Planted(
        "TestNeedsEdgeWhilePossible",
        JUDGE,
        "ESPEFreeNoTest",
        sensor_test.test_needs_edge,
        [("return rises(i.StartTest, s.start_test_before)", "return i.StartTest")],
    ),
    Planted(
        "TestStartsAtOnce",
        JUDGE,
        "ESPEFreeTestOk",
        sensor_test.test_starts_at_once,
        [
            (
                "return rises(i.StartTest, s.start_test_before)",
                "return rises(i.StartTest, s.start_test_before) and not i.Reset",
            )
        ],
    ),
    Planted("SlowTestFails", JUDGE, "TestActive", sensor_test.slow_test_fails, [FREE_FIRST]),
    Planted(
        "EachPhaseHasItsTime",
        JUDGE,
        "TestRequest",
        sensor_test.each_phase_has_its_time,
        [
            (
                "s.elapsed_ms + i.dt_ms >= s.params.TestTime_ms",
                "s.elapsed_ms + i.dt_ms + 1 >= s.params.TestTime_ms",
            )
        ],
    ),
    Planted(
        "ReactionIsSeen",
        JUDGE,
        "TestActive",
        sensor_test.reaction_is_seen,
        [
            (
                "if i.S_OSSD_In:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)  # SeeFree",
                "if i.S_OSSD_In and not i.StartTest:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
            )
        ],
    ),
    Planted("TestExecutedIsTrue", JUDGE, "TestActive", sensor_test.test_executed_is_true, [FREE_FIRST]),
    Planted(
        "TestExecutedStays",
        JUDGE,
        "ESPEFreeTestOk",
        sensor_test.test_executed_stays,
        [
            (
                "return _to(s, i, Step.ESPE_INTERRUPTED_2)  # Interrupt2",
                "return _to(s, i, Step.ESPE_INTERRUPTED_1)",
            )
        ],
    ),
    Planted(
        "CodeTellsResettable",
        JUDGE,
        "TestError1C410",
        sensor_errors.code_tells_resettable,
        [("if i.S_OSSD_In and i.NoExternalTest:", "if i.S_OSSD_In:")],
    ),
    Planted(
        "ErrorLeftOnlyAsDocumented",
        JUDGE,
        "ResetError4",
        sensor_errors.error_left_only_as_documented,
        [
            (
                "if c == Step.RESET_ERROR_4:\n        return _to(s, i, Step.END_EXTERNAL_TEST)",
                "if c == Step.RESET_ERROR_4:\n        return _to(s, i, Step.WAIT_FOR_RESET_2)",
            )
        ],
    ),
    Planted(
        "StaticResetIsFound",
        JUDGE,
        "EndExternalTest",
        sensor_errors.static_reset_is_found,
        [("return _to(s, i, Step.RESET_ERROR_4)", "return _to(s, i, Step.END_EXTERNAL_TEST)")],
    ),
    Planted(
        "ResetErrorKeepsTestExecuted",
        JUDGE,
        "WaitForReset2",
        sensor_errors.reset_error_keeps_test_executed,
        [("return _to(s, i, Step.RESET_ERROR_6)", "return _to(s, i, Step.RESET_ERROR_4)")],
    ),
    Planted(
        "ExternalTestIsComplete",
        JUDGE,
        "TestError1C410",
        sensor_errors.external_test_is_complete,
        [("if ends and i.S_OSSD_In and i.NoExternalTest:", "if ends and i.S_OSSD_In:")],
    ),
    Planted(
        "ParameterErrorStays",
        JUDGE,
        "Init",
        sensor_errors.parameter_error_stays,
        [("s.params.TestTime_ms <= TEST_TIME_MAX_MS", "s.params.TestTime_ms <= TEST_TIME_MAX_MS + 1")],
    ),
    Planted(
        "OneTransitionPerCall",
        JUDGE,
        "ESPEInterruptedExternalTest",
        sensor_errors.one_transition,
        [
            (
                "return _to(s, i, Step.END_EXTERNAL_TEST)  # BecomeFreeExternal",
                "return _to(s, i, Step.WAIT_FOR_RESET_1)",
            )
        ],
    ),
    Planted(
        "CodeIsThePrintedOne",
        JUDGE,
        "ESPEInterrupted1",
        _state(sensor_answers.code_is_the_printed_one),
        [(ROW_8402, ROW_8402.replace("0x8402", "0x8442"))],
    ),
    Planted(
        "DemandNeedsDarkSensor",
        JUDGE,
        "ESPEInterrupted2",
        sensor_answers.demand_needs_dark_sensor,
        [
            (
                "return _to(s, i, Step.WAIT_FOR_RESET_2)  # BecomeFree2",
                "return _to(s, i, Step.ESPE_INTERRUPTED_2)",
            )
        ],
    ),
    Planted(
        "ResetEndsAtOnce",
        JUDGE,
        "WaitForReset2",
        sensor_answers.reset_ends_at_once,
        [
            (
                "if _reset_rises(s, i) or i.S_AutoReset:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
                "if i.S_AutoReset:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
            )
        ],
    ),
    Planted(
        "ResetErrorNeedsHeldReset",
        JUDGE,
        "Init",
        sensor_answers.reset_error_needs_held_reset,
        [("if _reset_is_static(s, i) and not i.S_StartReset:", "if s.reset_before and not i.S_StartReset:")],
    ),
    Planted(
        "ManualTestIsSeen",
        JUDGE,
        "ExternalFunctionTest",
        sensor_answers.manual_test_is_seen,
        [
            (
                "if s.sensor_before and not i.S_OSSD_In:",
                "if s.sensor_before and not i.S_OSSD_In and not i.Reset:",
            )
        ],
    ),
    Planted(
        "ParameterErrorNeedsCause",
        JUDGE,
        "Init",
        sensor_answers.parameter_error_needs_cause,
        [("return s.params.TestTime_ms >= 0 and", "return s.params.TestTime_ms > 0 and")],
    ),
    Planted(
        "ActiveAtOnce",
        JUDGE,
        "Idle",
        sensor_answers.active_at_once,
        [
            (
                "return _to(s, i, Step.INIT)  # BecomeActive",
                "return _to(s, i, Step.IDLE if i.Reset else Step.INIT)",
            )
        ],
    ),
    Planted(
        "EnablesAgain",
        ANYWHERE,
        "ExternalFunctionTest",
        sensor_response.comes_closer,
        [
            (
                "if s.sensor_before and not i.S_OSSD_In:",
                "if s.sensor_before and not i.S_OSSD_In and i.StartTest:",
            )
        ],
    ),
    Planted(
        "TestedAgain",
        ANYWHERE,
        "TestActive",
        sensor_response.test_comes_closer,
        [("return _to(s, i, Step.ESPE_FREE_TEST_OK)  # SeeFree", "return _to(s, i, Step.ESPE_FREE_NO_TEST)")],
    ),
]


@pytest.mark.sampled(8)
@pytest.mark.parametrize("fault", FAULTS, ids=[fault.name for fault in FAULTS])
def test_a_planted_fault_is_refuted_with_an_example_that_happens(fault: Planted) -> None:
    assert fault.refuted()
    if fault.name != "PowerUpIsSafe":  # it speaks of power-up, and is asked of a call here
        assert not fault.refuted_unplanted()


def test_every_property_that_a_theorem_names_has_a_planted_fault() -> None:
    proved = named(
        *(rows, sensor_answers, sensor_safety, sensor_test, sensor_errors, sensor_response, step_paths)
    )
    assert {fault.name for fault in FAULTS} >= proved - {"EveryCallIsAnswered"}
    beyond_the_block = {"PersonStopsMachine", "EveryPersonIsShown", "StuckSenderFails", "FailedTestIsMended"}
    known = decided("testable_safety_sensor")
    assert known - proved == beyond_the_block


def test_the_rows_of_the_theorem_are_those_of_the_table() -> None:
    assert ORDER == rows.OUTPUTS
    wanted = {
        state_of(name, code): (code, tuple(output for output, true in zip(ORDER, row, strict=True) if true))
        for (name, code), row in printed().items()
    }
    assert wanted == rows.TRUE_IN


def test_the_theorem_of_the_paths_is_true() -> None:
    queries = step_paths.every_call_of_the_block_takes_exactly_one_path.queries()
    assert len(queries) >= 2 * len(SENSOR.register.states)
    assert not wrong_answers(queries[:8])
