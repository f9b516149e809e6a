"""A trace in a real browser: opened by its link, stepped forward and back by keyboard."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser, expect

from tests.report.box_vectors import SHUTS
from tests.report.browser.opened import open_page


def test_a_link_opens_a_trace_and_arrow_keys_step_it(browser: Browser, box_report: Path) -> None:
    with open_page(browser, box_report, f"#trace-box-{SHUTS}") as opened:
        page = opened.page
        expect(page.locator("#trace-view")).to_be_focused()
        step, current = page.locator("#trace-step"), page.locator("#trace-table tr[aria-current=step]")
        now = page.locator("#trace-diagram .step.now")
        expect(page.locator("#trace-about")).to_contain_text("The door comes and the box shuts.")
        expect(step).to_contain_text("Step 0 of 3: power-up")
        page.keyboard.press("ArrowRight")
        page.keyboard.press("ArrowRight")
        expect(step).to_have_text("Step 2 of 3: box executes Closebox is in Shut")
        expect(current.locator("td.changed")).to_have_text(["▸1", "▸Shut", "▸0F10 = code 1", "▸1"])
        expect(now).to_have_attribute("data-step", "2")
        expect(now).to_contain_text("door 1")
        page.keyboard.press("ArrowLeft")
        expect(step).to_contain_text("Step 1 of 3: box executes Wait")
        expect(current.locator("td.changed")).to_have_count(0)
        page.keyboard.press("End")
        expect(step).to_contain_text("Step 3 of 3: box executes Stay")
        page.keyboard.press("ArrowRight")
        expect(now).to_have_attribute("data-step", "3")
        page.keyboard.press("Home")
        expect(step).to_contain_text("Step 0 of 3")
        assert opened.said == []
