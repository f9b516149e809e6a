"""A machine cell: blocks that are called in an order, and wires between them. One call of ``step`` is a scan.

Which block, which wire and which order is data: spec/machine_cell/wiring.toml, or another file of the form.
A wire shows what its sources show at that moment, so what is read from a block that is called later is what
that block wrote in the scan before.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from itertools import combinations
from pathlib import Path
from typing import Any

from refimpl.edm import sf_edm
from refimpl.enable_switch import sf_enable_switch
from refimpl.errors import InputError, ParameterError, check_bool, check_int, check_word
from refimpl.guard_locking import sf_guard_locking
from refimpl.machine_cell.expression import Signal, Value, signal, signals
from refimpl.machine_cell.standard import STEPS, Memory
from refimpl.mode_selection import fplc
from refimpl.testable_safety_sensor import sf_testable_safety_sensor

DEVICES = {
    "FPLC": fplc,
    "SF_EDM": sf_edm,
    "SF_ENABLESWITCH": sf_enable_switch,
    "SF_GUARDLOCKING": sf_guard_locking,
    "SF_TESTABLESAFETYSENSOR": sf_testable_safety_sensor,
}
"""The documents' blocks by their names in capitals."""

Call = Callable[[Any, Mapping[str, Value], int], tuple[Any, Mapping[str, Value]]]


@dataclass(frozen=True, slots=True)
class Block:
    """An instance: its memory at power-up, one call of it, the source of each input pin, its output pins."""

    start: Any
    call: Call
    reads: Callable[[Mapping[str, Value]], Mapping[str, Value]]
    writes: Mapping[str, Value]


@dataclass(frozen=True, slots=True)
class Cell:
    """A wiring: the type of each input (BOOL or WORD), the blocks in the order of calls, the outputs.

    ``shows``: what every signal and every output shows, all at once.
    """

    inputs: Mapping[str, str]
    blocks: Mapping[str, Block]
    outputs: Mapping[str, Signal]
    shows: Callable[[Mapping[str, Value]], dict[str, Value]]


@dataclass(frozen=True, slots=True)
class State:
    """Memory between two scans: that of each block, and what its output pins show (`guard.Ready`)."""

    memory: Mapping[str, Any]
    pins: Mapping[str, Value]


def load(path: Path) -> Cell:
    """The cell of a wiring file. Raises ParameterError for what it cannot be made of."""
    return made_of(tomllib.loads(path.read_text("utf-8")))


def made_of(table: Mapping[str, Any]) -> Cell:
    """The cell of a wiring. Raises ParameterError for what it cannot be made of."""
    named = {name: row["is"] for name, row in table.get("signals", {}).items()} | from_matrix(table)
    outputs = {name: row["is"] for name, row in table["outputs"].items()}
    return Cell(
        {name: row["type"] for name, row in table["inputs"].items()},
        {name: _block(table["block"][name], named) for name in table["order"]},
        {name: signal(text, named) for name, text in outputs.items()},
        signals({**named, **outputs}, named),
    )


def from_matrix(table: Mapping[str, Any]) -> dict[str, str]:
    """The signals that the activation matrix gives, as texts.

    Each mode by its name. ``a_mode``: one of them is active. ``two_modes``: more than one.
    ``safeguards_hold``: for an active mode, all safeguards of one of its sets hold. ``NAME_in_use``: a mode
    is active that has the safeguard in a set.
    """
    modes = {name: row["is"] for name, row in table["modes"].items()}
    guards = {name: f"({row['is']})" for name, row in table["safeguards"].items()}
    hold = []
    for mode, sets in table["matrix"].items():
        for names in sets:
            hold.append(" AND ".join([mode, *(guards[name] for name in names)]))
    both = [f"{one} AND {other}" for one, other in combinations(modes, 2)]
    found = {**modes, "a_mode": " OR ".join(modes), "safeguards_hold": " OR ".join(hold)}
    found["two_modes"] = " OR ".join(both) or "FALSE"
    for name in guards:
        using = [mode for mode, sets in table["matrix"].items() if any(name in part for part in sets)]
        found[f"{name}_in_use"] = " OR ".join(using) or "FALSE"
    return found


def power_up(cell: Cell) -> State:
    """The state before the first scan: no block was called, every output pin is FALSE or 0."""
    pins = {
        f"{name}.{pin}": value for name, block in cell.blocks.items() for pin, value in block.writes.items()
    }
    return State({name: block.start for name, block in cell.blocks.items()}, pins)


def step(cell: Cell, state: State, inputs: Mapping[str, Value], dt_ms: int) -> tuple[State, dict[str, Value]]:
    """One scan, ``dt_ms`` (>= 0) after the one before: the state after it, and the outputs.

    Raises InputError for an input that is missing, unknown or of the wrong type.
    """
    _check(cell, inputs, dt_ms)
    memory, values = dict(state.memory), {**inputs, **state.pins}
    for name, block in cell.blocks.items():
        memory[name], written = block.call(memory[name], block.reads(values), dt_ms)
        for pin, value in written.items():
            values[f"{name}.{pin}"] = value
    outputs = {name: source(values) for name, source in cell.outputs.items()}
    return State(memory, {pin: values[pin] for pin in state.pins}), outputs


def values_after(cell: Cell, state: State, inputs: Mapping[str, Value]) -> dict[str, Value]:
    """What every input, pin, signal and output shows at the end of the scan that left ``state``."""
    values = {**inputs, **state.pins}
    return values | cell.shows(values)


def _check(cell: Cell, inputs: Mapping[str, Value], dt_ms: int) -> None:
    check_int("dt_ms", dt_ms, 0, None)
    for name in {**cell.inputs, **inputs}:
        if name not in cell.inputs or name not in inputs:
            raise InputError(name, inputs.get(name), "one value for each input of the cell, and no other")
        (check_bool if cell.inputs[name] == "BOOL" else check_word)(name, inputs[name])


def _block(row: Mapping[str, Any], named: Mapping[str, str]) -> Block:
    reads = signals(row["inputs"], named)
    kind, given = row["of"].upper(), row.get("parameters", {})
    if kind in STEPS:
        pins = {"Q1": False} if kind in ("SR", "RS") else {"Q": False, **({"ET": 0} if kind == "TON" else {})}
        return Block(Memory(), _standard(kind, given), reads, pins)
    device: Any = DEVICES.get(kind) or DEVICES.get(kind.replace("_", ""))
    if device is None:
        raise ParameterError("of", row["of"], f"one of {', '.join((*DEVICES, *STEPS))}")
    known = {field.name.removesuffix("_ms"): field.name for field in fields(device.Params)}
    for pin in given:
        if pin not in known:
            raise ParameterError(pin, given[pin], f"a parameter of {row['of']}")
    start = device.power_up(device.Params(**{known[pin]: value for pin, value in given.items()}))
    outputs = device.outputs(start)
    pins = {field.name: getattr(outputs, field.name) for field in fields(outputs)}
    return Block(start, _document(device), reads, {name: type(value)() for name, value in pins.items()})


def _document(device: Any) -> Call:
    names = tuple(field.name for field in fields(device.Outputs))

    def call(state: Any, pins: Mapping[str, Value], dt_ms: int) -> tuple[Any, Mapping[str, Value]]:
        after, outputs = device.step(state, device.Inputs(dt_ms, **pins))
        return after, {name: getattr(outputs, name) for name in names}

    return call


def _standard(kind: str, given: Mapping[str, Value]) -> Call:
    step_of = STEPS[kind]

    def call(state: Any, pins: Mapping[str, Value], dt_ms: int) -> tuple[Any, Mapping[str, Value]]:
        return step_of(state, {**given, **pins} if given else pins, dt_ms)

    return call
