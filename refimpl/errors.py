"""Typed errors of the reference implementations, and the checks that raise them.

The checks are called when ``Inputs`` or ``Params`` are built; ``step`` itself only compares. Nothing is
coerced: ``True`` is not the word 1, ``"0FF0"`` is not the word 0x0FF0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields
from typing import Any, TypeVar

T = TypeVar("T")

WORD_MAX = 0xFFFF


class RefimplError(ValueError):
    """A value from outside cannot be used. ``field`` names where it stood, ``value`` is what was given."""

    def __init__(self, field: str, value: object, expected: str) -> None:
        super().__init__(f"{field}: expected {expected}, got {_shortened(value)}")
        self.field = field
        self.value = value
        self.expected = expected


class InputError(RefimplError):
    """An input of a scan is missing, unknown, of the wrong type or out of range."""


class ParameterError(RefimplError):
    """A parameter is missing, unknown, of the wrong type, out of range, or contradicts another one."""


class StateError(RefimplError):
    """A state that no scan can have left behind was passed to ``step``."""


class KeyDataError(RefimplError):
    """The memory of an Electronic-Key has the wrong size, or data that must not be written to a key."""


class LayoutError(RefimplError):
    """The fields of a touchscreen are placed where they must not be."""


def check_bool(field: str, value: object, error: type[RefimplError] = InputError) -> None:
    """Refuse everything but ``True`` and ``False``."""
    if type(value) is not bool:
        raise error(field, value, "a boolean")


def check_int(
    field: str, value: object, low: int, high: int | None, error: type[RefimplError] = InputError
) -> None:
    """Refuse everything but an integer (no boolean) in ``low``..``high``; ``None`` means no upper limit."""
    if type(value) is not int or value < low or (high is not None and value > high):
        raise error(field, value, f"an integer {low}..{high}" if high is not None else f"an integer >= {low}")


def check_word(field: str, value: object, error: type[RefimplError] = InputError) -> None:
    """Refuse everything but a 16-bit word, an integer 0..65535."""
    if type(value) is not int or value < 0 or value > WORD_MAX:
        raise error(field, value, f"a word 0..{WORD_MAX}")


def check_text(
    field: str, value: object, values: tuple[str, ...], error: type[RefimplError] = InputError
) -> None:
    """Refuse everything but one of the texts ``values``."""
    if type(value) is not str or value not in values:
        raise error(field, value, f"one of {', '.join(repr(text) for text in values)}")


def checked(record: type[T], values: Mapping[str, Any], error: type[RefimplError] = InputError) -> T:
    """Build ``Inputs`` or ``Params`` from named values; one missing or extra raises ``error``."""
    known = {field.name: field for field in fields(record)}  # type: ignore[arg-type]
    for name in values:
        if name not in known:
            raise error(name, values[name], f"nothing ({record.__qualname__} has no such field)")
    for name, field in known.items():
        if name not in values and field.default is MISSING and field.default_factory is MISSING:
            raise error(name, MISSING, f"a value ({record.__qualname__} needs this field)")
    return record(**values)


def _shortened(value: object) -> str:
    if value is MISSING:
        return "nothing"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
