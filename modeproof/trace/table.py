"""Reads a log as the trace tool of a PLC exports it: a table with one column a signal, one row a scan.

Columns are named like the signals or their tags; separated by `;`, `,` or tabs. Booleans are 0, 1, TRUE or
FALSE; words are hexadecimal, with or without 16#, W#16# or 0x, or decimal when the log or the command says
so. A column `dt_ms` holds the time since the row before; `t_ms`, `t_us` or `t_s` a time since any moment. An
empty cell was not observed. Lines that begin with # come first and may set parameters: `# T_ms = 100`, or
`# words = decimal`.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal, DecimalException
from pathlib import Path
from typing import Any

from modeproof.graph.values import NONE
from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.rows import Device, Signal
from modeproof.trace.lines import lines_of
from modeproof.trace.log import Builder, Log, Row
from modeproof.trace.targets import Target

_HEX = re.compile(r"(?:W#16#|16#|0x)?([0-9A-F]{1,4})", re.IGNORECASE)
_DECIMAL = re.compile(r"\d{1,5}")
_INTEGER = re.compile(r"-?\d{1,30}")
_SETTING = re.compile(r"#\s*([\w.]+)\s*[=:]\s*(.*?)\s*")
_TRUTH = {"0": False, "1": True, "false": False, "true": True}
_NOTHING = ("none", "null", "-", "-1")
LONGEST_TIME = 10**16
_TIMES = {"dt_ms": Decimal(1), "t_ms": Decimal(1), "t_us": Decimal("0.001"), "t_s": Decimal(1000)}


@dataclass(frozen=True)
class TableForm:
    """What a table does not say itself.

    `ignore` are columns that do not matter, `time` is the name of a column that holds ms since any moment.
    """

    decimal_words: bool = False
    separator: str = ""
    time: str = ""
    ignore: frozenset[str] = frozenset()


def read_table(
    path: Path, target: Target, params: Mapping[str, Any] | None = None, form: TableForm | None = None
) -> Log:
    """The log in `path`. Raises Unjudged with file, line and column for whatever cannot be right."""
    builder = Builder(target, path, params)
    return _Table(builder, form or TableForm()).read(path)


class _Table:
    def __init__(self, builder: Builder, form: TableForm) -> None:
        self.builder = builder
        self.form = form
        self.decimal = form.decimal_words

    def read(self, path: Path) -> Log:
        names: list[str] = []
        separator = self.form.separator
        for number, line, ended in lines_of(path):
            if not ended and line.strip():
                raise self.builder.fail(number, "the last line is cut off: it has no end of line")
            if not line.strip():
                continue
            if not names and line.startswith("#"):
                self._setting(number, line)
            elif not names:
                separator = separator or max(";,\t", key=line.count)
                names = [name.strip() for name in self._cells(number, line, separator)]
                self._check_names(number, names)
            else:
                cells = [cell.strip() for cell in self._cells(number, line, separator)]
                if len(cells) != len(names):
                    cut = "; the line is cut off" if len(cells) < len(names) else ""
                    raise self.builder.fail(
                        number, f"{len(cells)} cells where {len(names)} were expected{cut}"
                    )
                self._row(number, dict(zip(names, cells, strict=True)))
        return self.builder.log()

    def _cells(self, number: int, line: str, separator: str) -> list[str]:
        try:
            return next(csv.reader([line], delimiter=separator, strict=True))
        except csv.Error as error:
            raise self.builder.fail(number, f"no row of a table: {error}") from None

    def _setting(self, number: int, line: str) -> None:
        match = _SETTING.fullmatch(line.strip())
        if match is None:
            return  # a remark
        name, text = match.groups()
        if name == "words":
            if text not in ("decimal", "hex"):
                raise self.builder.fail(number, f"words are hex or decimal, not {text!r}")
            self.decimal = text == "decimal"
        elif name == "target":
            if text != self.builder.target.id:
                raise self.builder.fail(number, f"this log is of {text!r}, not of {self.builder.target.id}")
        else:
            self.builder.set_param(self.builder.place(number), name, self._wire_param(name, text))

    def _wire_param(self, name: str, text: str) -> Any:
        inner = name.rpartition(".")[2]
        for part in self.builder.target.parts.values():
            signal = part.device.parameters.get(inner)
            if signal is not None:
                return wire_param(signal, text)
        return text

    # ------------------------------------------------------------------------------------------- columns

    def _check_names(self, number: int, names: list[str]) -> None:
        for n, name in enumerate(names):
            column = f"column {n + 1}"
            if not name:
                raise self.builder.fail(number, "a column has no name", column)
            if name in names[:n]:
                raise self.builder.fail(number, f"{name!r} is there twice", column)
            if name in (*_TIMES, "device", self.form.time) or name in self.form.ignore:
                continue
            if not any(self._find(part.device, name) for part in self.builder.target.parts.values()):
                known = [name for part in self.builder.target.parts.values() for name in _names(part.device)]
                text = f"{name!r} is no signal of {self.builder.target.id}"
                mean = suggestion(name, dict.fromkeys(known))
                raise self.builder.fail(number, f"{text}; {mean}; or --ignore it", column)
        for part in self.builder.target.parts.values():
            columns: dict[str, str] = {}
            for name in names:
                if name in self.form.ignore or (found := self._find(part.device, name)) is None:
                    continue
                other = columns.setdefault(found[1].name, name)
                if other != name:
                    text = f"columns {other} and {name} are one signal of {part.device.id}; --ignore one"
                    raise self.builder.fail(number, text)
        times = [name for name in names if name in _TIMES or name == self.form.time]
        if len(times) > 1:
            raise self.builder.fail(number, f"two columns of time: {times[0]} and {times[1]}")
        if self.form.time and self.form.time not in names:
            raise self.builder.fail(number, f"no column {self.form.time!r}, which was to hold the time")

    def _find(self, device: Device, name: str) -> tuple[str, Signal] | None:
        for side, table in (("in", device.inputs), ("out", device.outputs)):
            for signal in table.values():
                if name in (signal.name, signal.tag):
                    return side, signal
        return None

    # ---------------------------------------------------------------------------------------------- rows

    def _row(self, number: int, cells: dict[str, str]) -> None:
        device = self.builder.device(number, cells.get("device"))
        sides: dict[str, dict[str, Any]] = {"in": {}, "out": {}}
        dt: Any = None
        at: Any = None
        for name, text in cells.items():
            if name == "device" or name in self.form.ignore:
                continue
            if name in _TIMES or name == self.form.time:
                value = self._time(number, name, text)
                dt, at = (value, at) if name == "dt_ms" else (dt, value)
                continue
            found = self._find(device, name)
            if not text:
                continue
            if found is None:
                raise self.builder.fail(
                    number, f"{device.id} has no signal {name!r}, so its cell must be empty", name
                )
            side, signal = found
            sides[side][signal.name] = self._value(number, name, signal, text)
        elapsed = self.builder.elapsed(number, device.id, dt, at)
        self.builder.add(Row(number, device.id, elapsed, sides["in"], sides["out"]))

    def _time(self, number: int, name: str, text: str) -> Any:
        if not text:
            raise self.builder.fail(number, "the time is missing", name)
        try:
            value = Decimal(text.replace(",", ".")) * _TIMES.get(name, Decimal(1))
            whole = int(value) if abs(value) < LONGEST_TIME else None
        except (DecimalException, ValueError, OverflowError):
            whole = None
        if whole is None:
            raise self.builder.fail(number, f"{text!r} is no time", name)
        return whole if value == whole else float(value)

    def _value(self, number: int, name: str, signal: Signal, text: str) -> Any:
        forms = self.builder.target.forms
        wire = wire_cell(signal, text, self.decimal)
        try:
            return forms.from_wire(signal, wire, "")
        except Unjudged:
            pass
        raise self.builder.fail(number, f"{text!r} is no value of type {signal.type}", name)


def _names(device: Device) -> list[str]:
    return [*device.inputs, *device.outputs]


def wire_param(signal: Signal, text: str) -> Any:
    """A parameter that was given as text, in the form of the wire; what it cannot be stays text."""
    return wire_cell(signal, text, decimal=False)


def wire_cell(signal: Signal, text: str, decimal: bool) -> Any:
    """A cell of a table in the form of the wire; a text that cannot be of the type stays a text."""
    kind = signal.type
    if kind == "bool":
        return _TRUTH.get(text.lower(), text)
    if kind in ("word", "function"):
        if decimal:
            return f"{int(text):04X}" if _DECIMAL.fullmatch(text) and int(text) <= 0xFFFF else text + " "
        match = _HEX.fullmatch(text)
        return f"{int(match.group(1), 16):04X}" if match else text + " "
    if kind == "mode":
        if text.lower() in _NOTHING:
            return None
        return int(text) if _INTEGER.fullmatch(text) else text
    if kind == "modes":
        inner = text.strip("{}[]").replace(",", " ").split()
        if inner in ([], ["none"]):
            return []
        return sorted(int(one) for one in inner) if all(map(_INTEGER.fullmatch, inner)) else text
    if kind == "text":
        return None if text.lower() in _NOTHING and text not in signal.values else text
    return int(text) if _INTEGER.fullmatch(text) else text


assert NONE == -1  # which the cells of a mode rely on
