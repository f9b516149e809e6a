"""The outcomes of a trial: what became of each edit, and what that rests on."""

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
from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build
from refimpl.machine_cell import cell as reference
from refimpl.machine_cell import expression, standard

LASTING = ("HARMLESS", "REFUSED")
"""Verdicts that do not rest on how the cell is used."""


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


def outcomes_path(root: Path, name: str) -> Path:
    """Where the outcomes of a machine of the project lie: with the other results, not in git."""
    return build(root) / "machine" / name / "trial.json"


def as_json(outcomes: Sequence[Outcome], basis: Mapping[str, str]) -> str:
    """The outcomes, and what they rest on."""
    rows = [
        {
            "kind": outcome.edit.kind,
            "row": outcome.edit.row,
            "text": outcome.edit.text,
            "verdict": outcome.word,
            "by": list(outcome.by),
            "scans": outcome.scans,
        }
        for outcome in outcomes
    ]
    return json.dumps({"basis": dict(basis), "edits": rows}, indent=1) + "\n"


def read_outcomes(path: Path, basis: Mapping[str, str]) -> Mapping[str, Mapping[str, Any]]:
    """The outcomes that still rest on what there is now, by the names of the edits; none without a file.

    Scans that break a property, a refusal and a proof do so however a cell is used. What runs did not reach
    is asked again when the file that guides them is another. Raises Unjudged for a file that is damaged.
    """
    if not path.exists():
        return {}
    try:
        table = json.loads(path.read_text("utf-8"))
        known, rows = table["basis"], {f"{row['row']} = {row['text']}": row for row in table["edits"]}
        lasting = {id: row for id, row in rows.items() if row["verdict"] in LASTING or row["scans"]}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Unjudged(
            f"{path}: not an outcome of `modeproof machine --trial`: {error!r}; delete it"
        ) from None
    if known == basis:
        return rows
    return lasting if {**known, "use": ""} == {**basis, "use": ""} else {}
