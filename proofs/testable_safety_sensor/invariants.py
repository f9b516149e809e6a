"""What is true of the block after every call, whatever the inputs were, and what an observer has seen.

`SENSOR_INVARIANT` holds in every reachable state: any inputs, any times, any TestTime, both values of
AUTO_RESET_ERRORS. Each conjunct is a sentence and a formula over the memory (`s`), the parameters (`p`) and
what the observer below has seen (`seen`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.invariant import Conjunct
from proofs.explorer.scanned import Scanned

TESTING: Final = frozenset({"TestRequest", "TestActive"})
TEST_ERRORS: Final = frozenset({"TestError1C010", "TestError1C410"})
RESET_ERRORS: Final = frozenset(f"ResetError{number}" for number in range(1, 7))
MANUAL: Final = frozenset(
    {"ExternalFunctionTest", "ESPEInterruptedExternalTest", "EndExternalTest", "ResetError4"}
)
INHIBITED: Final = frozenset({"ESPEInterrupted1", "WaitForReset1", "ResetError2"})
"""The states in which the start-up inhibit can still be pending, besides Init."""
PARAMETER_ERRORS: Final = frozenset({"ParameterError", "ResetError5"})


@dataclass(frozen=True, eq=False)
class Seen:
    """The memory of an observer of the wires; nothing of the block reads it.

    reset, start_test, sensor: these inputs in the call before · dark: ms since the sensor was first seen dark
    while S_OSSD_Out stayed TRUE, -1 without it · tested: ms since the test began, -1 outside a test · phase:
    ms since this phase of it began · starting: activated, and the start-up inhibit neither switched off when
    the sensor was first judged nor reset since · cycle: of the manual test, 0 nothing yet, 1 the sensor seen
    free, 2 then dark, 3 then free.
    """

    reset: z3.BoolRef
    start_test: z3.BoolRef
    sensor: z3.BoolRef
    dark: z3.ArithRef
    tested: z3.ArithRef
    phase: z3.ArithRef
    starting: z3.BoolRef
    cycle: z3.ArithRef


SEEN: Final = Seen(
    z3.Bool("seen.reset"),
    z3.Bool("seen.start_test"),
    z3.Bool("seen.sensor"),
    z3.Int("seen.dark"),
    z3.Int("seen.tested"),
    z3.Int("seen.phase"),
    z3.Bool("seen.starting"),
    z3.Int("seen.cycle"),
)
"""Any memory of the observer before a call."""

NOTHING: Final = Seen(FALSE, FALSE, FALSE, z3.IntVal(-1), z3.IntVal(-1), z3.IntVal(0), FALSE, z3.IntVal(0))
"""At power-up nothing was seen."""


@cache
def sees(scan: Scanned, seen: Seen = SEEN) -> Seen:
    """The observer's memory after a call."""
    i, dt = scan.inputs, scan.inputs.dt_ms
    masked = z3.And(scan.sends.S_OSSD_Out, z3.Not(i.S_OSSD_In))
    return Seen(
        reset=i.Reset,
        start_test=i.StartTest,
        sensor=i.S_OSSD_In,
        dark=z3.If(masked, z3.If(seen.dark < 0, 0, seen.dark + dt), -1),
        tested=z3.If(seen.tested < 0, 0, seen.tested + dt) if scan.becomes(*TESTING) else z3.IntVal(-1),
        phase=seen.phase + dt if _same_phase(scan) else z3.IntVal(0),
        starting=_starting(scan, seen),
        cycle=_cycle(scan, seen),
    )


def _same_phase(scan: Scanned) -> bool:
    return any(scan.was(phase) and scan.becomes(phase) for phase in TESTING)


def _starting(scan: Scanned, seen: Seen) -> z3.BoolRef:
    i = scan.inputs
    if scan.was("Idle"):
        return z3.And(i.Activate, TRUE)
    kept = z3.And(seen.starting, i.Activate, z3.Not(scan.sends.S_OSSD_Out))
    return z3.And(kept, z3.Not(i.S_StartReset)) if scan.was("Init") else kept


def _cycle(scan: Scanned, seen: Seen) -> z3.ArithRef:
    free = scan.inputs.S_OSSD_In
    if not scan.becomes(*MANUAL):
        return z3.IntVal(0)
    if not scan.was(*MANUAL):
        return z3.If(free, z3.IntVal(1), z3.IntVal(0))
    goes_on = z3.Or(seen.cycle == 0, seen.cycle == 2) == free
    return z3.If(z3.And(seen.cycle < 3, goes_on), seen.cycle + 1, seen.cycle)


# ---------------------------------------------------------------- the conjuncts


def valid(p: Any) -> z3.BoolRef:
    """TestTime is in its range. TSS-IN-TESTTIME"""
    return z3.And(p.TestTime_ms >= 0, p.TestTime_ms <= 150)


def _edges_are_remembered(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return z3.And(
        s.reset_before == seen.reset, s.start_test_before == seen.start_test, s.sensor_before == seen.sensor
    )


def _time_is_that_of_the_phase(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c not in TESTING:
        return z3.And(s.elapsed_ms == 0, seen.phase == 0)
    in_time = z3.Or(s.elapsed_ms < p.TestTime_ms, s.elapsed_ms == 0)
    return z3.And(s.elapsed_ms >= 0, s.elapsed_ms == seen.phase, in_time)


def _tested_within_both(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c == "TestRequest":
        return seen.tested == s.elapsed_ms
    if c == "TestActive":
        return z3.And(seen.tested >= s.elapsed_ms, seen.tested < s.elapsed_ms + p.TestTime_ms)
    return seen.tested == -1


def _dark_in_the_second_phase(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c == "TestActive":
        return z3.And(seen.dark == s.elapsed_ms, p.TestTime_ms > 0)
    return seen.dark == -1


def _start_inhibit_pending(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c in INHIBITED:
        return z3.Implies(seen.starting, s.start_inhibit)
    return TRUE if c in ("Init", "ResetError1", *PARAMETER_ERRORS) else z3.Not(seen.starting)


def _start_inhibit_nowhere_else(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return TRUE if c in INHIBITED else z3.Not(s.start_inhibit)


def _cycle_of_the_manual_test(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c == "ExternalFunctionTest":
        fits = z3.If(s.sensor_before, seen.cycle == 1, seen.cycle == 0)
        return fits
    if c == "ESPEInterruptedExternalTest":
        return z3.Or(seen.cycle == 2, seen.cycle == 3)
    return seen.cycle == 3 if c in MANUAL else seen.cycle == 0


def _a_refused_time_goes_nowhere(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c in PARAMETER_ERRORS:
        return z3.Not(valid(p))
    return TRUE if c in ("Idle", "Init") else valid(p)


SENSOR_INVARIANT: Final = (
    Conjunct(
        "EdgesAreRemembered",
        "Reset, StartTest and S_OSSD_In are remembered as they stood in the call before.",
        _edges_are_remembered,
    ),
    Conjunct(
        "TimeIsThatOfThePhase",
        "In a test the timer is the time since its phase began, and below TestTime; elsewhere it is zero.",
        _time_is_that_of_the_phase,
    ),
    Conjunct(
        "TestedWithinBoth",
        "In the second phase the test has lasted less than TestTime longer than that phase.",
        _tested_within_both,
    ),
    Conjunct(
        "DarkInTheSecondPhase",
        "S_OSSD_Out stands over a dark sensor in the second phase alone, for as long as it lasts.",
        _dark_in_the_second_phase,
    ),
    Conjunct(
        "StartInhibitPending",
        "A start-up inhibit that is still to be reset is remembered, or the block is in Init or its errors.",
        _start_inhibit_pending,
    ),
    Conjunct(
        "StartInhibitNowhereElse",
        "It is remembered in the first interruption, its wait and its reset error alone.",
        _start_inhibit_nowhere_else,
    ),
    Conjunct(
        "CycleOfTheManualTest",
        "How far the manual test is, is what the sensor has shown since it began.",
        _cycle_of_the_manual_test,
    ),
    Conjunct(
        "ARefusedTimeGoesNowhere",
        "A TestTime out of its range is met in Idle, Init and its own errors alone; a valid one not there.",
        _a_refused_time_goes_nowhere,
    ),
)
