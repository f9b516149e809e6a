"""What lets a test come out alike on every machine, however slow or busy it is."""

from __future__ import annotations

import time
from collections.abc import Callable

from hypothesis import HealthCheck, settings

PATIENCE_S = 600.0
"""Limit for what always comes in a sound program; reached only when it never comes."""
LONG_MS = 600_000
"""Limit for a solver that answers; reached only when it never does."""
SHARED_FIXTURE = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture]
"""What Hypothesis need not watch where all examples share what a fixture made, and may."""


def no_hurry() -> None:
    """Let Hypothesis take any time to draw an example and to try it, in all tests that are loaded after."""
    name = "any machine"
    settings.register_profile(
        name, settings.default, deadline=None, suppress_health_check=[HealthCheck.too_slow]
    )
    settings.load_profile(name)


def until(true: Callable[[], bool], what: str) -> None:
    """Return as soon as it is true. Fails, naming `what` did not come, after PATIENCE_S."""
    end = time.monotonic() + PATIENCE_S
    while not true():
        assert time.monotonic() < end, f"{what}: not within {PATIENCE_S:.0f} s"
        time.sleep(0.02)
