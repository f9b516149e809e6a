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
from programs.readers import tia, twincat
from programs.readers.plcopen.project import Lower, read_plcopen
from programs.readers.scl import names_of, open_at_power_up
from programs.readers.statement_list.program import beside, read_awl
from programs.readers.structured_text.types_and_values import Known
from programs.readers.structured_text.units import known_in, read_all

STATEMENT_LIST = (".awl", ".stl")
TEXTS = (".st", *tia.SUFFIXES, *twincat.SUFFIXES)
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
    ".xlsx": "export the table of PLC tags as .xml",
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
        found = _read(content, path, texts, known)
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
    tables = [path for path in every if path.suffix.lower() == ".xml" and _is_table(path)]
    projects = [path for path in every if path.suffix.lower() == twincat.PROJECT]
    if len(projects) > 1:
        raise Unjudged(f"{folder}: {len(projects)} projects in it; name one, such as {projects[0]}")
    read = (*TEXTS, twincat.TASKS)
    found = projects or [path for path in every if path.suffix.lower() in read or path in tables]
    if not found:
        raise Unjudged(f"{folder}: no project (.plcproj) and no source ({', '.join(TEXTS)}) in it")
    return found


def _is_table(path: Path) -> bool:
    """Whether an XML is a table of tags of TIA."""
    content = path.read_bytes() if path.stat().st_size <= LARGEST else b""
    return any(sign in content for sign in tia.TABLES)


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


Text = twincat.Container | tia.Block | Unjudged
Key = tuple[Path, int]
"""A file, and the number of the block in it."""


def _texts(given: Sequence[tuple[Path, bytes]]) -> dict[Key, Text]:
    """The Structured Text of each file that is one, or of each block of it, or why it cannot be read."""
    found: dict[Key, Text] = {}
    names: dict[str, str] = {}
    for path, content in given:
        suffix = path.suffix.lower()
        if suffix in (*STATEMENT_LIST, ".xml", twincat.TASKS):
            if suffix == ".xml" and (table := tia.tags(content, str(path))) is not None:
                found[path, 0] = twincat.Container(table, "")
            continue
        try:
            if suffix not in tia.SUFFIXES:
                found[path, 0] = _plain(content, path)
                continue
            text = _decoded(content, path)
            for n, block in enumerate(tia.blocks(text, str(path))):
                found[path, n] = block
            for key, name in names_of(text).items():
                if names.setdefault(key, name) != name:
                    raise Unjudged(f"{path}: {name!r} and {names[key]!r} are one name here: rename one")
        except Unjudged as error:
            found[path, 0] = error
    return found


def _decoded(text: bytes, path: Path) -> str:
    try:
        return text.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise Unjudged(f"{path}: byte {error.start} is not UTF-8") from None


def _plain(text: bytes, path: Path) -> twincat.Container:
    """Structured Text. Raises Unjudged."""
    if path.suffix.lower() in twincat.SUFFIXES:
        return twincat.read_container(text, str(path))
    return twincat.Container(_decoded(text, path), "")


def _known(texts: Mapping[Key, Text]) -> dict[Key, Known]:
    """The types and constants that each text may use of others; one may need those of another.

    A text that cannot be read declares none here: it is refused when it is read whole.
    """
    declares = re.compile(r"\b(?:TYPE|CONSTANT)\b", re.IGNORECASE)
    some = {
        key: one for key, one in texts.items() if not isinstance(one, Unjudged) and declares.search(one.text)
    }
    found: dict[Key, Known] = {}
    owner: dict[str, Key] = {}
    for number in range(len(some) if len(texts) > 1 else 0):
        before, found = found, {}
        for key, one in some.items():
            with suppress(Unjudged):
                apart = Known.joined(own for other, own in before.items() if other != key)
                found[key] = known_in(one.text, str(key[0]), apart, one.list)
            for name in found[key].types if key in found and number == 0 else ():
                if owner.setdefault(name, key) != key:
                    raise Unjudged(f"{key[0]}: the type {name} is in {owner[name][0]} too; give one of them")
        if found == before:
            break
    return {key: Known.joined(own for other, own in found.items() if other != key) for key in texts}


def _read(content: bytes, path: Path, texts: Mapping[Key, Text], known: Mapping[Key, Known]) -> _File:
    suffix = path.suffix.lower()
    if suffix == ".xml" and (path, 0) not in texts:
        read = read_plcopen(content, str(path))
        return _File(read.units, read.refused, read.shared, read.tasks, read.words)
    if suffix in STATEMENT_LIST:
        return _File([(unit, None) for unit in read_awl(path)])
    if suffix == twincat.TASKS:
        return _File(tasks=twincat.tasks_in(content, str(path)))
    if suffix in tia.SUFFIXES:
        return _blocks(content, path, texts, known)
    text, file = texts[path, 0], str(path)
    try:
        if isinstance(text, Unjudged):
            raise text
        found = read_all(text.text, file, known[path, 0], text.list)
        if isinstance(text, twincat.Container) and suffix in twincat.SUFFIXES:
            return _of_container(text, found.units, found.globals, file, known[path, 0])
    except Unjudged as error:
        if suffix not in twincat.SUFFIXES:
            raise
        words = frozenset(re.findall(r"%?\w+", content.decode("utf-8", "replace").upper()))
        return _File(refused={path.stem.upper(): error}, words={path.stem.upper(): words})
    return _File([(unit, None) for unit in found.units], shared=found.globals, tasks=found.tasks)


def _blocks(content: bytes, path: Path, texts: Mapping[Key, Text], known: Mapping[Key, Known]) -> _File:
    """The blocks of one source of TIA; one that cannot be read is refused alone."""
    units: list[tuple[Unit, Lower | None]] = []
    shared: list[Variable] = []
    refused: dict[str, Unjudged] = {}
    words: dict[str, frozenset[str]] = {}
    doubtful = open_at_power_up(_decoded(content, path))
    for key, block in texts.items():
        if key[0] != path:
            continue
        if isinstance(block, Unjudged):
            raise block
        assert isinstance(block, tia.Block)
        try:
            if block.refused is not None:
                raise block.refused
            found = read_all(block.text, str(path), known[key], block.list)
            own = tia.with_values(block, found.globals, known[key])
        except Unjudged as error:
            refused[block.name.upper()], words[block.name.upper()] = error, block.words
            continue
        shared += own
        for unit in found.units:
            notes = (NOT_KEPT.format(unit.name),) if unit.name.upper() in doubtful else ()
            units.append((replace(unit, fresh=False, notes=notes), None))
    return _File(units, refused, shared, words=words)


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
