"""For all tests: what is claimed is judged, not how fast this machine is or what else it does."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.any_machine import PATIENCE_S, no_hurry
from tests.groups import group_of

no_hurry()
HERE = Path(__file__).resolve().parent


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Say which tests share a process when several run at once (`make test`)."""
    for item in items:
        item.add_marker(pytest.mark.xdist_group(group_of(item.path.relative_to(HERE))))


@pytest.fixture(scope="session", autouse=True)
def time_to_shrink() -> Iterator[None]:
    """How short a difference becomes rests on the attempts that a plan allows, never on seconds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("modeproof.kit.judge.SHRINKING_S", PATIENCE_S)
        yield
