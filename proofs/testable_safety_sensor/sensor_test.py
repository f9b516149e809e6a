"""The test of the sensor: when it begins, when it fails, and what TestExecuted says.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in
TestableSafetySensorOpen.
"""

from __future__ import annotations

from typing import Final

import z3

from proofs.explorer.device import LOGIC
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, Scans, control
from proofs.sentences import Obligation
from proofs.testable_safety_sensor.invariants import SEEN, TEST_ERRORS, TESTING
from proofs.testable_safety_sensor.sensor_safety import JUDGE, rises
from proofs.theorem import Queries, claim, theorem
from proofs.theorem import control as control_query

POSSIBLE: Final = ("ESPEFreeNoTest", "ESPEFreeTestOk")


def asked_for(scan: Scanned) -> z3.BoolRef:
    """StartTest rises, as an observer of the wires sees it."""
    return z3.And(scan.inputs.StartTest, z3.Not(SEEN.start_test))


def over(scan: Scanned) -> z3.BoolRef:
    """This phase of the test has lasted TestTime, as an observer of the wires counts it."""
    late: z3.BoolRef = SEEN.phase + scan.inputs.dt_ms >= scan.params.TestTime_ms
    return late


# ---------------------------------------------------------------- its start


def test_needs_edge(scan: Scanned) -> Obligation:
    if not scan.becomes("TestRequest") or scan.was("TestRequest"):
        return TRUE, TRUE
    return TRUE, z3.And(scan.sent.TestPossible, asked_for(scan))


@theorem(
    clauses=["TSS-IN-STARTTEST", "TSS-OUT-POSSIBLE", "TSS-NOTE-3", "TSS-NOTE-4", "TSS-TEST-1"],
    findings=["TSSF-23"],
    properties=["TestNeedsEdgeWhilePossible"],
    slow=True,
)
def a_test_begins_only_by_an_edge_while_it_is_possible() -> Queries:
    """A test begins only in a call with an edge of StartTest, after a call that showed TestPossible."""
    yield from JUDGE.in_every_scan(test_needs_edge)
    yield JUDGE.without(test_needs_edge, "ESPEFreeTestOk", "EdgesAreRemembered")

    def never(scan: Scanned) -> Obligation:
        return TRUE, FALSE if scan.becomes("TestRequest") else TRUE

    yield JUDGE.too_strong("never", never, "ESPEFreeNoTest")


def test_starts_at_once(scan: Scanned) -> Obligation:
    if not scan.was(*POSSIBLE):
        return None
    begins = TRUE if scan.becomes("TestRequest") else FALSE
    return z3.And(scan.inputs.Activate, scan.inputs.S_OSSD_In), begins == asked_for(scan)


@theorem(
    clauses=["TSS-TEST-1", "TSS-8010", "TSS-8000"],
    findings=["TSSF-22", "TSSF-23"],
    properties=["TestStartsAtOnce"],
    slow=True,
)
def every_such_edge_starts_a_test() -> Queries:
    """After a call that showed TestPossible, active and with the sensor free, a test begins in exactly those
    calls that have an edge of StartTest.
    """
    yield from JUDGE.in_every_scan(test_starts_at_once)

    def over_a_dark_sensor(scan: Scanned) -> Obligation:
        said = test_starts_at_once(scan)
        return None if said is None else (z3.And(scan.inputs.Activate, TRUE), said[1])

    yield JUDGE.too_strong("also over a dark sensor", over_a_dark_sensor, "ESPEFreeTestOk")


VALUES: Final = (z3.Int("then.elapsed_ms"), z3.Bool("then.start_inhibit"))
OTHER: Final = (z3.Bool("other.StartTest"), z3.Bool("other.start_test_before"))


def _answer(scans: Scans, end: str) -> z3.BoolRef:
    """The call leads to this state, with these values in its memory; edges that it remembers left out."""

    def there(scan: Scanned) -> z3.BoolRef:
        if not scan.becomes(end):
            return FALSE
        after = scan.after
        return z3.And(after.elapsed_ms == VALUES[0], after.start_inhibit == VALUES[1])

    return scans.some(there)


def _without_start_test(scans: Scans, formula: z3.BoolRef) -> z3.BoolRef:
    """The same of a call that differs in StartTest, now and before, and in nothing else."""
    was, now = scans.scan.state.start_test_before.term, scans.scan.inputs.StartTest.term
    changed: z3.BoolRef = z3.substitute(formula, (now, OTHER[0]), (was, OTHER[1]))
    return changed


@theorem(
    clauses=["TSS-IN-STARTTEST", "TSS-OUT-POSSIBLE", "TSS-NOTE-3"],
    findings=["TSSF-23"],
    properties=["TestNeedsEdgeWhilePossible"],
    slow=True,
)
def start_test_has_no_effect_while_no_test_is_possible() -> Queries:
    """From any memory: where TestPossible is FALSE, two calls that differ in StartTest alone, or in what was
    remembered of it, lead to the same state, outputs, time and inhibit.
    """
    for scans in JUDGE.scans():
        ends = dict.fromkeys(control(scan.device, scan.after) for scan in scans.read.values())
        given = {"memory, inputs and parameters in their ranges": scans.scan.premise}
        same = [_answer(scans, end) == _without_start_test(scans, _answer(scans, end)) for end in ends]
        if scans.control not in POSSIBLE:
            yield from claim(f"from {scans.control}", given, z3.And(*same), LOGIC)
        else:
            differs = {**given, "StartTest decides": z3.Not(z3.And(*same))}
            yield control_query(f"control: it decides in {scans.control}", differs, LOGIC)


# ---------------------------------------------------------------- its end


def slow_test_fails(scan: Scanned) -> Obligation:
    if not scan.was(*TESTING):
        return None
    failed = z3.And(scan.sends.Error, z3.Not(scan.sends.S_OSSD_Out), z3.Not(scan.sends.TestExecuted))
    return z3.And(scan.inputs.Activate, over(scan)), failed if scan.becomes(*TEST_ERRORS) else FALSE


@theorem(
    clauses=[
        "TSS-ERR-1",
        "TSS-ERR-2",
        "TSS-FN-4",
        "TSS-FN-6A",
        "TSS-FN-6B",
        "TSS-FN-6C",
        "TSS-EB-1",
        "TSS-CX10",
    ],
    findings=["TSSF-07", "TSSF-08", "TSSF-10"],
    properties=["SlowTestFails"],
    slow=True,
)
def a_test_longer_than_test_time_or_without_reaction_always_fails() -> Queries:
    """For any TestTime and any times between calls: a call that finds that a phase of the test has lasted
    TestTime ends in the test error, with S_OSSD_Out and TestExecuted FALSE, whatever the sensor shows in it.

    A sensor that does not react at all is in this: its phase lasts until then.
    """
    yield from JUDGE.in_every_scan(slow_test_fails)
    yield JUDGE.without(slow_test_fails, "TestActive", "TimeIsThatOfThePhase")

    def a_ms_before(scan: Scanned) -> Obligation:
        said = slow_test_fails(scan)
        early = SEEN.phase + scan.inputs.dt_ms + 1 >= scan.params.TestTime_ms
        return None if said is None else (z3.And(scan.inputs.Activate, early), said[1])

    yield JUDGE.too_strong("a millisecond before", a_ms_before, "TestRequest")


def each_phase_has_its_time(scan: Scanned) -> Obligation:
    if not scan.was(*TESTING):
        return None
    return TRUE, over(scan) if scan.becomes(*TEST_ERRORS) else TRUE


@theorem(
    clauses=["TSS-TEST-0"], findings=["TSSF-06", "TSSF-08"], properties=["EachPhaseHasItsTime"], slow=True
)
def no_other_test_fails() -> Queries:
    """A test fails only in a call that finds that the phase it is in has lasted TestTime."""
    yield from JUDGE.in_every_scan(each_phase_has_its_time)
    yield JUDGE.without(each_phase_has_its_time, "TestRequest", "TimeIsThatOfThePhase")

    def never(scan: Scanned) -> Obligation:
        return None if not scan.was(*TESTING) else (TRUE, FALSE if scan.becomes(*TEST_ERRORS) else TRUE)

    yield JUDGE.too_strong("no test fails", never, "TestActive")


def reaction_is_seen(scan: Scanned) -> Obligation:
    if not scan.was(*TESTING):
        return None
    free = scan.inputs.S_OSSD_In
    waits = free if scan.was("TestRequest") else z3.Not(free)
    goes_on = {"TestRequest": "TestActive", "TestActive": "ESPEFreeTestOk"}[control(scan.device, scan.before)]
    here = z3.And(scan.inputs.Activate, z3.Not(over(scan)))
    if scan.becomes(goes_on):
        return here, z3.Not(waits)
    same = z3.And(waits, scan.after.elapsed_ms == SEEN.phase + scan.inputs.dt_ms)
    return here, same if scan.becomes(control(scan.device, scan.before)) else FALSE


@theorem(
    clauses=["TSS-TEST-2", "TSS-TEST-3", "TSS-FN-5"],
    findings=["TSSF-06"],
    properties=["ReactionIsSeen"],
    slow=True,
)
def a_reaction_in_time_is_seen_at_once() -> Queries:
    """Within TestTime each call of a phase goes on exactly if the sensor has reacted, and otherwise adds its
    time.
    """
    yield from JUDGE.in_every_scan(reaction_is_seen)
    yield JUDGE.without(reaction_is_seen, "TestActive", "TimeIsThatOfThePhase")


def test_executed_is_true(scan: Scanned) -> Obligation:
    if not scan.becomes("ESPEFreeTestOk", "ESPEInterrupted2", "WaitForReset2", "ResetError6"):
        return TRUE, z3.Not(rises(scan, "TestExecuted"))
    if not scan.was("TestActive"):
        return TRUE, z3.Not(rises(scan, "TestExecuted"))
    in_time = z3.And(scan.inputs.S_OSSD_In, z3.Not(over(scan)), SEEN.dark >= 0)
    return TRUE, z3.Implies(rises(scan, "TestExecuted"), in_time)


@theorem(
    clauses=["TSS-OUT-EXECUTED", "TSS-TEST-2", "TSS-TEST-3", "TSS-FN-6C"],
    findings=["TSSF-07"],
    properties=["TestExecutedIsTrue"],
    slow=True,
)
def test_executed_says_the_truth() -> Queries:
    """TestExecuted rises only in a call of the second phase that finds the sensor free before TestTime is
    over, after it was seen dark.
    """
    yield from JUDGE.in_every_scan(test_executed_is_true)
    yield JUDGE.without(test_executed_is_true, "TestActive", "DarkInTheSecondPhase")

    def never(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(rises(scan, "TestExecuted"))

    yield JUDGE.too_strong("never", never, "TestActive")


def test_executed_stays(scan: Scanned) -> Obligation:
    if not scan.was("ESPEFreeTestOk", "ESPEInterrupted2", "WaitForReset2", "ResetError6"):
        return None
    ends = z3.Not(scan.sends.TestExecuted)
    return z3.And(scan.inputs.Activate, scan.sent.TestExecuted), TRUE if scan.becomes(
        "TestRequest"
    ) else z3.Not(ends)


@theorem(
    clauses=["TSS-OUT-EXECUTED", "TSS-8806", "TSS-8406", "TSS-C051"],
    findings=["TSSF-03"],
    properties=["TestExecutedStays"],
    slow=True,
)
def test_executed_stays_until_the_next_test() -> Queries:
    """While the block is active TestExecuted ends only in a call that begins another test."""
    yield from JUDGE.in_every_scan(test_executed_stays)

    def also_inactive(scan: Scanned) -> Obligation:
        said = test_executed_stays(scan)
        return None if said is None else (TRUE, said[1])

    yield JUDGE.too_strong("also without Activate", also_inactive, "WaitForReset2")
