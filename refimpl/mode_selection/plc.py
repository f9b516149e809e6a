"""The PLC: it copies four words between the F-PLC and the panel, one a scan, and compares before each copy.

Covers steps 13, 16, 21, 26 of the insert flow and 7, 10, 15, 17 of the remove flow, and the PLC's rows of
Figures 3 and 9. The copy of MW01 makes ReadAuthorization the same word; the other copies are made only while
it still is (E-08). In the removal both are zero, so that one comparison serves both figures. If it fails, the
other routine begins, and that begins with the copy of MW01. The PLC is not safe (EKS-GP-2), so nothing rests
on this check. The order of the copies is that of the steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from refimpl.errors import StateError, check_int, check_word
from refimpl.mode_selection.code_tables import ZERO


class Step(Enum):
    """The copy that is executed next. EKS-GP-3"""

    COPY_READ_AUTHORIZATION = "CopyReadAuthorization"
    COPY_MW03 = "CopyMW03"
    COPY_CHECK_MSO = "CopyCheckMSO"
    COPY_MW07 = "CopyMW07"


@dataclass(frozen=True, slots=True)
class Params:
    """The PLC has no parameters."""


@dataclass(frozen=True, slots=True)
class State:
    """Memory of the PLC between two scans: whose turn it is, and the four words last written."""

    params: Params
    turn: Step
    ReadAuthorization: int
    MW03: int
    CheckMSO: int
    MW07: int


@dataclass(frozen=True, slots=True)
class Inputs:
    """What one scan reads; words 0..65535, dt_ms >= 0 (not used by the PLC). Building it raises InputError;

    nothing is coerced.
    """

    dt_ms: int
    MW01: int
    MW05: int
    SelectMSO: int
    SwitchMSO: int

    def __post_init__(self) -> None:
        check_int("dt_ms", self.dt_ms, 0, None)
        check_word("MW01", self.MW01)
        check_word("MW05", self.MW05)
        check_word("SelectMSO", self.SelectMSO)
        check_word("SwitchMSO", self.SwitchMSO)


@dataclass(frozen=True, slots=True)
class Outputs:
    """What one scan writes: two words to the panel, two flag words to the F-PLC."""

    ReadAuthorization: int
    CheckMSO: int
    MW03: int
    MW07: int


def power_up(params: Params) -> State:
    """The state after power-up: all words zero, the first copy is ReadAuthorization. EKS-KS-8, EKS-GP-3"""
    return State(params, Step.COPY_READ_AUTHORIZATION, ZERO, ZERO, ZERO, ZERO)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One scan: one copy, always; that of MW01 where ReadAuthorization is no longer MW01.

    EKS-GP-2, EKS-GP-3, EKS-GP-4, EKS-GP-5, EKS-3-1-PLC, EKS-3-2, EKS-3-3, EKS-3-4-PLC, EKS-9-1-PLC, EKS-9-2,
    EKS-9-3, EKS-9-4-PLC, E-08
    """
    if state.turn == Step.COPY_READ_AUTHORIZATION or state.ReadAuthorization != inputs.MW01:
        after = _copy_read_authorization(state, inputs)
    elif state.turn == Step.COPY_MW03:
        after = _copy_mw03(state, inputs)
    elif state.turn == Step.COPY_CHECK_MSO:
        after = _copy_check_mso(state, inputs)
    elif state.turn == Step.COPY_MW07:
        after = _copy_mw07(state, inputs)
    else:
        raise StateError("turn", state.turn, "a Step of the PLC")
    return after, outputs(after)


def outputs(s: State) -> Outputs:
    """The four words as last copied. EKS-2-13, EKS-2-16, EKS-2-21, EKS-2-26"""
    return Outputs(s.ReadAuthorization, s.CheckMSO, s.MW03, s.MW07)


def _copy_read_authorization(s: State, i: Inputs) -> State:
    """ReadAuthorization := MW01, unchanged; it is the authorization level, not the access code (E-06b).

    EKS-2-13, EKS-8-7

    No comparison stands in the way of this copy: it makes the two equal. E-08
    """
    return State(s.params, Step.COPY_MW03, i.MW01, s.MW03, s.CheckMSO, s.MW07)  # CopyReadAuthorization


def _copy_mw03(s: State, i: Inputs) -> State:
    """MW03 := SelectMSO, unchanged. EKS-2-16, EKS-8-10;

    that it is zero on removal is for the F-PLC to check (E-33).
    """
    return State(
        s.params, Step.COPY_CHECK_MSO, s.ReadAuthorization, i.SelectMSO, s.CheckMSO, s.MW07
    )  # CopyMW03


def _copy_check_mso(s: State, i: Inputs) -> State:
    """CheckMSO := MW05, unchanged. EKS-2-21, EKS-8-15"""
    return State(s.params, Step.COPY_MW07, s.ReadAuthorization, s.MW03, i.MW05, s.MW07)  # CopyCheckMSO


def _copy_mw07(s: State, i: Inputs) -> State:
    """MW07 := SwitchMSO, unchanged. EKS-2-26, EKS-8-17"""
    return State(
        s.params, Step.COPY_READ_AUTHORIZATION, s.ReadAuthorization, s.MW03, s.CheckMSO, i.SwitchMSO
    )  # CopyMW07
