"""Short TLC runs: Java need not optimise them, and two of them run at once."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.spec.mode_selection.planted import Finding, Trial


@pytest.fixture(scope="session", autouse=True)
def quick_java() -> Iterator[None]:
    """The first compiler of Java only: half the time for a run of a few seconds."""
    with pytest.MonkeyPatch.context() as patch:
        options = os.environ.get("JAVA_TOOL_OPTIONS", "")
        patch.setenv("JAVA_TOOL_OPTIONS", f"{options} -XX:TieredStopAtLevel=1".strip())
        yield


@pytest.fixture(scope="session")
def trials(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, quick_java: None
) -> Iterator[dict[Trial, Future[Finding]]]:
    """What TLC says in each trial that the selected tests ask for, by their parameter `trial`."""
    wanted: dict[Trial, None] = {}
    for item in request.session.items:
        trial = getattr(getattr(item, "callspec", None), "params", {}).get("trial")
        if isinstance(trial, Trial):
            wanted[trial] = None
    with ThreadPoolExecutor(max_workers=2) as pool:
        yield {trial: pool.submit(trial.run, Path(tmp_path_factory.mktemp("trial"))) for trial in wanted}
        pool.shutdown(wait=True, cancel_futures=True)
