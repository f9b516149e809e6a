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
    graphs, a kit with the published suite `brief`.
    """
    (tmp_path / "modeproof").symlink_to(ROOT)
    work = tmp_path / "my plc"
    work.mkdir()
    packed = suite_file(tmp_path / "place", "mode_selection", "fplc", "brief")
    packed.parent.mkdir(parents=True)
    (tmp_path / "place" / "spec").symlink_to(ROOT / "spec")
    shutil.copyfile(ROOT / "vectors" / "fplc" / "brief.jsonl.gz", packed)
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


def _wrong(folder: Path, blocks: list[tuple[str, str]], shown: list[str]) -> list[str]:
    """What the commands do otherwise than the page says, and the lines it shows that none of them printed."""
    said, wrong = "", []
    for kind, commands in blocks:
        if kind == "sh build":
            continue
        done = _run(folder, commands)
        if done.returncode != (1 if kind == "sh exit 1" else 0):
            wrong.append(f"status {done.returncode}: {commands}\n{done.stdout}\n{done.stderr}")
        said += done.stdout
    for line in "\n".join(shown).splitlines():
        if re.sub(r", [\d.]+ s, [\d,]+ scans a second$", "", line) not in said:
            wrong.append(f"no command printed: {line}")
    return wrong


@pytest.mark.deep
def test_every_command_of_the_page_does_what_the_page_says(folder: Path) -> None:
    builds = [commands for kind, commands in BLOCKS if kind == "sh build"]
    assert len(builds) == 1 and builds[0].startswith("make -C ../modeproof kit\n")
    assert _wrong(folder, BLOCKS, SHOWN) == []
    assert (folder / "verdict.json").is_file() and (folder / "verdict.xml").is_file()


def test_the_page_has_seven_steps_and_every_suite_and_relation() -> None:
    assert re.findall(r"^## (\d)\.", PAGE, re.MULTILINE) == [str(n) for n in range(1, 8)]
    assert len(BLOCKS) >= 9
    table = set(re.findall(r"^(?:\| |- \*\*)`(\w+)`", PAGE, re.MULTILINE))
    from modeproof.suites.kinds import SUITES

    assert set(SUITES) <= table
    assert {"exact", "settled", "monitor"} <= table


def test_a_wrong_command_and_a_line_nobody_prints_are_found(folder: Path) -> None:
    planted = [
        ("sh", "python3 modeproof-kit.pyz conform fplc --adapter ./none --suite brief\n"),
        ("sh exit 1", "true\n"),
    ]
    status, passed, line = _wrong(folder, planted, ["CONFORMS(exact, brief)\n"])
    assert status.startswith("status 2: python3") and passed.startswith("status 0: true")
    assert line == "no command printed: CONFORMS(exact, brief)"
