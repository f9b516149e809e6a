"""Every reading of the sensor block is tried, and what no property of states can see."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import msgspec

from modeproof.registers.made import make
from modeproof.tlc.process import run_tlc
from modeproof.tlc.toolchain import find_toolchain
from tests.spec.block import Block

BLOCK = Block("testable_safety_sensor")


def test_every_reading_is_a_negative_or_is_told_harmless() -> None:
    readings, tried = BLOCK.readings(), BLOCK.tried()
    assert len(readings) == 20 and set(tried) == readings
    assert sorted(name for name, kind in tried.items() if kind != "NEG") == [
        "StaticResetBeforeTestTime",
        "WaitForResetNeedsEdge",
    ]


def test_the_reading_that_leaves_the_states_changes_transitions(tmp_path: Path) -> None:
    shutil.copytree(BLOCK.spec.parent, tmp_path / "spec")
    graphs = []
    for reading in ((), "WaitForResetNeedsEdge"):
        base = BLOCK.runs["OPEN_SF_TestableSafetySensor_zero"]
        folder, run = make(tmp_path, msgspec.structs.replace(base, reading=reading))
        file = run_tlc(tmp_path, run, find_toolchain(), made_in=folder).graph_file
        assert file is not None
        graphs.append(set(file.read_text().splitlines()))
    decided, otherwise = graphs
    assert len(decided) == len(otherwise) and len(decided - otherwise) == len(otherwise - decided) > 0


def test_every_state_step_code_and_transition_is_witnessed() -> None:
    device = BLOCK.registers.interface.devices["sf_testable_safety_sensor"]
    witnessed = {name for run in BLOCK.registers.runs if run.kind == "WIT" for name in run.witnesses}
    assert set(device.steps) <= witnessed
    assert len({name for name in witnessed if name.startswith("DiagCode")}) == len(device.states) == 22
    states = "|".join(sorted(device.states, key=len, reverse=True))
    joined = {name for name in witnessed if re.fullmatch(rf"({states})To({states})", name)}
    assert {f"{one}ToIdle" for one in device.states if one != "Idle"} <= joined
    entered = {re.fullmatch(rf"({states})To({states})", name).group(2) for name in joined}  # type: ignore[union-attr]
    assert entered == set(device.states) and len(joined) == 21 + 45
