"""What the tests of a function block ask of its registers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from modeproof.ground.places import root
from modeproof.registers.load import load_document
from modeproof.registers.readings import readings_of
from modeproof.registers.rows import Document
from modeproof.registers.runs import Run, load_runs
from modeproof.registers.tla import read_modules


@dataclass(frozen=True)
class Block:
    """A block by its document."""

    document: str

    @property
    def spec(self) -> Path:
        """The folder of the specification."""
        return root() / "spec" / self.document

    @cached_property
    def registers(self) -> Document:
        """The registers of the document."""
        return load_document(root(), self.document)

    @cached_property
    def runs(self) -> dict[str, Run]:
        """Every declared run by its id."""
        return {run.id: run for run in load_runs(root(), self.document)}

    def readings(self) -> set[str]:
        """The readings of the document and those of its family."""
        modules = read_modules(root(), self.document)
        return set(readings_of(self.registers, modules))

    def tried(self) -> dict[str, str]:
        """The kind of the run that tries each reading; that of the demands where there is no other."""
        runs = sorted(self.runs.values(), key=lambda run: not run.module.endswith("Demands"))
        return {reading: run.kind for run in runs for reading in run.readings}
