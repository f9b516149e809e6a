"""The devices whose mutants are judged, and what is known of their states; judges.py says by what."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import z3

from proofs.mode_selection import eks_safety, fplc_invariant, panel_safety, plc_safety
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from proofs.mode_selection.invariants import holds
from proofs.mode_selection.sentences import Judge
from proofs.mutants.shipped import Subject


def _known(judge: Judge) -> Callable[[Any], z3.BoolRef]:
    def of(state: Any) -> z3.BoolRef:
        return (
            holds(judge.invariant, judge.device, state, judge.seen) if judge.invariant else z3.BoolVal(True)
        )

    return of


SUBJECTS: Final = (
    Subject(FPLC, _known(fplc_invariant.JUDGE), "every_scan_of_the_fplc_takes_exactly_one_path"),
    Subject(HMI, _known(panel_safety.JUDGE), "every_scan_of_the_panel_takes_exactly_one_path"),
    Subject(PLC, _known(plc_safety.JUDGE), "every_scan_of_the_plc_takes_exactly_one_path"),
    Subject(EKS, _known(eks_safety.JUDGE), "every_scan_of_the_eks_takes_exactly_one_path"),
)
