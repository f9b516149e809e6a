"""A copy of the tree in which things are made anew, and the step that puts them into the tree all at once.

Whatever ends the work before that step, the tree is as it was. The step itself is a list of renames that lies
on the disk before the first of them: one that was cut short is finished by whoever works here next.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import build

ROOMS = ("spec", "refimpl", "proofs", "vectors", "scenes", "docs", "examples", "README.md")
"""What is copied. Of the rest of the tree the original is used."""
FOLDER, JOURNAL = "renew", "journal.json"
_LEFT_OUT = shutil.ignore_patterns("__pycache__", ".*.part")


@dataclass(frozen=True)
class Copy:
    """A copy of a tree, and the hash of every file when it was copied."""

    place: Path
    tree: Path
    then: dict[str, str]

    def changed(self) -> dict[str, bool]:
        """The files that differ from the original, by their paths; whether each is in the copy."""
        now = hashes(self.tree)
        names = sorted(name for name in {*now, *self.then} if now.get(name) != self.then.get(name))
        return {name: name in now for name in names}

    def put(self) -> list[str]:
        """Put what differs into the original, all of it; the names of these files.

        Raises Unjudged when somebody has written to the original meanwhile; then nothing is put.
        """
        changed = self.changed()
        now = hashes(self.place)
        if other := [name for name in {*now, *self.then} if now.get(name) != self.then.get(name)]:
            raise Unjudged(f"{min(other)} was written to while this was at work; nothing was put; try again")
        if changed:
            journal = json.dumps({"tree": self.tree.name, "files": changed})
            write_whole(self.tree.parent / JOURNAL, journal.encode())
            finish(self.place)
        return list(changed)


@contextlib.contextmanager
def copied(place: Path) -> Iterator[Copy]:
    """A copy of the tree, which is gone afterwards. What is built is that of the original."""
    finish(place)
    folder = build(place) / FOLDER
    shutil.rmtree(folder, ignore_errors=True)
    tree = folder / "tree"
    tree.mkdir(parents=True)
    try:
        for name in ROOMS:
            if (place / name).is_dir():
                shutil.copytree(place / name, tree / name, symlinks=True, ignore=_LEFT_OUT)
            elif (place / name).is_file():
                shutil.copyfile(place / name, tree / name)
        (tree / "build").symlink_to(build(place).resolve())
        for name in ("modeproof", "programs"):
            if (place / name).exists():
                (tree / name).symlink_to((place / name).resolve())
        yield Copy(place, tree, hashes(tree))
    finally:
        if not (folder / JOURNAL).is_file():
            shutil.rmtree(folder, ignore_errors=True)


def finish(place: Path) -> bool:
    """Carry out the renames of a journal, if one lies there; whether one did."""
    folder = build(place) / FOLDER
    try:
        journal = json.loads((folder / JOURNAL).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return False
    tree = folder / str(journal["tree"])
    for name, there in journal["files"].items():
        if not there:
            (place / name).unlink(missing_ok=True)
        elif (tree / name).is_file():  # not yet renamed
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            os.replace(tree / name, place / name)
    shutil.rmtree(tree, ignore_errors=True)
    (folder / JOURNAL).unlink()
    return True


def hashes(root: Path) -> dict[str, str]:
    """The hash of every file of the rooms that are copied, by its path."""
    found = {}
    for room in ROOMS:
        place = root / room
        for path in [place] if place.is_file() else sorted(place.rglob("*")):
            hidden = "__pycache__" in path.parts or path.name.endswith(".part")
            if path.is_file() and not hidden:
                found[path.relative_to(root).as_posix()] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found
