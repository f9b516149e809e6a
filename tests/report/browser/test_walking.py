"""The explorer in a real browser: a graph is walked by keyboard, by table and by link."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser, Page, expect

from tests.report.browser.opened import Opened, open_page

ID = "box-OPEN_Box"


def said(page: Page, text: str) -> None:
    """What a screen reader is told."""
    status = page.locator("#explore-said")
    assert status.get_attribute("aria-live") == "polite"
    expect(status).to_have_text(text)


def test_a_graph_is_opened_and_walked_by_keyboard_alone(box: Opened) -> None:
    page = box.page
    page.locator("#explore-graph").focus()
    page.keyboard.type("box: OPEN")
    said(page, "Power-up: Open (shut 0).")
    page.locator("#explore-input-0").focus()
    page.keyboard.type("TRUE")
    said(page, "This input leads by Close to Shut (shut 1)")
    page.locator("#explore-scan").focus()
    page.keyboard.press("Enter")
    said(
        page,
        "Scan 1: Close. Now in Shut. Changed: state = Shut, shut = 1, WORD = 0F10 (code 1), LAMP = TRUE.",
    )
    page.keyboard.press("ArrowLeft")
    said(page, "Power-up: Open (shut 0).")
    page.keyboard.press("ArrowRight")
    expect(page.locator("#explore-where")).to_have_text("State: Shut, after 1 scan")
    page.keyboard.press("Enter")
    said(page, "Scan 2: Stay. Now in Shut. Nothing changed.")
    page.keyboard.press("Home")
    said(page, "Power-up: Open (shut 0).")
    expect(page.locator("#explore-trail li")).to_have_count(1)
    assert box.said == []


def test_the_state_shows_memory_and_outputs_and_words_for_changes(box: Opened) -> None:
    page = box.page
    page.locator("#explore-graph").select_option(ID)
    page.get_by_role("button", name="Take Close to Shut (shut 1)").click()
    word = page.locator("#explore-values tr", has_text="WORD")
    expect(word).to_have_text("WORD0F10 (code 1)changed, was 0000a word")
    spare = page.locator("#explore-values tr", has_text="SPARE")
    expect(spare).to_contain_text("same")
    expect(page.locator("#explore-where")).to_be_focused()


def test_enabled_actions_say_their_inputs_and_what_they_cite(box: Opened) -> None:
    page = box.page
    page.locator("#explore-graph").select_option(ID)
    rows = page.locator("#explore-actions tbody tr")
    expect(rows).to_have_count(2)
    expect(rows.nth(0)).to_have_text("WaitBX-1-1the same statedoor = FALSE2 of 4Take")
    expect(rows.nth(1)).to_have_text("CloseBX-1-1, E-01Shut (shut 1)door = TRUE2 of 4Take")
    rows.nth(1).get_by_role("button").click()
    expect(rows).to_have_text(["StayBX-1-1the same stateevery input4 of 4Take"])


def test_a_chosen_state_is_reached_by_a_shortest_trail(box: Opened) -> None:
    page = box.page
    page.locator("#explore-graph").select_option(ID)
    page.locator("#explore-state").select_option("Shut (shut 1)")
    expect(page.locator("#explore-trail li")).to_have_text(
        ["power-up: Open", "Close to Shut; door = TRUE, dt_ms = 0 ms"]
    )


def test_a_trail_has_a_link_that_leads_to_its_end(browser: Browser, box: Opened, box_report: Path) -> None:
    page = box.page
    page.locator("#explore-graph").select_option(ID)
    page.get_by_role("button", name="Take Close to Shut (shut 1)").click()
    page.locator("#explore-scan").click()
    link = f"#explore-{ID}/2.2"
    expect(page.locator("#explore-link")).to_have_attribute("href", link)
    expect(page).to_have_url(box_report.as_uri() + link)
    with open_page(browser, box_report, link) as again:
        expect(again.page.locator("#explore-where")).to_have_text("State: Shut, after 2 scans")
        expect(again.page.locator("#explore-title")).to_be_focused()
        assert again.said == []


def test_a_link_that_does_not_fit_says_so(browser: Browser, box_report: Path) -> None:
    with open_page(browser, box_report, f"#explore-{ID}/2.99.1") as opened:
        expect(opened.page.locator("#explore-said")).to_contain_text(
            "names an input that this graph does not have; its trail ends before scan 2. Scan 1: Close."
        )
    with open_page(browser, box_report, "#explore-box-OPEN_None/1") as opened:
        said(opened.page, "This page has no graph box-OPEN_None.")


def test_a_property_says_its_subject_and_whether_it_holds_here(box: Opened) -> None:
    page = box.page
    page.locator("#explore-graph").select_option(ID)
    item = page.locator("#explore-properties li")
    expect(item).to_have_text(
        "ShutsOverDoor of each transition: It shuts only over the door. "
        "✓ Holds in the run that printed this graph."
    )


def test_a_trail_goes_back_and_keeps_what_lies_ahead(box: Opened) -> None:
    page = box.page
    page.locator("#explore-graph").select_option(ID)
    page.get_by_role("button", name="Take Close to Shut (shut 1)").click()
    page.locator("#explore-trail button").first.click()
    expect(page.locator("#explore-where")).to_have_text("State: Open, after power-up")
    expect(page.locator("#explore-trail li").nth(1)).to_contain_text("(ahead)")
    page.get_by_role("button", name="Forward").click()
    expect(page.locator("#explore-where")).to_have_text("State: Shut, after 1 scan")


def test_the_graph_is_not_unpacked_before_it_is_opened(box: Opened) -> None:
    page = box.page
    page.evaluate(
        """() => {
          const unpack = window.atob;
          window.unpacked = 0;
          window.atob = (text) => { window.unpacked += 1; return unpack(text); };
        }"""
    )
    before = page.evaluate("() => window.unpacked")
    expect(page.locator("#explore-body")).to_be_hidden()
    page.locator("#explore-graph").select_option(ID)
    expect(page.locator("#explore-body")).to_be_visible()
    assert (before, page.evaluate("() => window.unpacked") >= 2) == (0, True)
