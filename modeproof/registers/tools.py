"""The register of the tools: what is known to be unsound in them, and why this use is not affected."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.files import read_toml
from modeproof.registers.schema import check_schema

SOURCE = "docs/tools.toml"


@dataclass(frozen=True)
class Check:
    """The check of one engine by another. `kind` is the kind of evidence of the comparison."""

    engine: str
    by: str
    kind: str


@dataclass(frozen=True)
class Condition:
    """What a machine checks of a judgement. `name` and `value` as the register has them; `of`: kinds of run,
    all where there are none.
    """

    name: str
    value: Any
    of: tuple[str, ...] = ()


@dataclass(frozen=True)
class ToolProblem:
    """One known problem of a tool, and its judgement (not reached, covered, only refuses)."""

    id: str
    tool: str
    title: str
    reference: str
    what: str
    affects: str
    judgement: str
    because: str
    also: tuple[str, ...] = ()
    holds: tuple[Condition, ...] = field(default=())


@dataclass(frozen=True)
class Tools:
    """The whole register."""

    checks: tuple[Check, ...]
    problems: tuple[ToolProblem, ...]


def load_tools(root: Path) -> Tools:
    """Read the register. Raises Unjudged with one line when it is missing or wrong."""
    data = read_toml(root, root / SOURCE)
    check_schema("tools", SOURCE, data)
    problems = tuple(_problem(row) for row in data["problem"])
    ids = [problem.id for problem in problems]
    for id in ids:
        if ids.count(id) > 1:
            raise Unjudged(f"{SOURCE}: problem {id} is declared twice")
    return Tools(tuple(Check(**row) for row in data["check"]), problems)


def _problem(row: Mapping[str, Any]) -> ToolProblem:
    return ToolProblem(
        **{key: value for key, value in row.items() if key not in ("also", "holds")},
        also=tuple(row.get("also", ())),
        holds=tuple(_condition(row["id"], condition) for condition in row.get("holds", ())),
    )


def _condition(id: str, table: Mapping[str, Any]) -> Condition:
    names = [key for key in table if key != "of"]
    if len(names) != 1:
        raise Unjudged(f"{SOURCE}: problem {id}: a condition under `holds` has exactly one key besides `of`")
    return Condition(names[0], table[names[0]], tuple(table.get("of", ())))
