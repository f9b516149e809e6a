"""For all tests: what is claimed is judged, not how fast this machine is or what else it does."""

from __future__ import annotations

import os
import shutil
import signal
from collections.abc import Iterator
from pathlib import Path, PurePath
from typing import Any

import pytest
from xdist.scheduler import LoadScopeScheduling

HERE = Path(__file__).resolve().parent
# Modules beside the tests assert too and show their values. This must come before they are imported.
pytest.register_assert_rewrite(*(f"tests.{path.stem}" for path in HERE.iterdir()))

from modeproof.ground.solvers import needing_solvers  # noqa: E402
from tests.any_machine import PATIENCE_S, no_hurry  # noqa: E402
from tests.groups import group_of, in_order  # noqa: E402
from tests.tiers import divide  # noqa: E402

no_hurry()
signal.signal(signal.SIGINT, signal.default_int_handler)  # whoever started us may have them ignored, as nohup
for number in (signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else [])):
    signal.signal(number, signal.SIG_DFL)


class ByGroup(LoadScopeScheduling):  # type: ignore[misc]
    """Tests that share a process are one unit of work (`make test`)."""

    def _split_scope(self, nodeid: str) -> str:
        return group_of(PurePath(nodeid.partition("::")[0]).relative_to(HERE.name))


def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> ByGroup:
    """Several processes take groups, whatever `--dist` says. (Its own groups have no effect with this pytest:
    the suffix that they put on the id of a test is lost.)
    """
    return ByGroup(config, log)


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """The order of the groups is ours (`in_order`)."""
    if hasattr(config.option, "loadscopereorder"):
        config.option.loadscopereorder = False


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Cases are put into tiers before `-m` chooses among them; several processes take groups in our order."""
    divide(items)
    if hasattr(config, "workerinput"):
        groups = [group_of(PurePath(item.nodeid.partition("::")[0]).relative_to(HERE.name)) for item in items]
        items[:] = [items[place] for place in in_order(groups)]


@pytest.fixture(scope="session", autouse=True)
def time_to_shrink() -> Iterator[None]:
    """How short a difference becomes rests on the attempts that a plan allows, never on seconds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("modeproof.kit.suite_judge.SHRINKING_S", PATIENCE_S)
        yield


@pytest.fixture
def deaf() -> Iterator[None]:
    """For tests that interrupt this process: z3 would stop for good, and other tests still need it."""
    with needing_solvers():
        import proofs.theorem  # noqa: F401
    before = signal.set_wakeup_fd(-1)
    yield
    signal.set_wakeup_fd(before)


def program() -> str | None:
    """The path of Chromium; None where there is none."""
    named = os.environ.get("MODEPROOF_CHROMIUM")
    return shutil.which(named) if named else shutil.which("chromium")


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """One Chromium for all tests of a process; it can reach nothing but files.

    MODEPROOF_CHROMIUM names the program (default: chromium on the PATH). Without one the tests are skipped,
    or fail where MODEPROOF_BROWSER is `required`.
    """
    from playwright.sync_api import expect, sync_playwright

    from tests.report.browser.opened import ARGUMENTS, WAIT_MS

    path = program()
    if path is None:
        reason = "no chromium here (Debian: apt install chromium), or MODEPROOF_CHROMIUM names none"
        if os.environ.get("MODEPROOF_BROWSER") == "required":
            pytest.fail(f"MODEPROOF_BROWSER=required: {reason}")
        pytest.skip(reason)
    expect.set_options(timeout=WAIT_MS)
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=path, args=list(ARGUMENTS))
        yield started
        started.close()
