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
    *("AwaitAcknowledgment", "Settle", "AwaitZeros", "Error"),
)
IN_ORDER: Final = frozenset(
    {
        *pairwise(("Idle", "PulseOnes", "PulseZeros", "OneOutput", "Authorize", "AwaitSelection")),
        *pairwise(("AwaitSelection", "CheckSelection", "EchoSelection", "AwaitAcknowledgment")),
        *pairwise(("AwaitAcknowledgment", "CheckAcknowledgment", "Match", "Switch", "Settle")),
        ("Settle", "AwaitSelection"),
        *pairwise(("Clear", "AwaitZeros", "Idle")),
        ("Start", "Idle"),
        ("Error", "Idle"),
        *((one, one) for one in WAITING),
    }
)
"""The numbered steps one after another, and waiting."""
FROM_THE_SIDE: Final = frozenset(
    {
        *((one, "Settle") for one in TRANSACTION | {"CheckSelection"}),
        *((one, "Clear") for one in INSERTION | HOLDING),
        *((one, "Error") for one in FPLC.register.states),
    }
)


def _pair(one: Scanned) -> tuple[str, str]:
    return control(one.device, one.before), control(one.device, one.after)


def steps_in_order(one: Scanned) -> Obligation:
    return TRUE, TRUE if _pair(one) in IN_ORDER | FROM_THE_SIDE else FALSE


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

    def never_aside(one: Scanned) -> Obligation:
        return TRUE, TRUE if _pair(one) in IN_ORDER else FALSE

    yield JUDGE.too_strong("nor those", never_aside, "Match")


def time_goes_on(one: Scanned) -> Obligation:
    before, after = _pair(one)
    if before != after or before not in CLOCKED:
        return None
    limit = deadline(before, one.params) if before in TIMED else one.params.T_DWELL_ms
    return TRUE, one.after.elapsed_ms >= z3.If(now(one) < limit, now(one), limit)


@theorem(clauses=["EKS-GP-3", "EKS-8-3"], findings=["E-36", "E-52"], properties=["TimeGoesOn"], slow=True)
def the_fplc_counts_the_time_of_every_scan_that_waits() -> Queries:
    """In a state that counts time, every scan that stays there adds its own, up to the deadline or to the
    dwell time.
    """
    yield from JUDGE.in_every_scan(time_goes_on)

    def faster(one: Scanned) -> Obligation:
        return None if time_goes_on(one) is None else (TRUE, one.after.elapsed_ms > now(one))

    yield JUDGE.too_strong("and runs ahead", faster, "Settle")


def selection_stands(one: Scanned) -> z3.BoolRef:
    """MW03 carries the word of the latched selection."""
    stands: z3.BoolRef = one.inputs.MW03 == code("SE", one.before.selection)
    return stands


def acknowledgment_needs_echo(one: Scanned) -> Obligation:
    if not one.was("AwaitSelection", "CheckSelection", "EchoSelection"):
        return None
    early = z3.And(signalled(one), one.inputs.MW07 != 0)
    if one.was("EchoSelection"):
        early = z3.And(early, selection_stands(one))
    return early, TRUE if one.becomes("Error") else FALSE


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

    def any_time(one: Scanned) -> Obligation:
        obligation = z3.And(signalled(one), one.inputs.MW07 != 0)
        return obligation, TRUE if one.becomes("Error") else FALSE

    yield JUDGE.too_strong("and after it too", any_time, "AwaitAcknowledgment")


def changed_selection_is_withdrawn(one: Scanned) -> Obligation:
    if not one.was(*TRANSACTION):
        return None
    changed = z3.And(signalled(one), z3.Not(selection_stands(one)))
    return changed, one.after.mode == one.before.mode if one.becomes("Settle") else FALSE


@theorem(
    clauses=["EKS-2-25"],
    findings=["E-16", "E-21", "E-61"],
    properties=["ChangedSelectionIsWithdrawn"],
    slow=True,
)
def the_fplc_takes_back_a_selection_that_no_longer_stands() -> Queries:
    """While the key stands, a scan of a transaction that finds another word than that of the selection in
    MW03 leads to Settle and leaves the mode as it is, whatever MW07 shows.
    """
    yield from JUDGE.in_every_scan(changed_selection_is_withdrawn)

    def a_code_is_an_error(one: Scanned) -> Obligation:
        obligation = changed_selection_is_withdrawn(one)
        refused = z3.And(one.inputs.MW07 != 0, TRUE if one.becomes("Settle") else FALSE)
        return None if obligation is None else (obligation[0], z3.Not(refused))

    yield JUDGE.too_strong("but not beside a word in MW07", a_code_is_an_error, "Switch")


def acknowledgment_is_judged(one: Scanned) -> Obligation:
    if not one.was("AwaitAcknowledgment", "CheckAcknowledgment", "Match", "Switch"):
        return None
    stands = z3.And(signalled(one), selection_stands(one))
    if one.was("AwaitAcknowledgment"):
        return stands, z3.BoolVal(not one.becomes("Error"))
    MW07 = one.inputs.MW07
    settles = one.after.mode == one.before.mode if one.becomes("Settle") else FALSE
    refused, matched = z3.BoolVal(one.becomes("Error")), z3.BoolVal(one.becomes("Match"))
    other = refused
    if one.was("CheckAcknowledgment"):
        other = z3.If(mode("SW", MW07) != NONE, matched, refused)
    own = MW07 == code("SW", one.before.selection)
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

    def never_refused(one: Scanned) -> Obligation:
        obligation = acknowledgment_is_judged(one)
        return None if obligation is None else (obligation[0], z3.BoolVal(not one.becomes("Error")))

    yield JUDGE.too_strong("and is never refused", never_refused, "Match")
