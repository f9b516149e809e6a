"""How long the two pages take to be made, how large they are, and when Chromium has them ready."""

from __future__ import annotations

import shutil
import statistics
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

from modeproof.report.build import make
from modeproof.simulate.build import make as simulate
from tests.report.browser.opened import ARGUMENTS, open_page

PAINT = "() => performance.getEntriesByType('paint')[0]?.startTime"
READY = "() => window.modeproofReady"
REPEATS = 5


def show_page(place: Path) -> None:
    """Two lines a page: how it was made, and when it is there, where there is a Chromium."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        for name, made, there, question in (
            ("report", lambda: make(place).html, "first paint", PAINT),
            ("simulate", lambda: simulate(place), "usable", READY),
        ):
            began = time.perf_counter()
            html = made()
            took = time.perf_counter() - began
            print(f"{name}: made in {took:.1f} s, {len(html.encode()) / 1e6:.1f} MB", flush=True)
            chromium = shutil.which("chromium")
            if chromium is None:
                print(f"{name}: {there} not measured: no chromium here")
                continue
            page = Path(folder, f"{name}.html")
            page.write_text(html, encoding="utf-8")
            browser = playwright.chromium.launch(executable_path=chromium, args=list(ARGUMENTS))
            times = []
            for _ in range(REPEATS):
                with open_page(browser, page) as opened:
                    opened.page.wait_for_function(f"() => ({question})() !== undefined")
                    times.append(float(opened.ask(question)))
            browser.close()
            print(
                f"{name}: {there} after {statistics.median(times):.0f} ms   least {min(times):.0f}, "
                f"greatest {max(times):.0f}, {REPEATS} repetitions",
                flush=True,
            )
