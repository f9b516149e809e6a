"""The table of faults: is it complete, and does it name what exists."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import get_args

from modeproof.ground.errors import suggestion
from modeproof.registers.rows import Document, FaultClass, Problem

CELL = re.compile(r"(?P<row>.+) at (?P<column>[^:,]+)(?P<rest>[^:]*): (?P<what>.+)")
"""A witness that is a cell of a matrix."""


def check_faults(document: Document) -> Iterator[Problem]:
    """Classes without a row, rows that name no run, and names that no other register has."""
    if not document.faults:
        return
    file = document.source("assumptions")
    for missing in [
        name for name in get_args(FaultClass) if name not in {fault.kind for fault in document.faults}
    ]:
        yield Problem(file, missing, "no row for this class of faults")
    runs = {run.id: run for run in document.runs}
    properties = {prop.id: prop for prop in document.properties}
    for fault in document.faults:
        if not fault.runs and not fault.falls and not fault.not_modelled:
            yield Problem(file, fault.id, "names no run, and `not_modelled` does not say why")
        for name in (*fault.runs, *(fall.run for fall in fault.falls)):
            if name not in runs:
                yield Problem(file, fault.id, f"unknown run {name!r}; {suggestion(name, runs)}")
        for name in (*fault.holds, *(fall.property for fall in fault.falls)):
            if name not in properties:
                yield Problem(file, fault.id, f"unknown property {name!r}; {suggestion(name, properties)}")
        for fall in fault.falls:
            run, known = runs.get(fall.run), properties.get(fall.property)
            if run and known and run.property != known.tla:
                yield Problem(file, fault.id, f"{fall.run} does not show that {fall.property} fails")
        checked = {name for run in fault.runs if run in runs for name in runs[run].properties}
        for name in fault.holds:
            if name in properties and properties[name].tla not in checked:
                yield Problem(file, fault.id, f"none of its runs checks {name}")
    if document.matrix is not None and not (
        document.matrix.run in runs and any(map(CELL.fullmatch, runs[document.matrix.run].witnesses))
    ):
        yield Problem(file, "matrix", f"{document.matrix.run} is no run whose witnesses are cells")
