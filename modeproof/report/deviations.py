"""Which readings each run tries, and what comes of it."""

from __future__ import annotations

from dataclasses import dataclass

from modeproof.registers.rows import Document, Finding
from modeproof.registers.runs import Run
from modeproof.report.claims import Result, result_of
from modeproof.report.sources import Sources


@dataclass(frozen=True)
class Deviation:
    """A run that tries readings; `findings` are those that name it as evidence.

    `also` are the other runs in which its reading must hold (`also` of runs.toml).
    """

    run: Run
    readings: tuple[str, ...]
    result: Result
    findings: tuple[Finding, ...]
    also: tuple[Result, ...]

    @property
    def holding(self) -> int:
        """In how many of its runs every property holds, as it was declared."""
        return sum(run.word == "HOLDS" and run.good is True for run in (self.result, *self.also))

    @property
    def harmless(self) -> bool:
        """One reading is tried, and every property still holds in each of its runs, within their bounds."""
        return len(self.readings) == 1 and self.holding == 1 + len(self.also)


def deviations(sources: Sources, document: Document) -> tuple[Deviation, ...]:
    """The runs that try readings: those with one first, in the order of the findings."""
    order = {finding.id: place for place, finding in enumerate(document.findings)}
    found = [
        Deviation(
            run,
            run.readings,
            result_of(sources, document, run),
            tuple(finding for finding in document.findings if run.id in finding.evidence),
            tuple(result_of(sources, document, other) for other in document.runs if run.id in other.of[:1]),
        )
        for run in document.runs
        if run.readings and not run.of
    ]
    return tuple(
        sorted(
            found,
            key=lambda tried: (
                len(tried.readings),
                min((order[finding.id] for finding in tried.findings), default=len(order)),
                tried.run.id,
            ),
        )
    )
