"""The table of faults: is it complete and does it name what exists, and how it is shown to a reader."""

from __future__ import annotations

import re
from collections.abc import Iterator

from modeproof.registers.rows import Document, Fault, Problem
from modeproof.registers.schema import schema, suggestion

CELL = re.compile(r"(?P<row>.+) at (?P<column>[^:,]+)(?P<rest>[^:]*): (?P<what>.+)")
"""A witness that is a cell of a matrix."""


def check_faults(document: Document) -> Iterator[Problem]:
    """Classes without a row, rows that name no run, and names that no other register has."""
    if not document.faults:
        return
    file = document.source("faults")
    classes: list[str] = schema("faults")["properties"]["fault"]["items"]["properties"]["class"]["enum"]
    for missing in [name for name in classes if name not in {one.kind for one in document.faults}]:
        yield Problem(file, missing, "no row for this class of faults")
    runs = {run.id: run for run in document.runs}
    properties = {one.id: one for one in document.properties}
    for one in document.faults:
        if not one.runs and not one.falls and not one.not_modelled:
            yield Problem(file, one.id, "names no run, and `not_modelled` does not say why")
        for name in (*one.runs, *(fall.run for fall in one.falls)):
            if name not in runs:
                yield Problem(file, one.id, f"unknown run {name!r}; {suggestion(name, runs)}")
        for name in (*one.holds, *(fall.property for fall in one.falls)):
            if name not in properties:
                yield Problem(file, one.id, f"unknown property {name!r}; {suggestion(name, properties)}")
        for fall in one.falls:
            run, known = runs.get(fall.run), properties.get(fall.property)
            if run and known and run.property != known.tla:
                yield Problem(file, one.id, f"{fall.run} does not show that {fall.property} falls")
        checked = {name for run in one.runs if run in runs for name in runs[run].properties}
        for name in one.holds:
            if name in properties and properties[name].tla not in checked:
                yield Problem(file, one.id, f"none of its runs checks {name}")
    if document.matrix is not None and not (
        document.matrix.run in runs and any(map(CELL.fullmatch, runs[document.matrix.run].witnesses))
    ):
        yield Problem(file, "matrix", f"{document.matrix.run} is no run whose witnesses are cells")


def render_faults_table(document: Document) -> str:
    """The rows of the register as a Markdown table that ends with a line end."""
    lines = [
        "| fault | class | in the model | detected by | holds all the same | falls, and what that takes "
        "| detected by nothing |",
        "|---|---|---|---|---|---|---|",
    ]
    for one in document.faults:
        cells = (
            one.title,
            one.kind,
            one.model if not one.not_modelled else f"{one.model} Not modelled, because {one.not_modelled}",
            ", ".join(one.detected_by) or "nothing",
            _holds(one),
            "; ".join(f"{fall.property} (`{fall.run}`): {fall.needs}" for fall in one.falls) or "-",
            one.not_detected,
        )
        lines.append("| " + " | ".join(" ".join(cell.split()).replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def _holds(one: Fault) -> str:
    runs = ", ".join(f"`{run}`" for run in one.runs)
    return ", ".join(one.holds) + (f" ({runs})" if runs else "") or "-"


def render_fault_matrix(document: Document) -> str:
    """The cells of the matrix as a Markdown table; rows and columns in the order of their declaration."""
    matrix = document.matrix
    run = next((run for run in document.runs if matrix is not None and run.id == matrix.run), None)
    if matrix is None or run is None:
        return ""
    cells: dict[tuple[str, str], dict[str, list[str]]] = {}
    for witness in run.witnesses:
        match = CELL.fullmatch(witness)
        if match:
            whats = cells.setdefault((match["row"], match["column"]), {})
            whats.setdefault(match["what"], []).append(match["rest"].strip(", "))
    rows = list(dict.fromkeys(row for row, _ in cells))
    columns = list(dict.fromkeys(column for _, column in cells))
    lines = [f"| {matrix.title} | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for row in rows:
        shown = (_cell(cells.get((row, column), {})) for column in columns)
        lines.append(f"| {row} | " + " | ".join(shown) + " |")
    return "\n".join(lines) + "\n"


def _cell(whats: dict[str, list[str]]) -> str:
    """What can come of it; how long it took is said where it matters."""
    everywhere = {rest for rests in whats.values() for rest in rests}
    parts = []
    for what, rests in whats.items():
        all_the_same = set(rests) == everywhere
        parts.append(what if all_the_same else f"{what} ({', '.join(dict.fromkeys(rests))})")
    return "; ".join(parts) or "-"
