"""Reads a log as JSON Lines: each line a scan, in the shape of the vectors' scans.

    {"target":"lamp","params":{"T_ms":100}}                       a header, if any
    {"dt_ms":10,"in":{"S":true},"out":{"L":false}}                a scan; "device" if there are several

`t_ms`, a time since any moment, may stand for `dt_ms`. A signal that is not there was not observed.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.trace.log import Builder, Log, Row
from modeproof.trace.targets import Target

_ROW = ("dt_ms", "t_ms", "device", "in", "out")
LONGEST_LINE = 1 << 20
_HEADER = ("target", "params", "recorder", "remark")


class _Twice(ValueError):
    pass


def read_lines(path: Path, target: Target, params: Mapping[str, Any] | None = None) -> Log:
    """The log in `path`. Raises Unjudged with file, line and key for whatever cannot be right."""
    builder = Builder(target, path, params)
    for number, line, ended in lines_of(path):
        if not line.strip():
            continue
        record = _record(builder, number, line, last=not ended)
        if "in" not in record and "out" not in record and not builder.rows:
            _header(builder, number, record)
        else:
            builder.add(_row(builder, number, record))
    return builder.log()


def lines_of(path: Path) -> Iterator[tuple[int, str, bool]]:
    """Each line of a log: its number, its text, and whether it has an end of line.

    Raises Unjudged when the log cannot be read, a line is no UTF-8, or one is longer than LONGEST_LINE.
    """
    try:
        with path.open("rb") as stream:
            number = 0
            while content := stream.readline(LONGEST_LINE + 1):
                number += 1
                if len(content) > LONGEST_LINE:
                    raise Unjudged(f"{path}: line {number}: longer than {LONGEST_LINE:,} bytes")
                text = content.decode("utf-8-sig" if number == 1 else "utf-8")
                yield number, text.rstrip("\r\n"), text.endswith("\n")
    except OSError as error:
        raise Unjudged(f"{path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise Unjudged(f"{path}: line {number}: no UTF-8 text") from None


def _record(builder: Builder, number: int, line: str, last: bool) -> dict[str, Any]:
    try:
        record = json.loads(line, parse_constant=_refuse, object_pairs_hook=_once)
    except _Twice as error:
        raise builder.fail(number, str(error)) from None
    except json.JSONDecodeError as error:
        if last:
            raise builder.fail(number, "the last line is cut off", f"column {error.colno}") from None
        raise builder.fail(number, f"no JSON: {error.msg}", f"column {error.colno}") from None
    except ValueError:
        raise builder.fail(number, "a number with too many digits") from None
    except RecursionError:
        raise builder.fail(number, "nested too deeply") from None
    if not isinstance(record, dict):
        raise builder.fail(number, "an object was expected")
    return record


def _refuse(name: str) -> Any:
    raise _Twice(f"{name} is no number that a log may hold")


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        names = [name for name, _ in pairs]
        again = next(name for n, name in enumerate(names) if name in names[:n])
        raise _Twice(f"{again!r} is there twice")
    return found


def _header(builder: Builder, number: int, record: Mapping[str, Any]) -> None:
    for key in record:
        if key not in _HEADER:
            raise builder.fail(number, f"unknown key {key!r}; {suggestion(key, (*_HEADER, *_ROW))}")
    named = record.get("target", builder.target.id)
    if named != builder.target.id:
        raise builder.fail(number, f"this log is of {named!r}, not of {builder.target.id}", "target")
    builder.set_params(number, record.get("params", {}))


def _row(builder: Builder, number: int, record: Mapping[str, Any]) -> Row:
    for key in record:
        if key not in _ROW:
            raise builder.fail(number, f"unknown key {key!r}; {suggestion(key, _ROW)}")
    device = builder.device(number, record.get("device"))
    sides: dict[str, dict[str, Any]] = {}
    for side in ("in", "out"):
        values = record.get(side, {})
        if not isinstance(values, dict):
            raise builder.fail(number, "an object was expected", side)
        sides[side] = {
            name: builder.target.forms.from_wire(
                builder.signal(number, device, name, side), value, builder.place(number, side)
            )
            for name, value in values.items()
        }
    dt = builder.elapsed(number, device.id, record.get("dt_ms"), record.get("t_ms"))
    return Row(number, device.id, dt, sides["in"], sides["out"])
