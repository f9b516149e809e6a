"""How soon the block answers: the bounds of spec/testable_safety_sensor/properties.toml, stated there."""

from __future__ import annotations

import z3

from modeproof.registers import Response
from proofs.explorer.ends import FALSE
from proofs.explorer.scanned import Scanned
from proofs.responses import waits_without_end, within_calls, within_time
from proofs.testable_safety_sensor.invariants import TESTING
from proofs.testable_safety_sensor.sensor_safety import JUDGE
from proofs.theorem import Queries, theorem


def _off(scan: Scanned) -> z3.BoolRef:
    return z3.Not(scan.sends.S_OSSD_Out)


def _dark(scan: Scanned) -> z3.BoolRef:
    return z3.Not(scan.inputs.S_OSSD_In)


@theorem(clauses=["TSS-IN-OSSD", "TSS-FN-1"], findings=["TSSF-21"], responses=["TSSR-01"], slow=True)
def a_dark_sensor_is_answered_in_the_calls_of_its_row(row: Response) -> Queries:
    """Outside a test, while the sensor is dark, S_OSSD_Out is FALSE within the calls of TSSR-01."""
    outside = lambda scan: FALSE if scan.was(*TESTING) else _dark(scan)  # noqa: E731
    yield from within_calls(JUDGE, row, outside, _off)


@theorem(
    clauses=["TSS-TEST-0", "TSS-FN-7", "TSS-NOTE-1"],
    findings=["TSSF-06", "TSSF-09"],
    responses=["TSSR-02"],
    slow=True,
)
def a_sensor_that_is_dark_in_a_test_is_answered_in_the_time_of_its_row(row: Response) -> Queries:
    """While the sensor is dark in every call of a test, by the test or by a person, the first call that comes
    the times of TSSR-02 after the first such call ends with S_OSSD_Out FALSE.
    """
    inside = lambda scan: _dark(scan) if scan.was(*TESTING) else FALSE  # noqa: E731
    yield from within_time(JUDGE, row, inside, lambda seen: seen.dark, _off)


@theorem(clauses=["TSS-FN-7", "TSS-NOTE-1"], findings=["TSSF-06"], responses=["TSSR-03"], slow=True)
def the_sender_is_on_again_in_the_time_of_its_row(row: Response) -> Queries:
    """While the sender is off, the first call that comes the times of TSSR-03 after the one that switched it
    off ends with S_TestOut TRUE.
    """
    yield from within_time(
        JUDGE,
        row,
        lambda scan: z3.Not(scan.sent.S_TestOut),
        lambda seen: seen.phase,
        lambda scan: scan.sends.S_TestOut,
    )


@theorem(clauses=["TSS-ERR-2", "TSS-FN-4"], findings=["TSSF-06"], responses=["TSSR-04"], slow=True)
def a_sensor_that_ignores_the_test_is_an_error_in_the_time_of_its_row(row: Response) -> Queries:
    """While the sender is off and the sensor stays free in every active call, the first one that comes the
    times of TSSR-04 after the start of the test shows Error and no output.
    """

    def asks(scan: Scanned) -> z3.BoolRef:
        return z3.And(scan.inputs.Activate, z3.Not(scan.sent.S_TestOut), scan.inputs.S_OSSD_In)

    yield from within_time(
        JUDGE, row, asks, lambda seen: seen.phase, lambda scan: z3.And(scan.sends.Error, _off(scan))
    )


@theorem(clauses=["TSS-REL-1", "TSS-8002"], findings=[], responses=["TSSR-06"], slow=True)
def a_reset_or_a_manual_test_is_waited_for_without_end(row: Response) -> Queries:
    """TSSR-06 has no bound: while nobody presses Reset, a call that shows ResetRequest, or one in the manual
    test, can be followed by as many like it as one likes, whatever time passes, without S_OSSD_Out.
    """
    manual = ("ExternalFunctionTest", "ESPEInterruptedExternalTest", "EndExternalTest")

    def asks(scan: Scanned) -> z3.BoolRef:
        waits = z3.BoolVal(True) if scan.was(*manual) else scan.sent.ResetRequest
        return z3.And(scan.inputs.Activate, z3.Not(scan.inputs.Reset), waits)

    yield from waits_without_end(JUDGE, row, asks, lambda scan: scan.sends.S_OSSD_Out)


@theorem(clauses=["TSS-FN-9", "TSS-NOTE-2"], findings=[], responses=["TSSR-07"], slow=True)
def the_next_test_is_waited_for_without_end(row: Response) -> Queries:
    """TSSR-07 has no bound: without StartTest, a call after a test that was passed can be followed by as many
    like it as one likes, whatever time passes, and no test begins.
    """
    yield from waits_without_end(
        JUDGE,
        row,
        lambda scan: z3.And(scan.sent.TestExecuted, z3.Not(scan.inputs.StartTest)),
        lambda scan: z3.Not(scan.sends.S_TestOut),
    )
