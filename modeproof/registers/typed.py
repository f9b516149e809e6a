"""Tables of a register as typed rows; every fault is one line with its place and what is allowed."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, TypeVar, get_args

import msgspec

from modeproof.ground.errors import Unjudged, suggestion

_PLACE = re.compile(r" - at `(?:key in )?\$\.?(.*)`$")
_UNKNOWN = re.compile(r"Object contains unknown field `(.+)`")
_MISSING = re.compile(r"Object missing required field `(.+)`")
_VALUE = re.compile(r"Invalid enum value (.+)")

Row = TypeVar("Row")


def typed(kind: type[Row], values: Mapping[str, Any], place: str) -> Row:
    """The row that a table holds. Raises Unjudged: `place`, the key, what is wrong, what is allowed."""
    try:
        return msgspec.convert(values, kind)
    except msgspec.ValidationError as error:
        raise Unjudged(f"{place}: {_explained(kind, str(error))}") from None


def _explained(kind: type, text: str) -> str:
    found = _PLACE.search(text)
    path = found.group(1) if found else ""
    text = _PLACE.sub("", text)
    said = f"{path}: " if path else ""
    if match := _UNKNOWN.fullmatch(text):
        return f"{said}unknown key {match.group(1)!r}; {suggestion(match.group(1), _keys(kind, path))}"
    if match := _MISSING.fullmatch(text):
        return f"{said}key {match.group(1)!r} is missing"
    if match := _VALUE.fullmatch(text):
        value = match.group(1).strip("'")
        return f"{said}{value!r} is not allowed; {suggestion(value, _allowed(_at(kind, path)))}"
    return said + text[0].lower() + text[1:]


def _keys(kind: type, path: str) -> tuple[str, ...]:
    struct = next((part for part in _parts(_at(kind, path)) if _is_struct(part)), None)
    return tuple(field.encode_name for field in msgspec.structs.fields(struct)) if struct else ()


def _at(kind: Any, path: str) -> Any:
    """The type of what stands at a path such as `graph.states` or `lanes[0]`."""
    for part in re.findall(r"\w+|\[\S*?\]", path):
        if part.startswith("["):
            kind = next(
                (
                    get_args(choice)[-1 if dict is choice else 0]
                    for choice in _parts(kind)
                    if get_args(choice)
                ),
                None,
            )
        else:
            struct = next((choice for choice in _parts(kind) if _is_struct(choice)), None)
            fields = (
                {field.encode_name: field.type for field in msgspec.structs.fields(struct)} if struct else {}
            )
            kind = fields.get(part)
    return kind


def _is_struct(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, msgspec.Struct)


def _parts(kind: Any) -> tuple[Any, ...]:
    """The members of a union; else the type alone."""
    members = get_args(kind)
    return members if type(None) in members else (kind,)


def _allowed(kind: Any) -> tuple[str, ...]:
    return tuple(value for value in get_args(kind) if isinstance(value, str))
