"""Where things lie: the tree of the tool, the user's project, and the folder for all that is made."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path

from modeproof.ground.errors import Unjudged, suggestion

TREE = Path(__file__).resolve().parents[2]
"""The tree that this package is of: a checkout, or `_home` of an installed wheel, of the same layout."""

INSTALLED = TREE.name == "_home"
"""Whether this is an installed wheel, in which nothing is ever written."""

PROJECT_FILE = "modeproof.toml"
"""The file that lists what is a user's; its folder is their project."""


def root() -> Path:
    """The tree that is judged: `TREE`, or, for maintainers, the one that MODEPROOF_ROOT names.

    Raises Unjudged when the latter has no `spec` folder, and when it, or the current folder, is of another
    checkout with a modeproof of its own: a copied checkout would be judged by the tool of the original.
    """
    named = os.environ.get("MODEPROOF_ROOT")
    if named and not (Path(named) / "spec").is_dir():
        raise Unjudged(f"{Path(named).resolve()}: no folder `spec` here; unset MODEPROOF_ROOT")
    for place in [Path(named).resolve()] if named else _above():
        own = place / "modeproof"
        if (own / "cli.py").is_file() and documents(place) and not own.samefile(TREE / "modeproof"):
            raise Unjudged(
                f"{place} has a modeproof of its own, and this is the one of {TREE}: nothing was judged; "
                f"in {place} run `make venv` and `.venv/bin/python -m modeproof`"
            )
    return Path(named).resolve() if named else TREE


def _above() -> tuple[Path, ...]:
    """The current folder and those above it."""
    here = Path(os.curdir).resolve()
    return (here, *here.parents)


def adding(extra: str, package: str) -> str:
    """What to do where a package is missing that an extra of the wheel brings."""
    if INSTALLED:
        return f'pip install "modeproof[{extra}]"' if extra else "pip install --force-reinstall modeproof"
    return f"run `make venv` (it installs {package})"


def project() -> Path:
    """The user's project: the nearest folder with a project file, from the current one up, else that one."""
    above = _above()
    return next((place for place in above if (place / PROJECT_FILE).is_file()), above[0])


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
    """The path of a file relative to the root; of one that was made, `build/...`, wherever that folder is.

    Raises ValueError for one that lies outside. In a copied tree `build` leads to that of the original; what
    is in it lies inside all the same.
    """
    if path.is_relative_to(place) and ".." not in path.parts:
        return path.relative_to(place).as_posix()
    made = build(place)
    if path.is_relative_to(made) and ".." not in path.parts:
        return f"{BUILD}/{path.relative_to(made).as_posix()}"
    return path.resolve().relative_to(place.resolve()).as_posix()


def located(place: Path, name: str) -> Path:
    """The file of a name that `within` gave."""
    room, _, rest = name.partition("/")
    return build(place) / rest if room == BUILD else place / name


BUILD = "build"
"""The name of the folder for all that is made, in a checkout and in what evidence says."""


def in_checkout(place: Path) -> bool:
    """Whether what is done is the tool's own: by who stands in its checkout, or names another tree."""
    return place != TREE or (not INSTALLED and place in _above())


def build(place: Path) -> Path:
    """The folder for all that is made: graphs, logs, evidence, reports. Never under version control.

    MODEPROOF_STATE names it; else it is `build` of a checkout, for whoever is in it, and `.modeproof` of
    the user's project for everybody else.
    """
    named = os.environ.get("MODEPROOF_STATE")
    if named:
        return Path(named).resolve()
    if in_checkout(place):
        return place / BUILD
    return project() / ".modeproof"
