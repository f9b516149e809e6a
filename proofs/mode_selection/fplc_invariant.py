"""The invariant of the F-PLC is true at power-up, and every scan keeps it.

Initiation and consecution as separate plain queries; the properties that follow from it are in
fplc_safety.py.
"""

from __future__ import annotations

from typing import Final

from proofs.mode_selection.devices import FPLC
from proofs.mode_selection.invariants import FPLC_INVARIANT
from proofs.mode_selection.observer import NOTHING, SEEN, sees
from proofs.sentences import Judge
from proofs.theorem import Queries, theorem

JUDGE: Final = Judge(FPLC, FPLC_INVARIANT, SEEN, sees, NOTHING)


@theorem(clauses=["EKS-GP-5", "EKS-8-8"], findings=["E-25c"])
def the_invariant_of_the_fplc_is_true_at_power_up() -> Queries:
    """After power-up, with any parameters that the code accepts, the F-PLC is in a state of its invariant."""
    yield from JUDGE.initiation()


@theorem(clauses=["EKS-GP-3", "EKS-GP-4", "EKS-3-0", "EKS-9-0"], findings=["E-16", "E-18"], slow=True)
def every_scan_of_the_fplc_keeps_its_invariant() -> Queries:
    """From every state of the invariant, with any inputs and any elapsed time, every path of a scan of the
    F-PLC leads to a state of the invariant.

    One query for each control state and each one that follows it.
    """
    yield from JUDGE.consecution()
