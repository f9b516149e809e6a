"""How errors are found and left, the manual test, and which transitions there are at all.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in
TestableSafetySensorOpen.
"""

from __future__ import annotations

from itertools import product
from typing import Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.sentences import Obligation
from proofs.testable_safety_sensor.devices import SENSOR
from proofs.testable_safety_sensor.invariants import (
    MANUAL,
    PARAMETER_ERRORS,
    RESET_ERRORS,
    SEEN,
    TEST_ERRORS,
    TESTING,
    valid,
)
from proofs.testable_safety_sensor.sensor_safety import JUDGE, automatic, edge, rises
from proofs.theorem import Queries, theorem

WATCHED: Final = {
    "ResetError1": ("Init",),
    "ResetError2": ("WaitForReset1",),
    "ResetError3": ("TestError1C010", "TestError1C410"),
    "ResetError4": ("EndExternalTest",),
    "ResetError5": ("ParameterError",),
    "ResetError6": ("WaitForReset2",),
}
"""Where each reset error is found, and where its end leads back to. TSSF-01, TSSF-02, TSSF-03"""


def static(scan: Scanned) -> z3.BoolRef:
    """Reset is held, as an observer of the wires sees it."""
    return z3.And(scan.inputs.Reset, SEEN.reset)


def code_tells_resettable(scan: Scanned) -> Obligation:
    fits = z3.And(scan.inputs.S_OSSD_In, scan.inputs.NoExternalTest)
    if scan.becomes("TestError1C410"):
        return TRUE, z3.And(fits, scan.sends.DiagCode == 0xC410)
    if scan.becomes("TestError1C010"):
        return TRUE, z3.And(z3.Not(fits), scan.sends.DiagCode == 0xC010)
    return TRUE, TRUE


@theorem(
    clauses=["TSS-CX10", "TSS-C410", "TSS-C010"],
    findings=["TSSF-17"],
    properties=["CodeTellsResettable"],
    slow=True,
)
def c410_is_shown_exactly_with_the_sensor_free_and_no_manual_test() -> Queries:
    """Every call that ends in the test error shows C410 if S_OSSD_In and NoExternalTest are TRUE in it, and
    C010 otherwise.
    """
    yield from JUDGE.in_every_scan(code_tells_resettable)

    def as_before(scan: Scanned) -> Obligation:
        return TRUE, TRUE if scan.becomes("TestError1C010", "ResetError3", "Idle") else FALSE

    yield JUDGE.too_strong("it stays as it was", as_before, "TestError1C010")


def error_left_only_as_documented(scan: Scanned) -> Obligation:
    before, after = control(SENSOR, scan.before), control(SENSOR, scan.after)
    if before not in TEST_ERRORS | RESET_ERRORS | PARAMETER_ERRORS:
        return None
    if before == after:
        return scan.inputs.Activate, TRUE
    if before in RESET_ERRORS:
        return scan.inputs.Activate, z3.Not(scan.inputs.Reset) if after in WATCHED[before] else FALSE
    if after in RESET_ERRORS:
        return scan.inputs.Activate, static(scan) if before in WATCHED[after] else FALSE
    if before not in TEST_ERRORS:
        return scan.inputs.Activate, FALSE
    by_itself = z3.And(scan.params.AUTO_RESET_ERRORS, scan.inputs.S_AutoReset)
    return scan.inputs.Activate, TRUE if after in TEST_ERRORS else z3.Or(edge(scan), by_itself)


@theorem(
    clauses=["TSS-EB-1", "TSS-EB-2", "TSS-ERR-3", "TSS-C000"],
    findings=["TSSF-12", "TSSF-13", "TSSF-15", "TSSF-24"],
    properties=["ErrorLeftOnlyAsDocumented"],
    slow=True,
)
def errors_are_left_only_as_documented() -> Queries:
    """While the block is active: a test error is left by an edge of Reset, or for the reset error of a static
    one; a reset error only when Reset is FALSE, to where it was found; a parameter error for its reset error
    alone.
    """
    yield from JUDGE.in_every_scan(error_left_only_as_documented)
    yield JUDGE.without(error_left_only_as_documented, "TestError1C410", "EdgesAreRemembered")

    def never(scan: Scanned) -> Obligation:
        return scan.inputs.Activate, z3.And(scan.sends.Error, TRUE)

    yield JUDGE.too_strong("no error is left", never, "ResetError6")


def kept(scan: Scanned, state: str) -> z3.BoolRef:
    """The inhibit, or the error, of this very state is kept in this call."""
    i, p = scan.inputs, scan.params
    if state == "Init":
        return z3.And(z3.Not(i.S_StartReset), valid(p))
    if state == "WaitForReset1":
        return z3.Or(z3.Not(i.S_AutoReset), scan.before.start_inhibit)
    if state == "WaitForReset2":
        return z3.Not(i.S_AutoReset)
    return TRUE if state in PARAMETER_ERRORS else z3.Not(z3.And(p.AUTO_RESET_ERRORS, i.S_AutoReset))


def static_reset_is_found(scan: Scanned) -> Obligation:
    before, after = control(SENSOR, scan.before), control(SENSOR, scan.after)
    found = [error for error, states in WATCHED.items() if before in states]
    if not found:
        return None
    given = z3.And(scan.inputs.Activate, static(scan), kept(scan, before))
    return given, TRUE if after in found else FALSE


@theorem(
    clauses=[
        "TSS-ERR-3",
        "TSS-IN-RESET",
        "TSS-C001",
        "TSS-C011",
        "TSS-C021",
        "TSS-C031",
        "TSS-C041",
        "TSS-C051",
    ],
    findings=["TSSF-01", "TSSF-02", "TSSF-03", "TSSF-24"],
    properties=["StaticResetIsFound"],
    slow=True,
)
def a_static_reset_is_found_wherever_a_reset_is_waited_for() -> Queries:
    """A Reset that was TRUE in the call before and still is leads to the reset error of the state, wherever
    the inhibit or error of that very state is kept: in Init (with a valid TestTime), both waits, the test
    error, the end of the manual test and the parameter error.
    """
    yield from JUDGE.in_every_scan(static_reset_is_found)
    yield JUDGE.without(static_reset_is_found, "EndExternalTest", "EdgesAreRemembered")

    def whatever_the_constants(scan: Scanned) -> Obligation:
        said = static_reset_is_found(scan)
        return None if said is None else (z3.And(scan.inputs.Activate, static(scan)), said[1])

    yield JUDGE.too_strong("whatever the constants", whatever_the_constants, "WaitForReset2")


def a_held_reset_never_resets(scan: Scanned) -> Obligation:
    return z3.And(static(scan), z3.Not(automatic(scan))), z3.Not(rises(scan, "S_OSSD_Out"))


@theorem(
    clauses=["TSS-ERR-3", "TSS-EB-3", "TSS-REL-1"],
    findings=["TSSF-24"],
    properties=["NoRestartByItself"],
    slow=True,
)
def a_static_reset_never_resets() -> Queries:
    """No call in which Reset is held makes S_OSSD_Out TRUE, unless the inhibit of that very state is switched
    off.
    """
    yield from JUDGE.in_every_scan(a_held_reset_never_resets)
    yield JUDGE.without(a_held_reset_never_resets, "WaitForReset1", "EdgesAreRemembered")


def reset_error_keeps_test_executed(scan: Scanned) -> Obligation:
    before, after = control(SENSOR, scan.before), control(SENSOR, scan.after)
    if after not in RESET_ERRORS:
        return None
    same = scan.sends.TestExecuted == scan.sent.TestExecuted
    return TRUE, same if before in (*WATCHED[after], after) else FALSE


@theorem(
    clauses=["TSS-C051", "TSS-OUT-EXECUTED"],
    findings=["TSSF-02", "TSSF-03"],
    properties=["ResetErrorKeepsTestExecuted"],
    slow=True,
)
def a_reset_error_keeps_the_result_of_the_test() -> Queries:
    """A reset error is reached from the state that it belongs to, and TestExecuted stays as it was."""
    yield from JUDGE.in_every_scan(reset_error_keeps_test_executed)

    def without_a_result(scan: Scanned) -> Obligation:
        said = reset_error_keeps_test_executed(scan)
        return None if said is None else (TRUE, z3.Not(scan.sends.TestExecuted))

    yield JUDGE.too_strong("and there is none", without_a_result, "WaitForReset2")


def external_test_is_complete(scan: Scanned) -> Obligation:
    if scan.was(*TEST_ERRORS):
        if scan.becomes(*MANUAL):
            return TRUE, z3.Not(scan.inputs.NoExternalTest)
        return TRUE, z3.Implies(rises(scan, "S_OSSD_Out"), scan.inputs.NoExternalTest)
    if not scan.was(*MANUAL):
        return None
    complete = SEEN.cycle == 3 if scan.was("EndExternalTest") else FALSE
    return TRUE, z3.Implies(rises(scan, "S_OSSD_Out"), complete)


@theorem(
    clauses=["TSS-IN-NOEXT-FALSE", "TSS-IN-NOEXT-TRUE", "TSS-8002", "TSS-8804", "TSS-8404"],
    findings=["TSSF-14", "TSSF-16"],
    properties=["ExternalTestIsComplete"],
    slow=True,
)
def after_a_failed_test_the_manual_test_is_complete_or_there_is_none() -> Queries:
    """While Activate stays, after a failed test S_OSSD_Out rises only with NoExternalTest TRUE, or at the end
    of a manual test in which the sensor was seen free, then dark, then free; a manual test begins only with
    NoExternalTest FALSE.
    """
    yield from JUDGE.in_every_scan(external_test_is_complete)
    yield JUDGE.without(external_test_is_complete, "EndExternalTest", "CycleOfTheManualTest")

    def always_a_manual_one(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(rises(scan, "S_OSSD_Out"))

    yield JUDGE.too_strong("always a manual one", always_a_manual_one, "TestError1C410")


def parameter_error_stays(scan: Scanned) -> Obligation:
    shows = TRUE if scan.was("Idle", "ResetError1") else z3.And(scan.sends.Error, TRUE)
    return z3.And(z3.Not(valid(scan.params)), scan.inputs.Activate), z3.And(
        z3.Not(scan.sends.S_OSSD_Out), shows
    )


def _refusable(scan: Scanned) -> Obligation:
    """Asked where a TestTime out of its range can be met at all."""
    return parameter_error_stays(scan) if scan.was("Idle", "Init", *PARAMETER_ERRORS) else None


@theorem(
    clauses=["TSS-C000", "TSS-ERR-4", "TSS-IN-TESTTIME"],
    findings=["TSSF-11", "TSSF-12"],
    properties=["ParameterErrorStays"],
    slow=True,
)
def a_test_time_out_of_its_range_never_enables() -> Queries:
    """For every TestTime below 0 or above 150 ms, also those that no real one can be: S_OSSD_Out is never
    TRUE, and an active block shows an error from its second call on.

    By the invariant it is met in Idle, Init, the parameter error and its reset error alone.
    """
    yield from JUDGE.in_every_scan(_refusable)

    def whatever_test_time_is(scan: Scanned) -> Obligation:
        return scan.inputs.Activate, z3.And(scan.sends.Error, TRUE)

    yield JUDGE.too_strong("whatever TestTime is", whatever_test_time_is, "Init")


TRANSITIONS: Final = frozenset(
    {
        ("Idle", "Init"),
        *product(("Init",), ("ParameterError", "ResetError1", "ESPEInterrupted1", "ESPEFreeNoTest")),
        *product(("ESPEInterrupted1",), ("WaitForReset1", "ESPEFreeNoTest")),
        *product(("WaitForReset1",), ("ResetError2", "ESPEInterrupted1", "ESPEFreeNoTest")),
        *product(("ESPEFreeNoTest",), ("ESPEInterrupted1", "TestRequest")),
        *product(("ESPEFreeTestOk",), ("ESPEInterrupted2", "TestRequest")),
        *product(("ESPEInterrupted2",), ("WaitForReset2", "ESPEFreeTestOk")),
        *product(("WaitForReset2",), ("ResetError6", "ESPEInterrupted2", "ESPEFreeTestOk")),
        ("TestRequest", "TestActive"),
        ("TestActive", "ESPEFreeTestOk"),
        *product(TESTING, TEST_ERRORS),
        *product(TEST_ERRORS, (*TEST_ERRORS, "ResetError3", "ExternalFunctionTest")),
        ("TestError1C410", "ESPEFreeNoTest"),
        ("ExternalFunctionTest", "ESPEInterruptedExternalTest"),
        ("ESPEInterruptedExternalTest", "EndExternalTest"),
        *product(("EndExternalTest",), ("ResetError4", "ESPEInterruptedExternalTest", "ESPEFreeNoTest")),
        ("ParameterError", "ResetError5"),
        *((error, state) for error, states in WATCHED.items() for state in states),
        *((state, "Idle") for state in SENSOR.register.states),
        *((state, state) for state in SENSOR.register.states),
    }
)
"""Every pair of states that a call may join."""


def one_transition(scan: Scanned) -> Obligation:
    pair = control(SENSOR, scan.before), control(SENSOR, scan.after)
    return TRUE, TRUE if pair in TRANSITIONS else FALSE


@theorem(clauses=["TSS-OUT-DIAG"], findings=["TSSF-27"], properties=["OneTransitionPerCall"], slow=True)
def every_call_takes_one_of_the_listed_transitions_or_stays() -> Queries:
    """From every state every call stays, or takes one of the listed transitions."""
    yield from JUDGE.in_every_scan(one_transition)

    def stays(scan: Scanned) -> Obligation:
        return TRUE, TRUE if scan.becomes(control(SENSOR, scan.before)) else FALSE

    yield JUDGE.too_strong("it stays", stays, "Idle")
