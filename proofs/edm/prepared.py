"""What the theorems share, made once, before several processes prove them side by side."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from proofs.edm.devices import BLOCK
from proofs.explorer.device import judging, scans
from proofs.explorer.scanned import scans_of


@contextmanager
def prepared() -> Iterator[None]:
    """The block linted, explored and read. Inside, that is not done again: the code cannot change there.

    Raises ExplorationError or TheoremError for code that cannot be explored or read.
    """
    with judging(BLOCK, scans(BLOCK)):
        scans_of(BLOCK)
        yield
