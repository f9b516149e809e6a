"""The enable switch as the signal sequence of the document walks it, and where it does not."""

from __future__ import annotations

import itertools
from dataclasses import replace

import pytest

from refimpl.enable_switch.sf_enable_switch import (
    Inputs,
    Outputs,
    Params,
    State,
    Step,
    outputs,
    power_up,
    step,
)
from refimpl.errors import InputError, ParameterError, StateError

S0, S1, S2 = (False, True, False), (True, False, True), (False, False, False)
PATTERNS = tuple(itertools.product((False, True), repeat=3))
BETWEEN = tuple(one for one in PATTERNS if one not in (S0, S1, S2))
PARAMS = Params(DiscrepancyTimeCh1_Ch3_ms=100)


def call(channels: tuple[bool, bool, bool] = S0, dt_ms: int = 10, **other: bool) -> Inputs:
    """A call in the mode; channels 1, 2, 3."""
    given = {"Activate": True, "S_SafetyActive": True, "S_AutoReset": False, "Reset": False, **other}
    first, second, third = channels
    return Inputs(
        dt_ms=dt_ms, S_EnableSwitchCh1=first, S_EnableSwitchCh2=second, S_EnableSwitchCh3=third, **given
    )


def run(state: State, *calls: Inputs) -> tuple[State, Outputs]:
    after, out = state, outputs(state)
    for one in calls:
        after, out = step(after, one)
    return after, out


def at(control: Step, elapsed_ms: int = 0, reset_before: bool = False, params: Params = PARAMS) -> State:
    return State(params, control, reset_before, elapsed_ms)


def test_the_signal_sequence_of_the_document() -> None:
    state, out = run(power_up(PARAMS), call(Activate=False, S_SafetyActive=False))  # 0
    assert not any(
        (out.Ready, out.S_EnableSwitchOut, out.SafetyDemand, out.ResetRequest, out.Error, out.DiagCode)
    )
    state, out = run(state, call(S_SafetyActive=False))  # 1
    assert not out.S_EnableSwitchOut and not out.Error
    state, out = run(state, call(), call())  # 2: the mode comes, one call later stage 0 is there
    assert (state.state, out.S_EnableSwitchOut) == (Step.STAGE_0, False)
    state, out = run(state, call((True, False, False)), call((True, False, False), dt_ms=99))  # 3
    assert not out.Error and not out.S_EnableSwitchOut
    state, out = run(state, call((True, False, False), dt_ms=1))
    assert out.Error and not out.S_EnableSwitchOut and out.DiagCode == 0xC050
    state, out = run(state, call(S2), call(S2, Reset=True), call(S2))  # 4: unplugged; a reset does nothing
    assert out.Error and not out.ResetRequest
    state, out = run(state, call(S0))
    assert out.Error and out.ResetRequest and not out.S_EnableSwitchOut
    state, out = run(state, call(S0, Reset=True))  # 5
    assert not out.Error and not out.S_EnableSwitchOut
    state, out = run(state, call((True, False, False)), call(S1, dt_ms=99))  # 6
    assert out.S_EnableSwitchOut and out.DiagCode == 0x8000
    state, out = run(state, call(S2))  # 7
    assert not out.S_EnableSwitchOut and not out.Error
    state, out = run(state, call((False, True, True)), call(S0, dt_ms=99))  # 8
    assert (state.state, out.S_EnableSwitchOut) == (Step.STAGE_0, False)
    state, out = run(state, call(S1))  # 9
    assert out.S_EnableSwitchOut


@pytest.mark.parametrize("late", ["the time is reached", "the time is passed"])
def test_channels_that_come_together_too_late_do_not_enable(late: str) -> None:
    dt_ms = 100 if late == "the time is reached" else 101
    for pattern in BETWEEN:
        after, out = run(at(Step.STAGE_0), call(pattern), call(S1, dt_ms=dt_ms))
        assert after.state == Step.EQUIVALENCE_ERROR and not out.S_EnableSwitchOut
        assert run(at(Step.STAGE_0), call(pattern), call(S1, dt_ms=99))[1].S_EnableSwitchOut


def test_the_time_goes_on_whichever_patterns_follow_each_other() -> None:
    calls = [call(one, dt_ms=19) for one in BETWEEN]
    assert run(at(Step.CHANGE_TO_STAGE_1), *calls)[0].elapsed_ms == 95
    assert run(at(Step.CHANGE_TO_STAGE_1), *calls, call(BETWEEN[0], dt_ms=5))[1].Error


def test_the_initial_time_accepts_only_changes_within_one_call() -> None:
    zero = at(Step.STAGE_0, params=Params())
    assert run(zero, call(S1))[1].S_EnableSwitchOut
    for pattern in BETWEEN:
        assert not run(zero, call(pattern))[1].Error
        assert run(zero, call(pattern), call(S1, dt_ms=0))[1].Error


def test_channel_2_that_stays_true_has_its_own_error() -> None:
    assert run(at(Step.CHANGE_TO_STAGE_1), call((True, True, True), dt_ms=100))[1].DiagCode == 0xC030
    assert run(at(Step.CHANGE_TO_STAGE_0), call((True, False, False), dt_ms=100))[1].DiagCode == 0xC050


def test_the_enable_drops_in_any_call_without_stage_1() -> None:
    for pattern in PATTERNS:
        assert run(at(Step.STAGE_1), call(pattern))[1].S_EnableSwitchOut == (pattern == S1)
    assert not run(at(Step.STAGE_1), call(S1, S_SafetyActive=False))[1].S_EnableSwitchOut
    assert not run(at(Step.STAGE_1), call(S1, Activate=False))[1].S_EnableSwitchOut


def test_stage_1_not_out_of_stage_0_is_an_error() -> None:
    for control in (Step.STAGE_2, Step.CHANGE_TO_STAGE_0):
        assert run(at(control), call(S1))[0].state == Step.PLAUSIBILITY_ERROR
    assert run(at(Step.SAFE_MODE), call(S1))[0].state == Step.OPERATION_ERROR


def test_the_mode_ends_errors_only_where_the_parameter_permits() -> None:
    off = call(S_SafetyActive=False)
    for control in Step:
        out = outputs(at(control))
        if out.Error:
            chosen = replace(PARAMS, MODE_ENDS_ERROR=True)
            assert run(at(control), off)[1].Error
            assert run(at(control, params=chosen), off)[0].state == Step.BASIC_MODE
            assert run(at(control, params=chosen), call())[1].Error


def test_a_reset_without_the_mode_waits_for_the_mode() -> None:
    after, out = run(at(Step.EQUIVALENCE_ERROR_AT_STAGE_0), call(S_SafetyActive=False, Reset=True))
    assert after.state == Step.BASIC_MODE and not out.Error


def test_a_reset_that_is_held_resets_nothing() -> None:
    held = [call(Reset=True)] * 3
    state, out = run(at(Step.EQUIVALENCE_ERROR, reset_before=True), *held)
    assert out.Error and out.DiagCode == 0xC021
    state, out = run(state, call(), call(Reset=True))
    assert not out.Error and state.state == Step.STAGE_0


def test_automatic_reset_waits_for_stage_0() -> None:
    for pattern in PATTERNS:
        calls = [call(pattern, S_AutoReset=True)] * 2
        assert run(at(Step.EQUIVALENCE_ERROR), *calls)[1].Error == (pattern != S0)


def test_wrong_values_are_refused() -> None:
    with pytest.raises(ParameterError, match="DiscrepancyTimeCh1_Ch3_ms"):
        Params(DiscrepancyTimeCh1_Ch3_ms=-1)
    with pytest.raises(ParameterError, match="DiscrepancyTimeCh1_Ch3_ms"):
        Params(DiscrepancyTimeCh1_Ch3_ms=3_600_001)
    with pytest.raises(ParameterError, match="MODE_ENDS_ERROR"):
        Params(MODE_ENDS_ERROR=1)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="Reset"):
        replace(call(), Reset=1)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="dt_ms"):
        call(dt_ms=-1)
    with pytest.raises(StateError, match="state"):
        step(replace(at(Step.IDLE), state="Nowhere"), call())  # type: ignore[arg-type]


@pytest.mark.parametrize("name", [one for one in Inputs.__dataclass_fields__ if one != "dt_ms"])
def test_every_input_is_a_boolean(name: str) -> None:
    with pytest.raises(InputError, match=name):
        replace(call(), **{name: 0})
