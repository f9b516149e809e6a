"""A signal sequence that a page prints is played in its printed order, with the parameters of the letter."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from typing import Any

import pytest

from refimpl.edm import sf_edm
from refimpl.enable_switch import sf_enable_switch
from refimpl.guard_locking import sf_guard_locking
from refimpl.testable_safety_sensor import sf_testable_safety_sensor

Row = tuple[str, Mapping[str, Any], Mapping[str, bool]]
"""What a line of the page says: its number, the inputs that change, the outputs that it names."""
TIME_MS = 100
"""The time of each block; a call is 10 ms after the one before where a row does not say dt_ms."""
DROPPED, PICKED = {"S_EDM1": True, "S_EDM2": True}, {"S_EDM1": False, "S_EDM2": False}
OFF = {"S_EDM_Out": False, "Error": False}
EDM: Sequence[Row] = (
    ("0", DROPPED, {"Ready": False, **OFF, "SafetyDemand": False, "ResetRequest": False}),
    ("1", {"Activate": True}, {"Ready": True, "S_EDM_Out": False}),
    ("1", {}, {"S_EDM_Out": False}),
    ("2", {"Reset": True}, OFF),
    ("2", {"Reset": False, "dt_ms": TIME_MS}, OFF),
    ("2", {}, OFF),
    ("3", {"S_OutControl": True}, {"S_EDM_Out": True}),
    ("3", {**PICKED, "dt_ms": TIME_MS - 1}, {"S_EDM_Out": True, "Error": False}),
    ("3", {"dt_ms": TIME_MS}, {"S_EDM_Out": True, "Error": False}),
    ("4", {"S_OutControl": False}, OFF),
    ("4", {**DROPPED, "dt_ms": TIME_MS - 1}, OFF),
    ("4", {"dt_ms": TIME_MS}, OFF),
    ("5", {"S_OutControl": True}, {"S_EDM_Out": True}),
    ("5", {"dt_ms": TIME_MS}, {"S_EDM_Out": False, "Error": True}),
    ("6", {"S_OutControl": False, "Reset": True}, {"Error": False}),
    ("6", {"Reset": False, "dt_ms": TIME_MS}, {"Error": False}),
    ("6", {}, {"Error": False}),
    # S_OutControl TRUE, and Reset: "can cause the S_EDM_Out output to switch to SAFETRUE immediately"
    ("reset", {"S_OutControl": True}, {"S_EDM_Out": True}),
    ("reset", {"dt_ms": TIME_MS}, {"Error": True}),
    ("reset", {"Reset": True}, {"Error": False}),
    ("reset", {}, {"S_EDM_Out": True}),
)
LOCKED = {"S_GuardMonitoring": True, "S_GuardLock": True}
GUARD: Sequence[Row] = (
    (
        "0",
        {**LOCKED, "S_SafetyActive": True},
        {"Ready": False, "S_GuardLocked": False, "S_UnlockGuard": False},
    ),
    ("1", {"Activate": True}, {"S_GuardLocked": False}),
    ("1", {}, {"S_GuardLocked": False}),
    ("2", {"Reset": True}, {"S_GuardLocked": True}),
    ("2", {"Reset": False, "S_SafetyActive": False}, {"S_GuardLocked": True}),
    ("3", {"UnlockRequest": True}, {"S_GuardLocked": True, "S_UnlockGuard": False}),
    ("3", {"S_SafetyActive": True}, {"S_GuardLocked": False, "S_UnlockGuard": True}),
    ("3", {}, {"S_UnlockGuard": True}),
    (
        "4",
        {"S_GuardMonitoring": False, "S_GuardLock": False},
        {"S_GuardLocked": False, "S_UnlockGuard": True},
    ),
    ("4", {"S_GuardMonitoring": True}, {"S_GuardLocked": False, "S_UnlockGuard": True}),
    ("5", {"UnlockRequest": False}, {"S_GuardLocked": False, "S_UnlockGuard": False}),
    ("5", {}, {"S_GuardLocked": False, "S_UnlockGuard": False}),
    # "The TRUE signal must be maintained for as long as the guard locking is unlocked"
    ("request", {"UnlockRequest": True}, {"S_UnlockGuard": True}),
    ("request", {"S_GuardMonitoring": False}, {"S_UnlockGuard": True}),
    ("request", {"UnlockRequest": False}, {"S_UnlockGuard": False}),
    ("request", {"S_GuardMonitoring": True}, {"S_UnlockGuard": False}),
    # "Resetting error messages when the cause of the error is no longer present"
    ("message", {"S_GuardLock": True}, {"S_GuardLocked": False}),
    ("message", {"Reset": True}, {"S_GuardLocked": True}),
    ("message", {"Reset": False, "S_GuardMonitoring": False}, {"S_GuardLocked": False, "Error": True}),
    ("message", {"S_GuardMonitoring": True}, {"Error": True}),
    ("message", {}, {"Error": True}),
    ("message", {"Reset": True}, {"Error": False}),
)
CHANNELS = ("S_EnableSwitchCh1", "S_EnableSwitchCh2", "S_EnableSwitchCh3")
STAGE_0, STAGE_1, STAGE_2 = (
    dict(zip(CHANNELS, (channel == "1" for channel in stage), strict=True)) for stage in ("010", "101", "000")
)
FALSE = {"S_EnableSwitchOut": False, "Error": False}
SWITCH: Sequence[Row] = (
    ("0", STAGE_0, {"Ready": False, **FALSE}),
    ("1", {"Activate": True}, {"Ready": True, **FALSE}),
    ("2", {"S_SafetyActive": True}, FALSE),
    ("2", {}, FALSE),
    ("3", {"S_EnableSwitchCh1": True, "S_EnableSwitchCh2": False}, FALSE),
    ("3", {"dt_ms": TIME_MS}, {"S_EnableSwitchOut": False, "Error": True}),
    ("4", STAGE_2, {"S_EnableSwitchOut": False, "Error": True}),
    ("4", STAGE_0, {"S_EnableSwitchOut": False, "Error": True}),
    ("5", {"Reset": True}, FALSE),
    ("5", {"Reset": False}, FALSE),
    ("6", {"S_EnableSwitchCh1": True, "S_EnableSwitchCh2": False}, FALSE),
    ("6", {"S_EnableSwitchCh3": True, "dt_ms": TIME_MS - 20}, {"S_EnableSwitchOut": True}),
    ("7", STAGE_2, FALSE),
    ("8", STAGE_0, FALSE),
    ("9", STAGE_1, {"S_EnableSwitchOut": True}),
)
DARK, LIT = {"S_OSSD_In": False}, {"S_OSSD_In": True}
SENSOR: Sequence[Row] = (
    ("0", LIT, {"Ready": False, "S_OSSD_Out": False}),
    ("0", {"Activate": True}, {"Ready": True, "S_OSSD_Out": False}),
    ("0", {}, {"S_OSSD_Out": False}),
    ("0", {"Reset": True}, {"Error": False}),
    ("0", {"Reset": False}, {"S_OSSD_Out": True, "S_TestOut": True, "TestPossible": True}),
    ("1", {"StartTest": True}, {"S_TestOut": False, "S_OSSD_Out": True}),
    ("2", {**DARK, "dt_ms": TIME_MS - 1}, {"S_TestOut": True, "S_OSSD_Out": True}),
    ("3", {**LIT, "dt_ms": TIME_MS - 1}, {"S_TestOut": True, "S_OSSD_Out": True, "Error": False}),
)
PAGES: Mapping[str, tuple[Any, Callable[..., Any], Sequence[Row], Mapping[str, str]]] = {
    "edm": (
        sf_edm,
        lambda **given: sf_edm.Params(MonitoringTime_ms=TIME_MS, **given),
        EDM,
        {"AFTER_RESET": "stop_first"},
    ),
    "guard locking": (
        sf_guard_locking,
        sf_guard_locking.Params,
        GUARD,
        {"UNLOCK_ON": "edge", "UNLOCK_ENDS": "when_closed", "MESSAGE_OF_LOSS": "until_safe"},
    ),
    "enable switch": (
        sf_enable_switch,
        lambda **given: sf_enable_switch.Params(DiscrepancyTimeCh1_Ch3_ms=TIME_MS, **given),
        SWITCH,
        {},
    ),
    "sensor": (
        sf_testable_safety_sensor,
        lambda **given: sf_testable_safety_sensor.Params(TestTime_ms=TIME_MS, **given),
        SENSOR,
        {},
    ),
}
"""Of each page the block, its parameters, the rows, and of some parameters a value that they cannot have."""


def first_wrong(block: Any, params: Any, rows: Sequence[Row]) -> str:
    """The number of the first line that comes out otherwise than printed; empty where none does."""
    state = block.power_up(params)
    inputs: dict[str, Any] = {field.name: False for field in fields(block.Inputs)}
    for number, changed, printed in rows:
        inputs |= {"dt_ms": 10, **changed}
        state, out = block.step(state, block.Inputs(**inputs))
        if any(getattr(out, name) != value for name, value in printed.items()):
            return number
    return ""


@pytest.mark.parametrize("page", PAGES)
def test_the_printed_order_is_played_by_the_letter(page: str) -> None:
    block, params, rows, _ = PAGES[page]
    assert first_wrong(block, params(), rows) == ""


@pytest.mark.parametrize(
    ("page", "name", "line"),
    [
        ("edm", "AFTER_RESET", "reset"),
        ("guard locking", "UNLOCK_ON", "3"),
        ("guard locking", "UNLOCK_ENDS", "request"),
        ("guard locking", "MESSAGE_OF_LOSS", "message"),
    ],
)
def test_with_the_old_default_a_printed_line_fails(page: str, name: str, line: str) -> None:
    block, params, rows, others = PAGES[page]
    assert first_wrong(block, params(**{name: others[name]}), rows) == line


@pytest.mark.parametrize(("value", "comes_back"), [("at_once", True), ("stop_first", False)])
def test_the_printed_wiring_comes_back_after_a_reset(value: str, comes_back: bool) -> None:
    """S_GuardLocked at S_OutControl, as the page on guard locking prints; contactors that fail once."""
    guard = sf_guard_locking.power_up(sf_guard_locking.Params())
    edm = sf_edm.power_up(sf_edm.Params(TIME_MS, value))
    on: list[bool] = []
    for call in range(60):
        reset = call in (3, 40)
        given = {field.name: False for field in fields(sf_guard_locking.Inputs)} | {"dt_ms": 10, **LOCKED}
        guard, seen = sf_guard_locking.step(
            guard, sf_guard_locking.Inputs(**{**given, "Activate": True, "Reset": reset})
        )
        follows = bool(on and on[-1]) and call > 40
        edm, out = sf_edm.step(
            edm,
            sf_edm.Inputs(10, True, seen.S_GuardLocked, not follows, not follows, True, reset),
        )
        on.append(out.S_EDM_Out)
    assert any(on[:40]) and not on[39], "it came on, and the contactors did not follow"
    assert on[-1] == comes_back


@pytest.mark.parametrize(
    ("page", "params", "line"),
    [
        ("enable switch", sf_enable_switch.Params(DiscrepancyTimeCh1_Ch3_ms=20), "6"),
        ("sensor", sf_testable_safety_sensor.Params(TestTime_ms=20), "2"),
    ],
)
def test_with_too_short_a_time_a_printed_line_fails(page: str, params: Any, line: str) -> None:
    block, _, rows, _ = PAGES[page]
    assert first_wrong(block, params, rows) == line
