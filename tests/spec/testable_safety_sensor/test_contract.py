"""The contract of the sensor block on wires: it is kept, and each property falls to a planted fault."""

from __future__ import annotations

from typing import Any

import pytest

from tests.spec.watched import Edit, Watched

BLOCK = Watched(
    "testable_safety_sensor",
    "sf_testable_safety_sensor",
    (1, 5, 9),
    {"Activate": 0.97, "S_OSSD_In": 0.7},
)
KEPT: list[dict[str, Any]] = [
    {"TestTime_ms": 20},
    {"TestTime_ms": 20, "AUTO_RESET_ERRORS": True},
    {"TestTime_ms": 0},
    {"TestTime_ms": 151},
]
FAULTS: dict[str, list[Edit]] = {
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
    "FailedTestNeedsReset": [("return s.params.AUTO_RESET_ERRORS and i.S_AutoReset", "return i.S_AutoReset")],
    "NoRestartByItself": [
        (
            "if i.S_AutoReset:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
            "if i.S_AutoReset or i.S_StartReset:\n        return _to(s, i, Step.ESPE_FREE_TEST_OK)",
        )
    ],
    "TestNeedsEdgeWhilePossible": [("return rises(i.StartTest, s.start_test_before)", "return i.StartTest")],
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
}


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", FAULTS)
def test_the_property_falls_to_the_fault(name: str) -> None:
    params = {"TestTime_ms": 151} if name == "ParameterErrorStays" else KEPT[0]
    assert BLOCK.falls(name, FAULTS[name], params)


@pytest.mark.deep
def test_the_block_keeps_its_contract_and_tests_each_property() -> None:
    assert BLOCK.put_to_it(KEPT) == set(BLOCK.properties)


def test_a_program_a_call_late_keeps_it_with_held_inputs() -> None:
    broken, _ = BLOCK.watch(late=True, **KEPT[0])
    assert broken is None, broken


def test_each_property_has_a_fault_and_needs_no_codes() -> None:
    assert set(FAULTS) == set(BLOCK.properties) and BLOCK.unjudged_without_codes() == ()
