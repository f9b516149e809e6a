"""A wiring with the properties that are asked of it: which they are, in the names of the wiring."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from machines.composed_program import Observer, Watched, looked, spelled
from machines.coverage import TABLE
from machines.missing_names import EXPRESSIONS, lacking, observers_lacking
from machines.roles import TABLE as ROLES
from machines.roles import Cast, cast_observers, cast_of
from machines.wiring import Wiring, wiring_of
from modeproof.ground.errors import Unjudged
from modeproof.registers.typed import rows_of, typed
from programs.properties.property_file import Beside, Questions, read_questions

BESIDE = {"hazard": str, "cites": list}
"""What a property of a machine has besides."""


@dataclass
class Asking:
    """A wiring, the file of properties, and the file that says how it is used."""

    text: str
    file: str
    properties: Path
    use: Path
    leave_out: bool = field(default=False, kw_only=True)
    """A property that names what the wiring has not is NOT JUDGED or not asked; else the file is refused."""

    @cached_property
    def wiring(self) -> Wiring:
        """The wiring, looked through. Raises Unjudged."""
        return wiring_of(self.text, self.file)

    @cached_property
    def table(self) -> Mapping[str, Any]:
        """The same as plain tables."""
        return tomllib.loads(self.text)

    @cached_property
    def every(self) -> Questions:
        """The file of properties. Raises Unjudged."""
        return read_questions(
            self.properties, Beside(BESIDE, ("observer", TABLE, ROLES), self.wiring.table.scan_ms)
        )

    @cached_property
    def cast(self) -> Cast:
        """Who plays the roles of the properties. Raises Unjudged."""
        return cast_of(self.every.tables, self.every.file, self.wiring)

    @cached_property
    def played(self) -> Questions:
        """The properties in the names of the wiring, with those about what it has not."""
        return replace(self.every, rows=tuple(map(self.cast.row, self.every.rows)))

    @cached_property
    def lost(self) -> Mapping[str, str]:
        """By property the name that the wiring has not. Raises Unjudged."""
        return lacking(self.wiring, self.observers, self.played) if self.leave_out else {}

    @cached_property
    def not_asked(self) -> Mapping[str, str]:
        """By property about what this machine has not: what that is. Raises Unjudged."""
        idle = {row["id"]: self.cast.why_idle(row, self.every.place(row)) for row in self.every.rows}
        idle = {id: why for id, why in idle.items() if why}
        return idle | {id: why for id, name in self.lost.items() if (why := self.cast.why_absent(name))}

    @cached_property
    def lacking(self) -> Mapping[str, str]:
        """By property that is not judged the name that the wiring should have. Raises Unjudged."""
        return {id: name for id, name in self.lost.items() if id not in self.not_asked}

    @cached_property
    def questions(self) -> Questions:
        """The properties that are judged, in the spelling of the wiring. Raises Unjudged."""
        left = [row for row in self.played.rows if row["id"] not in {*self.lacking, *self.not_asked}]
        rows = tuple(map(self.spelled, left))
        return replace(self.every, rows=rows)

    def spelled(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
        """A property in the spelling of the wiring. Raises Unjudged: what no property of a machine has."""
        if self.every.file != str(self.properties):
            return row  # a question that was made, not read
        place = self.every.place(row)
        texts = {
            key: spelled(self.wiring, self.watched, row[key], place, f"{row['id']}: {key}")
            for key in EXPRESSIONS
            if key in row
        }
        return {**row, **texts}

    @cached_property
    def observers(self) -> Watched:
        """The observers of the file. Raises Unjudged."""
        lines = {row: number for number, row in rows_of(self.every.text)}
        rows = self.every.tables.get("observer", {})
        if not isinstance(rows, dict):
            raise Unjudged(f"{self.properties}: [observer] is a table")
        made = Watched(str(self.properties), {}, lines)
        told = {name: f"{made.file}:{made.place(name).line}: observer.{name}" for name in rows}
        made = replace(made, rows={name: typed(Observer, row, told[name]) for name, row in rows.items()})
        return cast_observers(made, self.cast)

    @cached_property
    def watched(self) -> Watched:
        """Those that the cell can have, in the spelling of the wiring. Raises Unjudged."""
        lost = observers_lacking(self.wiring, self.observers) if self.leave_out else {}
        rows = {name: row for name, row in self.observers.rows.items() if name not in lost}
        return looked(self.wiring, replace(self.observers, rows=rows))
