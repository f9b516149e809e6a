"""The record of a trial: what became of each edit, and what that rests on."""

from __future__ import annotations

import ast
import hashlib
import json
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from machines import composed_program as wired
from machines import concrete_runs as machine_runs
from machines import wiring as wiring_module
from machines.trial import Outcome
from machines.verdicts import Machine
from refimpl.machine_cell import cell as reference
from refimpl.machine_cell import expression, standard


def basis_of(machine: Machine) -> dict[str, str]:
    """What outcomes rest on, as hashes: what the files say, and the code of a scan and of the runs.

    Words about it do not count, nor does the search for a proof: z3 judges what it finds.
    """
    tables = {"wiring": machine.table, "properties": tomllib.loads(machine.questions.text)}
    tables["use"] = tomllib.loads(machine.use.read_text("utf-8"))
    said = {name: json.dumps(_without_words(table), sort_keys=True) for name, table in tables.items()}
    modules = [
        *reference.DEVICES.values(),
        reference,
        expression,
        standard,
        machine_runs,
        wired,
        wiring_module,
    ]
    trees = [ast.parse(Path(str(module.__file__)).read_text("utf-8")) for module in modules]
    for node in (node for tree in trees for node in ast.walk(tree)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            node.value.value = None  # a docstring
    said["code"] = "".join(map(ast.dump, trees))
    return {name: hashlib.sha256(text.encode()).hexdigest()[:16] for name, text in said.items()}


def _without_words(table: Any) -> Any:
    if isinstance(table, list):
        return [_without_words(part) for part in table]
    if not isinstance(table, dict):
        return table
    words = ("why", "title", "sentence", "hazard", "cites")
    return {key: _without_words(value) for key, value in table.items() if key not in words}


def as_toml(outcomes: Sequence[Outcome], count: int, basis: Mapping[str, str]) -> str:
    """The outcomes as data. count: of all edits that there are; basis: what they rest on."""
    lines = [
        "# The wiring on trial: what became of one edit of wiring.toml at a time.",
        "# Made by `modeproof machine --trial --record`. Our own design: no claim about a paper.",
        "# scans: of the shortest way from power-up that was found",
        f"# {len(outcomes)} of {count} edits were judged; of the others nothing is said.",
        "# basis: hashes of what the outcomes rest on; an outcome is taken over as long as they are the same",
        "",
        "[basis]",
        *(f"{name} = {json.dumps(value)}" for name, value in basis.items()),
        "",
    ]
    for outcome in outcomes:
        lines += [
            "[[edit]]",
            f"kind = {json.dumps(outcome.edit.kind)}",
            f"row = {json.dumps(outcome.edit.row)}",
            f"text = {json.dumps(outcome.edit.text)}",
            f"verdict = {json.dumps(outcome.word)}",
            f"by = {json.dumps(list(outcome.by))}",
            *([f"scans = {outcome.scans}"] if outcome.scans else []),
            "",
        ]
    return "\n".join(lines)


def read_record(text: str, basis: Mapping[str, str] | None = None) -> Mapping[str, Mapping[str, Any]]:
    """The recorded outcomes by the names of the edits; with a basis, those that still rest on it.

    Scans that break a property, a refusal and a proof do so however a cell is used. What runs did not reach
    is asked again when the file that guides them is another.
    """
    table = tomllib.loads(text)
    rows = {f"{row['row']} = {row['text']}": row for row in table.get("edit", [])}
    if basis is None or (known := table.get("basis", {})) == basis:
        return rows
    if {**known, "use": ""} != {**basis, "use": ""}:
        return {}
    lasting = ("HARMLESS", "REFUSED")
    return {id: row for id, row in rows.items() if row["verdict"] in lasting or "scans" in row}
