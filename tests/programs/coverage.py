"""What of a folder of foreign programs is read and translated, and what is refused and why."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from modeproof.ground.errors import Unjudged
from programs.language.subset import check
from programs.language.tree import (
    BOOL,
    Assign,
    Call,
    Function,
    Instance,
    Name,
    Source,
    Statement,
    Unit,
    Variable,
)
from programs.readers.plcopen.project import read_plcopen
from programs.readers.scl import structured_text
from programs.readers.structured_text.units import read_text
from programs.semantics.document_blocks import with_blocks
from tests.programs.fuzz import difference_of_translator

SCANS = 12
_UNIT = re.compile(
    r"^[ \t]*(?P<kind>FUNCTION_BLOCK|PROGRAM|FUNCTION|TYPE|ORGANIZATION_BLOCK|DATA_BLOCK)\b.*?"
    r"^[ \t]*END_(?P=kind)\b[ \t]*;?",
    re.MULTILINE | re.DOTALL | re.IGNORECASE,
)
_NUMBERS = re.compile(r"'[^']*'|\b\d+\b|16#\w+")


@dataclass(frozen=True)
class Piece:
    """One block, function or type of a file."""

    kind: str
    text: str
    file: str

    @property
    def plain(self) -> str:
        """Structured Text. Raises Unjudged for SCL that cannot be read so."""
        return structured_text(self.text, self.file) if self.file.lower().endswith(".scl") else self.text


def pieces(path: Path) -> Iterator[Piece]:
    """The units of a file of text or of TwinCAT."""
    text = path.read_text("utf-8-sig", "replace")
    if path.suffix.lower() in (".st", ".scl", ".exp", ".txt"):
        for found in _UNIT.finditer(text):
            yield Piece(found["kind"].upper(), found[0], path.name)
    elif path.suffix in (".TcPOU", ".TcDUT"):
        node = ElementTree.fromstring(text)
        declared = node.findtext(".//Declaration") or ""
        body = node.findtext("./POU/Implementation/ST")
        word = re.search(r"\b(FUNCTION_BLOCK|PROGRAM|FUNCTION|TYPE)\b", declared)
        if word is not None:
            more = "\n(* graphical *) NETWORK;" if body is None and word[0] != "TYPE" else body or ""
            end = "" if word[0] == "TYPE" else f"\nEND_{word[0]}"
            yield Piece(word[0], f"{declared}\n{more}{end}\n", path.name)


def project(path: Path) -> tuple[dict[str, Unit], dict[str, str]] | None:
    """The units of a file that is PLCopen XML, and why others are refused; None: it is something else."""
    try:
        read = read_plcopen(path.read_bytes(), path.name)
    except Unjudged:
        return None
    found, refused = read.units, read.refused
    units = {unit.name.upper(): unit for unit, _ in found}
    declared = Source(dict(units), {})
    causes = {name: _cause(error) for name, error in refused.items()}
    for unit, lower in found:
        try:
            units[unit.name.upper()] = lower(declared)
        except Unjudged as error:
            causes[unit.name.upper()] = _cause(error)
            del units[unit.name.upper()]
    return units, causes


@dataclass
class Collection:
    """A folder. `wrong`: blocks for which interpreter and terms do not agree."""

    folder: Path
    projects: dict[str, Source] = field(default_factory=dict)
    """For each block of a project of PLCopen XML the blocks of that project; the rest know each other."""
    reasons: Counter[str] = field(default_factory=Counter)
    translated: list[str] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)

    @cached_property
    def pieces(self) -> list[Piece]:
        """All units of all files."""
        files = sorted(path for path in self.folder.rglob("*") if path.is_file())
        return [piece for path in files for piece in pieces(path)]

    @cached_property
    def units(self) -> dict[str, Unit | str]:
        """Each block that was read, or why not, by its name; functions as far as they are supported."""
        known = {
            _type_name(piece.text): piece for piece in self.pieces if piece.kind == "TYPE" and _reads(piece)
        }
        types = "\n".join(piece.plain for piece in known.values())
        found: dict[str, Unit | str] = {}
        for piece in self.pieces:
            if piece.kind not in ("FUNCTION_BLOCK", "PROGRAM", "FUNCTION"):
                continue
            name = f"{piece.kind} {_name(piece.text)}"
            try:
                unit = read_text(f"{types}\n{piece.plain}", piece.file)[-1]
                found[name] = unit
            except Unjudged as error:
                found[name] = _cause(error)
            except RecursionError:
                found[name] = "nested too deeply"
        for path in sorted(self.folder.rglob("*.xml")):
            if not path.is_file() or (there := project(path)) is None:
                continue
            units, causes = there
            for key, what in (units | causes).items():
                name = f"POU {path.relative_to(self.folder)}: {key}"
                found[name], self.projects[name] = what, Source(units, {})
        return found

    def judge(self) -> None:
        """Translate each block with all that were read, and run both sides."""
        source = Source(
            {
                unit.name.upper(): unit
                for name, unit in self.units.items()
                if isinstance(unit, Unit) and name not in self.projects
            },
            {},
        )
        for name, unit in self.units.items():
            if isinstance(unit, str):
                self.reasons[unit] += 1
                continue
            try:
                whole = with_blocks(self.projects.get(name, source))
                unit = caller(unit) if unit.kind == "function" or unit.of("in_out") else unit
                check(whole, unit)
                difference = difference_of_translator(whole, unit, 1, SCANS)
            except Unjudged as error:
                self.reasons[_cause(error)] += 1
                continue
            self.translated.append(name)
            if difference:
                self.wrong.append(f"{name}: {difference}")


def caller(unit: Unit) -> Unit:
    """A block with the inputs of a FUNCTION, or of a block with VAR_IN_OUT, that calls it."""
    place = unit.place
    variables = {
        key: Variable(found.name, found.type, "input" if found.section == "input" else "var", None, place)
        for key, found in unit.variables.items()
        if found.section in ("input", "in_out")
    }
    given = tuple((found.name, Name(found.name, place)) for found in variables.values())
    body: Statement
    if unit.kind == "function" and (unit.of("in_out") or unit.name.upper() not in unit.variables):
        variables["DONE"] = Variable("DONE", BOOL, "output", None, place)
        body = Call(Name(unit.name, place), given, (), place)
    elif unit.kind == "function":
        result = unit.variables[unit.name.upper()].type
        variables["RESULT_OF_CALL"] = Variable("RESULT_OF_CALL", result, "output", None, place)
        called = Function(unit.name.upper(), tuple((name.upper(), value) for name, value in given), place)
        body = Assign(Name("RESULT_OF_CALL", place), called, place)
    else:
        variables["CALLED"] = Variable("CALLED", Instance(unit.name), "var", None, place)
        variables["DONE"] = Variable("DONE", BOOL, "output", None, place)
        body = Call(Name("CALLED", place), given, (), place)
    return Unit(f"caller of {unit.name}", "function block", variables, (body,), place, unit.enumerations)


def _reads(piece: Piece) -> bool:
    try:
        read_text(piece.plain, piece.file)
    except Unjudged:
        return False
    return True


def _name(text: str) -> str:
    found = re.search(
        r"\b(?:FUNCTION_BLOCK|PROGRAM|FUNCTION)\s+(?:PUBLIC\s+|INTERNAL\s+)?\"?(\w+)", text, re.I
    )
    return found[1] if found else "?"


def _type_name(text: str) -> str:
    """The first name that a text with types declares; a collection may declare a type in several files."""
    found = re.search(r"\bTYPE\s+(\w+)", text, re.I)
    return found[1].upper() if found else text


def _cause(error: Unjudged) -> str:
    """The refusal without file, line and names."""
    text = error.message.partition(": ")[2] or error.message
    text = re.sub(r"^(.*?) is not supported.*", r"\1 is not supported", text)
    text = re.sub(r"; did you mean.*|; allowed.*", "", text)
    return _NUMBERS.sub("..", text)[:70]


def table(collection: Collection) -> Iterator[str]:
    """The figures in lines."""
    units = collection.units
    collection.judge()
    read = sum(isinstance(unit, Unit) for unit in units.values())
    translated = len(collection.translated)
    yield f"{collection.folder.name}: {len(units)} units, {read} read, {translated} translated"
    for kind in ("FUNCTION_BLOCK", "PROGRAM", "FUNCTION", "POU"):
        of = [name for name in units if name.startswith(f"{kind} ")]
        there = [name for name in collection.translated if name.startswith(f"{kind} ")]
        yield f"  {kind:<16} {len(there)} of {len(of)}"
    for reason, number in collection.reasons.most_common(25):
        yield f"  {number:>4} {reason}"
    for wrong in collection.wrong:
        yield f"  WRONG {wrong}"
