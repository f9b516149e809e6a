"""The tool as a user has it: from the wheelhouse, with no checkout, make, gcc, git or Java about."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from modeproof.ground.places import TREE

WHEELS = TREE / "build" / "wheels"
COREUTILS = ("cat", "cp", "env", "ls", "mkdir", "rm", "sh", "test")


@dataclass(frozen=True)
class Installed:
    """A folder with a virtual environment that has the tool and its base, and with a few programs."""

    place: Path

    @property
    def environment(self) -> dict[str, str]:
        """All that a command may find."""
        path = os.pathsep.join([str(self.place / "venv" / "bin"), str(self.place / "bin")])
        return {"PATH": path, "HOME": str(self.place)}

    def which(self, name: str) -> str | None:
        """Where a program is, if a command finds it."""
        return shutil.which(name, path=self.environment["PATH"])

    def run(
        self, folder: Path, *command: str, status: int = 0, **more: str
    ) -> subprocess.CompletedProcess[str]:
        """Run a command in a folder; it must end with this status."""
        program = self.which(command[0])
        assert program is not None, command[0]
        done = subprocess.run(
            [program, *command[1:]],
            cwd=folder,
            env=self.environment | more,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == status, done.stdout + done.stderr
        return done


def recipe(path: str) -> Any:
    """What a recipe in YAML holds."""
    return yaml.safe_load((TREE / path).read_text(encoding="utf-8"))


def install(place: Path) -> Installed:
    """Fill the wheelhouse, and install from it alone, by the step of the action."""
    fill = [sys.executable, "-m", "modeproof.lane.wheelhouse", str(WHEELS)]
    filled = subprocess.run(fill, cwd=TREE, capture_output=True, text=True, check=False)
    assert filled.returncode == 0, filled.stderr
    subprocess.run([sys.executable, "-m", "venv", place / "venv"], check=True)
    (place / "bin").mkdir()
    for name in COREUTILS:
        found = shutil.which(name)
        assert found is not None
        (place / "bin" / name).symlink_to(found)
    made = Installed(place)
    _, step, _ = recipe("action.yml")["runs"]["steps"]
    made.run(place, "sh", "-c", step["run"], WHEELS=str(WHEELS), PIP_NO_INDEX="1")
    return made


def spent() -> float:
    """Seconds of CPU time of all commands so far."""
    used = os.times()
    return used.children_user + used.children_system
