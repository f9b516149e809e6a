"""Which files of ours a piece of work reads, so that a test can say that each of them is known."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

_watched: list[set[str]] = []


def _hear(event: str, given: tuple[Any, ...]) -> None:
    if event == "open" and _watched and isinstance(given[0], (str, os.PathLike)):
        _watched[-1].add(os.path.abspath(os.fspath(given[0])))


@contextmanager
def reads(root: Path) -> Iterator[set[str]]:
    """The files below the root that are opened meanwhile, by their paths from it; modules as sources."""
    if not _watched:
        sys.addaudithook(_hear)
    opened: set[str] = set()
    found: set[str] = set()
    _watched.append(opened)
    try:
        yield found
    finally:
        _watched.remove(opened)
        for path in map(Path, opened):
            if path.suffix == ".pyc":
                path = path.parents[1] / f"{path.name.partition('.')[0]}.py"
            if path.is_relative_to(root) and path.is_file():
                found.add(path.relative_to(root).as_posix())
