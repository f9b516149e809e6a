"""What the grammar cannot read in declarations: a pass over the text that keeps every line where it is.

Initial values of arrays and structures, and lists of names in a structure, are taken out of the
text and kept by the place where they were. What is not asked for again is refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from programs.language.tree import Place

_TOKEN = re.compile(
    r"""
    (?P<comment> //[^\n]* | \(\*.*?\*\) | /\*.*?\*/ )
    | (?P<string> '(?:\$.|[^'$\n])*' | "(?:\$.|[^"$\n])*" )
    | (?P<word> [A-Za-z_]\w* )
    | (?P<value> :=\s*(?:\[|\(\s*[A-Za-z_]\w*\s*:=) )
    | (?P<end> ; ) | .
    """,
    re.VERBOSE | re.DOTALL | re.IGNORECASE,
)  # fmt: skip
_MEMBERS = re.compile(r"\s*([A-Za-z_]\w*)((?:\s*,\s*[A-Za-z_]\w*)+)\s*:(?!=)")
_FIELDS = re.compile(r"\(\s*[A-Za-z_]\w*\s*:=")
_REPEATED = re.compile(r"(\d[\d_]*)\s*\((.*)\)", re.DOTALL)
_COMMENT = re.compile(r"//[^\n]*|\(\*.*?\*\)|/\*.*?\*/", re.DOTALL)


@dataclass
class Declared:
    """The text for the grammar; what was taken out of it, by the byte of the text and with its line."""

    text: str
    values: dict[int, tuple[int, str]] = field(default_factory=dict)
    members: dict[int, tuple[int, list[str]]] = field(default_factory=dict)

    def value(self, behind: int) -> str | None:
        """The initial value that stood behind this byte, before the end of its declaration."""
        whole = self.text.encode("utf-8")
        for start in sorted(self.values):
            if start >= behind:
                near = b";" not in whole[behind:start]
                return self.values.pop(start)[1] if near else None
        return None

    def also(self, start: int) -> list[str]:
        """The further names of the member of a structure whose name begins here."""
        return self.members.pop(start, (0, []))[1]

    def refuse_rest(self, file: str) -> None:
        """Raises Unjudged for what nobody asked for."""
        for line, text in self.values.values():
            shown = " ".join(text.split())[:40]
            raise Place(file, line).refuse(f"this initial value is not supported here: {shown}")
        for line, names in self.members.values():
            raise Place(file, line).refuse(f"these names are not expected here: {', '.join(names)}")


def taken_apart(text: str, file: str) -> Declared:
    """The text without what the grammar does not know. Raises Unjudged with file and line."""
    made = Declared("")
    parts: list[str] = []
    at, inside, structures, start = 0, "", 0, False
    line, seen = 1, 0

    def here() -> int:
        return len("".join(parts).encode("utf-8"))

    while at < len(text):
        if start and (names := _MEMBERS.match(text, at)):
            head = names[0][: names.end(1) - at]
            parts.append(head)
            there = text.count("\n", 0, names.end(1)) + 1
            made.members[here() - len(names[1])] = there, re.findall(r"\w+", names[2])
            parts.append(_blank(names[2]) + text[names.end(2) : names.end()])
            at, start = names.end(), False
            continue
        match = _TOKEN.match(text, at)
        assert match is not None
        found, kind = match[0], match.lastgroup
        line, seen = line + text.count("\n", seen, at), at
        word = found.upper() if kind == "word" else ""
        if found.strip() and kind != "comment":
            start = False
        if word.startswith("VAR") or word == "TYPE":
            inside = inside or word
        elif word in ("END_VAR", "END_TYPE"):
            inside, structures = "", 0
        elif word == "STRUCT" and inside:
            structures, start = structures + 1, True
        elif kind == "end" and structures:
            start = True
        if word == "END_STRUCT" and inside:
            structures -= 1
            rest = _COMMENT.sub("", text[match.end() :]).lstrip()
            found += ";" * (not rest.startswith((";", ":=")))
            start = structures > 0
        elif kind == "value" and inside:
            end = _closed(text, at + 2, Place(file, line))
            made.values[here()] = line, _COMMENT.sub(" ", text[at + 2 : end])
            parts.append(_blank(text[at:end]))
            at = end
            continue
        parts.append(found)
        at = match.end()
    made.text = "".join(parts)
    return made


def _closed(text: str, at: int, place: Place) -> int:
    """Behind the bracket that closes the first one from here on."""
    depth = 0
    while (match := _TOKEN.match(text, at)) is not None:
        at = match.end()
        if match.lastgroup == "value":
            at = match.start() + 2
        elif match.lastgroup not in ("comment", "string"):
            depth += match[0].count("(") + match[0].count("[") - match[0].count(")") - match[0].count("]")
            if depth == 0 and match[0] in ")]":
                return at
            if match.lastgroup == "end":
                break
    raise place.refuse("an initial value has a bracket that is not closed")


def _blank(text: str) -> str:
    return " " + "\n" * text.count("\n")


# ---------------------------------------------------------------- initial values


def is_list(text: str) -> bool:
    """Whether the text is an initial value of an array."""
    return text.strip().startswith("[")


def is_fields(text: str) -> bool:
    """Whether the text is an initial value of a structure."""
    return _FIELDS.match(text.strip()) is not None


def elements(text: str, place: Place) -> list[str]:
    """The elements of `[1, 2(7)]`, repeated as it says."""
    return list(_repeated(_split(text.strip()[1:-1]), place))


def _repeated(parts: list[str], place: Place) -> Iterator[str]:
    for part in parts:
        again = _REPEATED.fullmatch(part.strip())
        if again is None:
            yield part.strip()
            continue
        times = int(again[1].replace("_", ""))
        if not 0 < times <= 1000:
            raise place.refuse(f"{times} times: 1 to 1,000 are possible")
        inner = list(_repeated(_split(again[2]), place))
        for _ in range(times):
            yield from inner


def named(text: str, place: Place) -> list[tuple[str, str]]:
    """The names and values of `(a := 1, b := 2)`."""
    found = []
    for part in _split(text.strip()[1:-1]):
        name, sign, value = part.partition(":=")
        if not sign or not value.strip():
            raise place.refuse(f"{part.strip()}: NAME := VALUE is needed here")
        found.append((name.strip(), value.strip()))
    return found


def _split(text: str) -> list[str]:
    """What is between the commas that are in no bracket."""
    found, depth, last = [], 0, 0
    for n, char in enumerate(text):
        depth += (char in "([") - (char in ")]")
        if char == "," and depth == 0:
            found.append(text[last:n])
            last = n + 1
    return [*found, text[last:]] if text.strip() else []
