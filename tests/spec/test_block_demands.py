"""The demands of each block on its wires: it is kept, and each property falls to a planted fault."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest

from tests.spec.watched import Edit, Watched


@dataclass(frozen=True)
class Trial:
    """A block with the parameters with which it keeps its demands, and for each property a fault.

    The faults are tried with the first parameters, or with those named in `others`.
    """

    block: Watched
    kept: list[dict[str, Any]]
    faults: dict[str, list[Edit]]
    others: dict[str, dict[str, Any]]


GUARD_LOCKING = Trial(
    Watched(
        "guard_locking",
        "sf_guard_locking",
        (10,),
        {"Activate": 0.97, "S_GuardMonitoring": 0.8, "S_GuardLock": 0.8, "S_SafetyActive": 0.7},
    ),
    [
        {},
        {"UNLOCK_ON": "edge", "UNLOCK_ENDS": "when_closed"},
        {"UNLOCK_ON": "level", "ZONE_LOST": "tolerated", "CAUSE_OF_LOSS": "guard_and_zone"},
        {"START_UP_INHIBIT": "until_opened", "CAUSE_OF_LOSS": "zone", "MESSAGE_OF_LOSS": "until_safe"},
    ],
    {
        "NeverEnabledAndUnlocked": [
            ("Outputs(True, True, False, False, 0x8000)", "Outputs(True, True, True, False, 0x8000)")
        ],
        "NothingWhileInactiveOrInError": [
            ("Outputs(True, False, False, True, 0xC004)", "Outputs(True, False, True, True, 0xC004)")
        ],
        "InactiveAtOnce": [("if not i.Activate:", "if not i.Activate and not i.Reset:")],
        "EnableNeedsSecuredGuard": [
            ("return Step.SAFETY_LOST  # LoseGuard", "return Step.GUARD_CLOSED_AND_LOCKED")
        ],
        "NoAutomaticRestart": [("alone = i.S_AutoReset and not s.start_up_inhibit", "alone = i.S_AutoReset")],
        "LossNeedsReset": [
            (
                "    if rises(i.Reset, s.reset_before):\n        return Step.WAIT_FOR_OPERATOR",
                "    if i.S_AutoReset or rises(i.Reset, s.reset_before):\n"
                "        return Step.WAIT_FOR_OPERATOR",
            )
        ],
        "UnlockNeedsSafeZone": [("if i.S_SafetyActive and _requested(s, i):", "if _requested(s, i):")],
        "UnlockedOnlyWhileSafe": [
            ("return Step.SAFETY_LOST  # LoseZoneWhileClosed", "return Step.GUARD_CLOSED_BUT_UNLOCKED")
        ],
        "UnlockedOnlyWhileRequested": [
            ("    if _ends(s, i):\n        return Step.WAIT_FOR_OPERATOR  # WithdrawWhileOpen\n", "")
        ],
        "MessageUntilReset": [("s.params.MESSAGE_OF_LOSS == UNTIL_RESET, 0x8014", "False, 0x8014")],
        "NoErrorLocksSafeZone": [
            ("return Step.WAIT_FOR_OPERATOR  # WithdrawWhileOpen", "return Step.SAFETY_LOST")
        ],
        "UnlockNeedsRequest": [("if i.UnlockRequest and i.S_SafetyActive:", "if i.S_SafetyActive:")],
        "LossIsAnError": [("return Step.SAFETY_LOST  # LoseGuard", "return Step.GUARD_CLOSED_AND_LOCKED")],
    },
    {},
)
SENSOR = Trial(
    Watched(
        "testable_safety_sensor", "sf_testable_safety_sensor", (1, 5, 9), {"Activate": 0.97, "S_OSSD_In": 0.7}
    ),
    [
        {"TestTime_ms": 20},
        {"TestTime_ms": 20, "AUTO_RESET_ERRORS": False},
        {"TestTime_ms": 0},
        {"TestTime_ms": 151},
    ],
    {
        "InactiveAtOnce": [("if not i.Activate:", "if not i.Activate and not i.Reset:")],
        "EnableMeansNothingPending": [
            (
                "Outputs(True, False, True, False, False, False, True, False, 0x8402)",
                "Outputs(True, True, True, True, False, False, True, False, 0x8402)",
            )
        ],
        "EnableNeedsFreeSensor": [
            (
                "return _to(s, i, Step.ESPE_INTERRUPTED_1)  # Interrupt1",
                "return _to(s, i, Step.ESPE_FREE_NO_TEST)",
            )
        ],
        "MaskedTimeIsBounded": [
            ("    if _time_is_over(s, i):\n        return _to(s, i, _test_error(i))  # ExpireActive\n", "")
        ],
        "SenderOffIsBounded": [
            ("    if _time_is_over(s, i):\n        return _to(s, i, _test_error(i))  # ExpireRequest\n", "")
        ],
        "SlowTestFails": [
            (
                "    if _time_is_over(s, i):\n        return _to(s, i, _test_error(i))  # ExpireActive\n",
                "    if _time_is_over(s, i) and not i.S_OSSD_In:\n        return _to(s, i, _test_error(i))\n",
            )
        ],
        "FailedTestNeedsReset": [
            ("return s.params.AUTO_RESET_ERRORS and i.S_AutoReset", "return i.S_AutoReset")
        ],
        "NoRestartByItself": [
            (
                "if i.S_AutoReset:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
                "if i.S_AutoReset or i.S_StartReset:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
            )
        ],
        "TestNeedsEdgeWhilePossible": [
            ("return rises(i.StartTest, s.start_test_before)", "return i.StartTest")
        ],
        "TestOutOnlyInTestRequest": [
            (
                "Outputs(True, False, True, False, False, False, True, False, 0x8402)",
                "Outputs(True, False, False, False, False, False, True, False, 0x8402)",
            )
        ],
        "TestExecutedIsTrue": [
            ("return _to(s, i, Step.TEST_ACTIVE)  # SeeDark", "return _to(s, i, Step.ESPE_FREE_TEST_OK)")
        ],
        "ParameterErrorStays": [
            ("s.params.TestTime_ms <= TEST_TIME_MAX_MS", "s.params.TestTime_ms <= TEST_TIME_MAX_MS + 1")
        ],
    },
    {
        "ParameterErrorStays": {"TestTime_ms": 151},
        "FailedTestNeedsReset": {"TestTime_ms": 20, "AUTO_RESET_ERRORS": False},
    },
)
TRIALS = {one.block.document: one for one in (GUARD_LOCKING, SENSOR)}


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("document", "name"), [(document, name) for document, one in TRIALS.items() for name in one.faults]
)
def test_the_property_falls_to_the_fault(document: str, name: str) -> None:
    one = TRIALS[document]
    assert one.block.falls(name, one.faults[name], one.others.get(name, one.kept[0]))


@pytest.mark.parametrize(
    "document",
    [pytest.param(name, marks=pytest.mark.deep if one is SENSOR else ()) for name, one in TRIALS.items()],
)
def test_the_block_keeps_its_demands_and_tests_each_property(document: str) -> None:
    one = TRIALS[document]
    assert one.block.put_to_it(one.kept) == set(one.block.properties)


@pytest.mark.parametrize("document", TRIALS)
def test_a_program_a_call_late_keeps_it_with_held_inputs(document: str) -> None:
    broken, _ = TRIALS[document].block.watch(late=True, **TRIALS[document].kept[0])
    assert broken is None, broken


@pytest.mark.parametrize("document", TRIALS)
def test_each_property_has_a_fault_and_needs_no_codes(document: str) -> None:
    one = TRIALS[document]
    assert set(one.faults) == set(one.block.properties) and one.block.unjudged_without_codes() == ()
