"""A shell completes commands, options and their values."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.cli import COMMANDS, main
from modeproof.ground.places import TREE
from modeproof.lane.completion import HOW


def offered(line: str, folder: Path) -> list[str]:
    """What the shell would offer at the end of a line."""
    answer = folder / "answer"
    done = subprocess.run(
        [sys.executable, "-m", "modeproof"],
        cwd=TREE,
        env={
            "_ARGCOMPLETE": "1",
            "_ARGCOMPLETE_IFS": "\n",
            "_ARGCOMPLETE_SUPPRESS_SPACE": "1",
            "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
            "COMP_LINE": line,
            "COMP_POINT": str(len(line)),
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return [word.strip() for word in answer.read_text().split("\n")]


def test_commands_options_and_values_are_offered(tmp_path: Path) -> None:
    assert set(COMMANDS) <= set(offered("modeproof ", tmp_path))
    assert offered("modeproof ma", tmp_path) == ["machine", "map"]
    assert offered("modeproof machine --pr", tmp_path) == ["--properties", "--program"]
    assert offered("modeproof conform fplc --relation ", tmp_path) == ["exact", "settled", "monitor"]
    assert offered("modeproof prove-program x.st --target sf_e", tmp_path) == ["sf_edm", "sf_enable_switch"]
    assert offered("modeproof explain EDMF-04", tmp_path) == ["EDMF-04"]
    assert "README.md" in offered("modeproof prove-program REA", tmp_path)


@pytest.mark.parametrize("shell", HOW)
def test_each_shell_gets_its_lines(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    first, *lines = capsys.readouterr().out.splitlines()
    assert first == f"# {HOW[shell]}" and any("_ARGCOMPLETE" in line for line in lines)


def test_another_shell_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "cmd"]) == 2
    assert "invalid choice: 'cmd'" in capsys.readouterr().err
