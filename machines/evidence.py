"""What is found out about the project's own machine, as evidence keeps it and the report shows it."""

from __future__ import annotations

import json
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from machines.flowchart import boxes_and_wires, matrix_rows
from machines.killers import Killer, Killers, name_of, read_killers
from machines.machine_command import OWN, TRUST, rows_of_trace, verdict_rows
from machines.trial import edits
from machines.trial_record import basis_of, outcomes_path, read_outcomes
from machines.verdicts import Machine

SECONDS = 240
"""Of CPU, for the invariants."""


def machine_of(folder: Path, tell: Callable[[str], None] = lambda text: None) -> Machine:
    """The machine of a folder of spec/. What it names and has not is NOT JUDGED."""
    wiring = folder / "wiring.toml"
    name = wiring.relative_to(folder.parents[1]).as_posix()
    text = wiring.read_text("utf-8")
    return Machine(text, name, folder / "safety.toml", folder / "use.toml", tell, leave_out=True)


def looked_at(folder: Path) -> list[str]:
    """What is wrong as far as it is seen at once: the reader refuses the file, or what should break does not.

    Raises Unjudged: the reader refuses a file.
    """
    machine = machine_of(folder)
    lost = {id: f"the wiring has no {name!r}" for id, name in machine.lacking.items()}
    return _said(lost | Killers(machine).problems(read_killers(folder / "killers.toml")))


def _said(problems: Mapping[str, str]) -> list[str]:
    return [f"{id}: {why}; modeproof machine --killers" for id, why in problems.items()]


def judged(folder: Path, tell: Callable[[str], None] = lambda text: None) -> dict[str, Any]:
    """The result of a piece of evidence: each verdict, judged by two solvers, and what the report shows.

    Raises Unjudged: the reader refuses a file.
    """
    began = time.process_time()
    machine = machine_of(folder, tell)
    killers = read_killers(folder / "killers.toml")
    problems = Killers(machine).problems(killers)
    hidden = {*problems, *machine.lacking}
    found = machine.all(SECONDS, recheck=True)
    table = machine.wiring.table
    boxes, wires = boxes_and_wires(machine.wiring)
    return {
        "basis": OWN,
        "title": table.title,
        "scan_ms": list(table.scan_ms),
        "cycle_ms": table.cycle_ms,
        "trusted": list(TRUST),
        "verdicts": [row | {"how": row["how"] * (row["verdict"] != "PROVED")} for row in verdict_rows(found)],
        "problems": _said(problems),
        "order": list(table.order),
        "picture": {"boxes": boxes, "wires": wires},
        "matrix": {"safeguards": list(table.safeguards), "rows": matrix_rows(machine.wiring)},
        "killers": [_killer(machine, killer) for killer in killers if killer.property not in hidden],
        "trial": _trial(machine, outcomes_path(folder.parents[1], folder.name)),
        "work": {"cpu_s": round(time.process_time() - began, 1)},
    }


def _killer(machine: Machine, killer: Killer) -> dict[str, Any]:
    of = Killers(machine)
    edit, scans = of.edits[name_of(killer)], of.scans(killer)
    edited = Machine(edit.after, machine.file, machine.properties, machine.use, leave_out=machine.leave_out)
    return {
        "property": killer.property,
        "kind": edit.kind,
        "row": killer.row,
        "text": killer.text,
        "was": _was(machine, killer.row),
        "scans": [
            {"dt_ms": dt_ms, "in": given, "out": gives}
            for dt_ms, given, gives in rows_of_trace(edited, scans)
        ],
    }


def _was(machine: Machine, row: str) -> str:
    """What is in a row; nothing for the order, of which the evidence has the whole."""
    value: Any = machine.table
    for key in row.split("."):
        value = value[key]
    text = value["is"] if isinstance(value, Mapping) else value
    return "" if row == "order" else text if isinstance(text, str) else json.dumps(text)


def _trial(machine: Machine, path: Path) -> dict[str, Any]:
    """What became of the edits of this very wiring, and how many of them break each property."""
    names = {edit.id for edit in edits(machine.text, machine.wiring)}
    rows = {name: row for name, row in read_outcomes(path, basis_of(machine)).items() if name in names}
    return {
        "edits": len(names),
        "judged": len(rows),
        "counts": dict(sorted(Counter(row["verdict"] for row in rows.values()).items())),
        "falls": {
            row["id"]: sum(row["id"] in one["by"] for one in rows.values()) for row in machine.every.rows
        },
        "left": list(_left(rows)),
    }


def _left(rows: Mapping[str, Mapping[str, Any]]) -> Iterator[dict[str, str]]:
    for name, row in rows.items():
        if row["verdict"] in ("SURVIVED", "HARMLESS"):
            yield {"edit": name, "kind": row["kind"], "verdict": row["verdict"], "why": ", ".join(row["by"])}
