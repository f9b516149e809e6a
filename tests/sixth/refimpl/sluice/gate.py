"""The gate: calls the beacon, opens over it, and shuts after T_OPEN_ms."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from refimpl.errors import ParameterError, StateError, check_bool, check_int


class Step(Enum):
    """What the gate does. SL-1-1, SL-1-3, SL-1-4"""

    SHUT = "Shut"
    CALLING = "Calling"
    OPEN = "Open"


@dataclass(frozen=True, slots=True)
class Params:
    """T_OPEN_ms: how long the gate is open, 1..60000. Building it raises ParameterError. SL-1-4"""

    T_OPEN_ms: int = 1000

    def __post_init__(self) -> None:
        check_int("T_OPEN_ms", self.T_OPEN_ms, 1, 60_000, ParameterError)


@dataclass(frozen=True, slots=True)
class State:
    """Memory between two scans; elapsed_ms since the gate opened."""

    params: Params
    state: Step
    elapsed_ms: int


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one scan reads; dt_ms >= 0. Building it raises InputError."""

    dt_ms: int
    OpenRequest: bool
    BeaconLit: bool

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_bool("OpenRequest", self.OpenRequest)
        check_bool("BeaconLit", self.BeaconLit)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What one scan writes."""

    BeaconCall: bool
    GateMotor: bool


def power_up(params: Params) -> State:
    """Shut. SL-1-1"""
    return State(params, Step.SHUT, 0)


def outputs(s: State) -> Outputs:
    """What the state shows. SL-1-1, SL-1-3"""
    return Outputs(s.state != Step.SHUT, s.state == Step.OPEN)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One scan. SL-1-1, SL-1-3, SL-1-4"""
    if state.state == Step.SHUT:
        after = _shut(state, inputs)
    elif state.state == Step.CALLING:
        after = _calling(state, inputs)
    elif state.state == Step.OPEN:
        after = _open(state, inputs)
    else:
        raise StateError("state", state.state, "a Step of the gate")
    return after, outputs(after)


def _shut(s: State, i: Inputs) -> State:
    """A request calls the beacon. SL-1-1"""
    if i.OpenRequest:
        return State(s.params, Step.CALLING, 0)  # CallBeacon
    return s  # StayShut


def _calling(s: State, i: Inputs) -> State:
    """The gate waits for the beacon. SL-1-3, SLF-01"""
    if i.BeaconLit:
        return State(s.params, Step.OPEN, 0)  # OpenGate
    return s  # AwaitBeacon


def _open(s: State, i: Inputs) -> State:
    """The time is judged in the scan that completes it. SL-1-4"""
    elapsed = s.elapsed_ms + i.dt_ms
    if elapsed >= s.params.T_OPEN_ms:
        return State(s.params, Step.SHUT, 0)  # ShutGate
    return State(s.params, Step.OPEN, elapsed)  # StayOpen
