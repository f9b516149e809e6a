"""Each theorem about the sensor block falls to a fault planted in a copy of its code."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import pytest
import z3

from modeproof.places import root
from modeproof.registers import load_document
from proofs.sentences import Judge, Sentence
from proofs.solvers import ask_z3
from proofs.testable_safety_sensor import (
    rows,
    sensor_errors,
    sensor_response,
    sensor_safety,
    sensor_test,
    step_paths,
)
from proofs.testable_safety_sensor.devices import SENSOR
from proofs.testable_safety_sensor.sensor_safety import JUDGE
from proofs.theorem import Theorem
from tests.proofs.mode_selection.planted_steps import begun_in, planted, refuted
from tests.refimpl.testable_safety_sensor.printed_rows import ORDER, state_of
from tests.refimpl.testable_safety_sensor.printed_rows import rows as printed

ANYWHERE = sensor_response.JUDGE
Edit = tuple[str, str]


def _state(always: Callable[..., z3.BoolRef]) -> Sentence:
    return JUDGE.after_a_scan(always)


ROW_8402 = "Outputs(True, False, True, False, False, False, True, False, 0x8402)"
FORGETS = ("return State(s.params, c, i.Reset,", "return State(s.params, c, i.Reset and i.Activate,")
LEVEL = ("return rises(i.Reset, s.reset_before)", "return i.Reset")
EXPIRES = "    if _time_is_over(s, i):\n        return _to(s, i, _test_error(i))  # ExpireActive\n"
FREE_FIRST = (EXPIRES, EXPIRES.replace("(s, i):", "(s, i) and not i.S_OSSD_In:"))
FAULTS: list[tuple[str, Judge, str, Sentence, list[Edit]]] = [
    (
        "CodeTellsItsOutputs",
        JUDGE,
        "ESPEInterrupted1",
        _state(rows.code_tells_its_outputs),
        [(ROW_8402, ROW_8402.replace("True, False, 0x", "False, False, 0x"))],
    ),
    (
        "EnableMeansNothingPending",
        JUDGE,
        "ESPEInterrupted1",
        _state(rows.enable_means_nothing_pending),
        [(ROW_8402, ROW_8402.replace("True, False, True", "True, True, True", 1))],
    ),
    (
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
    (
        "PowerUpIsSafe",
        JUDGE,
        "Init",
        lambda one: (z3.Not(one.inputs.Activate), rows.power_up_is_safe(one)),
        [
            (
                "Outputs(False, False, True, False, False, False, False, False, 0x0000)",
                "Outputs(True, False, True, False, False, False, False, False, 0x0000)",
            )
        ],
    ),
    (
        "EdgesAreRemembered",
        JUDGE,
        "Init",
        lambda one: (z3.BoolVal(True), one.after.reset_before == one.inputs.Reset),
        [FORGETS],
    ),
    (
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
    (
        "MaskedTimeIsBounded",
        JUDGE,
        "TestActive",
        _state(sensor_safety.masked_time_is_bounded),
        [("s.elapsed_ms + i.dt_ms >= s.params.TestTime_ms", "s.elapsed_ms + i.dt_ms > s.params.TestTime_ms")],
    ),
    (
        "InactiveAtOnce",
        JUDGE,
        "WaitForReset1",
        sensor_safety.inactive_at_once,
        [("if not i.Activate:", "if not i.Activate and not i.Reset:")],
    ),
    (
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
    (
        "FailedTestNeedsReset",
        JUDGE,
        "TestError1C410",
        sensor_safety.failed_test_needs_reset,
        [("return s.params.AUTO_RESET_ERRORS and i.S_AutoReset", "return i.S_AutoReset")],
    ),
    (
        "StartInhibitHolds",
        JUDGE,
        "WaitForReset1",
        sensor_safety.start_inhibit_holds,
        [("return i.S_AutoReset and not s.start_inhibit", "return i.S_AutoReset")],
    ),
    (
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
    (
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
    (
        "TestNeedsEdgeWhilePossible",
        JUDGE,
        "ESPEFreeNoTest",
        sensor_test.test_needs_edge,
        [("return rises(i.StartTest, s.start_test_before)", "return i.StartTest")],
    ),
    (
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
    ("SlowTestFails", JUDGE, "TestActive", sensor_test.slow_test_fails, [FREE_FIRST]),
    (
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
    (
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
    ("TestExecutedIsTrue", JUDGE, "TestActive", sensor_test.test_executed_is_true, [FREE_FIRST]),
    (
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
    (
        "CodeTellsResettable",
        JUDGE,
        "TestError1C410",
        sensor_errors.code_tells_resettable,
        [("if i.S_OSSD_In and i.NoExternalTest:", "if i.S_OSSD_In:")],
    ),
    (
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
    (
        "StaticResetIsFound",
        JUDGE,
        "EndExternalTest",
        sensor_errors.static_reset_is_found,
        [("return _to(s, i, Step.RESET_ERROR_4)", "return _to(s, i, Step.END_EXTERNAL_TEST)")],
    ),
    (
        "ResetErrorKeepsTestExecuted",
        JUDGE,
        "WaitForReset2",
        sensor_errors.reset_error_keeps_test_executed,
        [("return _to(s, i, Step.RESET_ERROR_6)", "return _to(s, i, Step.RESET_ERROR_4)")],
    ),
    (
        "ExternalTestIsComplete",
        JUDGE,
        "TestError1C410",
        sensor_errors.external_test_is_complete,
        [("if ends and i.S_OSSD_In and i.NoExternalTest:", "if ends and i.S_OSSD_In:")],
    ),
    (
        "ParameterErrorStays",
        JUDGE,
        "Init",
        sensor_errors.parameter_error_stays,
        [("s.params.TestTime_ms <= TEST_TIME_MAX_MS", "s.params.TestTime_ms <= TEST_TIME_MAX_MS + 1")],
    ),
    (
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
    (
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
    (
        "TestedAgain",
        ANYWHERE,
        "TestActive",
        sensor_response.test_comes_closer,
        [("return _to(s, i, Step.ESPE_FREE_TEST_OK)  # SeeFree", "return _to(s, i, Step.ESPE_FREE_NO_TEST)")],
    ),
]


@pytest.mark.parametrize(
    ("name", "judge", "control", "sentence", "edits"), FAULTS, ids=[one[0] for one in FAULTS]
)
def test_a_planted_fault_is_refuted_with_an_example_that_happens(
    name: str, judge: Judge, control: str, sentence: Sentence, edits: list[Edit]
) -> None:
    with planted(judge.device, *edits) as device:
        scan = begun_in(device, control)
        assert refuted(replace(judge, device=device, explored=(scan,)), sentence, control)
    if name != "PowerUpIsSafe":  # it speaks of power-up, and is asked of a call here
        assert not refuted(judge, sentence, control)


def _theorems(*modules: ModuleType) -> list[Theorem]:
    return [one for module in modules for one in vars(module).values() if isinstance(one, Theorem)]


def test_every_property_that_a_theorem_names_has_a_planted_fault() -> None:
    found = _theorems(rows, sensor_safety, sensor_test, sensor_errors, sensor_response, step_paths)
    named = {name for item in found for name in item.properties}
    assert {one[0] for one in FAULTS} >= named - {"EveryCallIsAnswered"}
    beyond_the_block = {"PersonStopsMachine", "EveryPersonIsShown", "StuckSenderFails", "FailedTestIsMended"}
    known = {one.id for one in load_document(root(), "testable_safety_sensor").properties}
    assert known - named == beyond_the_block


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
    assert not [one.name for one in queries[:8] if ask_z3(one, "", 20_000).answer != one.expected]
