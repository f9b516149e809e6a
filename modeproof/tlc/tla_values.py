"""TLA+ values as TLC prints them: integers, booleans, strings, tuples, sets and records.

Python forms: int, bool, str, tuple, frozenset, dict (a record, in the order of the text). `canonical` writes
a value back with the members of sets and the fields of records in one fixed order, so that two spellings of
one value become one text.
"""

from __future__ import annotations

import re
from typing import Any

_TOKEN = re.compile(
    r'\s*(?:(?P<int>-?\d+)|(?P<text>"(?:[^"\\]|\\.)*")|(?P<word>[A-Za-z_][A-Za-z0-9_]*)|(?P<mark><<|>>|\|->|[{}\[\],]))'
)
_ESCAPE = re.compile(r"\\(.)")
_PLAIN = {"n": "\n", "t": "\t", "r": "\r", "f": "\f"}
_DEPTH = 50


class TlaError(ValueError):
    """A text that is not one whole TLA+ value of the kinds above; the message is one line."""


def unquote(text: str) -> str:
    """The content of a TLA+ string literal without its quotes: `\\"` becomes `"`, and so on."""
    return _ESCAPE.sub(lambda match: _PLAIN.get(match.group(1), match.group(1)), text)


def parse(text: str) -> Any:
    """The value that `text` spells. Raises TlaError with the column (from 1) where it stops making sense."""
    value, at = _value(text, 0, 0)
    if text[at:].strip():
        raise TlaError(f"column {at + 1}: {text[at : at + 20]!r} after the end of the value")
    return value


def canonical(value: Any) -> str:
    """One text for one value."""
    if value is True:
        return "TRUE"
    if value is False:
        return "FALSE"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, tuple):
        return f"<<{', '.join(canonical(member) for member in value)}>>"
    if isinstance(value, frozenset):
        return "{" + ", ".join(sorted(canonical(member) for member in value)) + "}"
    if isinstance(value, dict):
        return "[" + ", ".join(f"{key} |-> {canonical(value[key])}" for key in sorted(value)) + "]"
    raise TypeError(f"no TLA+ value: {value!r}")


def _token(text: str, at: int) -> tuple[str, str, int]:
    match = _TOKEN.match(text, at)
    if match is None:
        shown = repr(text[at : at + 20]) if text[at:].strip() else "the end"
        raise TlaError(f"column {at + 1}: a value or mark was expected, not {shown}")
    kind = str(match.lastgroup)
    return kind, match.group(kind), match.end()


def _value(text: str, at: int, depth: int) -> tuple[Any, int]:
    if depth > _DEPTH:
        raise TlaError(f"column {at + 1}: nested deeper than {_DEPTH}")
    kind, token, after = _token(text, at)
    if kind == "int":
        return int(token), after
    if kind == "text":
        return unquote(token[1:-1]), after
    if token in ("TRUE", "FALSE"):
        return token == "TRUE", after
    if token == "<<":
        items, after = _items(text, after, ">>", depth)
        return tuple(items), after
    if token == "{":
        items, after = _items(text, after, "}", depth)
        return _set(items, at), after
    if token == "[":
        return _record(text, after, depth)
    raise TlaError(f"column {at + 1}: {token!r} begins no value")


def _set(items: list[Any], at: int) -> frozenset[Any]:
    try:
        found = frozenset(items)
    except TypeError:
        raise TlaError(f"column {at + 1}: a set of records is not understood") from None
    if len(found) != len(items):
        raise TlaError(f"column {at + 1}: a set names a member twice")
    return found


def _items(text: str, at: int, end: str, depth: int) -> tuple[list[Any], int]:
    items: list[Any] = []
    kind, token, after = _token(text, at)
    if kind == "mark" and token == end:
        return items, after
    while True:
        value, at = _value(text, at, depth + 1)
        items.append(value)
        kind, token, after = _token(text, at)
        if kind == "mark" and token == end:
            return items, after
        if token != ",":
            raise TlaError(f"column {at + 1}: ',' or {end!r} was expected, not {token!r}")
        at = after


def _record(text: str, at: int, depth: int) -> tuple[dict[str, Any], int]:
    fields: dict[str, Any] = {}
    while True:
        kind, name, after = _token(text, at)
        if kind != "word" or name in fields:
            raise TlaError(f"column {at + 1}: a new field name was expected, not {name!r}")
        kind, token, after = _token(text, after)
        if token != "|->":
            raise TlaError(f"column {at + 1}: '|->' was expected after {name}, not {token!r}")
        fields[name], at = _value(text, after, depth + 1)
        kind, token, after = _token(text, at)
        if kind == "mark" and token == "]":
            return fields, after
        if token != ",":
            raise TlaError(f"column {at + 1}: ',' or ']' was expected, not {token!r}")
        at = after
