"""The invariant of the block, and when its enable output may be TRUE, or become so.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in
TestableSafetySensorOpen.
"""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.device import LOGIC
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.sentences import Judge, Obligation, Sentence
from proofs.testable_safety_sensor.devices import SENSOR
from proofs.testable_safety_sensor.invariants import (
    MANUAL,
    NOTHING,
    SEEN,
    SENSOR_INVARIANT,
    TEST_ERRORS,
    sees,
    valid,
)
from proofs.theorem import Queries, claim, theorem
from proofs.theorem import control as control_query

JUDGE: Final = Judge(SENSOR, SENSOR_INVARIANT, SEEN, sees, NOTHING)


@theorem(
    clauses=["TSS-IN-RESET", "TSS-IN-STARTTEST", "TSS-TEST-0", "TSS-FN-3", "TSS-8002", "TSS-C000"],
    findings=["TSSF-19", "TSSF-16"],
    slow=True,
)
def every_call_of_the_block_keeps_its_invariant() -> Queries:
    """The invariant of the block is true at power-up, and every call keeps it, with any inputs, times and
    TestTime.
    """
    yield from JUDGE.initiation()
    yield from JUDGE.consecution()


@theorem(
    clauses=["TSS-IN-RESET", "TSS-IN-STARTTEST"],
    findings=["TSSF-24"],
    properties=["EdgesAreRemembered"],
    slow=True,
)
def the_block_remembers_the_inputs_of_every_call() -> Queries:
    """After every call, active or not, what the block remembers of Reset, StartTest and S_OSSD_In is what
    stood there in that call.
    """

    def remembered(scan: Scanned) -> Obligation:
        s, i = scan.after, scan.inputs
        kept = (s.reset_before == i.Reset, s.start_test_before == i.StartTest, s.sensor_before == i.S_OSSD_In)
        return TRUE, z3.And(*kept)

    yield from JUDGE.in_every_scan(remembered)

    def only_while_active(scan: Scanned) -> Obligation:
        return TRUE, scan.after.reset_before == z3.And(scan.inputs.Reset, scan.inputs.Activate)

    yield JUDGE.too_strong("only while active", only_while_active, "Idle")


# ---------------------------------------------------------------- TRUE


def enable_needs_free_sensor(scan: Scanned) -> Obligation:
    dark = z3.And(scan.sends.S_OSSD_Out, z3.Not(scan.inputs.S_OSSD_In))
    return TRUE, TRUE if scan.becomes("TestActive") else z3.Not(dark)


@theorem(
    clauses=["TSS-IN-OSSD", "TSS-FN-1", "TSS-FN-5", "TSS-OUT-OSSD"],
    findings=["TSSF-09", "TSSF-21", "TSSF-22"],
    properties=["EnableNeedsFreeSensor"],
    slow=True,
)
def the_block_enables_over_a_dark_sensor_in_the_second_phase_of_a_test_only() -> Queries:
    """After every call that finds the sensor dark S_OSSD_Out is FALSE, unless it leads to, or stays in, the
    second phase of a test.
    """
    yield from JUDGE.in_every_scan(enable_needs_free_sensor)

    def nor_there(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(z3.And(scan.sends.S_OSSD_Out, z3.Not(scan.inputs.S_OSSD_In)))

    yield JUDGE.too_strong("nor there", nor_there, "TestRequest")


def masked_time_is_bounded(scan: Scanned, seen: Any) -> z3.BoolRef:
    p = scan.params
    dark = z3.Or(seen.dark < 0, seen.dark < p.TestTime_ms)
    tested = z3.Or(seen.tested <= 0, seen.tested < 2 * p.TestTime_ms)
    return z3.And(dark, tested)


@theorem(
    clauses=["TSS-TEST-0", "TSS-FN-7"],
    findings=["TSSF-06", "TSSF-08", "TSSF-09"],
    properties=["MaskedTimeIsBounded"],
    slow=True,
)
def a_test_masks_the_sensor_for_less_than_test_time() -> Queries:
    """For any TestTime and any times between calls: after every call that leaves S_OSSD_Out TRUE over a dark
    sensor less than TestTime has passed since the call that first saw it dark, and less than twice TestTime
    since the test began.
    """
    yield from JUDGE.after_every_scan(masked_time_is_bounded)
    sentence = JUDGE.after_a_scan(masked_time_is_bounded)
    yield JUDGE.without(sentence, "TestActive", "DarkInTheSecondPhase")
    yield JUDGE.without(sentence, "TestActive", "TestedWithinBoth")

    def half(scan: Scanned) -> Obligation:
        seen = JUDGE.sees(scan)
        return TRUE, z3.Or(seen.dark < 0, 2 * seen.dark <= scan.params.TestTime_ms)

    yield JUDGE.too_strong("for half of it", half, "TestActive")

    def once(scan: Scanned) -> Obligation:
        return TRUE, z3.Or(JUDGE.sees(scan).tested <= 0, JUDGE.sees(scan).tested <= scan.params.TestTime_ms)

    yield JUDGE.too_strong("a test lasts TestTime at most", once, "TestActive")


def sender_off_bounded(scan: Scanned, seen: Any) -> z3.BoolRef:
    if not scan.becomes("TestRequest"):
        return z3.And(scan.sends.S_TestOut, TRUE)
    return z3.Or(seen.phase == 0, seen.phase < scan.params.TestTime_ms)


@theorem(
    clauses=["TSS-FN-7", "TSS-OUT-TESTOUT", "TSS-NOTE-1"],
    findings=["TSSF-06"],
    properties=["SenderOffIsBounded"],
    slow=True,
)
def the_sender_is_off_for_less_than_test_time_and_one_call() -> Queries:
    """After every call that leaves S_TestOut FALSE less than TestTime has passed since the call that made it
    so; the first call that finds TestTime over makes it TRUE.

    So it is off for less than TestTime and the time of one call: at most 150 ms only if both together are
    (TSSA-10).
    """
    yield from JUDGE.after_every_scan(sender_off_bounded)
    yield JUDGE.without(JUDGE.after_a_scan(sender_off_bounded), "TestRequest", "TimeIsThatOfThePhase")


def latency(scan: Scanned) -> Obligation:
    """A call over a dark sensor that ends the output, and how long ago the sensor was first seen dark."""
    if not scan.was("ESPEFreeNoTest", "ESPEFreeTestOk", "TestRequest", "TestActive"):
        return None
    falls = z3.And(scan.sent.S_OSSD_Out, z3.Not(scan.sends.S_OSSD_Out), scan.inputs.Activate)
    since = z3.If(SEEN.dark < 0, 0, SEEN.dark + scan.inputs.dt_ms)
    bound = z3.If(SEEN.dark < 0, since == 0, since < scan.params.TestTime_ms + scan.inputs.dt_ms)
    return z3.And(falls, z3.Not(scan.inputs.S_OSSD_In)), bound


@theorem(clauses=["TSS-NOTE-1", "TSS-FN-7", "TSS-OUT-OSSD"], findings=["TSSF-09"], slow=True)
def a_person_in_the_field_is_answered_within_test_time_and_one_call() -> Queries:
    """Who makes the sensor dark and stays: outside a test S_OSSD_Out falls in the first call that sees it;
    in a test it falls less than TestTime, and the time of one call, after the call that first saw it.

    From the field to that first call another cycle can pass. So the longest delay is below TestTime and two
    cycles, and it is the sensor that is dark in the second phase that has it.
    """
    yield from JUDGE.in_every_scan(latency)

    def within_test_time(scan: Scanned) -> Obligation:
        said = latency(scan)
        return None if said is None else (said[0], SEEN.dark + scan.inputs.dt_ms < scan.params.TestTime_ms)

    yield JUDGE.too_strong("within TestTime", within_test_time, "TestActive")

    def stays_dark(scan: Scanned) -> Obligation:
        """The sensor is still dark TestTime after it was first seen so."""
        late = z3.And(SEEN.dark >= 0, SEEN.dark + scan.inputs.dt_ms >= scan.params.TestTime_ms)
        return z3.And(late, z3.Not(scan.inputs.S_OSSD_In)), z3.Not(scan.sends.S_OSSD_Out)

    for scans in JUDGE.scans():
        if scans.control == "TestActive":
            spoken = {"it is spoken of": scans.some(lambda scan: (stays_dark(scan) or (FALSE, TRUE))[0])}
            then = scans.always(lambda scan: z3.Implies(*(stays_dark(scan) or (FALSE, TRUE))))
            yield from claim("still dark at TestTime", {**JUDGE.premises(scans), **spoken}, then, LOGIC)


def a_short_demand(scan: Scanned) -> z3.BoolRef:
    """Somebody leaves the field in this call, and the output has been TRUE all the time."""
    return z3.And(SEEN.dark > 0, scan.inputs.S_OSSD_In, scan.sends.S_OSSD_Out, scan.sends.TestExecuted)


@theorem(clauses=["TSS-FN-1", "TSS-TEST-3", "TSS-OUT-EXECUTED"], findings=["TSSF-09"], slow=True)
def a_demand_that_begins_and_ends_in_a_test_is_only_seen_as_the_test() -> Queries:
    """A sensor that became dark in a test, by the test or by a person, and is free again within TestTime
    leaves S_OSSD_Out TRUE and TestExecuted TRUE: no output shows which it was.
    """

    def passes(scan: Scanned) -> Obligation:
        if not scan.was("TestActive"):
            return None
        in_time = SEEN.dark + scan.inputs.dt_ms < scan.params.TestTime_ms
        given = z3.And(scan.inputs.Activate, scan.inputs.S_OSSD_In, in_time)
        return given, z3.And(scan.sends.S_OSSD_Out, scan.sends.TestExecuted, z3.Not(scan.sends.SafetyDemand))

    yield from JUDGE.in_every_scan(passes)
    scans = JUDGE.begin("TestActive")
    example = {**JUDGE.premises(scans), "somebody was there": scans.some(a_short_demand)}
    yield control_query("control: it happens", example, LOGIC)


def inactive_at_once(scan: Scanned) -> Obligation:
    off = z3.Not(scan.sends.S_OSSD_Out) if scan.becomes("Idle") else FALSE
    return z3.Not(scan.inputs.Activate), off


@theorem(clauses=["TSS-IN-ACTIVATE", "TSS-0000"], findings=[], properties=["InactiveAtOnce"], slow=True)
def without_activate_the_call_ends_in_idle() -> Queries:
    """Every call without Activate, from any state, ends in Idle, with S_OSSD_Out FALSE."""
    yield from JUDGE.in_every_scan(inactive_at_once)

    def always(scan: Scanned) -> Obligation:
        return TRUE, TRUE if scan.becomes("Idle") else FALSE

    yield JUDGE.too_strong("and every other", always, "Idle")


# ---------------------------------------------------------------- becoming TRUE


def edge(scan: Scanned) -> z3.BoolRef:
    """Reset rises, as an observer of the wires sees it."""
    return z3.And(scan.inputs.Reset, z3.Not(SEEN.reset))


def rises(scan: Scanned, name: str) -> z3.BoolRef:
    """This output becomes TRUE in the call."""
    return z3.And(z3.Not(getattr(scan.sent, name)), getattr(scan.sends, name))


def automatic(scan: Scanned) -> z3.BoolRef:
    """The constants switch off the inhibit of this state."""
    i = scan.inputs
    if scan.was("Init"):
        return z3.And(i.S_StartReset, TRUE)
    if scan.was("ESPEInterrupted1", "WaitForReset1", "ESPEInterrupted2", "WaitForReset2"):
        return z3.And(i.S_AutoReset, TRUE)
    if scan.was(*TEST_ERRORS, *MANUAL):
        return z3.And(i.S_AutoReset, scan.params.AUTO_RESET_ERRORS)
    return FALSE


def no_restart_by_itself(scan: Scanned) -> Obligation:
    given = z3.And(scan.inputs.Activate, scan.inputs.S_OSSD_In)
    return rises(scan, "S_OSSD_Out"), z3.And(given, z3.Or(edge(scan), automatic(scan)))


def _spoken(sentence: Sentence) -> Sentence:
    """Not asked of paths that cannot enable."""

    def of(scan: Scanned) -> Obligation:
        said = sentence(scan)
        return None if said is None or z3.is_false(z3.simplify(said[0])) else said

    return of


@theorem(
    clauses=[
        "TSS-REL-1",
        "TSS-FN-2",
        "TSS-FN-3",
        "TSS-EB-3",
        "TSS-EB-4",
        "TSS-EB-5",
        "TSS-IN-STARTRESET",
        "TSS-IN-AUTORESET",
    ],
    findings=["TSSF-15", "TSSF-24"],
    properties=["NoRestartByItself"],
    slow=True,
)
def the_block_never_enables_by_itself() -> Queries:
    """S_OSSD_Out rises only in a call with Activate and the sensor free, and with an edge of Reset, or where
    S_StartReset, or S_AutoReset, switches off the inhibit of that very state; S_AutoReset after a failed test
    only with AUTO_RESET_ERRORS.
    """
    yield from JUDGE.in_every_scan(_spoken(no_restart_by_itself))
    yield JUDGE.without(_spoken(no_restart_by_itself), "WaitForReset1", "EdgesAreRemembered")

    def always_an_edge(scan: Scanned) -> Obligation:
        return rises(scan, "S_OSSD_Out"), edge(scan)

    yield JUDGE.too_strong("always by an edge", _spoken(always_an_edge), "ESPEInterrupted2")


def failed_test_needs_reset(scan: Scanned) -> Obligation:
    if not scan.was(*TEST_ERRORS, *MANUAL):
        return None
    return z3.And(rises(scan, "S_OSSD_Out"), z3.Not(scan.params.AUTO_RESET_ERRORS)), edge(scan)


@theorem(
    clauses=["TSS-EB-2", "TSS-EB-3", "TSS-IN-NOEXT-FALSE"],
    findings=["TSSF-15"],
    properties=["FailedTestNeedsReset"],
    slow=True,
)
def after_a_failed_test_only_a_reset_enables() -> Queries:
    """With AUTO_RESET_ERRORS FALSE, S_OSSD_Out rises from a test error or from the manual test only in a call
    with an edge of Reset, whatever S_AutoReset is.
    """
    yield from JUDGE.in_every_scan(_spoken(failed_test_needs_reset))

    def with_the_other_value(scan: Scanned) -> Obligation:
        return rises(scan, "S_OSSD_Out"), edge(scan)

    yield JUDGE.too_strong("with AUTO_RESET_ERRORS too", _spoken(with_the_other_value), "TestError1C410")


def start_inhibit_holds(scan: Scanned) -> Obligation:
    off = z3.And(scan.inputs.S_StartReset, TRUE) if scan.was("Init") else FALSE
    return TRUE, z3.Implies(z3.And(rises(scan, "S_OSSD_Out"), SEEN.starting), z3.Or(edge(scan), off))


@theorem(clauses=["TSS-FN-3", "TSS-EB-5"], findings=["TSSF-19"], properties=["StartInhibitHolds"], slow=True)
def the_start_up_inhibit_outlives_an_interruption() -> Queries:
    """The first enable after an activation needs an edge of Reset, unless S_StartReset is TRUE when the
    sensor is first judged; a sensor that is dark then, and S_AutoReset, change nothing in this.
    """
    yield from JUDGE.in_every_scan(start_inhibit_holds)
    yield JUDGE.without(start_inhibit_holds, "ESPEInterrupted1", "StartInhibitPending")
    yield JUDGE.without(start_inhibit_holds, "ESPEInterrupted2", "StartInhibitPending")


def switched_off_inhibit_ends(scan: Scanned) -> Obligation:
    i, p, out = scan.inputs, scan.params, z3.And(scan.sends.S_OSSD_Out, TRUE)
    free = z3.And(i.Activate, i.S_OSSD_In)
    if scan.was("Init"):
        return z3.And(free, i.S_StartReset, valid(p)), out
    if scan.was("ESPEInterrupted1"):
        return z3.And(free, i.S_AutoReset, z3.Not(scan.before.start_inhibit)), out
    if scan.was("ESPEInterrupted2"):
        return z3.And(free, i.S_AutoReset), out
    by_itself = z3.And(free, i.S_AutoReset, p.AUTO_RESET_ERRORS)
    manual = TRUE if scan.becomes("ExternalFunctionTest") else FALSE
    if scan.was("TestError1C410"):
        return by_itself, z3.If(i.NoExternalTest, out, manual)
    if scan.was("TestError1C010"):
        return z3.And(by_itself, z3.Not(i.NoExternalTest)), manual
    return (by_itself, out) if scan.was("EndExternalTest") else None


@theorem(
    clauses=["TSS-IN-STARTRESET", "TSS-IN-AUTORESET", "TSS-FN-2", "TSS-EB-3"],
    findings=["TSSF-15", "TSSF-19"],
    properties=["SwitchedOffInhibitEnds"],
    slow=True,
)
def an_inhibit_that_is_switched_off_is_not_waited_for() -> Queries:
    """With the sensor free an active call enables from Init with S_StartReset and a valid TestTime, and from
    an interruption with S_AutoReset and no start-up inhibit left, whatever Reset is; with AUTO_RESET_ERRORS
    S_AutoReset ends the manual test too, and a test error, by enabling or by asking for the manual test.
    """
    yield from JUDGE.in_every_scan(switched_off_inhibit_ends)

    def with_the_other_value_too(scan: Scanned) -> Obligation:
        given = z3.And(scan.inputs.Activate, scan.inputs.S_OSSD_In, scan.inputs.S_AutoReset)
        return given, z3.And(scan.sends.S_OSSD_Out, TRUE)

    yield JUDGE.too_strong("without AUTO_RESET_ERRORS", with_the_other_value_too, "EndExternalTest")


def reset_only_where_requested(scan: Scanned) -> Obligation:
    kept = z3.Not(z3.Or(scan.inputs.S_StartReset, scan.inputs.S_AutoReset))
    return kept, z3.Implies(rises(scan, "S_OSSD_Out"), scan.sent.ResetRequest)


@theorem(
    clauses=["TSS-OUT-REQUEST", "TSS-C410"],
    findings=["TSSF-18"],
    properties=["ResetOnlyWhereRequested"],
    slow=True,
)
def a_reset_enables_only_where_it_was_asked_for() -> Queries:
    """With S_StartReset and S_AutoReset FALSE, S_OSSD_Out rises only in a call after one that showed
    ResetRequest.
    """
    yield from JUDGE.in_every_scan(reset_only_where_requested)

    def whatever_the_constants(scan: Scanned) -> Obligation:
        return rises(scan, "S_OSSD_Out"), z3.And(scan.sent.ResetRequest, TRUE)

    yield JUDGE.too_strong("whatever the constants", _spoken(whatever_the_constants), "ESPEInterrupted1")


def demand_is_shown(scan: Scanned) -> Obligation:
    judged = ("ESPEFreeNoTest", "ESPEFreeTestOk", "WaitForReset1", "WaitForReset2", "Init", "EndExternalTest")
    still = ("ESPEInterrupted1", "ESPEInterrupted2", "ESPEInterruptedExternalTest")
    if not scan.was(*judged, *still):
        return None
    lost = z3.And(scan.inputs.Activate, z3.Not(scan.inputs.S_OSSD_In))
    return lost, z3.Or(scan.sends.SafetyDemand, scan.sends.Error)


@theorem(
    clauses=["TSS-8802", "TSS-8804", "TSS-8806", "TSS-OUT-DEMAND", "TSS-OUT-OSSD"],
    findings=["TSSF-31"],
    properties=["DemandIsShown"],
    slow=True,
)
def a_lost_sensor_is_shown_at_once() -> Queries:
    """Where the sensor was free, or is judged for the first time, and no test runs, a call that finds it dark
    shows SafetyDemand or an error; where it was interrupted, every call that finds it still dark does.
    """
    yield from JUDGE.in_every_scan(demand_is_shown)

    def as_a_demand(scan: Scanned) -> Obligation:
        said = demand_is_shown(scan)
        return None if said is None else (said[0], z3.And(scan.sends.SafetyDemand, TRUE))

    yield JUDGE.too_strong("always as a demand", as_a_demand, "WaitForReset2")
