"""Response times whose theorem counts down a number: so many calls are really needed (properties.toml)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import ModuleType
from typing import Any

import pytest

from modeproof.ground.places import root
from modeproof.registers import load_responses
from refimpl.edm import sf_edm
from refimpl.guard_locking import sf_guard_locking
from refimpl.mode_selection import fplc
from refimpl.testable_safety_sensor import sf_testable_safety_sensor


def calls_of(document: str, row_id: str) -> int:
    (row,) = (row for row in load_responses(root(), document).rows if row.id == row_id)
    assert row.calls is not None
    return row.calls


def played(block: ModuleType, state: Any, inputs: Callable[[Any], dict[str, Any]], output: str) -> int:
    """The calls up to the first with this output; an input that is not named is FALSE."""
    off = dict.fromkeys(block.Inputs.__dataclass_fields__, False)
    for call in range(1, 20):
        state, sends = block.step(
            state, block.Inputs(**{**off, "dt_ms": 1, "Activate": True, **inputs(state)})
        )
        if getattr(sends, output):
            return call
    raise AssertionError(f"{output} is never TRUE")


def served_contactors(state: sf_edm.State) -> dict[str, Any]:
    off, on = (state.state.value == name for name in ("OutputDisable", "OutputEnable"))
    wanted = state.stop_seen if off else on
    return {"S_OutControl": wanted, "S_EDM1": not on, "S_EDM2": not on, "Reset": not state.reset_before}


def served_guard(state: sf_guard_locking.State) -> dict[str, Any]:
    secure = dict.fromkeys(("S_GuardMonitoring", "S_GuardLock", "S_SafetyActive"), True)
    return {**secure, "Reset": not state.reset_before}


def served_sensor(state: sf_testable_safety_sensor.State) -> dict[str, Any]:
    shown = sf_testable_safety_sensor.outputs(state)
    dark = state.state.value == "ExternalFunctionTest" and state.sensor_before
    asked = shown.ResetRequest or shown.Error
    return {"S_OSSD_In": not dark, "Reset": asked and not state.reset_before}


@pytest.mark.parametrize(
    ("row", "block", "start", "inputs", "output"),
    [
        ("edm EDMR-05", sf_edm, "Idle", served_contactors, "S_EDM_Out"),
        ("guard_locking GLR-06", sf_guard_locking, "SafetyLost", served_guard, "S_GuardLocked"),
        (
            "testable_safety_sensor TSSR-05",
            sf_testable_safety_sensor,
            "ResetError3",
            served_sensor,
            "S_OSSD_Out",
        ),
    ],
)
def test_no_fewer_calls_bring_the_output_back(
    row: str, block: ModuleType, start: str, inputs: Callable[[Any], dict[str, Any]], output: str
) -> None:
    state = replace(block.power_up(block.Params()), state=block.Step(start))
    assert played(block, state, inputs, output) == calls_of(*row.split())


def test_without_a_dwell_time_the_fplc_needs_its_calls() -> None:
    params = fplc.Params(T_DWELL_ms=0, T_REM_ms=2)
    state = replace(fplc.power_up(params), state=fplc.Step.PULSE_ONES)
    zeros: dict[str, Any] = {**dict.fromkeys(("LA", "A", "B", "C", "D", "STR"), False), "MW03": 0, "MW07": 0}
    passed = []
    while state.state is not fplc.Step.IDLE:
        state, _ = fplc.step(state, fplc.Inputs(dt_ms=1, **zeros))
        passed.append(state.state.value)
    assert passed == ["Clear", "AwaitZeros", "Error", "Idle"]
    late = passed.index("Error")  # so many scans after the first quiet one it is still not in Idle
    assert late == calls_of("mode_selection", "R-07")
