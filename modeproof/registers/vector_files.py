"""The published vectors: what a file holds, and which files it says that it was made from. So drift shows
without making them again.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.rows import Problem

ROOM = "vectors"
REMEDY = "run modeproof vectors publish"
DECIDING = ("interface.toml", "classes.toml", "contracts.toml", "sequences.toml")
"""Registers that decide what a vector holds, besides the specification. Others give its sentences."""
_ERRORS = (OSError, EOFError, ValueError, zlib.error, LookupError, TypeError, AttributeError)
"""What reading a file that is none of vectors may raise."""


@dataclass(frozen=True)
class VectorFile:
    """One file of the room, its lines as the schema says; `sources`: the SHA-256 of what it was made from."""

    header: Mapping[str, Any]
    cases: tuple[Mapping[str, Any], ...]
    sources: Mapping[str, str]


def vectors_path(target: str, suite: str) -> str:
    """The file of a suite, relative to the root."""
    return f"{ROOM}/{target}/{suite}.jsonl.gz"


def read_vectors(packed: bytes) -> VectorFile:
    """A whole file. Raises Unjudged where it is damaged, or does not hold the cases that it counts."""
    try:
        header, *cases = map(json.loads, gzip.decompress(packed).decode("utf-8").rstrip("\n").split("\n"))
        counted, sources = int(header["cases"]), _sources(header)
    except _ERRORS as error:
        raise Unjudged(_no_file(error)) from None
    if len(cases) != counted:
        raise Unjudged(f"holds {len(cases)} cases and says {counted}")
    return VectorFile(header, tuple(cases), sources)


def drift(sources: Mapping[str, str], digest: Callable[[str], str]) -> Iterator[str]:
    """The first source of a file that has changed, if any has; `digest` gives the SHA-256 of a file now."""
    deciding = [name for name in sources if name.startswith("spec/") and _decides(name)]
    if not deciding:
        yield "does not say which specification it was made from"
    for name in deciding:
        if digest(name) != sources[name]:
            yield f"{name} has changed"
            return


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
            sources = _sources(json.loads(next(lines, "")))
    except _ERRORS as error:
        yield _no_file(error)
        return
    yield from drift(sources, digest)


def _sources(header: Any) -> dict[str, str]:
    return {str(name): str(value) for name, value in header["sources"].items()}


def _no_file(error: BaseException) -> str:
    return f"is no file of vectors ({type(error).__name__})"


def _decides(name: str) -> bool:
    return name.endswith(".tla") or name.rsplit("/", 1)[1] in DECIDING


def _sha256(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""
