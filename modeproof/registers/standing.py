"""What the page says of a reading, decided by runs: whether a block with it satisfies all demands, and which
property of ours falls. The class of a finding follows from its readings; nobody types it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from modeproof.registers.demands import MODULE
from modeproof.registers.rows import Finding
from modeproof.registers.runs import Run

FORBIDDEN, OPEN, ALLOWED, UNASKED = "forbidden", "open", "a hazard that the page allows", "not asked"
CLASSES = {
    "safety": "The page allows it, or no demand was asked, and a property of ours falls",
    "hazard": "Hazard: the text has one reading, which leaves something to the machine",
    "open": "Open: a block with the other reading satisfies all demands, and no property of ours falls",
    "decided": "Decided by the page: with the other reading a demand falls",
    "untried": "Not judged by a run: no reading was tried alone",
}
"""The classes of findings, what weighs most first."""


@dataclass(frozen=True)
class Standing:
    """One reading: what the page says of it, the demand or property that falls, and the run that shows it."""

    reading: str
    word: str
    broken: str = ""
    run: str = ""


def standings(finding: Finding, runs: Sequence[Run]) -> Iterator[Standing]:
    """Each reading that the finding tries. The demands are those of one block: of readings that only show in
    the whole procedure they were not asked.
    """
    for reading in finding.tries:
        alone = [run for run in runs if run.readings == (reading,)]
        demanded = [run for run in alone if run.module.endswith(MODULE)]
        falls = next((run for run in alone if run.kind == "NEG" and run not in demanded), None)
        excluded = next((run for run in demanded if run.kind == "NEG"), None)
        if excluded is not None:
            yield Standing(reading, FORBIDDEN, excluded.property, excluded.id)
        elif not demanded:
            yield Standing(reading, UNASKED, falls.property if falls else "", falls.id if falls else "")
        elif falls is not None:
            yield Standing(reading, ALLOWED, falls.property, falls.id)
        else:
            yield Standing(reading, OPEN, "", demanded[0].id)


def class_of(finding: Finding, runs: Sequence[Run]) -> str:
    """The class of a finding: by its worst reading; of a choice that is a parameter, by its evidence."""
    if len(finding.readings) == 1:
        return "hazard"
    found = list(standings(finding, runs))
    shown = [run for run in runs if run.id in finding.evidence and not run.module.endswith(MODULE)]
    choice = finding.parameter or not found
    if any(one.word in (ALLOWED, UNASKED) and one.broken for one in found):
        return "safety"
    if choice and any(run.kind == "NEG" for run in shown):
        return "safety"
    if any(one.word in (OPEN, UNASKED) for one in found) or (choice and shown):
        return "open"
    return "decided" if found else "untried"
