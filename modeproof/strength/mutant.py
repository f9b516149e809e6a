"""One edit of one module: its identity, its text, and the module with it."""

from __future__ import annotations

import difflib
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

from modeproof.tlc.parse_tree import Place

ID_LENGTH = 8


@dataclass(frozen=True)
class Edit:
    """`new` takes the place of the text at `place`; later lines of `new` stand where they shall stand."""

    place: Place
    new: str


@dataclass(frozen=True)
class Mutant:
    """A module with one edit. `old` and `new` are the texts joined to one line, `line` is the edit's first.

    `id` is made of what is edited, not of where: it survives other edits of the module.
    """

    id: str
    module: str
    definition: str
    operator: str
    line: int
    old: str
    new: str
    edit: Edit

    def __str__(self) -> str:
        return f"{self.id}  {self.operator}  {self.definition}:{self.line}  {self.old}  ->  {self.new}"


def identity(module: str, parts: Sequence[str]) -> str:
    """A stable name of a mutant: the module and a hash of all that makes it what it is."""
    digest = hashlib.sha256("\x00".join((module, *parts)).encode()).hexdigest()
    return f"{module}-{digest[:ID_LENGTH]}"


def one_line(text: str) -> str:
    """A text joined to one line, without comments to the end of a line."""
    return " ".join(" ".join(line.split("\\*")[0] for line in text.split("\n")).split())


def cut(lines: Sequence[str], place: Place) -> str:
    """The text at a place, its later lines as they are in the file."""
    chosen = list(lines[place.first_line - 1 : place.last_line])
    chosen[-1] = chosen[-1][: place.last_column]
    chosen[0] = chosen[0][place.first_column - 1 :]
    return "\n".join(chosen)


def applied(lines: Sequence[str], edit: Edit) -> str:
    """The whole text with the edit made."""
    first, last = edit.place.first_line - 1, edit.place.last_line - 1
    before = lines[first][: edit.place.first_column - 1]
    after = lines[last][edit.place.last_column :]
    return "\n".join([*lines[:first], before + edit.new + after, *lines[last + 1 :]]) + "\n"


def wrapped(text: str, before: str, after: str) -> str:
    """`before text after`, with later lines moved as far as the first one is."""
    return before + text.replace("\n", "\n" + " " * len(before)) + after


def moved(text: str, columns: int) -> str:
    """The text with its later lines moved by so many columns (negative: to the left)."""
    head, *rest = text.split("\n")
    if columns >= 0:
        return "\n".join([head, *(" " * columns + line for line in rest)])
    return "\n".join([head, *(line[min(-columns, len(line) - len(line.lstrip())) :] for line in rest)])


def diff(lines: Sequence[str], mutant: Mutant, ending: str = "tla") -> str:
    """The edit as a unified diff."""
    new = applied(lines, mutant.edit).splitlines()
    name = f"{mutant.module}.{ending}"
    return "\n".join(difflib.unified_diff(list(lines), new, name, f"{name} ({mutant.id})", lineterm=""))
