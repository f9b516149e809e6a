"""The devices whose mutants are judged, and what is known of their states; judges.py says by what."""

from __future__ import annotations

from typing import Final

from proofs.mode_selection import eks_safety, fplc_invariant, panel_safety, plc_safety
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC
from proofs.mutants.shipped import Subject

SUBJECTS: Final = (
    Subject(FPLC, fplc_invariant.JUDGE.known, "every_scan_of_the_fplc_takes_exactly_one_path"),
    Subject(HMI, panel_safety.JUDGE.known, "every_scan_of_the_panel_takes_exactly_one_path"),
    Subject(PLC, plc_safety.JUDGE.known, "every_scan_of_the_plc_takes_exactly_one_path"),
    Subject(EKS, eks_safety.JUDGE.known, "every_scan_of_the_eks_takes_exactly_one_path"),
)
