"""Which readings each run restores, and what comes of it: from the cfg of the run and its evidence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from modeproof.ground.errors import Unjudged
from modeproof.registers.made import read_cfg
from modeproof.registers.replay import has_replay, load_replay
from modeproof.registers.rows import Document, Finding
from modeproof.registers.runs import Run
from modeproof.registers.switches import restored
from modeproof.report.claims import Result, result_of
from modeproof.report.sources import Sources


@dataclass(frozen=True)
class Deviation:
    """A run that restores readings; `findings` are those that name it as evidence."""

    run: Run
    readings: tuple[str, ...]
    result: Result
    findings: tuple[Finding, ...]

    @property
    def harmless(self) -> bool:
        """One reading is restored, and every property still holds within the bounds."""
        return len(self.readings) == 1 and self.result.word == "HOLDS" and self.result.good is True


def deviations(sources: Sources, document: Document) -> tuple[Deviation, ...]:
    """The runs that restore readings: those with one first, in the order of the findings.

    Empty where the document does not say which constant restores a reading.
    """
    readings = _readings(sources, document)
    order = {one.id: place for place, one in enumerate(document.findings)}
    found = [
        Deviation(
            run,
            readings[run.id],
            result_of(sources, document, run),
            tuple(finding for finding in document.findings if run.id in finding.evidence),
        )
        for run in document.runs
        if readings.get(run.id)
    ]
    return tuple(
        sorted(
            found,
            key=lambda one: (
                len(one.readings),
                min((order[each.id] for each in one.findings), default=len(order)),
                one.run.id,
            ),
        )
    )


def _readings(sources: Sources, document: Document) -> Mapping[str, tuple[str, ...]]:
    """By run, the readings that its cfg restores; a cfg that cannot be read restores none."""
    literal = ""
    if has_replay(document.root, document.name):
        try:
            literal = load_replay(document.root, document.name).literal
        except Unjudged:
            return {}
    found: dict[str, tuple[str, ...]] = {}
    for run in document.runs:
        try:
            constants = read_cfg(document.root, run).constants
        except Unjudged:
            continue
        sources.content(f"spec/{document.name}/{run.cfg}")
        found[run.id] = run.readings or tuple(sorted(restored(constants, literal)))
    return found
