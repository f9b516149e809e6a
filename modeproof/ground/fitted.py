"""Lines of a page that a person can read as text: none is longer than WIDTH, as far as it is prose.

A paragraph or an entry of a list is broken between words. A table with a row that is too wide becomes a list,
one entry a row. Code and tables of scans stay as they are.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from itertools import groupby

WIDTH = 160
"""Characters of a line, as it is read: where a link leads, and marks of the form, do not count."""
KEPT = {"```": "```", "<!-- begin trace": "<!-- end trace"}
"""What begins, and ends, lines that stay as they are."""
_LINK = re.compile(r"\]\([^)\s]*\)")
_ENTRY = re.compile(r"(\s*(?:[-*]|\d+\.)\s+)")
_KEPT = re.compile(r"^(?:```|<!--|#|\||\s*$|!?\[!?\[)")
_CELL = re.compile(r"(?<!\\)\|")


def visible(line: str) -> str:
    """What a reader sees of a line."""
    line = _LINK.sub("]", line)
    return re.sub(r"&nbsp;|<br>", " ", line).replace("**", "").replace("`", "")


def too_long(text: str) -> list[int]:
    """The numbers of the lines, from 1, that are longer than WIDTH; code and tables of scans do not count."""
    found, number = [], 0
    for kept, part in _parts(text):
        for line in part:
            number += 1
            if not kept and len(visible(line)) > WIDTH:
                found.append(number)
    return found


def fitted(text: str) -> str:
    """The page with lines that fit."""
    lines: list[str] = []
    for kept, part in _parts(text):
        if kept:
            lines += part
            continue
        for table, rows in groupby(part, lambda line: line.startswith("|")):
            block = list(rows)
            if table:
                lines += _table(block)
            else:
                for line in block:
                    lines += _line(line)
    return "\n".join(lines) + "\n"


def _parts(text: str) -> Iterator[tuple[bool, list[str]]]:
    """The lines, and whether they stay as they are: code in fences, and tables of scans between marks."""
    part: list[str] = []
    ends = ""
    for line in text.splitlines():
        begins = next((mark for mark in KEPT if not ends and line.lstrip().startswith(mark)), "")
        if begins:
            yield False, part
            part, ends = [], KEPT[begins]
        part.append(line)
        if ends and not begins and line.lstrip().startswith(ends):
            yield True, part
            part, ends = [], ""
    yield bool(ends), part


def _line(line: str) -> list[str]:
    if len(visible(line)) <= WIDTH or _KEPT.match(line):
        return [line]
    entry = _ENTRY.match(line)
    first = entry[0] if entry else re.match(r"\s*", line)[0]  # type: ignore[index]
    return _broken(line[len(first) :], first, " " * len(first))


def _broken(text: str, first: str, later: str) -> list[str]:
    """The text in lines; code between ticks may be broken too where it has blanks, links may not."""
    kept = re.sub(r"\[[^\]]*\]\([^)]*\)", lambda link: link[0].replace(" ", "\0"), text)
    found = textwrap.wrap(
        kept,
        WIDTH - 10,
        initial_indent=first,
        subsequent_indent=later,
        break_long_words=False,
        break_on_hyphens=False,
    )
    # A line that begins like an entry of a list or a heading would be read as one
    text_lines = [line.replace("\0", " ") for line in found]
    return [text_lines[0], *(re.sub(r"^(\s*)([-+#]|\d+\.) ", r"\1\\\2 ", line) for line in text_lines[1:])]


def _table(rows: list[str]) -> list[str]:
    """The table, or a list where a row is too wide: its first cell, and then the others by their headings."""
    if all(len(visible(row)) <= WIDTH for row in rows) or len(rows) < 3:
        return rows
    head, _, *others = [[cell.strip() for cell in _CELL.split(row)[1:-1]] for row in rows]
    lines: list[str] = []
    for cells in others:
        lines += _broken(f"**{cells[0].replace('**', '')}**", "- ", "  ")
        for name, cell in zip(head[1:], cells[1:], strict=False):
            if cell:
                lines += _broken(f"{name}: {cell}", "  - ", "    ")
    return lines
