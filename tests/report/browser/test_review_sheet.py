"""The review sheet in a real browser: answered, kept as a file, read back; a broken file refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from modeproof.report.review_sheet import read_answers
from tests.report.browser.opened import Opened, open_page

ROW = "#review .row[data-row='box E-01']"


def keep(opened: Opened, path: Path) -> Path:
    """The sheet as the page keeps it."""
    with opened.page.expect_download() as download:
        opened.page.get_by_role("button", name="Keep as a file").click()
    download.value.save_as(path)
    return path


def test_answers_are_kept_and_read_back_by_page_and_command(
    browser: Browser, box_report: Path, box: Opened, tmp_path: Path
) -> None:
    page = box.page
    page.get_by_label("Name", exact=True).fill("=A. Reader")
    page.get_by_label("Day", exact=True).fill("2026-11-23")
    page.locator(ROW).get_by_label("reject").check()
    page.locator(ROW).get_by_label("Words about box E-01").fill('no; "never",\tsays it')
    expect(page.locator("#review-said")).to_contain_text("0 accepted, 1 rejected, 0 with a remark, 5 open")
    path = keep(box, tmp_path / "kept.csv")
    rows = page.locator("#review .row").evaluate_all("(rows) => rows.map((row) => row.dataset.row)")
    (answer,) = read_answers(path, rows).values()
    assert (answer.answer, answer.words) == ("reject", 'no; "never",\tsays it')
    assert (answer.name, answer.day) == ("'=A. Reader", "2026-11-23")
    with open_page(browser, box_report, "#review") as again:
        again.page.locator("#review-file").set_input_files(path)
        expect(again.page.locator("#review-said")).to_contain_text("1 rejected")
        expect(again.page.locator(ROW).get_by_label("reject")).to_be_checked()
        expect(again.page.locator(ROW).get_by_label("Words about box E-01")).to_have_value(
            'no; "never",\tsays it'
        )
        assert keep(again, tmp_path / "again.csv").read_bytes() == path.read_bytes() and again.said == []


def test_a_remark_without_words_is_not_kept(box: Opened) -> None:
    box.page.locator(ROW).get_by_label("remark").check()
    box.page.get_by_role("button", name="Keep as a file").click()
    expect(box.page.locator("#review-said")).to_have_text("Refused: box E-01: a remark without words")
    expect(box.page.locator(ROW).get_by_label("Words about box E-01")).to_be_focused()


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("reject", "perhaps", "perhaps is no answer"),
        ("box E-01", "box E-77", "this report has no row box E-77"),
        ("reject", '"reject', "a quote is not closed"),
        ("reject,", "reject,,", "has not as many cells as the first"),
    ],
)
def test_a_broken_file_is_refused_and_changes_nothing(
    box: Opened, tmp_path: Path, old: str, new: str, why: str
) -> None:
    box.page.locator(ROW).get_by_label("reject").check()
    path = keep(box, tmp_path / "kept.csv")
    path.write_text(path.read_text("utf-8-sig").replace(old, new, 1))
    box.page.locator(ROW).get_by_label("accept").check()
    box.page.locator("#review-file").set_input_files(path)
    expect(box.page.locator("#review-said")).to_contain_text("Refused: kept.csv: ")
    expect(box.page.locator("#review-said")).to_contain_text(why)
    expect(box.page.locator(ROW).get_by_label("accept")).to_be_checked()


def test_an_answer_to_an_earlier_text_is_not_taken(box: Opened, tmp_path: Path) -> None:
    box.page.locator(ROW).get_by_label("reject").check()
    path = keep(box, tmp_path / "kept.csv")
    text = box.page.locator(ROW).get_attribute("data-text")
    assert text
    path.write_text(path.read_text("utf-8-sig").replace(text, "0" * 12))
    box.page.locator(ROW).get_by_label("accept").check()
    box.page.locator("#review-file").set_input_files(path)
    expect(box.page.locator("#review-said")).to_contain_text("1 answers are to an earlier text")
    expect(box.page.locator(ROW).get_by_label("accept")).to_be_checked()
