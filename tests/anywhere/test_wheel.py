"""One wheel is the whole tool: installed where nothing else is, it proves a block of the user's at once."""

from __future__ import annotations

import resource
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from modeproof.ground.places import TREE
from tests.anywhere.installed import WHEELS, environment, installed, run

pytestmark = pytest.mark.deep
MOST_MB, WHEEL_MB = 160, 10
HELP_S, PROOF_S = 0.3, 5.0
"""Of CPU."""


@pytest.fixture
def place() -> Path:
    return installed()


def spent() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def files(folder: Path) -> Iterator[Path]:
    return (path for path in folder.rglob("*") if path.is_file())


def tool_files(place: Path) -> dict[str, int]:
    """The files of the installed tool, and when each was written; what Python compiles may come later."""
    found = files(place / "venv")
    return {str(path): path.stat().st_mtime_ns for path in found if path.suffix != ".pyc"}


def test_wheel_and_installation_are_small(place: Path) -> None:
    [wheel] = WHEELS.glob("modeproof-*.whl")
    assert wheel.stat().st_size <= WHEEL_MB * 1e6
    size = sum(path.stat().st_size for path in files(place / "venv" / "lib"))
    assert size <= MOST_MB * 1e6, f"{size / 1e6:.0f} MB"


def test_nothing_else_is_to_be_found(place: Path) -> None:
    for name in ("make", "gcc", "cc", "git", "java", "pip"):
        assert shutil.which(name, path=environment(place)["PATH"]) is None
    assert "not installed" in run(place, place, "modeproof", "doctor").stdout


def test_one_command_proves_a_block_of_an_empty_folder(place: Path, tmp_path: Path) -> None:
    shutil.copy(TREE / "examples/st/sf_edm.st", tmp_path / "mine.st")
    (tmp_path / "spec" / "foo").mkdir(parents=True)  # means nothing
    (tmp_path / "spec" / "foo" / "interface.toml").write_text("[devices]\n")
    before = tool_files(place)
    began = spent()
    said = run(place, tmp_path, "modeproof", "prove-program", "mine.st", "--target", "sf_edm").stdout
    assert spent() - began <= PROOF_S
    assert said.startswith("PROVED: function block SF_EDM of mine.st has the outputs of sf_edm (edm)")
    assert sorted(path.name for path in tmp_path.iterdir()) == [".modeproof", "mine.st", "spec"]
    assert tool_files(place) == before


def test_the_help_is_there_at_once(place: Path, tmp_path: Path) -> None:
    began = spent()
    assert "prove-program" in run(place, tmp_path, "modeproof", "--help").stdout
    assert spent() - began <= HELP_S


def test_what_is_not_installed_is_one_line(place: Path, tmp_path: Path) -> None:
    done = run(place, tmp_path, "modeproof", "check", "MC_any", status=2)
    assert len(done.stderr.splitlines()) == 1 and "TLC" in done.stderr


def test_two_runs_at_once_do_not_hinder_each_other(place: Path, tmp_path: Path) -> None:
    for name in ("one", "two"):
        text = (TREE / "examples/st/sf_edm.st").read_text(encoding="utf-8")
        (tmp_path / f"{name}.st").write_text(text, encoding="utf-8")
    modeproof = str(place / "venv/bin/modeproof")
    running = [
        subprocess.Popen(
            [modeproof, "prove-program", f"{name}.st", "--target", "sf_edm"],
            cwd=tmp_path,
            env=environment(place),
            stdout=subprocess.PIPE,
            text=True,
        )
        for name in ("one", "two")
    ]
    for name, process in zip(("one", "two"), running, strict=True):
        said, _ = process.communicate()
        assert process.returncode == 0 and f"SF_EDM of {name}.st" in said
