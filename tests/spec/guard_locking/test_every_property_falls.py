"""Each property of the guard locking falls to a reading of the text, or to a fault planted in a copy."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.spec.block import Block

BLOCK = Block(
    "guard_locking",
    "GuardLocking.tla",
    "MC_SF_GuardLocking_arbitrary",
    others={
        "EnablesAgain": "LIVE_SF_GuardLocking_recovery",
        "EntryIsGranted": "LIVE_SF_GuardLocking_entry",
    },
)
FAULTS = {
    "NeverEnabledAndUnlocked": (
        'S_GuardLocked == state = "GuardClosedAndLocked"',
        'S_GuardLocked == state \\in {"GuardClosedAndLocked", "GuardOpenAndUnlocked"}',
    ),
    "NothingWhileInactiveOrInError": (
        "S_UnlockGuard == state \\in Unlocked",
        'S_UnlockGuard == state \\in Unlocked \\cup {"SafetyLost"}',
    ),
    "InactiveIsNoError": ('state = "Idle" -> \\h0000', 'state = "Idle" -> \\h8002'),
    "RowOfDiagCode": ('state = "SafetyLost" -> \\hC004', 'state = "SafetyLost" -> \\h8004'),
    "PowerUpIsSafe": ('/\\ state = "Idle" /\\ resetBefore', '/\\ state = "Init" /\\ resetBefore'),
    "EveryCallIsAnswered": ("(SeeZoneSafe(i) \\/ StaySafetyLost(i))", "SeeZoneSafe(i)"),
    "InactiveAtOnce": ('GoTo("Idle") /\\ Did("Deactivate")', 'GoTo("Init") /\\ Did("Deactivate")'),
    "NoAutomaticRestart": (
        "RestartsAlone(i) == i.S_AutoReset /\\",
        "RestartsAlone(i) == (i.S_AutoReset \\/ i.S_StartReset) /\\",
    ),
    "UnlockNeedsRequest": (
        "i.S_GuardMonitoring /\\ i.UnlockRequest /\\ i.S_SafetyActive",
        "i.S_GuardMonitoring /\\ i.S_SafetyActive",
    ),
    "RequestUnlocksAtOnce": (
        "RequestRises(i) == Rises(i.UnlockRequest, unlockRequestBefore)",
        "RequestRises(i) == Rises(unlockRequestBefore, i.UnlockRequest)",
    ),
    "StaysUnlockedWhileRequested": (
        'GoTo("GuardClosedButUnlocked")\n    /\\ Did("CloseGuard")',
        'GoTo("WaitForOperator")\n    /\\ Did("CloseGuard")',
    ),
    "LocksWithoutRequest": (
        'GoTo("WaitForOperator")\n    /\\ Did("WithdrawRequest")',
        'GoTo("GuardOpenAndUnlocked")\n    /\\ Did("WithdrawRequest")',
    ),
    "StaysLocked": (
        'GoTo("GuardClosedAndLocked")\n    /\\ Did("StayLocked")',
        'GoTo("WaitForReset")\n    /\\ Did("StayLocked")',
    ),
    "ErrorNeedsCause": (
        "ZoneOpenToIt(i) == ~i.S_SafetyActive /\\ ~Secured(i)",
        "ZoneOpenToIt(i) == ~Secured(i) /\\ ~i.S_GuardMonitoring",
    ),
    "ErrorEndsWithCause": ('[] OTHER -> "WaitForReset"', '[] OTHER -> "GuardClosedAndLocked"'),
    "LatchedRequestUnlocks": ('"latched" -> RequestStands(i)', '"latched" -> RequestRises(i)'),
    "CodeTellsTheGuard": (
        'GoTo("GuardOpenAndUnlocked")\n    /\\ Did("StayOpen")',
        'GoTo("GuardClosedButUnlocked")\n    /\\ Did("StayOpen")',
    ),
    "OneTransitionACall": (
        'At("Idle", i) /\\ GoTo("Init") /\\ Did("StartUp")',
        'At("Idle", i) /\\ GoTo("WaitForOperator") /\\ Did("StartUp")',
    ),
    "AnswersAtOnce": (
        'GoTo("SafetyReturn") /\\ Did("SeeZoneSafe")',
        'GoTo("SafetyLost") /\\ Did("SeeZoneSafe")',
    ),
    "LeavesForACause": (
        'At("WaitForOperator", i) /\\ ~GoesOnRequest(i) /\\ Secured(i)',
        'At("WaitForOperator", i) /\\ Secured(i)',
    ),
    "EnablesAgain": (
        'GoTo(ReturnsTo) /\\ Did("ReleaseReset")',
        'GoTo(IF state = "ResetError3" THEN state ELSE ReturnsTo) /\\ Did("ReleaseReset")',
    ),
    "EntryIsGranted": (
        'GoTo("SafetyReturn") /\\ Did("SeeZoneSafe")',
        'GoTo("SafetyLost") /\\ Did("SeeZoneSafe")',
    ),
}


@pytest.mark.sampled(10)
@pytest.mark.parametrize("name", FAULTS)
def test_the_property_falls_to_the_fault(name: str, tmp_path: Path) -> None:
    assert BLOCK.checked(tmp_path, name, FAULTS[name]) == BLOCK.falls(name)


def test_nothing_planted_nothing_falls(tmp_path: Path) -> None:
    unchanged = 'Ready == state # "Idle"'
    assert BLOCK.checked(tmp_path, "AnswersAtOnce", (unchanged, unchanged)) == []


def test_every_property_falls_to_something() -> None:
    assert set(FAULTS) | BLOCK.fallen == set(BLOCK.properties)


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    readings, tried = BLOCK.readings(), BLOCK.tried()
    assert len(readings) == 12 and set(tried) == readings
    assert sorted(name for name, kind in tried.items() if kind != "NEG") == [
        "ResetSeenOnlyWhileActive",
    ]


def test_every_state_code_and_transition_is_witnessed() -> None:
    device = BLOCK.registers.interface.devices["sf_guard_locking"]
    witnessed, cautious = [set(run.witnesses) for run in BLOCK.registers.runs if run.kind == "WIT"]
    assert cautious - witnessed == {"UnlockedWithoutRequest"}
    assert set(device.states) <= witnessed and set(device.steps) <= witnessed
    assert len({name for name in witnessed if name.startswith("DiagCode")}) == len(device.states) == 12
    transitions = {name for name in witnessed if re.fullmatch(r"[A-Z]\w+To[A-Z]\w+", name)}
    assert {f"{one}ToIdle" for one in device.states if one != "Idle"} <= transitions
    listed = re.findall(r"<<\\h\w{4}, \\h\w{4}>>", (BLOCK.spec / "GuardLockingOpen.tla").read_text())
    assert len(transitions) == 11 + 25 and len(listed) >= 24
