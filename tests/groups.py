"""Which tests share a process when several run at once: those that share what is made once."""

from __future__ import annotations

from pathlib import Path, PurePath

ROOT = Path(__file__).resolve().parents[1]
SHARING = frozenset({"anywhere", "proofs", "report", "simulate", "spec", "strength", "trace"})
"""Rooms whose tests share explored devices, parse trees, runs of TLC, graphs or a page, by document."""
APART = frozenset({"report/browser"})
"""Rooms within such a room that share nothing with the rest of it."""
DOCUMENTS = frozenset(path.parent.name for path in ROOT.glob("spec/*/interface.toml"))


def group_of(file: PurePath, documents: frozenset[str] = DOCUMENTS) -> str:
    """The group of a test file, given below tests/: its room, or room and document, or the file alone."""
    room, *rest = file.parts
    if room not in SHARING or not rest:
        return file.as_posix()
    return f"{room}/{rest[0]}" if rest[0] in documents or f"{room}/{rest[0]}" in APART else room
