"""Where things lie: the repository root, the document folders, and the ignored build folder."""

from __future__ import annotations

import os
from pathlib import Path

from modeproof.errors import Unjudged


def root() -> Path:
    """The repository root: MODEPROOF_ROOT, or the folder that holds the package.

    Raises Unjudged when there is no `spec` folder in it.
    """
    named = os.environ.get("MODEPROOF_ROOT")
    place = Path(named).resolve() if named else Path(__file__).resolve().parent.parent
    if not (place / "spec").is_dir():
        raise Unjudged(f"{place}: no folder `spec` here; set MODEPROOF_ROOT to the root of the repository")
    return place


def documents(place: Path) -> tuple[str, ...]:
    """The names of all document folders: those in `spec` that carry one of the registers."""
    folders = sorted(folder for folder in (place / "spec").iterdir() if folder.is_dir())
    return tuple(
        folder.name
        for folder in folders
        if any((folder / f"{register}.toml").is_file() for register in ("document", "interface", "runs"))
    )


def build(place: Path) -> Path:
    """The folder for all that is made: graphs, logs, evidence, reports. Never under version control."""
    return place / "build"
