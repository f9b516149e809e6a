"""Where things lie: the repository root, the document folders, and the ignored build folder."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

from modeproof.ground.errors import Unjudged, suggestion


def root() -> Path:
    """The repository root: MODEPROOF_ROOT, or the folder that holds the package.

    Raises Unjudged when there is no `spec` folder in it.
    """
    named = os.environ.get("MODEPROOF_ROOT")
    place = Path(named).resolve() if named else Path(__file__).resolve().parents[2]
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


def chosen_documents(place: Path, names: Sequence[str] | None) -> tuple[str, ...]:
    """The documents that a command is about, in the order of `documents`: all, or those named.

    Raises Unjudged when there is none, or when a name is no document's.
    """
    known = documents(place)
    if not known:
        raise Unjudged(f"{place / 'spec'} holds no document; there is nothing to do")
    for name in names or ():
        if name not in known:
            raise Unjudged(f"unknown document {name!r}; {suggestion(name, known)}")
    return tuple(document for document in known if not names or document in names)


def add_document_option(parser: argparse.ArgumentParser) -> None:
    """Add --document, which may be repeated; `chosen_documents` reads `args.document`."""
    parser.add_argument(
        "--document", action="append", metavar="NAME", help="only this document of spec/ (may be repeated)"
    )


def build(place: Path) -> Path:
    """The folder for all that is made: graphs, logs, evidence, reports. Never under version control."""
    return place / "build"
