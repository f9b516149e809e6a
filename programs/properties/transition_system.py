"""A program of one's own as a transition system, with what is asked of it: terms, plain runs, random runs.

A scan takes the memory, the inputs and the time since the scan before to the memory after it. What is asked
(`Asked`) is looked at after every scan.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import z3

from programs.language.memory import leaves
from programs.language.shared_memory import completed
from programs.language.subset import check, reached
from programs.language.tree import BOOL, Expression, Source, Unit
from programs.language.types import Types
from programs.semantics.document_blocks import Block, check_parameters, with_blocks
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Limit, Overflow
from programs.semantics.obligations import Obligation
from programs.semantics.terms import TRUE, Slot, in_range, slots, symbol
from programs.semantics.translator import Translator
from programs.semantics.translator_expressions import Context
from programs.semantics.value_paths import put, value_at, whole

CLOCK = "DT_MS"
"""The input of a program that has the time since the scan before, in ms."""


@dataclass(frozen=True)
class Asked:
    """One property: `holds` is true after every scan, or what `within_ms` or `once` say."""

    id: str
    sentence: str
    text: str
    holds: Expression | None
    """None: the program stays within its types."""
    trigger: tuple[tuple[str, Expression], ...] = ()
    """What must be true at some time, or the property says nothing: the text and the expression of each."""
    within_ms: int | None = None
    """`holds` is true after a scan at most so many ms after each scan with the (only) trigger."""
    once: Expression | None = None
    """After a scan with the first trigger, `holds` stands aside until a scan with this one: see `Judge`."""

    @property
    def watched(self) -> bool:
        """Whether the property is about more than one scan."""
        return self.within_ms is not None or self.once is not None


@dataclass(frozen=True)
class Trace:
    """Scans from power-up with plain values: elapsed ms, inputs, the values that are shown after each."""

    retained: Mapping[str, Any]
    scans: Sequence[tuple[int, Mapping[str, Any]]]
    rows: Sequence[Mapping[str, Any]]
    stopped: str = ""


@dataclass(frozen=True)
class Cell:
    """A program that calls the documents' blocks, and the range of its scan times in ms (None: no limit)."""

    source: Source
    unit: Unit
    scan_time: tuple[int, int | None] = (0, None)
    wrap: bool = False

    @staticmethod
    def of(
        source: Source, unit: Unit, scan_time: tuple[int, int | None] = (0, None), wrap: bool = False
    ) -> Cell:
        """The cell, looked through. Raises Unjudged with file, line and cause."""
        whole = with_blocks(source)
        unit = completed(whole, unit)
        check(whole, unit)
        for found in reached(whole, unit, ()):
            check_parameters(whole, found)
        cell = Cell(whole, unit, scan_time, wrap)
        most = cell.inputs[cell.clock].type.high if cell.clock else None
        if most is not None and (scan_time[1] is None or scan_time[1] > most):
            place = unit.variables[cell.clock].place
            raise place.refuse(
                f"dt_ms holds {most:,} ms at most: scan_time_ms names a longest scan that fits"
            )
        return cell

    @cached_property
    def clock(self) -> str:
        """The path of the input that has the time since the scan before; empty: there is none."""
        slot = self.inputs.get(CLOCK)
        return CLOCK if slot is not None and slot.type.kind in ("int", "time") else ""

    @cached_property
    def types(self) -> Types:
        """The types within the program."""
        return Types(self.source, self.unit)

    @cached_property
    def blocks(self) -> dict[str, Block]:
        """The documents' blocks that are called, by their names in the program."""
        return {
            unit.name: unit.device
            for unit in reached(self.source, self.unit, ())
            if isinstance(unit.device, Block)
        }

    # ------------------------------------------------------------ as terms

    @cached_property
    def slots(self) -> dict[str, Slot]:
        """The memory."""
        return {slot.path: slot for slot in slots(self.source, self.unit) if not slot.given}

    @cached_property
    def inputs(self) -> dict[str, Slot]:
        """The inputs."""
        return {slot.path: slot for slot in slots(self.source, self.unit) if slot.given}

    @cached_property
    def symbols(self) -> dict[str, Any]:
        """The symbol of each value before a scan, and of the inputs."""
        return {path: symbol(slot.type, path) for path, slot in {**self.slots, **self.inputs}.items()}

    @cached_property
    def dt_ms(self) -> Any:
        """The symbol of the time since the scan before."""
        return z3.Int("dt_ms")

    @cached_property
    def translator(self) -> Translator:
        """What made the terms."""
        return Translator(self.source, self.unit, self.wrap)

    @cached_property
    def after(self) -> dict[str, Any]:
        """Each value after a scan, over the symbols; inputs are what they were."""
        scan = self.translator.scan(self.symbols, self.dt_ms)
        return {path: z3.simplify(term) for path, term in scan.after.items()}

    @cached_property
    def obligations(self) -> tuple[Obligation, ...]:
        """What keeps the program within its types."""
        assert self.after is not None
        return tuple(
            owed for owed in self.translator.obligations if not z3.is_true(z3.simplify(owed.formula))
        )

    @cached_property
    def environment(self) -> z3.BoolRef:
        """The ranges of inputs and of the scan time."""
        low, high = self.scan_time
        parts = [in_range(slot.type, self.symbols[path]) for path, slot in self.inputs.items()]
        parts.append(self.dt_ms >= low)
        if high is not None:
            parts.append(self.dt_ms <= high)
        if self.clock:
            parts.append(self.symbols[self.clock] == self.dt_ms)
        return z3.And(*parts)

    def holds(self, expression: Expression) -> z3.BoolRef:
        """The expression after a scan. Raises Unjudged: a value in it could leave its type."""
        own = Translator(self.source, self.unit, self.wrap)
        term = Context(own, self.types, "", "").value(expression, dict(self.after), TRUE, BOOL)
        if any(not _follows(owed.formula) for owed in own.obligations):
            raise expression.place.refuse(
                "a value here could leave its type; compute it in the program and name the variable"
            )
        found: z3.BoolRef = z3.simplify(term)
        return found

    def says_nothing(self, asked: Asked) -> bool:
        """Whether a property is true whatever its names stand for, so that no program can break it."""
        if asked.holds is None or asked.once is not None:
            return False
        free = {path: z3.FreshConst(term.sort()) for path, term in self.after.items()}
        own = Translator(self.source, self.unit, self.wrap)
        term = Context(own, self.types, "", "").value(asked.holds, free, TRUE, BOOL)
        return _follows(term)

    # ------------------------------------------------------------ with plain values

    def machine(self, retained: Mapping[str, Any]) -> Machine:
        """The interpreter at power-up, with these values in what is RETAIN."""
        machine = Machine(self.source, self.unit, self.wrap)
        for path, value in retained.items():
            put(machine.memory, path, value)
        return machine

    def plain_inputs(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Values by slot as the interpreter takes them."""
        return whole(self.unit, values)

    def run(
        self, retained: Mapping[str, Any], scans: Sequence[tuple[int, Mapping[str, Any]]], asked: Asked
    ) -> Trace | None:
        """The scans up to the one after which the property is false; None: it is true after all of them."""
        machine, judge = self.machine(retained), Judge(asked)
        rows: list[Mapping[str, Any]] = []
        for number, (dt_ms, inputs) in enumerate(scans, 1):
            try:
                machine.scan(self.plain_inputs(inputs), dt_ms)
            except Limit:
                raise
            except Overflow as error:
                wrong = asked.holds is None
                return Trace(retained, scans[:number], rows, error.message) if wrong else None
            rows.append(self.row(machine, asked))
            if judge.broken(machine, dt_ms):
                return Trace(retained, scans[:number], rows)
        return None

    def row(self, machine: Machine, asked: Asked) -> dict[str, Any]:
        """What is shown of a scan: the outputs, and each part of the property."""
        found = {
            path: value_at(self.unit, path, machine.memory.values)
            for name, variable in self.unit.of("output").items()
            for path in (f"{name}{leaf}" for leaf in leaves(variable.type))
        }
        for text, expression in asked.trigger:
            found[f"[{text}]"] = machine.value(machine.memory, expression)
        return found

    def random_runs(
        self, seed: int, runs: int, length: int
    ) -> Iterator[tuple[Machine, dict[str, Any], Scans]]:
        """The machine after each scan of random runs, what it retained, and the scans so far.

        A run that stops ends there.
        """
        values = random.Random(seed)
        low, high = self.scan_time
        times = sorted({low, low + 1, low + 10, low + 50, low + 200, low + 5000})
        times = [dt_ms for dt_ms in times if high is None or dt_ms <= high] + ([high] if high else [])
        for _ in range(runs):
            retained = {path: _random(values, self.slots[path]) for path in self.retained}
            machine = self.machine(retained)
            likely = {path: values.choice((0.05, 0.3, 0.7, 0.95)) for path in self.inputs}
            steady = values.choice((0.5, 0.8, 0.95))
            inputs: dict[str, Any] = {}
            scans: list[tuple[int, Mapping[str, Any]]] = []
            for _ in range(length):
                for path, slot in self.inputs.items():
                    if path not in inputs or values.random() > steady:
                        bit = values.random() < likely[path]
                        inputs[path] = bit if slot.type.kind == "bool" else _random(values, slot)
                dt_ms = values.choice(times)
                scans.append((dt_ms, inputs | ({self.clock: dt_ms} if self.clock else {})))
                try:
                    machine.scan(self.plain_inputs(scans[-1][1]), dt_ms)
                except Overflow:
                    break
                yield machine, retained, scans

    @cached_property
    def retained(self) -> tuple[str, ...]:
        """What has any value at power-up."""
        return tuple(path for path, slot in self.slots.items() if slot.initial is None)


LIMIT_MS = 2_000
"""For the question whether a value in a property stays within its type."""
Scans = list[tuple[int, Mapping[str, Any]]]


class Judge:
    """Watches a run with plain values.

    within_ms: it waits from a scan with the trigger to one with `holds`, and `since` is that time. once: it
    waits from a scan with the trigger to one with `once`, and meanwhile `holds` must not be true.
    """

    def __init__(self, asked: Asked) -> None:
        self.asked = asked
        self.waits = False
        self.since = 0

    def broken(self, machine: Machine, dt_ms: int) -> bool:
        """Whether the property is false after this scan."""
        asked = self.asked
        if asked.holds is None:
            return False
        true = bool(machine.value(machine.memory, asked.holds))
        if not asked.watched:
            return not true
        trigger = bool(machine.value(machine.memory, asked.trigger[0][1]))
        if asked.once is not None:
            self.waits = (self.waits or trigger) and not machine.value(machine.memory, asked.once)
            return self.waits and true
        assert asked.within_ms is not None
        self.since = self.since + dt_ms if self.waits else 0
        late = self.waits and self.since > asked.within_ms
        self.waits = (self.waits or trigger) and not true
        return late


def _follows(formula: z3.BoolRef) -> bool:
    """Whether a formula is true of all values."""
    solver = z3.Solver()
    solver.set("timeout", LIMIT_MS)
    solver.add(z3.Not(formula))
    return bool(solver.check() == z3.unsat)


def _random(values: random.Random, slot: Slot) -> Any:
    kind = slot.type
    if kind.kind == "bool":
        return values.random() < 0.5
    near = [value for value in (0, 1, 2, 5, 10, 100, 1000) if kind.low <= value <= kind.high]
    return values.choice([*near, kind.low, kind.high, values.randint(kind.low, kind.high)])
