"""Waits for what must come, however busy the machine is."""

from __future__ import annotations

import time
from collections.abc import Callable

PATIENCE_S = 600.0
"""Limit for what always comes in a sound program; reached only when it never comes."""


def until(true: Callable[[], bool], what: str) -> None:
    """Return as soon as it is true. Fails, naming `what` did not come, after PATIENCE_S."""
    end = time.monotonic() + PATIENCE_S
    while not true():
        assert time.monotonic() < end, f"{what}: not within {PATIENCE_S:.0f} s"
        time.sleep(0.02)
