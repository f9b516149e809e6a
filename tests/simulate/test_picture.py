"""The pictures of README: made by the command, small, of the story that they name, and of today's scenes."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.errors import Unjudged
from modeproof.simulate.picture import png, svg
from tests.simulate.conftest import ROOT

MOVING, STILL = ROOT / "docs/simulate-E-52.svg", ROOT / "docs/simulate.png"
LARGEST = 300_000
"""Bytes of both together."""
PNG = b"\x89PNG\r\n\x1a\n"


def size(picture: bytes) -> tuple[int, int]:
    """Width and height of a PNG."""
    assert picture.startswith(PNG)
    return int.from_bytes(picture[16:20], "big"), int.from_bytes(picture[20:24], "big")


@pytest.mark.deep
def test_the_moving_picture_is_the_story_as_it_runs() -> None:
    drawn = svg(ROOT, "stale_confirmation")
    assert drawn == MOVING.read_text(encoding="utf-8"), "modeproof simulate --picture docs/simulate-E-52.svg"
    frames = drawn.split('<g id="f')[1:]
    assert len(frames) == 12
    assert "Active mode: 0: Manual mode" in frames[-1] and "Active mode: none" in frames[-1]
    assert svg(ROOT, "repeated_acknowledgment") != drawn


def test_readme_shows_both_pictures_and_they_are_small() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for file in (MOVING, STILL):
        assert re.search(rf"!\[[^\]]{{40,}}\]\(docs/{re.escape(file.name)}\)", text)
    assert MOVING.stat().st_size + STILL.stat().st_size <= LARGEST
    width, height = size(STILL.read_bytes())
    assert width >= 1.5 * height


@pytest.mark.usefixtures("browser")
@pytest.mark.deep
def test_the_command_photographs_a_story(tmp_path: Path) -> None:
    """In a process of its own: this one has a browser open already."""
    page, picture = tmp_path / "page.html", tmp_path / "picture.png"
    command = [sys.executable, "-m", "modeproof", "simulate", "--out", page, "--picture", picture]
    subprocess.run([*command, "--story", "normal_change", "--step", "7"], cwd=ROOT, check=True)
    assert size(picture.read_bytes())[0] == size(STILL.read_bytes())[0]
    assert picture.stat().st_size > LARGEST / 10


@pytest.mark.parametrize(
    ("story", "said"), [("norml_change", "normal_change"), ("welded_contactor", "story.svg.j2 is missing")]
)
def test_a_story_that_cannot_be_drawn_is_refused(story: str, said: str) -> None:
    with pytest.raises(Unjudged, match=said):
        svg(ROOT, story)


def test_a_picture_of_another_kind_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["simulate", "--out", str(tmp_path / "page.html"), "--picture", str(tmp_path / "x.gif")]
    assert main(arguments) == 2
    assert "a picture is a .png or a .svg" in capsys.readouterr().err


def test_without_chromium_no_photograph_is_made(monkeypatch: pytest.MonkeyPatch, page_file: Path) -> None:
    monkeypatch.setenv("MODEPROOF_CHROMIUM", "no-such-browser")
    with pytest.raises(Unjudged, match="Chromium is missing"):
        png(ROOT, page_file, "normal_change", 1)
    with pytest.raises(Unjudged, match="has no step 99"):
        png(ROOT, page_file, "normal_change", 99)
