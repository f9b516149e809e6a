"""What the theorems share, made once, before several processes prove them side by side."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from proofs.explorer.device import judging, scans
from proofs.explorer.scanned import scans_of
from proofs.testable_safety_sensor.devices import SENSOR


@contextmanager
def prepared() -> Iterator[None]:
    """The block linted, explored and read. Inside, that is not done again: the code cannot change there.

    Raises ExplorationError or TheoremError for code that cannot be explored or read.
    """
    with judging(SENSOR, scans(SENSOR)):
        scans_of(SENSOR)
        yield
