"""Reading texts and TOML, so that every failure is one line with place and cause."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
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


def read_own_toml(path: Path) -> tuple[str, dict[str, Any]]:
    """Text and tables of a file that a user names. Raises Unjudged, with the line, when it is not TOML."""
    try:
        text = path.read_text("utf-8")
        return text, tomllib.loads(text)
    except OSError as error:
        raise Unjudged(f"{path}: cannot be read: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Unjudged(f"{path}: no TOML: {error}") from None


def markdown(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table that ends with a line end."""
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += [
        "| " + " | ".join(" ".join(cell.split()).replace("|", "\\|") for cell in row) + " |" for row in rows
    ]
    return "\n".join(lines) + "\n"
