"""What the F-PLC bears without giving up, and that it does what was asked when all is there.

No property of the specification says these of the F-PLC alone; without them an edit of the code would pass
all theorems (docs/mode_selection.md).
"""

# ruff: noqa: SIM300 -- the names of words are upper case
from __future__ import annotations

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.mode_selection.fplc_invariant import JUDGE
from proofs.mode_selection.fplc_order import selection_stands
from proofs.mode_selection.fplc_prompt import signalled
from proofs.mode_selection.fplc_safety import now
from proofs.mode_selection.invariants import TRANSACTION
from proofs.mode_selection.vocabulary import code
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem


def outputs_may_switch_one_by_one(scan: Scanned) -> Obligation:
    if not scan.was("PulseOnes", "PulseZeros"):
        return None
    limit = scan.params.T_ON_ms if scan.was("PulseOnes") else scan.params.T_SEQ_ms
    within = z3.And(scan.inputs.LA, now(scan) < limit)
    return within, TRUE if scan.becomes("PulseOnes", "PulseZeros", "OneOutput") else FALSE


@theorem(clauses=["EKS-2-10", "EKS-4-1", "EKS-4-3"], findings=["E-09", "E-10"], slow=True)
def in_the_test_pulse_outputs_may_switch_one_by_one() -> Queries:
    """While LA is on and the deadline of the state is not reached, no scan of PulseOnes or PulseZeros ends
    the insertion, whichever outputs are set.
    """
    yield from JUDGE.in_every_scan(outputs_may_switch_one_by_one)

    def at_any_time(scan: Scanned) -> Obligation:
        said = outputs_may_switch_one_by_one(scan)
        return None if said is None else (scan.inputs.LA, said[1])

    yield JUDGE.too_strong("at any time", at_any_time, "PulseZeros")


def settle_needs_cause(scan: Scanned) -> Obligation:
    if scan.was("Settle") or not scan.becomes("Settle"):
        return None
    if scan.was("CheckSelection"):
        return TRUE, scan.inputs.MW03 == 0
    changed = scan.inputs.MW03 != code("SE", scan.before.selection)
    if scan.was("CheckAcknowledgment", "Match"):
        return TRUE, z3.Or(changed, scan.inputs.MW07 == 0)
    if scan.was("Switch"):
        judged = z3.Or(scan.inputs.MW07 == 0, scan.inputs.MW07 == code("SW", scan.before.selection))
        return TRUE, z3.Or(changed, judged)
    return TRUE, changed if scan.was(*TRANSACTION) else FALSE


@theorem(
    clauses=["EKS-2-17", "EKS-2-20", "EKS-2-25", "EKS-2-27"], findings=["E-11", "E-16", "E-21"], slow=True
)
def the_fplc_gives_up_a_selection_only_for_a_cause() -> Queries:
    """A scan leads to Settle only if the selection does not stand in MW03 any more, or, from the first
    acknowledgment on, MW07 is zero again, or the mode was switched; so that the echo waits for the user.
    """
    yield from JUDGE.in_every_scan(settle_needs_cause)

    def by_mw03_alone(scan: Scanned) -> Obligation:
        if settle_needs_cause(scan) is None:
            return None
        return TRUE, scan.inputs.MW03 != code("SE", scan.before.selection)

    yield JUDGE.too_strong("by MW03 alone", by_mw03_alone, "Match")


def checks_what_is_there(scan: Scanned) -> Obligation:
    if scan.was("AwaitSelection") and scan.becomes("CheckSelection"):
        return TRUE, scan.inputs.MW03 != 0
    if scan.was("AwaitAcknowledgment") and scan.becomes("CheckAcknowledgment"):
        return TRUE, scan.inputs.MW07 != 0
    return None


@theorem(clauses=["EKS-2-17", "EKS-2-27"], findings=["E-11"], slow=True)
def the_fplc_checks_only_a_word_that_is_there() -> Queries:
    """AwaitSelection is left for the check only over a word in MW03, AwaitAcknowledgment only over a word in
    MW07.
    """
    yield from JUDGE.in_every_scan(checks_what_is_there)


def switches_when_all_stands(scan: Scanned) -> Obligation:
    if not scan.was("Switch"):
        return None
    acknowledged = scan.inputs.MW07 == code("SW", scan.before.selection)
    switched = scan.after.mode == scan.before.selection if scan.becomes("Complete", "Settle") else FALSE
    return z3.And(signalled(scan), selection_stands(scan), acknowledged), switched


@theorem(clauses=["EKS-2-29"], findings=["E-01", "E-42"], slow=True)
def the_fplc_switches_when_all_words_stand() -> Queries:
    """A scan of Switch in which the key is signalled and both words stand for the latched selection makes
    that mode the active one.
    """
    yield from JUDGE.in_every_scan(switches_when_all_stands)

    def by_the_key_alone(scan: Scanned) -> Obligation:
        said = switches_when_all_stands(scan)
        return None if said is None else (signalled(scan), said[1])

    yield JUDGE.too_strong("by the key alone", by_the_key_alone, "Switch")
