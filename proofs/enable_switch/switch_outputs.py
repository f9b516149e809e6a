"""The row of outputs of every state, and what the rows have in common.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in EnableSwitchOpen.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import Any, Final

import z3

from proofs.enable_switch.invariants import JUDGE
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.sentences import Sentence
from proofs.theorem import Queries, theorem

ROWS: Final = MappingProxyType(
    {
        "Idle": (0x0000, ""),
        "BasicMode": (0x8002, "Ready"),
        "SafeMode": (0x8004, "Ready"),
        "Stage0": (0x8802, "Ready SafetyDemand"),
        "ChangeToStage1": (0x8812, "Ready SafetyDemand"),
        "Stage1": (0x8000, "Ready S_EnableSwitchOut"),
        "ChangeToStage0": (0x8822, "Ready SafetyDemand"),
        "Stage2": (0x8832, "Ready SafetyDemand"),
        "OperationError": (0xC020, "Ready Error"),
        "OperationErrorAtStage0": (0xC420, "Ready Error ResetRequest"),
        "PlausibilityError": (0xC030, "Ready Error"),
        "PlausibilityErrorAtStage0": (0xC440, "Ready Error ResetRequest"),
        "EquivalenceError": (0xC050, "Ready Error"),
        "EquivalenceErrorAtStage0": (0xC450, "Ready Error ResetRequest"),
        "ResetError1": (0xC001, "Ready Error"),
        "ResetError2": (0xC011, "Ready Error"),
        "ResetError3": (0xC021, "Ready Error"),
    }
)
"""The code of each state, and the outputs that are TRUE in it."""
FLAGS: Final = ("Ready", "S_EnableSwitchOut", "SafetyDemand", "ResetRequest", "Error")


def row_of_the_state(scan: Scanned, seen: Any) -> z3.BoolRef:
    code, on = ROWS[control(scan.device, scan.after)]
    flags = [getattr(scan.sends, name) == z3.BoolVal(name in on.split()) for name in FLAGS]
    return z3.And(scan.sends.DiagCode == code, *flags)


@theorem(
    clauses=["ES-SEQ-0", "ES-SEQ-1", "ES-SEQ-3", "ES-SEQ-4", "ES-SEQ-6", "ES-SEQ-7", "ES-NOTE-3"],
    findings=["ESF-01"],
    properties=["EveryStateHasItsRow"],
)
def every_state_has_its_row_of_outputs() -> Queries:
    """Before the first call and after every call the outputs are the row of the state that the call led to:
    17 states, 17 codes.
    """
    yield from JUDGE.after_every_scan(row_of_the_state)
    yield JUDGE.too_strong("no row has a code", lambda scan: (TRUE, scan.sends.DiagCode == 0), "Stage0")


def outputs_follow_the_code(scan: Scanned, seen: Any) -> z3.BoolRef:
    o = scan.sends

    def bit(number: int) -> z3.BoolRef:
        return z3.Extract(number, number, o.DiagCode) == 1

    return z3.And(
        o.Ready == bit(15),
        o.Error == bit(14),
        o.SafetyDemand == bit(11),
        o.ResetRequest == bit(10),
        o.S_EnableSwitchOut == (o.DiagCode == 0x8000),
    )


@theorem(clauses=["ES-NOTE-3"], findings=["ESF-01"], properties=["OutputsFollowTheCode"], slow=True)
def the_code_says_what_the_flags_say() -> Queries:
    """Before the first call and after every call the bits 8000, 4000, 0800 and 0400 of DiagCode are Ready,
    Error, SafetyDemand and ResetRequest, and S_EnableSwitchOut is TRUE exactly with 8000.
    """
    yield from JUDGE.after_every_scan(outputs_follow_the_code)
    never: Sentence = lambda scan: (TRUE, z3.Not(scan.sends.S_EnableSwitchOut))  # noqa: E731
    yield JUDGE.too_strong("8000 never comes", never, "Stage0")


def enable_stands_alone(scan: Scanned, seen: Any) -> z3.BoolRef:
    o = scan.sends
    alone = z3.And(o.Ready, z3.Not(o.Error), z3.Not(o.ResetRequest), z3.Not(o.SafetyDemand))
    return z3.Implies(o.S_EnableSwitchOut, alone)


@theorem(clauses=["ES-SEQ-3", "ES-SEQ-4"], findings=["ESF-01"], properties=["EnableStandsAlone"], slow=True)
def the_switch_never_enables_beside_an_error_or_a_pending_reset() -> Queries:
    """Before the first call and after every call: with S_EnableSwitchOut TRUE, Ready is TRUE, and Error,
    ResetRequest and SafetyDemand are FALSE.
    """
    yield from JUDGE.after_every_scan(enable_stands_alone)
    demand: Sentence = lambda scan: (TRUE, z3.Not(scan.sends.SafetyDemand))  # noqa: E731
    yield JUDGE.too_strong("SafetyDemand never comes", demand, "Stage1")


def idle_is_silent(scan: Scanned, seen: Any) -> z3.BoolRef:
    if not scan.becomes("Idle"):
        return TRUE
    return z3.And(scan.sends.DiagCode == 0, *[z3.Not(getattr(scan.sends, name)) for name in FLAGS])


@theorem(clauses=["ES-SEQ-0"], findings=[], properties=["IdleIsSilent"], slow=True)
def the_switch_that_is_not_active_sends_nothing() -> Queries:
    """Before the first call, and after every call that leads to Idle, all outputs are FALSE and DiagCode is
    0000.
    """
    yield from JUDGE.after_every_scan(idle_is_silent)
    silent: Sentence = lambda scan: (TRUE, z3.Not(scan.sends.Ready))  # noqa: E731
    yield JUDGE.too_strong("and after any other", silent, "Idle")


def in_idle(scan: Scanned, seen: Any) -> z3.BoolRef:
    nothing = z3.And(scan.after.elapsed_ms == 0, z3.Not(scan.after.reset_before), z3.Not(scan.sends.Ready))
    return nothing if scan.becomes("Idle") else FALSE


@theorem(clauses=["ES-SEQ-0"], findings=[], properties=["PowerUpIsSilent"], slow=True)
def the_switch_begins_in_idle() -> Queries:
    """Before the first call, with any parameters, the block is in Idle, no time has passed and no Reset was
    seen.
    """
    yield from JUDGE.at_power_up(in_idle)
    yield JUDGE.too_strong("and after every call", JUDGE.after_a_scan(in_idle), "Idle")
