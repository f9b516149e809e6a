"""For all tests: what is claimed is judged, not how fast this machine is or what else it does."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import HealthCheck, settings

ANY_MACHINE = "any machine"
"""The Hypothesis profile of all tests: an example may take as long as it takes, to draw and to try."""

settings.register_profile(
    ANY_MACHINE, settings.default, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile(ANY_MACHINE)


@pytest.fixture(scope="session", autouse=True)
def time_to_shrink() -> Iterator[None]:
    """How short a difference becomes rests on the attempts that a plan allows, never on seconds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("modeproof.kit.judge.SHRINKING_S", 600.0)
        yield
