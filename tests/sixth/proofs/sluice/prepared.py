"""What the theorems share, made once, before several processes prove them side by side."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from proofs.sluice.devices import DEVICES

from proofs.explorer.device import judging, scans
from proofs.explorer.scanned import scans_of


@contextmanager
def prepared() -> Iterator[None]:
    """Every device linted, explored and read."""
    with ExitStack() as stack:
        for device in DEVICES:
            stack.enter_context(judging(device, scans(device)))
            scans_of(device)
        yield
