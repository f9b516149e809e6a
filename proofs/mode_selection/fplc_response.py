"""How soon the F-PLC is ready for the next key once everything on its wires is zero.

A quiet scan finds LA and all outputs of the EKS off and MW03 and MW07 zero. From any memory whatever,
reachable or not, quiet scans lead to Idle: within a stated number of scans, and within a stated time. The
time is carried by two numbers that nothing of the F-PLC reads: `passed`, since the first quiet scan, and
`between`, the longest time between two scans.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import z3

from modeproof.registers import Response
from proofs.explorer.device import LOGIC
from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, Scans, control, memory, parameters
from proofs.mode_selection.devices import FPLC
from proofs.mode_selection.fplc_safety import now
from proofs.mode_selection.invariants import HOLDING
from proofs.mode_selection.observer import INSERTION
from proofs.mode_selection.vocabulary import none_set, vector
from proofs.responses import waited_for
from proofs.sentences import Judge, Obligation
from proofs.theorem import Queries, claim, theorem
from proofs.theorem import control as control_query

JUDGE: Final = Judge(FPLC, ())
"""No invariant: from any memory in its ranges."""
PASSED: Final = z3.Int("passed")
BETWEEN: Final = z3.Int("between")
RANK: Final = {"Idle": 0, "Start": 1, "Error": 1, "AwaitZeros": 2, "Clear": 3}
"""How many states of the way to Idle lie ahead; 4 from everywhere else."""
DWELLING: Final = ("Start", "Error", "AwaitZeros")
"""The states of that way in which a quiet scan may wait."""

OnTheWay = Callable[[str, Any, Any, z3.ArithRef], z3.BoolRef]
"""What is known of a state after quiet scans: control state, memory, parameters, time since the first."""


def quiet(scan: Scanned) -> z3.BoolRef:
    """LA, the outputs of the EKS and both words are zero in this scan."""
    i = scan.inputs
    return z3.And(z3.Not(i.LA), none_set(vector(i)), i.MW03 == 0, i.MW07 == 0)


def rank(c: str) -> int:
    """The place of a control state on the way to Idle."""
    return RANK.get(c, 4)


def comes_closer(scan: Scanned) -> Obligation:
    """A quiet scan goes on to a later state, or adds the time passed to a dwell time that is not over."""
    before, after = control(FPLC, scan.before), control(FPLC, scan.after)
    if rank(after) < rank(before) or (before, after) == ("Idle", "Idle"):
        return quiet(scan), TRUE
    if before == after and before in DWELLING:
        grows = scan.after.elapsed_ms == now(scan)
        return quiet(scan), z3.And(grows, scan.after.elapsed_ms < scan.params.T_DWELL_ms)
    return quiet(scan), FALSE


@theorem(
    clauses=["EKS-8-6", "EKS-8-11", "EKS-8-18", "EKS-9-0", "EKS-GP-5"], findings=["E-23", "E-52"], slow=True
)
def quiet_scans_lead_the_fplc_to_idle() -> Queries:
    """From any memory, every quiet scan brings the F-PLC one state closer to Idle, or, in Start, AwaitZeros
    and Error, adds the time that passed to a dwell time that is not yet over; in Idle it stays.

    There are at most four states on the way: Clear, AwaitZeros, Error, Idle.
    """
    yield from JUDGE.in_every_scan(comes_closer)

    def always_closer(scan: Scanned) -> Obligation:
        return quiet(scan), TRUE if rank(control(FPLC, scan.after)) < rank(
            control(FPLC, scan.before)
        ) else FALSE

    yield JUDGE.too_strong("always a state closer", always_closer, "AwaitZeros")

    def not_quiet(scan: Scanned) -> Obligation:
        said = comes_closer(scan)
        return None if said is None else (z3.Not(scan.inputs.LA), said[1])

    yield JUDGE.too_strong("whatever stands in the words", not_quiet, "Error")


# ---------------------------------------------------------------- within a number of scans


def way_left(c: str, s: Any, p: Any) -> z3.ArithRef:
    """A time that shrinks by BETWEEN in every quiet scan that comes at least BETWEEN after the one before.

    One BETWEEN for each state ahead, and, for each of the two in which a dwell time has to pass, the rest of
    it.
    """
    dwells = {"AwaitZeros": 1}.get(c, 0 if c in ("Idle", *DWELLING) else 2)
    ahead = rank(c) * BETWEEN + dwells * p.T_DWELL_ms
    if c not in DWELLING:
        return ahead
    return ahead + z3.If(s.elapsed_ms < p.T_DWELL_ms, p.T_DWELL_ms - s.elapsed_ms, 0)


def shrinks(scan: Scanned) -> Obligation:
    """The time left shrinks by BETWEEN, or the F-PLC is in Idle."""
    given = z3.And(quiet(scan), BETWEEN >= 1, scan.inputs.dt_ms >= BETWEEN)
    if scan.was("Idle"):
        return given, TRUE if scan.becomes("Idle") else FALSE
    left = [way_left(control(FPLC, state), state, scan.params) for state in (scan.before, scan.after)]
    return given, left[1] + BETWEEN <= left[0]


@theorem(clauses=["EKS-8-6", "EKS-8-11", "EKS-8-18", "EKS-9-0"], findings=["E-23", "E-52"], slow=True)
def the_fplc_is_idle_again_within_a_stated_number_of_scans() -> Queries:
    """From any memory the F-PLC is in Idle after at most 4 + 2 T_DWELL / d quiet scans, and stays there, if
    each comes at least d after the one before: a number that is 4 d + 2 T_DWELL at most, and 0 in Idle alone,
    shrinks by d in each of them.

    So after four scans if the dwell time is 0.
    """
    yield from JUDGE.in_every_scan(shrinks)
    for scans in JUDGE.scans():
        params = parameters(FPLC, scans.scan.state)
        left = way_left(scans.control, memory(FPLC, scans.scan.state), params)
        given = {**JUDGE.premises(scans), "time passes between two scans": BETWEEN >= 1}
        idle = left == 0 if scans.control == "Idle" else left >= BETWEEN
        most = z3.And(idle, left <= 4 * BETWEEN + 2 * params.T_DWELL_ms)
        yield from claim(f"the number in {scans.control}", given, most, LOGIC)

    def faster(scan: Scanned) -> Obligation:
        said = shrinks(scan)
        return None if said is None else (said[0], TRUE if scan.becomes("Idle") else FALSE)

    yield JUDGE.too_strong("one scan is enough", faster, "AwaitZeros")


# ---------------------------------------------------------------- within a time


def on_the_way(c: str, s: Any, p: Any, passed: z3.ArithRef) -> z3.BoolRef:
    dwelling = s.elapsed_ms < p.T_DWELL_ms
    if c == "Idle":
        return TRUE
    if c == "Clear":
        return z3.And(s.elapsed_ms == 0, passed == 0)
    if c == "AwaitZeros":
        return z3.And(passed <= s.elapsed_ms, z3.Or(dwelling, passed <= BETWEEN))
    if c == "Start":
        return z3.And(dwelling, passed <= s.elapsed_ms)
    if c == "Error":
        late = passed <= s.elapsed_ms + p.T_DWELL_ms + 2 * BETWEEN
        return z3.And(z3.Or(dwelling, s.elapsed_ms == 0), late)
    return FALSE


def without_error(c: str, s: Any, p: Any, passed: z3.ArithRef) -> z3.BoolRef:
    if c == "Idle":
        return TRUE
    if c == "Clear":
        return z3.And(s.elapsed_ms == 0, passed == 0)
    if c == "AwaitZeros":
        short = z3.Or(s.elapsed_ms < p.T_DWELL_ms, s.elapsed_ms <= BETWEEN)
        return z3.And(s.elapsed_ms == passed, short)
    return FALSE


def stays_on_the_way(
    way: OnTheWay, starts: frozenset[str], also: Callable[[Any], z3.BoolRef], judge: Judge = JUDGE
) -> Queries:
    """The first quiet scan from these control states leads to the way, and no later one leads off it."""
    for scans in judge.scans():
        given = {**judge.premises(scans), "what the times fulfil": also(parameters(FPLC, scans.scan.state))}
        if scans.control in starts:
            yield from _leads(f"first, from {scans.control}", scans, given, way, z3.IntVal(0), BETWEEN >= 0)
        known = _known(scans, way)
        if not z3.is_false(known):
            later = {**given, "known before": known, "time has passed": PASSED >= 0}
            passed = PASSED + scans.scan.inputs.dt_ms.term
            within = scans.scan.inputs.dt_ms.term <= BETWEEN
            yield from _leads(f"later, from {scans.control}", scans, later, way, passed, within)


def _known(scans: Scans, way: OnTheWay) -> z3.BoolRef:
    state = scans.scan.state
    return way(scans.control, memory(FPLC, state), parameters(FPLC, state), PASSED)


def _leads(
    name: str,
    scans: Scans,
    given: dict[str, z3.BoolRef],
    way: OnTheWay,
    passed: z3.ArithRef,
    within: z3.BoolRef,
) -> Queries:
    given = {**given, "quiet": scans.some(quiet), "not longer between two scans": within}
    then = scans.always(
        lambda scan: z3.Implies(quiet(scan), way(control(FPLC, scan.after), scan.after, scan.params, passed))
    )
    yield from claim(name, given, then, LOGIC)


def _bound(way: OnTheWay, bound: Callable[[Any], z3.BoolRef], also: Callable[[Any], z3.BoolRef]) -> Queries:
    """In every state on the way that is not Idle the time passed is within the bound."""
    for scans in JUDGE.scans():
        known = _known(scans, way)
        if scans.control != "Idle" and not z3.is_false(known):
            params = parameters(FPLC, scans.scan.state)
            given = {
                **JUDGE.premises(scans),
                "what the times fulfil": also(params),
                "known before": known,
                "time has passed": z3.And(PASSED >= 0, BETWEEN >= 0),
            }
            yield from claim(f"not yet Idle, in {scans.control}", given, bound(params), LOGIC)


ANYWHERE: Final = frozenset(FPLC.register.states)


def any_times(p: Any) -> z3.BoolRef:
    return BETWEEN >= 0


@theorem(
    clauses=["EKS-8-3", "EKS-8-11", "EKS-8-18", "EKS-9-0", "EKS-3-0"],
    findings=["E-23", "E-52"],
    responses=["R-07"],
    slow=True,
)
def the_fplc_is_idle_again_within_a_stated_time(row: Response) -> Queries:
    """From any memory, the F-PLC is in Idle no later than in the first quiet scan that comes more than twice
    T_DWELL and twice the longest time between two scans after the first quiet one.
    """
    yield from stays_on_the_way(on_the_way, ANYWHERE, any_times)
    calls = row.calls or 0
    yield from _bound(on_the_way, lambda p: waited_for(row, p) + calls * BETWEEN >= PASSED, any_times)

    def longest(p: Any) -> z3.BoolRef:
        return z3.And(BETWEEN >= 1, waited_for(row, p) + calls * BETWEEN == PASSED + 1)

    yield _reaches("control: a millisecond less is not enough", on_the_way, "Error", any_times, longest)
    yield _reaches("control: half of that is not enough", on_the_way, "Error", any_times)


def _late(p: Any) -> z3.BoolRef:
    late: z3.BoolRef = p.T_DWELL_ms + BETWEEN < PASSED
    return late


def _reaches(
    name: str,
    way: OnTheWay,
    start: str,
    also: Callable[[Any], z3.BoolRef],
    late: Callable[[Any], z3.BoolRef] = _late,
) -> Any:
    """An example of a state on the way so late: after more than T_DWELL and the time between two scans."""
    scans = JUDGE.begin(start)
    params = parameters(FPLC, scans.scan.state)
    formulas = {
        **JUDGE.premises(scans),
        "what the times fulfil": also(params),
        "known before": _known(scans, way),
        "late": late(params),
    }
    return control_query(name, formulas, LOGIC)


def times_of_a_good_removal(p: Any) -> z3.BoolRef:
    return z3.And(BETWEEN >= 0, p.T_REM_ms > 2 * BETWEEN, p.T_REM_ms >= p.T_DWELL_ms + BETWEEN)


@theorem(clauses=["EKS-8-3", "EKS-8-6", "EKS-8-11", "EKS-8-18"], findings=["E-30", "E-52"], slow=True)
def a_removal_over_zeros_ends_without_the_error_mode() -> Queries:
    """If T_REM is at least T_DWELL and the longest time between two scans, and more than twice the latter,
    then a removal whose scans are all quiet never leads to the error mode; and the F-PLC is in Idle in the
    first scan later than both T_DWELL and that time after the first.

    So T_REM and T_DWELL can be chosen for a cycle time such that only words or outputs that do not return to
    zero in time make an error.
    """
    starts = frozenset(INSERTION | HOLDING)
    yield from stays_on_the_way(without_error, starts, times_of_a_good_removal)

    def bound(p: Any) -> z3.BoolRef:
        return z3.Or(p.T_DWELL_ms > PASSED, PASSED <= BETWEEN)

    yield from _bound(without_error, bound, times_of_a_good_removal)

    def no_error(scan: Scanned) -> Obligation:
        zero_waited = z3.And(quiet(scan), scan.before.elapsed_ms < scan.params.T_DWELL_ms)
        return zero_waited, FALSE if scan.becomes("Error") else TRUE

    yield JUDGE.too_strong("whatever the times", no_error, "AwaitZeros")
