"""Changes since the previous report: what moved, and why; made again from the same evidence nothing moves."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.report.build import make
from modeproof.report.snapshot import pins_of
from modeproof.report.sources import gather
from tests.report.paper import change, make_whole, put, without


def pin(root: Path, distinct: int) -> None:
    """Move the pin of the model, which each of these tests finds where the last one left it."""
    path = root / "spec/box/runs.toml"
    path.write_text(re.sub(r"distinct = [567]\b", f"distinct = {distinct}", path.read_text(), count=1))


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The box with a report of it."""
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    make_whole(tmp_path)
    assert main(["report"]) == 0
    return tmp_path


def changes(root: Path) -> dict[str, Any]:
    """The part of the report that lies there, its rows by title."""
    content = json.loads((root / "build" / "report" / "report.json").read_text())
    part = content["parts"]["changes"]
    return {**part, "rows": {group["title"]: group["rows"] for group in part["groups"]}}


def files(root: Path) -> dict[str, bytes]:
    """All that a report wrote."""
    return {path.name: path.read_bytes() for path in (root / "build" / "report").iterdir()}


def test_the_first_report_is_compared_with_nothing(root: Path) -> None:
    assert changes(root)["baseline"] is None
    assert "no previous report" in (root / "build" / "report" / "report.html").read_text()


def test_made_again_from_identical_evidence_every_file_is_identical(root: Path) -> None:
    before = files(root)
    assert main(["report"]) == 0
    assert files(root) == before
    put(root, "MC_Box", seconds=7.0)
    assert main(["report"]) == 0
    after = files(root)
    assert after["previous.json"] == before["report.json"] and after["report.json"] != before["report.json"]
    assert main(["report"]) == 0
    assert files(root) == after


def test_changed_counts_verdicts_and_tools_are_shown(root: Path) -> None:
    pin(root, 6)
    put(root, "MC_Box", result={"distinct": 6}, tools={"tlc": {"version": "newer", "sha256": "7" * 64}})
    put(root, "MC_Box_lazy", verdict="INCONCLUSIVE", as_expected=False, reason="time")
    assert main(["report"]) == 2
    rows = changes(root)["rows"]
    assert rows["Counts"] == [{"what": "box/MC_Box: distinct", "before": "5", "now": "6", "why": ""}]
    assert rows["Verdicts of evidence"][0] == {
        "what": "box/MC_Box_lazy",
        "before": "HOLDS",
        "now": "INCONCLUSIVE",
        "why": "",
    }
    assert "Verdicts of properties" not in rows, "a run with a reading says nothing of what was decided"
    assert [row["what"] for row in rows["Tools"]] == ["tlc"]


def test_evidence_that_came_or_went_is_shown(root: Path) -> None:
    without(root, "WIT_Box")
    put(root, "coverage", kind="coverage")
    assert main(["report"]) == 2
    rows = changes(root)["rows"]["Verdicts of evidence"]
    assert [(row["what"], row["before"], row["now"]) for row in rows] == [
        ("box/WIT_Box", "REACHED", "none"),
        ("box/coverage", "none", "EQUAL"),
    ]


def test_a_pin_that_moved_is_shown_with_its_reason(root: Path) -> None:
    runs = root / "spec" / "box" / "runs.toml"
    change(runs, "distinct = 5\n", "distinct = 6\n")
    runs.write_text('moved = ["the door has two leaves"]\n' + runs.read_text())
    assert pins_of(gather(root).documents["box"])["MC_Box"]["distinct"] == "6"
    main(["report"])
    assert changes(root)["rows"]["Pins"] == [
        {"what": "box/MC_Box: distinct", "before": "5", "now": "6", "why": "the door has two leaves"}
    ]


def test_nothing_that_counts_changed(root: Path) -> None:
    put(root, "MC_Box", seconds=8.0)
    assert main(["report"]) == 0
    assert changes(root)["rows"] == {} and changes(root)["baseline"] is not None


def test_another_report_can_be_compared_with(root: Path) -> None:
    old = root / "old.json"
    old.write_bytes((root / "build" / "report" / "report.json").read_bytes())
    pin(root, 6)
    put(root, "MC_Box", result={"distinct": 6})
    assert main(["report"]) == 0
    pin(root, 7)
    put(root, "MC_Box", result={"distinct": 7})
    assert main(["report"]) == 0
    assert changes(root)["rows"]["Counts"][0]["before"] == "6"
    assert main(["report", "--previous", str(old)]) == 0
    assert changes(root)["rows"]["Counts"][0]["before"] == "5"


def test_a_damaged_previous_report_is_only_a_hole(root: Path) -> None:
    (root / "build" / "report" / "report.json").write_text("{")
    assert main(["report"]) == 2
    page = (root / "build" / "report" / "report.html").read_text()
    assert "the previous report cannot be compared with: report.json: not JSON" in page
    assert main(["report"]) == 0


def test_a_previous_report_that_was_edited_is_no_baseline(root: Path) -> None:
    path = root / "build" / "report" / "report.json"
    path.write_text(path.read_text().replace('"HOLDS"', '"VIOLATED"'))
    put(root, "MC_Box", seconds=8.0)
    assert main(["report"]) == 2
    assert changes(root)["baseline"] is None


def test_without_a_folder_nothing_is_compared(tmp_path: Path) -> None:
    assert '"baseline": null' in make(make_whole(tmp_path)).json
