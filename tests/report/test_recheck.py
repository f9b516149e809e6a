"""`modeproof report --verify` finds every byte that changed since a report was made, and says where."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.ground.evidence import evidence_path, result_sha256
from modeproof.report.integrity import BLANK, seal_json, seal_of_json, seal_of_page, seal_page
from tests.report.paper import change, make_whole, put


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Path:
    """The box with a report of it."""
    monkeypatch.setenv("MODEPROOF_ROOT", str(tmp_path))
    make_whole(tmp_path)
    assert main(["report"]) == 0
    capsys.readouterr()
    return tmp_path


def flip(path: Path, at: int) -> None:
    """Change one byte."""
    content = bytearray(path.read_bytes())
    content[at] = content[at] ^ 1
    path.write_bytes(bytes(content))


def test_a_report_just_made_is_as_it_was_made(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", "--verify"]) == 0
    assert capsys.readouterr().out.endswith("files: as it was made\n")
    assert main(["report", "--verify", str(root / "build" / "report" / "report.json")]) == 0


@pytest.mark.parametrize(
    ("file", "says"),
    [
        ("build/evidence/box/MC_Box.json", "differs  build/evidence/box/MC_Box.json"),
        ("spec/box/properties.toml", "differs  spec/box/properties.toml"),
        ("docs/limits.md", "differs  docs/limits.md"),
        ("spec/box/Box.tla", "differs  spec/box/Box.tla: "),
        ("build/report/review.csv", "review.csv: was changed since it was written"),
    ],
)
def test_a_changed_byte_is_found_and_its_file_named(
    root: Path, capsys: pytest.CaptureFixture[str], file: str, says: str
) -> None:
    flip(root / file, 40)
    assert main(["report", "--verify"]) == 1
    out = capsys.readouterr().out
    assert says in out and "NOT as it was made" in out


@pytest.mark.parametrize("where", [0.3, 0.5, 0.9, 0.999])
@pytest.mark.parametrize("name", ["report.html", "report.json"])
def test_a_changed_byte_of_the_report_itself_is_found(
    root: Path, capsys: pytest.CaptureFixture[str], name: str, where: float
) -> None:
    """One letter by another, anywhere: the file stays a file of its kind."""
    path = root / "build" / "report" / name
    text = path.read_text()
    at = next(place for place in range(int(len(text) * where), len(text)) if text[place] == "e")
    path.write_text(f"{text[:at]}a{text[at + 1 :]}")
    assert main(["report", "--verify", str(path)]) in (1, 2)
    captured = capsys.readouterr()
    assert name in captured.out + captured.err


def test_a_page_alone_is_verified_by_what_it_carries(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = root / "build" / "report" / "report.html"
    moved = root / "sent.html"
    moved.write_bytes(page.read_bytes())
    assert main(["report", "--verify", str(moved)]) == 0
    put(root, "MC_Box", seconds=9.0)
    assert main(["report", "--verify", str(moved)]) == 0
    said = capsys.readouterr().out
    assert "again    build/evidence/box/MC_Box.json: made again 1970-01-01T00:00:00Z: " in said
    assert said.endswith("as it was made; 1 made again since: reproduced, same result\n")
    put(root, "MC_Box", result={"generated": 12})
    assert main(["report", "--verify", str(moved)]) == 1
    assert "differs  build/evidence/box/MC_Box.json" in capsys.readouterr().out


CHANGES: list[tuple[dict[str, Any], bool]] = [
    ({"started": 1.0, "seconds": 77.0, "command": "typed otherwise"}, True),
    ({"result": {"queries": [{"seconds": 3.0}], "workers": 7, "log": "elsewhere"}}, True),
    ({"verdict": "REFUTED"}, False),
    ({"inputs": {"spec/box/Box.tla": "1" * 64}}, False),
    ({"result": {"queries": [{"seconds": 3.0, "z3": "sat"}]}}, False),
    ({"environment": "honest"}, False),
]


@pytest.mark.parametrize(("change", "same"), CHANGES)
def test_times_and_host_alone_leave_a_result_the_same(change: dict[str, Any], same: bool) -> None:
    usual = {"verdict": "HOLDS", "result": {"queries": [{"seconds": 1.0}]}, "environment": "arbitrary"}
    usual |= {"inputs": {"spec/box/Box.tla": "0" * 64}, "started": 0.0, "machine": {"cores": 2}}
    assert (result_sha256(usual | change) == result_sha256(usual)) == same


def test_a_user_s_runs_are_shown_and_turn_nothing_red(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = {"verdict": "DIFFERS", "as_expected": False, "reason": "case box-1, scan 2 (Open): LID is false"}
    put(root, "mine_box_brief", kind="conformance", **said)
    path = evidence_path(root, "box", "mine_box_brief")
    place = root / "build/yours/box/mine_box_brief.json"
    place.parent.mkdir(parents=True)
    assert main(["report"]) == 1
    path.rename(place)
    capsys.readouterr()
    assert main(["report"]) == 0
    row = re.search(r'<tr id="conformance-yours-mine_box_brief">.*?</tr>', page(root), re.DOTALL)
    assert row is not None and "DIFFERS" in row.group()
    place.write_text("{")
    assert main(["report", "--verify"]) == 0
    assert "yours    build/yours/box/mine_box_brief.json" in capsys.readouterr().out
    assert main(["report"]) == 0, "one that is damaged is told, and no more"
    place.unlink()
    assert main(["report"]) == 0 and "none yet" in page(root)


def page(root: Path) -> str:
    return (root / "build/report/report.html").read_text(encoding="utf-8")


def test_page_and_json_of_two_reports_do_not_belong_together(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = root / "build" / "report" / "report.html"
    before = page.read_bytes()
    put(root, "MC_Box", seconds=9.0)
    assert main(["report"]) == 0
    assert main(["report", "--verify"]) == 0
    page.write_bytes(before)
    capsys.readouterr()
    assert main(["report", "--verify"]) == 1
    assert "does not belong to report.json" in capsys.readouterr().out


def test_what_was_stale_at_report_time_is_no_later_change(root: Path) -> None:
    change(root / "spec" / "box" / "Box.tla", "CODE == TLCEval", "CODE  == TLCEval")
    assert main(["report"]) == 2
    assert main(["report", "--verify"]) == 0
    flip(root / "spec" / "box" / "Box.tla", 40)
    assert main(["report", "--verify"]) == 1


def test_evidence_that_came_later_is_new(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    put(root, "MC_Later")
    assert main(["report", "--verify"]) == 1
    assert "new      build/evidence/box/MC_Later.json" in capsys.readouterr().out


def test_evidence_that_went_is_gone_and_nothing_else_is_wrong(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (root / "build" / "evidence" / "box" / "MC_Box.json").unlink()
    assert main(["report", "--verify", "--json", str(root / "result.json")]) == 2
    assert "gone     build/evidence/box/MC_Box.json" in capsys.readouterr().out
    result = json.loads((root / "result.json").read_text())
    assert result["status"] == 2 and [one["word"] for one in result["differences"]] == ["gone"]


def test_a_removed_text_that_evidence_rests_on_is_gone(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = root / "build" / "made.txt"
    made.write_text("x")
    put(
        root,
        "MC_Box",
        inputs={"build/made.txt": "2d711642b726b04401627ca9fbac32f5c8530fb1903cc4db02258717921a4881"},
    )
    assert main(["report"]) == 0
    made.unlink()
    assert main(["report", "--verify"]) == 0  # its command makes it again
    assert "gone     build/made.txt" in capsys.readouterr().out


@pytest.mark.parametrize("content", [None, b"", b"<html>", b"\xff\xfe", b"{}"])
@pytest.mark.parametrize("name", ["x.html", "x.json"])
def test_what_is_no_report_is_one_line(
    root: Path, capsys: pytest.CaptureFixture[str], name: str, content: bytes | None
) -> None:
    path = root / "other" / name
    path.parent.mkdir()
    if content is not None:
        path.write_bytes(content)
    assert main(["report", "--verify", str(path)]) == 2
    err = capsys.readouterr().err
    assert str(path) in err and len(err.splitlines()) == 1


def test_a_seal_hashes_the_text_with_zeros_in_its_place() -> None:
    page = f'<meta name="modeproof-page" content="{BLANK}"><p>text</p>'
    sealed = seal_of_page(seal_page(page))
    assert sealed is not None and sealed[0] == sealed[1] != BLANK
    changed = seal_of_page(seal_page(page).replace("text", "test"))
    assert changed is not None and changed[0] != changed[1]
    text = f'{{\n "schema_version": 1,\n "sha256": "{BLANK}",\n "other": "{BLANK}"\n}}'
    assert seal_json(text).count(BLANK) == 1 and seal_of_json("{}") is None
