"""Compares the explanations of survivors with the survivors that there are."""

from __future__ import annotations

import fnmatch
from collections.abc import Sequence

from modeproof.strength.campaign import Judged
from modeproof.strength.register import Explained


def explanation_of(explained: Sequence[Explained], mutant: str) -> Explained | None:
    """The explanation that names a mutant, if there is one."""
    for one in explained:
        if any(fnmatch.fnmatchcase(mutant, pattern) for pattern in one.ids):
            return one
    return None


def unexplained(explained: Sequence[Explained], judged: Sequence[Judged]) -> list[Judged]:
    """The survivors that nobody has explained."""
    return [
        one for one in judged if one.word == "SURVIVED" and explanation_of(explained, one.mutant.id) is None
    ]


def explanation_problems(
    explained: Sequence[Explained], judged: Sequence[Judged], complete: bool
) -> list[str]:
    """Explanations that explain nothing: of a mutant that is no survivor, or (when all mutants were judged)
    that is not there any more; and mutants that are explained twice.
    """
    problems: list[str] = []
    words = {one.mutant.id: one.word for one in judged}
    seen: set[str] = set()
    for one in explained:
        for pattern in one.ids:
            matched = fnmatch.filter(words, pattern)
            if not matched and complete:
                problems.append(f"{pattern} is explained and is no mutant")
            for name in matched:
                if words[name] != "SURVIVED":
                    problems.append(f"{name} is explained as a survivor and is {words[name]}")
                if name in seen:
                    problems.append(f"{name} is explained twice")
                seen.add(name)
    return problems
