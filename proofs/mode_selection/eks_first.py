"""What the EKS owes besides: it begins without a key, and its output outlasts LA by one scan.

No property of the specification says these of the EKS alone; without them an edit of the code would pass all
theorems (docs/mode_selection.md).
"""

from __future__ import annotations

from typing import Any

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.mode_selection.eks_safety import JUDGE, same_vector
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem


def begins_empty(scan: Scanned, seen: Any) -> z3.BoolRef:
    return TRUE if scan.becomes("Empty") else FALSE


@theorem(clauses=["EKS-2-1", "EKS-8-1"], findings=[])
def the_eks_begins_without_a_key() -> Queries:
    """After power-up the EKS waits for a key."""
    yield from JUDGE.at_power_up(begins_empty)


def output_outlasts_la(scan: Scanned) -> Obligation:
    if not (scan.was("Signal") and scan.becomes("ClearOutputs")):
        return None
    return TRUE, same_vector(scan)


@theorem(clauses=["EKS-8-2", "EKS-8-5"], findings=[])
def the_output_of_the_eks_outlasts_la_by_one_scan() -> Queries:
    """In the scan in which LA goes off from Signal the outputs stay as they are; they go off a scan later."""
    yield from JUDGE.in_every_scan(output_outlasts_la)
