"""Properties of a program of one's own, read from TOML.

    scan_time_ms = [1, 50]               # the shortest and the longest scan

    [[property]]
    id = "one-mode"
    sentence = "The two modes are never on together."
    never = "S_SetupMode AND S_AutomaticMode"

`never` and `always` are expressions in Structured Text over inputs, outputs, variables and pins of instances,
looked at after every scan. `holds` with `only_if`: where the first is true, so is the second. `after`,
`within_ms`, `holds`: the last is true after a scan at most so many ms after each scan with the first.
`after`, `holds`, `only_once`: after a scan with the first, the second waits for a scan with the third.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.files import read_own_toml
from programs.language.calls import called_functions
from programs.language.shared_memory import asked
from programs.language.subset import check_below
from programs.language.tree import (
    BOOL,
    Assign,
    Binary,
    Bit,
    Expression,
    Index,
    Member,
    Name,
    Place,
    Source,
    Unary,
    Unit,
)
from programs.language.types import Types
from programs.properties.transition_system import Asked, Cell
from programs.readers.structured_text.units import read_text

FORMS = (
    {"never"},
    {"always"},
    {"holds", "only_if"},
    {"after", "within_ms", "holds"},
    {"after", "holds", "only_once"},
)
TYPES = "types"
"""The id of what is asked of every program: that it stays within its types."""


@dataclass(frozen=True)
class Questions:
    """What the file asks, and the range of scan times in ms (None: no limit)."""

    scan_time: tuple[int, int | None]
    rows: tuple[Mapping[str, Any], ...]
    file: str
    text: str
    tables: Mapping[str, Any] = field(default_factory=dict)
    """What else the file may have, as it is there."""

    def asked(self, cell: Cell) -> list[Asked]:
        """The properties over this program. Raises Unjudged with file, line and cause."""
        return [_asked(row, cell, self.place(row)) for row in self.rows]

    def times(self, source: Source, unit: Unit) -> tuple[int, int | None]:
        """The range of scan times: that of the file, else the interval of the program's task."""
        interval = None if "scan_time_ms" in self.tables else interval_of(source, unit)
        return self.scan_time if interval is None else (interval, interval)

    def place(self, row: Mapping[str, Any]) -> Place:
        """Where a property is."""
        wanted = re.compile(rf"\s*id\s*=\s*[\"']{re.escape(row['id'])}[\"']")
        lines = enumerate(self.text.splitlines(), 1)
        found = [number for number, line in lines if wanted.match(line)]
        return Place(self.file, found[0] if found else 1)


def interval_of(source: Source, unit: Unit) -> int | None:
    """The ms between two scans of a program, if the source says it once."""
    tasks = [task for task in source.tasks if unit.name.upper() in map(str.upper, task.programs)]
    found = {task.interval_ms for task in tasks}
    return next(iter(found)) if len(found) == 1 else None


@dataclass(frozen=True)
class Beside:
    """What a file of properties has besides: keys of a property, tables, scan times that are elsewhere."""

    keys: Mapping[str, type] = field(default_factory=dict)
    tables: tuple[str, ...] = ()
    scan_ms: tuple[int, int] | None = None


def read_questions(path: Path, beside: Beside | None = None) -> Questions:
    """The properties of a TOML file. Raises Unjudged with file, line and cause."""
    beside = beside or Beside()
    text, table = read_own_toml(path)
    allowed = ["property", *beside.tables, *(["scan_time_ms"] if beside.scan_ms is None else [])]
    for key in table:
        if key not in allowed:
            raise Unjudged(f"{path}: unknown key {key!r}; {suggestion(key, allowed)}")
    rows = table.get("property", [])
    if not isinstance(rows, list) or not rows or not all(isinstance(row, dict) for row in rows):
        raise Unjudged(f"{path}: no [[property]] in it")
    seen: set[str] = {TYPES}
    for row in rows:
        _check_row(row, path, seen, beside.keys)
    times = table.get("scan_time_ms", [0]) if beside.scan_ms is None else list(beside.scan_ms)
    if (
        not isinstance(times, list)
        or len(times) not in (1, 2)
        or not all(type(number) is int and number >= 0 for number in times)
        or times != sorted(times)
        or times[1:] == [0]  # time would stand still
    ):
        raise Unjudged(f"{path}: scan_time_ms = [shortest, longest] in whole ms, the longest above 0")
    if len(times) == 1 and any("within_ms" in row for row in rows):
        raise Unjudged(f"{path}: a property with within_ms needs scan_time_ms = [shortest, longest]")
    return Questions((times[0], times[1] if len(times) == 2 else None), tuple(rows), str(path), text, table)


def _check_row(row: Mapping[str, Any], path: Path, seen: set[str], beside: Mapping[str, type]) -> None:
    name = row.get("id")
    if not isinstance(name, str) or not name:
        raise Unjudged(f"{path}: each [[property]] has an id")
    if name in seen:
        raise Unjudged(f"{path}: two properties have the id {name!r}; {TYPES!r} is ours")
    seen.add(name)
    for key, kind in beside.items():
        if not isinstance(row.get(key), kind) or (kind is str and not row[key]):
            raise Unjudged(
                f"{path}: {name}: {key} is missing, or no {'text' if kind is str else kind.__name__}"
            )
    known = {"id", "sentence"}.union(*FORMS)
    for key, value in row.items():
        if key in beside:
            continue
        if key not in known:
            raise Unjudged(f"{path}: {name}: unknown key {key!r}; {suggestion(key, sorted(known))}")
        if type(value) is not (int if key == "within_ms" else str):
            raise Unjudged(f"{path}: {name}: {key} is {'a number' if key == 'within_ms' else 'a text'}")
        if isinstance(value, str) and any(not (one.isprintable() or one in "\n\t") for one in value):
            raise Unjudged(f"{path}: {key} {value!r}: a character that cannot be printed")
    if not name.isprintable():
        raise Unjudged(f"{path}: id {name!r}: one line is needed")
    if not row.get("sentence", "").strip():
        raise Unjudged(f'{path}: {name}: say it in a sentence as well: sentence = "..."')
    if {*row} - {"id", "sentence", *beside} not in FORMS:
        raise Unjudged(
            f"{path}: {name}: a property is `never`, `always`, `holds` with `only_if`, or `after` with "
            "`holds` and `within_ms` or `only_once`"
        )
    if row.get("within_ms", 0) < 0:
        raise Unjudged(f"{path}: {name}: within_ms is 0 or more")


def words_of(row: Mapping[str, Any]) -> str:
    """A property as one text in one line."""
    row = {key: " ".join(value.split()) if isinstance(value, str) else value for key, value in row.items()}
    for key in ("never", "always"):
        if key in row:
            return f"{key} {row[key]}"
    if "only_if" in row:
        return f"{row['holds']} only if {row['only_if']}"
    if "only_once" in row:
        return f"after {row['after']} {row['holds']} only once {row['only_once']}"
    return f"after {row['after']} within {row['within_ms']} ms {row['holds']}"


def _asked(row: Mapping[str, Any], cell: Cell, place: Place) -> Asked:
    def read(key: str) -> tuple[str, Expression]:
        return " ".join(row[key].split()), expression(row[key], cell, place)

    head = row["id"], " ".join(row["sentence"].split()), words_of(row)
    if "never" in row:
        _, found = read("never")
        parts = _both(found)
        trigger = [(shown(part), part) for part in parts] if len(parts) > 1 else []
        return Asked(*head, Unary("NOT", found, place), tuple(trigger))
    if "always" in row:
        return Asked(*head, read("always")[1])
    what, holds = read("holds")
    if "only_if" in row:
        implied = Binary("OR", Unary("NOT", holds, place), read("only_if")[1], place)
        return Asked(*head, implied, ((what, holds),))
    text, after = read("after")
    if "only_once" in row:
        end, once = read("only_once")
        waits = Binary("AND", after, Unary("NOT", once, place), place)
        return Asked(*head, holds, ((f"({text}) AND NOT ({end})", waits), (what, holds)), once=once)
    return Asked(*head, holds, ((text, after),), row["within_ms"])


def expression(text: str, cell: Cell, place: Place) -> Expression:
    """An expression of type BOOL over the program's values. Raises Unjudged with file, line and cause."""
    found: Expression = asked(parsed(text, place), cell.unit)
    for name in called_functions(found):
        if (unit := cell.source.find(name)) is not None:
            check_below(cell.source, unit)
    types = Types(cell.source, cell.unit)
    types.scalar(found, place, ("bool",), BOOL)
    for name in _names(found):
        variable = cell.unit.variables.get(name.upper())
        if variable is not None and variable.section == "temp":
            raise place.refuse(f"{name} is VAR_TEMP: it has no value after a scan")
    cell.holds(found)
    return found


def parsed(text: str, place: Place) -> Expression:
    """An expression in Structured Text; every part of it is at `place`. Raises Unjudged there."""
    try:
        units = read_text(
            f"FUNCTION_BLOCK q VAR_OUTPUT q : BOOL; END_VAR q := {text}\n; END_FUNCTION_BLOCK", place.file
        )
    except Unjudged as error:
        cause = error.message.partition(": ")[2]
        raise place.refuse(f"{text!r}: {cause}") from None
    statements = units[0].body
    if len(units) != 1 or len(statements) != 1 or not isinstance(statements[0], Assign):
        raise place.refuse(f"{text!r}: one expression is needed")
    found: Expression = _moved(statements[0].value, place)
    return found


def _moved(node: Any, place: Place) -> Any:
    """The expression with this place in all its parts."""
    if isinstance(node, tuple):
        return tuple(_moved(part, place) for part in node)
    if not hasattr(node, "place"):
        return node
    return type(node)(**{name: _moved(part, place) for name, part in vars(node).items()} | {"place": place})


def _names(node: Any) -> Iterator[str]:
    if isinstance(node, tuple):
        for part in node:
            yield from _names(part)
    elif isinstance(node, Name):
        yield node.name
    elif hasattr(node, "place"):
        for part in vars(node).values():
            yield from _names(part)


def _both(node: Expression) -> list[Expression]:
    if isinstance(node, Binary) and node.operator == "AND":
        return [*_both(node.left), *_both(node.right)]
    return [node]


def shown(node: Expression) -> str:
    """An expression in words again."""
    match node:
        case Name(name, _):
            return name
        case Member(of, name, _):
            return f"{shown(of)}.{name}"
        case Bit(of, number, _):
            return f"{shown(of)}.{number}"
        case Index(of, index, _):
            return f"{shown(of)}[{shown(index)}]"
        case Unary(operator, operand, _):
            return f"{operator} {shown(operand)}"
        case Binary(operator, left, right, _):
            return f"({shown(left)} {operator} {shown(right)})"
    value = getattr(node, "value", None)
    return str(value).upper() if value is not None else f"{getattr(node, 'name', '?')}(...)"
