"""Each property of the guard locking falls to a reading that is restored, or to a fault planted in a copy."""

from __future__ import annotations

import hashlib
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from modeproof.places import root
from modeproof.registers.load import load_document
from modeproof.tlc.process import run_tlc
from modeproof.tlc.runs import load_runs
from modeproof.tlc.toolchain import find_toolchain

DOCUMENT = "guard_locking"
SPEC = root() / "spec" / DOCUMENT
REGISTERS = load_document(root(), DOCUMENT)
PROPERTIES = {one.id: one for one in REGISTERS.properties}
RUNS = {run.id: run for run in load_runs(root(), DOCUMENT)}
BASE = "MC_SF_GuardLocking_arbitrary"
OTHER = {
    "LatchedRequestUnlocks": "MC_SF_GuardLocking_latched",
    "EnablesAgain": "LIVE_SF_GuardLocking_recovery",
    "EntryIsGranted": "LIVE_SF_GuardLocking_entry",
}
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
        'GoTo("GuardClosedAndLocked") /\\ Did("StayLocked")',
        'GoTo("WaitForReset") /\\ Did("StayLocked")',
    ),
    "ErrorNeedsCause": (
        'GoTo("WaitForOperator")\n    /\\ Did("AcknowledgeError")',
        'GoTo("ResetError2")\n    /\\ Did("AcknowledgeError")',
    ),
    "ErrorEndsWithCause": ('[] OTHER -> "WaitForReset"', '[] OTHER -> "GuardClosedAndLocked"'),
    "LatchedRequestUnlocks": (
        'i.UnlockRequest /\\ (RequestRises(i) \\/ requestPending)\n      [] UNLOCK_ON = "level"',
        'i.UnlockRequest /\\ RequestRises(i)\n      [] UNLOCK_ON = "level"',
    ),
    "CodeTellsTheGuard": (
        '"WaitForOperator" ELSE "GuardOpenAndUnlocked")',
        '"WaitForOperator" ELSE "GuardClosedButUnlocked")',
    ),
    "OneTransitionACall": (
        'At("Idle", i) /\\ GoTo("Init") /\\ Did("StartUp")',
        'At("Idle", i) /\\ GoTo("WaitForOperator") /\\ Did("StartUp")',
    ),
    "AnswersAtOnce": (
        'GoTo("SafetyReturn") /\\ Did("SeeZoneSafe")',
        'GoTo("SafetyLost") /\\ Did("SeeZoneSafe")',
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
FALLEN = {run.violates: run.id for run in RUNS.values() if run.kind == "NEG"}


def checked(place: Path, name: str, edit: tuple[str, str]) -> list[tuple[str, str]]:
    """What TLC says of this property alone on a copy with the edit."""
    base = RUNS[OTHER.get(name, BASE)]
    folder = place / "spec" / DOCUMENT
    shutil.copytree(SPEC, folder)
    shutil.copytree(SPEC.parent / "common", place / "spec/common")
    text = (folder / "GuardLocking.tla").read_text()
    assert text.count(edit[0]) == 1, edit[0]
    (folder / "GuardLocking.tla").write_text(text.replace(*edit))
    kind = "INVARIANT" if PROPERTIES[name].kind == "invariant" else "PROPERTY"
    text = (folder / base.cfg).read_text()
    text = re.sub(r"^(INVARIANTS|PROPERTIES)(?s:.*)", f"{kind} {name}\n", text, flags=re.MULTILINE)
    (folder / base.cfg).write_text(text)
    digest = hashlib.sha256(text.encode()).hexdigest()
    run = replace(base, properties=(name,), cfg_sha256=digest)
    return list(run_tlc(place, run, find_toolchain()).log.violations)


@pytest.mark.parametrize("name", FAULTS)
def test_the_property_falls_to_the_fault(name: str, tmp_path: Path) -> None:
    if PROPERTIES[name].kind == "liveness":  # TLC does not name it, but checked no other
        assert checked(tmp_path, name, FAULTS[name]) == [("temporal", "")]
        return
    said = "invariant" if PROPERTIES[name].kind == "invariant" else "property"
    assert checked(tmp_path, name, FAULTS[name]) == [(said, name)]


def test_nothing_planted_nothing_falls(tmp_path: Path) -> None:
    unchanged = 'Ready == state # "Idle"'
    assert checked(tmp_path, "AnswersAtOnce", (unchanged, unchanged)) == []


def test_every_property_falls_to_something() -> None:
    assert set(FAULTS) | {name for name in FALLEN if name} == set(PROPERTIES)


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    files = ("guard_locking/GuardLocking.tla", "common/CyclicBlock.tla")
    text = "".join((SPEC.parent / file).read_text() for file in files)
    lists = re.findall(r"Readings == (?:\w+ \\cup )?\{([^}]*)\}", text)
    readings = {name for one in lists for name in re.findall(r'"(\w+)"', one)}
    tried = {run.switch: run.kind for run in REGISTERS.runs if run.switch in readings}
    assert len(readings) == 13 and set(tried) == readings
    assert sorted(name for name, kind in tried.items() if kind != "NEG") == [
        "ERROR_UNTIL_RESET",
        "RESET_SEEN_ONLY_WHILE_ACTIVE",
    ]


def test_every_state_code_and_transition_is_witnessed() -> None:
    device = REGISTERS.interface.devices["sf_guard_locking"]
    (witnessed,) = [set(run.witnesses) for run in REGISTERS.runs if run.kind == "WIT"]
    assert set(device.states) <= witnessed and set(device.steps) <= witnessed
    assert len({name for name in witnessed if name.startswith("DiagCode")}) == len(device.states) == 12
    transitions = {name for name in witnessed if re.fullmatch(r"[A-Z]\w+To[A-Z]\w+", name)}
    assert {f"{one}ToIdle" for one in device.states if one != "Idle"} <= transitions
    listed = re.findall(r"<<\\h\w{4}, \\h\w{4}>>", (SPEC / "GuardLockingOpen.tla").read_text())
    assert len(transitions) == 11 + 24 and len(listed) >= 24
