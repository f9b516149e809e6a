"""External device monitoring as the signal sequence of the document walks it, and where it does not."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.ground.places import TREE
from modeproof.registers import load_interface
from refimpl.edm.sf_edm import ERRORS, Inputs, Outputs, Params, State, Step, outputs, power_up, step
from refimpl.errors import InputError, ParameterError, StateError

PARAMS = Params(MonitoringTime_ms=100)
CODES = {of: int(code, 16) for of, code in load_interface(TREE, "edm").devices["sf_edm"].codes.items()}
CAUTIOUS = replace(PARAMS, AFTER_RESET="stop_first")
DROPPED, PICKED = (True, True), (False, False)
FEEDBACKS = tuple(itertools.product((False, True), repeat=2))
BLAMED = {(False, True): 0, (True, False): 1, (False, False): 2}
"""Which error of a group is about contactors that show this and should have dropped out."""


def call(feedback: tuple[bool, bool] = DROPPED, dt_ms: int = 10, **other: bool) -> Inputs:
    given = {"Activate": True, "S_OutControl": False, "S_StartReset": False, "Reset": False, **other}
    return Inputs(dt_ms=dt_ms, S_EDM1=feedback[0], S_EDM2=feedback[1], **given)


def on(feedback: tuple[bool, bool] = DROPPED, dt_ms: int = 10, **other: bool) -> Inputs:
    return call(feedback, dt_ms, S_OutControl=True, **other)


def run(state: State, *calls: Inputs) -> tuple[State, Outputs]:
    after, out = state, outputs(state)
    for one in calls:
        after, out = step(after, one)
    return after, out


def at(control: Step, **other: Any) -> State:
    return replace(State(PARAMS, control, False, False, False, 0), **other)


def disabled(stop_seen: bool = True, elapsed_ms: int = 0, params: Params = PARAMS) -> State:
    return at(Step.OUTPUT_DISABLE, stop_seen=stop_seen, elapsed_ms=elapsed_ms, params=params)


def enabled(elapsed_ms: int = 0, params: Params = PARAMS) -> State:
    return at(Step.OUTPUT_ENABLE, out_control_before=True, elapsed_ms=elapsed_ms, params=params)


@pytest.mark.parametrize(
    ("params", "control"),
    [(PARAMS, "taken back"), (CAUTIOUS, "taken back"), (CAUTIOUS, "still there")],
)
def test_the_signal_sequence_of_the_document(params: Params, control: str) -> None:
    state, out = run(power_up(params), call(Activate=False))  # 0
    assert not any((out.Ready, out.S_EDM_Out, out.SafetyDemand, out.ResetRequest, out.Error, out.DiagCode))
    state, out = run(state, call(), call(dt_ms=500))  # 1: the inhibit
    assert (out.Ready, out.ResetRequest, out.S_EDM_Out) == (True, True, False)
    state, out = run(state, call(Reset=True), call(dt_ms=99), call(dt_ms=1), call(dt_ms=900))  # 2
    assert (out.SafetyDemand, out.Error, out.S_EDM_Out) == (True, False, False)
    state, out = run(state, on())  # 3
    assert out.S_EDM_Out and not out.Error
    state, out = run(state, on(dt_ms=99), on(PICKED, dt_ms=1), on(PICKED, dt_ms=900))
    assert out.S_EDM_Out and not out.Error
    state, out = run(state, call(PICKED))  # 4
    assert not out.S_EDM_Out and not out.Error
    state, out = run(state, call(PICKED, dt_ms=99), call(DROPPED, dt_ms=1), call(dt_ms=900))
    assert not out.Error
    state, out = run(state, on(), on(dt_ms=99))  # 5
    assert out.S_EDM_Out and not out.Error
    state, out = run(state, on(dt_ms=1))
    assert (out.Error, out.S_EDM_Out, out.ResetRequest, out.DiagCode) == (True, False, True, 0xC090)
    after = on if control == "still there" else call
    state, out = run(state, after(), after(Reset=True))  # 6
    assert (out.Error, out.S_EDM_Out) == (False, False)
    state, out = run(state, after(dt_ms=99), after(dt_ms=1), after(dt_ms=900))
    assert (state.state, out.Error, out.S_EDM_Out) == (Step.OUTPUT_DISABLE, False, False)


def test_reset_with_a_standing_request_starts_only_where_chosen() -> None:
    for params, starts in ((PARAMS, True), (CAUTIOUS, False)):
        for before in (Step.EDM_ERROR_33, Step.INIT):
            state = at(before, params=params, out_control_before=True)
            state, out = run(state, on(Reset=True))
            assert (state.state, out.S_EDM_Out) == (Step.OUTPUT_DISABLE, False)
            state, out = run(state, on(), on())
            assert out.S_EDM_Out == starts
            assert run(state, call(PICKED if starts else DROPPED), call(), on())[1].S_EDM_Out


def test_without_inhibit_a_standing_request_switches_on_by_itself() -> None:
    state, out = run(power_up(PARAMS), *[on(S_StartReset=True)] * 2)
    assert (state.state, out.S_EDM_Out) == (Step.OUTPUT_DISABLE, False)
    assert run(state, on(S_StartReset=True))[1].S_EDM_Out


@pytest.mark.parametrize("feedback", FEEDBACKS)
def test_at_switching_on_both_contactors_are_dropped_out(feedback: tuple[bool, bool]) -> None:
    state, out = run(disabled(), on(feedback))
    if feedback == DROPPED:
        assert out.S_EDM_Out
    else:
        assert (state.state, out.S_EDM_Out) == (ERRORS[BLAMED[feedback]][0], False)


@pytest.mark.parametrize("feedback", FEEDBACKS)
@pytest.mark.parametrize("elapsed_ms", [0, 99, 100])
@pytest.mark.parametrize("make", [call, on])
def test_a_contactor_has_only_monitoring_time_to_drop_out(
    feedback: tuple[bool, bool], elapsed_ms: int, make: Any
) -> None:
    state, out = run(disabled(False, elapsed_ms), make(feedback, dt_ms=1))
    if feedback == DROPPED or elapsed_ms == 0:
        assert (state.state, out.Error) == (Step.OUTPUT_DISABLE, False)
    else:
        assert (state.state, out.S_EDM_Out) == (ERRORS[3 + BLAMED[feedback]][0], False)


@pytest.mark.parametrize("feedback", FEEDBACKS)
@pytest.mark.parametrize("elapsed_ms", [0, 99, 100])
@pytest.mark.parametrize("make", [call, on])
def test_a_contactor_has_only_monitoring_time_to_pick_up(
    feedback: tuple[bool, bool], elapsed_ms: int, make: Any
) -> None:
    """A stop does not hide that it came too late."""
    state, out = run(enabled(elapsed_ms), make(feedback, dt_ms=1))
    if feedback == PICKED or elapsed_ms == 0:
        assert (out.S_EDM_Out, out.Error) == (make is on, False)
    else:
        wrong = (not feedback[0], not feedback[1])
        assert (state.state, out.S_EDM_Out) == (ERRORS[6 + BLAMED[wrong]][0], False)


def test_a_monitoring_time_that_is_not_set_leaves_no_time() -> None:
    unset = Params()
    assert run(enabled(params=unset), on(dt_ms=0))[1].Error
    assert run(disabled(params=unset), call(PICKED, dt_ms=0))[1].Error
    assert not run(enabled(params=unset), on(PICKED, dt_ms=0))[1].Error


@pytest.mark.parametrize("error", ERRORS, ids=lambda one: one[0].value)
def test_a_fresh_edge_resets_an_error_whose_cause_is_gone(error: Any) -> None:
    name, code, held, held_code = error
    for feedback in FEEDBACKS[:-1]:
        state, out = run(at(name), call(feedback, Reset=True))
        assert (state.state, out.DiagCode, out.ResetRequest) == (name, code, True)
        state, out = run(state, call(Reset=True), call(Reset=True))
        assert (state.state, out.DiagCode, out.ResetRequest) == (held, held_code, False)
        state, out = run(state, call(Reset=False))
        assert (state.state, out.Error) == (name, True)
        assert run(state, call(Reset=True))[1] == outputs(disabled())
    assert run(at(name), call(Activate=False))[1] == outputs(power_up(PARAMS))


def test_reset_held_while_the_block_starts_removes_no_inhibit() -> None:
    state, out = run(power_up(PARAMS), call(Activate=False, Reset=True), call(Reset=True), call(Reset=True))
    assert (state.state, out.Error, out.ResetRequest) == (Step.RESET_ERROR_1, True, False)
    state, out = run(state, call(), call(Reset=True))
    assert (state.state, out.SafetyDemand) == (Step.OUTPUT_DISABLE, True)
    assert run(power_up(PARAMS), call(Reset=True), call(Reset=True))[0].state == Step.RESET_ERROR_1


def test_reset_and_request_that_rise_together_remove_no_inhibit() -> None:
    state, out = run(at(Step.INIT), on(Reset=True))
    assert (state.state, out.Error, out.DiagCode) == (Step.INIT_ERROR, True, CODES["InitError"])
    assert run(state, on(Reset=True))[0].state == Step.INIT_ERROR
    assert run(state, on())[0].state == Step.INIT
    assert run(at(Step.INIT), on(Reset=True, S_StartReset=True))[0].state == Step.OUTPUT_DISABLE


@given(
    st.sampled_from(list(Step)),
    st.tuples(*[st.booleans()] * 6),
    st.tuples(*[st.booleans()] * 3),
    st.integers(0, 300),
    st.integers(0, 300),
)
def test_the_output_is_never_on_without_activation_request_and_peace(
    control: Step, inputs: tuple[bool, ...], memory: tuple[bool, ...], dt_ms: int, elapsed_ms: int
) -> None:
    state = State(PARAMS, control, *memory, elapsed_ms)
    after, out = step(state, Inputs(dt_ms, *inputs))
    if out.S_EDM_Out:
        assert out.Ready and inputs[0] and inputs[1]
        assert not (out.Error or out.ResetRequest or out.SafetyDemand)
    assert out.Ready == inputs[0]
    assert out == outputs(after)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        *[("MonitoringTime_ms", value) for value in (-1, 3_600_001, True, "100")],
        *[("AFTER_RESET", value) for value in ("later", None, "")],
    ],
)
def test_parameters_out_of_range_are_refused_by_name(field: str, value: object) -> None:
    with pytest.raises(ParameterError, match=field):
        Params(**{field: value})  # type: ignore[arg-type]


@pytest.mark.parametrize("field", ["dt_ms", "Activate", "S_OutControl", "S_EDM1", "S_EDM2", "Reset"])
def test_inputs_of_another_type_are_refused_by_name(field: str) -> None:
    with pytest.raises(InputError, match=field):
        replace(call(), **{field: "1"})  # type: ignore[arg-type]


def test_a_state_that_is_none_is_refused() -> None:
    broken = replace(disabled(), state="OutputDisable")  # type: ignore[arg-type]
    with pytest.raises(StateError, match="state"):
        step(broken, call())
    with pytest.raises(StateError, match="state"):
        outputs(broken)
