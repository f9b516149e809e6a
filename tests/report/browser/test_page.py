"""The page in a real browser: silent, without network, readable without colour, by keyboard and on paper."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from tests.report.browser.conftest import write
from tests.report.browser.opened import Opened, open_page

IMAGE = '<img src="http://127.0.0.1:9/dot.png" alt="a dot">'
COLOURS = ('<b class="bad">✗</b>', '<b class="good">HOLDS</b>', '<b class="hole"></b>')
PALE = '<p style="color: #bbb; background: #fff">too pale to read</p>'
WIDE = '<div class="wide" id="too-wide"><table><tr><td style="min-width: 3000px">wide</td></tr></table></div>'
FAULTS = (
    "<script>console.error('said')</script>",
    "<script>throw new Error('thrown')</script>",
    IMAGE,
    *COLOURS,
    PALE,
    '<button></button><input type="text">',
    WIDE,
    '<table><tr style="display: none"><td>a row that does not show</td></tr></table>',
    '<a href="#no-such-place">lost</a>',
)


@pytest.fixture(scope="module")
def faulty(browser: Browser, box_report: Path) -> Iterator[Opened]:
    """The page of the box with every fault planted, and nothing that forbids them."""
    html = box_report.read_text(encoding="utf-8")
    assert html.count("</main>") == 1
    html = html.replace('http-equiv="Content-Security-Policy"', "")
    html = html.replace("</main>", f'<section id="planted">{"".join(FAULTS)}</section></main>')
    with open_page(browser, write(box_report.with_name("faulty.html"), html)) as opened:
        opened.page.wait_for_load_state("networkidle")
        opened.open_annex()
        yield opened


def test_it_opens_with_a_silent_console_and_requests_nothing(anyone: Opened, any_report: Path) -> None:
    anyone.page.wait_for_load_state("networkidle")
    assert anyone.said == []
    assert [url for url in anyone.asked if not url.startswith("data:")] == [any_report.as_uri()]


def test_an_error_or_a_request_would_be_noticed(faulty: Opened) -> None:
    assert "error: said" in faulty.said and "error: thrown" in faulty.said
    assert "http://127.0.0.1:9/dot.png" in faulty.asked


def test_the_page_itself_forbids_requests(browser: Browser, box_report: Path) -> None:
    html = box_report.read_text(encoding="utf-8").replace("</main>", f"{IMAGE}</main>")
    with open_page(browser, write(box_report.with_name("asking.html"), html)) as opened:
        opened.page.wait_for_load_state("networkidle")
        assert any("Content Security Policy" in one for one in opened.said)


def test_no_verdict_is_told_by_colour_alone(anyone: Opened) -> None:
    assert anyone.wrong("wordless") == []
    assert anyone.ask("() => document.querySelectorAll('.good').length") > 0


def test_a_colour_without_sign_and_word_would_be_noticed(faulty: Opened) -> None:
    assert faulty.wrong("wordless")[-3:] == list(COLOURS)


def test_the_box_shows_all_three_colours(faulty: Opened) -> None:
    for word in ("good", "bad", "hole"):
        assert faulty.ask("(word) => document.querySelectorAll(`#verdict .${word}`).length", word) > 0, word


def test_it_is_accessible(anyone: Opened) -> None:
    assert anyone.inaccessible() == []


def test_what_cannot_be_read_or_named_would_be_noticed(faulty: Opened) -> None:
    rules = {one.partition(":")[0] for one in faulty.inaccessible()}
    assert {"color-contrast", "button-name", "label"} <= rules


def test_every_link_in_the_page_leads_somewhere(anyone: Opened) -> None:
    """But for those to traces: a page has only the traces that were recorded."""
    assert [one for one in anyone.wrong("lost") if not one.startswith("#trace-")] == []


def test_a_link_that_leads_nowhere_would_be_noticed(faulty: Opened) -> None:
    assert "#no-such-place" in faulty.wrong("lost")


def test_a_figure_says_by_keyboard_where_it_comes_from(box: Opened) -> None:
    box.page.locator("#explorer-graphs").scroll_into_view_if_needed()
    figure = box.page.locator("#explorer-graphs.dataTable .figure").first
    figure.focus()
    box.page.keyboard.press("Enter")
    expect(box.page.locator("#source")).to_contain_text("build/evidence/box/refimpl_OPEN_Box.json: SHA-256 ")
    box.page.keyboard.press("Escape")
    expect(box.page.locator("#source")).to_be_hidden()


def test_a_table_filters_and_sorts_by_keyboard(box: Opened) -> None:
    page = box.page
    table = page.locator("#runs-box")
    table.scroll_into_view_if_needed()
    field = page.get_by_role("searchbox", name="Filter Every run of the model checker: A box")
    field.focus()
    page.keyboard.type("lazy")
    rows = table.locator("tbody tr")
    expect(rows).to_have_count(1)
    field.fill("")
    expect(rows).to_have_count(6)
    names = sorted(table.locator("tbody td:first-child").all_inner_texts())
    assert len(set(names)) == 6
    head = table.locator("thead").get_by_role("button").first
    head.focus()
    for order in (names, names[::-1]):
        page.keyboard.press("Enter")
        expect(table.locator("tbody td:first-child")).to_have_text(order)


def test_on_paper_nothing_is_cut_and_every_row_shows(browser: Browser, any_report: Path) -> None:
    with open_page(browser, any_report) as opened:
        opened.print_view()
        assert opened.wrong("cut") == []
        assert opened.wrong("hidden") == []


def test_a_row_that_a_filter_hides_is_printed(box: Opened) -> None:
    page = box.page
    table = page.locator("#explorer-graphs")
    table.scroll_into_view_if_needed()
    page.get_by_role("searchbox", name="Filter Graphs in this page").fill("nothing like this")
    expect(table.locator("tbody")).to_have_text("No row has these words.")
    box.print_view()
    expect(table.locator("tbody tr")).to_have_count(1)
    expect(table.locator("tbody")).to_contain_text("OPEN_Box")


def test_what_is_cut_or_hidden_on_paper_would_be_noticed(faulty: Opened) -> None:
    """The last of its page: afterwards it is laid out for paper."""
    faulty.print_view()
    assert any(one.startswith("DIV too-wide") for one in faulty.wrong("cut"))
    assert faulty.wrong("hidden") == ["TR planted: a row that does not show"]
