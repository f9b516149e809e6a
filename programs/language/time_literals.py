"""Literals of times."""

from __future__ import annotations

import re
from fractions import Fraction

from programs.language.tree import TIME, Place

_TIME_PART = re.compile(r"(\d+(?:\.\d+)?)(ms|us|ns|d|h|m|s)", re.IGNORECASE)
_UNIT_MS = {"d": 86_400_000, "h": 3_600_000, "m": 60_000, "s": 1000, "ms": 1}


def time_ms(text: str, place: Place) -> int:
    """T#1h2m3.5s in milliseconds. Raises Unjudged for what is no whole number of them."""
    body = text.partition("#")[2].replace("_", "")
    sign, digits = (-1, body[1:]) if body.startswith("-") else (1, body)
    parts = _TIME_PART.findall(digits)
    if not parts or "".join(f"{number}{unit}" for number, unit in parts).lower() != digits.lower():
        raise place.refuse(f"{text}: not a time such as T#1s500ms")
    whole = Fraction(0)
    for number, unit in parts:
        if unit.lower() not in _UNIT_MS:
            raise place.refuse(f"{text}: times are whole milliseconds here")
        whole += Fraction(number) * _UNIT_MS[unit.lower()]
    if whole != int(whole):
        raise place.refuse(f"{text}: times are whole milliseconds here")
    if not TIME.low <= sign * whole <= TIME.high:
        raise place.refuse(f"{text}: outside TIME, {TIME.low}..{TIME.high} ms")
    return sign * int(whole)
