"""Markdown and timing diagrams of an outcome, and the options that write them."""

from __future__ import annotations

import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import TREE
from modeproof.kit import __main__ as kit
from modeproof.output.diagram import as_svg, columns_of, latest, rows_of
from modeproof.output.markdown import as_markdown, escaped
from modeproof.output.outcome import Counterexample, Scan, read, unjudged
from tests.output.outcomes import FOREIGN, SCANS, outcome

SVG = "{http://www.w3.org/2000/svg}"
CAUSES = {
    "no/such/a.sarif": "No such file or directory",
    "old/a.sarif": "Not a directory",
    ".": "Is a directory",
    "old/../no/such": "No such file or directory",
}
EXAMPLE = Counterexample(scans=SCANS, wrong=["Lamp"])


def test_a_summary_has_verdict_place_clause_and_scans() -> None:
    text = as_markdown(outcome())
    assert text.startswith("### REFUTED: `Block`")
    assert "#### `lamp`, `plc/my lamp.st:7`" in text
    assert "- clause `AB-1` (A paper, page 2): The lamp follows the key" in text
    assert "| 4 | 10 | Key=TRUE, W=0FF0 | Wrong: Lamp is FALSE, expected TRUE |" in text
    assert "Again: `modeproof prove-program 'plc/my lamp.st' --target lamp`" in text


def test_foreign_text_is_no_markup_in_a_summary() -> None:
    text = as_markdown(outcome(subject=FOREIGN, not_shown=[FOREIGN], sentence=FOREIGN))
    for mark in ("<", "@", "[", "|"):
        assert not re.search(rf"(?<![\\|\n ]){re.escape(mark)}(?! |\n|-)", text.partition("Not shown")[2])
    assert "\x1b" not in text and "\n#1" not in text
    assert escaped("1. a") == "1\\. a"
    assert escaped("S_EDM_Out") == "S_EDM_Out"


def test_what_was_not_judged_says_why() -> None:
    text = as_markdown(unjudged("trace", "my.csv", "fplc", "modeproof trace fplc my.csv", "no such column"))
    assert "### UNJUDGED: `my.csv`" in text
    assert "Not judged: no such column" in text


def drawing(example: Counterexample, title: str = "A title", about: str = "why") -> ElementTree.Element:
    return ElementTree.fromstring(as_svg(example, title, about))


def test_a_diagram_marks_the_wrong_scan_and_what_was_expected() -> None:
    root = drawing(EXAMPLE)
    texts = [text.text for text in root.iter(f"{SVG}text")]
    assert texts.count("wrong") == 1
    assert {"Key", "W", "Lamp", "expected Lamp", "0FF0", "+10 ms"} <= {*texts}
    frames = [one for one in root.iter(f"{SVG}rect") if one.get("class") == "frame"]
    assert len(frames) == 1
    title = root.find(f"{SVG}title")
    assert title is not None and title.text == "A title"


def test_scans_in_which_nothing_changes_share_a_column() -> None:
    assert [(column.number, column.count, column.last) for column in columns_of(EXAMPLE)] == [
        (1, 1, False),
        (2, 2, False),
        (4, 1, True),
    ]
    assert "2-3" in [text.text for text in drawing(EXAMPLE).iter(f"{SVG}text")]


def test_a_scan_alone_is_the_wrong_one() -> None:
    [column] = columns_of(Counterexample(scans=SCANS[-1:], wrong=["Lamp"]))
    assert (column.number, column.last) == (1, True)
    still = Counterexample(scans=[SCANS[1], SCANS[2]])
    assert [column.last for column in columns_of(still)] == [False, True]


def test_a_wrong_value_has_a_box_of_its_own() -> None:
    scans = [
        Scan(dt_ms=1, inputs={"x": bool(n)}, given={"W": "0001"}, expected={"W": "0001" if n < 2 else "0002"})
        for n in range(3)
    ]
    root = drawing(Counterexample(scans=scans, wrong=["W"]))
    kinds = [path.get("class") for path in root.iter(f"{SVG}path")]
    assert (kinds.count("bus"), kinds.count("x")) == (1, 1)


def test_foreign_names_are_text_in_a_diagram() -> None:
    scans = [Scan(dt_ms=0, inputs={FOREIGN: True}, given={"a": FOREIGN})]
    text = as_svg(Counterexample(scans=scans), FOREIGN, FOREIGN)
    assert "<script" not in text and "\x1b" not in text
    ElementTree.fromstring(text)


def test_many_scans_go_on_below() -> None:
    scans = [Scan(dt_ms=1, inputs={"Key": n % 2 == 0}, given={"Lamp": False}) for n in range(40)]
    root = drawing(Counterexample(scans=scans))
    assert float(root.get("width", "0")) < 1000
    assert [text.text for text in root.iter(f"{SVG}text")].count("Key") > 1
    names = [row.name for row in rows_of(Counterexample(scans=scans))]
    assert names == ["Key", "Lamp"]


def test_of_many_signals_only_what_changes_is_drawn() -> None:
    inputs = {f"In{n}": True for n in range(20)}
    scans = [
        Scan(dt_ms=1, inputs={**inputs, "Key": key}, given={"Lamp": False, "Bell": key}) for key in (0, 1)
    ]
    names = [row.name for row in rows_of(Counterexample(scans=scans, wrong=["Lamp"]))]
    assert names == ["Key", "Lamp", "Bell"]


def test_a_small_picture_has_the_last_columns() -> None:
    scans = [Scan(dt_ms=1, inputs={"Key": n % 2 == 0}, given={"Lamp": False}) for n in range(40)]
    short = latest(Counterexample(scans=scans), 5)
    assert (short.first, len(short.scans)) == (36, 5)
    assert latest(EXAMPLE, 5) is EXAMPLE


# ---------------------------------------------------------------- the options


@pytest.fixture
def wrong(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a block that shows a wrong code."""
    text = (TREE / "examples/st/sf_edm.st").read_text("utf-8").replace("16#8810", "16#8811")
    (tmp_path / "edm.st").write_text(text, "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_form_is_written_in_one_run(wrong: Path, capfd: pytest.CaptureFixture[str]) -> None:
    words = ["prove-program", "edm.st", "--target", "sf_edm", "--codes", "--sarif", "-", "--markdown", "a.md"]
    (wrong / "pictures").mkdir()
    (wrong / "pictures/prove-program-edm.st-sf-edm-9.svg").write_text("old", "utf-8")
    assert main([*words, "--diagram", "pictures", "--junit", "a.xml", "--json", "a.json"]) == 1
    said = capfd.readouterr()
    result = json.loads(said.out)["runs"][0]["results"][0]  # nothing else stands there
    assert result["ruleId"] == "EDM-OUT-DIAG"
    assert "REFUTED: function block" in said.err
    assert "### REFUTED" in (wrong / "a.md").read_text("utf-8")
    assert [path.name for path in (wrong / "pictures").iterdir()] == ["prove-program-edm.st-sf-edm-1.svg"]
    assert read(wrong / ".modeproof/records/prove-program-edm.st-sf-edm.json").word == "REFUTED"


def test_a_program_that_is_refused_has_its_forms_too(wrong: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (wrong / "edm.st").write_text("FUNCTION_BLOCK x\nIF\n", "utf-8")
    (wrong / "old.svg").write_text("old", "utf-8")
    words = ["prove-program", "edm.st", "--target", "sf_edm", "--diagram", "old.svg"]
    assert main([*words, "--sarif", "a.sarif"]) == 2
    assert capfd.readouterr().err.count("\n") == 1
    [run] = json.loads((wrong / "a.sarif").read_text("utf-8"))["runs"]
    assert run["results"][0]["ruleId"] == "unjudged"
    assert not (wrong / "old.svg").exists()


def test_two_results_for_standard_output_are_refused(wrong: Path, capfd: pytest.CaptureFixture[str]) -> None:
    words = ["prove-program", "edm.st", "--target", "sf_edm", "--json", "-", "--junit", "-"]
    assert main(words) == 2
    assert "two options write to `-`" in capfd.readouterr().err


def test_a_form_that_cannot_be_written_is_one_line(wrong: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (wrong / "old").write_text("a file", "utf-8")
    for place in CAUSES:
        for option in ("--sarif", "--markdown", "--json", "--junit"):
            assert main(["prove-program", "edm.st", "--target", "sf_edm", option, place]) == 2
            said = f"modeproof: {Path(place)}: cannot be written: {CAUSES[place]}\n"
            assert capfd.readouterr() == ("", said)


def test_a_verdict_is_said_after_its_files_are_written(
    wrong: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, text: str) -> None:
        raise Unjudged(f"{path}: cannot be written: No space left on device")

    monkeypatch.setattr("modeproof.output.options.write_text", full)
    assert main(["prove-program", "edm.st", "--target", "sf_edm", "--markdown", "a.md"]) == 2
    assert capfd.readouterr() == ("", "modeproof: a.md: cannot be written: No space left on device\n")


def test_the_kit_alone_writes_to_standard_output(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    vectors = TREE / "vectors/sf_edm/brief.jsonl.gz"
    words = ["conform", "sf_edm", "--builtin", "refimpl", "--vectors", str(vectors), "--json", "-", "--quiet"]
    assert kit.main(words) == 0
    said = capfd.readouterr()
    assert json.loads(said.out)["verdict"] == "CONFORMS"
    assert "CONFORMS" in said.err
