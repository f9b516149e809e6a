"""The recorded results of mutation campaigns, spec/<document>/scores.toml: what became of the planted faults.

A campaign takes minutes to hours, so no lane runs it; `modeproof mutate` records what it found, with hashes
of the texts that were judged. A score of an earlier text says that it is one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from modeproof.registers.load import read_register

WHAT = {
    "spec": ("the specification", "a property"),
    "impl": ("our program", "a theorem"),
    "vectors": ("our program", "a test vector"),
}
"""Of each campaign: what is edited, and what may notice it."""


@dataclass(frozen=True)
class Score:
    """One campaign over every mutant: how many had each verdict, and the hashes of what was judged."""

    what: str
    judged_on: str
    command: str
    killed: int
    equivalent: int
    invalid: int
    survived: int
    survived_explained: int
    unmeasured: int
    earlier_text: bool
    files: Mapping[str, str]

    @property
    def real(self) -> int:
        """The mutants that behave differently, as far as is known: only these count."""
        return self.killed + self.survived + self.unmeasured


def load_scores(root: Path, name: str) -> tuple[Score, ...]:
    """The recorded campaigns of a document; none where it has no register."""
    if not (root / "spec" / name / "scores.toml").is_file():
        return ()
    return tuple(Score(**row) for row in read_register(root, name, "scores").get("campaign", ()))
