"""What a call owes at once: the printed code, a demand and an error that are true, and a reset that acts.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in
TestableSafetySensorOpen.
"""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.sentences import Obligation
from proofs.testable_safety_sensor.devices import SENSOR
from proofs.testable_safety_sensor.invariants import RESET_ERRORS, SEEN, TEST_ERRORS, valid
from proofs.testable_safety_sensor.rows import TRUE_IN
from proofs.testable_safety_sensor.sensor_safety import JUDGE, edge
from proofs.theorem import Queries, theorem

OF_A_STATE: Final = ("ResetError1", "ResetError3", "ResetError4")
"""The reset errors whose inhibit or error is judged in the call that finds them; the others: TSSF-20."""


def code_is_the_printed_one(scan: Scanned, seen: Any) -> z3.BoolRef:
    return z3.And(scan.sends.DiagCode == TRUE_IN[control(scan.device, scan.after)][0], TRUE)


@theorem(
    clauses=[
        "TSS-OUT-DIAG",
        "TSS-0000",
        "TSS-8401",
        "TSS-8802",
        "TSS-8402",
        "TSS-8002",
        "TSS-8804",
        "TSS-8404",
        "TSS-8010",
        "TSS-8806",
        "TSS-8406",
        "TSS-8020",
        "TSS-8030",
        "TSS-8000",
        "TSS-C000",
        "TSS-C001",
        "TSS-C011",
        "TSS-C021",
        "TSS-C031",
        "TSS-C041",
        "TSS-C051",
        "TSS-C410",
        "TSS-C010",
    ],
    findings=["TSSF-02", "TSSF-03"],
    properties=["CodeIsThePrintedOne"],
    slow=True,
)
def every_state_shows_its_printed_code() -> Queries:
    """At power-up and after every call DiagCode is the number that the document prints for the state."""
    yield from JUDGE.after_every_scan(code_is_the_printed_one)

    def as_before(scan: Scanned) -> Obligation:
        return TRUE, scan.sends.DiagCode == scan.sent.DiagCode

    yield JUDGE.too_strong("it stays as it was", as_before, "Init")


def demand_needs_dark_sensor(scan: Scanned) -> Obligation:
    return TRUE, z3.Implies(scan.sends.SafetyDemand, z3.Not(scan.inputs.S_OSSD_In))


@theorem(
    clauses=["TSS-8802", "TSS-8804", "TSS-8806", "TSS-OUT-DEMAND"],
    findings=[],
    properties=["DemandNeedsDarkSensor"],
    slow=True,
)
def a_demand_is_shown_only_over_a_dark_sensor() -> Queries:
    """Every call that finds the sensor free leaves SafetyDemand FALSE."""
    yield from JUDGE.in_every_scan(demand_needs_dark_sensor)

    def never(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(scan.sends.SafetyDemand)

    yield JUDGE.too_strong("never", never, "ESPEFreeTestOk")


def reset_ends_at_once(scan: Scanned) -> Obligation:
    i = scan.inputs
    asked = z3.And(scan.sent.ResetRequest, i.S_OSSD_In, valid(scan.params))
    if scan.was("TestError1C410"):
        asked = z3.And(asked, i.NoExternalTest)
    acts = z3.Implies(asked, scan.sends.S_OSSD_Out)
    if scan.was(*TEST_ERRORS):
        begins = TRUE if scan.becomes("ExternalFunctionTest") else FALSE
        acts = z3.And(acts, z3.Implies(z3.Not(i.NoExternalTest), begins))
    return z3.And(i.Activate, edge(scan)), acts


@theorem(
    clauses=["TSS-OUT-REQUEST", "TSS-EB-2", "TSS-EB-4", "TSS-EB-5", "TSS-C410", "TSS-IN-NOEXT-FALSE"],
    findings=["TSSF-13", "TSSF-18"],
    properties=["ResetEndsAtOnce"],
    slow=True,
)
def a_reset_that_is_asked_for_acts_in_its_call() -> Queries:
    """An active call with an edge of Reset and the sensor free, after one that showed ResetRequest, makes
    S_OSSD_Out TRUE, with a TestTime in its range and, in C410, with NoExternalTest TRUE. In the test error an
    edge with NoExternalTest FALSE leads to 8002.
    """
    yield from JUDGE.in_every_scan(reset_ends_at_once)
    yield JUDGE.without(reset_ends_at_once, "WaitForReset2", "EdgesAreRemembered")

    def whatever_the_sensor(scan: Scanned) -> Obligation:
        given = z3.And(scan.inputs.Activate, edge(scan), scan.sent.ResetRequest)
        return given, z3.And(scan.sends.S_OSSD_Out, TRUE)

    yield JUDGE.too_strong("whatever the sensor is", whatever_the_sensor, "WaitForReset1")


def reset_error_needs_held_reset(scan: Scanned) -> Obligation:
    after = control(SENSOR, scan.after)
    if after not in RESET_ERRORS:
        return None
    i, p = scan.inputs, scan.params
    if scan.was(after):
        return TRUE, z3.And(i.Reset, TRUE)
    held = z3.And(i.Reset, SEEN.reset)
    if after not in OF_A_STATE:
        return TRUE, held
    kept = i.S_StartReset if after == "ResetError1" else z3.And(p.AUTO_RESET_ERRORS, i.S_AutoReset)
    return TRUE, z3.And(held, z3.Not(kept))


@theorem(
    clauses=["TSS-C001", "TSS-C011", "TSS-C021", "TSS-C031", "TSS-C041", "TSS-C051", "TSS-ERR-3"],
    findings=["TSSF-24"],
    properties=["ResetErrorNeedsHeldReset"],
    slow=True,
)
def a_reset_error_is_about_a_reset_that_is_held() -> Queries:
    """A call that shows a reset error finds Reset TRUE; the first one found it TRUE in the call before as
    well. C001 is found only with S_StartReset FALSE, C021 and C031 only where S_AutoReset does not end the
    error by itself.
    """
    yield from JUDGE.in_every_scan(reset_error_needs_held_reset)
    yield JUDGE.without(reset_error_needs_held_reset, "EndExternalTest", "EdgesAreRemembered")

    def without_auto_reset(scan: Scanned) -> Obligation:
        said = reset_error_needs_held_reset(scan)
        return None if said is None else (TRUE, z3.Not(scan.inputs.S_AutoReset))

    yield JUDGE.too_strong("and S_AutoReset is FALSE", without_auto_reset, "WaitForReset1")


def manual_test_is_seen(scan: Scanned) -> Obligation:
    if not scan.was("ExternalFunctionTest"):
        return None
    falls = z3.And(scan.inputs.Activate, SEEN.sensor, z3.Not(scan.inputs.S_OSSD_In))
    return falls, TRUE if scan.becomes("ESPEInterruptedExternalTest") else FALSE


@theorem(
    clauses=["TSS-8002", "TSS-8804", "TSS-IN-NOEXT-FALSE"],
    findings=["TSSF-16"],
    properties=["ManualTestIsSeen"],
    slow=True,
)
def a_manual_test_is_seen_when_it_begins() -> Queries:
    """In 8002 an active call that finds the sensor dark after one that found it free leads to 8804."""
    yield from JUDGE.in_every_scan(manual_test_is_seen)
    yield JUDGE.without(manual_test_is_seen, "ExternalFunctionTest", "EdgesAreRemembered")

    def by_level(scan: Scanned) -> Obligation:
        said = manual_test_is_seen(scan)
        return (
            None if said is None else (z3.And(scan.inputs.Activate, z3.Not(scan.inputs.S_OSSD_In)), said[1])
        )

    yield JUDGE.too_strong("by level", by_level, "ExternalFunctionTest")


def parameter_error_needs_cause(scan: Scanned) -> Obligation:
    if not scan.becomes("ParameterError"):
        return None
    return TRUE, z3.Not(valid(scan.params))


@theorem(
    clauses=["TSS-C000", "TSS-ERR-4", "TSS-IN-TESTTIME"],
    findings=[],
    properties=["ParameterErrorNeedsCause"],
    slow=True,
)
def a_parameter_error_is_about_test_time() -> Queries:
    """C000 is shown only with a TestTime below 0 or above 150 ms."""
    yield from JUDGE.in_every_scan(parameter_error_needs_cause)

    def above(scan: Scanned) -> Obligation:
        return None if not scan.becomes("ParameterError") else (TRUE, scan.params.TestTime_ms > 150)

    yield JUDGE.too_strong("above alone", above, "Init")


def active_at_once(scan: Scanned) -> Obligation:
    return scan.inputs.Activate, z3.And(scan.sends.Ready, TRUE)


@theorem(
    clauses=["TSS-IN-ACTIVATE", "TSS-OUT-READY", "TSS-8401"],
    findings=[],
    properties=["ActiveAtOnce"],
    slow=True,
)
def a_call_with_activate_is_active() -> Queries:
    """Every call with Activate TRUE leaves Ready TRUE."""
    yield from JUDGE.in_every_scan(active_at_once)

    def after_one_more(scan: Scanned) -> Obligation:
        return TRUE, z3.And(scan.sends.Ready, TRUE)

    yield JUDGE.too_strong("without it too", after_one_more, "Idle")
