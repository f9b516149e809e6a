"""A log as read: rows with what was observed, and the parameters of the machine that it comes from."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, overload

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


Values = Mapping[str, Any]


class Rows(Sequence[Row]):
    """The rows of a log, packed: 32 bytes each, and some 300 for each different set of values."""

    def __init__(self, rows: Iterable[Row] = ()) -> None:
        self._packed = array("q")  # of each row: line, dt_ms (-1: None), number of its inputs, of its outputs
        self._forms: dict[tuple[str, str, tuple[str, ...]], int] = {}  # device, "in" or "out", names
        self._sides: dict[tuple[Any, ...], int] = {}  # number of the form, values
        for row in rows:
            self.append(row)

    def append(self, row: Row) -> None:
        """Take a row at the end."""
        dt = -1 if row.dt_ms is None else row.dt_ms
        sides = (self._side(row.device, "in", row.inputs), self._side(row.device, "out", row.outputs))
        self._packed.extend((row.line, dt, *sides))

    def _side(self, device: str, side: str, values: Values) -> int:
        form = self._forms.setdefault((device, side, tuple(values)), len(self._forms))
        return self._sides.setdefault((form, *values.values()), len(self._sides))

    @cached_property
    def _table(self) -> tuple[list[tuple[str, str, tuple[str, ...]]], list[tuple[Any, ...]]]:
        return list(self._forms), list(self._sides)

    def _values(self, number: int) -> tuple[str, str, Values]:
        forms, sides = self._table
        form, *values = sides[number]
        device, side, names = forms[form]
        return device, side, dict(zip(names, values, strict=True))

    def __len__(self) -> int:
        return len(self._packed) // 4

    @overload
    def __getitem__(self, at: int) -> Row: ...
    @overload
    def __getitem__(self, at: slice) -> Rows: ...
    def __getitem__(self, at: int | slice) -> Row | Rows:
        if isinstance(at, slice):
            first, end, step = at.indices(len(self))
            return self._like(self._packed[4 * first : 4 * max(first, end)] if step == 1 else array("q"))
        at = range(len(self))[at]
        return self._row(*self._packed[4 * at : 4 * at + 4])

    def __iter__(self) -> Iterator[Row]:
        packed = iter(self._packed)
        return (self._row(*one) for one in zip(packed, packed, packed, packed, strict=True))

    def _row(self, line: int, dt_ms: int, inputs: int, outputs: int) -> Row:
        device, _, values = self._values(inputs)
        return Row(line, device, None if dt_ms < 0 else dt_ms, values, self._values(outputs)[2])

    def _like(self, packed: array[int]) -> Rows:
        other = Rows()
        other._packed, other._forms, other._sides = packed, self._forms, self._sides
        other._table = self._table
        return other

    def changed(self, change: Callable[[str, str, Values], Values]) -> Rows:
        """The rows with other values: `change` gets a device, "in" or "out", and values of that side."""
        other = Rows()
        numbers = []
        for number in range(len(self._sides)):
            device, side, values = self._values(number)
            numbers.append(other._side(device, side, change(device, side, values)))
        other._packed = self._packed[:]
        for at in (2, 3):
            other._packed[at::4] = array("q", (numbers[one] for one in self._packed[at::4]))
        return other

    def kinds(self) -> Iterator[tuple[Row, int]]:
        """Each different row (line and time aside, those of the first such row) and how many there are."""
        pairs = zip(self._packed[2::4], self._packed[3::4], strict=True)
        first: dict[tuple[int, int], int] = {}
        counts: Counter[tuple[int, int]] = Counter()
        for at, pair in enumerate(pairs):
            first.setdefault(pair, at)
            counts[pair] += 1
        return ((self[at], counts[pair]) for pair, at in first.items())

    def times(self, device: str) -> set[int | None]:
        """The different times of the rows of a device."""
        pairs = set(zip(self._packed[1::4], self._packed[2::4], strict=True))
        return {None if dt < 0 else dt for dt, side in pairs if self._values(side)[0] == device}


@dataclass(frozen=True)
class Log:
    """All rows, and the parameters by device (wire values; those that are not given are defaults).

    `not_compared` names outputs that the log had and that are left out.
    """

    name: str
    rows: Rows
    params: Mapping[str, Mapping[str, Any]]
    not_compared: tuple[str, ...] = ()

    def observed(self, device: str) -> frozenset[str]:
        """The signals of a device that at least one row shows."""
        return frozenset(
            name
            for row, _ in self.rows.kinds()
            if row.device == device
            for name in (*row.inputs, *row.outputs)
        )


def without_codes(log: Log, target: Target) -> Log:
    """The log without the outputs whose values the document does not give, which it names."""
    own = {
        name: {output for output, of in part.device.outputs.items() if of.project}
        for name, part in target.parts.items()
    }
    names = tuple(
        dict.fromkeys(name for row, _ in log.rows.kinds() for name in row.outputs if name in own[row.device])
    )
    if not names:
        return log

    def documented(device: str, side: str, values: Values) -> Values:
        return {k: v for k, v in values.items() if side == "in" or k not in own[device]}

    return replace(log, rows=log.rows.changed(documented), not_compared=names)


class Builder:
    """Collects the rows of one log and judges times and names; every complaint names file and line."""

    def __init__(self, target: Target, path: Path, params: Mapping[str, Any] | None = None) -> None:
        self.target = target
        self.name = str(path)
        self.rows = Rows()
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
        if not isinstance(name, str) or name not in self.target.parts:
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
        before = self.params[device].setdefault(name, value)
        if before != value and not place.startswith("--param"):
            raise Unjudged(f"{place}: {name} is {before!r} above and {value!r} here")
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
        return Log(self.name, self.rows, self.params)
