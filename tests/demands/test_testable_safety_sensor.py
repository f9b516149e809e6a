"""The demands of the page on the testable safety sensor: what they allow, and what breaks each of them."""

from __future__ import annotations

from typing import Any

import pytest

from tests.demands.trials import Edit, Trial

TRIAL = Trial(
    "testable_safety_sensor",
    "sf_testable_safety_sensor",
    (1, 5, 9),
    {"Activate": 0.96, "S_OSSD_In": 0.8, "Reset": 0.35},
    ("S_StartReset", "S_AutoReset", "NoExternalTest"),
    ("S_OSSD_In", "S_TestOut"),
)
LETTER = {"TestTime_ms": 20}
CAUTIOUS = {"TestTime_ms": 20, "AUTO_RESET_ERRORS": False}
INVALID = {"TestTime_ms": 151}
EXPIRE_REQUEST = "    if _time_is_over(s, i):\n        return _to(s, i, _test_error(i))  # ExpireRequest\n"
EXPIRE_ACTIVE = "    if _time_is_over(s, i):\n        return _to(s, i, _test_error(i))  # ExpireActive\n"
FAULTS: dict[str, list[Edit]] = {
    "InactiveIsIdle": [("    if not i.Activate:\n", "    if not i.Activate and not i.Reset:\n")],
    "ActiveIsReady": [("return _to(s, i, Step.INIT)  # BecomeActive", "return _to(s, i, Step.IDLE)")],
    "CodeIsInTheTable": [("True, False, False, 0x8802)", "True, False, False, 0x8812)")],
    "OutputsAreTheRowOfTheCode": [
        (
            "Outputs(True, False, True, False, False, False, True, False, 0x8402)",
            "Outputs(True, False, True, True, False, False, True, False, 0x8402)",
        )
    ],
    "DarkSensorSwitchesOff": [
        (
            "return _to(s, i, Step.ESPE_INTERRUPTED_1)  # Interrupt1",
            "return _to(s, i, Step.ESPE_FREE_NO_TEST)",
        )
    ],
    "EnableLasts": [
        (
            "return _to(s, i, Step.TEST_ACTIVE)  # SeeDark",
            "return _to(s, i, Step.TEST_ACTIVE, elapsed_ms=_time_so_far(s, i))",
        )
    ],
    "InhibitGoesByHand": [("    if i.S_StartReset or _reset_rises(s, i):", "    if True:")],
    "FailedTestNeedsEdge": [
        ("return s.params.AUTO_RESET_ERRORS and i.S_AutoReset", "return i.S_AutoReset or i.S_StartReset")
    ],
    "RunsByItself": [("return i.S_AutoReset and not s.start_inhibit", "return False")],
    "ResetEndsInhibit": [
        (
            "    if _reset_rises(s, i):\n        return _to(s, i, Step.ESPE_FREE_NO_TEST)  # EndRestart"
            "Inhibit1\n",
            "",
        )
    ],
    "LostSensorIsShown": [
        (
            "return _to(s, i, Step.ESPE_INTERRUPTED_2)  # Interrupt2",
            "return _to(s, i, Step.ESPE_INTERRUPTED_1)",
        )
    ],
    "ReturnAsksForReset": [
        ("return _to(s, i, Step.WAIT_FOR_RESET_2)  # BecomeFree2", "return _to(s, i, Step.WAIT_FOR_RESET_1)")
    ],
    "TestNeedsEdge": [("return rises(i.StartTest, s.start_test_before)", "return i.StartTest")],
    "TestNeedsTestPossible": [
        (
            "    if i.S_OSSD_In:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)  # SeeFree",
            "    if i.S_OSSD_In and _test_is_asked_for(s, i):\n        return _to(s, i, Step.TEST_REQUEST)\n"
            "    if i.S_OSSD_In:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
        )
    ],
    "TestBegins": [("return rises(i.StartTest, s.start_test_before)", "return i.StartTest and i.Reset")],
    "SenderStaysOffUntilDark": [
        (
            "return _to(s, i, Step.TEST_REQUEST, elapsed_ms=_time_so_far(s, i))",
            "return _to(s, i, Step.TEST_ACTIVE)",
        )
    ],
    "DarkSensorTurnsSenderOn": [
        ("    if not i.S_OSSD_In:\n        return _to(s, i, Step.TEST_ACTIVE)  # SeeDark\n", "")
    ],
    "FreeSensorEndsTest": [
        ("    if i.S_OSSD_In:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)  # SeeFree\n", "")
    ],
    "TestEndsWithFreeSensor": [
        ("return _to(s, i, Step.TEST_ACTIVE)  # SeeDark", "return _to(s, i, Step.ESPE_FREE_TEST_OK)")
    ],
    "PassedTestIsShown": [
        ("return _to(s, i, Step.ESPE_FREE_TEST_OK)  # SeeFree", "return _to(s, i, Step.ESPE_FREE_NO_TEST)")
    ],
    "TestExecutedIsEarned": [
        (
            "return _to(s, i, Step.ESPE_INTERRUPTED_1)  # Interrupt1",
            "return _to(s, i, Step.ESPE_INTERRUPTED_2)",
        )
    ],
    "PhaseEndsInTime": [(EXPIRE_ACTIVE, "")],
    "FailedTestIsShown": [
        (EXPIRE_REQUEST, EXPIRE_REQUEST.replace("_test_error(i)", "Step.ESPE_INTERRUPTED_1"))
    ],
    "CodeTellsTheSensor": [
        (
            "    if i.S_OSSD_In and i.NoExternalTest:\n        return Step",
            "    if i.S_OSSD_In:\n        return Step",
        )
    ],
    "ResetEndsTestError": [
        ("return _to(s, i, Step.ESPE_FREE_NO_TEST)  # ResetTestError", "return _to(s, i, _test_error(i))")
    ],
    "ResetBeginsManualTest": [
        ("    if not i.NoExternalTest and (_reset_rises(s, i) or", "    if not i.NoExternalTest and (")
    ],
    "ManualTestComesFirst": [("    if s.sensor_before and not i.S_OSSD_In:", "    if not i.S_OSSD_In:")],
    "ManualTestIsFollowed": [
        (
            "Step.ESPE_INTERRUPTED_EXTERNAL_TEST)  # BeginExternalTest",
            "Step.END_EXTERNAL_TEST)  # BeginExternalTest",
        )
    ],
    "ManualTestShows": [
        (
            "return _to(s, i, Step.END_EXTERNAL_TEST)  # BecomeFree",
            "return _to(s, i, Step.EXTERNAL_FUNCTION_TEST)  # BecomeFree",
        )
    ],
    "HeldResetIsAnError": [
        (
            "return _to(s, i, Step.RESET_ERROR_2, s.start_inhibit)  # Find",
            "return _to(s, i, Step.WAIT_FOR_RESET_1, s.start_inhibit)  # Find",
        )
    ],
    "HeldResetHasItsCode": [
        ("return _to(s, i, Step.RESET_ERROR_5)  # Find", "return _to(s, i, Step.PARAMETER_ERROR)  # Find")
    ],
    "InvalidTimeIsRefused": [
        ("return _to(s, i, Step.PARAMETER_ERROR)  # Refuse", "return _to(s, i, Step.INIT)  # Refuse")
    ],
    "InvalidTimeNeverEnables": [
        ("return _to(s, i, Step.RESET_ERROR_5)  # Find", "return _to(s, i, Step.ESPE_FREE_NO_TEST)  # Find")
    ],
    "ErrorNeedsReason": [
        (
            "return _to(s, i, Step.EXTERNAL_FUNCTION_TEST)  # AwaitExternalTest",
            "return _to(s, i, Step.TEST_ERROR_1_C010)",
        )
    ],
}
PARAMETERS = {
    "FailedTestNeedsEdge": CAUTIOUS,
    "HeldResetHasItsCode": INVALID,
    "InvalidTimeIsRefused": INVALID,
    "InvalidTimeNeverEnables": INVALID,
}


@pytest.mark.parametrize("late", [0, 1])
@pytest.mark.parametrize("params", [LETTER, CAUTIOUS, INVALID, {"TestTime_ms": 0}])
def test_every_profile_follows_the_page(params: dict[str, Any], late: int) -> None:
    assert not TRIAL.broken(TRIAL.reference(**params), 4000, late=late, **params)[0]


def test_every_demand_is_put_to_the_block() -> None:
    put = [TRIAL.broken(TRIAL.reference(**params), 8000, **params)[1] for params in (LETTER, INVALID)]
    assert put[0] | put[1] == {one.id for one in TRIAL.demands.rows}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("demand", FAULTS)
def test_each_demand_falls_to_an_edit(demand: str) -> None:
    params = PARAMETERS.get(demand, LETTER)
    assert TRIAL.falls(demand, TRIAL.reference(*FAULTS[demand], **params), **params)


def test_each_demand_has_its_fault() -> None:
    assert set(FAULTS) == {one.id for one in TRIAL.demands.rows}
