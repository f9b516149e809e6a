"""Every row of the table of codes, proved of every state with any memory."""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.explorer.ends import TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.sentences import Judge, Obligation
from proofs.testable_safety_sensor.devices import SENSOR
from proofs.theorem import Queries, theorem

JUDGE: Final = Judge(SENSOR, ())
OUTPUTS: Final = (
    *("Ready", "S_OSSD_Out", "S_TestOut", "TestPossible"),
    *("TestExecuted", "SafetyDemand", "ResetRequest", "Error"),
)
TRUE_IN: Final = {
    "Idle": (0x0000, ("S_TestOut",)),
    "Init": (0x8401, ("Ready", "S_TestOut", "ResetRequest")),
    "ESPEInterrupted1": (0x8802, ("Ready", "S_TestOut", "SafetyDemand")),
    "WaitForReset1": (0x8402, ("Ready", "S_TestOut", "ResetRequest")),
    "ExternalFunctionTest": (0x8002, ("Ready", "S_TestOut")),
    "ESPEInterruptedExternalTest": (0x8804, ("Ready", "S_TestOut", "SafetyDemand")),
    "EndExternalTest": (0x8404, ("Ready", "S_TestOut", "ResetRequest")),
    "ESPEFreeNoTest": (0x8010, ("Ready", "S_OSSD_Out", "S_TestOut", "TestPossible")),
    "ESPEInterrupted2": (0x8806, ("Ready", "S_TestOut", "TestExecuted", "SafetyDemand")),
    "WaitForReset2": (0x8406, ("Ready", "S_TestOut", "TestExecuted", "ResetRequest")),
    "TestRequest": (0x8020, ("Ready", "S_OSSD_Out")),
    "TestActive": (0x8030, ("Ready", "S_OSSD_Out", "S_TestOut")),
    "ESPEFreeTestOk": (0x8000, ("Ready", "S_OSSD_Out", "S_TestOut", "TestPossible", "TestExecuted")),
    "ParameterError": (0xC000, ("Ready", "S_TestOut", "Error")),
    "ResetError1": (0xC001, ("Ready", "S_TestOut", "Error")),
    "ResetError2": (0xC011, ("Ready", "S_TestOut", "Error")),
    "ResetError3": (0xC021, ("Ready", "S_TestOut", "Error")),
    "ResetError4": (0xC031, ("Ready", "S_TestOut", "Error")),
    "ResetError5": (0xC041, ("Ready", "S_TestOut", "Error")),
    "ResetError6": (0xC051, ("Ready", "S_TestOut", "TestExecuted", "Error")),
    "TestError1C010": (0xC010, ("Ready", "S_TestOut", "Error")),
    "TestError1C410": (0xC410, ("Ready", "S_TestOut", "ResetRequest", "Error")),
}
"""The code of each state, and which of its outputs are TRUE, in our words of the table; tests compare it with
a transcription of the table.
"""


def row_of_the_state(scan: Scanned, seen: Any) -> z3.BoolRef:
    code, true = TRUE_IN[control(scan.device, scan.after)]
    sends = scan.sends
    said = [getattr(sends, name) if name in true else z3.Not(getattr(sends, name)) for name in OUTPUTS]
    return z3.And(sends.DiagCode == code, *said)


@theorem(
    clauses=[
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
    findings=["TSSF-05", "TSSF-30"],
)
def every_state_has_its_row_of_the_table() -> Queries:
    """At power-up and after every call, from any memory, the nine outputs are the row that the table prints
    for the state.
    """
    yield from JUDGE.after_every_scan(row_of_the_state)

    def row_of_idle(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(scan.sends.Ready)

    yield JUDGE.too_strong("the row of Idle", row_of_idle, "ESPEFreeNoTest")


def code_tells_its_outputs(scan: Scanned, seen: Any) -> z3.BoolRef:
    o = scan.sends
    active, error, demand, request = (o.DiagCode & mask != 0 for mask in (0x8000, 0x4000, 0x0800, 0x0400))
    same = [active == o.Ready, demand == o.SafetyDemand, request == o.ResetRequest]
    return z3.And(z3.And(active, error) == o.Error, *same)


@theorem(
    clauses=["TSS-OUT-DIAG", "TSS-OUT-READY", "TSS-OUT-ERROR", "TSS-OUT-DEMAND", "TSS-OUT-REQUEST"],
    findings=[],
    properties=["CodeTellsItsOutputs"],
    slow=True,
)
def the_code_tells_its_outputs() -> Queries:
    """At power-up and after every call four bits of DiagCode say what Ready, Error, SafetyDemand and
    ResetRequest say.
    """
    yield from JUDGE.after_every_scan(code_tells_its_outputs)

    def and_the_enable_output(scan: Scanned) -> Obligation:
        return TRUE, scan.sends.S_OSSD_Out == (scan.sends.DiagCode & 0x0010 != 0)

    yield JUDGE.too_strong("and a fifth the enable output", and_the_enable_output, "TestActive")


def enable_means_nothing_pending(scan: Scanned, seen: Any) -> z3.BoolRef:
    o = scan.sends
    pending = z3.Or(z3.Not(o.Ready), o.Error, o.SafetyDemand, o.ResetRequest)
    return z3.Implies(o.S_OSSD_Out, z3.Not(pending))


@theorem(
    clauses=["TSS-OUT-OSSD", "TSS-OUT-ERROR", "TSS-OUT-DEMAND", "TSS-OUT-REQUEST", "TSS-EB-1"],
    findings=[],
    properties=["EnableMeansNothingPending"],
    slow=True,
)
def nothing_is_pending_while_the_block_enables() -> Queries:
    """At power-up and after every call that leaves S_OSSD_Out TRUE the block is ready, in no error, with no
    safety demand, and waits for no reset.
    """
    yield from JUDGE.after_every_scan(enable_means_nothing_pending)

    def and_tested(scan: Scanned) -> Obligation:
        return TRUE, z3.Implies(scan.sends.S_OSSD_Out, scan.sends.TestExecuted)

    yield JUDGE.too_strong("and the sensor was tested", and_tested, "Init")


def test_out_only_in_test_request(scan: Scanned, seen: Any) -> z3.BoolRef:
    off = z3.Not(scan.sends.S_TestOut)
    return off if scan.becomes("TestRequest") else z3.Not(off)


@theorem(
    clauses=["TSS-OUT-TESTOUT", "TSS-TEST-1", "TSS-TEST-2", "TSS-8020"],
    findings=["TSSF-05"],
    properties=["TestOutOnlyInTestRequest"],
    slow=True,
)
def the_sender_is_off_in_the_first_phase_only() -> Queries:
    """At power-up and after every call S_TestOut is FALSE exactly in the first phase of a test."""
    yield from JUDGE.after_every_scan(test_out_only_in_test_request)

    def in_both(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(scan.sends.S_TestOut) if scan.becomes("TestActive") else TRUE

    yield JUDGE.too_strong("in both phases", in_both, "TestActive")


def power_up_is_safe(scan: Scanned) -> z3.BoolRef:
    return z3.And(row_of_the_state(scan, None), z3.Not(scan.sends.S_OSSD_Out), z3.Not(scan.sends.Ready))


@theorem(clauses=["TSS-0000", "TSS-FN-3"], findings=[], properties=["PowerUpIsSafe"], slow=True)
def at_power_up_nothing_is_enabled() -> Queries:
    """At power-up the block is inactive and enables nothing, whatever TestTime is."""
    yield from JUDGE.at_power_up(lambda scan, seen: power_up_is_safe(scan))
