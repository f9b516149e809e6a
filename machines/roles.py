"""Who plays the roles that a file of properties speaks of, and what a machine has not.

The file's table `roles` names the modes, and for each device the kind of its block and its other names. A
wiring that has other names says in its own table `roles` who plays which: `setup = "setting"`. A mode or an
error that a machine cannot have is FALSE; a question about what it has not is not asked.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import msgspec

from machines.composed_program import Watched
from machines.missing_names import EXPRESSIONS
from machines.wiring import Wiring
from modeproof.ground.errors import suggestion
from modeproof.registers.typed import Entry, Text, typed
from programs.language.tree import Binary, Expression, Literal, Place, Unary
from programs.properties.property_file import parsed

TABLE = "roles"
NAME = re.compile(r"[A-Za-z_]\w*(?:\s*\.\s*[A-Za-z_]\w*)?")
ERRORS = ("ERROR",)
"""Pins that say nothing but that a device has an error."""


class Device(Entry, frozen=True, kw_only=True):
    """The kind of its block, which has the name of the row, and its other names: signals to and from it."""

    of: Text
    names: list[Text]


class Roles(Entry, frozen=True, kw_only=True):
    """The table of a file of properties."""

    modes: list[Text]
    devices: dict[str, Device]


@dataclass(frozen=True)
class Cast:
    """The names of a file of properties, in capitals, as a wiring has them."""

    own: Mapping[str, str] = field(default_factory=dict)
    """Who plays a role, where the name is another one."""
    never: Mapping[str, str] = field(default_factory=dict)
    """What is FALSE in this machine, and why."""
    absent: Mapping[str, str] = field(default_factory=dict)
    """What is not there, and why."""

    def text(self, text: str) -> str:
        """A condition in the names of the wiring."""

        def name(found: re.Match[str]) -> str:
            whole = re.sub(r"\s", "", found[0])
            head, dot, pin = whole.partition(".")
            if whole.upper() in self.never:
                return "FALSE"
            return f"{self.own[head.upper()]}{dot}{pin}" if head.upper() in self.own else found[0]

        return NAME.sub(name, text)

    def row(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
        """A property in the names of the wiring."""
        return {**row, **{key: self.text(row[key]) for key in EXPRESSIONS if isinstance(row.get(key), str)}}

    def why_idle(self, row: Mapping[str, Any], place: Place) -> str:
        """Why a property is about nothing that this machine has; nothing if it is about something.

        row: as the file has it.
        """
        for key in ("never", "after", "holds"):
            if not isinstance(text := row.get(key), str):
                continue
            lost = [self.never[name] for name in map(_upper, NAME.findall(text)) if name in self.never]
            if lost and folded(parsed(self.text(text), place)) is False:
                return lost[0]
        return ""

    def why_absent(self, name: str) -> str:
        """Why the wiring has not got a name; nothing if it should have."""
        return self.absent.get(_upper(name).partition(".")[0], "")


def cast_of(tables: Mapping[str, Any], file: str, wiring: Wiring) -> Cast:
    """The cast of a wiring. Raises Unjudged: a table that is none, a role that is none, nobody plays it."""
    given = wiring.table.roles
    if TABLE not in tables:
        if given:
            raise wiring.refuse("roles", f"{file} names no roles")
        return Cast()
    roles = typed(Roles, tables[TABLE], f"{file}: {TABLE}")
    known = [*roles.modes, *roles.devices, *(name for row in roles.devices.values() for name in row.names)]
    table = wiring.table
    there = [*table.modes, *table.block, *table.inputs, *table.outputs, *wiring.texts]
    for name, player in given.items():
        if name not in known:
            raise wiring.refuse(f"roles.{name}", f"no role {name!r}; {suggestion(name, known)}")
        if player not in there:
            raise wiring.refuse(f"roles.{name}", f"nothing is {player!r}; {suggestion(player, there)}")
        if (name in roles.modes) != (player in table.modes):
            raise wiring.refuse(f"roles.{name}", f"{player!r} is {'no' if name in roles.modes else 'a'} mode")
    never: dict[str, str] = {}
    absent: dict[str, str] = {}
    for name, row in roles.devices.items():
        kinds = {_kind(block.of) for block in table.block.values()}
        if _kind(row.of) in kinds or given.get(name, name) in table.block:
            continue
        why = f"no {row.of}"
        never |= {f"{name.upper()}.{pin}": why for pin in ERRORS}
        absent |= dict.fromkeys([name.upper(), *map(_upper, row.names)], why)
    if not strangers(roles.modes, wiring):
        lost = [name for name in roles.modes if given.get(name, name) not in table.modes]
        never |= {name.upper(): f"no mode {name}" for name in lost}
    return Cast({name.upper(): player for name, player in given.items()}, never, absent)


def strangers(modes: list[str], wiring: Wiring) -> list[str]:
    """The modes of a wiring that play none of these roles."""
    players = {wiring.table.roles.get(name, name) for name in modes}
    return [name for name in wiring.table.modes if name not in players]


def folded(tree: Expression) -> bool | None:
    """The value of a condition whatever its names stand for; None: it depends on them."""
    match tree:
        case Literal(bool() as value, _, _):
            return value
        case Unary("NOT", operand, _):
            found = folded(operand)
            return None if found is None else not found
        case Binary("AND" | "OR" as operator, left, right, _):
            both, decides = (folded(left), folded(right)), operator == "OR"
            return decides if decides in both else None if None in both else not decides
    return None


def cast_observers(watched: Watched, cast: Cast) -> Watched:
    """The observers in the names of the wiring."""
    rows = {
        name: msgspec.structs.replace(
            seen, inputs={pin: cast.text(text) for pin, text in seen.inputs.items()}
        )
        for name, seen in watched.rows.items()
    }
    return Watched(watched.file, rows, watched.lines)


def _upper(name: str) -> str:
    return re.sub(r"\s", "", name).upper()


def _kind(of: str) -> str:
    return of.upper().replace("_", "")
