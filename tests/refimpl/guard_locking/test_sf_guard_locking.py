"""The guard locking as the signal sequence of the document walks it, and where it does not."""

from __future__ import annotations

import itertools
from dataclasses import fields, replace

import pytest

from refimpl.errors import InputError, ParameterError, StateError
from refimpl.guard_locking.sf_guard_locking import (
    Inputs,
    Outputs,
    Params,
    State,
    Step,
    outputs,
    power_up,
    step,
)

FLAGS = ("Activate", "S_GuardMonitoring", "S_SafetyActive", "S_GuardLock", "UnlockRequest", "S_StartReset")
PARAMS = Params()
CAUTIOUS = Params(UNLOCK_ON="edge", UNLOCK_ENDS="when_closed")
FAMILY = replace(
    CAUTIOUS,
    ZONE_LOST="tolerated",
    START_UP_INHIBIT="until_opened",
    CAUSE_OF_LOSS="zone",
    MESSAGE_OF_LOSS="until_safe",
)
EVERY = tuple(
    Params(*one)
    for one in itertools.product(
        ("edge", "latched", "level"),
        ("with_request", "when_closed"),
        ("error", "tolerated"),
        ("until_reset", "until_opened"),
        ("what_was_lost", "guard_and_zone", "zone"),
        ("until_reset", "until_safe"),
    )
)


def call(**other: bool) -> Inputs:
    """Active, closed and locked, the zone safe, no request, both inhibits, no Reset; and what is named."""
    given = dict.fromkeys((one.name for one in fields(Inputs) if one.name != "dt_ms"), False)
    given |= {"Activate": True, "S_GuardMonitoring": True, "S_SafetyActive": True, "S_GuardLock": True}
    return Inputs(dt_ms=10, **{**given, **other})


def run(state: State, *calls: Inputs) -> tuple[State, Outputs]:
    after, out = state, outputs(state)
    for one in calls:
        after, out = step(after, one)
    return after, out


def at(control: Step, params: Params = PARAMS, **memory: bool) -> State:
    return replace(State(params, control, False, False, False, False, False), **memory)


def enabled(params: Params = PARAMS) -> State:
    state, out = run(power_up(params), call(), call(Reset=True), call())
    assert out.S_GuardLocked
    return state


OPEN = {"S_GuardMonitoring": False, "S_GuardLock": False}


@pytest.mark.parametrize("params", [PARAMS, CAUTIOUS])
def test_the_signal_sequence_of_the_document(params: Params) -> None:
    state, out = run(power_up(params), call(Activate=False))  # 0
    assert not any((out.Ready, out.S_GuardLocked, out.S_UnlockGuard, out.Error, out.DiagCode))
    state, out = run(state, call(), call())  # 1
    assert out.Ready and not out.S_GuardLocked and not out.S_UnlockGuard and not out.Error
    state, out = run(state, call(Reset=True))  # 2
    assert out.S_GuardLocked and not out.S_UnlockGuard
    state, out = run(state, call(S_SafetyActive=False), call(S_SafetyActive=False))
    assert out.S_GuardLocked
    early = [] if params == CAUTIOUS else [call(S_SafetyActive=False, UnlockRequest=True)]
    state, out = run(state, *early)  # 3: the request, and then the zone that is safe again
    assert out.S_GuardLocked and not out.S_UnlockGuard
    state, out = run(state, call(UnlockRequest=True))
    assert out.S_UnlockGuard and not out.S_GuardLocked and not out.Error
    state, out = run(state, call(UnlockRequest=True, **OPEN))  # 4
    assert out.S_UnlockGuard and not out.S_GuardLocked
    state, out = run(state, call(UnlockRequest=True, S_GuardLock=False))
    assert out.S_UnlockGuard and not out.S_GuardLocked
    state, out = run(state, call(S_GuardLock=False))  # 5
    assert not out.S_UnlockGuard and not out.S_GuardLocked and not out.Error


def test_the_enable_waits_for_the_locked_guard_and_reset() -> None:
    state = at(Step.WAIT_FOR_OPERATOR)
    state, out = run(state, call(S_GuardLock=False), call())
    assert out.DiagCode == 0x8003 and not out.S_GuardLocked
    assert run(state, call(), call(Reset=True))[1].S_GuardLocked
    assert run(state, call(S_AutoReset=True))[1].S_GuardLocked


def test_an_early_request_does_what_unlock_on_says() -> None:
    early = (call(S_SafetyActive=False, UnlockRequest=True), call(UnlockRequest=True))
    seen = {one: run(enabled(Params(UNLOCK_ON=one)), *early)[1] for one in ("edge", "latched", "level")}
    assert {one: out.S_UnlockGuard for one, out in seen.items()} == {
        "edge": False,
        "latched": True,
        "level": True,
    }


def test_a_request_before_the_enable_unlocks_only_by_level() -> None:
    for one in ("edge", "latched", "level"):
        state = at(Step.GUARD_CLOSED_AND_LOCKED, Params(UNLOCK_ON=one), unlock_request_before=True)
        assert run(state, call(UnlockRequest=True))[1].S_UnlockGuard == (one == "level")


def test_a_latched_request_is_forgotten_when_it_ends() -> None:
    state = enabled(Params(UNLOCK_ON="latched"))
    state, _ = run(state, call(S_SafetyActive=False, UnlockRequest=True), call(S_SafetyActive=False))
    assert not state.request_pending and run(state, call())[1].S_GuardLocked


@pytest.mark.parametrize("guard_open", [False, True])
def test_the_zone_that_is_lost_at_an_unlocked_guard(guard_open: bool) -> None:
    control = Step.GUARD_OPEN_AND_UNLOCKED if guard_open else Step.GUARD_CLOSED_BUT_UNLOCKED
    lost = call(S_SafetyActive=False, UnlockRequest=True, S_GuardMonitoring=not guard_open)
    assert run(at(control), lost)[1].Error
    assert run(at(control, FAMILY), lost)[1].Error == guard_open


def test_a_start_up_inhibit_is_not_walked_round() -> None:
    """Open at start-up, closed and locked later, and no restart inhibit."""
    way = (
        call(),
        call(**OPEN),
        call(**OPEN),
        call(S_GuardLock=False),
        call(S_GuardLock=False),
        call(S_AutoReset=True),
        call(S_AutoReset=True),
    )
    state, out = run(power_up(PARAMS), *way)
    assert not out.S_GuardLocked and state.start_up_inhibit
    assert run(state, call(S_AutoReset=True, Reset=True))[1].S_GuardLocked
    assert run(power_up(FAMILY), *way)[1].S_GuardLocked
    free = (way[0], call(S_StartReset=True, **OPEN), *way[2:])
    assert run(power_up(PARAMS), *free)[1].S_GuardLocked


def test_a_lost_guard_needs_reset_even_with_s_auto_reset() -> None:
    state, out = run(enabled(), call(S_GuardMonitoring=False, S_AutoReset=True))
    assert out.Error and out.DiagCode == 0xC004
    state, out = run(state, *[call(S_AutoReset=True)] * 5)
    assert out.DiagCode == 0x8014 and out.Error, "the message stays until Reset"
    state, out = run(state, call(S_AutoReset=True, Reset=True), *[call(S_AutoReset=True)] * 2)
    assert out.S_GuardLocked


def test_a_loss_is_acknowledged_only_behind_the_guard() -> None:
    """Forced open, Reset with the door open, and no restart inhibit."""
    free = {"S_AutoReset": True}
    way = (
        call(**OPEN, **free),
        call(**OPEN, **free),
        call(**OPEN, **free, Reset=True),
        call(**OPEN, **free),
        *[call(**free)] * 5,
    )
    state, out = run(enabled(), *way)
    assert not out.S_GuardLocked and out.DiagCode == 0x8014
    assert run(state, call(**free, Reset=True), call(**free), call(**free))[1].S_GuardLocked
    assert run(enabled(FAMILY), *way)[1].S_GuardLocked


@pytest.mark.parametrize(
    ("params", "open_is_enough"), [(PARAMS, True), (replace(PARAMS, CAUSE_OF_LOSS="guard_and_zone"), False)]
)
def test_a_loss_of_the_zone_is_reset_behind_no_guard(params: Params, open_is_enough: bool) -> None:
    """A standstill glitch behind the open door, the request held; Reset with the door open."""
    held = {"UnlockRequest": True, **OPEN}
    state = at(Step.GUARD_OPEN_AND_UNLOCKED, params, unlock_request_before=True)
    state, out = run(state, call(S_SafetyActive=False, **held), call(**held))
    assert out.Error and not out.S_UnlockGuard
    state, out = run(state, call(Reset=True, **held), call(**held))
    assert (out.Error, out.S_UnlockGuard) == (not open_is_enough, open_is_enough)


@pytest.mark.parametrize("params", [PARAMS, CAUTIOUS])
@pytest.mark.parametrize("auto", [False, True])
def test_a_request_over_the_reset_unlocks_a_locked_guard(params: Params, auto: bool) -> None:
    """GLF-14: a standstill glitch locks a person in; who asks only after the Reset must enable first."""
    unlocked = at(Step.GUARD_CLOSED_BUT_UNLOCKED, params, unlock_request_before=True)
    lost, out = run(unlocked, call(S_SafetyActive=False, S_GuardLock=False), call())
    assert out.Error and not out.S_UnlockGuard
    asks = {"UnlockRequest": True, "S_AutoReset": auto}
    _, out = run(lost, call(**asks), call(Reset=True, **asks), call(**asks))
    assert out.S_UnlockGuard and not out.S_GuardLocked
    state, _ = run(lost, call(Reset=True, S_AutoReset=auto), call(S_AutoReset=auto), call(**asks))
    assert state.state == (Step.GUARD_CLOSED_AND_LOCKED if auto else Step.WAIT_FOR_RESET)


def test_the_unlock_signal_ends_with_the_request_by_the_letter() -> None:
    for control in (Step.GUARD_OPEN_AND_UNLOCKED, Step.GUARD_CLOSED_BUT_UNLOCKED):
        for params, stays in ((PARAMS, False), (CAUTIOUS, True)):
            state, out = run(at(control, params, unlock_request_before=True), call(**OPEN))
            assert out.S_UnlockGuard == stays
            assert run(state, call(UnlockRequest=True, **OPEN))[1].S_UnlockGuard


@pytest.mark.parametrize(
    ("control", "error"),
    [
        (Step.INIT, Step.RESET_ERROR1),
        (Step.SAFETY_RETURN, Step.RESET_ERROR2),
        (Step.WAIT_FOR_RESET, Step.RESET_ERROR3),
    ],
)
def test_a_static_reset_is_an_error_until_its_release(control: Step, error: Step) -> None:
    state, out = run(at(control, reset_before=True), call(Reset=True))
    assert state.state == error and out.Error
    assert run(state, call(Reset=True))[0].state == error
    assert run(state, call())[0].state == control


def test_a_reset_held_while_activate_comes_is_no_edge() -> None:
    _, out = run(power_up(PARAMS), call(Reset=True), call(Reset=True))
    assert out.Error and not out.S_GuardLocked


@pytest.mark.parametrize("params", EVERY)
def test_every_call_without_activate_ends_idle(params: Params) -> None:
    for control in Step:
        state, out = step(at(control, params, start_up_inhibit=True), call(Activate=False, Reset=True))
        assert state == State(params, Step.IDLE, True, False, False, False, False)
        assert out == Outputs(False, False, False, False, 0)


@pytest.mark.parametrize("params", EVERY)
def test_a_call_that_loses_the_guard_never_enables(params: Params) -> None:
    for control, request, reset in itertools.product(Step, (False, True), (False, True)):
        for lost in (OPEN, {"S_GuardLock": False}, {"S_GuardMonitoring": False}):
            inputs = call(UnlockRequest=request, Reset=reset, S_AutoReset=True, S_StartReset=True, **lost)
            assert not step(at(control, params), inputs)[1].S_GuardLocked


def test_what_is_no_input_is_refused() -> None:
    for name in FLAGS:
        with pytest.raises(InputError) as refused:
            call(**{name: 1})  # type: ignore[arg-type]
        assert refused.value.field == name
    with pytest.raises(InputError):
        replace(call(), dt_ms=-1)


@pytest.mark.parametrize("name", [one.name for one in fields(Params)])
def test_what_is_no_parameter_is_refused(name: str) -> None:
    with pytest.raises(ParameterError) as refused:
        Params(**{name: "never"})
    assert refused.value.field == name


def test_what_is_no_state_is_refused() -> None:
    with pytest.raises(StateError):
        step(replace(at(Step.INIT), state="Init"), call())  # type: ignore[arg-type]
