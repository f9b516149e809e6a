"""Each property of external device monitoring falls to a reading of the paper, or to a planted fault."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.spec.block import Block

BLOCK = Block("edm", "EDM.tla", "MC_SF_EDM_arbitrary")
FAULTS = {
    "OutputNeedsAll": (
        'ResetRequest == state = "Init"',
        'ResetRequest == state \\in {"Init", "OutputEnable"}',
    ),
    "IdleShowsNothing": ('state = "Idle" -> 0', 'state = "Idle" -> 1'),
    "CodeTellsTheRow": ('state = "EDMError22" -> \\hC050', 'state = "EDMError22" -> \\hC051'),
    "PowerUpIsSafe": ('EDMInit ==\n    /\\ state = "Idle"', 'EDMInit ==\n    /\\ state = "Init"'),
    "EveryCallIsAnswered": ("(ReturnToError(i) \\/ AwaitReleaseInError(i))", "ReturnToError(i)"),
    "StopAtOnce": (
        "~LateInEnable(i) /\\ i.S_OutControl\n    /\\ Waits(i)",
        "~LateInEnable(i)\n    /\\ Waits(i)",
    ),
    "InactiveAtOnce": (
        '~i.Activate /\\ To("Idle") /\\ Did("Deactivate")',
        '~i.Activate /\\ To("Init") /\\ Did("Deactivate")',
    ),
    "SwitchOnNeedsInitialState": (
        "Feedback(i, dropped) == i.S_EDM1 = dropped /\\ i.S_EDM2 = dropped",
        "Feedback(i, dropped) == i.S_EDM1 = dropped",
    ),
    "MissedDropOutIsAnError": (
        "LateInDisable(i) == Expired(i) /\\ ~Feedback(i, TRUE)",
        "LateInDisable(i) == Expired(i) /\\ ~i.S_EDM1",
    ),
    "ErrorsAreLeftAsDocumented": (
        'To("Init") /\\ Did("ReturnToInit")',
        'Disable(TRUE) /\\ Did("ReturnToInit")',
    ),
    "HeldResetIsAnError": (
        'To(ResetErrors[Number(state, EDMErrors)])\n    /\\ Did("FindStaticResetInError")',
        'Stay\n    /\\ Did("FindStaticResetInError")',
    ),
    "StartsWithInhibit": (
        'To("Init") /\\ Did("Initialize")',
        'To(IF i.S_StartReset THEN "OutputEnable" ELSE "Init") /\\ Did("Initialize")',
    ),
    "OneTransitionACall": ('To("Init") /\\ Did("ReturnToInit")', 'Disable(TRUE) /\\ Did("ReturnToInit")'),
    "SwitchesOnAtOnce": (
        'Disable(CountsAfterReset(i))\n    /\\ Did("ResetError")',
        'Disable(FALSE)\n    /\\ Did("ResetError")',
    ),
    "RemovesInhibitAtOnce": (
        "Together(i) == ResetRises(i) /\\ Rises(i.S_OutControl, outControlBefore)",
        "Together(i) == ResetRises(i) /\\ i.S_OutControl",
    ),
    "ErrorNeedsCause": (
        "LateInEnable(i) == Expired(i) /\\ ~Feedback(i, FALSE)",
        "LateInEnable(i) == Expired(i) /\\ ~(i.S_EDM1 /\\ ~i.S_EDM2)",
    ),
    "ResetErrorKeepsTheCode": (
        "To(EDMErrors[Number(state, ResetErrors)])",
        'To(IF state = "ResetError23" THEN "EDMError22" ELSE EDMErrors[Number(state, ResetErrors)])',
    ),
}


@pytest.mark.sampled(8)
@pytest.mark.parametrize("name", FAULTS)
def test_the_property_falls_to_the_fault(name: str, tmp_path: Path) -> None:
    assert BLOCK.checked(tmp_path, name, FAULTS[name]) == BLOCK.falls(name)


def test_nothing_planted_nothing_falls(tmp_path: Path) -> None:
    unchanged = 'Ready == state # "Idle"'
    assert BLOCK.checked(tmp_path, "ErrorNeedsCause", (unchanged, unchanged)) == []


def test_every_property_falls_to_something() -> None:
    assert set(FAULTS) | BLOCK.fallen == set(BLOCK.properties)


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    readings, tried = BLOCK.readings(), BLOCK.tried()
    assert len(readings) == 14 and set(tried) == readings
    assert sorted(name for name, kind in tried.items() if kind != "NEG") == [
        "RequestWaits",
        "ResetSeenOnlyWhileActive",
    ]


def test_every_state_code_and_transition_is_witnessed() -> None:
    device = BLOCK.registers.interface.devices["sf_edm"]
    witnessed, cautious = [set(run.witnesses) for run in BLOCK.registers.runs if run.kind == "WIT"]
    assert cautious == witnessed | {"RequestHeldOverReset"}
    assert set(device.steps) <= witnessed
    assert {f"at {state}" for state in device.states} <= witnessed
    assert len({name for name in witnessed if name.startswith("code ")}) == len(device.states) == 24
    transitions = {name for name in witnessed if re.fullmatch(r"\w+ to \w+", name)}
    assert {f"{state} to Idle" for state in device.states if state != "Idle"} <= transitions
    assert len(transitions) == 1 + 23 + 3 + 2 + 7 + 4 + 9 * 3


def test_reading_a_trace_has_a_case_for_every_sequence_step() -> None:
    text = (BLOCK.spec / "sequences.toml").read_text()
    assert re.findall(r"^    # (\d)$", text, re.MULTILINE) == list("0123456")
