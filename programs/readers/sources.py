"""Reads program sources: Structured Text, SCL, PLCopen XML, each by the end of the file's name."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from modeproof.ground.errors import Unjudged
from programs.language.namespaces import resolved
from programs.language.standard_blocks import BLOCKS
from programs.language.tree import Source, Unit
from programs.readers.plcopen.project import Lower, read_plcopen
from programs.readers.scl import open_at_power_up, structured_text
from programs.readers.statement_list.program import beside, read_awl
from programs.readers.structured_text.units import KnownTypes, read_text, types_in

STATEMENT_LIST = (".awl", ".stl")
NOT_KEPT = "the instance data block of {} is not retentive, which the source leaves open"
LARGEST = 1_000_000
"""Bytes of a source file."""


def read_sources(paths: Sequence[Path]) -> Source:
    """All program units of these files. Raises Unjudged with file, line and cause.

    A unit of a PLCopen project that is refused is kept as such: it is no matter if it is not needed.
    """
    units: dict[str, Unit] = {}
    bodies: dict[str, Lower] = {}
    refused: dict[str, Unjudged] = {}
    files: dict[str, str] = {}
    types = _types(paths)
    for path in paths:
        if path.suffix.lower() == ".csv" and str(path) in files:
            continue  # it belongs to a statement list that was read
        text = _bytes(path, files)
        for other in beside(path) if path.suffix.lower() in STATEMENT_LIST else ():
            _bytes(other, files)
        apart = {name: kind for other, own in types.items() if other != path for name, kind in own.items()}
        found, without = _read(text, path, apart)
        refused |= without
        for unit, lower in found:
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
    units = resolved(units)
    if refused and (not units or set(refused) & set(BLOCKS)):
        raise next(iter(refused.values()))
    if not units:
        raise Unjudged(f"{', '.join(files)}: no PROGRAM and no FUNCTION_BLOCK")
    return Source(units, files, refused)


def _advice(one: Unit, other: Unit) -> str:
    if one.namespace.upper() == other.namespace.upper():
        return ""
    return "; it is in two namespaces, and either could be meant: give the files of one alone"


def _bytes(path: Path, files: dict[str, str]) -> bytes:
    """The content of a file, whose hash is noted."""
    try:
        text = path.read_bytes()
    except OSError as error:
        raise Unjudged(f"{path}: cannot be read: {error.strerror or error}") from None
    if len(text) > LARGEST:
        raise Unjudged(f"{path}: {len(text):,} bytes; a source has at most {LARGEST:,}")
    files[str(path)] = hashlib.sha256(text).hexdigest()
    return text


def _types(paths: Sequence[Path]) -> dict[Path, KnownTypes]:
    """The types that each file of text declares; one may need those of another.

    A file that cannot be read declares none here: it is refused when it is read whole.
    """
    texts: dict[Path, str] = {}
    for path in paths if len(paths) > 1 else ():
        if path.suffix.lower() not in (*STATEMENT_LIST, ".xml", ".csv"):
            with suppress(Unjudged):
                texts[path] = _plain(_bytes(path, {}), path)
    found: dict[Path, KnownTypes] = {}
    owner: dict[str, Path] = {}
    for number in range(len(texts)):
        before, found = found, {}
        for path, text in texts.items():
            apart = {name: kind for other in before if other != path for name, kind in before[other].items()}
            with suppress(Unjudged):
                found[path] = types_in(text, str(path), apart)
            for name in found.get(path, ()) if number == 0 else ():
                if owner.setdefault(name, path) != path:
                    raise Unjudged(f"{path}: the type {name} is in {owner[name]} too; give one of them")
        if found == before:
            break
    return found


def _plain(text: bytes, path: Path) -> str:
    """Structured Text. Raises Unjudged."""
    try:
        plain = text.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise Unjudged(f"{path}: byte {error.start} is not UTF-8") from None
    return structured_text(plain, str(path)) if path.suffix.lower() == ".scl" else plain


def _read(
    text: bytes, path: Path, types: KnownTypes
) -> tuple[Sequence[tuple[Unit, Lower | None]], Mapping[str, Unjudged]]:
    if path.suffix.lower() == ".xml":
        return read_plcopen(text, str(path))
    if path.suffix.lower() in STATEMENT_LIST:
        return [(unit, None) for unit in read_awl(path)], {}
    units = read_text(_plain(text, path), str(path), types)
    if path.suffix.lower() == ".scl":
        units = [replace(unit, fresh=False) for unit in units]
        doubtful = open_at_power_up(text.decode("utf-8-sig"))
        units = [
            replace(unit, notes=(NOT_KEPT.format(unit.name),)) if unit.name.upper() in doubtful else unit
            for unit in units
        ]
    return [(unit, None) for unit in units], {}
