"""Reads program sources, each by the end of the file's name: text, PLCopen XML, TwinCAT's files, projects."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from modeproof.ground.errors import Unjudged
from programs.language.namespaces import resolved
from programs.language.pou_actions import Actions
from programs.language.shared_memory import linked
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import Body, Source, Task, Unit, Variable
from programs.readers import twincat
from programs.readers.plcopen.project import Lower, read_plcopen
from programs.readers.scl import open_at_power_up, structured_text
from programs.readers.statement_list.program import beside, read_awl
from programs.readers.structured_text.types_and_values import Known
from programs.readers.structured_text.units import known_in, read_all

STATEMENT_LIST = (".awl", ".stl")
TEXTS = (".st", ".scl", ".db", ".udt", *twincat.SUFFIXES)
"""What is read of a folder."""
NOT_KEPT = "the instance data block of {} is not retentive, which the source leaves open"
LARGEST = 1_000_000
"""Bytes of a source file."""
CLOSED = {
    ".l5x": "Rockwell's ladder has blocks of its own; export the routine as Structured Text",
    ".l5k": "Rockwell's text has blocks of its own; export the routine as Structured Text",
    ".export": "this form of CODESYS is not documented; export the project as PLCopen XML",
    ".project": "this form of CODESYS is not documented; export the project as PLCopen XML",
    ".xef": "this form of Schneider is not documented; export each section as Structured Text (.xst, .st)",
    ".zef": "this form of Schneider is not documented; export each section as Structured Text (.xst, .st)",
    ".smbp": "this form of Schneider is not documented; export the program as Structured Text",
    **dict.fromkeys(
        (".zap15", ".zap16", ".zap17", ".zap18", ".zap19", ".ap15", ".ap16", ".ap17", ".ap18", ".ap19"),
        "a TIA project is no source; let TIA generate the source of the block (.scl)",
    ),
    ".s7dcl": "this form of TIA is not read; let TIA generate the source of the block (.scl)",
}
"""Files that are refused by name, each with what to do."""


@dataclass
class _File:
    """What one file declares."""

    units: Sequence[tuple[Unit, Lower | None]] = ()
    refused: Mapping[str, Unjudged] = field(default_factory=dict)
    shared: Sequence[Variable] = ()
    tasks: Sequence[Task] = ()
    words: Mapping[str, frozenset[str]] = field(default_factory=dict)


def read_sources(paths: Sequence[Path]) -> Source:
    """All program units of these files and folders. Raises Unjudged with file, line and cause.

    A unit of a project that is refused is kept as such: it is no matter if it is not needed.
    """
    units: dict[str, Unit] = {}
    bodies: dict[str, Lower] = {}
    refused: dict[str, Unjudged] = {}
    words: dict[str, frozenset[str]] = {}
    files: dict[str, str] = {}
    shared: list[Variable] = []
    tasks: list[Task] = []
    given = _expanded(paths, files)
    lists = [path for path, _ in given if path.suffix.lower() in STATEMENT_LIST]
    beside_lists = {other for path in lists for other in beside(path)}
    given = [(path, content) for path, content in given if path not in beside_lists]
    texts = _texts(given)
    known = _known(texts)
    for path, content in given:
        for other in beside(path) if path.suffix.lower() in STATEMENT_LIST else ():
            _bytes(other, files)
        found = _read(content, path, texts.get(path), known.get(path, Known()))
        refused |= found.refused
        words |= found.words
        shared += found.shared
        tasks += found.tasks
        for unit, lower in found.units:
            key = unit.name.upper()
            if key in BLOCKS:
                raise unit.place.refuse(
                    f"{unit.name} is the name of a standard block; give yours another one"
                )
            if key in units:
                raise unit.place.refuse(
                    f"there is another unit with the name {unit.name}{_advice(units[key], unit)}"
                )
            units[key] = unit
            if lower is not None:
                bodies[key] = lower
    declared = Source(units, files, refused)
    for key, lower in bodies.items():
        try:
            units[key] = lower(declared)
        except Unjudged as error:
            refused[key] = error
    for key in refused:
        units.pop(key, None)
    units = resolved(linked(units, shared))
    if refused and (not units or set(refused) & set(BLOCKS)):
        raise next(iter(refused.values()))
    if not units:
        raise Unjudged(f"{', '.join(files)}: no PROGRAM and no FUNCTION_BLOCK")
    return Source(units, files, refused, tuple(tasks), words)


def _advice(one: Unit, other: Unit) -> str:
    if one.namespace.upper() == other.namespace.upper():
        return ""
    return "; it is in two namespaces, and either could be meant: give the files of one alone"


# ---------------------------------------------------------------- files


def _expanded(paths: Sequence[Path], files: dict[str, str]) -> list[tuple[Path, bytes]]:
    """The files, with those of folders and projects in their place, each once."""
    found: dict[Path, bytes] = {}
    for path in paths:
        if path.is_dir():
            for inner in _in_folder(path):
                found.setdefault(inner, b"")
            continue
        found.setdefault(path, b"")
    for path in list(found):
        found[path] = _bytes(path, files)
        if path.suffix.lower() == twincat.PROJECT:
            for inner in twincat.files_of(path, found[path]):
                if inner not in found:
                    found[inner] = _bytes(inner, files)
    return [(path, text) for path, text in found.items() if path.suffix.lower() != twincat.PROJECT]


def _in_folder(folder: Path) -> list[Path]:
    """The sources in a folder; a project in it says which they are."""
    every = sorted(path for path in folder.rglob("*") if path.is_file())
    projects = [path for path in every if path.suffix.lower() == twincat.PROJECT]
    if len(projects) > 1:
        raise Unjudged(f"{folder}: {len(projects)} projects in it; name one, such as {projects[0]}")
    found = projects or [path for path in every if path.suffix.lower() in (*TEXTS, twincat.TASKS)]
    if not found:
        raise Unjudged(f"{folder}: no project (.plcproj) and no source ({', '.join(TEXTS)}) in it")
    return found


def _bytes(path: Path, files: dict[str, str]) -> bytes:
    """The content of a file, whose hash is noted."""
    if advice := CLOSED.get(path.suffix.lower()):
        raise Unjudged(f"{path}: {path.suffix} is not read: {advice}")
    try:
        text = path.read_bytes()
    except OSError as error:
        raise Unjudged(f"{path}: cannot be read: {error.strerror or error}") from None
    if len(text) > LARGEST:
        raise Unjudged(f"{path}: {len(text):,} bytes; a source has at most {LARGEST:,}")
    files[str(path)] = hashlib.sha256(text).hexdigest()
    return text


# ---------------------------------------------------------------- text


Text = twincat.Container | Unjudged


def _texts(given: Sequence[tuple[Path, bytes]]) -> dict[Path, Text]:
    """The Structured Text of each file that is one, or why it cannot be read."""
    found: dict[Path, Text] = {}
    for path, content in given:
        if path.suffix.lower() not in (*STATEMENT_LIST, ".xml", twincat.TASKS):
            try:
                found[path] = _plain(content, path)
            except Unjudged as error:
                found[path] = error
    return found


def _plain(text: bytes, path: Path) -> twincat.Container:
    """Structured Text. Raises Unjudged."""
    if path.suffix.lower() in twincat.SUFFIXES:
        return twincat.read_container(text, str(path))
    try:
        plain = text.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise Unjudged(f"{path}: byte {error.start} is not UTF-8") from None
    if path.suffix.lower() == ".scl":
        plain = structured_text(plain, str(path))
    return twincat.Container(plain, "")


def _known(texts: Mapping[Path, Text]) -> dict[Path, Known]:
    """The types and constants that each file may use of others; one may need those of another.

    A file that cannot be read declares none here: it is refused when it is read whole.
    """
    declares = re.compile(r"\b(?:TYPE|CONSTANT)\b", re.IGNORECASE)
    some = {
        path: one
        for path, one in texts.items()
        if not isinstance(one, Unjudged) and declares.search(one.text)
    }
    found: dict[Path, Known] = {}
    owner: dict[str, Path] = {}
    for number in range(len(some) if len(texts) > 1 else 0):
        before, found = found, {}
        for path, one in some.items():
            with suppress(Unjudged):
                apart = Known.joined(own for other, own in before.items() if other != path)
                found[path] = known_in(one.text, str(path), apart, one.list)
            for name in found[path].types if path in found and number == 0 else ():
                if owner.setdefault(name, path) != path:
                    raise Unjudged(f"{path}: the type {name} is in {owner[name]} too; give one of them")
        if found == before:
            break
    return {path: Known.joined(own for other, own in found.items() if other != path) for path in texts}


def _read(content: bytes, path: Path, text: Text | None, known: Known) -> _File:
    suffix = path.suffix.lower()
    if suffix == ".xml":
        read = read_plcopen(content, str(path))
        return _File(read.units, read.refused, read.shared, read.tasks, read.words)
    if suffix in STATEMENT_LIST:
        return _File([(unit, None) for unit in read_awl(path)])
    if suffix == twincat.TASKS:
        return _File(tasks=twincat.tasks_in(content, str(path)))
    assert text is not None
    try:
        if isinstance(text, Unjudged):
            raise text
        found = read_all(text.text, str(path), known, text.list)
        if suffix in twincat.SUFFIXES:
            return _of_container(text, found.units, found.globals, str(path), known)
    except Unjudged as error:
        if suffix not in twincat.SUFFIXES:
            raise
        words = frozenset(re.findall(r"%?\w+", content.decode("utf-8", "replace").upper()))
        return _File(refused={path.stem.upper(): error}, words={path.stem.upper(): words})
    units = found.units
    if suffix == ".scl":
        units = [replace(unit, fresh=False) for unit in units]
        doubtful = open_at_power_up(content.decode("utf-8-sig"))
        units = [
            replace(unit, notes=(NOT_KEPT.format(unit.name),)) if unit.name.upper() in doubtful else unit
            for unit in units
        ]
    return _File([(unit, None) for unit in units], shared=found.globals, tasks=found.tasks)


def _of_container(
    text: twincat.Container, units: Sequence[Unit], shared: Sequence[Variable], file: str, known: Known
) -> _File:
    """A file of TwinCAT, whose unit has the name that its XML says."""
    names = [unit.name for unit in units]
    if len(units) > 1 or any(name.upper() != text.name.upper() for name in names):
        raise Unjudged(f"{file}: {text.name} is expected there, and it declares {', '.join(names)}")
    found: list[tuple[Unit, Lower | None]] = []
    for unit in units:
        made = replace(unit, others_call=text.methods)
        bodies: dict[str, Callable[[], Body]] = {
            key: partial(_action, inner, file, known) for key, inner in text.actions.items()
        }
        found.append((made, partial(_with_actions, made, bodies) if bodies else None))
    return _File(found, shared=shared)


def _action(text: str, file: str, known: Known) -> Body:
    return read_all(text, file, known).units[0].body


def _with_actions(unit: Unit, bodies: dict[str, Callable[[], Body]], source: Source) -> Unit:
    for key in bodies:
        if key in source.units or key in unit.variables:
            raise unit.place.refuse(f"{unit.name}: {key} is an action and something else too")
    return replace(unit, body=Actions(bodies).inlined(unit.body))
