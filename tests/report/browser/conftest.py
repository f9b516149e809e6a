"""The page of the toy document; MODEPROOF_REPORT names another, for tests that say something of any page."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from modeproof.report.build import make
from tests.report.box_graph import add_graph
from tests.report.box_machine import add_machine
from tests.report.box_vectors import put_vectors
from tests.report.browser.opened import Opened, open_page
from tests.report.paper import make_paper, put, without


@pytest.fixture(scope="session")
def box_report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of the box: what is as expected, one thing that is not, and one that is missing."""
    root = make_paper(tmp_path_factory.mktemp("box"))
    add_graph(root)
    put_vectors(root)
    add_machine(root)
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
        opened.open_annex()
        yield opened


@pytest.fixture(scope="module")
def anyone(browser: Browser, any_report: Path) -> Iterator[Opened]:
    """Any page, opened once for the tests of a module; they only look at it."""
    with open_page(browser, any_report) as opened:
        opened.open_annex()
        yield opened


def write(path: Path, html: str) -> Path:
    """A page as a file."""
    path.write_text(html, encoding="utf-8")
    return path
