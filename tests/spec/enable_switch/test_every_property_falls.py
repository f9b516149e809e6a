"""Each property of the enable switch falls to a reading of the paper, or to a planted fault."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.spec.block import Block

BLOCK = Block(
    "enable_switch",
    "EnableSwitch.tla",
    "MC_SF_EnableSwitch_arbitrary",
    others={"EndOfModeEndsErrors": "MC_SF_EnableSwitch_mode_ends_error"},
    small={
        "EnableSwitchOpen.tla": ("N == 2 * 2 * 8 * 2 * 2 * 3", "N == 2 * 2 * 8 * 2 * 2 * 2")
    },  # 0 or 1 tick a call
)
FAULTS = {
    "OutputsFollowTheCode": ("Error == state \\in Errors", "Error == state \\in Errors \\ ResetErrors"),
    "EveryStateHasItsRow": ('state = "Stage0" -> \\h8802', 'state = "Stage0" -> \\h8803'),
    "IdleIsSilent": ('Ready == state # "Idle"', 'Ready == state # "Stage2"'),
    "EnableStandsAlone": (
        'SafetyDemand == state \\in {"Stage0", ',
        'SafetyDemand == state \\in {"Stage0", "Stage1", ',
    ),
    "EveryCallIsAnswered": ("\\/ AwaitStage0(i) \\/ SeeStage0(i)", "\\/ SeeStage0(i)"),
    "PowerUpIsSilent": ('BlockInit == state = "Idle"', 'BlockInit == state = "BasicMode"'),
    "ActivateGoesFirst": ('To("Idle", i) /\\ Did("Deactivate")', 'To("BasicMode", i) /\\ Did("Deactivate")'),
    "ModeEndsOperation": (
        'To("BasicMode", i) /\\ Did("LoseSafetyActive")',
        'To("Stage0", i) /\\ Did("LoseSafetyActive")',
    ),
    "ErrorNeedsResetInTheMode": (
        "~(ResetStatic(i) /\\ ~AutoReset(i)) /\\ Resets(i)",
        "~(ResetStatic(i) /\\ ~AutoReset(i))",
    ),
    "ResetEndsTheError": ('~Resets(i) /\\ Stay(i) /\\ Did("AwaitReset")', 'Stay(i) /\\ Did("AwaitReset")'),
    "EndOfModeEndsErrors": ("i.Activate /\\ (MODE_ENDS_ERROR => i.S_SafetyActive)", "i.Activate"),
    "LateChangeHasItsError": (
        'To("PlausibilityError", i)\n    /\\ Did("FindContradiction")',
        'To("EquivalenceError", i)\n    /\\ Did("FindContradiction")',
    ),
    "HeldResetIsAnError": ("/\\ Held(ResetErrors, i) /\\ ~i.Reset\n", "/\\ Held(ResetErrors, i)\n"),
    "OneTransitionACall": (
        '/\\ To(IF i.S_SafetyActive THEN "Stage0" ELSE "BasicMode", i)',
        '/\\ To(IF i.S_SafetyActive THEN "Stage1" ELSE "BasicMode", i)',
    ),
    "PatternsDecide": (
        '/\\ SeesStage0(i)\n    /\\ To("Stage0", i)',
        '/\\ SeesStage0(i)\n    /\\ To("SafeMode", i)',
    ),
}


@pytest.mark.sampled(8)
@pytest.mark.parametrize("name", FAULTS)
def test_the_property_falls_to_the_fault(name: str, tmp_path: Path) -> None:
    assert BLOCK.checked(tmp_path, name, FAULTS[name]) == BLOCK.falls(name)


def test_nothing_planted_nothing_falls(tmp_path: Path) -> None:
    assert BLOCK.checked(tmp_path, "PatternsDecide", ("Errors == (Faulty", "Errors == (Faulty")) == []


def test_every_property_falls_to_something() -> None:
    assert set(FAULTS) | BLOCK.fallen == set(BLOCK.properties)


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    readings, tried = BLOCK.readings(), BLOCK.tried()
    assert len(readings) == 13 and set(tried) == readings
    assert [name for name, kind in tried.items() if kind != "NEG"] == ["ResetSeenOnlyWhileActive"]


def test_every_state_step_code_and_transition_is_witnessed() -> None:
    device = BLOCK.registers.interface.devices["sf_enable_switch"]
    (witnessed,) = [set(run.witnesses) for run in BLOCK.registers.runs if run.kind == "WIT"]
    assert set(device.steps) <= witnessed
    assert len({name for name in witnessed if name.startswith("DiagCode")}) == len(device.states) == 17
    states = "|".join(device.states)
    pairs = [re.fullmatch(rf"({states})To({states})", name) for name in witnessed]
    joined = {(one[1], one[2]) for one in pairs if one}
    assert {(one, "Idle") for one in device.states if one != "Idle"} <= joined
    assert {entered for _, entered in joined} == set(device.states)
    # To Idle, from all others; to BasicMode, from Idle, from 6 states of the mode, from 9 errors
    ended = 16 + 16
    assert len(joined) == ended + (1 + 2) + (3 + 5 + 3 + 4 + 3) + 3 * (1 + 3 + 1)
