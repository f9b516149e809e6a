"""The order of the F-PLC's steps, and its answer to each word at each of them, for all words and times.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in FplcOrder.
"""

# ruff: noqa: SIM300 -- the names of words are upper case
from __future__ import annotations

from itertools import pairwise
from typing import Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.mode_selection.devices import FPLC
from proofs.mode_selection.fplc_invariant import JUDGE
from proofs.mode_selection.fplc_prompt import signalled
from proofs.mode_selection.fplc_safety import TIMED, deadline, now
from proofs.mode_selection.invariants import CLOCKED, HOLDING, TRANSACTION
from proofs.mode_selection.observer import INSERTION
from proofs.mode_selection.vocabulary import NONE, code, mode
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem

WAITING: Final = (
    *("Start", "Idle", "PulseOnes", "PulseZeros", "OneOutput", "AwaitSelection"),
    *("AwaitAcknowledgment", "Complete", "Settle", "AwaitZeros", "Error"),
)
IN_ORDER: Final = frozenset(
    {
        *pairwise(("Idle", "PulseOnes", "PulseZeros", "OneOutput", "Authorize", "AwaitSelection")),
        *pairwise(("AwaitSelection", "CheckSelection", "EchoSelection", "AwaitAcknowledgment")),
        *pairwise(("AwaitAcknowledgment", "CheckAcknowledgment", "Match", "Switch", "Settle")),
        ("Settle", "AwaitSelection"),
        ("Switch", "Complete"),
        *pairwise(("Clear", "AwaitZeros", "Idle")),
        ("Start", "Idle"),
        ("Error", "Idle"),
        *((step, step) for step in WAITING),
    }
)
"""The numbered steps one after another, and waiting."""
FROM_THE_SIDE: Final = frozenset(
    {
        *((step, "Settle") for step in TRANSACTION | {"CheckSelection"}),
        *((step, "Clear") for step in INSERTION | HOLDING),
        *((state, "Error") for state in FPLC.register.states),
    }
)


def _pair(scan: Scanned) -> tuple[str, str]:
    return control(scan.device, scan.before), control(scan.device, scan.after)


def steps_in_order(scan: Scanned) -> Obligation:
    return TRUE, TRUE if _pair(scan) in IN_ORDER | FROM_THE_SIDE else FALSE


@theorem(
    clauses=[
        "EKS-GP-3",
        "EKS-GP-5",
        "EKS-2-6",
        "EKS-2-12",
        "EKS-2-17",
        "EKS-2-20",
        "EKS-2-27",
        "EKS-2-28",
        "EKS-2-29",
        "EKS-4-1",
        "EKS-4-3",
        "EKS-4-5",
        "EKS-8-6",
        "EKS-8-18",
    ],
    findings=[],
    properties=["StepsInOrder"],
    slow=True,
)
def the_fplc_leaves_no_step_out() -> Queries:
    """Every scan goes on to the next numbered step or waits; only Settle, Clear and the error mode are
    reached from the side.
    """
    yield from JUDGE.in_every_scan(steps_in_order)

    def never_aside(scan: Scanned) -> Obligation:
        return TRUE, TRUE if _pair(scan) in IN_ORDER else FALSE

    yield JUDGE.too_strong("nor those", never_aside, "Match")


def time_goes_on(scan: Scanned) -> Obligation:
    before, after = _pair(scan)
    if before != after or before not in CLOCKED:
        return None
    limit = deadline(before, scan.params) if before in TIMED else scan.params.T_DWELL_ms
    return TRUE, scan.after.elapsed_ms >= z3.If(now(scan) < limit, now(scan), limit)


@theorem(clauses=["EKS-GP-3", "EKS-8-3"], findings=["E-36", "E-52"], properties=["TimeGoesOn"], slow=True)
def the_fplc_counts_the_time_of_every_scan_that_waits() -> Queries:
    """In a state that counts time, every scan that stays there adds its own, up to the deadline or to the
    dwell time.
    """
    yield from JUDGE.in_every_scan(time_goes_on)

    def faster(scan: Scanned) -> Obligation:
        return None if time_goes_on(scan) is None else (TRUE, scan.after.elapsed_ms > now(scan))

    yield JUDGE.too_strong("and runs ahead", faster, "Settle")


def selection_stands(scan: Scanned) -> z3.BoolRef:
    """MW03 carries the word of the latched selection."""
    stands: z3.BoolRef = scan.inputs.MW03 == code("SE", scan.before.selection)
    return stands


def acknowledgment_needs_echo(scan: Scanned) -> Obligation:
    if not scan.was("AwaitSelection", "CheckSelection", "EchoSelection"):
        return None
    early = z3.And(signalled(scan), scan.inputs.MW07 != 0)
    if scan.was("EchoSelection"):
        early = z3.And(early, selection_stands(scan))
    return early, TRUE if scan.becomes("Error") else FALSE


@theorem(
    clauses=["EKS-2-17", "EKS-2-20"],
    findings=["E-65"],
    properties=["AcknowledgmentNeedsEcho"],
    slow=True,
)
def the_fplc_refuses_an_acknowledgment_before_the_echo() -> Queries:
    """While the key stands, any word in MW07 before the echo leads to the error mode in that scan; in
    EchoSelection unless the selection has been taken back.
    """
    yield from JUDGE.in_every_scan(acknowledgment_needs_echo)

    def any_time(scan: Scanned) -> Obligation:
        obligation = z3.And(signalled(scan), scan.inputs.MW07 != 0)
        return obligation, TRUE if scan.becomes("Error") else FALSE

    yield JUDGE.too_strong("and after it too", any_time, "AwaitAcknowledgment")


def changed_selection_is_withdrawn(scan: Scanned) -> Obligation:
    if not scan.was(*TRANSACTION):
        return None
    MW03 = scan.inputs.MW03
    taken_back = z3.Or(MW03 == 0, mode("SE", MW03) != NONE)
    changed = z3.And(signalled(scan), z3.Not(selection_stands(scan)), taken_back)
    return changed, scan.after.mode == scan.before.mode if scan.becomes("Settle") else FALSE


@theorem(
    clauses=["EKS-2-25"],
    findings=["E-16", "E-21", "E-61"],
    properties=["ChangedSelectionIsWithdrawn"],
    slow=True,
)
def the_fplc_takes_back_a_selection_that_no_longer_stands() -> Queries:
    """While the key stands, a scan of a transaction that finds zero or another selection in MW03 leads to
    Settle and leaves the mode as it is, whatever MW07 shows.
    """
    yield from JUDGE.in_every_scan(changed_selection_is_withdrawn)

    def a_code_is_an_error(scan: Scanned) -> Obligation:
        obligation = changed_selection_is_withdrawn(scan)
        refused = z3.And(scan.inputs.MW07 != 0, TRUE if scan.becomes("Settle") else FALSE)
        return None if obligation is None else (obligation[0], z3.Not(refused))

    yield JUDGE.too_strong("but not beside a word in MW07", a_code_is_an_error, "Switch")


def no_code_is_reported(scan: Scanned) -> Obligation:
    if not scan.was("CheckSelection", *TRANSACTION):
        return None
    MW03 = scan.inputs.MW03
    no_code = z3.And(signalled(scan), MW03 != 0, mode("SE", MW03) == NONE)
    return no_code, TRUE if scan.becomes("Error") else FALSE


@theorem(clauses=["EKS-2-19"], findings=["E-61"], properties=["NoCodeIsReported"], slow=True)
def the_fplc_reports_a_selection_that_is_no_code() -> Queries:
    """While the key stands, from the check of the selection until the switchover, a word in MW03 that is
    neither zero nor one of the five selections leads to the error mode in that scan, whatever MW07 shows.
    """
    yield from JUDGE.in_every_scan(no_code_is_reported)

    def any_change(scan: Scanned) -> Obligation:
        if not scan.was(*TRANSACTION):
            return None
        changed = z3.And(signalled(scan), z3.Not(selection_stands(scan)))
        return changed, TRUE if scan.becomes("Error") else FALSE

    yield JUDGE.too_strong("and so does every change", any_change, "Match")


def acknowledgment_is_judged(scan: Scanned) -> Obligation:
    if not scan.was("AwaitAcknowledgment", "CheckAcknowledgment", "Match", "Switch"):
        return None
    stands = z3.And(signalled(scan), selection_stands(scan))
    if scan.was("AwaitAcknowledgment"):
        return stands, z3.BoolVal(not scan.becomes("Error"))
    MW07 = scan.inputs.MW07
    settles = scan.after.mode == scan.before.mode if scan.becomes("Settle") else FALSE
    refused, matched = z3.BoolVal(scan.becomes("Error")), z3.BoolVal(scan.becomes("Match"))
    other = refused
    if scan.was("CheckAcknowledgment"):
        other = z3.If(mode("SW", MW07) != NONE, matched, refused)
    own = MW07 == code("SW", scan.before.selection)
    answer = z3.If(MW07 == 0, settles, z3.If(own, z3.Not(refused), other))
    return stands, answer


@theorem(
    clauses=["EKS-2-20", "EKS-2-27", "EKS-2-28", "EKS-7-12"],
    findings=["E-11", "E-13", "E-21", "E-66"],
    properties=["AcknowledgmentIsJudged"],
    slow=True,
)
def the_fplc_has_one_answer_to_each_acknowledgment() -> Queries:
    """While key and selection stand, after the echo: nothing in MW07 is an error before step 27; from there
    on zero leads to Settle with the mode as it was; the word of the selection to no error; the word of
    another mode from step 27 to step 28, and there to the error mode; and what is no code to the error mode.
    """
    yield from JUDGE.in_every_scan(acknowledgment_is_judged)

    def never_refused(scan: Scanned) -> Obligation:
        obligation = acknowledgment_is_judged(scan)
        return None if obligation is None else (obligation[0], z3.BoolVal(not scan.becomes("Error")))

    yield JUDGE.too_strong("and is never refused", never_refused, "Match")
