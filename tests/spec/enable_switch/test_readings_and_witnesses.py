"""Every reading of the enable switch is tried, and every state, code and transition is witnessed."""

from __future__ import annotations

import re

from tests.spec.block import Block

BLOCK = Block("enable_switch")


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    readings, tried = BLOCK.readings(), BLOCK.tried()
    assert len(readings) == 17 and set(tried) == readings
    assert sorted(name for name, kind in tried.items() if kind != "NEG") == [
        "ErrorRemembered",
        "JudgedWithoutTheMode",
        "NoErrorAfterStage2",
        "ResetSeenOnlyWhileActive",
        "StageSeenWithTheMode",
    ]


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
