"""What ends the start-up inhibit and an error, and what does not; which errors come, and with which code.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in EDMOpen.
"""

from __future__ import annotations

import z3

from proofs.edm.block_safety import both_are, on_time
from proofs.edm.devices import CODES
from proofs.edm.invariant import JUDGE
from proofs.edm.observer import SEEN, reset_edge
from proofs.explorer.ends import TRUE
from proofs.explorer.scanned import Scanned
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem


def asked(scan: Scanned, error: bool) -> z3.BoolRef:
    """ResetRequest shows, with an error or for the inhibit."""
    return z3.And(scan.sent.ResetRequest, scan.sent.Error if error else z3.Not(scan.sent.Error))


def ends_well(scan: Scanned) -> z3.BoolRef:
    """The block is active, and shows neither an error nor a request for a reset."""
    o = scan.sends
    return z3.And(o.Ready, z3.Not(o.ResetRequest), z3.Not(o.Error))


def held(scan: Scanned) -> z3.BoolRef:
    """Reset is TRUE, and was in the call before."""
    return z3.And(scan.inputs.Reset, SEEN.reset)


def control_rises(scan: Scanned) -> z3.BoolRef:
    """S_OutControl rises on the wires."""
    return z3.And(scan.inputs.S_OutControl, z3.Not(SEEN.control))


def reset_error(scan: Scanned) -> z3.BoolRef:
    """The call ends in an error about Reset."""
    return z3.And(scan.sends.Error, z3.Not(scan.sends.ResetRequest))


def reset_needs_edge(scan: Scanned) -> Obligation:
    free = z3.And(z3.Not(scan.sent.Error), scan.inputs.S_StartReset)
    gone = z3.And(scan.sent.ResetRequest, ends_well(scan))
    return TRUE, z3.Implies(gone, z3.Or(reset_edge(scan), free))


@theorem(
    clauses=[
        "EDM-IN-START-1",
        "EDM-IN-START-2",
        "EDM-IN-RESET-1",
        "EDM-IN-RESET-2",
        "EDM-IN-RESET-3",
        "EDM-SEQ-2",
    ],
    findings=["EDMF-10"],
    properties=["ResetNeedsEdge"],
    slow=True,
)
def neither_inhibit_nor_error_goes_without_an_edge() -> Queries:
    """While the block stays active, the inhibit goes only in a call with a rising edge of Reset, or with
    S_StartReset TRUE, and an error is reset only in a call with such an edge.
    """
    yield from JUDGE.in_every_scan(reset_needs_edge)
    yield JUDGE.without(reset_needs_edge, "EDMError22", "WiresAreRemembered")


def cause_is_gone(scan: Scanned) -> Obligation:
    return TRUE, z3.Implies(z3.And(asked(scan, True), ends_well(scan)), both_are(scan, True))


@theorem(
    clauses=["EDM-IN-RESET-1", "EDM-SEQ-6", "EDM-FB-1"],
    findings=["EDMF-07"],
    properties=["CauseIsGone"],
    slow=True,
)
def no_error_is_reset_over_its_cause() -> Queries:
    """An error is reset only in a call with both feedbacks TRUE."""
    yield from JUDGE.in_every_scan(cause_is_gone)

    def never(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(ends_well(scan))

    yield JUDGE.too_strong("never", never, "EDMError33")


def errors_are_left(scan: Scanned) -> Obligation:
    left = z3.And(scan.sent.Error, scan.sends.Ready, z3.Not(scan.sends.Error))
    back = z3.And(scan.sends.ResetRequest, z3.Not(scan.inputs.Reset))
    return TRUE, z3.Implies(left, z3.If(scan.sent.ResetRequest, scan.sends.SafetyDemand, back))


@theorem(
    clauses=["EDM-OUT-ERROR", "EDM-IN-RESET-1", "EDM-SEQ-6"],
    findings=["EDMF-10", "EDMF-11"],
    properties=["ErrorsAreLeftAsDocumented"],
    slow=True,
)
def an_error_has_one_way_out() -> Queries:
    """An active block leaves an error by its reset, to the state with the output off on request, or one about
    Reset in Init when Reset is let go, back to the inhibit.
    """
    yield from JUDGE.in_every_scan(errors_are_left)

    def stays(scan: Scanned) -> Obligation:
        return scan.inputs.Activate, scan.sends.Error

    yield JUDGE.too_strong("no error is left", stays, "InitError")


def held_reset(scan: Scanned) -> Obligation:
    waits = z3.And(scan.sent.ResetRequest, z3.Or(scan.sent.Error, z3.Not(scan.inputs.S_StartReset)))
    return TRUE, z3.Implies(z3.And(waits, scan.inputs.Activate, held(scan)), reset_error(scan))


@theorem(clauses=["EDM-IN-RESET-1"], findings=["EDMF-10"], properties=["HeldResetIsAnError"], slow=True)
def a_held_reset_is_an_error_where_its_edge_is_waited_for() -> Queries:
    """An active call with Reset held ends in an error about Reset, from the inhibit and from each error."""
    yield from JUDGE.in_every_scan(held_reset)
    yield JUDGE.without(held_reset, "Init", "WiresAreRemembered")


def two_edges(scan: Scanned) -> Obligation:
    both = z3.And(reset_edge(scan), control_rises(scan), z3.Not(scan.inputs.S_StartReset))
    return TRUE, z3.Implies(z3.And(asked(scan, False), scan.inputs.Activate, both), reset_error(scan))


@theorem(
    clauses=["EDM-IN-START-2", "EDM-IN-RESET-4"],
    findings=["EDMF-11"],
    properties=["TwoEdgesAreAnError"],
    slow=True,
)
def reset_and_request_that_rise_together_are_an_error() -> Queries:
    """From the inhibit an active call in which Reset and S_OutControl rise ends in an error about Reset."""
    yield from JUDGE.in_every_scan(two_edges)
    yield JUDGE.without(two_edges, "Init", "WiresAreRemembered")


def starts_by_itself(scan: Scanned) -> Obligation:
    free = z3.And(asked(scan, False), scan.inputs.Activate, scan.inputs.S_StartReset)
    return TRUE, z3.Implies(free, scan.sends.SafetyDemand)


@theorem(
    clauses=["EDM-IN-START-1", "EDM-IN-START-3"],
    findings=["EDMF-11"],
    properties=["StartsByItself"],
    slow=True,
)
def without_inhibit_nothing_is_waited_for() -> Queries:
    """From Init an active call with S_StartReset TRUE ends in the state with the output off on request."""
    yield from JUDGE.in_every_scan(starts_by_itself)

    def with_inhibit_too(scan: Scanned) -> Obligation:
        return scan.inputs.Activate, scan.sends.SafetyDemand

    yield JUDGE.too_strong("with inhibit too", with_inhibit_too, "Init")


def removes_inhibit(scan: Scanned) -> Obligation:
    edge = z3.And(reset_edge(scan), z3.Not(control_rises(scan)))
    return TRUE, z3.Implies(z3.And(asked(scan, False), scan.inputs.Activate, edge), scan.sends.SafetyDemand)


def resets_at_once(scan: Scanned) -> Obligation:
    edge = z3.And(reset_edge(scan), both_are(scan, True))
    return TRUE, z3.Implies(z3.And(asked(scan, True), scan.inputs.Activate, edge), scan.sends.SafetyDemand)


@theorem(
    clauses=["EDM-IN-START-2", "EDM-IN-RESET-2", "EDM-SEQ-2"],
    findings=["EDMF-11"],
    properties=["RemovesInhibitAtOnce"],
    slow=True,
)
def the_edge_removes_the_inhibit_in_its_call() -> Queries:
    """From Init an active call with an edge of Reset, and none of S_OutControl, removes the inhibit."""
    yield from JUDGE.in_every_scan(removes_inhibit)
    yield JUDGE.without(removes_inhibit, "Init", "WiresAreRemembered")


@theorem(
    clauses=["EDM-IN-RESET-1", "EDM-SEQ-6"],
    findings=["EDMF-07", "EDMF-11"],
    properties=["ResetsAtOnce"],
    slow=True,
)
def the_edge_resets_an_error_whose_cause_is_gone_in_its_call() -> Queries:
    """From each of the nine errors an active call with an edge of Reset and both feedbacks TRUE resets it."""
    yield from JUDGE.in_every_scan(resets_at_once)
    yield JUDGE.without(resets_at_once, "EDMError11", "WiresAreRemembered")


def error_needs_cause(scan: Scanned) -> Obligation:
    found = z3.And(z3.Not(scan.sent.Error), scan.sends.Error)
    on = z3.And(z3.Not(on_time(scan)), z3.Not(both_are(scan, False)))
    requested = z3.And(scan.inputs.S_OutControl, z3.Or(SEEN.released, scan.before.stop_seen))
    off = z3.And(z3.Not(both_are(scan, True)), z3.Or(z3.Not(on_time(scan)), requested))
    together = z3.And(scan.inputs.Reset, z3.Or(SEEN.reset, control_rises(scan)))
    inhibit = z3.And(z3.Not(scan.inputs.S_StartReset), together)
    cause = z3.If(scan.sent.S_EDM_Out, on, z3.If(scan.sent.SafetyDemand, off, inhibit))
    return TRUE, z3.Implies(found, cause)


@theorem(
    clauses=["EDM-OUT-ERROR", "EDM-SEQ-2", "EDM-SEQ-3", "EDM-SEQ-6"],
    findings=["EDMF-05"],
    properties=["ErrorNeedsCause"],
    slow=True,
)
def no_error_comes_for_nothing() -> Queries:
    """An error comes only over a wrong feedback with MonitoringTime over, or with a request that counts; or
    over a held Reset, or two edges, at the inhibit: MonitoringTime over the right feedback does nothing.
    """
    yield from JUDGE.in_every_scan(error_needs_cause)
    yield JUDGE.without(error_needs_cause, "OutputEnable", "TimeIsThatOnTheWires")


def code_names_the_cause(scan: Scanned) -> Obligation:
    i, on = scan.inputs, scan.sent.S_EDM_Out
    first, second = on == i.S_EDM1, on == i.S_EDM2  # wrong: TRUE with the output on, FALSE with it off
    which = z3.If(z3.Not(second), 1, z3.If(z3.Not(first), 2, 3))
    group = z3.If(on, 6, z3.If(on_time(scan), 0, 3))
    found = z3.And(scan.sends.Error, z3.Or(on, scan.sent.SafetyDemand))
    code = z3.BV2Int(scan.sends.DiagCode)
    about_reset = z3.And(scan.sends.Error, asked(scan, False))
    return TRUE, z3.And(
        z3.Implies(found, code == 0xC000 + 16 * (group + which)),
        z3.Implies(about_reset, code == z3.If(SEEN.reset, CODES["ResetError1"], CODES["InitError"])),
    )


@theorem(
    clauses=["EDM-OUT-DIAG", "EDM-OUT-ERROR", "EDM-IN-EDM-1"],
    findings=["EDMF-01", "EDMF-06", "EDMF-10", "EDMF-11"],
    properties=["CodeNamesTheCause"],
    slow=True,
)
def the_code_names_the_cause() -> Queries:
    """The DiagCode of an error that a feedback causes says which of the two was wrong in that call, and
    whether at the request, after the time to drop out, or after the time to pick up; that of an error at the
    inhibit says whether Reset was held, or rose together with S_OutControl.
    """
    yield from JUDGE.in_every_scan(code_names_the_cause)
    yield JUDGE.without(code_names_the_cause, "OutputDisable", "TimeIsThatOnTheWires")
    yield JUDGE.without(code_names_the_cause, "Init", "WiresAreRemembered")


def keeps_the_code(scan: Scanned) -> Obligation:
    before, after = scan.sent.DiagCode, scan.sends.DiagCode
    at_start = z3.Or(before == CODES["ResetError1"], before == CODES["InitError"])
    numbered = z3.And(scan.sent.Error, z3.Not(at_start), scan.sends.Error)
    same = (before & 0xFFF0) == (after & 0xFFF0)
    digit = z3.And(scan.inputs.Reset, z3.Or(SEEN.reset, z3.Not(scan.sent.ResetRequest)))
    return TRUE, z3.Implies(numbered, z3.And(same, ((after & 0x000F) == 1) == digit))


@theorem(clauses=["EDM-IN-RESET-1"], findings=["EDMF-10"], properties=["ResetErrorKeepsTheCode"], slow=True)
def a_held_reset_does_not_hide_the_error() -> Queries:
    """From an error about contactors a held Reset leads to the error about Reset with the same number, which
    leads back to it.
    """
    yield from JUDGE.in_every_scan(keeps_the_code)
    yield JUDGE.without(keeps_the_code, "EDMError31", "WiresAreRemembered")
