"""Reads a project file. All that is wrong with it is found at once, each with its line."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import GenericAlias
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.places import PROJECT_FILE
from modeproof.project.entries import KINDS, Binding, Row, texts
from modeproof.registers.typed import rows_of, typed

VERSION = 1
_NAME = re.compile(r"[A-Za-z0-9_-]{1,60}")
_IN_LINE = re.compile(r"\(at line (\d+), column \d+\)")


def schema() -> dict[str, Any]:
    """The JSON schema of a project file, for editors; `project.schema.json` is made of it."""
    name: Any = Annotated[str, Meta(pattern=f"^{_NAME.pattern}$")]
    tables: list[Any] = [(kind.KIND, GenericAlias(dict, (name, kind)), {}) for kind in KINDS]
    whole = msgspec.defstruct("Project", [("version", Literal[1]), *tables], forbid_unknown_fields=True)
    found = msgspec.json.decode(msgspec.json.encode(msgspec.json.schema(whole)))
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": PROJECT_FILE, **found}


class Wrong(Exception):
    """All that is wrong with a project file, a line each."""

    def __init__(self, lines: list[str]) -> None:
        super().__init__("\n".join(lines))
        self.lines = [Unjudged(line).message for line in lines]


@dataclass(frozen=True)
class Listed:
    """An entry with its name."""

    name: str
    row: Row


@dataclass(frozen=True)
class Project:
    """A project file: where it is, how it is shown, what it lists, and in which line each row begins."""

    path: Path
    shown: str
    entries: tuple[Listed, ...]
    lines: Mapping[str, int]

    @property
    def folder(self) -> Path:
        """The folder from which its paths are."""
        return self.path.parent

    def at(self, entry: Listed, key: str = "") -> str:
        """The place of an entry, or of one of its keys."""
        return _place(self.shown, self.lines, f"{entry.row.KIND}.{entry.name}", key)

    def chosen(self, names: list[str]) -> list[Listed]:
        """The entries of these names, all where there is none. Raises Unjudged for an unknown one."""
        known = [entry.name for entry in self.entries]
        for name in names:
            if name not in known:
                raise Unjudged(f"{self.shown} lists no {name!r}; {suggestion(name, known)}")
        return [entry for entry in self.entries if not names or entry.name in names]


def read(path: Path, shown: str) -> Project:
    """The project of a file. Raises Unjudged: it cannot be read at all; Wrong: it is not as it must be."""
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise Unjudged(f"{shown}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise Unjudged(f"{shown}: byte {error.start} is no UTF-8; save it as UTF-8") from None
    rows = list(rows_of(text))
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise Wrong([_no_toml(shown, rows, str(error))]) from None
    lines = dict[str, int]()
    for number, row in rows:
        lines.setdefault(row, number)
    wrong = list(_version(shown, lines, table))
    if wrong and "version" in table:  # what else is there may be of that form
        raise Wrong(wrong)
    known = ["version", *(kind.KIND for kind in KINDS)]
    for key in table:
        if key not in known:
            begins = next((number for row, number in lines.items() if row.partition(".")[0] == key), 0)
            wrong.append(f"{_line(shown, begins)}: unknown key {key!r}; {suggestion(key, known)}")
    entries: list[Listed] = []
    seen: dict[str, str] = {}
    for kind in KINDS:
        named = table.get(kind.KIND, {})
        if not isinstance(named, dict) or not all(isinstance(row, dict) for row in named.values()):
            what = f"an entry is a table with a name: [{kind.KIND}.NAME]"
            wrong.append(f"{_line(shown, lines.get(kind.KIND, 0))}: {what}")
            continue
        for name, row in named.items():
            head = f"{kind.KIND}.{name}"
            here = _place(shown, lines, head)
            if not _NAME.fullmatch(name):
                wrong.append(f"{here}: a name has letters, digits, - and _, up to 60 of them")
            elif (first := seen.setdefault(name.casefold(), head)) != head:
                there = lines.get(first)
                where = f" in line {there}" if there else ""
                wrong.append(f"{here}: [{first}]{where} has this name too; give one of them another")
            troubles, entry = _entry(kind, row, shown, lines, head)
            wrong += troubles
            if entry is not None:
                entries.append(Listed(name, entry))
    if wrong:
        raise Wrong(sorted(wrong, key=_line_of))
    order = {row: number for number, (row, _) in enumerate(lines.items())}
    entries.sort(key=lambda entry: order.get(f"{entry.row.KIND}.{entry.name}", len(order)))
    return Project(path, shown, tuple(entries), lines)


def _version(shown: str, lines: Mapping[str, int], table: Mapping[str, Any]) -> Iterator[str]:
    said = table.get("version")
    here = _line(shown, lines.get("version", 1))
    if said is None:
        yield f"{here}: `version = {VERSION}` is missing; write it in the first line"
    elif type(said) is not int:
        yield f"{here}: version is a number, {VERSION} here, not {said!r}"
    elif said > VERSION:
        yield f"{here}: version {said} is of a newer modeproof; this one reads {VERSION}: update modeproof"
    elif said < VERSION:
        yield (
            f"{here}: version {said} is an old form; this modeproof reads {VERSION}: rename the file, and "
            "`modeproof init` writes a new one"
        )


def _entry(
    kind: type[Row], row: Mapping[str, Any], shown: str, lines: Mapping[str, int], head: str
) -> tuple[list[str], Row | None]:
    """What is wrong with an entry, and the entry where nothing is."""
    fields = {field.encode_name: field for field in msgspec.structs.fields(kind)}
    wrong = []
    fitting = dict[str, Any]()
    for key, value in row.items():
        here = _place(shown, lines, head, key)
        if key not in fields:
            wrong.append(f"{here}: unknown key; {suggestion(key, fields)}")
            continue
        if key == "binding" and isinstance(value, Mapping):
            wrong += _keys_of_binding(shown, lines, f"{head}.{key}", value)
            if wrong:
                continue
        try:
            read: Any = typed(fields[key].type, value, here)
        except Unjudged as error:
            wrong.append(error.message)
            continue
        if fields[key].name in kind.PATHS and not isinstance(read, Binding):
            for path in texts(read):
                if any(not one.isprintable() for one in path):
                    wrong.append(
                        f"{here}: {path!r} is no path; write / in it, or '...' in the place of quotes"
                    )
            value = [_slashes(one) for one in value] if isinstance(value, list) else _slashes(value)
        fitting[key] = value
    for key, field in fields.items():
        if field.required and key not in row:
            wrong.append(f"{_place(shown, lines, head)}: `{key}` is missing")
    if wrong:
        return wrong, None
    entry = typed(kind, fitting, _place(shown, lines, head))
    trouble = entry.trouble()
    return ([f"{_place(shown, lines, head)}: {trouble}"], None) if trouble else ([], entry)


def _keys_of_binding(
    shown: str, lines: Mapping[str, int], head: str, table: Mapping[str, Any]
) -> Iterator[str]:
    fields = {field.encode_name: field for field in msgspec.structs.fields(Binding)}
    for key, value in table.items():
        here = _place(shown, lines, head, key)
        if key not in fields:
            yield f"{here}: unknown key; {suggestion(key, fields)}"
            continue
        try:
            typed(fields[key].type, value, here)
        except Unjudged as error:
            yield error.message


def _slashes(path: str) -> str:
    return path.replace("\\", "/")


def _no_toml(shown: str, rows: list[tuple[int, str]], cause: str) -> str:
    """Why a text is no TOML; of an entry that is there twice, where both are."""
    found = _IN_LINE.search(cause)
    number = int(found[1]) if found else 0
    what = " ".join(_IN_LINE.sub("", cause).split())
    first = dict[str, int]()
    for line, row in rows:
        if line == number and row in first:
            what = f"{row} stands in line {first[row]} too; give one of them another name, or take it out"
        first.setdefault(row, line)
    if "\\" in what:
        what += "; a path is written with /, or in '...'"
    return f"{_line(shown, number)}: {what[0].lower()}{what[1:]}"


def _place(shown: str, lines: Mapping[str, int], head: str, key: str = "") -> str:
    """File, line and row; the nearest row above where it has no line of its own."""
    whole = f"{head}.{key}" if key else head
    row, number = whole, 0
    while row and not (number := lines.get(row, 0)):
        row = row.rpartition(".")[0]
    return f"{_line(shown, number)}: {whole}"


def _line_of(said: str) -> int:
    found = re.match(r"[^:]*:(\d+):", said)
    return int(found[1]) if found else 0


def _line(shown: str, number: int) -> str:
    return f"{shown}:{number}" if number else shown
