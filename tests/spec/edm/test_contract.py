"""The contract of SF_EDM on its wires: it is kept, and each property falls to a planted fault."""

from __future__ import annotations

from typing import Any

import pytest

from tests.spec.watched import Edit, Watched

BLOCK = Watched("edm", "sf_edm", (0, 5, 10), {"Activate": 0.97, "Reset": 0.4})
KEPT: list[dict[str, Any]] = [{"MonitoringTime_ms": 20}, {"MonitoringTime_ms": 20, "AFTER_RESET": "at_once"}]
FAULTS: dict[str, list[Edit]] = {
    "OutputNeedsAll": [
        (
            "Outputs(True, True, False, False, False, 0x8000)",
            "Outputs(True, True, True, False, False, 0x8000)",
        )
    ],
    "IdleShowsNothing": [
        (
            "Outputs(False, False, False, False, False, 0x0000)",
            "Outputs(False, False, False, True, False, 0x0000)",
        )
    ],
    "InactiveAtOnce": [("elif not inputs.Activate:", "elif not inputs.Activate and not inputs.Reset:")],
    "StopAtOnce": [("    if not i.S_OutControl:\n", "    if not s.out_control_before:\n")],
    "SwitchOnNeedsInitialState": [("return i.S_EDM1 and i.S_EDM2", "return i.S_EDM1")],
    "FeedbackWrongOnlyForATime": [("return not i.S_EDM1 and not i.S_EDM2", "return not i.S_EDM1")],
    "MissedDropOutIsAnError": [("elif _time_is_over(s, i):", "elif _time_is_over(s, i) and not i.S_EDM1:")],
    "ResetNeedsEdge": [
        (
            "    if s.reset_before:\n        return _enter(s, i, Step.RESET_ERROR_1)",
            "    if s.reset_before and i.S_OutControl:\n        return _enter(s, i, Step.RESET_ERROR_1)",
        )
    ],
    "CauseIsGone": [("if not _both_dropped_out(i):", "if not i.S_EDM1:")],
    "ResetNeverStarts": [("requested = i.S_OutControl and s.stop_seen", "requested = i.S_OutControl")],
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
