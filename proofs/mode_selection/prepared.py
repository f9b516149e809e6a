"""What the theorems share, made once, before several processes prove them side by side."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from proofs.explorer.device import judging, scans
from proofs.explorer.scanned import scans_of
from proofs.mode_selection.devices import EKS, FPLC, HMI, PLC


@contextmanager
def prepared() -> Iterator[None]:
    """Every device linted, explored and read. Inside, that is not done again: the code cannot change there.

    Raises ExplorationError or TheoremError for code that cannot be explored or read.
    """
    with ExitStack() as stack:
        for device in (EKS, FPLC, HMI, PLC):
            stack.enter_context(judging(device, scans(device)))
            scans_of(device)
        yield
