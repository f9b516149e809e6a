"""A log as read: rows with what was observed, and the parameters of the machine that it comes from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.rows import Device, Signal
from modeproof.trace.targets import Target

LONGEST_MS = 1_000_000_000
"""Longer pauses are cut to this, some eleven days: far beyond any deadline, and within TLC's integers."""


@dataclass(frozen=True)
class Row:
    """One line of a log: a scan of a device (or a sample of its signals).

    `line` counts from 1 in the file. `dt_ms` is the time since the row before (since the scan before of this
    device), None where the log does not tell. `inputs` and `outputs` hold what was observed, in Python form.
    """

    line: int
    device: str
    dt_ms: int | None
    inputs: Mapping[str, Any]
    outputs: Mapping[str, Any]


@dataclass(frozen=True)
class Log:
    """All rows, and the parameters by device (wire values; those that are not given are defaults).

    `not_compared` names outputs that the log had and that are left out.
    """

    name: str
    rows: tuple[Row, ...]
    params: Mapping[str, Mapping[str, Any]]
    notes: tuple[str, ...] = field(default=())
    not_compared: tuple[str, ...] = ()

    def observed(self, device: str) -> frozenset[str]:
        """The signals of a device that at least one row shows."""
        return frozenset(
            name for row in self.rows if row.device == device for name in (*row.inputs, *row.outputs)
        )


def without_codes(log: Log, target: Target) -> Log:
    """The log without the outputs whose values the document does not give, which it names."""
    own = {
        name: {output for output, of in part.device.outputs.items() if of.project}
        for name, part in target.parts.items()
    }
    names = tuple(dict.fromkeys(name for row in log.rows for name in row.outputs if name in own[row.device]))
    if not names:
        return log
    rows = tuple(
        replace(row, outputs={k: v for k, v in row.outputs.items() if k not in own[row.device]})
        for row in log.rows
    )
    return replace(log, rows=rows, not_compared=names)


class Builder:
    """Collects the rows of one log and judges times and names; every complaint names file and line."""

    def __init__(self, target: Target, path: Path, params: Mapping[str, Any] | None = None) -> None:
        self.target = target
        self.name = str(path)
        self.rows: list[Row] = []
        self.params: dict[str, dict[str, Any]] = {name: {} for name in target.parts}
        self._given = dict(params or {})
        self._since: dict[str, int] = {}
        self._last: int | None = None

    def place(self, line: int, column: str = "") -> str:
        """Where in the file: the line, and the column or key."""
        return f"{self.name}: line {line}" + (f", {column}" if column else "")

    def fail(self, line: int, text: str, column: str = "") -> Unjudged:
        """The complaint about a place."""
        return Unjudged(f"{self.place(line, column)}: {text}")

    def device(self, line: int, name: Any) -> Device:
        """The device of a row: the only one, or the one that the row names."""
        if name is None:
            if self.target.system:
                raise self.fail(
                    line, f"`device` is missing; a line is of one of {', '.join(self.target.parts)}"
                )
            return self.target.only.device
        if name not in self.target.parts:
            raise self.fail(
                line,
                f"{name!r} is no device of {self.target.id}; {suggestion(str(name), self.target.parts)}",
                "device",
            )
        return self.target.parts[name].device

    def signal(self, line: int, device: Device, name: str, kind: str) -> Signal:
        """The declaration of an input or an output."""
        table = device.inputs if kind == "in" else device.outputs
        if name not in table:
            word = "input" if kind == "in" else "output"
            raise self.fail(
                line, f"{device.id} has no {word} {name!r}; {suggestion(name, table)}", f"{kind}: {name}"
            )
        return table[name]

    def set_params(self, line: int, values: Any) -> None:
        """Parameters of the log's header: by device, or directly where there is only one."""
        if not isinstance(values, dict):
            raise self.fail(line, "a table of parameters was expected", "params")
        for name, value in values.items():
            if self.target.system or (name in self.target.parts and isinstance(value, dict)):
                if name not in self.target.parts or not isinstance(value, dict):
                    raise self.fail(
                        line,
                        f"{name!r} is no device with parameters; {suggestion(name, self.target.parts)}",
                        "params",
                    )
                for inner, one in value.items():
                    self._param(self.place(line, "params"), name, inner, one)
            else:
                self._param(self.place(line, "params"), self.target.only.device.id, name, value)

    def set_param(self, place: str, name: str, value: Any) -> None:
        """One parameter, NAME or DEVICE.NAME."""
        device, dot, inner = name.rpartition(".")
        if not dot:
            owners = [one for one, part in self.target.parts.items() if name in part.device.parameters]
            for owner in owners or list(self.target.parts)[:1]:
                self._param(place, owner, name, value)
        else:
            if device not in self.target.parts:
                raise Unjudged(f"{place}: no device {device!r}; {suggestion(device, self.target.parts)}")
            self._param(place, device, inner, value)

    def _param(self, place: str, device: str, name: str, value: Any) -> None:
        declared = self.target.parts[device].device.parameters
        if name not in declared:
            raise Unjudged(f"{place}: {device} has no parameter {name!r}; {suggestion(name, declared)}")
        self.target.forms.from_wire(declared[name], value, f"{place}: {device}")
        self.params[device][name] = value

    def elapsed(self, line: int, device: str, dt: Any, at: Any) -> int | None:
        """The time of a row in ms: as it is, or since the row before. Raises for impossible ones."""
        if dt is not None:
            whole = self._ms(line, "dt_ms", dt)
            if whole < 0:
                raise self.fail(line, f"a time of {dt} ms since the scan before is impossible", "dt_ms")
            return min(whole, LONGEST_MS)
        if at is None:
            return None
        now = self._ms(line, "t_ms", at)
        if self._last is not None and now < self._last:
            raise self.fail(line, f"time goes back, from {self._last} ms to {now} ms", "t_ms")
        self._last = now
        before = self._since.get(device)
        self._since[device] = now
        return None if before is None else min(now - before, LONGEST_MS)

    def _ms(self, line: int, column: str, value: Any) -> int:
        if (
            isinstance(value, bool)
            or not isinstance(value, int | float)
            or value != value
            or abs(value) > 1e15
        ):
            raise self.fail(line, f"{value!r} is no time in ms", column)
        if value != int(value):
            raise self.fail(line, f"{value!r} is no whole number of ms; round the times before", column)
        return int(value)

    def add(self, row: Row) -> None:
        """Take a row."""
        self.rows.append(row)

    def log(self) -> Log:
        """The log. Raises Unjudged when it is empty or lacks a parameter that has no default."""
        if not self.rows:
            raise Unjudged(f"{self.name}: no scan in it")
        for name, value in self._given.items():
            self.set_param(f"--param {name}", name, value)
        for device, given in self.params.items():
            for signal in self.target.parts[device].device.parameters.values():
                if signal.name not in given:
                    if signal.default is None:
                        raise Unjudged(
                            f"{self.name}: parameter {signal.name} of {device} is missing; give it in the "
                            f"header of the log or with --param {device}.{signal.name}=VALUE"
                        )
                    given[signal.name] = signal.default
        unseen = [name for name in self.target.parts if all(row.device != name for row in self.rows)]
        notes = [f"no line of {name}" for name in unseen] if self.target.system else []
        return Log(self.name, tuple(self.rows), self.params, tuple(notes))
