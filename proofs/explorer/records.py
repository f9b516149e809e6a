"""Records with symbols in them: built without validation, given to a run, compared, filled with plain values.

The checks that `Inputs` and `Params` make when they are built look at types, which a symbolic value does not
have. `unvalidated` builds a frozen dataclass without them; `filled` builds the same record from plain values
with them, so that every example that the solver gives is one that the shipped code accepts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any, TypeVar

import z3

from proofs.explorer.errors import ConcretizationError
from proofs.explorer.values import Flag, Number, Opaque, Proxy, Run, Symbol, Text, TextProxy, Word

T = TypeVar("T")
PLAIN = (bool, int, str, type(None))


def unvalidated(record: type[T], values: Mapping[str, Any]) -> T:
    """A dataclass instance with these field values, without its checks. Raises TypeError for wrong fields."""
    names = [field.name for field in fields(record)]  # type: ignore[arg-type]
    if set(names) != set(values):
        raise TypeError(f"{record.__qualname__} has the fields {names}, not {sorted(values)}")
    made = object.__new__(record)
    for name in names:
        object.__setattr__(made, name, values[name])
    return made


_FIELDS: dict[type, tuple[str, ...] | None] = {}


def _fields_of(value: Any) -> tuple[str, ...] | None:
    """The fields of a dataclass of the code; None for everything else, the explorer's own included."""
    kind = type(value)
    if kind not in _FIELDS:
        ours = isinstance(value, (Flag, Word, Number, Text, Opaque))
        names = tuple(field.name for field in fields(kind)) if is_dataclass(kind) and not ours else None
        _FIELDS[kind] = names
    return _FIELDS[kind]


def _is_record(value: Any) -> bool:
    return _fields_of(value) is not None


def _parts(value: Any) -> dict[str, Any]:
    return {name: getattr(value, name) for name in _fields_of(value) or ()}


def symbols(value: object) -> Iterator[Symbol]:
    """Every symbol in a record or tuple, in order."""
    if isinstance(value, (Flag, Word, Number, Text)):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from symbols(part)
    elif _is_record(value):
        for part in _parts(value).values():
            yield from symbols(part)


def in_run(value: Any, run: Run) -> Any:
    """The record with a proxy for each symbol."""
    if isinstance(value, (Flag, Word, Number, Text)):
        return value.proxy(run)
    if isinstance(value, tuple):
        return tuple(in_run(part, run) for part in value)
    if _is_record(value):
        return unvalidated(type(value), {name: in_run(part, run) for name, part in _parts(value).items()})
    return value


def filled(value: Any, model: z3.ModelRef) -> Any:
    """The record with the model's values, built by its own constructor and so with its checks."""
    if isinstance(value, (Flag, Word, Number, Text)):
        return value.python(model.eval(value.term, model_completion=True))
    if isinstance(value, tuple):
        return tuple(filled(part, model) for part in value)
    if _is_record(value):
        return type(value)(**{name: filled(part, model) for name, part in _parts(value).items()})
    return value


def plain(value: Any, model: z3.ModelRef) -> Any:
    """As `filled`, without the checks of constructors, so that what the code only hands on may stay."""
    if isinstance(value, (Flag, Word, Number, Text)):
        return value.python(model.eval(value.term, model_completion=True))
    if isinstance(value, tuple):
        return tuple(plain(part, model) for part in value)
    if _is_record(value):
        return unvalidated(type(value), {name: plain(part, model) for name, part in _parts(value).items()})
    return value


def evaluated(value: Any, model: z3.ModelRef) -> Any:
    """A result of a run with the model's values in place of symbolic ones."""
    return _evaluated(value, model, lambda record, values: record(**values))


def evaluated_plain(value: Any, model: z3.ModelRef) -> Any:
    """As `evaluated`, without the checks of constructors (see `plain`)."""
    return _evaluated(value, model, unvalidated)


def _evaluated(value: Any, model: z3.ModelRef, make: Callable[[Any, dict[str, Any]], Any]) -> Any:
    if isinstance(value, Proxy):
        found = model.eval(value.term, model_completion=True)
        if isinstance(value, TextProxy):
            return value._values[found.as_long()]
        return z3.is_true(found) if z3.is_bool(found) else _integer(value, found)
    if isinstance(value, tuple):
        return tuple(_evaluated(part, model, make) for part in value)
    if _is_record(value):
        return make(
            type(value), {name: _evaluated(part, model, make) for name, part in _parts(value).items()}
        )
    return value


def _integer(proxy: Any, found: z3.ExprRef) -> int:
    signed = z3.is_bv_value(found) and proxy._signed
    number: int = found.as_signed_long() if signed else found.as_long()
    return number


def terms(value: Any, place: str = "") -> Iterator[tuple[str, z3.ExprRef | object]]:
    """Each leaf of a result with its place, such as `after.selection`: a solver term, or a plain value."""
    found: list[tuple[str, z3.ExprRef | object]] = []
    _leaves(value, place, found)
    return iter(found)


def _leaves(value: Any, place: str, found: list[tuple[str, z3.ExprRef | object]]) -> None:
    if isinstance(value, Proxy):
        found.append((place, value.term))
    elif isinstance(value, tuple):
        for number, part in enumerate(value):
            _leaves(part, f"{place}[{number}]", found)
    elif (names := _fields_of(value)) is not None:
        for name in names:
            _leaves(getattr(value, name), f"{place}.{name}" if place else name, found)
    else:
        found.append((place, value))


def check_result(value: object) -> None:
    """Refuse a result that the solver could not speak about: lists, dictionaries, floats, functions."""
    for place, leaf in terms(value):
        plain = type(leaf) in PLAIN or isinstance(leaf, (Enum, Opaque, z3.ExprRef))
        if not plain:
            where = f" in {place}" if place else ""
            raise ConcretizationError(
                f"the code returned {type(leaf).__name__}{where}; return flags, words, numbers, records"
            )


def same(result: Any, other: Any) -> bool:
    """Whether two results are the same, terms and types included."""
    if type(result) is not type(other):
        return False
    if isinstance(result, Proxy):
        return result.term is other.term or bool(result.term.eq(other.term))
    if isinstance(result, tuple):
        return len(result) == len(other) and all(map(same, result, other))
    if _is_record(result):
        return all(same(getattr(result, name), getattr(other, name)) for name in _fields_of(result) or ())
    return bool(result == other)
