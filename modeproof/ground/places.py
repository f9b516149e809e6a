"""Where things lie: the repository root, the document folders, and the ignored build folder."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

from modeproof.ground.errors import Unjudged, suggestion

TREE = Path(__file__).resolve().parents[2]
"""The repository that this package is of."""


def root() -> Path:
    """The repository root: MODEPROOF_ROOT, else the tree in which the command stands, else `TREE`.

    Raises Unjudged when there is no `spec` folder in it, or when it has a modeproof of its own that is not
    this one: a copied checkout would be judged by the tool of the original.
    """
    named = os.environ.get("MODEPROOF_ROOT")
    if named:
        place = Path(named).resolve()
    else:
        stands = Path(os.curdir).resolve()
        place = next((one for one in (stands, *stands.parents) if documents(one)), TREE)
    if not (place / "spec").is_dir():
        raise Unjudged(f"{place}: no folder `spec` here; set MODEPROOF_ROOT to the root of the repository")
    own = place / "modeproof"
    if (own / "cli.py").is_file() and not own.samefile(TREE / "modeproof"):
        raise Unjudged(
            f"{place} has a modeproof of its own, and this is the one of {TREE}: nothing was judged; "
            f"in {place} run `make venv` and `.venv/bin/python -m modeproof`"
        )
    return place


def documents(place: Path) -> tuple[str, ...]:
    """The names of all document folders: those in `spec` that carry one of the registers."""
    return tuple(
        folder.name
        for folder in sorted((place / "spec").glob("*/"))
        if any((folder / f"{register}.toml").is_file() for register in ("document", "interface", "runs"))
    )


def machines(place: Path) -> tuple[str, ...]:
    """The names of all machines: folders in `spec` with a wiring, which are no documents."""
    return tuple(path.parent.name for path in sorted((place / "spec").glob("*/wiring.toml")))


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


def within(place: Path, path: Path) -> str:
    """The path of a file relative to the root. Raises ValueError for one that lies outside.

    In a copied tree `build` leads to that of the original; what is in it lies inside all the same.
    """
    if path.is_relative_to(place) and ".." not in path.parts:
        return path.relative_to(place).as_posix()
    return path.resolve().relative_to(place.resolve()).as_posix()


def build(place: Path) -> Path:
    """The folder for all that is made: graphs, logs, evidence, reports. Never under version control."""
    return place / "build"
