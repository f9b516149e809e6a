"""The recorded results of mutation campaigns, spec/<document>/scores.toml: what became of the planted faults.

A campaign takes minutes to hours, so no lane runs it; `modeproof mutate` writes what it found. Each campaign
names the files that it was about by their SHA-256, so a score of an earlier text is known for one.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from modeproof.registers.load import read_register

WHAT = {
    "spec": ("the specification", "a property", "modeproof mutate spec --document {}"),
    "impl": ("our program", "a theorem", "modeproof mutate impl --document {}"),
    "vectors": ("our program", "a test vector", "modeproof mutate impl --judge vectors --document {}"),
}
"""Of each campaign: what is edited, what may notice it, and the command that runs it."""


@dataclass(frozen=True)
class Score:
    """One campaign: how many mutants had each verdict, and the files that it was about."""

    what: str
    judged_on: str
    killed: int
    equivalent: int
    invalid: int
    survived: int
    survived_explained: int
    unmeasured: int
    files: Mapping[str, str]

    @property
    def different(self) -> int:
        """The mutants that behave differently, as far as we know: only these count."""
        return self.killed + self.survived + self.unmeasured

    def changed(self, root: Path) -> tuple[str, ...]:
        """The files that are no longer those that were judged."""
        return tuple(name for name, digest in self.files.items() if _sha256(root / name) != digest)


def load_scores(root: Path, name: str) -> tuple[Score, ...]:
    """The recorded campaigns of a document; none where it has no register."""
    if not (root / "spec" / name / "scores.toml").is_file():
        return ()
    return tuple(Score(**row) for row in read_register(root, name, "scores")["campaign"])


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""
