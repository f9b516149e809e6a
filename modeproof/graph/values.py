"""One value in its three forms: TLA+ (as parsed), Python (refimpl) and wire (JSON of the adapter protocol).

The type of a signal, from interface.toml, decides. `none` of a mode is -1 in TLA+ and Python and null on the
wire; a set of modes is a set, one boolean for each mode, or an ascending list; the empty text is null on the
wire.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.rows import Signal

NONE = -1
WORD_MAX = 0xFFFF
_WORD = re.compile("[0-9A-F]{4}")


class ValueForms:
    """Converts values of the signals of one document; `modes` are its modes, ascending from 0."""

    def __init__(self, modes: Sequence[int]) -> None:
        self.modes = tuple(modes)

    def from_tla(self, signal: Signal, value: Any, place: str) -> Any:
        """The Python form of a TLA+ value. Raises Unjudged, naming `place`, for a value outside the type."""
        kind = signal.type
        good: bool
        if kind == "bool":
            good = type(value) is bool
        elif kind == "text":
            good = type(value) is str and (not signal.values or value in signal.values)
        elif kind == "modes":
            good = isinstance(value, frozenset) and all(
                type(member) is int and member in self.modes for member in value
            )
            if good:
                return tuple(mode in value for mode in self.modes)
        elif kind == "mode":
            good = type(value) is int and (value == NONE or value in self.modes)
        else:
            good = type(value) is int and self._within(signal, value)
        if not good:
            raise Unjudged(f"{place}: {signal.name}: {value!r} is no value of type {kind}")
        return value

    def to_wire(self, signal: Signal, value: Any) -> Any:
        """The wire form of a Python value; a value of a wrong type comes out as its `repr`."""
        kind = signal.type
        if kind == "word" and type(value) is int and 0 <= value <= WORD_MAX:
            return f"{value:04X}"
        if kind == "bool" and type(value) is bool:
            return value
        if kind == "mode" and type(value) is int:
            return None if value == NONE else value
        if kind == "modes" and isinstance(value, tuple) and all(type(one) is bool for one in value):
            return [mode for mode, member in zip(self.modes, value, strict=False) if member]
        if kind == "text" and type(value) is str:
            return None if value == "" and "" in signal.values else value
        if kind in ("int", "ms") and type(value) is int:
            return value
        return repr(value)

    def from_wire(self, signal: Signal, value: Any, place: str) -> Any:
        """The Python form of a wire value. Raises Unjudged, naming `place`, for a value outside the type."""
        kind = signal.type
        if kind in ("word", "function") and isinstance(value, str) and _WORD.fullmatch(value):
            word = int(value, 16)
            return word if kind == "word" else constant(word)
        if kind == "bool" and type(value) is bool:
            return value
        if kind == "mode" and value is None:
            return NONE
        if kind == "mode" and type(value) is int and value in self.modes:
            return value
        if kind == "modes" and isinstance(value, list) and value == sorted(set(value) & set(self.modes)):
            return tuple(mode in value for mode in self.modes)
        if kind == "text" and value is None and "" in signal.values:
            return ""
        if kind == "text" and isinstance(value, str) and value and value in signal.values:
            return value
        if kind in ("int", "ms") and type(value) is int and self._within(signal, value):
            return value
        raise Unjudged(f"{place}: {signal.name}: {value!r} is no value of type {kind}")

    def _within(self, signal: Signal, value: int) -> bool:
        low, high = (0, WORD_MAX) if signal.type == "word" else (signal.minimum, signal.maximum)
        return (low is None or value >= low) and (high is None or value <= high)


def constant(word: int) -> Callable[[bytes], int]:
    """The function that always returns `word`."""

    def same_word(data: bytes) -> int:
        return word

    return same_word
