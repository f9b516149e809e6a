"""Reading TOML and writing results, so that every failure is one line with place and cause."""

from __future__ import annotations

import os
import tempfile
import tomllib
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged


def shown(root: Path, path: Path) -> str:
    """The path relative to the repository root, with forward slashes; as it is when it lies elsewhere."""
    try:
        return path.relative_to(root).as_posix()
    except ValueError:
        return path.as_posix()


def read_text(root: Path, path: Path) -> str:
    """The text of a UTF-8 file. Raises Unjudged: missing, unreadable, not UTF-8."""
    place = shown(root, path)
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise Unjudged(f"{place}: not found") from None
    except UnicodeDecodeError as error:
        raise Unjudged(f"{place}: byte {error.start} is not UTF-8") from None
    except OSError as error:
        raise Unjudged(f"{place}: cannot be read: {error.strerror or error}") from None


def read_toml(root: Path, path: Path) -> dict[str, Any]:
    """The tables of a TOML file. Raises Unjudged, with the line, when the file is not TOML."""
    try:
        return tomllib.loads(read_text(root, path))
    except tomllib.TOMLDecodeError as error:
        raise Unjudged(f"{shown(root, path)}: not valid TOML: {error}") from None


def write_text(path: Path, text: str) -> None:
    """Write all of the file or nothing of it. Raises Unjudged when the place cannot be written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except OSError as error:
        raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None
    temporary = Path(name)
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
        temporary.chmod(0o644)
        temporary.replace(path)
    except OSError as error:
        raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        temporary.unlink(missing_ok=True)
