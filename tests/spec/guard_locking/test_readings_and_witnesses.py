"""Every reading of the guard locking is tried, and every state, code and transition is witnessed."""

from __future__ import annotations

import re

from tests.spec.block import Block

BLOCK = Block("guard_locking")


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    readings, tried = BLOCK.readings(), BLOCK.tried()
    assert len(readings) == 13 and set(tried) == readings
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
