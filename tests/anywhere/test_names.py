"""Every file of the tree has a name that every system takes, and no two differ by their case alone."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

import pytest

from modeproof.ground.places import TREE

FORBIDDEN = re.compile(r'[<>:"\\|?*\x00-\x1f]|[ .]$|^(con|prn|aux|nul|com\d|lpt\d)(\.|$)', re.IGNORECASE)
LONGEST = 130
"""Characters: Windows takes 260, and a folder with a virtual environment comes first."""
NOT_OURS = {".venv", "build", ".git", ".hypothesis", ".mypy_cache", ".ruff_cache", ".pytest_cache"}


def misnamed(paths: Iterable[str]) -> list[str]:
    """Those that some system refuses, or takes for one another."""
    names = list(paths)
    many = {name for name, count in Counter(name.lower() for name in names).items() if count > 1}
    return [
        name
        for name in names
        if any(FORBIDDEN.search(part) for part in PurePosixPath(name).parts)
        or len(name) > LONGEST
        or name.lower() in many
    ]


def files(folder: Path) -> Iterable[str]:
    """The files of the tree below a folder, those that are made left out."""
    for path in folder.iterdir():
        if path.name in NOT_OURS or path.name == "__pycache__":
            continue
        if path.is_dir() and not path.is_symlink():
            yield from files(path)
        else:
            yield path.relative_to(TREE).as_posix()


def test_every_system_takes_every_name() -> None:
    found = list(files(TREE))
    assert "README.md" in found and len(found) > 1000
    assert misnamed(found) == []


@pytest.mark.parametrize("name", ["a/b:c.json", "nul.txt", "spec/Aux/x", "end.", "a?b", "x" * 140])
def test_a_name_that_some_system_refuses_is_found(name: str) -> None:
    assert misnamed([name, "good.json"]) == [name]


def test_two_names_that_differ_by_case_are_found() -> None:
    assert misnamed(["spec/EDM.tla", "spec/edm.tla", "b"]) == ["spec/EDM.tla", "spec/edm.tla"]
