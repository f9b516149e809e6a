"""Names and types of a target, as the header of a vector file declares them, and the check of wire values."""

from __future__ import annotations

import itertools
import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

from modeproof.kit.errors import Unjudged

_WORD = re.compile("[0-9A-F]{4}")
DIGITS = 40
"""Characters of a number on the wire; no signal needs half as many."""
TYPES = ("word", "bool", "mode", "modes", "text", "int", "ms")


@dataclass(frozen=True)
class Signal:
    """One input or output: its type, and its range or values where the type leaves them open.

    The values of one that is `project` are a choice of the specification's authors, not of the document.
    """

    name: str
    type: str
    minimum: int | None = None
    maximum: int | None = None
    values: tuple[str, ...] = ()
    modes: tuple[int, ...] = ()
    project: bool = False

    def fault(self, value: Any) -> str:
        """What is wrong with a wire value, or nothing. NaN, 1.0 for 1 and 1 for true are wrong."""
        kind = self.type
        if kind == "word":
            good = type(value) is str and _WORD.fullmatch(value) is not None
            wanted = "four upper-case hex digits"
        elif kind == "bool":
            good, wanted = type(value) is bool, "true or false"
        elif kind == "mode":
            good = value is None or (type(value) is int and value in self.modes)
            wanted = f"one of {', '.join(map(str, self.modes))} or null"
        elif kind == "modes":
            good = (
                type(value) is list
                and all(type(mode) is int and mode in self.modes for mode in value)
                and all(a < b for a, b in itertools.pairwise(value))
            )
            wanted = f"an ascending list of {', '.join(map(str, self.modes))}"
        elif kind == "text":
            good = (
                value in self.values if type(value) is str and value else value is None and "" in self.values
            )
            wanted = "one of " + ", ".join(json.dumps(allowed or None) for allowed in self.values)
        else:
            low, high = self.minimum, self.maximum
            good = type(value) is int and (low is None or value >= low) and (high is None or value <= high)
            wanted = f"an integer {'' if low is None else low}..{'' if high is None else high}"
        return "" if good else f"{self.name}: {wanted} expected, got {shown(value)}"


def read_signals(table: Any, place: str) -> dict[str, Signal]:
    """Signals from a header. Raises Unjudged for an unknown type or a malformed entry."""
    if not isinstance(table, dict):
        raise Unjudged(f"{place}: an object was expected")
    signals = {}
    for name, row in table.items():
        if not isinstance(row, dict) or row.get("type") not in TYPES:
            raise Unjudged(f"{place}: {name}: unknown type")
        signals[name] = Signal(
            name=name,
            type=row["type"],
            minimum=row.get("min"),
            maximum=row.get("max"),
            values=tuple(row.get("values", ())),
            modes=tuple(row.get("modes", ())),
            project=row.get("project", False) is True,
        )
    return signals


def shown(value: Any, limit: int = 60) -> str:
    """A value as JSON, shortened."""
    try:
        text = json.dumps(value)
    except (TypeError, ValueError):
        text = repr(value)
    return text if len(text) <= limit else f"{text[: limit - 3]}..."


def loads(text: str | bytes) -> Any:
    """JSON in the strict sense: no NaN or Infinity, no key twice, no number of more than `DIGITS` characters.

    Raises ValueError.
    """
    return json.loads(
        text, parse_constant=_no_constant, parse_int=_integer, parse_float=_float, object_pairs_hook=_no_twins
    )


def _integer(text: str) -> int:
    if len(text) > DIGITS:
        raise ValueError(f"a number of {len(text)} digits")
    return int(text)


def _float(text: str) -> float:
    number = float(text)
    if len(text) > DIGITS or not math.isfinite(number):
        raise ValueError(f"{text[:DIGITS]} is out of range")
    return number


def _no_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not JSON")


def _no_twins(pairs: list[tuple[str, Any]]) -> Mapping[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("an object names a key twice")
    return found
