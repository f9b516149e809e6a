"""What is called: FUNCTIONs of a program's own, and the pins of blocks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from programs.language.standard_blocks import BLOCKS
from programs.language.tree import (
    Array,
    Bit,
    Body,
    Call,
    Case,
    Expression,
    For,
    Function,
    If,
    Index,
    Instance,
    Loop,
    Member,
    Name,
    Scalar,
    Source,
    Type,
    Unit,
    Variable,
    blocks_in,
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
        if isinstance(here, Call) and isinstance(here.instance, Name):
            yield here.instance.name.upper()
        if isinstance(here, tuple) or hasattr(here, "place"):
            seen.add(id(here))
            waiting += here if isinstance(here, tuple) else vars(here).values()


def names_in(expression: Any) -> Iterator[str]:
    """The variables in an expression, in upper case."""
    if isinstance(expression, Name):
        yield expression.name.upper()
    elif isinstance(expression, tuple):
        for part in expression:
            yield from names_in(part)
    elif hasattr(expression, "place"):
        yield from names_in(tuple(vars(expression).values()))


def paths_in(expression: Any) -> Iterator[tuple[str, ...]]:
    """What an expression reads or names: a variable with its members, up to the first index."""
    match expression:
        case Name(name, _):
            yield (name.upper(),)
        case Member(of, name, _):
            first, *others = paths_in(of)
            yield first if _indexed(of) else (*first, name.upper())
            yield from others
        case Index(of, index, _):
            yield from paths_in(of)
            yield from paths_in(index)
        case Bit(of, _, _):
            yield from paths_in(of)
        case tuple():
            for part in expression:
                yield from paths_in(part)
        case _ if hasattr(expression, "place"):
            yield from paths_in(tuple(vars(expression).values()))


def _indexed(target: Any) -> bool:
    while isinstance(target, Member):
        target = target.of
    return not isinstance(target, Name)


def check_function(unit: Unit) -> None:
    """Refuse a FUNCTION that remembers something, or whose pins are not single values."""
    for variable in unit.variables.values():
        if variable.section == "external" and not any(blocks_in(variable.type)):
            continue  # it belongs to the program
        if variable.section == "in_out" and not any(blocks_in(variable.type)):
            continue  # it is the caller's
        handed = variable.section in ("input", "output", "in_out")
        if not isinstance(variable.type, Scalar | Array) or variable.retained:
            raise variable.place.refuse(f"{variable.name}: a FUNCTION has plain variables here")
        if handed and not isinstance(variable.type, Scalar):
            raise variable.place.refuse(
                f"{variable.name}: inputs and outputs of a FUNCTION are single values"
            )


def function_of(source: Source, unit: Unit, call: Call) -> Unit | None:
    """The FUNCTION that a statement of this unit calls; None: it calls an instance."""
    if not isinstance(call.instance, Name) or call.instance.name.upper() in _instances(unit):
        return None
    found = source.units.get(call.instance.name.upper())
    return found if found is not None and found.kind == "function" else None


def _instances(unit: Unit) -> set[str]:
    return {key for key, variable in unit.variables.items() if not isinstance(variable.type, Scalar)}


Pairs = tuple[tuple[str, Expression], ...]


def handed(call: Call, ins: Sequence[str], outs: Sequence[str], by_name: str = "") -> tuple[Pairs, Pairs]:
    """The inputs and the outputs of a call with their names.

    Arguments without names are all the inputs, or all the inputs and then all the outputs, in the order in
    which they are declared. by_name: why the callee needs names.
    """
    if all(name for name, _ in call.inputs):
        return call.inputs, call.outputs
    values = [value for _, value in call.inputs]
    if by_name:
        raise call.place.refuse(f"arguments without names: {by_name}; give them names")
    if len(values) not in (len(ins), len(ins) + len(outs)):
        raise call.place.refuse(
            f"{len(values)} arguments without names; the inputs are {', '.join(ins)}; give all, or give names"
        )
    return tuple(zip(ins, values, strict=False)), tuple(zip(outs, values[len(ins) :], strict=False))


def handed_to_block(source: Source, kind: Instance, call: Call) -> tuple[Pairs, Pairs]:
    """`handed` for the block of an instance."""
    ins, outs = sides(source, kind)
    unit = source.units.get(kind.block.upper())
    why = ""
    if unit is not None and unit.device is not None:
        why = f"the order of the pins of {kind.block} is not laid down here"
    elif unit is not None and (in_outs(source, kind) or not _in_order(unit)):
        why = f"{kind.block} has VAR_IN_OUT, or outputs before inputs"
    return handed(call, list(ins), list(outs), why)


def handed_to_function(unit: Unit, call: Call) -> tuple[Pairs, Pairs]:
    """`handed` for a FUNCTION: every input and VAR_IN_OUT is given."""
    ins = [*unit.of("input"), *unit.of("in_out")]
    outs = [name for name in unit.of("output") if name.upper() != unit.name.upper()]
    doubtful = unit.of("in_out") or not _in_order(unit)
    why = f"{unit.name} has VAR_IN_OUT, or outputs before inputs" if doubtful else ""
    inputs, outputs = handed(call, ins, outs, why)
    given = [name.upper() for name, _ in inputs]
    if sorted(given) != sorted(name.upper() for name in ins):
        raise call.place.refuse(f"the arguments of {unit.name} are {', '.join(ins) or 'none'}")
    return inputs, outputs


def _in_order(unit: Unit) -> bool:
    """Whether all inputs are declared before all outputs."""
    sections = [variable.section for variable in unit.variables.values()]
    return "input" not in sections[sections.index("output") :] if "output" in sections else True


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
        case For(_, _, _, _, inner, _) | Loop(_, inner, _, _):
            yield inner
