"""What is called: FUNCTIONs of a program's own, and the pins of blocks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from programs.standard import BLOCKS
from programs.tree import (
    Array,
    Body,
    Case,
    Expression,
    For,
    Function,
    If,
    Instance,
    Scalar,
    Source,
    Type,
    Unit,
    Variable,
)


def own_arguments(node: Function, unit: Unit) -> dict[str, Expression]:
    """The arguments of a FUNCTION by its inputs in upper case, all of them."""
    names = [name.upper() for name in unit.of("input")]
    given = dict(node.arguments)
    if node.arguments and all(not name for name, _ in node.arguments):
        given = dict(zip(names, (value for _, value in node.arguments), strict=False))
    if set(given) != set(names) or len(node.arguments) != len(names):
        raise node.place.refuse(f"the arguments of {unit.name} are {', '.join(unit.of('input')) or 'none'}")
    return given


def called_functions(part: Any) -> Iterator[str]:
    """The names of all functions that are called in a part of a program, once for each place."""
    waiting, seen = [part], set()
    while waiting:
        here = waiting.pop()
        if id(here) in seen:
            continue
        if isinstance(here, Function):
            yield here.name
        if isinstance(here, tuple) or hasattr(here, "place"):
            seen.add(id(here))  # the turns of a loop share their statements
            waiting += here if isinstance(here, tuple) else vars(here).values()


def check_function(unit: Unit) -> None:
    """Refuse a FUNCTION that is more than a value of its inputs."""
    for variable in unit.variables.values():
        result = variable.section == "output" and variable.name.upper() == unit.name.upper()
        plain = variable.section in ("input", "var", "temp", "constant")
        if not isinstance(variable.type, Scalar | Array) or not (plain or result):
            raise variable.place.refuse(f"{variable.name}: a FUNCTION has inputs and plain variables here")
        if (variable.section == "input" or result) and not isinstance(variable.type, Scalar):
            raise variable.place.refuse(f"{variable.name}: inputs and result of a FUNCTION are single values")


def in_outs(source: Source, kind: Type) -> dict[str, Variable]:
    """The VAR_IN_OUT of a block, in upper case."""
    unit = source.units.get(kind.block.upper()) if isinstance(kind, Instance) else None
    return {} if unit is None else {name.upper(): found for name, found in unit.of("in_out").items()}


def sides(source: Source, kind: Instance) -> tuple[Mapping[str, Type], Mapping[str, Type]]:
    """Inputs and outputs of a block with their types."""
    if kind.block.upper() in BLOCKS:
        return BLOCKS[kind.block.upper()]
    unit = source.units[kind.block.upper()]
    ins, outs = (
        {name: variable.type for name, variable in unit.of(*sections).items()}
        for sections in (("input", "in_out"), ("output",))
    )
    return ins, outs


def inner_bodies(statement: object) -> Iterator[Body]:
    """The bodies within a statement."""
    match statement:
        case If(branches, otherwise, _):
            yield from (inner for _, inner in branches)
            yield otherwise
        case Case(_, clauses, otherwise, _):
            yield from (inner for _, inner in clauses)
            yield otherwise
        case For(_, _, _, _, inner, _):
            yield inner
