"""`modeproof render` from evidence to page, on a box whose literal reading does not wait for its door."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.registers import load_document, read_sources
from modeproof.registers.document_page import check_document_page

PAGE = "docs/box.md"


def problems(root: Path) -> list[str]:
    document = load_document(root, "box")
    return [one.text for one in check_document_page(document, read_sources(document))]


def change(root: Path, name: str, old: str, new: str) -> None:
    text = (root / name).read_text(encoding="utf-8")
    assert old in text
    (root / name).write_text(text.replace(old, new), encoding="utf-8")


def test_the_page_shows_a_counterexample_and_renders_the_same_again(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = (checked / PAGE).read_text(encoding="utf-8")
    for expected in (
        "### E-01: does it wait for the door\n\nNothing is in the door, and the box shuts.",
        "What fails: It shuts only over the door. (`ShutsOverDoor`)",
        "| scan | executes | box is in | WORD | lamps |",
        "| 0 | power-up | Open | 0 | none |",
        "| 1 | `Close` | **Shut** | **0F10 =<br>code&nbsp;1** | **lamp** |",
        "The same in every row: door 0, SPARE 0.",
        "What we decided: in scan 1 the box reads the same, and it executes `Wait`, not `Close`.",
        "`modeproof check NEG_Box_eager --trace`",
    ):
        assert expected in page, page
    findings = " ".join((checked / "docs/box-findings.md").read_text(encoding="utf-8").split())
    assert (
        "*Otherwise:* It shuts on a hand. `ShutsOverDoor` fails after 1 step: "
        "`modeproof check NEG_Box_eager NEG_Box_hasty --trace`."
    ) in findings, findings
    assert problems(checked) == []
    for walk in (checked / "build/walks/box").iterdir():
        walk.unlink()
    capsys.readouterr()
    assert main(["render", "--check"]) == 0 and main(["render"]) == 0
    assert capsys.readouterr().out == "nothing has changed\n" * 2
    assert (checked / PAGE).read_text(encoding="utf-8") == page


def test_a_page_that_drifted_is_said_and_rendered_anew(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    change(checked, PAGE, "| **Shut** |", "| Shut |")
    assert len(problems(checked)) == 1
    capsys.readouterr()
    assert main(["render", "--check"]) == 1
    assert capsys.readouterr().out == "docs/box.md differs from registers and evidence\n"
    assert main(["render"]) == 0 and problems(checked) == []
    change(checked, "spec/box/runs.toml", "trace_length = 2", "trace_length = 3")
    assert len(problems(checked)) == 1


def test_without_evidence_the_table_of_an_unchanged_run_is_kept(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = (checked / PAGE).read_text(encoding="utf-8")
    shutil.rmtree(checked / "build")
    change(checked, "spec/box/findings.toml", "It shuts on a hand.", "It shuts on a foot.")
    assert len(problems(checked)) == 1
    assert main(["render"]) == 0
    assert "NEG_Box_eager: its table is kept as it was: no evidence" in capsys.readouterr().out
    assert (checked / PAGE).read_text(encoding="utf-8") == page.replace("on a hand", "on a foot")
    assert problems(checked) == []


def _no_evidence(root: Path) -> None:
    (root / "build/evidence/box/NEG_Box_eager.json").unlink()


def _other_cfg(root: Path) -> None:
    change(root, "spec/box/models/MC_Box.cfg", "CONSTANTS", "CONSTANT")


def _other_pin(root: Path) -> None:
    change(root, "spec/box/runs.toml", "trace_length = 2", "trace_length = 3")


def _other_verdict(root: Path) -> None:
    path = root / "build/evidence/box/NEG_Box_eager.json"
    record: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    record |= {"verdict": "INCONCLUSIVE", "as_expected": False, "reason": "stopped"}
    path.write_text(json.dumps(record), encoding="utf-8")


def _other_property(root: Path) -> None:
    path = root / "build/evidence/box/NEG_Box_eager.json"
    record: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    record["result"]["violated"] = "TypeOK"
    path.write_text(json.dumps(record), encoding="utf-8")


def _other_specification(root: Path) -> None:
    change(root, "spec/box/Box.tla", "~Needed", "(~Needed)")


@pytest.mark.parametrize(
    ("spoil", "expected"),
    [
        (_no_evidence, ": no evidence;"),
        (_other_cfg, "spec/box/models/MC_Box.cfg has changed since"),
        (_other_pin, "its evidence has trace_length 2, runs.toml 3"),
        (_other_verdict, "its evidence is not as expected: INCONCLUSIVE"),
        (_other_property, "its evidence has violated TypeOK, runs.toml ShutsOverDoor"),
        (_other_specification, "spec/box/Box.tla has changed since"),
    ],
)
def test_missing_or_foreign_evidence_only_names_its_run_and_command(
    checked: Path, capsys: pytest.CaptureFixture[str], spoil: Callable[[Path], None], expected: str
) -> None:
    shutil.rmtree(checked / "docs")
    spoil(checked)
    capsys.readouterr()
    assert main(["render"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and expected in said
    assert "NEG_Box_eager" in said and "run modeproof check NEG_Box_eager" in said
    assert not (checked / "docs").exists()


def test_a_negative_run_that_holds_names_the_reading_without_effect(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    change(checked, "spec/box/BoxAsPrinted.tla", "Ready_Eager(i) == TRUE", "Ready_Eager(i) == i.door")
    assert main(["check", "--quiet", "NEG_Box_eager"]) == 1
    said = capsys.readouterr().out
    assert "the reading Eager changes nothing: its counts are those of MC_Box" in said

    change(checked, "spec/box/BoxAsPrinted.tla", "Ready_Eager(i) == i.door", "Ready_Eager(i) == FALSE")
    assert main(["check", "--quiet", "NEG_Box_eager"]) == 1
    assert (
        "ShutsOverDoor was to be violated, and is not: the reading Eager breaks nothing"
        in capsys.readouterr().out
    )
