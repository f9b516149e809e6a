"""Campaigns of mutants over the present texts, from evidence alone: what was killed, what not and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from modeproof.report.sources import Evidence, Sources

KINDS = {
    "spec": ("the specification", "properties", "modeproof mutate spec --document {}"),
    "impl": ("the reference implementation", "theorems", "modeproof mutate impl --document {}"),
    "vectors": (
        "the reference implementation",
        "suites of vectors",
        "modeproof mutate impl --judge vectors --document {}",
    ),
}
"""Of each campaign: what is edited, what judges, and the command that runs it."""
WORDS = ("KILLED", "SURVIVED", "EQUIVALENT", "INVALID", "UNMEASURED")


@dataclass(frozen=True)
class Campaign:
    """One campaign as its evidence has it."""

    kind: str
    evidence: Evidence

    @property
    def mutants(self) -> Sequence[Mapping[str, Any]]:
        """The judged mutants: id, place, edit, verdict, killers."""
        found: Sequence[Mapping[str, Any]] = self.evidence.result["mutants"]
        return found

    @cached_property
    def judges(self) -> Mapping[str, int]:
        """How many mutants were put to each property, theorem or suite, in the order of asking."""
        return dict(self.evidence.result["judges"])

    @cached_property
    def killed(self) -> Counter[str]:
        """By judge: mutants that it kills."""
        return Counter(name for mutant in self.mutants for name in mutant["killers"])

    @cached_property
    def first(self) -> Counter[str]:
        """By judge: mutants that it was the first to kill."""
        return Counter(mutant["killers"][0] for mutant in self.mutants if mutant["killers"])

    @cached_property
    def alone(self) -> Counter[str]:
        """By judge: mutants that nothing else that was asked kills."""
        return Counter(mutant["killers"][0] for mutant in self.mutants if len(mutant["killers"]) == 1)

    def counts(self, field: str = "") -> Mapping[str, Counter[str]]:
        """Verdicts by the value of a field (module, operator); of all under "" where none is named."""
        found: dict[str, Counter[str]] = {}
        for mutant in self.mutants:
            found.setdefault(str(mutant[field]) if field else "", Counter())[mutant["verdict"]] += 1
        return dict(sorted(found.items()))

    def matrix(self) -> tuple[tuple[str, ...], Mapping[str, Counter[str]]]:
        """The operators, and by judge how many mutants of each operator it kills."""
        cells: dict[str, Counter[str]] = {}
        for mutant in self.mutants:
            for name in mutant["killers"]:
                cells.setdefault(name, Counter())[mutant["operator"]] += 1
        return tuple(sorted({op for row in cells.values() for op in row})), cells


def id_of(kind: str) -> str:
    """The id of a campaign's evidence."""
    return f"strength_{kind}"


def campaign(sources: Sources, document: str, kind: str) -> Campaign | None:
    """The campaign over the present texts; None where there is no evidence of one."""
    found = sources.evidence[document].get(id_of(kind))
    there = found is not None and found.record["kind"] == "strength" and not found.changed
    return Campaign(kind, found) if found is not None and there else None
