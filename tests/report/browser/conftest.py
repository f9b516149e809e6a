"""Chromium, started once for all tests of the page, and the page of the toy document.

MODEPROOF_CHROMIUM names the program (default: chromium on the PATH). Without one the tests are skipped, or
fail where MODEPROOF_BROWSER is `required`. MODEPROOF_REPORT names another page, for the tests that say
something of any page.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect, sync_playwright

from modeproof.report.build import make
from tests.report.box_graph import add_graph
from tests.report.box_vectors import put_vectors
from tests.report.browser.opened import ARGUMENTS, WAIT_MS, Opened, open_page
from tests.report.paper import make_paper, put, without


def program() -> str | None:
    """The path of Chromium; None where there is none."""
    named = os.environ.get("MODEPROOF_CHROMIUM")
    return shutil.which(named) if named else shutil.which("chromium")


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One Chromium for all tests; it can reach nothing but files."""
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


@pytest.fixture(scope="session")
def box_report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of the box: what is as expected, one thing that is not, and one that is missing."""
    root = make_paper(tmp_path_factory.mktemp("box"))
    add_graph(root)
    put_vectors(root)
    put(root, "MC_Box_lazy", verdict="VIOLATED", expected="HOLDS", as_expected=False, reason="it falls")
    without(root, "WIT_Box")
    return write(root / "report.html", make(root).html)


@pytest.fixture(scope="session")
def any_report(box_report: Path) -> Path:
    """The page of the box, or the one that MODEPROOF_REPORT names."""
    named = os.environ.get("MODEPROOF_REPORT")
    return Path(named).resolve() if named else box_report


@pytest.fixture
def box(browser: Browser, box_report: Path) -> Iterator[Opened]:
    """The page of the box, opened anew."""
    with open_page(browser, box_report) as opened:
        yield opened


@pytest.fixture(scope="module")
def anyone(browser: Browser, any_report: Path) -> Iterator[Opened]:
    """Any page, opened once for the tests of a module; they only look at it."""
    with open_page(browser, any_report) as opened:
        yield opened


def write(path: Path, html: str) -> Path:
    """A page as a file."""
    path.write_text(html, encoding="utf-8")
    return path
