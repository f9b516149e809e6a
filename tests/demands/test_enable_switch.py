"""The demands of the page on the enable switch: what they allow, and what breaks each of them."""

from __future__ import annotations

import random
from typing import Any

import pytest

from tests.demands.short_runs import Edit, Runs
from tests.demands.switches import Switch


def channels(*closed: int) -> dict[str, bool]:
    """What the three channels show."""
    return {f"S_EnableSwitchCh{n}": n in closed for n in (1, 2, 3)}


def begins(dice: random.Random) -> list[dict[str, bool]]:
    """Most runs: active in the mode at stage 0, then channel 1 for a while, stage 1, and what may follow."""
    if dice.random() < 0.3:
        return []
    ready = {"Activate": True, "S_SafetyActive": True, **channels(2)}
    waits = [channels(1)] * dice.choice((0, 1, 2, 9))
    grips = [channels(1, 3)] * dice.choice((1, 4))
    ends = [channels(*dice.choice(((), (2,), (1,))))] * dice.choice((1, 4))
    resets = [channels(2)] * 4 + [{"Reset": True}, {}, {"Reset": False}, {}, {}, {}]
    return [ready, {}, {}, {}, *waits, *grips, *ends, *(resets if dice.random() < 0.6 else grips)]


RUNS = Runs("enable_switch", "sf_enable_switch", begins)
TIME = {"DiscrepancyTimeCh1_Ch3_ms": 20}
CHOICES: list[dict[str, Any]] = [
    {},
    {"auto": True, "agree": True},
    {"mode_ends": True, "at_the_top": True, "over": True},
    {"gap": True, "watches": True},
    {"refuses": True, "in_mode": True, "late_outputs": True},
]
OUTRIGHT = {
    "nothing": "Stage1Enables",
    "always": "EnablesInStage1",
    "no activation": "InactiveShowsNothing",
    "no mode": "NothingWithoutMode",
    "no channel 2": "EnablesInStage1",
    "no channel 3": "EnablesInStage1",
    "no order": "EnableComesFromStage0",
    "any order": "EnableComesFromStage0",
    "stays on": "OffInOtherStages",
    "latched": "OffInOtherStages",
    "level": "ErrorStaysUntilReset",
    "error goes": "ErrorStaysUntilReset",
    "no error": "Channel3TooLateIsAnError",
    "thrice": "Channel3TooLateIsAnError",
    "at once": "ErrorNeedsReason",
}
_STAYS = "    if sees_stage_1(i) or {}:\n        return _at(s, i, Step.STAGE_1)  # StayEnabled"
FAULTS: dict[str, list[Edit]] = {
    "InactiveShowsNothing": [("if not i.Activate:", "if not i.Activate and not i.Reset:")],
    "NothingWithoutMode": [
        (
            'ES-SEQ-7, ESF-04"""\n    if not i.S_SafetyActive:',
            'ES-SEQ-7, ESF-04"""\n    if not i.S_SafetyActive and not i.Reset:',
        )
    ],
    "EnablesInStage1": [
        (
            "return i.S_EnableSwitchCh1 and not i.S_EnableSwitchCh2 and i.S_EnableSwitchCh3",
            "return i.S_EnableSwitchCh1 and not i.S_EnableSwitchCh2",
        )
    ],
    "OffInOtherStages": [
        (
            "    if sees_stage_1(i):\n        return _at(s, i, Step.STAGE_1)  # StayEnabled",
            _STAYS.format("sees_stage_2(i)"),
        )
    ],
    "OffWithoutStage1": [
        (
            "    if sees_stage_1(i):\n        return _at(s, i, Step.STAGE_1)  # StayEnabled",
            _STAYS.format("all_true(i)"),
        )
    ],
    "EnableComesFromStage0": [
        (
            "# StayAtStage2\n    if sees_stage_1(i):\n        return _at(s, i, Step.PLAUSIBILITY_ERROR)",
            "# StayAtStage2\n    if sees_stage_1(i):\n        return _at(s, i, Step.STAGE_1)",
        )
    ],
    "NoEnableInError": [
        (
            "Outputs(True, True, False, False, False, 0x8000)",
            "Outputs(True, True, False, False, True, 0x8000)",
        )
    ],
    "Channel3TooLateIsAnError": [
        (
            "    if time_is_over(s, i):\n        return _too_late(s, i)\n    if sees_stage_1",
            "    if time_is_over(s, i) and all_true(i):\n        return _too_late(s, i)\n    if sees_stage_1",
        )
    ],
    "ErrorNeedsReason": [
        (
            "return _at(s, i, Step.STAGE_0)  # StayAtStage0",
            "return _at(s, i, Step.OPERATION_ERROR if i.Reset else Step.STAGE_0)  # StayAtStage0",
        )
    ],
    "ErrorStaysUntilReset": [
        ("automatic = s.params.AUTO_RESET_ERRORS and i.S_AutoReset", "automatic = True")
    ],
    "CauseGoesFirst": [
        ("    if not sees_stage_0(i):\n        return _at(s, i, cause)  # LoseStage0\n", ""),
        (
            "    if sees_stage_0(i):\n        return _at(s, i, released)  # SeeStage0",
            "    return _at(s, i, released)",
        ),
    ],
    "ResetEndsError": [
        (
            "            return _at(s, i, Step.STAGE_0)  # LeaveError",
            "            return _at(s, i, s.state)  # LeaveError",
        )
    ],
    "Stage1Enables": [
        (
            "Outputs(True, True, False, False, False, 0x8000)",
            "Outputs(True, False, False, False, False, 0x8000)",
        )
    ],
}


@pytest.mark.parametrize("auto", [True, False])
@pytest.mark.parametrize("late", [0, 1])
def test_the_reference_follows_the_page(auto: bool, late: int) -> None:
    params: dict[str, Any] = {**TIME, "AUTO_RESET_ERRORS": auto, "MODE_ENDS_ERROR": bool(late)}
    broken, put = RUNS.broken(RUNS.reference(**params), 100 if late else 300, late=late, **params)
    assert not broken
    if not late:
        judged_on_the_way = {"Channel3TooLateIsAnError", "ResetEndsError"}
        assert put | judged_on_the_way == {one.id for one in RUNS.demands.rows}


@pytest.mark.parametrize("choice", CHOICES)
@pytest.mark.parametrize("late", [0, 1])
def test_a_program_of_another_hand_follows_the_page(choice: dict[str, Any], late: int) -> None:
    late = 0 if choice.get("late_outputs") else late
    assert not RUNS.broken(lambda: Switch(**TIME, **choice).scan, 150, late=late, **TIME)[0]


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("fault", "demand"), OUTRIGHT.items())
def test_an_outright_fault_breaks_its_demand(fault: str, demand: str) -> None:
    assert RUNS.falls(demand, lambda: Switch(**TIME, fault=fault).scan, **TIME)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("demand", FAULTS)
def test_each_demand_falls_to_an_edit(demand: str) -> None:
    assert RUNS.falls(demand, RUNS.reference(*FAULTS[demand], **TIME), **TIME)


def test_each_demand_has_its_fault() -> None:
    assert set(FAULTS) == {one.id for one in RUNS.demands.rows}
