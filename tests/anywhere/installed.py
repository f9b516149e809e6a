"""The tool as a user has it: installed from the wheelhouse, with no checkout, make, gcc, git or Java about."""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import mkdtemp

from modeproof.ground.places import TREE

WHEELS = TREE / "build" / "wheels"
COREUTILS = ("cat", "cp", "env", "ls", "mkdir", "rm", "sh", "test")


@functools.cache
def installed() -> Path:
    """A virtual environment with the tool and its base alone; made once for all tests of a process."""
    done = subprocess.run(
        [sys.executable, "-m", "modeproof.lane.wheelhouse", str(WHEELS)],
        cwd=TREE,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    place = Path(mkdtemp(prefix="modeproof-installed-"))
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", place / "venv"], check=True)
    pip = [sys.executable, "-m", "pip", "--python", str(python(place / "venv")), "--quiet"]
    subprocess.run([*pip, "install", "--no-index", "--find-links", WHEELS, "modeproof"], check=True)
    bare = place / "bin"
    bare.mkdir()
    for name in COREUTILS:
        found = shutil.which(name)
        assert found is not None
        (bare / name).symlink_to(found)
    return place


def python(venv: Path) -> Path:
    """Its interpreter."""
    return venv / "bin" / "python"


def environment(place: Path) -> dict[str, str]:
    """All that a command may find: the environment's programs and a few of the system's."""
    return {"PATH": os.pathsep.join([str(place / "venv" / "bin"), str(place / "bin")]), "HOME": str(place)}


def run(
    place: Path, folder: Path, *command: str, status: int = 0, **more: str
) -> subprocess.CompletedProcess[str]:
    """Run a command there, in this folder."""
    given = environment(place) | more
    found = shutil.which(command[0], path=given["PATH"])
    assert found is not None, command[0]
    words = [found, *command[1:]]
    done = subprocess.run(words, cwd=folder, env=given, capture_output=True, text=True, check=False)
    assert done.returncode == status, done.stdout + done.stderr
    return done
