"""What else the F-PLC owes to each scan: an answer to each word, times that begin and end where they must.

No property of the specification says these of the F-PLC alone; without them an edit of the code would pass
all theorems (docs/mode_selection.md).
"""

# ruff: noqa: SIM300 -- the names of words are upper case
from __future__ import annotations

from typing import Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.mode_selection.devices import FPLC
from proofs.mode_selection.fplc_invariant import JUDGE
from proofs.mode_selection.fplc_prompt import no_word, signalled
from proofs.mode_selection.fplc_safety import now
from proofs.mode_selection.invariants import CLOCKED
from proofs.mode_selection.observer import Seen
from proofs.mode_selection.vocabulary import code, mode, permits
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem

DWELLING: Final = ("Start", "Error")
"""The states that count time up to T_DWELL."""
GOING_ON: Final = (("PulseOnes", "PulseZeros"), ("PulseZeros", "OneOutput"), ("Clear", "AwaitZeros"))
"""From one step to the next the time of the insertion, or of the removal, goes on."""


def selection_is_answered(scan: Scanned) -> Obligation:
    if not scan.was("CheckSelection"):
        return None
    i, chosen = scan.inputs, mode("SE", scan.inputs.MW03)
    good = permits(scan.params, scan.before.authority, chosen)
    latched = scan.after.selection == chosen if scan.becomes("EchoSelection") else FALSE
    back = TRUE if scan.becomes("Settle") else FALSE
    judged = z3.If(i.MW03 == 0, back, z3.If(good, latched, scan.sends.ERROR))
    return z3.And(signalled(scan), i.MW07 == 0), judged


@theorem(clauses=["EKS-2-18", "EKS-2-19", "EKS-T2-2"], findings=["E-14", "E-16", "E-21", "E-47"], slow=True)
def each_selection_has_one_answer() -> Queries:
    """In CheckSelection, while the key is signalled and MW07 is zero: a word in MW03 that means a mode which
    the machine permits to the level is latched, zero takes the selection back, and every other word leads to
    the error mode.
    """
    yield from JUDGE.in_every_scan(selection_is_answered)

    def never(scan: Scanned) -> Obligation:
        return None if selection_is_answered(scan) is None else (TRUE, scan.sends.ERROR)

    yield JUDGE.too_strong("always the error mode", never, "CheckSelection")


def level_is_published(scan: Scanned) -> Obligation:
    if not scan.was("Authorize"):
        return None
    shown = scan.sends.MW01 == code("RE", scan.before.accepted)
    return signalled(scan), z3.If(no_word(scan), shown, scan.sends.ERROR)


@theorem(clauses=["EKS-2-12"], findings=["E-06b", "E-54"], slow=True)
def the_fplc_publishes_the_level_or_refuses_an_early_word() -> Queries:
    """In Authorize, while the key is signalled, MW01 gets the word of its level in that scan; but a word in
    MW03 or MW07, which cannot be an answer yet, leads to the error mode.
    """
    yield from JUDGE.in_every_scan(level_is_published)


def pulse_is_seen_in_its_scan(scan: Scanned) -> Obligation:
    if not scan.was("Idle"):
        return None
    return scan.inputs.LA, TRUE if scan.becomes("PulseOnes") else FALSE


@theorem(clauses=["EKS-2-6", "EKS-9-4-FPLC"], findings=["E-73"], slow=True)
def la_begins_the_insertion_whatever_the_outputs_show() -> Queries:
    """In Idle a scan with LA begins the insertion, also when outputs are set already."""
    yield from JUDGE.in_every_scan(pulse_is_seen_in_its_scan)


# ---------------------------------------------------------------- times


def begins_at_zero(scan: Scanned) -> Obligation:
    before, after = control(FPLC, scan.before), control(FPLC, scan.after)
    if before == after or after not in CLOCKED:
        return None
    zero = scan.after.elapsed_ms == 0
    if (before, after) not in GOING_ON:
        return TRUE, zero
    return TRUE, z3.Or(zero, scan.after.elapsed_ms == now(scan))


@theorem(clauses=["EKS-2-6", "EKS-4-2", "EKS-8-3"], findings=["E-38", "E-52"], slow=True)
def every_time_of_the_fplc_begins_at_zero() -> Queries:
    """A scan that enters a state that counts time sets the timer to 0, or, from one step of the insertion or
    of the removal to the next, lets it go on by the time that passed.
    """
    yield from JUDGE.in_every_scan(begins_at_zero)

    def always(scan: Scanned) -> Obligation:
        return None if begins_at_zero(scan) is None else (TRUE, scan.after.elapsed_ms == 0)

    yield JUDGE.too_strong("never goes on", always, "Clear")


def dwell_in_range(scan: Scanned, seen: Seen) -> z3.BoolRef:
    return scan.after.elapsed_ms <= scan.params.T_DWELL_ms if scan.becomes(*DWELLING) else TRUE


@theorem(clauses=["EKS-GP-3", "EKS-8-18"], findings=["E-52"], slow=True)
def no_dwell_time_of_the_fplc_counts_beyond_its_end() -> Queries:
    """At power-up and after every scan the timer of Start and Error is at most T_DWELL, however long
    the F-PLC stays there, so that no timer of a machine overflows.
    """
    yield from JUDGE.after_every_scan(dwell_in_range)

    def less(scan: Scanned) -> Obligation:
        return TRUE, scan.after.elapsed_ms < scan.params.T_DWELL_ms

    yield JUDGE.too_strong("and never reaches it", less, "Error")
