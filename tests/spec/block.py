"""A function block on trial: TLC on a copy of its specification with one edit planted, or with none."""

from __future__ import annotations

import hashlib
import re
import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import msgspec

from modeproof.ground.places import root
from modeproof.registers.load import load_document
from modeproof.registers.made import cfg_text
from modeproof.registers.readings import readings_of
from modeproof.registers.rows import Document, Property
from modeproof.registers.runs import Run, load_runs
from modeproof.registers.tla import read_modules
from modeproof.tlc.process import run_tlc
from modeproof.tlc.toolchain import find_toolchain

Edit = tuple[str, str]
_CHECKED = re.compile(r"^(INVARIANTS?|PROPERT(?:Y|IES))\b(?s:.*)", re.MULTILINE)


@dataclass(frozen=True)
class Block:
    """A block by its document, its module and the run whose bounds its faults are tried on.

    others: properties that are tried on another run. small: an edit of a further module, planted each time,
    that makes the bounds smaller.
    """

    document: str
    module: str
    base: str
    others: Mapping[str, str] = field(default_factory=dict)
    small: Mapping[str, Edit] = field(default_factory=dict)

    @property
    def spec(self) -> Path:
        """The folder of the specification."""
        return root() / "spec" / self.document

    @cached_property
    def registers(self) -> Document:
        """The registers of the document."""
        return load_document(root(), self.document)

    @cached_property
    def properties(self) -> dict[str, Property]:
        """Every property by its id."""
        return {one.id: one for one in self.registers.properties}

    @cached_property
    def runs(self) -> dict[str, Run]:
        """Every declared run by its id."""
        return {run.id: run for run in load_runs(root(), self.document)}

    @property
    def fallen(self) -> set[str]:
        """The properties that a negative violates."""
        return {run.property for run in self.runs.values() if run.kind == "NEG" and run.property}

    def checked(self, place: Path, name: str, edit: Edit) -> list[tuple[str, str]]:
        """What TLC says of this property alone on a copy with the edit."""
        base = self.runs[self.others.get(name, self.base)]
        folder = place / "spec" / self.document
        shutil.copytree(self.spec, folder)
        shutil.copytree(self.spec.parent / "common", place / "spec/common")
        for file, (old, new) in {self.module: edit, **self.small}.items():
            text = (folder / file).read_text()
            assert text.count(old) == 1, old
            (folder / file).write_text(text.replace(old, new))
        kind = "INVARIANT" if self.properties[name].kind == "invariant" else "PROPERTY"
        text = _CHECKED.sub(f"{kind} {name}\n", cfg_text(root(), base))
        cfg = "models/planted.cfg"
        (folder / cfg).write_text(text)
        digest = hashlib.sha256(text.encode()).hexdigest()
        run = msgspec.structs.replace(base, properties=(name,), base="", cfg=cfg, cfg_sha256=digest)
        log = run_tlc(place, run, find_toolchain()).log
        assert log.violations or log.success, (
            log.errors,
            log.broken,
        )  # a copy that does not parse shows nothing
        return list(log.violations)

    def falls(self, name: str) -> list[tuple[str, str]]:
        """What TLC says when this property falls and no other is checked; it does not name a liveness."""
        if self.properties[name].kind == "liveness":
            return [("temporal", "")]
        return [("invariant" if self.properties[name].kind == "invariant" else "property", name)]

    def readings(self) -> set[str]:
        """The readings of the document and those of its family."""
        modules = read_modules(root(), self.document)
        return set(readings_of(self.registers, modules))

    def tried(self) -> dict[str, str]:
        """The kind of the run that tries each reading."""
        return {reading: run.kind for run in self.runs.values() for reading in run.readings}
