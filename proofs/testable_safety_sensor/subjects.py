"""The device whose mutants are judged, and what is known of its states; judges.py says by what."""

from __future__ import annotations

from typing import Final

from proofs.mutants.shipped import Subject
from proofs.testable_safety_sensor import sensor_safety
from proofs.testable_safety_sensor.devices import SENSOR

SUBJECTS: Final = (
    Subject(SENSOR, sensor_safety.JUDGE.known, "every_call_of_the_block_takes_exactly_one_path"),
)
