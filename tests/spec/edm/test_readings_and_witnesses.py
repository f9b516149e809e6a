"""Every reading of external device monitoring is tried, and every state, code and transition is witnessed."""

from __future__ import annotations

import re

from tests.spec.block import Block

BLOCK = Block("edm")


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    readings, tried = BLOCK.readings(), BLOCK.tried()
    assert len(readings) == 18 and set(tried) == readings
    assert sorted(name for name, kind in tried.items() if kind != "NEG") == [
        "ErrorRemembered",
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
