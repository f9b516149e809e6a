"""What the block answers to each pattern of the channels in each state, and that it enables again.

The table is PatternTable of EnableSwitchOpen.tla, written a second time from the findings.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

import z3

from proofs.enable_switch.devices import SWITCH
from proofs.enable_switch.vocabulary import (
    ERRORS,
    FAULTY,
    PATTERNS,
    RELEASED,
    RESET_ERRORS,
    STAGE_0,
    STAGE_1,
    STAGE_2,
    TIMED,
    Pattern,
    automatic,
    in_the_mode,
    shows,
)
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.sentences import Judge, Obligation
from proofs.theorem import Queries, theorem

ANYWHERE: Final = Judge(SWITCH, ())
"""No invariant: from any memory in its ranges."""


def _row(otherwise: str, **stages: str) -> dict[Pattern, str]:
    named = {"released": STAGE_0, "enabled": STAGE_1, "pressed": STAGE_2}
    return dict.fromkeys(PATTERNS, otherwise) | {named[name]: state for name, state in stages.items()}


def _table() -> Mapping[str, Mapping[Pattern, str]]:
    forward, back = TIMED
    error = "PlausibilityError"
    rows = {
        "Idle": _row("BasicMode"),
        "BasicMode": _row("SafeMode"),
        "SafeMode": _row("OperationError", released="Stage0"),
        "Stage0": _row(forward, released="Stage0", enabled="Stage1", pressed="Stage2"),
        forward: _row(forward, released="Stage0", enabled="Stage1", pressed="Stage2"),
        "Stage1": _row(back, released="Stage0", enabled="Stage1", pressed="Stage2"),
        back: _row(back, released="Stage0", enabled=error, pressed="Stage2"),
        "Stage2": _row(back, released="Stage0", enabled=error, pressed="Stage2"),
    }
    for cause, waits, static in zip(FAULTY, RELEASED, RESET_ERRORS, strict=True):
        rows |= {cause: _row(cause, released=waits), waits: _row(cause, released=waits), static: _row(waits)}
    return MappingProxyType(rows)


TABLE: Final = _table()


def in_time(scan: Scanned) -> z3.BoolRef:
    """No change is too late in this call."""
    if not scan.was(*TIMED):
        return TRUE
    spent: z3.ArithRef = scan.before.elapsed_ms + scan.inputs.dt_ms
    return spent < scan.params.DiscrepancyTimeCh1_Ch3_ms


def _plain(scan: Scanned) -> z3.BoolRef:
    i = scan.inputs
    return z3.And(in_the_mode(scan), in_time(scan), z3.Not(i.Reset), z3.Not(i.S_AutoReset))


def patterns_decide(scan: Scanned) -> Obligation:
    row, after = TABLE[control(scan.device, scan.before)], control(scan.device, scan.after)
    if after not in row.values():
        return TRUE, z3.Not(_plain(scan))
    return _plain(scan), z3.Or(*[shows(scan.inputs, one_of) for one_of in PATTERNS if row[one_of] == after])


@theorem(
    clauses=["ES-STAGE-0", "ES-STAGE-1", "ES-STAGE-2", "ES-SEQ-6", "ES-SEQ-7", "ES-SEQ-8", "ES-ORDER-2"],
    findings=["ESF-02", "ESF-03", "ESF-04", "ESF-05", "ESF-06"],
    properties=["PatternsDecide"],
    slow=True,
)
def each_pattern_in_each_state_has_its_answer() -> Queries:
    """From any memory: where the block is active in the mode, the time of a change is not over, and Reset and
    S_AutoReset are FALSE, each of the eight patterns leads from each of the 17 states to the one state that
    the table has for it.
    """
    yield from ANYWHERE.in_every_scan(patterns_decide)

    def whatever_the_time(scan: Scanned) -> Obligation:
        return in_the_mode(scan), TRUE if scan.becomes(*TABLE["ChangeToStage1"].values()) else FALSE

    yield ANYWHERE.too_strong("whatever the time is", whatever_the_time, "ChangeToStage1")


def ways_out(before: str, ends_errors: bool) -> set[str]:
    """The states to which a call may lead from this one; `ends_errors`: the parameter is set."""
    rows = {before, "Idle"} | set(TABLE[before].values())
    if before in TIMED:
        rows |= {"EquivalenceError", "PlausibilityError"}
    if before in RELEASED:
        rows |= {RESET_ERRORS[RELEASED.index(before)], "Stage0", "BasicMode"}
    in_operation = before not in ("Idle", *ERRORS)
    return rows | ({"BasicMode"} if in_operation or (ends_errors and before in ERRORS) else set())


def one_transition(scan: Scanned) -> Obligation:
    before, after = control(scan.device, scan.before), control(scan.device, scan.after)
    ends_errors = scan.params.MODE_ENDS_ERROR
    ways = [
        ends_errors if chosen else z3.Not(ends_errors)
        for chosen in (False, True)
        if after in ways_out(before, chosen)
    ]
    return TRUE, z3.Or(*ways)


@theorem(
    clauses=["ES-NOTE-1", "ES-ORDER-2", "ES-SEQ-2", "ES-SEQ-5"],
    findings=["ESF-02", "ESF-06", "ESF-08"],
    properties=["OneTransitionACall"],
    slow=True,
)
def a_call_leads_to_a_neighbour_or_stays() -> Queries:
    """From any memory and with any inputs, times and parameters, a call leads to one of the ways out that its
    state has: Idle, BasicMode, where the table of patterns leads, the error of a change that is too late, and
    out of a wait for a reset also the reset error or Stage0.
    """
    yield from ANYWHERE.in_every_scan(one_transition)

    def never_to_basic_mode(scan: Scanned) -> Obligation:
        return TRUE, FALSE if scan.becomes("BasicMode") else TRUE

    yield ANYWHERE.too_strong("an error is never left that way", never_to_basic_mode, "ResetError1")


def resets_lead_back(scan: Scanned) -> Obligation:
    """What a reset leads to, by state."""
    i = scan.inputs
    held = z3.And(i.Reset, scan.before.reset_before)
    edge = z3.And(i.Reset, z3.Not(scan.before.reset_before))
    resets = z3.And(i.Activate, shows(i, STAGE_0), z3.Or(edge, automatic(scan)))
    kept = z3.And(resets, z3.Implies(scan.params.MODE_ENDS_ERROR, i.S_SafetyActive))
    if not scan.was(*RELEASED):
        return None
    if scan.becomes("Stage0"):
        return TRUE, z3.And(resets, i.S_SafetyActive)
    if scan.becomes("BasicMode"):
        return kept, z3.Not(i.S_SafetyActive)
    static = RESET_ERRORS[RELEASED.index(control(scan.device, scan.before))]
    if scan.becomes(static):
        return TRUE, z3.And(held, z3.Not(automatic(scan)), shows(i, STAGE_0))
    return i.Activate, z3.Not(z3.And(kept))


@theorem(
    clauses=["ES-SEQ-5", "ES-RESTART"],
    findings=["ESF-06", "ESF-08", "ESF-10"],
    properties=["ResetEndsTheError"],
    slow=True,
)
def a_reset_at_stage_0_ends_the_error_in_that_call() -> Queries:
    """From any memory: where a reset is waited for, a call that sees stage 0 with a rising edge of Reset, or
    with S_AutoReset and AUTO_RESET_ERRORS, leads to Stage0 in the mode and to BasicMode without it; and to a
    reset error, which is that of its own error, leads only a Reset that is held.
    """
    yield from ANYWHERE.in_every_scan(resets_lead_back)

    def without_stage_0(scan: Scanned) -> Obligation:
        return z3.And(in_the_mode(scan), automatic(scan)), TRUE if scan.becomes("Stage0") else FALSE

    yield ANYWHERE.too_strong("at any stage", without_stage_0, "PlausibilityErrorAtStage0")


# ---------------------------------------------------------------- it enables again

RANK: Final = {"Idle": 3, "BasicMode": 2, "SafeMode": 1, "Stage0": 0}
"""How many calls with a released switch it takes to Stage0, or to where a reset is waited for."""


def rank(c: str) -> int:
    """At most this many calls; 2 from a change that may be too late, 1 from everywhere else."""
    return 0 if c in RELEASED else RANK.get(c, 2 if c in TIMED else 1)


def released(scan: Scanned) -> z3.BoolRef:
    """The block is active in the mode, the switch is released and Reset is FALSE."""
    i = scan.inputs
    return z3.And(in_the_mode(scan), shows(i, STAGE_0), z3.Not(i.Reset), z3.Not(i.S_AutoReset))


def comes_closer(scan: Scanned) -> Obligation:
    before, after = rank(control(scan.device, scan.before)), rank(control(scan.device, scan.after))
    remembered = z3.Not(scan.after.reset_before)
    return released(scan), z3.And(remembered, TRUE if after < before or after == before == 0 else FALSE)


def the_edge_resets(scan: Scanned) -> Obligation:
    if not scan.was(*RELEASED):
        return None
    i = scan.inputs
    given = z3.And(in_the_mode(scan), shows(i, STAGE_0), i.Reset, z3.Not(scan.before.reset_before))
    return given, TRUE if scan.becomes("Stage0") else FALSE


def stage_1_enables(scan: Scanned) -> Obligation:
    if not scan.was("Stage0", "ChangeToStage1"):
        return None
    given = z3.And(in_the_mode(scan), in_time(scan), shows(scan.inputs, STAGE_1))
    return given, scan.sends.S_EnableSwitchOut


@theorem(clauses=["ES-SEQ-2", "ES-SEQ-4", "ES-SEQ-5"], findings=["ESF-06", "ESF-10"], slow=True)
def a_released_switch_leads_to_stage_0_or_to_the_wait_for_a_reset() -> Queries:
    """From any memory, each call in the mode that sees stage 0 with Reset FALSE brings the block one state
    closer to Stage0, or to an error that waits for its reset: there after three calls at most, and it stays.
    """
    yield from ANYWHERE.in_every_scan(comes_closer)

    def one_call(scan: Scanned) -> Obligation:
        return released(scan), TRUE if rank(control(scan.device, scan.after)) == 0 else FALSE

    yield ANYWHERE.too_strong("one call is enough", one_call, "ChangeToStage0")


@theorem(clauses=["ES-SEQ-5", "ES-RESTART"], findings=["ESF-06"], slow=True)
def then_the_edge_of_reset_leads_to_stage_0() -> Queries:
    """From any memory: where a reset is waited for, the next call in the mode that sees stage 0 with Reset
    TRUE, which was FALSE before, leads to Stage0.
    """
    yield from ANYWHERE.in_every_scan(the_edge_resets)

    def any_reset(scan: Scanned) -> Obligation:
        said = the_edge_resets(scan)
        return None if said is None else (z3.And(in_the_mode(scan), scan.inputs.Reset), said[1])

    yield ANYWHERE.too_strong("any Reset", any_reset, "OperationErrorAtStage0")


@theorem(
    clauses=["ES-SEQ-6", "ES-SEQ-9", "ES-STAGE-1"],
    findings=["ESF-02"],
    properties=["EnablesAgain"],
    slow=True,
)
def then_stage_1_enables() -> Queries:
    """From any memory: out of Stage0, or out of a change from there that is not too late, a call in the mode
    that sees stage 1 enables.

    With the two theorems before it: from any state, at most three calls with the switch released, one with
    Reset where it is asked for, and one with stage 1.
    """
    yield from ANYWHERE.in_every_scan(stage_1_enables)

    def too_late_as_well(scan: Scanned) -> Obligation:
        return z3.And(in_the_mode(scan), shows(scan.inputs, STAGE_1)), scan.sends.S_EnableSwitchOut

    yield ANYWHERE.too_strong("too late as well", too_late_as_well, "ChangeToStage1")


def kept_in_error(scan: Scanned) -> Obligation:
    """An error without its parameter keeps to its own states."""
    if not scan.was(*ERRORS):
        return None
    number = {name: n for group in (FAULTY, RELEASED, RESET_ERRORS) for n, name in enumerate(group)}
    before, after = control(scan.device, scan.before), control(scan.device, scan.after)
    if after in number:
        return TRUE, TRUE if number[before] == number[after] else FALSE
    kept = z3.And(scan.inputs.Activate, z3.Not(scan.params.MODE_ENDS_ERROR))
    return kept, TRUE if before in RELEASED and scan.becomes("Stage0", "BasicMode") else FALSE


@theorem(clauses=["ES-SEQ-4", "ES-SEQ-5"], findings=["ESF-06", "ESF-08"], slow=True)
def an_error_stays_the_error_that_it_is() -> Queries:
    """From any memory: an error never turns into one of another kind, and, unless MODE_ENDS_ERROR is set, an
    active block leaves it for Stage0 or BasicMode, from where the reset is waited for.
    """
    yield from ANYWHERE.in_every_scan(kept_in_error)

    def whatever_the_parameter(scan: Scanned) -> Obligation:
        return scan.inputs.Activate, TRUE if scan.becomes(*ERRORS, "Stage0") else FALSE

    yield ANYWHERE.too_strong("whatever the parameter is", whatever_the_parameter, "ResetError3")


def parameter_ends_errors(scan: Scanned) -> Obligation:
    if not scan.was(*ERRORS):
        return None
    off = z3.And(scan.inputs.Activate, z3.Not(scan.inputs.S_SafetyActive), scan.params.MODE_ENDS_ERROR)
    return off, TRUE if scan.becomes("BasicMode") else FALSE


@theorem(clauses=["ES-RESTART"], findings=["ESF-08"], properties=["EndOfModeEndsErrors"], slow=True)
def the_parameter_lets_the_end_of_the_mode_end_every_error() -> Queries:
    """From any memory: with MODE_ENDS_ERROR set, a call of an active block without the mode leads from every
    error to BasicMode.
    """
    yield from ANYWHERE.in_every_scan(parameter_ends_errors)

    def without_it(scan: Scanned) -> Obligation:
        off = z3.And(scan.inputs.Activate, z3.Not(scan.inputs.S_SafetyActive))
        return off, TRUE if scan.becomes("BasicMode") else FALSE

    yield ANYWHERE.too_strong("also where it is not set", without_it, "ResetError1")
