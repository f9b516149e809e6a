"""Sources of TIA Portal (.scl, .db, .udt) block by block, and its tables of PLC tags (.xml).

Each block is read by itself, so that one that cannot be read does not keep the others from being read. A data
block is a list of globals with its name, or, of a type or of a function block, one global with its name. It
keeps its values without power unless it says NON_RETAIN. A tag is a global at its address.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from modeproof.ground.errors import Unjudged
from programs.language.tree import Array, Place, Scalar, Struct, Type, Variable, shown
from programs.readers.plcopen.xml_tree import Element, read_xml
from programs.readers.scl import HEADS, TOKEN, named, structured_text
from programs.readers.structured_text.types_and_values import Known
from programs.readers.structured_text.units import read_all

SUFFIXES = (".scl", ".db", ".udt")
TABLES = (b"SW.Tags.PlcTagTable", b"<Tagtable")
"""One of these is in a table of tags."""
_SET = re.compile(r"[\s;]*((?:\"[^\"\n]*\"|[^\s:;\"])+)\s*:=\s*([^;]+);")
_STEP = re.compile(r"(\"[^\"]*\"|[^\W\d]\w*)|\[\s*(-?\d+)\s*\]")
Value = tuple[str, str, Place]
"""A path in a data block, the value that it has first, and where that is said."""
_QUIET = ("comment", "about", "attributes")


@dataclass(frozen=True)
class Block:
    """One block of a source: its text with the lines of the file.

    list: of a data block, the list of globals that it is.
    words: those in it, as they are here, in upper case; none where it carries out nothing.
    """

    kind: str
    name: str
    text: str
    words: frozenset[str]
    list: str = ""
    values: tuple[Value, ...] = ()
    refused: Unjudged | None = None


def blocks(text: str, file: str) -> list[Block]:
    """The blocks of a source as Structured Text. Raises Unjudged: there is something else in it."""
    return [_block(kind, name, part, line, file) for kind, name, part, line in _apart(text, file)]


def _apart(text: str, file: str) -> Iterator[tuple[str, str, str, int]]:
    """Kind, name, text and first line of each block."""
    kind, name, start, line, first = "", "", 0, 1, 1
    for match in TOKEN.finditer(text):
        word = match[0].upper()
        if not kind and match.lastgroup == "word" and word in HEADS:
            kind, start, first = word, match.start(), line
        elif not kind and match[0].strip(" \t\r\n;") and match.lastgroup not in _QUIET:
            shown = " ".join(match[0].split())[:40]
            raise Place(file, line).refuse(f"{shown!r} is in no block of SCL")
        elif kind and not name and match.lastgroup in ("word", "quoted"):
            name = named(match[0].strip('"'))
        elif kind and match.lastgroup == "word" and word == f"END_{kind}":
            yield kind, name, text[start : match.end()], first
            kind = name = ""
        line += match[0].count("\n")
    if kind:
        raise Place(file, first).refuse(f"{kind} {name} does not end")


def _block(kind: str, name: str, text: str, line: int, file: str) -> Block:
    lines = "\n" * (line - 1)
    words = frozenset[str]()
    if kind not in ("TYPE", "DATA_BLOCK"):
        tokens = (match[0] for match in TOKEN.finditer(text) if match.lastgroup in ("word", "quoted"))
        words = frozenset(named(token.strip('"')).upper() for token in tokens)
    try:
        if kind == "DATA_BLOCK":
            text, group, values = _data_block(lines + text, name, file)
            return Block(kind, name, structured_text(text, file), words, group, values)
        return Block(kind, name, structured_text(lines + text, file), words)
    except Unjudged as error:
        return Block(kind, name, "", words, refused=error)


# ---------------------------------------------------------------- data blocks


def _data_block(text: str, name: str, file: str) -> tuple[str, str, tuple[Value, ...]]:
    """A data block as globals in SCL, the list to which they belong, and the first values behind BEGIN."""
    parts: list[str] = []
    retains, depth, group, line, heading, begun = " RETAIN", 0, "", 1, 0, 0
    matches = list(TOKEN.finditer(text))
    for n, match in enumerate(matches):
        found, kind = match[0], match.lastgroup
        word = found.upper() if kind in ("word", "quoted", "timer") else ""
        here = Place(file, line)
        line += found.count("\n")
        if kind == "begin" or word == "END_DATA_BLOCK":
            begun = n
            break
        if word == "DATA_BLOCK" or heading == 1:
            heading += bool(word)
            parts.append("\n" * found.count("\n"))
        elif not group and not depth and word == "NON_RETAIN":
            retains = ""
        elif not group and not depth and kind == "about":
            parts.append("\n" * found.count("\n"))
        elif not group and not depth and word in ("VAR", "STRUCT"):
            group, depth = name, 1
            parts.append(f"VAR_GLOBAL{retains if _next(matches, n) != 'RETAIN' else ''}")
        elif not group and word:
            group = "?"
            parts.append(f"VAR_GLOBAL{retains} {name} : {found}; END_VAR")
        elif word == "VAR" and depth == 0:
            depth = 1
            parts.append(f"VAR_GLOBAL{retains if _next(matches, n) != 'RETAIN' else ''}")
        elif word == "STRUCT":
            depth += 1
            parts.append(found)
        elif word in ("END_STRUCT", "END_VAR"):
            depth -= 1
            parts.append(found if depth or word == "END_VAR" else "END_VAR")
        elif group == "?" and found.strip(" \t\r\n;") and kind not in _QUIET:
            raise here.refuse(f"data block {name}: {found} is not expected here")
        else:
            parts.append(
                found if group != "?" and not (found == ";" and not depth) else "\n" * found.count("\n")
            )
    if not group:
        raise Place(file, line).refuse(f"data block {name} has no content that is known")
    values = _values(matches[begun:] if begun else [], name, line, file)
    return "".join(parts), "" if group == "?" else group, values


def _next(matches: list[re.Match[str]], n: int) -> str:
    """The word behind this one."""
    return next((match[0].upper() for match in matches[n + 1 :] if match[0].strip()), "")


def _values(behind: list[re.Match[str]], name: str, line: int, file: str) -> tuple[Value, ...]:
    """What is behind BEGIN: paths and values."""
    text = "".join(
        match[0] if match.lastgroup != "comment" else "\n" * match[0].count("\n")
        for match in behind
        if match.lastgroup != "begin" and match[0].upper() != "END_DATA_BLOCK"
    )
    found: list[Value] = []
    while text.strip(" \t\r\n;"):
        match = _SET.match(text)
        if match is None:
            shown = " ".join(text.split())[:40]
            raise Place(file, line).refuse(f"data block {name}: this first value is not read here: {shown}")
        line += text.count("\n", 0, match.start(1))
        found.append((match[1], match[2].strip(), Place(file, line)))
        line += text.count("\n", match.start(1), match.end())
        text = text[match.end() :]
    return tuple(found)


def with_values(block: Block, declared: list[Variable], known: Known) -> list[Variable]:
    """The globals of a data block with the first values that are behind BEGIN. Raises Unjudged."""
    found = {one.name.upper(): one for one in declared}
    for path, value, place in block.values:
        steps = [
            number or named(word.strip('"')).upper()
            for word, number in _STEP.findall(path.replace(",", "]["))
        ]
        if not block.list:
            steps.insert(0, block.name.upper())
        if (one := found.get(str(steps[0]))) is None:
            raise place.refuse(f"data block {block.name} has no {path}")

        def read(kind: Scalar, value: str = value, place: Place = place) -> object:
            text = "\n" * (place.line - 1) + f"VAR_GLOBAL v : {kind.name} := {value}; END_VAR"
            return read_all(structured_text(text, place.file), place.file, known).globals[0].initial

        initial = _put(one.type, one.initial, steps[1:], read, place)
        found[one.name.upper()] = replace(one, initial=initial)
    return list(found.values())


def _put(
    kind: Type, initial: object, steps: list[str], read: Callable[[Scalar], object], place: Place
) -> object:
    """An initial value in which one single value is another."""
    if isinstance(kind, Scalar) and not steps:
        return read(kind)
    if isinstance(kind, Array) and steps and steps[0].lstrip("-").isdigit():
        number, size = int(steps[0]) - kind.low, kind.high - kind.low + 1
        given = list(initial) if isinstance(initial, tuple) else []
        given += [None] * (size - len(given))
        if 0 <= number < size:
            given[number] = _put(kind.element, given[number], steps[1:], read, place)
            return tuple(given)
    if isinstance(kind, Struct) and steps:
        own = dict(initial) if isinstance(initial, tuple) else {}
        for name, inner, value in kind.members:
            if name.upper() == steps[0]:
                own[steps[0]] = _put(inner, own.get(steps[0], value), steps[1:], read, place)
                return tuple(own.items())
    raise place.refuse(f"this first value is not read here: it is of {shown(kind)}")


# ---------------------------------------------------------------- tags


def tags(content: bytes, file: str) -> str | None:
    """A table of PLC tags as globals in Structured Text; None: the file is none. Raises Unjudged."""
    if not any(sign in content for sign in TABLES):
        return None
    root = read_xml(content, file)
    lines: list[str] = []
    for place, name, kind, address, value in _tags(root):
        if not name or not re.fullmatch(r"[A-Za-z_]\w*", kind, re.ASCII):
            raise place.refuse(f"tag {name or '?'}: a name and an elementary type are needed")
        at = f" AT {address}" if address else ""
        first = f" := {value}" if value else ""
        lines += [""] * (place.line - len(lines))
        section = "VAR_GLOBAL CONSTANT" if value else "VAR_GLOBAL"
        lines[-1] += f" {section} {named(name)}{at} : {kind}{first}; END_VAR"
    return "\n".join(lines)


def _tags(root: Element) -> Iterator[tuple[Place, str, str, str, str]]:
    """Where each is, its name, type, address, and value of a constant."""
    for tag in root.below("Tag"):  # saved by hand from the table
        yield tag.place, tag.text.strip(), tag.get("type"), tag.get("addr").upper(), ""
    for kind in ("SW.Tags.PlcTag", "SW.Tags.PlcUserConstant"):  # by Openness
        for tag in root.below(kind):
            given = {
                one.name: one.text.strip() for group in tag.all("AttributeList") for one in group.children
            }
            value = given.get("Value", "") if kind.endswith("Constant") else ""
            address = given.get("LogicalAddress", "").upper()
            yield tag.place, given.get("Name", ""), given.get("DataTypeName", ""), address, value
