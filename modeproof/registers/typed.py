"""Tables of a register as typed rows; every fault is one line with its place and what is allowed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any, TypeVar, get_args, get_origin

import msgspec
from msgspec import Meta

from modeproof.ground.errors import Unjudged, suggestion

Row = TypeVar("Row")
Table = Mapping[str, Any]

Text = Annotated[str, Meta(min_length=1)]
Texts = tuple[Text, ...]
SomeTexts = Annotated[Texts, Meta(min_length=1)]
Name = Annotated[
    str, Meta(pattern=r"^[A-Za-z_]\w*$", description="a name of letters, digits and underscores")
]
Names = tuple[Name, ...]
SomeNames = Annotated[Names, Meta(min_length=1)]
LowerName = Annotated[
    str, Meta(pattern=r"^[a-z][a-z0-9_]*$", description="a lower-case name such as mode_name")
]
Clauses = tuple[
    Annotated[str, Meta(pattern=r"^[A-Z]+(-[A-Z0-9]+)+$", description="a clause id such as AB-2-18")], ...
]
RowId = Annotated[str, Meta(pattern=r"^[A-Z]+-[0-9]+[a-z]?$", description="an id such as E-01 or A-01")]
RunId = Annotated[
    str, Meta(pattern=r"^(MC|NEG|WIT|LIVE|OPEN)_\w+$", description="the id of a run such as MC_Door")
]
Sha256 = Annotated[
    str, Meta(pattern=r"^[0-9a-f]{64}$", description="a SHA-256 of 64 lower-case hexadecimal digits")
]
Count = Annotated[int, Meta(ge=1)]

DEFAULT = "default"
"""[default.key] of a register: what a row of this key says where it says nothing else."""
_PLACE = re.compile(r" - at `(?:key in )?\$\.?(.*)`$")
_UNKNOWN = re.compile(r"Object contains unknown field `(.+)`")
_MISSING = re.compile(r"Object missing required field `(.+)`")
_WORDS = {
    "str": "a text in quotes",
    "int": "an integer",
    "float": "a number",
    "bool": "true or false",
    "array": "a list",
    "object": "a table",
}


class Entry(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A table of a register: no key but those declared."""


def typed(kind: type[Row], values: Table, place: str) -> Row:
    """The row that a table holds. Raises Unjudged: `place`, the key, what is wrong, what is allowed.

    A list of texts that holds one of them twice is refused as well.
    """
    try:
        row = msgspec.convert(values, kind)
    except msgspec.ValidationError as error:
        raise Unjudged(f"{place}: {_explained(kind, values, str(error))}") from None
    for key, value in msgspec.structs.asdict(row).items() if isinstance(row, msgspec.Struct) else ():
        if isinstance(value, tuple):
            for n, entry in enumerate(value):
                if isinstance(entry, str) and entry in value[:n]:
                    raise Unjudged(f"{place}: {key} holds {entry!r} twice")
    return row


def rows_of(text: str) -> Iterator[tuple[int, str]]:
    """The number of each line that begins a row, and the row as a path."""
    above = ""
    for number, line in enumerate(text.splitlines(), 1):
        if head := re.match(r"\s*\[([^\[\]]+)\]", line):
            above = head[1].replace(" ", "")
            yield number, above
        elif key := re.match(r"\s*([\w.-]+)\s*=", line):
            yield number, f"{above}.{key[1]}".lstrip(".")


def only_keys(source: str, data: Table, known: Iterable[str]) -> None:
    """Raises Unjudged for a key that a file must not have on its top floor."""
    known = list(known)
    for key in (*(key for key in data if key != DEFAULT), *data.get(DEFAULT, ())):
        if key not in known:
            raise Unjudged(f"{source}: unknown key {key!r}; {suggestion(key, known)}")


def tables(source: str, data: Table, key: str) -> dict[str, Table]:
    """The rows of a file ([key.ID], or a list [[key]]), each by its id, with what they leave out.

    That is in [default.key]. Raises Unjudged: no row, an id twice.
    """
    rows = data.get(key, [])
    if isinstance(rows, dict) and all(isinstance(row, dict) for row in rows.values()):
        rows = [{"id": id, **row} for id, row in rows.items()]
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise Unjudged(f"{source}: `{key}` must be tables ([{key}.ID], or a list [[{key}]])")
    if not rows:
        raise Unjudged(f"{source}: there is no [{key}.ID] and no [[{key}]]")
    usual = data.get(DEFAULT, {}).get(key, {})
    rows = [{**usual, **row} for row in rows]
    ids = [str(row.get("id", f"number {number}")) for number, row in enumerate(rows, 1)]
    for n, row_id in enumerate(ids):
        if row_id in ids[:n]:
            first = ids.index(row_id) + 1
            raise Unjudged(f"{source}: [[{key}]] {row_id}: declared twice (rows {first} and {n + 1})")
    return dict(zip(ids, rows, strict=True))


def grouped(source: str, data: Table, key: str, name: str) -> list[Table]:
    """The rows of lists by a name ([[key.NAME]]), each with that name under `name` and with its default.

    Raises Unjudged for what is no such list.
    """
    found = data.get(key, {})
    if not isinstance(found, dict) or not all(
        isinstance(rows, list) and all(isinstance(row, dict) for row in rows) for rows in found.values()
    ):
        raise Unjudged(f"{source}: `{key}` must be a list of tables for each name ([[{key}.NAME]])")
    usual = data.get(DEFAULT, {}).get(key, {})
    return [{name: id, **usual, **row} for id, rows in found.items() for row in rows]


def typed_rows(kind: type[Row], source: str, data: Table, key: str) -> tuple[Row, ...]:
    """The rows of such a list. Raises Unjudged like `tables` and `typed`."""
    return tuple(
        typed(kind, row, f"{source}: [[{key}]] {row_id}") for row_id, row in tables(source, data, key).items()
    )


def _explained(kind: Any, values: Any, text: str) -> str:
    found = _PLACE.search(text)
    path = found.group(1) if found else ""
    text = _PLACE.sub("", text)
    here, value, shown = _at(kind, values, path)
    said = f"{shown}: " if shown else ""
    if match := _UNKNOWN.fullmatch(text):
        known = [field.encode_name for field in _fields(here).values()]
        return f"{said}unknown key {match.group(1)!r}; {suggestion(match.group(1), known)}"
    if match := _MISSING.fullmatch(text):
        return f"{said}key {match.group(1)!r} is missing"
    if text.startswith("Invalid enum value"):
        return f"{said}{value!r} is not allowed; {suggestion(str(value), _allowed(here))}"
    return said + _plainly(here, value, text)


def _plainly(kind: Any, value: Any, text: str) -> str:
    """A fault of a single value: what it must be, and what it is."""
    given = repr(value) if len(repr(value)) <= 60 else f"{value!r:.57}..."
    if "of length >= 1" in text:
        return "must not be empty"
    if "matching regex" in text:
        metas = [meta for meta in get_args(kind) if isinstance(meta, Meta)]
        described = next((meta.description for meta in metas if meta.description), None)
        return (
            f"{given} is not {described or text.partition(' matching ')[2].replace('regex', 'of the form')}"
        )
    if match := re.fullmatch(r"Expected `(?:int|float|int \| null)` (>=|>) ([\d.]+)", text):
        return f"{given} is too small; it must be {'at least' if match[1] == '>=' else 'above'} {match[2]}"
    if match := re.fullmatch(r"Expected `(.+?)`, got `.+`", text):
        names = [_WORDS.get(name, name) for name in match[1].split(" | ") if name != "null"]
        return f"must be {' or '.join(names)}, not {given}"
    return text[0].lower() + text[1:]


def _at(kind: Any, values: Any, path: str) -> tuple[Any, Any, str]:
    """What is at a path such as `graph.states` or `lanes[...]`: its type, its value, and where it is.

    msgspec does not say which entry of a list or table is wrong: it is the first that does not fit its type.
    """
    shown = ""
    for part in re.findall(r"\w+|\[\S*?\]", path):
        kind = next((choice for choice in _parts(kind) if get_args(choice) or _is_struct(choice)), kind)
        if part.startswith("["):
            keyed = isinstance(values, Mapping)
            entry_kind = get_args(kind)[1 if keyed else 0]
            entries = values.items() if keyed else enumerate(values)
            key, values = next(
                ((key, entry) for key, entry in entries if not _fits(entry, entry_kind)), ("", None)
            )
            kind, shown = entry_kind, f"{shown}.{key}" if keyed else f"{shown}[{key}]"
        else:
            field = _fields(kind).get(part)
            kind, values = field.type if field else None, values.get(part) if values else None
            shown = f"{shown}.{part}"
    return kind, values, shown.lstrip(".")


def _fits(value: Any, kind: Any) -> bool:
    try:
        msgspec.convert(value, kind)
    except msgspec.ValidationError:
        return False
    return True


def _is_struct(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, msgspec.Struct)


def _fields(kind: Any) -> dict[str, msgspec.structs.FieldInfo]:
    """The fields of a struct by the keys that a file has for them; none of what is no struct."""
    struct = next((part for part in _parts(kind) if _is_struct(part)), None)
    return {field.encode_name: field for field in msgspec.structs.fields(struct)} if struct else {}


def _parts(kind: Any) -> tuple[Any, ...]:
    """The members of a union, without what is annotated; else the type alone."""
    if get_origin(kind) is Annotated:
        return _parts(get_args(kind)[0])
    members = get_args(kind)
    return tuple(part for member in members for part in _parts(member)) if type(None) in members else (kind,)


def _allowed(kind: Any) -> list[str]:
    return [value for part in _parts(kind) for value in get_args(part) if isinstance(value, str)]
