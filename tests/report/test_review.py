"""The review sheet: every entry once, the most important first, at most 150 rows, answered and read back."""

from __future__ import annotations

import csv
import hashlib
import io
from collections import Counter
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.report.filing import Filing
from modeproof.report.parts import review
from modeproof.report.parts.review import MOST, rows_of
from modeproof.report.review_sheet import HEADS, QUESTIONS, Item, tally
from modeproof.report.sources import gather
from tests.report.paper import change, make_whole

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The box with all that a report needs; the command line works on it."""
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    return make_whole(tmp_path)


def lines(root: Path) -> list[dict[str, str]]:
    """The empty sheet as a spreadsheet reads it."""
    content = review.part(gather(root)).attachments["review.csv"].decode("utf-8-sig")
    return list(csv.DictReader(io.StringIO(content, newline="")))


def write(path: Path, rows: list[dict[str, str]], between: str = ",") -> Path:
    """A sheet as a file."""
    with path.open("w", newline="", encoding="utf-8-sig") as file:
        writer = csv.DictWriter(file, list(rows[0]), delimiter=between)
        writer.writeheader()
        writer.writerows(rows)
    return path


def answered(root: Path, row: str, answer: str, words: str = "") -> Path:
    """A sheet in which one row has an answer."""
    rows = lines(root)
    (one,) = (line for line in rows if line["row"] == row)
    one |= {"answer": answer, "words": words, "name": "A. Reader", "day": "2026-11-23"}
    return write(root / "answered.csv", rows)


def test_every_entry_stands_in_one_row_and_what_matters_first(root: Path) -> None:
    rows = review.sheet(gather(root))
    assert [(row.id, row.items[0].group) for row in rows] == [
        ("box A-01", "assumption"),
        ("box E-01", "drawing"),
        ("box ShutsOverDoor", "requirement"),
        ("box E-02", "untried"),
        ("box BX-1-1", "clause"),
        ("box BX-1-2", "clause"),
    ]
    change(root / "spec/box/findings.toml", "drawing_could_settle = true", "drawing_could_settle = false")
    assert review.sheet(gather(root))[0].id == "box E-01"


def test_a_row_has_readings_decision_consequence_and_trace(root: Path) -> None:
    row = next(row for row in review.sheet(gather(root)) if row.id == "box E-01")
    assert row.readings == ("at once", "when the door is there")
    assert row.decision == "It waits for the door. And more." and row.consequence == "It shuts on a hand."
    assert [(trace.run, trace.steps and trace.steps.value) for trace in row.traces] == [
        ("NEG_Box_eager", 1),
        ("NEG_Box_hasty", 1),
    ]


def test_the_sheets_of_this_repository_have_150_rows_at_most(tmp_path: Path) -> None:
    for folder in ("spec", "docs"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    every = gather(tmp_path)
    items = list(review._items(every))
    chosen = [tuple(item for item in items if item.document == name) for name in every.documents]
    for some in (tuple(items), *chosen):
        rows = rows_of(some)
        assert len(rows) <= MOST and len({row.id for row in rows}) == len(rows)
        found = Counter((item.document, item.group, item.id) for row in rows for item in row.items)
        assert found == Counter((item.document, item.group, item.id) for item in some), "each entry once"
    urgent = [row for row in rows_of(items) if row.items[0].group in ("safety", "assumption")]
    assert len(urgent) > 80 and all(row.alone for row in urgent), "what matters most stands alone"


@pytest.mark.parametrize(
    ("most", "rows"), [(9, 7), (6, 5), (5, 5), (4, 4), (3, 2), (1, 2)], ids=lambda value: str(value)
)
def test_the_least_important_is_put_together_first(most: int, rows: int) -> None:
    def item(group: str, kind: str, id: str) -> Item:
        return Item(group, "box", kind, id, id, id)

    items = [item("clause", kind, f"C-{kind}{n}") for kind in "ab" for n in (1, 2)]
    items += [item("safety", "", f"E-{n}") for n in (1, 2, 3)]
    found = rows_of(items, most)
    assert len(found) == rows and found[0].items[0].group == "safety"
    if most >= 4:
        assert [row.id for row in found[:3]] == ["box E-1", "box E-2", "box E-3"]


def test_no_cell_of_the_sheet_is_taken_for_a_formula(root: Path) -> None:
    change(root / "spec/box/assumptions.toml", 'text = "There', 'text = "=1+1; There')
    row = next(line for line in lines(root) if line["row"] == "box A-01")
    assert row["readings"].startswith("'=1+1") and tuple(row) == HEADS
    assert {line["answer"] + line["words"] for line in lines(root)} == {""}


@pytest.mark.parametrize("between", [",", ";", "\t"])
def test_an_answer_is_kept_in_a_file_and_read_back(root: Path, between: str) -> None:
    path = answered(root, "box E-01", "Reject", 'no; "never", \nsays the drawing')
    rows = list(csv.DictReader(io.StringIO(path.read_text("utf-8-sig"), newline="")))
    write(path, rows, between)
    found = review.sheet(gather(root, Filing(answers=path)))
    answer = next(row.answer for row in found if row.id == "box E-01")
    assert answer is not None and (answer.answer, answer.name) == ("reject", "A. Reader")
    assert answer.words == 'no; "never", \nsays the drawing'
    assert tally(found) == {"rows": 6, "accept": 0, "reject": 1, "remark": 0, "open": 5}


def test_the_report_shows_the_answers_and_counts_them(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = answered(root, "box E-01", "remark", "see <b>Figure</b>")
    assert main(["report", "--quiet", "--review", str(path)]) == 0
    html = (root / "build/report/report.html").read_text()
    assert "0 accepted, 0 rejected, 1 with a remark, 5 open" in html
    assert f"Answers from answered.csv, SHA-256 <code>{hashlib.sha256(path.read_bytes()).hexdigest()}" in html
    assert 'value="see &lt;b&gt;Figure&lt;/b&gt;"' in html and "A. Reader 2026-11-23" in html
    kept = (root / "build/report/review.csv").read_text("utf-8-sig")
    assert "remark,see <b>Figure</b>,A. Reader,2026-11-23" in kept


def test_an_answer_to_an_earlier_text_does_not_count(root: Path) -> None:
    path = answered(root, "box E-01", "accept")
    change(root / "spec/box/findings.toml", "It waits for the door. And more.", "It waits no more.")
    found = review.sheet(gather(root, Filing(answers=path)))
    assert tally(found)["accept"] == 0 and [row.id for row in found if row.outdated] == ["box E-01"]


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("accept", "perhaps", "'perhaps' is no answer; write accept, reject or remark"),
        ("accept,", "remark,", "a remark without words"),
        ("box E-01", "box E-77", "this report has no row 'box E-77'"),
        ("box E-01", "box E-02", "the row 'box E-02' is there twice"),
        ("row,text", "line,text", "no review sheet of `modeproof report`: without the columns row"),
        ("A. Reader,", "A. Reader,,", "not as many cells as the first line has"),
        ("accept", '"accept', "no CSV"),
    ],
)
def test_a_broken_sheet_is_refused_in_one_line(
    root: Path, old: str, new: str, why: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = answered(root, "box E-01", "accept")
    text = path.read_text("utf-8-sig")
    assert text.count(old) >= 1
    path.write_text(text.replace(old, new, 1))
    assert main(["report", "--quiet", "--review", str(path)]) == 2
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1 and why in err and "answered.csv" in err
    assert not (root / "build/report/report.html").exists()


@pytest.mark.parametrize("content", [None, b"\xff\xfe\x00", b"", b"PK\x03\x04"])
def test_a_file_that_is_no_sheet_is_refused(
    root: Path, content: bytes | None, capsys: pytest.CaptureFixture[str]
) -> None:
    path = root / "answers"
    if content is not None:
        path.write_bytes(content)
    assert main(["report", "--quiet", "--review", str(path)]) == 2
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1 and "answers" in err


def test_every_group_asks_a_question() -> None:
    assert list(QUESTIONS)[:2] == ["safety", "assumption"] and list(QUESTIONS)[-1] == "clause"
    assert all(question.endswith("?") for question in QUESTIONS.values())
