"""One-edit mutants of a program in Structured Text, as texts."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from dataclasses import dataclass

SWAPS = {
    "AND": "OR", "OR": "AND", "NOT": "", "TRUE": "FALSE", "FALSE": "TRUE", "<>": "=", "<=": "<", ">=": ">",
    "<": "<=", ">": ">=", "ELSIF": None, "+": "-", "-": "+",
}  # fmt: skip
_TOKEN = re.compile(r"\(\*.*?\*\)|16#[0-9A-F]+|T#\d+ms|[A-Za-z_]\w*(?:\.\w+)?|\d+|:=|<>|<=|>=|=>|\S", re.S)
_KEYWORDS = {
    *SWAPS, "IF", "THEN", "ELSE", "END_IF", "CASE", "OF", "END_CASE", "RETURN", "SEL", "END_FUNCTION_BLOCK",
}  # fmt: skip


@dataclass(frozen=True)
class Mutant:
    """One edit: where, and what stands there instead."""

    file: str
    line: int
    old: str
    new: str
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.old!r} -> {self.new!r}"


def mutants(file: str, text: str, seed: int) -> Iterator[Mutant]:
    """All one-edit mutants of the body in a random order, each a text that may not be a program."""
    start = text.rindex("END_VAR") + len("END_VAR")
    flags = sorted(set(re.findall(r"(\w+)(?:\s*,\s*\w+)*\s*:\s*BOOL", text)))
    edits: list[tuple[int, int, str]] = []
    for token in _TOKEN.finditer(text, start):
        word = token[0]
        after = text[token.end() : token.end() + 3].lstrip()
        if word.startswith("(*"):
            continue
        if word.startswith("16#"):
            edits += [(token.start(), token.end(), f"16#{int(word[3:], 16) ^ bit:04X}") for bit in (1, 256)]
        elif word.startswith("T#"):
            edits.append((token.start(), token.end(), f"T#{int(word[2:-2]) + 1}ms"))
        elif word.isdigit():
            edits += [(token.start(), token.end(), str(int(word) + by)) for by in (1, -1)]
        elif SWAPS.get(word) is not None:
            edits.append((token.start(), token.end(), str(SWAPS[word])))
        elif word == "=":
            edits.append((token.start(), token.end(), "<>"))
        elif word[0].isalpha() and word not in _KEYWORDS and not after.startswith(("(", ":=", "=>")):
            edits.append((token.start(), token.end(), f"(NOT {word})"))
            if word in flags:
                edits += [(token.start(), token.end(), other) for other in flags if other != word][:2]
    for statement in re.finditer(r"(?<=[;\s])\w+ := [^;]*;", text[start:]):
        edits.append((start + statement.start(), start + statement.end(), ""))
    random.Random(seed).shuffle(edits)
    for low, high, new in edits:
        line = text.count("\n", 0, low) + 1
        yield Mutant(file, line, text[low:high], new, text[:low] + new + text[high:])
