"""The contract of the enable switch on wires: it is kept, and each property falls to a planted fault."""

from __future__ import annotations

from typing import Any

import pytest

from tests.spec.watched import Edit, Watched

BLOCK = Watched("enable_switch", "sf_enable_switch", (0, 5, 10), {"Activate": 0.97, "S_SafetyActive": 0.9})
KEPT: list[dict[str, Any]] = [
    {"DiscrepancyTimeCh1_Ch3_ms": 20},
    {"DiscrepancyTimeCh1_Ch3_ms": 20, "MODE_ENDS_ERROR": True},
]
FAULTS: dict[str, list[Edit]] = {
    "EnableNeedsItsConditions": [
        (
            "return i.S_EnableSwitchCh1 and not i.S_EnableSwitchCh2 and i.S_EnableSwitchCh3",
            "return i.S_EnableSwitchCh1 and not i.S_EnableSwitchCh2",
        )
    ],
    "EnableNeedsStage0": [
        (
            "# StayAtStage2\n    if sees_stage_1(i):\n        return _at(s, i, Step.PLAUSIBILITY_ERROR)",
            "# StayAtStage2\n    if sees_stage_1(i):\n        return _at(s, i, Step.STAGE_1)",
        )
    ],
    "EnableStandsAlone": [
        (
            "Outputs(True, True, False, False, False, 0x8000)",
            "Outputs(True, True, False, False, True, 0x8000)",
        )
    ],
    "IdleIsSilent": [("if not i.Activate:", "if not i.Activate and not i.Reset:")],
    "ErrorNeedsReset": [
        ("if rises(i.Reset, s.reset_before) or i.S_AutoReset:", "if i.Reset or i.S_AutoReset:"),
        ("if held(i.Reset, s.reset_before) and not i.S_AutoReset:", "if False:"),
    ],
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
