"""docs/check-your-plc.md: its commands run as they stand there, in an empty folder, and say what it says."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.suites import pack as packing
from modeproof.suites.build import suite_file

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "check-your-plc.md").read_text(encoding="utf-8")
FENCED = re.findall(r"^```([^\n]*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
BLOCKS = [(kind, text) for kind, text in FENCED if kind.startswith("sh")]
SHOWN = [text for kind, text in FENCED if not kind]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder beside the checkout, as the page has it, and in place of `make kit`, which needs the
    graphs, a kit with the suite `brief` of the faulty pack.
    """
    (tmp_path / "modeproof").symlink_to(ROOT)
    work = tmp_path / "my plc"
    work.mkdir()
    packed = suite_file(tmp_path / "place", "mode_selection", "fplc", "brief")
    packed.parent.mkdir(parents=True)
    shutil.copyfile(ROOT / "examples" / "faulty" / "vectors" / "brief.jsonl.gz", packed)
    monkeypatch.setattr(packing, "SUITES", {"brief": packing.SUITES["brief"]})
    packing.pack(tmp_path / "place", {"fplc": "mode_selection"}, work / packing.NAME)
    return work


def _run(folder: Path, commands: str) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "-e", "-c", commands],
        cwd=folder,
        capture_output=True,
        text=True,
        env={"PATH": path, "PYTHONDONTWRITEBYTECODE": "1"},
        check=False,
    )


def test_every_command_of_the_page_does_what_the_page_says(folder: Path) -> None:
    said = ""
    for kind, commands in BLOCKS:
        if kind == "sh build":
            assert commands.startswith("make -C ../modeproof kit\n")
            continue
        done = _run(folder, commands)
        expected = 1 if kind == "sh exit 1" else 0
        assert done.returncode == expected, f"{commands}\n{done.stdout}\n{done.stderr}"
        said += done.stdout
    assert "CONFORMS(exact, brief)" in said
    assert (folder / "verdict.json").is_file() and (folder / "verdict.xml").is_file()
    for shown in SHOWN:
        for line in shown.splitlines():
            stable = re.sub(r", [\d.]+ s, [\d,]+ scans a second$", "", line)
            assert stable in said, f"the page shows a line that no command printed: {line}"


def test_the_page_has_its_seven_steps_and_names_every_suite_and_relation() -> None:
    assert re.findall(r"^## (\d)\.", PAGE, re.MULTILINE) == [str(n) for n in range(1, 8)]
    assert len(BLOCKS) >= 9
    table = set(re.findall(r"^\| `(\w+)` \|", PAGE, re.MULTILINE))
    from modeproof.suites.write import SUITES

    assert set(SUITES) <= table
    assert {"exact", "settled", "monitor"} <= table


def test_a_command_that_does_something_else_is_found(folder: Path) -> None:
    assert (
        _run(folder, "python3 modeproof-kit.pyz conform fplc --adapter ./none --suite brief").returncode == 2
    )
