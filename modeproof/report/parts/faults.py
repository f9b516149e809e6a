"""The table of faults from outside: what detects each, what holds, what fails, what is not modelled."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from modeproof.registers.fault_table import CELL
from modeproof.registers.rows import Document, Fault
from modeproof.registers.runs import Run
from modeproof.report.claims import Result, result_of, steps_of
from modeproof.report.part import Part
from modeproof.report.sources import Sources, Trouble

ID = "faults"


def part(sources: Sources) -> Part:
    """One entry a document; `faults` is empty where a document declares no table."""
    troubles: list[Trouble] = []
    found = [_document(sources, document, troubles) for document in sources.documents.values()]
    return Part(ID, "Faults from outside", {"documents": found}, tuple(troubles))


def _document(sources: Sources, document: Document, troubles: list[Trouble]) -> dict[str, Any]:
    runs = {run.id: run for run in document.runs}
    shown: list[Result] = []
    rows = [_row(sources, document, fault, runs, shown) for fault in document.faults]
    return {
        "id": document.name,
        "title": document.about.title,
        "register": document.source("faults") if document.faults else None,
        "faults": rows,
        "matrix": _matrix(sources, document, runs),
    }


def _row(
    sources: Sources, document: Document, fault: Fault, runs: Mapping[str, Run], shown: list[Result]
) -> dict[str, Any]:
    holding = [result_of(sources, document, runs[name]) for name in fault.runs if name in runs]
    falling = [
        (fall, result_of(sources, document, runs[fall.run])) for fall in fault.falls if fall.run in runs
    ]
    shown += [*holding, *(each for _, each in falling)]
    return {
        "id": fault.id,
        "class": fault.kind,
        "title": fault.title,
        "model": fault.model,
        "detected_by": list(fault.detected_by),
        "not_detected": fault.not_detected,
        "not_modelled": fault.not_modelled,
        "holds": list(fault.holds),
        "runs": [each.data for each in holding],
        "falls": [
            {**each.data, "property": fall.property, "needs": fall.needs, "steps": steps_of(each)}
            for fall, each in falling
        ],
    }


def _matrix(sources: Sources, document: Document, runs: Mapping[str, Run]) -> dict[str, Any] | None:
    """The table whose cells are witnesses of one run, and which of them the run has reached."""
    if document.matrix is None or document.matrix.run not in runs:
        return None
    run = runs[document.matrix.run]
    result = result_of(sources, document, run)
    reached = result.evidence.result.get("reached", ()) if result.evidence is not None else ()
    cells: dict[str, dict[str, list[dict[str, Any]]]] = {}
    columns: dict[str, None] = {}
    for witness in run.witnesses:
        match = CELL.fullmatch(witness)
        if match is None:
            continue
        columns.setdefault(match["column"])
        text = match["what"] + (f" ({match['rest'].strip(', ')})" if match["rest"].strip(", ") else "")
        row = cells.setdefault(match["row"], {})
        row.setdefault(match["column"], []).append({"text": text, "reached": witness in reached})
    return {
        "title": document.matrix.title,
        "run": result.data,
        "columns": list(columns),
        "rows": [
            {"name": name, "cells": [row.get(column, []) for column in columns]}
            for name, row in cells.items()
        ],
    }
