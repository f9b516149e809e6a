"""The published vectors: what a file holds, and which files it says that it was made from. So drift shows
without making them again; that nobody edited them shows in SHA256SUMS, which `sha256sum -c` reads.
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
SUMS = "SHA256SUMS"
REMEDY = "run modeproof vectors publish"
REMEDY_MACHINE = "run modeproof machine --publish"
DECIDING = ("interface.toml", "classes.toml", "contracts.toml", "sequences.toml", "wiring.toml", "use.toml")
"""Registers that decide what a vector holds, besides the specification. Others give its sentences."""
CODE = "refimpl/"
"""Where the code lies that decides it for a whole machine, of which there is no graph."""
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
    deciding = [name for name in sources if _decides(name)]
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

    room = root / ROOM
    paths = published_files(root)
    listed = _sums(root)
    names = {path.relative_to(room).as_posix() for path in paths}
    lost = [Problem(f"{ROOM}/{name}", "", "is not there") for name in sorted(set(listed) - names)]
    return lost + [
        Problem(path.relative_to(root).as_posix(), "", f"{text}; {remedy(path)}")
        for path in paths
        for text in _faults(path, listed.get(path.relative_to(room).as_posix()), digest)
    ]


def published_files(root: Path, target: str = "*") -> list[Path]:
    """The published files of a target, or of all."""
    return sorted((root / ROOM).glob(f"{target}/*.jsonl.gz"))


def suite_name(path: Path) -> str:
    """The suite of a published file."""
    return path.name.removesuffix(".jsonl.gz")


def of_machine(path: Path) -> bool:
    """Whether a file holds vectors of a whole machine, whose header has its wiring."""
    try:
        with gzip.open(path, "rb") as lines:
            return "wiring" in json.loads(next(lines, b""))
    except _ERRORS:
        return False


def remedy(path: Path) -> str:
    """What brings a published file up to date."""
    return REMEDY_MACHINE if of_machine(path) else REMEDY


def published(root: Path, target: str, suite: str) -> Path | None:
    """The published file of a suite, if it is sealed, whole and of the specification as it is now."""
    name = f"{target}/{suite}.jsonl.gz"
    if not (root / ROOM / name).is_file():
        return None
    faults = _faults(root / ROOM / name, _sums(root).get(name), lambda source: _sha256(root / source))
    return None if any(faults) else root / ROOM / name


def _sums(root: Path) -> dict[str, str]:
    """The SHA-256 of each published file, as SHA256SUMS says."""
    sums = root / ROOM / SUMS
    return dict(line.split("  ")[::-1] for line in sums.read_text().splitlines()) if sums.is_file() else {}


def sums_text(room: Path) -> str:
    """The text of SHA256SUMS for the vectors that lie in a room."""
    paths = sorted(room.glob("*/*.jsonl.gz"))
    return "".join(f"{_sha256(path)}  {path.relative_to(room).as_posix()}\n" for path in paths)


def _faults(path: Path, listed: str | None, digest: Callable[[str], str]) -> Iterator[str]:
    if listed != _sha256(path):
        yield f"was changed since it was published, says {ROOM}/{SUMS}" if listed else f"is not in {SUMS}"
    try:
        with gzip.open(path, "rb") as lines:
            sources = _sources(json.loads(next(lines, b"")))
            for line in lines:
                if 0 < line.count(b'"dt_ms":') == line.count(b'"settling":true'):
                    yield f"compares nothing in case {json.loads(line)['id']}"
                    break
    except _ERRORS as error:
        yield _no_file(error)
        return
    yield from drift(sources, digest)


def _sources(header: Any) -> dict[str, str]:
    return {str(name): str(value) for name, value in header["sources"].items()}


def _no_file(error: BaseException) -> str:
    return f"is no file of vectors ({type(error).__name__})"


def _decides(name: str) -> bool:
    if name.startswith("spec/"):
        return name.endswith(".tla") or name.rsplit("/", 1)[1] in DECIDING
    return name.startswith(CODE)


def _sha256(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""
