"""The recorded results of mutation campaigns, spec/<document>/scores.toml: what became of the planted faults.

A campaign takes minutes to hours, so no lane runs it; `modeproof mutate ... --record` writes what it found,
and hashes of the texts that it rests on (modeproof/strength/scores.py).
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import msgspec

from modeproof.registers.files import read_toml
from modeproof.registers.typed import Entry, typed

WHAT = {
    "spec": ("the specification", "a property"),
    "impl": ("our program", "a theorem"),
    "vectors": ("our program", "a test vector"),
}
"""Of each campaign: what is edited, and what may notice it."""
Count = Annotated[int, msgspec.Meta(ge=0)]
Hash = Annotated[str, msgspec.Meta(pattern=r"^[0-9a-f]{16}$")]


class Score(Entry, frozen=True, kw_only=True):
    """One campaign over every mutant: how many had each verdict, and a hash of each text that it rests on.

    earlier_text: it was judged on a text before the present one.
    """

    what: Literal["spec", "impl", "vectors"]
    judged_on: Annotated[str, msgspec.Meta(pattern=r"^\d{4}-\d\d-\d\d$")]
    command: str
    killed: Count
    equivalent: Count
    invalid: Count
    survived: Count
    survived_explained: Count
    unmeasured: Count
    earlier_text: bool
    files: Annotated[dict[str, Hash], msgspec.Meta(min_length=1)]

    @property
    def different(self) -> int:
        """The mutants that behave differently, as far as we know: only these count."""
        return self.killed + self.survived + self.unmeasured

    @property
    def row(self) -> list[str]:
        """Its row of a table: what was planted and who is to notice it, how much was, the command."""
        edited, judge = WHAT[self.what]
        share = f" ({100 * self.killed / self.different:.1f} %)" if self.different else ""
        open_ones = self.survived - self.survived_explained
        rest = [f"{self.killed} of {self.different}{share}"]
        if self.survived:
            explained = f"{open_ones} unexplained" if open_ones else "each explained"
            rest.append(f"{self.survived} not noticed, {explained}")
        if self.unmeasured:
            rest.append(f"{self.unmeasured} unmeasured")
        if self.earlier_text:
            rest.append("of an earlier text")
        return [
            f"planted faults in {edited} that {judge} notices ({self.judged_on})",
            "; ".join(rest),
            f"`{self.command}`",
        ]


class _Record(Entry, frozen=True, kw_only=True):
    document: str
    campaign: tuple[Score, ...]


def scores_path(root: Path, name: str) -> Path:
    """Where the record of a document lies."""
    return root / "spec" / name / "scores.toml"


def load_scores(root: Path, name: str) -> tuple[Score, ...]:
    """The recorded campaigns of a document; none where it has no register. Raises Unjudged."""
    path = scores_path(root, name)
    if not path.is_file():
        return ()
    return typed(_Record, read_toml(root, path), f"spec/{name}/scores.toml").campaign
