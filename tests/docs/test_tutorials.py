"""The commands of the first page and of the tutorials run as they stand there, and print what it shows.

A fence says what its block is: `sh` (it ends with 0), `sh exit 1`, `sh not run`, `toml NAME` (a file to
write), nothing (lines that the block before it has printed, or how they begin).
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.registers.rooms import ROOMS

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PAGES = [
    "index",
    *(pytest.param(f"tutorial-{door}", marks=pytest.mark.deep) for door in ("prove", "wire", "assess")),
]


def blocks(page: str) -> list[tuple[str, str]]:
    """The fenced blocks of a page with what their fences say."""
    return FENCE.findall((ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8"))


def wrong(listed: list[tuple[str, str]], folder: Path) -> list[str]:
    """What the blocks do otherwise than they say."""
    found: list[str] = []
    printed: list[str] = []
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    for kind, text in listed:
        if kind.startswith("toml "):
            (folder / kind.removeprefix("toml ")).write_text(text, encoding="utf-8")
        elif kind in ("sh", "sh exit 1"):
            done = subprocess.run(
                ["bash", "-e", "-c", text],
                cwd=folder,
                capture_output=True,
                text=True,
                env={"PATH": path, "PYTHONDONTWRITEBYTECODE": "1", "HOME": str(folder)},
                check=False,
            )
            if done.returncode != int(kind == "sh exit 1"):
                found.append(f"status {done.returncode}: {text}{done.stderr}")
            printed = done.stdout.splitlines()
        elif not kind:
            lines = (line for line in text.splitlines() if not any(one.startswith(line) for one in printed))
            found += [f"not printed: {line}" for line in lines]
        elif kind != "sh not run":
            found.append(f"a block of an unknown kind: {kind}")
    return found


@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_do_what_it_says(page: str, tmp_path: Path) -> None:
    listed = blocks(page)
    assert sum(kind.startswith("sh") for kind, _ in listed) >= 2
    assert wrong(listed, tmp_path) == []


@pytest.mark.deep
def test_the_tutorial_for_maintainers_runs_in_a_checkout(tmp_path: Path) -> None:
    names = {room.partition("/")[0] for room in ROOMS} | {"spec", "docs", "vectors", "examples", "tests"}
    for name in names:
        ignore = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / name, tmp_path / name, ignore=ignore)
    for name in ("README.md", "CHANGELOG.md", "pyproject.toml", "requirements.lock"):
        shutil.copyfile(ROOT / name, tmp_path / name)
    (tmp_path / ".venv").symlink_to(ROOT / ".venv")
    listed = blocks("tutorial-carry-on")
    assert sum(kind == "sh" for kind, _ in listed) >= 4
    assert wrong(listed, tmp_path) == []


def test_each_door_has_a_short_tutorial() -> None:
    doors = re.findall(
        r"^- \*\*\[.*?\]\((tutorial-[\w-]+)\.md\)\*\*", (ROOT / "docs/index.md").read_text(), re.M
    )
    assert doors == ["tutorial-prove", "tutorial-wire", "tutorial-assess", "tutorial-carry-on"]
    for door in doors:
        assert len((ROOT / "docs" / f"{door}.md").read_text(encoding="utf-8").split()) <= 700


def test_a_slip_of_a_page_is_found(tmp_path: Path) -> None:
    planted = [
        ("toml a.toml", "x = 1\n"),
        ("sh", "cat a.toml; false\n"),
        ("", "x = 1\nx = 2\n"),
        ("sh exit 1", "true\n"),
        ("sh exit 2", "true\n"),
        ("sh not run", "false\n"),
    ]
    status, line, passed, kind = wrong(planted, tmp_path)
    assert status.startswith("status 1: cat") and line == "not printed: x = 2"
    assert passed.startswith("status 0: true") and kind.endswith("sh exit 2")
