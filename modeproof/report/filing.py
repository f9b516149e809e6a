"""What a report is filed under: the day that the caller gives, the commit, the chosen documents."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from datetime import date
from pathlib import Path

from modeproof.ground.errors import Unjudged


@dataclass(frozen=True)
class Filing:
    """`day` is YYYY-MM-DD or empty; `documents` are the only ones, none: all; `answers` a review sheet."""

    day: str = ""
    documents: tuple[str, ...] = ()
    answers: Path | None = None


def day_of(text: str) -> str:
    """A day as the caller gives it. Raises Unjudged for what is no day of the calendar."""
    try:
        return date.fromisoformat(text).isoformat()
    except ValueError:
        raise Unjudged(f"--date {text!r} is no day; give it as in 2026-11-23") from None


def commit_of(root: Path) -> str:
    """The commit of the tree, and whether files were changed since; empty where git knows no such tree."""
    top = _git(root, "rev-parse", "--show-toplevel")
    if not top or Path(top).resolve() != root.resolve():
        return ""
    commit = _git(root, "rev-parse", "HEAD")
    changed = _git(root, "status", "--porcelain", "--untracked-files=no")
    return f"{commit[:12]}{', and files changed since' if changed else ''}" if commit else ""


def _git(root: Path, *arguments: str) -> str:
    try:
        done = subprocess.run(
            ["git", "-C", str(root), *arguments], capture_output=True, timeout=20, check=False, text=True
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""
