"""What is filed, on paper: headed and numbered, no heading alone, no name broken, the annex on request."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from modeproof.report.build import make
from modeproof.report.filing import Filing
from tests.report.browser.conftest import write
from tests.report.browser.opened import Opened, open_page
from tests.report.paper import make_whole

ROOT = Path(__file__).resolve().parents[3]
DAY = "2026-11-23"
NAMED = re.compile(r"\b(?=\w*_)[A-Za-z]\w{7,}\b")
"""A name that is long enough to be broken."""
FILED = """() => [...document.querySelectorAll('main > section:not(.annex)')].map((part) => {
  const copy = part.cloneNode(true);
  for (const one of copy.querySelectorAll('.annex, .screen, .beside, button, .hidden')) one.remove();
  const words = document.createTreeWalker(copy, NodeFilter.SHOW_TEXT), found = [];
  while (words.nextNode()) found.push(words.currentNode.data);
  return found.join(' ');
}).join(' ')"""
HEADINGS = "() => [...document.querySelectorAll('main h2, main h3, main h4')].map((one) => one.textContent)"


@pytest.fixture(scope="module")
def filed(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Opened]:
    """The report on the box, as it is filed."""
    place = make_whole(tmp_path_factory.mktemp("filed"))
    page = write(place / "report.html", make(place, filing=Filing(day=DAY)).html)
    with open_page(browser, page) as opened:
        yield opened


def squeezed(text: str) -> str:
    """A text as its words."""
    return " ".join(text.split())


def body(sheet: str) -> list[str]:
    """The lines of a sheet without what stands on every one of them."""
    margins = re.compile(rf"page \d+ of \d+.*|no commit|commit .*|.*{DAY}$")
    lines = [squeezed(line) for line in sheet.splitlines()]
    return [line for line in lines if line and not margins.fullmatch(line)]


def unheaded(sheets: Sequence[str], title: str) -> list[int]:
    """The sheets on which title, commit, day or number is missing."""
    of = len(sheets)
    wanted = [(title, DAY, "commit", f"page {number} of {of}") for number in range(1, of + 1)]
    return [
        number
        for number, (sheet, words) in enumerate(zip(sheets, wanted, strict=True), 1)
        if not all(word in squeezed(sheet) for word in words)
    ]


def lonely(sheets: Sequence[str], headings: Sequence[str]) -> list[str]:
    """Headings that are the last line of a sheet."""
    known = {squeezed(heading) for heading in headings}
    return [lines[-1] for sheet in sheets if (lines := body(sheet)) and lines[-1] in known]


def broken(sheets: Sequence[str], text: str) -> set[str]:
    """Names of the page that do not stand on the sheets in one piece."""
    return set(NAMED.findall(text)) - set(NAMED.findall("\n".join(sheets)))


def test_what_is_filed_has_headed_and_numbered_pages(filed: Opened) -> None:
    sheets = filed.pdf()
    assert unheaded(sheets, "A box") == [] and len(sheets) < 10
    assert lonely(sheets, filed.ask(HEADINGS)) == []
    assert broken(sheets, filed.ask(FILED)) == set()


def test_the_first_page_is_one_page(filed: Opened) -> None:
    first, second, *_ = filed.pdf()
    assert "What was examined, and what came out" in first and "Sign-off" in first and "Words." in first
    assert body(second)[0] == "Safety functions"


@pytest.mark.deep
def test_the_annex_is_printed_on_request_alone(filed: Opened) -> None:
    sheets, everything = filed.pdf(), filed.pdf("all")
    assert not any("Traceability matrix" in sheet for sheet in sheets)
    assert any("Traceability matrix" in sheet for sheet in everything) and len(everything) > len(sheets)


def test_the_review_sheet_prints_alone(filed: Opened) -> None:
    sheets = filed.pdf("review")
    assert body(sheets[0])[0] == "Review sheet" and "Safety functions" not in "".join(sheets)
    assert len(re.findall(r"\baccept\b", "".join(sheets))) == 6 and "BX-1-2" in sheets[-1]


def test_no_chart_is_split_on_paper(box: Opened) -> None:
    box.print_view()
    tall = """() => [...document.querySelectorAll('figure.drawing')].map((one) =>
      [one.getBoundingClientRect().height, getComputedStyle(one).breakInside])"""
    found = box.ask(tall)
    assert found and all(height < 690 and inside == "avoid" for height, inside in found)


def test_a_fault_of_the_paper_would_be_noticed(browser: Browser, filed: Opened) -> None:
    sheets = filed.pdf()
    assert unheaded([sheets[0].replace(DAY, ""), *sheets[1:]], "A box") == [1]
    assert lonely(["x\nFindings\nno commit\npage 1 of 1\n"], filed.ask(HEADINGS)) == ["Findings"]
    filed.ask("() => document.querySelector('.functions td b').append('LONG_' + 'name_of_a_thing'.repeat(9))")
    style = ".functions td { overflow-wrap: anywhere !important; }"
    filed.page.add_style_tag(content=style)
    assert broken(filed.pdf(), filed.ask(FILED)) != set()


@pytest.mark.deep
def test_the_report_on_all_documents_has_15_to_25_pages(
    browser: Browser, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Without evidence: what is not there takes as much room as a verdict."""
    place = tmp_path_factory.mktemp("ours")
    for folder in ("spec", "docs", "refimpl", "proofs"):
        (place / folder).symlink_to(ROOT / folder)
    page = write(place / "report.html", make(place, filing=Filing(day=DAY)).html)
    with open_page(browser, page) as opened:
        sheets = opened.pdf()
        assert 15 <= len(sheets) <= 25 and unheaded(sheets, "5 safety procedures") == []
        assert lonely(sheets, opened.ask(HEADINGS)) == []
        assert broken(sheets, opened.ask(FILED)) == set()
        assert body(sheets[1])[0] == "Safety functions", "the first page is one page"
