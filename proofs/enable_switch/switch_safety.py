"""What the block promises whatever stands on its inputs and however late it is called.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in EnableSwitchOpen
and EnableSwitchOrder.
"""

from __future__ import annotations

import z3

from proofs.enable_switch.invariants import JUDGE
from proofs.enable_switch.observer import SEEN, sees
from proofs.enable_switch.vocabulary import (
    ERRORS,
    NONE,
    RELEASED,
    RESET_ERRORS,
    STAGE_0,
    STAGE_1,
    TIMED,
    automatic,
    in_the_mode,
    shows,
)
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem


@theorem(clauses=["ES-SEQ-3", "ES-SEQ-5", "ES-ORDER-2"], findings=["ESF-02", "ESF-04", "ESF-05"], slow=True)
def every_call_of_the_switch_keeps_its_invariant() -> Queries:
    """The invariant of the block is true before the first call, and every call keeps it, with any inputs, any
    time and any parameters.
    """
    yield from JUDGE.initiation()
    yield from JUDGE.consecution()


# ---------------------------------------------------------------- the enable


def enable_needs_its_conditions(scan: Scanned) -> Obligation:
    if not scan.becomes("Stage1"):
        return TRUE, z3.Not(scan.sends.S_EnableSwitchOut)
    return scan.sends.S_EnableSwitchOut, z3.And(in_the_mode(scan), shows(scan.inputs, STAGE_1))


@theorem(
    clauses=["ES-STAGE-1", "ES-SEQ-1", "ES-SEQ-7"],
    findings=["ESF-04", "ESF-05", "ESF-08"],
    properties=["EnableNeedsItsConditions"],
    slow=True,
)
def the_switch_enables_only_in_a_call_that_sees_stage_1_in_the_mode() -> Queries:
    """After a call with S_EnableSwitchOut TRUE, that very call found Activate and S_SafetyActive TRUE,
    channels 1 and 3 TRUE and channel 2 FALSE.

    So the enable drops in the call that finds anything else, also within the discrepancy time.
    """
    yield from JUDGE.in_every_scan(enable_needs_its_conditions)

    def whenever_it_sees_that(scan: Scanned) -> Obligation:
        return z3.And(in_the_mode(scan), shows(scan.inputs, STAGE_1)), scan.sends.S_EnableSwitchOut

    yield JUDGE.too_strong("and whenever it sees that", whenever_it_sees_that, "Stage2")


def enable_needs_stage_0(scan: Scanned) -> Obligation:
    rises = z3.And(scan.sends.S_EnableSwitchOut, z3.Not(scan.sent.S_EnableSwitchOut))
    if scan.becomes("Stage1") and not scan.was("Stage1"):
        return rises, SEEN.last_stage == 0
    return TRUE, z3.Not(rises)


@theorem(
    clauses=["ES-SEQ-6", "ES-SEQ-8", "ES-SEQ-9", "ES-ORDER-2"],
    findings=["ESF-02", "ESF-03", "ESF-11"],
    properties=["EnableNeedsStage0"],
    slow=True,
)
def the_enable_comes_out_of_stage_0_alone() -> Queries:
    """In a call in which S_EnableSwitchOut rises, the last stage that an observer of the wires saw before, in
    this run of the mode and since the last error, was stage 0: not 2, not 1, not none.
    """
    yield from JUDGE.in_every_scan(enable_needs_stage_0)
    yield JUDGE.without(enable_needs_stage_0, "ChangeToStage1", "LastStageIsKnown")


# ---------------------------------------------------------------- Activate and the mode


def activate_goes_first(scan: Scanned) -> Obligation:
    return TRUE, scan.sends.Ready == scan.inputs.Activate


@theorem(clauses=["ES-SEQ-0"], findings=[], properties=["ActivateGoesFirst"], slow=True)
def the_end_of_activate_goes_before_everything() -> Queries:
    """After every call Ready is what Activate was in it, whatever the state and the other inputs are."""
    yield from JUDGE.in_every_scan(activate_goes_first)

    def always_ready(scan: Scanned) -> Obligation:
        return TRUE, scan.sends.Ready

    yield JUDGE.too_strong("and Ready stays", always_ready, "EquivalenceError")


def mode_ends_operation(scan: Scanned) -> Obligation:
    off = z3.Not(scan.inputs.S_SafetyActive)
    quiet = z3.And(z3.Not(scan.sends.S_EnableSwitchOut), z3.Not(scan.sends.SafetyDemand))
    basic = scan.sends.DiagCode == 0x8002
    kept = z3.Implies(z3.And(z3.Not(scan.sent.Error), scan.inputs.Activate), basic)
    return off, z3.And(quiet, kept)


@theorem(clauses=["ES-SEQ-1"], findings=["ESF-08", "ESF-09"], properties=["ModeEndsOperation"], slow=True)
def without_the_mode_the_switch_demands_and_enables_nothing() -> Queries:
    """After a call with S_SafetyActive FALSE there is neither enable nor demand, and an active block that had
    no error is in BasicMode.
    """
    yield from JUDGE.in_every_scan(mode_ends_operation)

    def errors_too(scan: Scanned) -> Obligation:
        return z3.And(scan.inputs.Activate, z3.Not(scan.inputs.S_SafetyActive)), scan.sends.DiagCode == 0x8002

    yield JUDGE.too_strong("and errors end as well", errors_too, "EquivalenceError")


# ---------------------------------------------------------------- errors and Reset


def _ends(scan: Scanned) -> z3.BoolRef:
    return z3.And(scan.sent.Error, z3.Not(scan.sends.Error), scan.inputs.Activate)


def _by_a_reset(scan: Scanned) -> z3.BoolRef:
    edge = z3.And(scan.inputs.Reset, z3.Not(scan.before.reset_before))
    return z3.And(shows(scan.inputs, STAGE_0), scan.sent.ResetRequest, z3.Or(automatic(scan), edge))


def error_needs_reset(scan: Scanned) -> Obligation:
    kept = z3.Not(scan.params.MODE_ENDS_ERROR)
    if scan.was(*RELEASED) and not scan.becomes("Idle", *ERRORS):
        return z3.And(kept, _ends(scan)), _by_a_reset(scan)
    return kept, z3.Not(_ends(scan))


@theorem(
    clauses=["ES-STAGE-0", "ES-SEQ-4", "ES-SEQ-5", "ES-RESTART"],
    findings=["ESF-06", "ESF-08", "ESF-14"],
    properties=["ErrorNeedsReset", "ErrorNeedsEdge"],
    slow=True,
)
def an_error_ends_at_stage_0_and_by_a_reset() -> Queries:
    """Unless MODE_ENDS_ERROR is set, an error of an active block ends only in a call that sees stage 0 after
    ResetRequest was TRUE, with a rising edge of Reset or with S_AutoReset and AUTO_RESET_ERRORS.
    """
    yield from JUDGE.in_every_scan(error_needs_reset)

    def in_the_mode_alone(scan: Scanned) -> Obligation:
        return _ends(scan), scan.inputs.S_SafetyActive

    yield JUDGE.too_strong("and in the mode alone", in_the_mode_alone, "EquivalenceErrorAtStage0")

    def never_by_the_mode(scan: Scanned) -> Obligation:
        return _ends(scan), _by_a_reset(scan)

    yield JUDGE.too_strong("also with the parameter", never_by_the_mode, "EquivalenceError")


def error_needs_reset_in_the_mode(scan: Scanned) -> Obligation:
    ends = z3.And(_ends(scan), scan.inputs.S_SafetyActive)
    if scan.was(*RELEASED) and scan.becomes("Stage0"):
        return ends, _by_a_reset(scan)
    return TRUE, z3.Not(ends)


@theorem(
    clauses=["ES-SEQ-5", "ES-RESTART"],
    findings=["ESF-08"],
    properties=["ErrorNeedsResetInTheMode"],
    slow=True,
)
def in_the_mode_an_error_ends_by_a_reset_whatever_the_parameter_is() -> Queries:
    """With S_SafetyActive TRUE an error of an active block ends only at stage 0 and by a reset, whatever
    MODE_ENDS_ERROR is, and the call leads to Stage0.
    """
    yield from JUDGE.in_every_scan(error_needs_reset_in_the_mode)

    def without_stage_0(scan: Scanned) -> Obligation:
        return z3.And(_ends(scan), scan.inputs.S_SafetyActive), scan.inputs.Reset

    yield JUDGE.too_strong("and never without Reset", without_stage_0, "OperationErrorAtStage0")


def held_reset_never_resets(scan: Scanned) -> Obligation:
    counts = z3.Implies(scan.params.MODE_ENDS_ERROR, scan.inputs.S_SafetyActive)
    ends = z3.And(_ends(scan), z3.Not(automatic(scan)), counts)
    if scan.was(*RELEASED) and scan.becomes("Stage0", "BasicMode"):
        return ends, z3.And(scan.inputs.Reset, z3.Not(SEEN.last_reset))
    return TRUE, z3.Not(ends)


@theorem(
    clauses=["ES-SEQ-5", "ES-RESTART"], findings=["ESF-10"], properties=["HeldResetNeverResets"], slow=True
)
def a_reset_that_is_held_never_resets() -> Queries:
    """Unless S_AutoReset and AUTO_RESET_ERRORS are set, an error of an active block ends only in a call with
    Reset TRUE, and an observer of the wires saw Reset FALSE in the call before, whether or not the block was
    active in it; where MODE_ENDS_ERROR is set, in the mode.
    """
    yield from JUDGE.in_every_scan(held_reset_never_resets)
    yield JUDGE.without(held_reset_never_resets, "PlausibilityErrorAtStage0", "ResetIsRemembered")


def held_reset_is_an_error(scan: Scanned) -> Obligation:
    i = scan.inputs
    kept = z3.And(i.Activate, z3.Implies(scan.params.MODE_ENDS_ERROR, i.S_SafetyActive))
    stays = TRUE if scan.becomes(*RESET_ERRORS) else FALSE
    if scan.was(*RELEASED):
        held = z3.And(shows(i, STAGE_0), i.Reset, scan.before.reset_before, z3.Not(automatic(scan)))
        return z3.And(kept, held), stays
    if scan.was(*RESET_ERRORS):
        return z3.And(kept, i.Reset), stays
    return None


@theorem(
    clauses=["ES-RESTART", "ES-SEQ-5"], findings=["ESF-10"], properties=["HeldResetIsAnError"], slow=True
)
def a_reset_that_is_held_is_reported_until_it_is_released() -> Queries:
    """Where the edge of Reset is waited for, a call that finds Reset TRUE as in the call before leads to a
    reset error, unless S_AutoReset and AUTO_RESET_ERRORS are set; and a reset error stays for as long as
    Reset is TRUE.
    """
    yield from JUDGE.in_every_scan(held_reset_is_an_error)

    def reset_alone(scan: Scanned) -> Obligation:
        said = held_reset_is_an_error(scan)
        return None if said is None else (z3.And(scan.inputs.Activate, scan.inputs.Reset), said[1])

    yield JUDGE.too_strong("whenever Reset is TRUE", reset_alone, "EquivalenceErrorAtStage0")


# ---------------------------------------------------------------- the time of a change


def _over(scan: Scanned, lasted: z3.ArithRef) -> z3.BoolRef:
    """It lasted before this call, and by now for the discrepancy time."""
    over: z3.BoolRef = lasted + scan.inputs.dt_ms >= scan.params.DiscrepancyTimeCh1_Ch3_ms
    return z3.And(lasted != NONE, over)


def disagreement_ends_in_error(scan: Scanned) -> Obligation:
    late = z3.And(_over(scan, SEEN.apart), sees(scan).apart != NONE)
    return (late, scan.sends.Error) if scan.was(*TIMED, *ERRORS) else (TRUE, z3.Not(late))


@theorem(
    clauses=["ES-SEQ-3", "ES-SEQ-8"],
    findings=["ESF-04", "ESF-07"],
    properties=["DisagreementEndsInError"],
    slow=True,
)
def channels_that_differ_for_the_discrepancy_time_end_in_an_error() -> Queries:
    """A call that finds channels 1 and 3 different, in a block that is watching them, and that they have been
    so for the discrepancy time, ends in an error: for all times, whichever channel is late.
    """
    yield from JUDGE.in_every_scan(disagreement_ends_in_error)
    yield JUDGE.without(disagreement_ends_in_error, "ChangeToStage0", "DisagreementIsTimed")

    def at_once(scan: Scanned) -> Obligation:
        return sees(scan).apart != NONE, scan.sends.Error

    yield JUDGE.too_strong("any difference at once", at_once, "Stage1")


def contradiction_ends_in_error(scan: Scanned) -> Obligation:
    late = z3.And(_over(scan, SEEN.contrary), sees(scan).contrary != NONE)
    return (late, scan.sends.Error) if scan.was(*TIMED, *ERRORS) else (TRUE, z3.Not(late))


@theorem(clauses=["ES-STAGE-1"], findings=["ESF-05"], properties=["ContradictionEndsInError"], slow=True)
def three_channels_true_for_the_discrepancy_time_end_in_an_error() -> Queries:
    """A call that finds all three channels TRUE, in a block that is watching them, and that they have been so
    for the discrepancy time, ends in an error.
    """
    yield from JUDGE.in_every_scan(contradiction_ends_in_error)
    yield JUDGE.without(contradiction_ends_in_error, "ChangeToStage1", "ContradictionIsTimed")


def enable_comes_in_time(scan: Scanned) -> Obligation:
    late = _over(scan, SEEN.apart)
    return (late, z3.Not(scan.sends.S_EnableSwitchOut)) if scan.was(*TIMED, *ERRORS) else (TRUE, z3.Not(late))


@theorem(clauses=["ES-SEQ-3", "ES-SEQ-6"], findings=["ESF-07"], properties=["EnableComesInTime"], slow=True)
def channels_that_come_together_too_late_do_not_enable() -> Queries:
    """When channels 1 and 3 have differed for the discrepancy time, the call that finds it does not enable,
    even if it finds them together again. Equality counts as too late.
    """
    yield from JUDGE.in_every_scan(enable_comes_in_time)
    yield JUDGE.without(enable_comes_in_time, "ChangeToStage1", "DisagreementIsTimed")

    def one_ms_before(scan: Scanned) -> Obligation:
        early = SEEN.apart + scan.inputs.dt_ms + 1 >= scan.params.DiscrepancyTimeCh1_Ch3_ms
        return z3.And(SEEN.apart != NONE, early), z3.Not(scan.sends.S_EnableSwitchOut)

    yield JUDGE.too_strong("a millisecond before it is over", one_ms_before, "ChangeToStage1")


def timer_counts(scan: Scanned) -> Obligation:
    """The timer starts in the call that sees the change begin, adds up, and ends with the change."""
    if not scan.becomes(*TIMED):
        return TRUE, scan.after.elapsed_ms == 0
    if scan.was(*TIMED):
        same = TRUE if scan.was("ChangeToStage1") == scan.becomes("ChangeToStage1") else FALSE
        return TRUE, z3.And(same, scan.after.elapsed_ms == scan.before.elapsed_ms + scan.inputs.dt_ms)
    return TRUE, scan.after.elapsed_ms == 0


@theorem(clauses=["ES-SEQ-3", "ES-SEQ-8"], findings=["ESF-04", "ESF-07"], slow=True)
def the_time_of_a_change_starts_with_it_and_adds_up() -> Queries:
    """A call that begins a change starts the timer with 0, a call that goes on with it adds the time since
    the call before, and a call that ends it leaves 0; one change never turns into the other.
    """
    yield from JUDGE.in_every_scan(timer_counts)
    yield JUDGE.too_strong("it never runs", lambda scan: (TRUE, scan.after.elapsed_ms == 0), "ChangeToStage1")


def ends_by_its_cause(scan: Scanned) -> Obligation:
    """Which error a change that is too late ends in."""
    late = scan.before.elapsed_ms + scan.inputs.dt_ms >= scan.params.DiscrepancyTimeCh1_Ch3_ms
    if not scan.was(*TIMED):
        return None
    all_true = shows(scan.inputs, (True, True, True))
    if scan.becomes("PlausibilityError"):
        return z3.And(in_the_mode(scan), late), all_true
    if scan.becomes("EquivalenceError"):
        return TRUE, z3.And(in_the_mode(scan), late, z3.Not(all_true))
    return in_the_mode(scan), z3.Not(late)


@theorem(clauses=["ES-SEQ-3"], findings=["ESF-05", "ESF-07"], properties=["LateChangeHasItsError"], slow=True)
def a_change_that_is_too_late_ends_in_the_error_of_its_cause() -> Queries:
    """In the mode, a call that finds the time of a change over ends in PlausibilityError if all three
    channels are TRUE, and in EquivalenceError with any other pattern; no other call does the latter.
    """
    yield from JUDGE.in_every_scan(ends_by_its_cause)

    def equal_channels(scan: Scanned) -> Obligation:
        unequal = scan.inputs.S_EnableSwitchCh1 != scan.inputs.S_EnableSwitchCh3
        return (TRUE, unequal) if scan.becomes("EquivalenceError") else None

    yield JUDGE.too_strong("only while the two differ", equal_channels, "ChangeToStage1")
