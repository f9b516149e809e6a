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


EDM = Trial(
    Watched("edm", "sf_edm", (0, 5, 10), {"Activate": 0.97, "Reset": 0.4}),
    [{"MonitoringTime_ms": 20, "AFTER_RESET": "stop_first"}, {"MonitoringTime_ms": 20}],
    {
        "OutputNeedsAll": [
            (
                "Outputs(True, True, False, False, False, 0x8000)",
                "Outputs(True, True, False, False, True, 0x8000)",
            )
        ],
        "IdleShowsNothing": [
            (
                "Outputs(False, False, False, False, False, 0x0000)",
                "Outputs(False, False, False, False, True, 0x0000)",
            )
        ],
        "InactiveAtOnce": [("elif not inputs.Activate:", "elif not inputs.Activate and not inputs.Reset:")],
        "StopAtOnce": [("    if not i.S_OutControl:\n", "    if not s.out_control_before:\n")],
        "SwitchOnNeedsInitialState": [("return i.S_EDM1 and i.S_EDM2", "return i.S_EDM1")],
        "FeedbackWrongOnlyForATime": [("return not i.S_EDM1 and not i.S_EDM2", "return not i.S_EDM1")],
        "MissedDropOutIsAnError": [
            ("elif _time_is_over(s, i):", "elif _time_is_over(s, i) and not i.S_EDM1:")
        ],
        "ResetNeedsEdge": [
            (
                "    if s.reset_before:\n        return _enter(s, i, Step.RESET_ERROR_1)",
                "    if s.reset_before and i.S_OutControl:\n        return _enter(s, i, Step.RESET_ERROR_1)",
            )
        ],
        "CauseIsGone": [("if not _both_dropped_out(i):", "if not i.S_EDM1:")],
        "ResetNeverStarts": [("requested = i.S_OutControl and s.stop_seen", "requested = i.S_OutControl")],
    },
    {},
)
ENABLE_SWITCH = Trial(
    Watched("enable_switch", "sf_enable_switch", (0, 5, 10), {"Activate": 0.97, "S_SafetyActive": 0.9}),
    [
        {"DiscrepancyTimeCh1_Ch3_ms": 20},
        {"DiscrepancyTimeCh1_Ch3_ms": 20, "MODE_ENDS_ERROR": True},
        {"DiscrepancyTimeCh1_Ch3_ms": 20, "AUTO_RESET_ERRORS": False},
    ],
    {
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
            ("automatic = s.params.AUTO_RESET_ERRORS and i.S_AutoReset", "automatic = i.S_AutoReset")
        ],
    },
    {"ErrorNeedsReset": {"DiscrepancyTimeCh1_Ch3_ms": 20, "AUTO_RESET_ERRORS": False}},
)
TRIALS = {one.block.document: one for one in (EDM, ENABLE_SWITCH)}


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("document", "name"), [(document, name) for document, one in TRIALS.items() for name in one.faults]
)
def test_the_property_falls_to_the_fault(document: str, name: str) -> None:
    one = TRIALS[document]
    assert one.block.falls(name, one.faults[name], one.others.get(name, one.kept[0]))


@pytest.mark.parametrize("document", TRIALS)
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
