"""The contract of the guard locking on wires: it is kept, and each property falls to a planted fault."""

from __future__ import annotations

from typing import Any

import pytest

from tests.spec.watched import Edit, Watched

BLOCK = Watched(
    "guard_locking",
    "sf_guard_locking",
    (10,),
    {"Activate": 0.97, "S_GuardMonitoring": 0.8, "S_GuardLock": 0.8, "S_SafetyActive": 0.7},
)
KEPT: list[dict[str, Any]] = [
    {},
    {"UNLOCK_ON": "latched"},
    {"UNLOCK_ON": "level", "ZONE_LOST": "tolerated"},
    {"START_UP_INHIBIT": "until_opened", "CAUSE_OF_LOSS": "zone"},
]
FAULTS: dict[str, list[Edit]] = {
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
            "    if i.S_AutoReset or rises(i.Reset, s.reset_before):\n        return Step.WAIT_FOR_OPERATOR",
        )
    ],
    "UnlockNeedsSafeZone": [("if i.S_SafetyActive and _requested(s, i):", "if _requested(s, i):")],
    "UnlockedOnlyWhileSafe": [
        ("return Step.SAFETY_LOST  # LoseZoneWhileClosed", "return Step.GUARD_CLOSED_BUT_UNLOCKED")
    ],
    "NoErrorLocksSafeZone": [("return Step.WAIT_FOR_OPERATOR  # WithdrawRequest", "return Step.SAFETY_LOST")],
    "UnlockNeedsRequest": [("if i.UnlockRequest and i.S_SafetyActive:", "if i.S_SafetyActive:")],
    "LossIsAnError": [("return Step.SAFETY_LOST  # LoseGuard", "return Step.GUARD_CLOSED_AND_LOCKED")],
}


@pytest.mark.parametrize("name", FAULTS)
def test_the_property_falls_to_the_fault(name: str) -> None:
    assert BLOCK.falls(name, FAULTS[name], KEPT[0])


def test_the_block_keeps_its_contract_and_tests_each_property() -> None:
    assert BLOCK.put_to_it(KEPT) == set(BLOCK.properties)


def test_a_program_a_call_late_keeps_it_with_held_inputs() -> None:
    broken, _ = BLOCK.watch(late=True, **KEPT[0])
    assert broken is None, broken


def test_each_property_has_a_fault_and_needs_no_codes() -> None:
    assert set(FAULTS) == set(BLOCK.properties) and BLOCK.unjudged_without_codes() == ()
