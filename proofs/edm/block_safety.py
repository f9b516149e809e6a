"""When the output may be on, and what a contactor that does not follow does.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in EDMOpen.
"""

from __future__ import annotations

from typing import Final

import z3

from proofs.edm.devices import BLOCK, stop_first
from proofs.edm.invariant import JUDGE
from proofs.edm.observer import SEEN
from proofs.edm.rows import FROM_ANYWHERE, NUMBERS
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem


def both_are(scan: Scanned, dropped: bool) -> z3.BoolRef:
    """Both feedbacks show this: dropped out (TRUE), or picked up (FALSE)."""
    i = scan.inputs
    return z3.And(i.S_EDM1, i.S_EDM2) if dropped else z3.And(z3.Not(i.S_EDM1), z3.Not(i.S_EDM2))


def on_time(scan: Scanned) -> z3.BoolRef:
    """MonitoringTime has not passed since the output last changed."""
    term: z3.BoolRef = SEEN.unchanged + scan.inputs.dt_ms < scan.params.MonitoringTime_ms
    return term


def switches_on(scan: Scanned) -> z3.BoolRef:
    """S_EDM_Out becomes TRUE."""
    return z3.And(z3.Not(scan.sent.S_EDM_Out), scan.sends.S_EDM_Out)


def stays_on(scan: Scanned) -> z3.BoolRef:
    """S_EDM_Out stays TRUE."""
    return z3.And(scan.sent.S_EDM_Out, scan.sends.S_EDM_Out)


def stop_at_once(scan: Scanned) -> Obligation:
    stopped = z3.Or(z3.Not(scan.inputs.Activate), z3.Not(scan.inputs.S_OutControl))
    return stopped, z3.Not(scan.sends.S_EDM_Out)


@theorem(
    clauses=["EDM-IN-ACTIVATE", "EDM-IN-CONTROL-2", "EDM-OUT-EDM-1", "EDM-SEQ-4"],
    findings=["EDMF-12"],
    properties=["StopAtOnce"],
    slow=True,
)
def a_stop_request_switches_off_in_its_own_call() -> Queries:
    """In a call that is not active, or with S_OutControl FALSE, S_EDM_Out is FALSE."""
    yield from JUDGE.in_every_scan(stop_at_once)

    def always_off(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(scan.sends.S_EDM_Out)

    yield JUDGE.too_strong("also without a stop", always_off, "OutputEnable")


def inactive_at_once(scan: Scanned) -> Obligation:
    return TRUE, scan.sends.Ready == scan.inputs.Activate


@theorem(
    clauses=["EDM-IN-ACTIVATE", "EDM-OUT-READY-1", "EDM-OUT-READY-2"],
    findings=[],
    properties=["InactiveAtOnce"],
    slow=True,
)
def ready_is_activate_of_the_same_call() -> Queries:
    """After every call Ready is what Activate was in it."""
    yield from JUDGE.in_every_scan(inactive_at_once)

    def and_on(scan: Scanned) -> Obligation:
        return scan.inputs.Activate, scan.sends.S_EDM_Out

    yield JUDGE.too_strong("and the output with it", and_on, "Idle")


FOLLOWS: Final = {
    "Idle": ("Init",),
    "Init": ("OutputDisable", "ResetError1", "InitError"),
    "ResetError1": ("Init",),
    "InitError": ("Init",),
    "OutputDisable": ("OutputEnable", *(f"EDMError{of}" for of in NUMBERS[:6])),
    "OutputEnable": ("OutputDisable", *(f"EDMError{of}" for of in NUMBERS[6:])),
    **{f"EDMError{of}": ("OutputDisable", f"ResetError{of}") for of in NUMBERS},
    **{f"ResetError{of}": (f"EDMError{of}",) for of in NUMBERS},
}
"""Where one transition leads from each state, besides to Idle."""


def one_transition(scan: Scanned) -> Obligation:
    state = control(BLOCK, scan.before)
    return TRUE, TRUE if scan.becomes(state, "Idle", *FOLLOWS[state]) else FALSE


@theorem(
    clauses=["EDM-INST-1", "EDM-IN-ACTIVATE"],
    findings=["EDMF-12"],
    properties=["OneTransitionACall"],
    slow=True,
)
def a_call_takes_one_transition_at_most() -> Queries:
    """From any memory a call stays in its state, ends in Idle, or takes one of its state's transitions."""
    yield from FROM_ANYWHERE.in_every_scan(one_transition)

    def stays(scan: Scanned) -> Obligation:
        return TRUE, TRUE if scan.becomes(control(BLOCK, scan.before), "Idle") else FALSE

    yield FROM_ANYWHERE.too_strong("it takes none but to Idle", stays, "OutputDisable")


def starts_with_inhibit(scan: Scanned) -> Obligation:
    if not scan.was("Idle"):  # every_state_has_its_row: the one state without Ready
        return None
    o = scan.sends
    return o.Ready, z3.And(o.ResetRequest, z3.Not(o.Error), z3.Not(o.S_EDM_Out))


@theorem(
    clauses=["EDM-IN-START-1", "EDM-SEQ-1", "EDM-INST-1"],
    findings=["EDMF-12"],
    properties=["StartsWithInhibit"],
    slow=True,
)
def activation_shows_the_inhibit_for_one_call_at_least() -> Queries:
    """A call that makes the block active shows the inhibit and no output, whatever else is TRUE."""
    yield from JUDGE.in_every_scan(starts_with_inhibit)

    def and_goes_on(scan: Scanned) -> Obligation:
        return TRUE, scan.sends.SafetyDemand

    yield JUDGE.too_strong("and goes on at once", and_goes_on, "Idle")


def switch_on_needs_initial_state(scan: Scanned) -> Obligation:
    ready = z3.And(scan.sent.SafetyDemand, both_are(scan, True), scan.inputs.S_OutControl)
    return TRUE, z3.Implies(switches_on(scan), ready)


@theorem(
    clauses=["EDM-IN-EDM-1", "EDM-IN-EDM-2", "EDM-IN-CONTROL-3", "EDM-OUT-EDM-2", "EDM-SEQ-3", "EDM-FB-1"],
    findings=["EDMF-05"],
    properties=["SwitchOnNeedsInitialState"],
    slow=True,
)
def both_contactors_are_dropped_out_at_switching_on() -> Queries:
    """S_EDM_Out becomes TRUE only out of the state that shows SafetyDemand, in a call with both feedbacks
    TRUE and S_OutControl TRUE.
    """
    yield from JUDGE.in_every_scan(switch_on_needs_initial_state)

    def never(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(switches_on(scan))

    yield JUDGE.too_strong("never", never, "OutputDisable")


def wrong_only_for_a_time(scan: Scanned) -> Obligation:
    return TRUE, z3.Implies(stays_on(scan), z3.Or(on_time(scan), both_are(scan, False)))


@theorem(
    clauses=["EDM-IN-TIME-1", "EDM-IN-TIME-2", "EDM-IN-EDM-1", "EDM-SEQ-3", "EDM-SEQ-5", "EDM-FB-1"],
    findings=["EDMF-08", "EDMF-09"],
    properties=["FeedbackWrongOnlyForATime"],
    slow=True,
)
def the_output_stays_over_a_wrong_feedback_less_than_monitoring_time() -> Queries:
    """A call that leaves S_EDM_Out TRUE either comes before MonitoringTime has passed since it became TRUE,
    or finds both feedbacks FALSE; for every MonitoringTime, 0 too, and however long ago it has passed.
    """
    yield from JUDGE.in_every_scan(wrong_only_for_a_time)
    yield JUDGE.without(wrong_only_for_a_time, "OutputEnable", "TimeIsThatOnTheWires")


def missed_pick_up(scan: Scanned) -> Obligation:
    late = z3.And(
        scan.sent.S_EDM_Out, scan.inputs.Activate, z3.Not(on_time(scan)), z3.Not(both_are(scan, False))
    )
    return TRUE, z3.Implies(late, scan.sends.Error)


def missed_drop_out(scan: Scanned) -> Obligation:
    late = z3.And(
        scan.sent.SafetyDemand, scan.inputs.Activate, z3.Not(on_time(scan)), z3.Not(both_are(scan, True))
    )
    return TRUE, z3.Implies(late, scan.sends.Error)


@theorem(
    clauses=["EDM-IN-TIME-1", "EDM-SEQ-5", "EDM-OUT-ERROR", "EDM-FB-1"],
    findings=["EDMF-06", "EDMF-08"],
    properties=["MissedPickUpIsAnError"],
    slow=True,
)
def a_missed_pick_up_is_an_error_whatever_else_the_call_asks() -> Queries:
    """An active call that finds MonitoringTime over and a feedback TRUE, with the output on, ends in an
    error, also when it asks for the stop.
    """
    yield from JUDGE.in_every_scan(missed_pick_up)
    yield JUDGE.without(missed_pick_up, "OutputEnable", "TimeIsThatOnTheWires")


@theorem(
    clauses=["EDM-IN-TIME-1", "EDM-SEQ-4", "EDM-OUT-ERROR", "EDM-FB-1"],
    findings=["EDMF-06", "EDMF-14"],
    properties=["MissedDropOutIsAnError"],
    slow=True,
)
def a_missed_drop_out_is_an_error_whatever_else_the_call_asks() -> Queries:
    """An active call that finds MonitoringTime over and a feedback FALSE, with the output off on request,
    ends in an error.
    """
    yield from JUDGE.in_every_scan(missed_drop_out)
    yield JUDGE.without(missed_drop_out, "OutputDisable", "TimeIsThatOnTheWires")


def reset_never_starts(scan: Scanned) -> Obligation:
    return TRUE, z3.Implies(z3.And(stop_first(scan.params), switches_on(scan)), SEEN.released)


@theorem(
    clauses=["EDM-IN-RESET-4", "EDM-IN-CONTROL-1"],
    findings=["EDMF-04"],
    properties=["ResetNeverStarts"],
    slow=True,
)
def with_stop_first_the_reset_button_never_starts() -> Queries:
    """With AFTER_RESET at stop_first S_EDM_Out becomes TRUE only once S_OutControl has been FALSE since the
    last reset by hand; with at_once it need not.
    """
    yield from JUDGE.in_every_scan(reset_never_starts)
    yield JUDGE.without(reset_never_starts, "OutputDisable", "StopWasSeen")

    def with_at_once_too(scan: Scanned) -> Obligation:
        return TRUE, z3.Implies(switches_on(scan), SEEN.released)

    yield JUDGE.too_strong("with at_once too", with_at_once_too, "OutputDisable")
