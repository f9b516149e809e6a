"""How many statements a scan can come to, with all calls and all turns of loops in their place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from programs.language.calls import called_functions, function_of, inner_bodies
from programs.language.memory import elements
from programs.language.tree import (
    MOST_TURNS,
    Array,
    Assign,
    Body,
    Call,
    Case,
    Expression,
    For,
    If,
    Index,
    Instance,
    Literal,
    Loop,
    Member,
    Source,
    Statement,
    Type,
    Unit,
)
from programs.language.types import Types

MOST = 20_000
"""More would take hours to translate."""


def check_length(source: Source, unit: Unit) -> None:
    """Refuse a unit whose scan is too long. Raises Unjudged with file and line."""
    lengths = _Lengths(source)
    if (found := lengths.unit(unit)) > MOST:
        raise unit.place.refuse(
            f"{unit.name}: {found:,} statements in a scan, with calls and turns of loops; at most {MOST:,}"
        )
    if (found := lengths.instances(unit)) > MOST:
        raise unit.place.refuse(f"{unit.name}: {found:,} instances of blocks; at most {MOST:,}")


@dataclass
class _Lengths:
    """Lengths of units by their names, of statements by identity: the turns of a loop share theirs."""

    source: Source
    units: dict[str, int] = field(default_factory=dict)
    statements: dict[int, int] = field(default_factory=dict)
    below: dict[str, int] = field(default_factory=dict)

    def instances(self, unit: Unit) -> int:
        if unit.name not in self.below:
            kinds = [variable.type for variable in unit.variables.values()]
            blocks = [name.upper() for kind in kinds for name in _instances(kind)]
            own = [self.source.units[name] for name in blocks if name in self.source.units]
            self.below[unit.name] = len(blocks) + sum(map(self.instances, own))
        return self.below[unit.name]

    def unit(self, unit: Unit) -> int:
        if unit.name not in self.units:
            self.units[unit.name] = self.body(unit.body, Types(self.source, unit))
        return self.units[unit.name]

    def body(self, body: Body, types: Types) -> int:
        return sum(self.statement(statement, types) for statement in body)

    def statement(self, statement: Statement, types: Types) -> int:
        key = id(statement)
        if key in self.statements:
            return self.statements[key]
        inner = sum(self.body(body, types) for body in inner_bodies(statement))
        expressions: Any = ()
        match statement:
            case If(branches, _, _):
                expressions = tuple(asked for asked, _ in branches)
            case Case(subject, _, _, _):
                expressions = subject
            case Assign(target, value, _):
                expressions = (target, value)
            case Call():
                expressions = statement.inputs
                own = function_of(self.source, types.unit, statement)
                if own is None and isinstance(kind := types.of(statement.instance), Instance):
                    own = self.source.units.get(kind.block.upper())
                inner += 0 if own is None else self.unit(own) * _choices(statement.instance, types)
            case Loop(going, _, _, _):
                expressions = going
                inner = (MOST_TURNS + 1) * (inner + 1)
            case For(_, start, end, step, _, _):
                by = 1 if step is None else types.constant(step)
                turns = abs(types.constant(end) - types.constant(start)) // max(1, abs(by)) + 1
                inner = turns * (inner + 1)
        functions = [self.source.units.get(name) for name in called_functions(expressions)]
        found = 1 + inner + sum(self.unit(one) for one in functions if one is not None)
        self.statements[key] = found
        return found


def _instances(kind: Type) -> Iterator[str]:
    """The block of each instance in a variable."""
    return (one.block for _, one, _ in elements(kind, "", None) if isinstance(one, Instance))


def _choices(instance: Expression, types: Types) -> int:
    """How many instances a call may be of: all elements that an index may choose."""
    found = 1
    while isinstance(instance, Member | Index):
        if isinstance(instance, Index) and not isinstance(instance.index, Literal):
            array = types.of(instance.of)
            found *= array.high - array.low + 1 if isinstance(array, Array) else 1
        instance = instance.of
    return found
