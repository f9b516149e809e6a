"""The wiring of a machine: which signal feeds which input of which block, read from TOML.

A signal is TRUE, FALSE, the name of an input of the cell, an output pin of a block (`guard.S_GuardLocked`),
another signal with a name, or AND, OR and NOT of such. It is a wire: it has no memory, and shows at every
moment what its sources show at that moment. Blocks have memory; they are called once a scan, in an order.
spec/machine_cell/wiring.toml says what each table means.
"""

from __future__ import annotations

import itertools
import keyword
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import Annotated, Literal

import msgspec

from machines.block_rows import Pins, Row, check_row
from machines.own_pins import PINS, block_of, file_of, pins_of, source_of
from machines.signal_names import names
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.typed import Count, Entry, Text, rows_of, typed
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import (
    BOOL,
    SCALARS,
    Binary,
    Expression,
    Member,
    Name,
    Place,
    Scalar,
    Source,
    Unary,
)
from programs.language.tree import Literal as Value
from programs.properties.property_file import parsed
from programs.semantics import document_blocks as blocks
from programs.semantics.reference import targets
from refimpl.errors import ParameterError
from refimpl.machine_cell.expression import signal

STANDARD = ("R_TRIG", "F_TRIG", "SR", "RS", "TON")
"""The standard blocks that the reference of wirings has; of a machine with others the program is run."""
IN_USE, ANY_MODE, TWO_MODES, HOLD = "_in_use", "a_mode", "two_modes", "safeguards_hold"
"""The signals that come from modes and matrix, beside each mode by its name: the first for each safeguard."""
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
PLAIN = "a wire has TRUE, FALSE, names, AND, OR, NOT and brackets: no & for AND, no comment, no BOOL#"
RESERVED = {"TRUE", "FALSE", "AND", "OR", "NOT", "XOR", "MOD", *SCALARS, *BLOCKS}


class Input(Entry, frozen=True, kw_only=True):
    """What the cell reads. BOOL or WORD; `source` names who sends it."""

    type: Literal["BOOL", "WORD"]
    source: Text = msgspec.field(name="from")
    why: Text


class Wire(Entry, frozen=True, kw_only=True):
    """A signal with a name."""

    text: Text = msgspec.field(name="is")
    why: Text


class Output(Entry, frozen=True, kw_only=True):
    """What the cell writes; `target` names who reads it."""

    text: Text = msgspec.field(name="is")
    target: Text = msgspec.field(name="to")
    why: Text


Sets = Annotated[
    tuple[Annotated[tuple[Text, ...], msgspec.Meta(min_length=1)], ...], msgspec.Meta(min_length=1)
]


class Table(Entry, frozen=True, kw_only=True):
    """The file."""

    title: Text
    cycle_ms: Count
    scan_ms: tuple[Count, Count]
    order: tuple[Text, ...]
    inputs: dict[str, Input]
    block: dict[str, Row]
    modes: dict[str, Wire]
    safeguards: dict[str, Wire]
    matrix: dict[str, Sets]
    outputs: dict[str, Output]
    signals: dict[str, Wire] = msgspec.field(default_factory=dict)
    roles: dict[str, Text] = msgspec.field(default_factory=dict)
    """Who plays a role of the properties, where it has another name here."""


@dataclass(frozen=True)
class Wiring:
    """A wiring that was looked through: every name exists, every pin has its one source."""

    file: str
    table: Table
    lines: Mapping[str, int]
    """The line of each row, such as `block.guard.inputs.Reset`."""

    def place(self, row: str) -> Place:
        """Where a row is; the nearest row above it where it has no line of its own."""
        return _place(self.file, self.lines, row)

    def refuse(self, row: str, text: str) -> Unjudged:
        """The refusal of a row: file, line, row, cause."""
        return self.place(row).refuse(f"{row}: {text}")

    @cached_property
    def kinds(self) -> dict[str, Pins]:
        """The pins of each block."""
        return {name: self._kind(name, row) for name, row in self.table.block.items()}

    @cached_property
    def source(self) -> Source:
        """The files of all blocks of one's own. Raises Unjudged."""
        named = [file_of(row.of, self.file) for row in self.table.block.values()]
        files = [found[0] for found in named if found is not None]
        return source_of(files) if files else Source({}, {})

    @property
    def only_by_source(self) -> list[str]:
        """The blocks that the reference of wirings has not: one's own, and standard ones."""
        kinds = self.kinds.items()
        return [
            name
            for name, of in kinds
            if of.unit is None and self.table.block[name].of.upper() not in STANDARD
        ]

    def block_name(self, name: str) -> str:
        """The name under which a program has an instance of a block."""
        own = self.kinds[name].own
        return self.table.block[name].of if own is None else own.name

    def _kind(self, name: str, row: Row) -> Pins:
        key = row.of.upper()
        if key in BLOCKS:
            ins, outs = BLOCKS[key]
            fixed = {pin: kind for pin, kind in ins.items() if kind not in PINS}
            shown = {pin: kind for pin, kind in outs.items() if kind in PINS or key in STANDARD}
            return Pins({pin: kind for pin, kind in ins.items() if pin not in fixed}, fixed, shown, None)
        if (file := file_of(row.of, self.file)) is not None:
            try:
                own = block_of(self.source, file[1], file[0])
            except Unjudged as error:
                raise self.refuse(f"block.{name}", error.message) from None
            return Pins(*pins_of(own), None, own)
        found = blocks.block(row.of)
        if found is None:
            known = [*BLOCKS, *(target for target in targets() if blocks.block(target)), "FILE.st:NAME"]
            raise self.refuse(f"block.{name}", f"no block {row.of!r}; {suggestion(row.of, known)}")
        unit = found.unit()
        sides: dict[str, dict[str, Scalar]] = {"inputs": {}, "parameters": {}, "outputs": {}}
        for pin, (side, _) in found.pins.items():
            variable = unit.variables[pin]
            assert isinstance(variable.type, Scalar)
            sides[side][variable.name] = variable.type
        return Pins(sides["inputs"], sides["parameters"], sides["outputs"], unit)

    @cached_property
    def texts(self) -> dict[str, str]:
        """Each signal with a name as it is written, those that come from the matrix last."""
        table = self.table
        needs = {
            mode: " OR ".join(
                " AND ".join(f"({table.safeguards[name].text})" for name in part) for part in sets
            )
            for mode, sets in table.matrix.items()
        }
        found = {name: wire.text for name, wire in (*table.signals.items(), *table.modes.items())}
        for name in table.safeguards:
            using = [mode for mode, sets in table.matrix.items() if any(name in part for part in sets)]
            found[f"{name}{IN_USE}"] = " OR ".join(using) or "FALSE"
        found[ANY_MODE] = " OR ".join(table.modes)
        pairs = [f"{one} AND {other}" for one, other in itertools.combinations(table.modes, 2)]
        found[TWO_MODES] = " OR ".join(pairs) or "FALSE"
        found[HOLD] = " OR ".join(f"{mode} AND ({needs[mode]})" for mode in table.matrix)
        return found

    @cached_property
    def signals(self) -> dict[str, Expression]:
        """Each signal with a name, after those that it reads. Raises Unjudged: a loop."""
        trees = {name: self._read(self._row(name), text, BOOL) for name, text in self.texts.items()}
        reads = {name: [other for other in names(tree) if other in trees] for name, tree in trees.items()}
        try:
            order = list(TopologicalSorter(reads).static_order())
        except CycleError as error:
            circle = list(reversed(error.args[1]))
            raise self.refuse(
                self._row(circle[0]),
                f"{' -> '.join(circle)} is a loop without memory; put a block into it, such as RS",
            ) from None
        return {name: trees[name] for name in order}

    def _row(self, signal: str) -> str:
        if signal in self.table.signals:
            return f"signals.{signal}"
        if signal in self.table.modes:
            return f"modes.{signal}"
        return f"safeguards.{signal.removesuffix(IN_USE)}" if signal.endswith(IN_USE) else "matrix"

    @cached_property
    def sources(self) -> dict[str, dict[str, Expression]]:
        """What each input pin of each block reads."""
        return {
            name: {
                pin: self._read(f"block.{name}.inputs.{pin}", text, self.kinds[name].inputs[pin])
                for pin, text in row.inputs.items()
            }
            for name, row in self.table.block.items()
        }

    @cached_property
    def shown(self) -> dict[str, Expression]:
        """What each output shows."""
        return {
            name: self._read(f"outputs.{name}", output.text, None)
            for name, output in self.table.outputs.items()
        }

    def type_of(self, tree: Expression) -> Scalar:
        """The type of an expression that was looked through."""
        match tree:
            case Name(name, _) if name in self.table.inputs:
                return SCALARS[self.table.inputs[name].type]
            case Member(Name(block, _), pin, _):
                return self.kinds[block].outputs[pin]
        return BOOL

    def _read(self, row: str, text: str, wanted: Scalar | None) -> Expression:
        """An expression whose names exist and whose type is the one that is wanted (None: BOOL or WORD)."""
        tree = parsed(text, self.place(row))
        self._look(row, tree)
        found = self.type_of(tree)
        if wanted is not None and found != wanted:
            here = f"is a {wanted.name}, and {text!r} is a {found.name}"
            raise self.refuse(row, here)
        if wanted is None and found.kind not in ("bool", "bits"):
            raise self.refuse(row, f"{text!r} is a {found.name}; an output is a BOOL or a WORD")
        if not is_plain(text):
            raise self.refuse(row, f"{text!r}: {PLAIN}")
        return tree

    def _look(self, row: str, tree: Expression) -> None:
        """Refuse an operator or a name that a wire does not have."""
        match tree:
            case Value(value, _, _) if isinstance(value, bool):
                return
            case Name(name, _):
                known = [*self.table.inputs, *self.texts]
                if name in self.table.block:
                    raise self.refuse(row, f"{name} is a block; name one of its outputs, such as {name}.Q")
                if name not in known:
                    raise self.refuse(row, f"no signal {name!r}; {suggestion(name, known)}")
                return
            case Member(Name(block, _), pin, _):
                if block not in self.table.block:
                    raise self.refuse(row, f"no block {block!r}; {suggestion(block, self.table.block)}")
                if pin not in self.kinds[block].outputs:
                    outs = self.kinds[block].outputs
                    raise self.refuse(row, f"{block} has no output {pin!r}; {suggestion(pin, outs)}")
                return
            case Unary("NOT", operand, _):
                parts = [operand]
            case Binary("AND" | "OR", left, right, _):
                parts = [left, right]
            case _:
                raise self.refuse(row, "a wire has TRUE, FALSE, names, AND, OR and NOT, and nothing else")
        for part in parts:
            self._look(row, part)
            if self.type_of(part) is not BOOL:
                raise self.refuse(row, f"AND, OR and NOT take a BOOL, not a {self.type_of(part).name}")


def _place(file: str, lines: Mapping[str, int], row: str) -> Place:
    while row not in lines and "." in row:
        row = row.rpartition(".")[0]
    return Place(file, lines.get(row, 1))


def read_wiring(path: Path) -> Wiring:
    """The wiring of a TOML file. Raises Unjudged with file, line, row and cause."""
    try:
        text = path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Unjudged(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
    return wiring_of(text, str(path))


def wiring_of(text: str, file: str) -> Wiring:
    """The wiring of a text. Raises Unjudged with file, line, row and cause."""
    lines = {row: number for number, row in rows_of(text)}
    _twice(text, file)
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise Unjudged(f"{file}: no TOML: {error}") from None
    try:
        typed_table = typed(Table, table, file)
    except Unjudged as error:
        said = error.message.removeprefix(f"{file}: ")
        raise _place(file, lines, re.split(r"[: \[]", said)[0]).refuse(said) from None
    wiring = Wiring(file, typed_table, lines)
    _check(wiring)
    return wiring


def _twice(text: str, file: str) -> None:
    """Refuse a row that is there twice: two sources for one input."""
    seen: dict[str, int] = {}
    for number, row in rows_of(text):
        first = seen.setdefault(row.lower(), number)
        if first != number:
            what = "two sources for one input" if ".inputs." in row else "a row that is there already"
            raise Place(file, number).refuse(f"{row}: {what}; the first is in line {first}")


def _check(wiring: Wiring) -> None:
    """Everything that the types of the rows do not say. Raises Unjudged."""
    table = wiring.table
    _check_names(wiring)
    low, high = table.scan_ms
    if not low <= table.cycle_ms <= high:
        raise wiring.refuse("scan_ms", f"{low} to {high} ms does not contain cycle_ms, {table.cycle_ms} ms")
    for name, row in table.block.items():
        check_row(row, wiring.kinds[name], wiring.refuse, f"block.{name}", table.cycle_ms)
    _check_order(wiring)
    _check_matrix(wiring)
    for name, wire in table.safeguards.items():
        wiring._read(f"safeguards.{name}", wire.text, BOOL)
    for group in (wiring.signals, wiring.sources, wiring.shown):
        assert group is not None
    if not table.outputs:
        raise wiring.refuse("outputs", "a cell has outputs")


def _check_names(wiring: Wiring) -> None:
    table, seen = wiring.table, dict[str, str]()
    derived = {ANY_MODE, TWO_MODES, HOLD, *(f"{name}{IN_USE}" for name in table.safeguards)}
    for group in ("inputs", "block", "signals", "modes", "outputs"):
        for name in getattr(table, group):
            row = f"{group}.{name}"
            if cause := unfit(name):
                raise wiring.refuse(row, cause)
            if name in derived:
                raise wiring.refuse(row, "this signal comes from the matrix; give yours another name")
            if (first := seen.setdefault(name.upper(), row)) != row:
                raise wiring.refuse(row, f"the name is that of {first}")


def unfit(name: str) -> str:
    """Why this is no name for a signal, a block or an observer; nothing if it is one."""
    if not NAME.fullmatch(name) or name.upper() in RESERVED:
        return "a name begins with a letter, has letters, digits and _, no keyword"
    if keyword.iskeyword(name):
        return f"{name} is a keyword of Python, which runs the wires with plain values; take another name"
    return ""


def is_plain(text: str) -> bool:
    """Whether a text is a signal for the reference too, which reads wires with a reader of its own."""
    try:
        return re.fullmatch(r"[\w.()\s]*", text, re.ASCII) is not None and signal(text, {}) is not None
    except ParameterError:
        return False


def _check_order(wiring: Wiring) -> None:
    order, known = wiring.table.order, wiring.table.block
    for name in order:
        if name not in known:
            raise wiring.refuse("order", f"no block {name!r}; {suggestion(name, known)}")
    for name in known:
        if name not in order:
            raise wiring.refuse(f"block.{name}", "is not called: `order` does not name it")


def _check_matrix(wiring: Wiring) -> None:
    table = wiring.table
    for mode in table.modes:
        if mode not in table.matrix:
            raise wiring.refuse(f"modes.{mode}", "a mode without a row in [matrix]")
    for mode, sets in table.matrix.items():
        if mode not in table.modes:
            raise wiring.refuse(f"matrix.{mode}", f"no mode {mode!r}; {suggestion(mode, table.modes)}")
        for name in (name for part in sets for name in part):
            if name not in table.safeguards:
                cause = f"no safeguard {name!r}; {suggestion(name, table.safeguards)}"
                raise wiring.refuse(f"matrix.{mode}", cause)
    if not table.modes:
        raise wiring.refuse("modes", "a cell has a mode")
