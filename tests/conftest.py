"""For all tests: what is claimed is judged, not how fast this machine is or what else it does."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.any_machine import PATIENCE_S, no_hurry

no_hurry()


@pytest.fixture(scope="session", autouse=True)
def time_to_shrink() -> Iterator[None]:
    """How short a difference becomes rests on the attempts that a plan allows, never on seconds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("modeproof.kit.judge.SHRINKING_S", PATIENCE_S)
        yield
