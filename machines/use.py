"""How a cell is used, read from TOML such as spec/machine_cell/use.toml: what runs with plain values follow.

A row that names no input of a wiring is left out there, so one file serves several wirings.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

from msgspec import Meta
from msgspec import field as field_of

from machines.wiring import Wiring
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.typed import Entry, SomeTexts, Text, rows_of, typed
from programs.language.tree import Place
from refimpl.machine_cell.expression import Value

Values = dict[str, bool | int]
MOST = 0xFFFF
"""Of a WORD."""


@dataclass(frozen=True)
class Use:
    """How a cell is used."""

    rest: Mapping[str, Value] = field(default_factory=dict)
    follows: Mapping[str, str] = field(default_factory=dict)
    pattern: Sequence[Mapping[str, Any]] = ()
    story: Sequence[Mapping[str, Any]] = ()
    """`then` names stories that like to follow, `first` marks those that like to begin a run."""
    file: str = ""
    lines: Mapping[str, int] = field(default_factory=dict)
    """The line of a row such as `rest.Start`, and of the head of `story.0`."""

    def place(self, row: str) -> Place:
        """Where a row is, or the table that it is in."""
        return Place(self.file, self.lines.get(row, self.lines.get(row.partition(".")[0], 1)))


class _File(Entry, frozen=True, kw_only=True):
    rest: Values = field_of(default_factory=dict)
    follows: dict[str, Text] = field_of(default_factory=dict)
    pattern: list[dict[str, Any]] = field_of(default_factory=list)
    story: list[dict[str, Any]] = field_of(default_factory=list)


class _Pattern(Entry, frozen=True, kw_only=True):
    inputs: SomeTexts
    rows: Annotated[list[list[bool | int]], Meta(min_length=1)]


class _Story(Entry, frozen=True, kw_only=True):
    id: Text
    row: Annotated[list[Values], Meta(min_length=1)]
    first: bool = False
    then: list[Text] = field_of(default_factory=list)


def read_use(path: Path) -> Use:
    """The file. Raises Unjudged with file, line and row or story: no TOML, a key or a value of another kind.

    Whether the values are those of a wiring is looked at by `check_use`.
    """
    try:
        text = path.read_text("utf-8")
        table = tomllib.loads(text)
    except OSError as error:
        raise Unjudged(f"{path}: cannot be read: {error.strerror or error}") from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Unjudged(f"{path}: says nothing about the use of a cell: {error}") from None
    use = Use(file=str(path), lines=dict(_lines(text)))
    try:
        typed(_File, table, "")
    except Unjudged as error:
        said = error.message.removeprefix(": ")
        raise use.place(re.split(r"[: \[]", said)[0]).refuse(said) from None
    use = Use(**table, file=use.file, lines=use.lines)
    _check_shape(use)
    return use


def _lines(text: str) -> Iterator[tuple[str, int]]:
    for number, row in rows_of(text):
        yield row, number
    for key in ("pattern", "story"):
        heads = enumerate(text.splitlines(), 1)
        found = [number for number, line in heads if re.match(rf"\s*\[\[\s*{key}\s*\]\]", line)]
        yield from ((f"{key}.{at}", number) for at, number in enumerate(found))


def _at(use: Use, row: str, name: str) -> str:
    place = use.place(row)
    return f"{place.file}:{place.line}: {name}"


def _check_shape(use: Use) -> None:
    """Refuse patterns and stories that are none, whatever the wiring is."""
    for at, row in enumerate(use.pattern):
        here = _at(use, f"pattern.{at}", f"[[pattern]] {at + 1}")
        typed(_Pattern, row, here)
        for values in row["rows"]:
            if len(values) != len(row["inputs"]):
                wanted = f"a row has a value for each of its {len(row['inputs'])} inputs, not {len(values)}"
                raise Unjudged(f"{here}: {wanted}")
    ids = [row.get("id") for row in use.story]
    for at, row in enumerate(use.story):
        here = _at(use, f"story.{at}", f"story {row.get('id', at + 1)!r}")
        typed(_Story, row, here)
        if row["id"] in ids[:at]:
            raise Unjudged(f"{here}: another story has this id")
        for number, values in enumerate(row["row"], 1):
            if type(scans := values.get("scans", 1)) is not int or scans < 1:
                raise Unjudged(f"{here}: row {number}: scans is a number, 1 or more, not {scans!r}")
    for at, row in enumerate(use.story):
        for name in row.get("then", ()):
            if name not in ids:
                said = suggestion(name, list(map(str, ids)))
                here = _at(use, f"story.{at}", f"story {row['id']!r}")
                raise Unjudged(f"{here}: then: no story {name!r}; {said}")


def check_use(use: Use, wiring: Wiring) -> None:
    """Refuse a value that an input of the wiring cannot have. Raises Unjudged with file, line and row."""
    for name, value in use.rest.items():
        _check_value(wiring, name, value, _at(use, f"rest.{name}", "rest"))
    for at, row in enumerate(use.pattern):
        for values in row["rows"]:
            for name, value in zip(row["inputs"], values, strict=True):
                _check_value(wiring, name, value, _at(use, f"pattern.{at}", f"[[pattern]] {at + 1}"))
    for at, row in enumerate(use.story):
        for number, values in enumerate(row["row"], 1):
            for name, value in values.items():
                here = _at(use, f"story.{at}", f"story {row['id']!r}: row {number}")
                _check_value(wiring, name, value, here)


def _check_value(wiring: Wiring, name: str, value: Value, here: str) -> None:
    found = wiring.table.inputs.get(name)
    if found is None:
        return
    if found.type == "BOOL" and type(value) is not bool:
        raise Unjudged(f"{here}: {name} is a BOOL, true or false, not {value!r}")
    if found.type == "WORD" and (type(value) is not int or not 0 <= value <= MOST):
        raise Unjudged(f"{here}: {name} is a WORD, 0 to {MOST}, not {value!r}")
