"""The program that a wiring describes: as a unit that can be judged, and as Structured Text to read.

A wire is always true to its sources, so an assignment is written before each call that needs a signal whose
sources have changed since it was written last, and after the last call for all that are left.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import msgspec

from machines.signal_names import leaves, names
from machines.wiring import Wiring, is_plain, unfit
from modeproof.ground.errors import suggestion
from modeproof.registers.typed import Entry, Text
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import (
    BOOL,
    SCALARS,
    TIME,
    Assign,
    Binary,
    Body,
    Call,
    Expression,
    Function,
    Instance,
    Literal,
    Member,
    Name,
    Place,
    Scalar,
    Source,
    Statement,
    Unary,
    Unit,
    Variable,
)
from programs.properties.property_file import parsed, shown
from programs.properties.transition_system import Cell

OBSERVERS = ("R_TRIG", "F_TRIG", "SR", "RS")
"""What an observer may be."""


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
        """Where an observer is."""
        return Place(self.file, self.lines.get(f"observer.{name}", 1))


NONE = Watched("", {}, {})


def cell_of(wiring: Wiring, watched: Watched = NONE) -> Cell:
    """The machine as a program with these observers. Raises Unjudged."""
    made = unit(wiring, watched)
    source = Source({**wiring.source.units, made.name.upper(): made}, wiring.source.files)
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
        declare(name, Instance(wiring.block_name(name)), "var", wiring.place(f"block.{name}"))
    for name, seen in watched.rows.items():
        if name.upper() in variables:
            raise watched.place(name).refuse(f"observer.{name}: the cell has a signal of this name")
        _check_observer(watched, name)
        declare(name, Instance(seen.of), "var", watched.place(name))
    statements = (*_scan(wiring), *observed(watched))
    return Unit("Machine", "program", variables, statements, Place(wiring.file, 1))


def _check_observer(watched: Watched, name: str) -> None:
    """Refuse a name that no signal may have, another block, a pin too many or too few. Raises Unjudged."""
    place, seen = watched.place(name), watched.rows[name]
    if cause := unfit(name):
        raise place.refuse(f"observer.{name}: {cause}")
    if seen.of.upper() not in OBSERVERS or {*seen.inputs} != {*BLOCKS[seen.of.upper()][0]}:
        raise place.refuse(f"observer.{name}: R_TRIG, F_TRIG, SR or RS with all its inputs")


def looked(wiring: Wiring, watched: Watched) -> Watched:
    """The observers with the names as the wiring spells them. Raises Unjudged: file, line, what is wrong."""
    rows = {}
    for name, seen in watched.rows.items():
        _check_observer(watched, name)
        texts = {
            pin: spelled(wiring, watched, text, watched.place(name), f"observer.{name}")
            for pin, text in seen.inputs.items()
        }
        rows[name] = msgspec.structs.replace(seen, of=seen.of.upper(), inputs=texts)
    return replace(watched, rows=rows)


def spelled(wiring: Wiring, watched: Watched, text: str, place: Place, of: str) -> str:
    """A condition with the names as the wiring spells them; the same text where they are so already.

    of: whose condition it is. Raises Unjudged at `place`: an operator or a name that it must not have.
    """
    tree = parsed(text, place)
    found = _Spelling(wiring, watched, place, f"{of}: {text!r}").condition(tree)
    return text if found == tree and is_plain(text) else shown(found)


def kind_of(wiring: Wiring, watched: Watched, text: str, place: Place, of: str) -> Scalar | None:
    """The type of a signal; None: a name in it is nothing of the wiring or of the observers.

    of: whose signal it is. Raises Unjudged at `place`: an operator that no wire has, a WORD in an AND.
    """
    tree, look = parsed(text, place), _Spelling(wiring, watched, place, f"{of}: {text!r}", "a wire")
    plain, blocks = {*wiring.table.inputs, *wiring.texts, *wiring.shown}, look.blocks()
    for leaf in leaves(tree):
        match leaf:
            case Name(name, _) if name not in plain:
                return None
            case Member(Name(block, _), pin, _) if pin not in blocks.get(block, {}):
                return None
    match tree:
        case Name(name, _):
            return look.name(name)[1]
        case Member(Name(block, _), pin, _):
            return look.pin(block, pin)[2]
    look.condition(tree)
    return BOOL


@dataclass(frozen=True)
class _Spelling:
    """What is in one condition of a property or an observer."""

    wiring: Wiring
    watched: Watched
    place: Place
    here: str
    whose: str = "a property of a machine"

    def condition(self, tree: Expression) -> Expression:
        """The expression, which must be a BOOL."""
        match tree:
            case Literal(bool(), _, _):
                return tree
            case Name(name, place):
                found, kind = self.name(name)
                made: Expression = Name(found, place)
            case Member(Name(block, where), pin, place):
                owner, known, kind = self.pin(block, pin)
                made = Member(Name(owner, where), known, place)
            case Unary("NOT", operand, place):
                return Unary("NOT", self.condition(operand), place)
            case Binary("AND" | "OR" as operator, left, right, place):
                return Binary(operator, self.condition(left), self.condition(right), place)
            case _:
                lost = tree.operator if isinstance(tree, Unary | Binary) else shown(tree)
                lost = f"{tree.name}(...)" if isinstance(tree, Function) else lost
                allowed = f"{self.whose} has TRUE, FALSE, names, AND, OR and NOT"
                raise self.place.refuse(f"{self.here}: {allowed}, and no {lost}")
        if kind is not BOOL:
            raise self.place.refuse(f"{self.here}: {shown(made)} is a {kind.name}, and a BOOL is needed")
        return made

    def name(self, name: str) -> tuple[str, Scalar]:
        """A signal: its name in the wiring, its type."""
        wiring = self.wiring
        known = {other.upper(): other for other in (*wiring.table.inputs, *wiring.texts, *wiring.shown)}
        found = known.get(name.upper())
        if found is None and name.upper() in {other.upper() for other in self.blocks()}:
            raise self.place.refuse(f"{self.here}: {name} is a block; name one of its outputs, as {name}.Q")
        if found is None:
            said = suggestion(name, list(known.values()))
            raise self.place.refuse(f"{self.here}: {name} is not declared; {said}")
        if found in wiring.table.inputs:
            return found, SCALARS[wiring.table.inputs[found].type]
        return found, wiring.type_of(wiring.shown[found]) if found in wiring.shown else BOOL

    def pin(self, block: str, pin: str) -> tuple[str, str, Scalar]:
        """An output of a block: both names in the wiring, its type."""
        blocks = {name.upper(): (name, outputs) for name, outputs in self.blocks().items()}
        if block.upper() not in blocks:
            said = suggestion(block, list(self.blocks()))
            raise self.place.refuse(f"{self.here}: {block} is not declared; {said}")
        owner, outputs = blocks[block.upper()]
        found = next((name for name in outputs if name.upper() == pin.upper()), None)
        if found is None:
            said = suggestion(pin, list(outputs))
            raise self.place.refuse(f"{self.here}: {owner} has no output {pin!r}; {said}")
        return owner, found, outputs[found]

    def blocks(self) -> dict[str, Mapping[str, Scalar]]:
        """The outputs of each block and observer."""
        found = {name: pins.outputs for name, pins in self.wiring.kinds.items()}
        return found | {name: BLOCKS[seen.of.upper()][1] for name, seen in self.watched.rows.items()}


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


def with_own_wires(wiring: Wiring) -> Unit:
    """The program with a name of its own for each signal: properties of a wiring mean its signals, whatever
    a program has under that name.
    """
    made = unit(wiring)
    new = {name: _free(f"{name}_wire", made.variables) for name in wiring.signals}
    upper = {name.upper(): own for name, own in new.items()}
    variables = {
        upper.get(key, key).upper(): replace(variable, name=upper.get(key, variable.name))
        for key, variable in made.variables.items()
    }
    return replace(made, variables=variables, body=tuple(_renamed(part, new) for part in made.body))


def _free(name: str, taken: Collection[str]) -> str:
    """A name that nothing has."""
    while name.upper() in taken:
        name += "_"
    return name


def _renamed(node: Any, names: Mapping[str, str]) -> Any:
    """The same with other names; a pin keeps its own."""
    match node:
        case Name(name, place):
            return Name(names.get(name, name), place)
        case Assign(target, value, place):
            return Assign(_renamed(target, names), _renamed(value, names), place)
        case Unary(operator, operand, place):
            return Unary(operator, _renamed(operand, names), place)
        case Binary(operator, left, right, place):
            return Binary(operator, _renamed(left, names), _renamed(right, names), place)
        case Call():
            return replace(node, inputs=tuple((pin, _renamed(value, names)) for pin, value in node.inputs))
    return node


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
        return f"{value.type.name}#{value.type.names[int(value.value)]}"
    return shown(value)


def _enumerations(body: Body) -> dict[str, Scalar]:
    found = {}
    for statement in body:
        for _, value in statement.inputs if isinstance(statement, Call) else ():
            if isinstance(value, Literal) and value.type is not None and value.type.kind == "enum":
                found[value.type.name] = value.type
    return found
