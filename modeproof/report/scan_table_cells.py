"""What is in a cell of a scan table: words in hex and by their meaning, outputs by their letters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from modeproof.registers.replay import Traces, meanings
from modeproof.registers.rows import Interface

NONE = "none"


@dataclass(frozen=True)
class Column:
    """One column: its heading, and what of a row it shows."""

    id: str
    heading: str
    signals: tuple[str, ...]
    of: str
    """wire, vector, variable, or state (of the device `id`)."""


class Cells:
    """Formats the values of one walk: `tables` holds, for each table of words, pairs of number and word."""

    def __init__(
        self, interface: Interface, traces: Traces, tables: Mapping[str, Sequence[Sequence[int]]]
    ) -> None:
        self.interface, self.traces = interface, traces
        self._meaning = meanings(traces, tables)
        self._types = {
            name: signal.type
            for device in interface.devices.values()
            for group in (device.inputs, device.outputs)
            for name, signal in group.items()
        }

    def columns(self, names: Sequence[str], variables: Sequence[str]) -> list[Column]:
        """The columns of these names: devices, vectors, variables of the specification, signals."""
        vectors = {vector.id: vector for vector in self.traces.vectors}
        found = []
        for name in names:
            if name in self.traces.devices:
                found.append(Column(name, f"{self.traces.devices[name].short} is in", (), "state"))
            elif name in vectors:
                found.append(Column(name, name.replace("_", " "), vectors[name].signals, "vector"))
            elif name in variables and name not in self._types:
                found.append(Column(name, name, (name,), "variable"))
            else:
                found.append(Column(name, name, (name,), "wire"))
        return found

    def show(self, column: Column, wires: Mapping[str, Any], variables: Mapping[str, Any]) -> str:
        """The text of one cell; "" where the row has no such value."""
        if column.of == "state":
            return str(variables.get(self.state_variable(column.id, variables), ""))
        if column.of == "variable":
            return self.value("", variables.get(column.id, ""))
        if column.of == "vector":
            vector = next(vector for vector in self.traces.vectors if vector.id == column.id)
            if any(name not in wires for name in vector.signals):
                return ""
            on = [label for name, label in zip(vector.signals, vector.labels, strict=True) if wires[name]]
            if len(on) == len(vector.labels):
                return "all"
            return f"{vector.says} {', '.join(on)}".strip() if on else NONE
        return self.value(column.id, wires[column.id]) if column.id in wires else ""

    def state_variable(self, device: str, variables: Mapping[str, Any]) -> str:
        """The variable that holds the state of a device: as declared, or with the device's name before it."""
        memory = self.interface.devices[device].memory
        first = next(iter(memory.values()))
        capital = first.tla[:1].upper() + first.tla[1:]
        return f"{device}{capital}" if f"{device}{capital}" in variables else first.tla

    def value(self, signal: str, value: Any) -> str:
        """One value: a word in hex with its meaning, a boolean as 1 or 0, a set by its members."""
        if isinstance(value, bool):
            return "1" if value else "0"
        if self._types.get(signal) == "word" and isinstance(value, int):
            return self.word(signal, value)
        if isinstance(value, list):
            return ", ".join(self.value("", item) for item in value) if value else NONE
        if value == -1 or value == "":
            return NONE
        return str(value)

    def word(self, signal: str, word: int) -> str:
        """A word in hex and what it means where it is; zero alone."""
        if word == 0:
            return "0"
        if signal not in self._meaning:
            return f"{word:04X}"
        says, numbers = self._meaning[signal]
        return (
            f"{word:04X} =<br>{says}&nbsp;{numbers[word]}"
            if word in numbers
            else f"{word:04X} =<br>no&nbsp;code"
        )
