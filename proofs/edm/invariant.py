"""The inductive invariant of the block: true at power-up and after every call, whatever the inputs were."""

from __future__ import annotations

from typing import Any, Final

import z3

from proofs.edm.devices import BLOCK, stop_first
from proofs.edm.observer import NOTHING, SEEN, Seen, sees
from proofs.explorer.ends import TRUE
from proofs.explorer.invariant import Conjunct
from proofs.sentences import Judge
from proofs.theorem import Queries, theorem

CLOCKED: Final = frozenset({"OutputDisable", "OutputEnable"})


def _wires_are_remembered(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return z3.And(s.reset_before == seen.reset, s.out_control_before == seen.control)


def _time_is_that_on_the_wires(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c not in CLOCKED:
        return z3.And(s.elapsed_ms == 0, seen.unchanged == 0)
    reached = seen.unchanged >= p.MonitoringTime_ms
    cut = s.elapsed_ms == z3.If(reached, p.MonitoringTime_ms, seen.unchanged)
    return z3.And(seen.unchanged >= 0, cut)


def _stop_was_seen(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    if c != "OutputDisable":
        return z3.Not(s.stop_seen)
    at_once = z3.Implies(z3.Not(stop_first(p)), s.stop_seen)
    return z3.And(z3.Implies(stop_first(p), s.stop_seen == seen.released), at_once)


def _on_since_a_request(c: str, s: Any, p: Any, seen: Seen) -> z3.BoolRef:
    return s.out_control_before if c == "OutputEnable" else TRUE


INVARIANT: Final = (
    Conjunct(
        "WiresAreRemembered",
        "Reset and S_OutControl are remembered as they stood in the call before.",
        _wires_are_remembered,
    ),
    Conjunct(
        "TimeIsThatOnTheWires",
        "The timer is the time since the output went on, or off on request, up to MonitoringTime.",
        _time_is_that_on_the_wires,
    ),
    Conjunct(
        "StopWasSeen",
        "With stop_first S_OutControl counts where it was FALSE since a reset by hand; else always.",
        _stop_was_seen,
    ),
    Conjunct("OnSinceARequest", "With the output on S_OutControl was TRUE.", _on_since_a_request),
)
JUDGE: Final = Judge(BLOCK, INVARIANT, SEEN, sees, NOTHING)


@theorem(
    clauses=["EDM-IN-TIME-1", "EDM-IN-RESET-1", "EDM-IN-CONTROL-1", "EDM-INST-1"],
    findings=["EDMF-04", "EDMF-08", "EDMF-14"],
    slow=True,
)
def every_call_keeps_the_invariant() -> Queries:
    """The invariant of the block is true at power-up, and every call keeps it, with any inputs, times and
    parameters.
    """
    yield from JUDGE.initiation()
    yield from JUDGE.consecution()
