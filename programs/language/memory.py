"""What a variable holds: its single values and instances, and what they are at power-up."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from programs.language.tree import Array, Instance, Scalar, Struct, Type


def default(kind: Type, initial: object) -> Any:
    """The value of a variable at power-up; that of its type, or 0, FALSE, where none is declared."""
    if isinstance(kind, Array):
        given = list(initial) if isinstance(initial, tuple) else []
        size = kind.high - kind.low + 1
        return [default(kind.element, value) for value in [*given, *[None] * (size - len(given))]]
    if isinstance(kind, Struct):
        own = dict(initial) if isinstance(initial, tuple) else {}
        return {
            name.upper(): default(inner, own.get(name.upper(), value)) for name, inner, value in kind.members
        }
    assert isinstance(kind, Scalar)
    value = kind.start if initial is None else initial
    return bool(value) if kind.kind == "bool" else int(value)  # type: ignore[call-overload]


def elements(kind: Type, path: str, initial: object) -> Iterator[tuple[str, Scalar | Instance, object]]:
    """The single values and instances in a variable: path, type, and the initial value that is declared."""
    if isinstance(kind, Array):
        given = initial if isinstance(initial, tuple) else ()
        for n, number in enumerate(range(kind.low, kind.high + 1)):
            yield from elements(kind.element, f"{path}[{number}]", given[n] if n < len(given) else None)
    elif isinstance(kind, Struct):
        own = dict(initial) if isinstance(initial, tuple) else {}
        for name, inner, value in kind.members:
            yield from elements(inner, f"{path}.{name.upper()}", own.get(name.upper(), value))
    else:
        yield path, kind, initial


def leaves(kind: Type) -> list[str]:
    """The ends of the paths of the single values of this type; `""` for a type of single values."""
    return [path for path, _, _ in elements(kind, "", None)]
