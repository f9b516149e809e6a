"""A page in Chromium, what it said while it was open, and what may be asked of any page."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any
from unicodedata import normalize

from playwright.sync_api import Browser, Page, ViewportSize
from pypdf import PdfReader

ARGUMENTS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
WAIT_MS = 20_000
"""Limit for what always comes; a test that waits for what never comes ends after it."""
SCREEN = ViewportSize(width=1280, height=900)
A4_LANDSCAPE = ViewportSize(width=1031, height=703)
"""What lies between margins of 12 mm, in CSS pixels (96 an inch)."""
A4_UPRIGHT = ViewportSize(width=680, height=1000)
"""The same with margins of 15 mm at the sides."""
RULES = ("wcag2a", "wcag2aa", "wcag21a", "wcag21aa")

QUESTIONS = Path(__file__).with_name("questions.js")


@dataclass
class Opened:
    """An open page. `said` are messages of its console and its errors, `asked` what it wanted to load."""

    page: Page
    said: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)

    def ask(self, script: str, given: Any = None) -> Any:
        """What a function of JavaScript returns."""
        return self.page.evaluate(script, given)

    def open_annex(self) -> None:
        """Open every part of the annex, as a reader would."""
        self.ask("() => { for (const part of document.querySelectorAll('details.part')) part.open = true; }")

    def wrong(self, question: str) -> list[str]:
        """The answer to one of questions.js: cut, wordless, hidden, lost."""
        self.ask(QUESTIONS.read_text(encoding="utf-8"))
        found: list[str] = self.ask("(question) => questions[question]()", question)
        return found

    def inaccessible(self) -> list[str]:
        """What breaks WCAG 2.1, levels A and AA, as far as axe-core sees it."""
        axe = resources.files("axe_playwright_python").joinpath("axe.min.js").read_text(encoding="utf-8")
        self.ask(f"() => {{ {axe} }}")
        self.ask(QUESTIONS.read_text(encoding="utf-8"))
        found: list[str] = self.ask("(rules) => questions.inaccessible(rules)", list(RULES))
        return found

    def print_view(self, what: str = "all") -> None:
        """Lay the page out for paper: all of it on A4 landscape, or what is filed ("") on A4 upright."""
        self.page.set_viewport_size(A4_LANDSCAPE if what else A4_UPRIGHT)
        self.page.emulate_media(media="print")
        self.ask("(what) => { document.body.dataset.print = what; }", what)
        self.ask("() => { window.dispatchEvent(new Event('beforeprint')); }")

    def pdf(self, what: str = "") -> list[str]:
        """The page on paper, as the text of each sheet: what is filed, or `all`, or the `review` sheet."""
        self.ask("(what) => { document.body.dataset.print = what; }", what)
        made = self.page.pdf(prefer_css_page_size=True)
        sheets = PdfReader(io.BytesIO(made)).pages
        return [normalize("NFKC", sheet.extract_text()) for sheet in sheets]  # without ligatures


@contextmanager
def open_page(browser: Browser, path: Path, anchor: str = "") -> Iterator[Opened]:
    """Open a page without network; whatever it says and asks for is kept."""
    context = browser.new_context(viewport=SCREEN, offline=True, accept_downloads=True)
    context.set_default_timeout(WAIT_MS)
    try:
        opened = Opened(context.new_page())
        page = opened.page
        page.on("console", lambda message: opened.said.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: opened.said.append(f"error: {error}"))
        page.on("request", lambda request: opened.asked.append(request.url))
        page.goto(path.as_uri() + anchor)
        yield opened
    finally:
        context.close()
