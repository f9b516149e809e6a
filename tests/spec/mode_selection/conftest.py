"""Short TLC runs: Java need not optimise them, and two of them run at once."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor

import pytest

from tests.spec.mode_selection.planted import Finding, Trial


@pytest.fixture(scope="session", autouse=True)
def quick_java() -> Iterator[None]:
    """The first compiler of Java only: half the time for a run of a few seconds."""
    with pytest.MonkeyPatch.context() as patch:
        options = os.environ.get("JAVA_TOOL_OPTIONS", "")
        patch.setenv("JAVA_TOOL_OPTIONS", f"{options} -XX:TieredStopAtLevel=1".strip())
        yield


class Trials:
    """Gives what TLC says in a trial; each is run once. `wanted` are begun at once, two at a time."""

    def __init__(
        self, pool: ThreadPoolExecutor, folders: pytest.TempPathFactory, wanted: list[Trial]
    ) -> None:
        self._pool, self._folders = pool, folders
        self._known: dict[Trial, Future[Finding]] = {}
        for trial in wanted:
            self._begin(trial)

    def __call__(self, trial: Trial) -> Finding:
        return self._begin(trial).result()

    def _begin(self, trial: Trial) -> Future[Finding]:
        if trial not in self._known:
            self._known[trial] = self._pool.submit(trial.run, self._folders.mktemp("trial"))
        return self._known[trial]


@pytest.fixture(scope="session")
def trials(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, quick_java: None
) -> Iterator[Trials]:
    """Runs trials; those that the selected tests ask for by their parameter `trial` are begun beforehand."""
    params = [getattr(getattr(item, "callspec", None), "params", {}) for item in request.session.items]
    wanted = [one["trial"] for one in params if isinstance(one.get("trial"), Trial)]
    with ThreadPoolExecutor(max_workers=2) as pool:
        yield Trials(pool, tmp_path_factory, wanted)
        pool.shutdown(wait=True, cancel_futures=True)
