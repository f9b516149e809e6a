"""A machine as a program of one's own: the properties of a wiring, judged of its source.

The wiring says what the names mean: inputs, outputs, the instances of the documents' blocks, the modes and
the activation matrix. What is true of the program is found out from the program alone: its terms, and runs of
its source. How it wires its blocks is its own affair.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from machines.candidate_invariants import Sample
from machines.composed_program import observed
from machines.concrete_runs import Inputs, Runner, read_use
from machines.missing_names import EXPRESSIONS
from machines.signal_names import leaves, names
from machines.verdicts import Machine
from machines.wiring import Wiring
from modeproof.ground.errors import Unjudged, suggestion
from programs.language.calls import inner_bodies
from programs.language.shared_memory import completed
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import (
    BOOL,
    Assign,
    Body,
    Instance,
    Member,
    Place,
    Return,
    Source,
    Statement,
    Unit,
    Variable,
)
from programs.language.tree import Name as Named
from programs.properties.property_file import parsed
from programs.properties.transition_system import Cell
from programs.readers.sources import read_sources
from programs.semantics import document_blocks as blocks
from programs.semantics.interpreter import Machine as Interpreter
from programs.semantics.value_paths import memory_of
from refimpl.machine_cell.expression import Value

TRIES = 60
"""Runs that may be made to shorten one counterexample: a scan of the source takes ten times as long."""


@dataclass(frozen=True)
class ProgramRunner(Runner):
    """Runs the source, and gives the values that properties can name."""

    program: Cell
    pins: Mapping[str, tuple[str, str]]
    """Of each pin that a property may name, the instance and the pin in the program."""
    shown: Sequence[str] = ()
    """Variables that a property may name besides."""

    def power_up(self) -> Interpreter:
        """The interpreter at power-up. A scan changes it."""
        return self.program.machine({})

    def scan(self, state: Any, inputs: Inputs, dt_ms: int) -> tuple[Any, dict[str, Value]]:
        """As `Runner.scan`; it is the same interpreter afterwards."""
        state.scan(inputs, dt_ms)
        kept = state.memory.values
        values = {name: kept[block].values[pin] for name, (block, pin) in self.pins.items()}
        outputs = {name: kept[name.upper()] for name in (*self.wiring.table.outputs, *self.shown)}
        return state, {**inputs, **outputs, **values}

    def kept(self, state: Any) -> dict[str, Any]:
        """The memory by the names of the terms."""
        values = memory_of(state)
        return {path: values[path] for path in self.program.slots}


@dataclass
class ProgramMachine(Machine):
    """A program, with the wiring that gives names their meaning."""

    sources: Sequence[Path] = field(kw_only=True)
    unit: str | None = field(default=None, kw_only=True)
    tries: int = TRIES

    @cached_property
    def source(self) -> Source:
        """The source. Raises Unjudged with file, line and cause."""
        return read_sources(list(self.sources))

    @property
    def files(self) -> Mapping[str, str]:
        """The files of the source, with their SHA-256."""
        return self.source.files

    @cached_property
    def own(self) -> Unit:
        """The unit that is the machine. Raises Unjudged where it has not the names of the wiring."""
        found = self.source.main() if self.unit is None else self.source.find(self.unit)
        if found is None:
            raise Unjudged(f"{', '.join(map(str, self.sources))}: no unit {self.unit!r}")
        found = completed(blocks.with_blocks(self.source), found)
        _check(found, self.wiring, self.source.units)
        return found

    @cached_property
    def cell(self) -> Cell:
        """The program, after it the wires that the properties name, and the observers. Raises Unjudged."""
        own, wiring = self.own, self.wiring
        Cell.of(self.source, own, wiring.table.scan_ms)  # alone: observers and wires are none of its names
        wires = {name: tree for name, tree in wiring.signals.items() if name in self._wires}
        variables = dict(own.variables)
        for name in wires:
            variables[name.upper()] = Variable(name, BOOL, "var", None, own.place)
        for name, seen in self.watched.rows.items():
            if name.upper() in variables:
                raise self.watched.place(name).refuse(f"observer.{name}: the program has this name")
            variables[name.upper()] = Variable(name, Instance(seen.of), "var", None, self.watched.place(name))
        after: list[Statement] = [
            Assign(Named(name, own.place), tree, own.place) for name, tree in wires.items()
        ]
        body = (*own.body, *after, *observed(self.watched))
        whole = replace(own, variables=variables, body=body)
        units = {**self.source.units, own.name.upper(): whole}
        return Cell.of(replace(self.source, units=units), whole, wiring.table.scan_ms)

    def spelled(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
        """As `Machine.spelled`. Raises Unjudged for a standard block of the wiring too."""
        found = super().spelled(row)
        if found is row:
            return row
        place = self.every.place(row)
        for tree in (parsed(found[key], place) for key in EXPRESSIONS if key in found):
            for leaf in leaves(tree):
                name = leaf.of.name if isinstance(leaf, Member) and isinstance(leaf.of, Named) else ""
                kind = self.wiring.kinds.get(name)
                if kind is not None and kind.unit is kind.own is None:
                    raise place.refuse(
                        f"{row['id']}: {name} is a standard block, of which a program may have others"
                    )
        return found

    @cached_property
    def _wires(self) -> set[str]:
        """The wires that properties and observers name, and those that these read, as far as they can be had.

        A wire that reads a standard block of the wiring is none of the program's.
        """
        wiring = self.wiring
        standard = {name for name, of in wiring.kinds.items() if of.unit is of.own is None}
        found: set[str] = set()
        for name, tree in wiring.signals.items():
            read = set(names(tree))
            if not read & standard and read & set(wiring.signals) <= found:
                found.add(name)
        return found

    @property
    def _blocks(self) -> list[str]:
        """The blocks of the wiring that the program has too; of the standard ones it may have others."""
        return [name for name, of in self.wiring.kinds.items() if of.unit or of.own]

    @cached_property
    def runner(self) -> Runner:
        """What runs the source. Raises Unjudged, also for the use."""
        base = Runner.without_cell(self.wiring, self.watched, read_use(self.use), self.table)
        named = {name: text for name, text in base.named.items() if name not in self.wiring.table.outputs}
        outs = {name: self.wiring.kinds[name].outputs for name in self._blocks}
        outs |= {name: BLOCKS[seen.of.upper()][1] for name, seen in self.watched.rows.items()}
        pins = {f"{name}.{pin}": (name.upper(), pin.upper()) for name, of in outs.items() for pin in of}
        values = {name: getattr(base, name) for name in base.__dataclass_fields__} | {"named": named}
        return ProgramRunner(**values, program=self.cell, pins=pins)

    @property
    def unread(self) -> Iterator[str]:
        """None: what a program reads is its own affair."""
        return iter(())

    def sample(self, state: Any, memory: Mapping[str, tuple[bool, int]]) -> Sample:
        """As `Machine.sample`, of the interpreter."""
        found = self.runner.kept(state) if isinstance(state, Interpreter) else dict(state)
        found |= {f"{id} waits": waits for id, (waits, _) in memory.items()}
        return found | {f"{id} since": since for id, (_, since) in memory.items()}

    def on(self, choose: random.Random) -> Callable[[Sample], Iterator[Sample]]:
        """Nothing: an interpreter begins at power-up."""
        return lambda sample: iter(())


def _check(own: Unit, wiring: Wiring, sources: Mapping[str, Unit]) -> None:
    """Refuse a program in which a name of the wiring is not there, or is something else. Raises Unjudged."""
    table = wiring.table
    for section, rows in (("input", table.inputs), ("output", table.outputs)):
        known = own.of(section)
        there = {name.upper(): variable for name, variable in known.items()}
        for name in rows:
            if name.upper() not in there:
                raise own.place.refuse(f"no {section} {name}; {suggestion(name, known)}")
    for name, variable in own.of("input").items():
        if name.upper() not in {row.upper() for row in table.inputs}:
            raise variable.place.refuse(f"input {name} is not in {wiring.file}; write it there too")
    for name, of in wiring.kinds.items():
        if of.unit is of.own is None:
            continue
        instance = own.variables.get(name.upper())
        if instance is None or not isinstance(instance.type, Instance):
            kind = wiring.table.block[name].of
            raise own.place.refuse(f"no instance {name} of {kind}; {wiring.file} calls it so")
        if of.own is not None:
            if instance.type.block.upper() != of.own.name.upper():
                raise instance.place.refuse(f"{name} is no {of.own.name}, as {wiring.file} has it")
            continue
        if (brought := sources.get(instance.type.block.upper())) is not None:
            raise brought.place.refuse(
                f"{brought.name}: {wiring.file} means the document's block, and here is another of its name; "
                "take it out, and prove it alone with prove-program --target"
            )
        device = blocks.block(instance.type.block)
        if device is None or of.unit is None or device.unit().name != of.unit.name:
            kind = wiring.table.block[name].of
            raise instance.place.refuse(f"{name} is no {kind}, as {wiring.file} has it")
    for name in wiring.signals:
        if name.upper() in own.variables:
            variable = own.variables[name.upper()]
            raise variable.place.refuse(
                f"{name} is a signal of {wiring.file}, and properties mean that; give yours another name"
            )
    for place in _returns(own.body):
        raise place.refuse("RETURN in the program itself: what is watched comes at its end")


def _returns(body: Body) -> Iterator[Place]:
    for statement in body:
        if isinstance(statement, Return):
            yield statement.place
        for inner in inner_bodies(statement):
            yield from _returns(inner)
