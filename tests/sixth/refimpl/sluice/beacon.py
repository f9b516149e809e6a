"""The beacon: lit while it is called."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from refimpl.errors import StateError, check_bool, check_int

LAMP = 0xAAAA
"""The code of the lamp, which is our own choice."""


class Step(Enum):
    """What the beacon does. SL-1-2"""

    DARK = "Dark"
    LIT = "Lit"


@dataclass(frozen=True, slots=True)
class Params:
    """The beacon has no parameters."""


@dataclass(frozen=True, slots=True)
class State:
    """Memory between two scans."""

    params: Params
    state: Step


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one scan reads; dt_ms >= 0 is not used. Building it raises InputError."""

    dt_ms: int
    BeaconCall: bool

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_bool("BeaconCall", self.BeaconCall)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What one scan writes."""

    BeaconLit: bool
    LAMP_CODE: int


def power_up(params: Params) -> State:
    """Dark. SL-1-2"""
    return State(params, Step.DARK)


def outputs(s: State) -> Outputs:
    """What the state shows. SL-1-2"""
    return Outputs(s.state == Step.LIT, LAMP if s.state == Step.LIT else 0)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One scan. SL-1-2, SLF-02"""
    if state.state == Step.DARK:
        after = State(state.params, Step.LIT if inputs.BeaconCall else Step.DARK)  # LightUp, StayDark
    elif state.state == Step.LIT:
        after = State(state.params, Step.LIT if inputs.BeaconCall else Step.DARK)  # StayLit, GoDark
    else:
        raise StateError("state", state.state, "a Step of the beacon")
    return after, outputs(after)
