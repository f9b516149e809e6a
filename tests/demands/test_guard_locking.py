"""The demands of the page on guard locking: what they allow, and what breaks each of them."""

from __future__ import annotations

from typing import Any

import pytest

from tests.demands.guards import Guard
from tests.demands.trials import Edit, Trial

TRIAL = Trial(
    "guard_locking",
    "sf_guard_locking",
    (10,),
    {
        "Activate": 0.95,
        "S_GuardMonitoring": 0.8,
        "S_GuardLock": 0.8,
        "S_SafetyActive": 0.8,
        "UnlockRequest": 0.3,
        "Reset": 0.35,
    },
    ("S_StartReset", "S_AutoReset"),
)
LETTER: dict[str, Any] = {}
CAUTIOUS = {"UNLOCK_ON": "edge", "UNLOCK_ENDS": "when_closed"}
OTHERS = {"UNLOCK_ON": "level", "ZONE_LOST": "tolerated", "CAUSE_OF_LOSS": "guard_and_zone"}
# The page asks for the edge of Reset, and these do without it (GLF-06, GLF-08)
FORBIDDEN = {
    "ErrorGoesByHand": {"MESSAGE_OF_LOSS": "until_safe"},
    "StartInhibitGoesByHand": {"START_UP_INHIBIT": "until_opened"},
}
ALLOWED = [
    Guard(),
    Guard(held_reset=True),
    Guard(zone_lost="error", loss=True),
    Guard(zone_lost="error", loss=True, two_edges=True, held_reset=True),
    Guard(zone_lost="locks", reset_first=True),
]
OUTRIGHT = {
    "nothing": "ActiveIsReady",
    "always": "InactiveShowsNothing",
    "no zone": "UnlockWaitsForSafeZone",
    "open": "EnableNeedsClosedGuard",
    "unlocked": "EnableNeedsLockedGuard",
    "restarts": "RestartInhibitGoesByHand",
    "level": "StartInhibitGoesByHand",
    "falling": "ResetRemovesInhibit",
    "stays unlocked": "UnlockGoesWithRequest",
    "never unlocks": "RequestIsServed",
}
LOSES = "    if {}:\n        return Step.SAFETY_LOST  # LoseGuard"
FAULTS: dict[str, list[Edit]] = {
    "InactiveShowsNothing": [("if not i.Activate:", "if not i.Activate and not i.Reset:")],
    "ActiveIsReady": [
        ("Outputs(True, False, False, False, 0x8001)", "Outputs(False, False, False, False, 0x8001)")
    ],
    "EnableNeedsClosedGuard": [
        (
            LOSES.format("not (i.S_GuardMonitoring and i.S_GuardLock)"),
            LOSES.format("not i.S_GuardLock"),
        )
    ],
    "EnableNeedsLockedGuard": [
        (
            LOSES.format("not (i.S_GuardMonitoring and i.S_GuardLock)"),
            LOSES.format("not i.S_GuardMonitoring"),
        )
    ],
    "ErrorTakesBothSignals": [
        (
            "return Outputs(True, False, False, True, 0xC004)",
            "return Outputs(True, False, True, True, 0xC004)",
        )
    ],
    "StartInhibitGoesByHand": [
        (
            "    if i.S_StartReset:\n        return Step.GUARD",
            "    if i.S_StartReset or i.S_AutoReset:\n        return Step.GUARD",
        )
    ],
    "RestartInhibitGoesByHand": [
        ("alone = i.S_AutoReset and", "alone = (i.S_AutoReset or i.S_StartReset) and")
    ],
    "UnlockIsRequested": [("if i.UnlockRequest and i.S_SafetyActive:", "if i.S_SafetyActive:")],
    "UnlockWaitsForSafeZone": [("if i.S_SafetyActive and _requested(s, i):", "if _requested(s, i):")],
    "RequestIsServed": [
        ("if i.S_SafetyActive and _requested(s, i):", "if i.Reset and i.S_SafetyActive and _requested(s, i):")
    ],
    "UnlockTakesEnable": [
        ("Outputs(True, False, True, False, 0x8013)", "Outputs(True, True, True, False, 0x8013)")
    ],
    "UnlockLastsWithRequest": [
        (
            "    if not i.S_GuardMonitoring:\n        return Step.GUARD_OPEN_AND_UNLOCKED  # OpenGuard",
            "    if not i.S_GuardMonitoring:\n        return Step.WAIT_FOR_OPERATOR  # OpenGuard",
        )
    ],
    "UnlockGoesWithRequest": [
        ("return s.params.UNLOCK_ENDS == WITH_REQUEST and not i.UnlockRequest", "return False"),
        ("    if not i.UnlockRequest:\n        return Step.WAIT_FOR_OPERATOR  # WithdrawRequest\n", ""),
    ],
    "EnableLasts": [
        (
            "return Step.GUARD_CLOSED_AND_LOCKED  # StayLocked",
            "return Step.GUARD_CLOSED_AND_LOCKED if i.S_SafetyActive else Step.WAIT_FOR_RESET",
        )
    ],
    "StartsByItself": [("    if i.S_StartReset:\n", "    if i.S_StartReset and i.Reset:\n")],
    "RestartsByItself": [("alone = i.S_AutoReset and", "alone = False and")],
    "ResetRemovesInhibit": [
        (
            "    if rises(i.Reset, s.reset_before):\n        return Step.GUARD_CLOSED_AND_LOCKED  # RemoveRe"
            "startInhibit\n",
            "",
        )
    ],
    "ErrorGoesByHand": [("s.params.MESSAGE_OF_LOSS == UNTIL_RESET, 0x8014", "False, 0x8014")],
    "ResetEndsError": [("return Step.WAIT_FOR_OPERATOR  # AcknowledgeError", "return Step.SAFETY_RETURN")],
    "ErrorNeedsReason": [
        (
            "return Step.WAIT_FOR_RESET  # AwaitReset",
            "return Step.RESET_ERROR3 if i.UnlockRequest else Step.WAIT_FOR_RESET",
        )
    ],
}


@pytest.mark.parametrize("params", [LETTER, CAUTIOUS, OTHERS])
@pytest.mark.parametrize("late", [0, 1])
def test_every_profile_follows_the_page(params: dict[str, Any], late: int) -> None:
    broken, put = TRIAL.broken(TRIAL.reference(**params), 4000 if late else 10_000, late=late, **params)
    assert not broken
    if not late:
        assert put == {one.id for one in TRIAL.demands.rows}


@pytest.mark.parametrize(("demand", "params"), FORBIDDEN.items())
def test_a_reading_without_the_edge_is_forbidden(demand: str, params: dict[str, Any]) -> None:
    assert TRIAL.falls(demand, TRIAL.reference(**params), **params)


@pytest.mark.parametrize("program", ALLOWED)
def test_a_program_of_another_make_follows_the_page(program: Guard) -> None:
    assert not TRIAL.broken(program.scan, 5000)[0]


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("fault", "demand"), OUTRIGHT.items())
def test_an_outright_fault_breaks_its_demand(fault: str, demand: str) -> None:
    assert TRIAL.falls(demand, Guard(fault=fault).scan)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("demand", FAULTS)
def test_each_demand_falls_to_an_edit(demand: str) -> None:
    assert TRIAL.falls(demand, TRIAL.reference(*FAULTS[demand]))


def test_each_demand_has_its_fault() -> None:
    assert set(FAULTS) == {one.id for one in TRIAL.demands.rows}
