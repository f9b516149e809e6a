"""One wheel is the whole tool: installed where nothing else is, it proves a block of the user's at once."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from modeproof.ground.places import TREE
from tests.anywhere.installed import WHEELS, Installed, spent

pytestmark = pytest.mark.deep
MOST_MB, WHEEL_MB = 160, 10
NOT_OURS = ("pip", "setuptools", "pkg_resources", "_distutils_hack", "distutils-precedence")
"""What every virtual environment has."""
HELP_S, PROOF_S = 0.3, 15.0
"""Of CPU."""


def files(folder: Path) -> Iterator[Path]:
    return (path for path in (folder, *folder.rglob("*")) if path.is_file())


def tool_files(installed: Installed) -> dict[str, int]:
    """The files of the installed tool, and when each was written; what Python compiles may come later."""
    found = files(installed.place / "venv")
    return {str(path): path.stat().st_mtime_ns for path in found if path.suffix != ".pyc"}


def test_wheel_and_installation_are_small(installed: Installed) -> None:
    [wheel] = WHEELS.glob("modeproof-*.whl")
    assert wheel.stat().st_size <= WHEEL_MB * 1e6
    [packages] = installed.place.glob("venv/lib/*/site-packages")
    rooms = [path for path in packages.iterdir() if not path.name.startswith(NOT_OURS)]
    size = sum(path.stat().st_size for room in rooms for path in files(room))
    assert 50e6 < size <= MOST_MB * 1e6, f"{size / 1e6:.0f} MB"


def test_nothing_else_is_to_be_found(installed: Installed) -> None:
    assert [name for name in ("make", "gcc", "cc", "git", "java") if installed.which(name)] == []
    assert "nothing is missing" in installed.run(installed.place, "modeproof", "doctor").stdout


def test_one_command_proves_a_block_twice_at_once(installed: Installed, tmp_path: Path) -> None:
    (tmp_path / "spec" / "foo").mkdir(parents=True)  # means nothing
    (tmp_path / "spec" / "foo" / "interface.toml").write_text("[devices]\n")
    before, began, running = tool_files(installed), spent(), {}
    for name in ("one.st", "two.st"):
        shutil.copy(TREE / "examples/st/sf_edm.st", tmp_path / name)
        command = [installed.which("modeproof") or "", "prove-program", name, "--target", "sf_edm"]
        running[name] = subprocess.Popen(
            command, cwd=tmp_path, env=installed.environment, stdout=subprocess.PIPE, text=True
        )
    for name, process in running.items():
        said, _ = process.communicate()
        assert process.returncode == 0
        assert said.startswith(f"FOLLOWS: function block SF_EDM of {name} follows the page of sf_edm (edm)")
    assert spent() - began <= 2 * PROOF_S
    assert sorted(path.name for path in tmp_path.iterdir()) == [".modeproof", "one.st", "spec", "two.st"]
    assert tool_files(installed) == before


def test_the_help_is_there_at_once(installed: Installed, tmp_path: Path) -> None:
    began = spent()
    assert "prove-program" in installed.run(tmp_path, "modeproof", "--help").stdout
    assert spent() - began <= HELP_S


def test_what_is_not_installed_is_one_line(installed: Installed, tmp_path: Path) -> None:
    done = installed.run(tmp_path, "modeproof", "check", "WIT_SF_EDM", status=2)
    [line] = done.stderr.splitlines()
    assert "the TLC jar is missing" in line and 'pip install "modeproof[tlc]"' in line


def test_vectors_and_logs_are_judged_without_java(installed: Installed, tmp_path: Path) -> None:
    installed.run(tmp_path, "modeproof", "example", "fplc_good.csv")
    said = installed.run(tmp_path, "modeproof", "trace", "fplc", "fplc_good.csv").stdout
    assert "CONFORMS(exact, fplc_good.csv; 8 of 8 outputs compared" in said
    given = ["modeproof", "conform", "sf_edm", "--builtin", "refimpl"]
    assert "CONFORMS(exact, brief" in installed.run(tmp_path, *given, "--suite", "brief").stdout
    [line] = installed.run(tmp_path, *given, "--suite", "tour", status=2).stderr.splitlines()
    assert "the suite tour has to be made" in line and 'pip install "modeproof[tlc]"' in line
