"""`modeproof findings` from evidence to page, on a box whose literal reading does not wait for its door."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from modeproof.cli import main
from modeproof.registers import load_document
from modeproof.registers.stamps import check_findings_pages


def stamps(root: Path) -> list[str]:
    return [str(one) for one in check_findings_pages(load_document(root, "box"))]


def change(root: Path, name: str, old: str, new: str) -> None:
    text = (root / name).read_text(encoding="utf-8")
    assert old in text
    (root / name).write_text(text.replace(old, new), encoding="utf-8")


def test_the_page_shows_trace_and_decided_behaviour_and_rendering_again_gives_the_same_bytes(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = (checked / "docs/box/findings/E-01.md").read_text(encoding="utf-8")
    for expected in (
        "# E-01: does it wait for the door",
        "A drawing could settle which reading is meant, so this is no error of the document",
        "## `EAGER` restored: `ShutsOverDoor` falls in 1 step",
        "It shuts only over the door.",
        "Otherwise: It shuts on a hand.",
        "the bounds of MC_Box (any door)",
        ".venv/bin/modeproof check NEG_Box_eager --trace",
        "| 0 | power-up | Open | 0 | none |",
        "| 1 | `Close` | **Shut** | **0F10 =<br>code&nbsp;1** | **lamp** |",
        "The same in every row: door 0, SPARE 0.",
        "In step 1 (marked ▶) the box with no reading restored does otherwise",
        "| ▶ 1 | 0 | `Close` | **`Wait`** | Shut | **Open** |",
        "- `Close` (box): BX-1-1, E-01",
        "## `LAZY` restored: nothing falls",
        # a run that records no step and replaces a definition: TLC finds the step again
        "## Without A-01: `ShutsOverDoor` falls in 1 step",
        "It lets go of what the decided behaviour rests on: A-01, one door.",
        "No device differs from the decided behaviour here",
    ):
        assert expected in page, page
    assert not (checked / "docs/box/findings/E-02.md").exists()
    index = (checked / "docs/box/findings.md").read_text(encoding="utf-8")
    assert "2 findings: 1 of class safety, 0 availability, 1 wording" in index
    assert (
        "VIOLATED, as expected: `ShutsOverDoor` falls in 1 step" in index
        and "no model can show a slip" in index
    )
    table = (checked / "docs/box/deviations.md").read_text(encoding="utf-8")
    assert re.search(r"\| `EAGER` \| \[E-01\].* \| `ShutsOverDoor` \| 1 \| \d+\.\d \| arbitrary \|", table)
    assert "nothing: harmless within the bounds" in table
    assert "| none; without A-01 | [E-01]" in table and page.count("| 1 | `Close` | **Shut** |") == 2
    assert stamps(checked) == []

    before = {path: path.read_bytes() for path in (checked / "docs").rglob("*.md")}
    for walk in (checked / "build/walks/box").iterdir():
        walk.unlink()
    assert main(["findings", "--render", "--quiet"]) == 0
    assert {path: path.read_bytes() for path in (checked / "docs").rglob("*.md")} == before
    assert main(["findings", "--quiet"]) == 0
    assert "3 of 3 pages as registers and evidence give them" in capsys.readouterr().out


def test_each_kind_of_drift_is_found(checked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = "docs/box/findings/E-01.md"

    change(checked, page, "It shuts only", "It never shuts")
    assert any("E-01.md: the page was changed by hand" in one for one in stamps(checked))
    capsys.readouterr()
    assert main(["findings", "--quiet"]) == 1
    assert "E-01.md: the page differs from what registers and evidence give" in capsys.readouterr().out

    assert main(["findings", "--render", "--quiet"]) == 0
    change(checked, "spec/box/findings.toml", "It shuts on a hand.", "It shuts on a foot.")
    assert any("E-01.md: the registers have changed" in one for one in stamps(checked))
    change(checked, "spec/box/findings.toml", "It shuts on a foot.", "It shuts on a hand.")
    change(checked, "spec/box/runs.toml", "trace_length = 2", "trace_length = 3")
    assert any("E-01.md: the pins of its runs" in one for one in stamps(checked))
    change(checked, "spec/box/runs.toml", "trace_length = 3", "trace_length = 2")
    assert stamps(checked) == []

    (checked / page).rename(checked / "docs/box/findings/E-03.md")
    found = stamps(checked)
    assert any("E-01.md: the page is missing" in one for one in found)
    assert any("E-03.md: no finding with evidence has this page" in one for one in found)
    assert main(["findings", "--render", "--quiet"]) == 0
    assert not (checked / "docs/box/findings/E-03.md").exists()
    change(checked, page, "<!-- rendered", "<!-- written")
    assert any("E-01.md: the page has no stamp" in one for one in stamps(checked))


def _no_evidence(root: Path) -> None:
    (root / "build/evidence/box/NEG_Box_eager.json").unlink()


def _other_cfg(root: Path) -> None:
    change(root, "spec/box/models/NEG_Box_eager.cfg", "CONSTANTS", "CONSTANTS ")


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
    change(root, "spec/box/Box.tla", '\\/ "EAGER" \\in LITERAL', '\\/ "EAGER" \\in {}')


@pytest.mark.parametrize(
    ("spoil", "expected"),
    [
        (_no_evidence, "no evidence to render"),
        (_other_cfg, "its evidence is of another models/NEG_Box_eager.cfg"),
        (_other_pin, "its evidence has 2 where runs.toml pins 3"),
        (_other_verdict, "its evidence is not as expected: INCONCLUSIVE"),
        (_other_property, "its evidence violates TypeOK, not ShutsOverDoor"),
        (_other_specification, "the specification does not allow state 2 of its counterexample any more"),
    ],
)
def test_evidence_that_is_missing_or_of_something_else_writes_nothing_and_names_run_and_command(
    checked: Path,
    capsys: pytest.CaptureFixture[str],
    spoil: Callable[[Path], None],
    expected: str,
) -> None:
    shutil.rmtree(checked / "docs")
    spoil(checked)
    capsys.readouterr()
    assert main(["findings", "--render", "--quiet"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and expected in said
    assert "NEG_Box_eager" in said and "run modeproof check NEG_Box_eager" in said
    assert not (checked / "docs").exists()


def test_a_negative_run_that_holds_names_the_switch_that_changes_nothing(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    change(checked, "spec/box/Box.tla", ' \\/ "EAGER" \\in LITERAL', "")
    assert main(["check", "--quiet", "NEG_Box_eager"]) == 1
    said = capsys.readouterr().out
    assert "the switch EAGER changes nothing: its counts are those of MC_Box" in said

    never = 'i.door /\\ "EAGER" \\notin LITERAL'
    change(checked, "spec/box/Box.tla", "i.door \\/ ~Needed", never)
    assert main(["check", "--quiet", "NEG_Box_eager"]) == 1
    assert (
        "ShutsOverDoor was to be violated, and is not: EAGER restored breaks nothing"
        in capsys.readouterr().out
    )


def test_a_document_without_the_register_has_no_pages(
    checked: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (checked / "spec/box/replay.toml").unlink()
    assert main(["findings"]) == 2
    assert "no document has a replay.toml" in capsys.readouterr().err
