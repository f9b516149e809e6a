"""The program that a wiring describes: as a unit that can be judged, and as Structured Text to read.

A wire is always true to its sources, so an assignment is written before each call that needs a signal whose
sources have changed since it was written last, and after the last call for all that are left.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from modeproof.registers.typed import Entry, Text
from programs.cell import Cell
from programs.questions import parsed, shown
from programs.standard import BLOCKS
from programs.tree import (
    BOOL,
    SCALARS,
    TIME,
    Assign,
    Body,
    Call,
    Expression,
    Instance,
    Literal,
    Name,
    Place,
    Scalar,
    Source,
    Statement,
    Unit,
    Variable,
)
from programs.wiring import Wiring, names


class Observer(Entry, frozen=True, kw_only=True):
    """A standard block that a property needs; it reads the cell after each scan and feeds nothing in it."""

    of: Text
    inputs: dict[str, Text]


@dataclass(frozen=True)
class Watched:
    """Observers, and the file that they stand in."""

    file: str
    rows: Mapping[str, Observer]
    lines: Mapping[str, int]

    def place(self, name: str) -> Place:
        """Where an observer stands."""
        return Place(self.file, self.lines.get(f"observer.{name}", 1))


NONE = Watched("", {}, {})


def cell_of(wiring: Wiring, watched: Watched = NONE) -> Cell:
    """The machine as a program with these observers. Raises Unjudged."""
    made = unit(wiring, watched)
    source = Source({made.name.upper(): made}, {})
    return Cell.of(source, made, wiring.table.scan_ms)


def unit(wiring: Wiring, watched: Watched = NONE) -> Unit:
    """The program."""
    table, variables = wiring.table, dict[str, Variable]()

    def declare(name: str, kind: Scalar | Instance, section: str, place: Place) -> None:
        variables[name.upper()] = Variable(name, kind, section, None, place)

    for name, row in table.inputs.items():
        declare(name, SCALARS[row.type], "input", wiring.place(f"inputs.{name}"))
    for name, tree in wiring.shown.items():
        declare(name, wiring.type_of(tree), "output", wiring.place(f"outputs.{name}"))
    for name in wiring.signals:
        declare(name, BOOL, "var", wiring.place(f"signals.{name}"))
    for name in table.order:
        declare(name, Instance(table.block[name].of), "var", wiring.place(f"block.{name}"))
    for name, seen in watched.rows.items():
        if name.upper() in variables:
            raise watched.place(name).refuse(f"observer.{name}: the cell has a signal of this name")
        if seen.of.upper() not in BLOCKS or {*seen.inputs} != {*BLOCKS[seen.of.upper()][0]} - {"PT"}:
            raise watched.place(name).refuse(f"observer.{name}: R_TRIG, F_TRIG, SR or RS with all its inputs")
        declare(name, Instance(seen.of), "var", watched.place(name))
    statements = (*_scan(wiring), *observed(watched))
    return Unit("Machine", "program", variables, statements, Place(wiring.file, 1))


def _scan(wiring: Wiring) -> Iterator[Statement]:
    reads = {name: set(names(tree)) for name, tree in wiring.signals.items()}
    fresh: set[str] = set()
    for name in wiring.table.order:
        wanted = {part for tree in wiring.sources[name].values() for part in names(tree)}
        for other in reversed(reads):
            if other in wanted:
                wanted |= reads[other]
        yield from _assigned(wiring, [other for other in reads if other in wanted - fresh])
        fresh |= wanted & set(reads)
        yield _call(wiring, name)
        stale = {name}
        for other, sources in reads.items():
            if sources & stale:
                stale.add(other)
        fresh -= stale
    yield from _assigned(wiring, [other for other in reads if other not in fresh])
    for name, tree in wiring.shown.items():
        place = wiring.place(f"outputs.{name}")
        yield Assign(Name(name, place), tree, place)


def _assigned(wiring: Wiring, wanted: Sequence[str]) -> Iterator[Statement]:
    for name in wanted:
        tree = wiring.signals[name]
        yield Assign(Name(name, tree.place), tree, tree.place)


def _call(wiring: Wiring, name: str) -> Call:
    place = wiring.place(f"block.{name}")
    inputs: list[tuple[str, Expression]] = list(wiring.sources[name].items())
    for pin, value in wiring.table.block[name].parameters.items():
        kind = wiring.kinds[name].parameters[pin]
        number = kind.names.index(str(value)) if kind.kind == "enum" else value
        assert not isinstance(number, str)
        inputs.append((pin, Literal(number, kind, wiring.place(f"block.{name}.parameters.{pin}"))))
    return Call(Name(name, place), tuple(inputs), (), place)


def observed(watched: Watched) -> Iterator[Statement]:
    for name, seen in watched.rows.items():
        place = watched.place(name)
        pins = tuple((pin, parsed(text, place)) for pin, text in seen.inputs.items())
        yield Call(Name(name, place), pins, (), place)


# ---------------------------------------------------------------- as text


def text_of(made: Unit, comment: str = "") -> str:
    """The program as Structured Text; `prove-program` can read it again."""
    lines = [f"(* {comment} *)"] if comment else []
    for name, listed in _enumerations(made.body).items():
        lines.append(f"TYPE {name} : ({', '.join(listed.names)}); END_TYPE")
    lines.append(f"PROGRAM {made.name}")
    for section, word in (("input", "VAR_INPUT"), ("output", "VAR_OUTPUT"), ("var", "VAR")):
        lines.append(word)
        for name, variable in made.of(section).items():
            kind = variable.type
            shown_kind = kind.block if isinstance(kind, Instance) else getattr(kind, "name", "?")
            lines.append(f"    {name} : {shown_kind};")
        lines.append("END_VAR")
    for statement in made.body:
        if isinstance(statement, Assign):
            lines.append(f"{shown(statement.target)} := {shown(statement.value)};")
        elif isinstance(statement, Call):
            pins = ", ".join(f"{pin} := {_value(value)}" for pin, value in statement.inputs)
            lines.append(f"{shown(statement.instance)}({pins});")
    return "\n".join([*lines, "END_PROGRAM", ""])


def _value(value: Expression) -> str:
    if isinstance(value, Literal) and value.type is TIME:
        return f"T#{value.value}ms"
    if isinstance(value, Literal) and value.type is not None and value.type.kind == "enum":
        return value.type.names[int(value.value)]
    return shown(value)


def _enumerations(body: Body) -> dict[str, Scalar]:
    found = {}
    for statement in body:
        for _, value in statement.inputs if isinstance(statement, Call) else ():
            if isinstance(value, Literal) and value.type is not None and value.type.kind == "enum":
                found[value.type.name] = value.type
    return found
