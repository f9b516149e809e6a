"""How long the report takes to be made, how large it is, and when Chromium paints it first."""

from __future__ import annotations

import shutil
import statistics
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

from modeproof.report.build import make
from tests.report.browser.opened import ARGUMENTS, open_page

PAINT = "() => performance.getEntriesByType('paint')[0].startTime"
REPEATS = 5


def show_page(place: Path) -> None:
    """Two lines: the page, and its first paint where there is a Chromium."""
    began = time.perf_counter()
    html = make(place).html
    print(
        f"report: made in {time.perf_counter() - began:.1f} s, {len(html.encode()) / 1e6:.1f} MB", flush=True
    )
    path = shutil.which("chromium")
    if path is None:
        print("report: first paint not measured: no chromium here")
        return
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        page = Path(folder, "report.html")
        page.write_text(html, encoding="utf-8")
        browser = playwright.chromium.launch(executable_path=path, args=list(ARGUMENTS))
        paints = []
        for _ in range(REPEATS):
            with open_page(browser, page) as opened:
                paints.append(float(opened.ask(PAINT)))
        browser.close()
    print(
        f"report: first paint {statistics.median(paints):.0f} ms   least {min(paints):.0f}, "
        f"greatest {max(paints):.0f}, {REPEATS} repetitions",
        flush=True,
    )
