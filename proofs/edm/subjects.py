"""The device whose mutants are judged, and what is known of its states; judges.py says by what."""

from __future__ import annotations

from typing import Final

from proofs.edm.devices import BLOCK
from proofs.edm.invariant import JUDGE
from proofs.mutants.shipped import Subject

SUBJECTS: Final = (Subject(BLOCK, JUDGE.known, "every_call_takes_exactly_one_path"),)
