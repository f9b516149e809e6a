"""The demands of the page on external device monitoring: what they allow, and what breaks each of them."""

from __future__ import annotations

import random
from typing import Any

import pytest

from tests.demands.contactors import Contactors
from tests.demands.short_runs import Edit, Runs


def begins(dice: random.Random) -> list[dict[str, bool]]:
    """Half of the runs: active, the inhibit removed or none, and now and then the output is asked for."""
    if dice.random() < 0.5:
        return []
    ready = {"Activate": True, "S_EDM1": True, "S_EDM2": True, "S_StartReset": dice.random() < 0.3}
    asked = {"S_OutControl": dice.random() < 0.7}
    return [ready, {}, {"Reset": True}, {"Reset": False}, {}, asked, {}, {}, {}]


RUNS = Runs("edm", "sf_edm", begins)
TIME = {"MonitoringTime_ms": 20}
CHOICES: list[dict[str, Any]] = [
    {},
    {"refuses": True, "at_the_top": True},
    {"stop_first": True, "takes_a_call": True, "over": True},
    {"apart": True, "late_outputs": True},
    {"apart": True, "at_the_top": True, "over": True, "latched": True},
]
OUTRIGHT = {
    "nothing": "ActiveIsReady",
    "always": "StopRequestIsFollowed",
    "no activation": "InactiveShowsNothing",
    "one feedback": "OnlyOverDroppedContactors",
    "no initial state": "OnlyOverDroppedContactors",
    "no inhibit": "InhibitGoesByHand",
    "inhibit stays": "RequestIsServed",
    "level": "ErrorGoesByHand",
    "falling": "ResetEndsError",
    "error goes": "ErrorGoesByHand",
    "any reset": "CauseGoesFirst",
    "no stop": "StopRequestIsFollowed",
    "no pick-up": "LateContactorSwitchesOff",
    "no drop-out": "LateDropOutShowsError",
    "no error": "TripShowsError",
    "error stays on": "NoOutputInError",
    "twice": "LateContactorSwitchesOff",
    "half": "OffOnlyWithReason",
}
FAULTS: dict[str, list[Edit]] = {
    "InactiveShowsNothing": [("elif not inputs.Activate:", "elif not inputs.Activate and not inputs.Reset:")],
    "ActiveIsReady": [
        ("True, False, False, True, False, 0x8401", "False, False, False, True, False, 0x8401")
    ],
    "StopRequestIsFollowed": [("    if not i.S_OutControl:\n", "    if not i.S_OutControl and i.S_EDM1:\n")],
    "OnlyOverDroppedContactors": [("return i.S_EDM1 and i.S_EDM2", "return i.S_EDM1")],
    "InhibitGoesByHand": [("    if i.S_StartReset:\n", "    if i.S_StartReset or i.S_OutControl:\n")],
    "NoOutputInError": [
        ("True, True, False, False, False, 0x8000", "True, True, False, False, True, 0x8000")
    ],
    "LateContactorSwitchesOff": [("return not i.S_EDM1 and not i.S_EDM2", "return not i.S_EDM1")],
    "TripShowsError": [
        (
            "return Outputs(True, False, False, True, True, code)",
            "return Outputs(True, False, False, True, error is not Step.EDM_ERROR_33, code)",
        )
    ],
    "LateDropOutShowsError": [("elif _time_is_over(s, i):", "elif _time_is_over(s, i) and not i.S_EDM1:")],
    "OffOnlyWithReason": [("    if not i.S_OutControl:\n", "    if not i.S_OutControl or i.Reset:\n")],
    "ErrorNeedsReason": [
        (
            "        return _stay(s, i)  # AwaitReset",
            "        return _enter(s, i, Step.RESET_ERROR_1)  # AwaitReset",
        )
    ],
    "ErrorGoesByHand": [("    if not i.Reset:\n        return _stay(s, i)  # StayInError\n", "")],
    "CauseGoesFirst": [
        ("    if not _both_dropped_out(i):\n        return", "    if not i.S_EDM1:\n        return")
    ],
    "ResetEndsError": [
        ("    return _disable_by_hand(s, i)  # ResetError", "    return _stay(s, i)  # ResetError")
    ],
    "RequestIsServed": [
        ("    return _disable_by_hand(s, i)  # RemoveInhibit", "    return _stay(s, i)  # RemoveInhibit")
    ],
    "ComesByItself": [("    if i.S_StartReset:\n", "    if i.S_StartReset and i.Reset:\n")],
}


@pytest.mark.parametrize("profile", ["at_once", "stop_first"])
@pytest.mark.parametrize("late", [0, 1])
def test_the_reference_follows_the_page(profile: str, late: int) -> None:
    params: dict[str, Any] = {**TIME, "AFTER_RESET": profile}
    broken, put = RUNS.broken(RUNS.reference(**params), 100 if late else 300, late=late, **params)
    assert not broken
    if not late:
        judged_on_the_way = {"LateContactorSwitchesOff", "LateDropOutShowsError", "ResetEndsError"}
        assert put | judged_on_the_way == {one.id for one in RUNS.demands.rows}


@pytest.mark.parametrize("choice", CHOICES)
@pytest.mark.parametrize("late", [0, 1])
def test_a_program_of_another_hand_follows_the_page(choice: dict[str, Any], late: int) -> None:
    late = 0 if choice.get("late_outputs") else late
    assert not RUNS.broken(lambda: Contactors(**TIME, **choice).scan, 150, late=late, **TIME)[0]


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("fault", "demand"), OUTRIGHT.items())
def test_an_outright_fault_breaks_its_demand(fault: str, demand: str) -> None:
    assert RUNS.falls(demand, lambda: Contactors(**TIME, fault=fault).scan, **TIME)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("demand", FAULTS)
def test_each_demand_falls_to_an_edit(demand: str) -> None:
    assert RUNS.falls(demand, RUNS.reference(*FAULTS[demand], **TIME), **TIME)


def test_each_demand_has_its_fault() -> None:
    assert set(FAULTS) == {one.id for one in RUNS.demands.rows}
