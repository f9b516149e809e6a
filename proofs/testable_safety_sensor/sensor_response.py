"""How soon the block enables again once the machine is served, and how soon a test is passed.

Served means, in every call: the block is active; the sensor answers its test and is free otherwise, but is
interrupted once where the manual test waits for it; Reset is pressed, and released again, where the block
shows ResetRequest or an error; NoExternalTest stays as it is. In a test the call comes before TestTime is
over (TSSA-03). The block may have any memory whatever, reachable or not.
"""

from __future__ import annotations

from typing import Any, Final

import z3

from modeproof.registers import Response
from proofs.explorer.device import LOGIC
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control, memory
from proofs.responses import needs_all
from proofs.sentences import Judge, Obligation
from proofs.testable_safety_sensor.devices import SENSOR
from proofs.testable_safety_sensor.invariants import PARAMETER_ERRORS, TESTING, valid
from proofs.theorem import Queries, claim, theorem

JUDGE: Final = Judge(SENSOR, ())
MANUAL_TEST: Final = z3.Not(z3.Bool("served.NoExternalTest"))
"""There is a manual test: what NoExternalTest stays at."""
ENABLED: Final = frozenset({"ESPEFreeNoTest", "ESPEFreeTestOk", *TESTING})


def served(scan: Scanned) -> z3.BoolRef:
    """The call of a machine that is served."""
    i, s, c = scan.inputs, scan.before, control(SENSOR, scan.before)
    dark = TRUE if c == "TestRequest" else s.sensor_before if c == "ExternalFunctionTest" else FALSE
    asked = z3.Or(scan.sent.ResetRequest, scan.sent.Error)
    in_time = s.elapsed_ms + i.dt_ms < scan.params.TestTime_ms if c in TESTING else TRUE
    return z3.And(
        i.Activate,
        i.S_OSSD_In == z3.Not(dark),
        i.Reset == z3.And(asked, z3.Not(s.reset_before)),
        i.NoExternalTest == z3.Not(MANUAL_TEST),
        valid(scan.params),
        in_time,
    )


def _pressed(s: Any, first: int, then: int) -> z3.ArithRef:
    """The first where Reset can be pressed in the next call, the second where it is to be released before."""
    return z3.If(s.reset_before, z3.IntVal(then), z3.IntVal(first))


def calls_left(c: str, s: Any) -> z3.ArithRef:
    """How many calls of a served machine lead to the enable, at most."""
    if c in ENABLED:
        return z3.IntVal(0)
    if c in ("Init", "WaitForReset1", "WaitForReset2", "EndExternalTest"):
        return _pressed(s, 1, 2)
    if c in ("Idle", "ESPEInterrupted1", "ESPEInterrupted2", "ESPEInterruptedExternalTest"):
        return z3.IntVal(2)
    if c == "ExternalFunctionTest":
        return z3.If(s.sensor_before, z3.IntVal(3), z3.IntVal(4))
    if c == "TestError1C410":
        return z3.If(MANUAL_TEST, _pressed(s, 4, 5), _pressed(s, 1, 2))
    if c == "TestError1C010":
        return z3.If(MANUAL_TEST, _pressed(s, 4, 5), _pressed(s, 3, 2))
    if c == "ResetError3":
        return z3.If(MANUAL_TEST, _pressed(s, 6, 5), _pressed(s, 3, 2))
    return _pressed(s, 3, 2)


def comes_closer(scan: Scanned) -> Obligation:
    """A served call leaves a call less, or the block enables and goes on to."""
    if scan.was(*PARAMETER_ERRORS):
        return None
    left = calls_left(control(SENSOR, scan.after), scan.after)
    if scan.was(*ENABLED):
        return served(scan), left == 0
    return served(scan), left + 1 <= calls_left(control(SENSOR, scan.before), scan.before)


@theorem(
    clauses=[
        "TSS-EB-2",
        "TSS-EB-4",
        "TSS-EB-5",
        "TSS-IN-NOEXT-FALSE",
        "TSS-IN-NOEXT-TRUE",
        "TSS-8404",
        "TSS-FN-5",
    ],
    findings=["TSSF-12", "TSSF-13", "TSSF-15", "TSSF-16"],
    properties=["EnablesAgain"],
    responses=["TSSR-05"],
    slow=True,
)
def a_served_block_enables_within_six_calls_and_goes_on_to(row: Response) -> Queries:
    """With a valid TestTime, from any memory and in every state but the parameter errors: S_OSSD_Out is TRUE
    after at most six calls of a machine that is served, and stays so through every test.

    A number that is 6 at most, and 0 exactly while the output is TRUE, shrinks in each of them. Six are for
    where a static Reset was found at a failed test and a manual test is to be made.
    """
    yield from JUDGE.in_every_scan(comes_closer)

    def left_before(scan: Scanned, before: bool) -> z3.ArithRef:
        return calls_left(control(SENSOR, scan.before), scan.before)

    yield needs_all(JUDGE, row, left_before)
    for scans in JUDGE.scans():
        if scans.control in PARAMETER_ERRORS:
            continue
        left = calls_left(scans.control, memory(SENSOR, scans.scan.state))
        most = z3.And(left >= (0 if scans.control in ENABLED else 1), left <= row.calls)
        yield from claim(f"the number in {scans.control}", JUDGE.premises(scans), most, LOGIC)

    def in_one_call(scan: Scanned) -> Obligation:
        return served(scan), z3.And(scan.sends.S_OSSD_Out, TRUE)

    yield JUDGE.too_strong("one call is enough", in_one_call, "TestError1C010")

    def without_an_answer(scan: Scanned) -> Obligation:
        return z3.And(scan.inputs.Activate, scan.inputs.S_OSSD_In), z3.And(scan.sends.S_OSSD_Out, TRUE)

    yield JUDGE.too_strong("whether the sensor answers or not", without_an_answer, "TestRequest")


def tested_within(c: str, s: Any) -> z3.ArithRef:
    """How many calls lead to TestExecuted where a test is asked for whenever one is possible."""
    if c == "ESPEFreeNoTest":
        return z3.If(s.start_test_before, z3.IntVal(4), z3.IntVal(3))
    return z3.IntVal({"TestRequest": 2, "TestActive": 1}.get(c, 0))


def test_comes_closer(scan: Scanned) -> Obligation:
    """A served call with StartTest pressed and released leaves a call less up to TestExecuted."""
    if not scan.was("ESPEFreeNoTest", *TESTING):
        return None
    asks = scan.inputs.StartTest == z3.And(scan.sent.TestPossible, z3.Not(scan.before.start_test_before))
    if not scan.becomes("ESPEFreeNoTest", "ESPEFreeTestOk", *TESTING):
        return z3.And(served(scan), asks), FALSE
    before, after = (tested_within(control(SENSOR, s), s) for s in (scan.before, scan.after))
    reached = z3.Implies(after == 0, scan.sends.TestExecuted)
    return z3.And(served(scan), asks), z3.And(after + 1 <= before, reached)


@theorem(
    clauses=["TSS-TEST-1", "TSS-TEST-2", "TSS-TEST-3", "TSS-OUT-EXECUTED", "TSS-FN-5"],
    findings=[],
    properties=["TestedAgain"],
    slow=True,
)
def a_test_is_passed_within_four_calls() -> Queries:
    """Once it enables without a test, a served block whose StartTest is pressed and released while
    TestPossible is TRUE has passed a test after at most four calls, with S_OSSD_Out TRUE in all of them.
    """
    yield from JUDGE.in_every_scan(test_comes_closer)

    def within_three(scan: Scanned) -> Obligation:
        said = test_comes_closer(scan)
        return None if said is None else (said[0], FALSE if scan.becomes("ESPEFreeNoTest") else TRUE)

    yield JUDGE.too_strong("within three", within_three, "ESPEFreeNoTest")
