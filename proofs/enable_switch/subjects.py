"""The block whose mutants are judged, and what is known of its states; judges.py says by what."""

from __future__ import annotations

from typing import Final

from proofs.enable_switch.devices import SWITCH
from proofs.enable_switch.invariants import JUDGE
from proofs.mutants.shipped import Subject

SUBJECTS: Final = (Subject(SWITCH, JUDGE.known, "every_call_of_the_switch_takes_exactly_one_path"),)
