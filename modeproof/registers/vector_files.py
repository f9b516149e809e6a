"""The published vectors say which files they were made from: drift shows without making them again."""

from __future__ import annotations

import gzip
import hashlib
import json
import zlib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

from modeproof.registers.rows import Problem

ROOM = "vectors"
REMEDY = "run modeproof vectors publish"
DECIDING = ("interface.toml", "classes.toml", "contracts.toml", "sequences.toml")
"""Registers that decide what a vector holds, besides the specification. Others give its sentences."""


def check_vectors(root: Path) -> list[Problem]:
    """Every published file that does not say what it was made from, or was made from another text."""

    @cache
    def digest(name: str) -> str:
        return _sha256(root / name)

    return [
        Problem(path.relative_to(root).as_posix(), "", f"{text}; {REMEDY}")
        for path in sorted((root / ROOM).glob("*/*.jsonl.gz"))
        for text in _faults(path, digest)
    ]


def _faults(path: Path, digest: Callable[[str], str]) -> Iterator[str]:
    try:
        with gzip.open(path, "rt", encoding="utf-8") as lines:
            header = json.loads(next(lines, ""))
        sources = {str(name): str(value) for name, value in header["sources"].items()}
    except (OSError, EOFError, ValueError, zlib.error, LookupError, TypeError, AttributeError) as error:
        yield f"is no file of vectors ({type(error).__name__})"
        return
    deciding = [name for name in sources if name.startswith("spec/") and _decides(name)]
    if not deciding:
        yield "does not say which specification it was made from"
    for name in deciding:
        if digest(name) != sources[name]:
            yield f"{name} is another one now"
            return


def _decides(name: str) -> bool:
    return name.endswith(".tla") or name.rsplit("/", 1)[1] in DECIDING


def _sha256(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""
