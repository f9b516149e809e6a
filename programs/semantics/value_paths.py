"""Plain values by the paths of the solver's terms, such as `TIMER.ET`, `WORDS[2]` or `ROWS[1].TIMES[0].Q`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from programs.language.memory import default
from programs.language.tree import Array, Struct, Type, Unit
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_blocks import Standard
from programs.semantics.memory_of_units import Frame


def steps(path: str) -> list[str]:
    """The names and indexes of a path."""
    return re.findall(r"[^.\[\]]+", path)


def type_at(unit: Unit, path: str) -> Type | None:
    """The type of a variable of a unit, or of a part of one; None: there is none."""
    name, *rest = steps(path) or [""]
    kind = unit.variables[name].type if name in unit.variables else None
    for step in rest:
        if isinstance(kind, Array) and re.fullmatch(r"-?\d+", step) and kind.low <= int(step) <= kind.high:
            kind = kind.element
        else:
            kind = kind.member(step) if isinstance(kind, Struct) else None
    return kind


def value_at(unit: Unit, path: str, values: Mapping[str, Any]) -> Any:
    """The part of the interpreter's values, which have their names in upper case, with this path."""
    name, *rest = steps(path.upper())
    holder, key = _holder(values, name, unit.variables[name].type, rest)
    return holder[key]


def _holder(values: Any, key: Any, kind: Type, rest: list[str]) -> tuple[Any, Any]:
    for step in rest:
        values = values[key]
        if isinstance(kind, Array):
            key, kind = int(step) - kind.low, kind.element
        else:
            assert isinstance(kind, Struct)
            member = kind.member(step)
            assert member is not None
            key, kind = step, member
    return values, key


def whole(unit: Unit, given: Mapping[str, Any]) -> dict[str, Any]:
    """Single values by their paths as the interpreter takes them: by variable."""
    found: dict[str, Any] = {}
    for path, value in given.items():
        name, *rest = steps(path)
        kind = unit.variables[name].type
        found.setdefault(name, default(kind, None))
        holder, key = _holder(found, name, kind, rest)
        holder[key] = value
    return found


def put(frame: Frame, path: str, value: Any) -> None:
    """Give a variable in the memory of a unit, or of an instance below it, a value."""
    name, *rest = steps(path)
    kind: Any = frame.unit.variables[name].type if name in frame.unit.variables else None
    here: Any = frame.values
    key: Any = name
    for n, step in enumerate(rest, 1):
        here = here[key]
        if isinstance(here, Frame):
            put(here, ".".join(rest[n - 1 :]), value)
            return
        if isinstance(here, Standard):
            here = here.values
            key = step
        elif isinstance(kind, Array):
            key, kind = int(step) - kind.low, kind.element
        else:
            key, kind = step, kind.member(step)
    here[key] = value


def memory_of(machine: Machine) -> dict[str, Any]:
    """Every value in a program's memory by the paths of `terms.slots`."""
    return dict(single_values(machine.memory, machine.now))


def single_values(frame: Frame, now: int, above: str = "") -> Iterator[tuple[str, Any]]:
    """Every single value in a memory with its path."""
    if frame.unit.device is not None:
        yield f"{above}age", now - frame.since
    for key, value in frame.values.items():
        if key in frame.temporary:
            continue
        kind = frame.unit.variables[key].type if key in frame.unit.variables else None
        yield from _values(value, kind, f"{above}{key}", now)


def _values(value: Any, kind: Type | None, path: str, now: int) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Frame):
        yield from single_values(value, now, f"{path}.")
    elif isinstance(value, Standard):
        yield from ((f"{path}.{pin}", found) for pin, found in value.values.items())
        yield f"{path}.before", value.before
        yield f"{path}.running", value.running
        yield f"{path}.up", value.up
        yield f"{path}.down", value.down
        yield f"{path}.age", now - value.since
    elif isinstance(value, list):
        assert isinstance(kind, Array)
        for number, found in enumerate(value, kind.low):
            yield from _values(found, kind.element, f"{path}[{number}]", now)
    elif isinstance(value, dict):
        assert isinstance(kind, Struct)
        for key, found in value.items():
            yield from _values(found, kind.member(key), f"{path}.{key}", now)
    else:
        yield path, value
