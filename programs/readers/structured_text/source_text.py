"""A pass over Structured Text that keeps every line where it is: what the grammar does not know otherwise.

Comments of both kinds stay comments, pragmas that cannot change what is computed go, one that retains a
variable becomes a mark before it. `X.3` and `X.%X3` become a member that stands for a bit, USING is taken out
and kept. AND_THEN and OR_ELSE get a mark behind AND and OR.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from programs.language.addresses import ANYWHERE
from programs.language.tree import SCALARS, Place
from programs.readers.attributes import dropped, refusal, retained

BIT = "__BIT"
"""Begins the name that stands for a bit of a bit string; no other name may begin so."""
THEN = "(*\x01*)"
"""Behind AND and OR: the right side counts only where the left one leaves it open."""
RETAINS = "(*\x02*)"
"""Before a variable that holds any value at power-up."""
NO_RESULT = "VOID"
_PREFIXES = {*SCALARS, "T", "LTIME", "LT", "DATE", "D", "TOD", "DT"}
_TOKEN = re.compile(
    r"""
    (?P<comment> //[^\n]* | \(\*.*?\*\) | /\*.*?\*/ )
    | (?P<string> '(?:\$.|[^'$\n])*' | "(?:\$.|[^"$\n])*" )
    | (?P<open> \(\* | /\* )
    | (?P<pragma> \{[^{}]*\} )
    | (?P<time> \b(?:L?TIME|L?T)\#[\w.]+ )
    | (?P<member> \b[A-Za-z_]\w*\#(?=[A-Za-z_]) )
    | (?P<address> %[IQM](?:\*|\w*(?:\.\d+)*) )
    | (?P<number> \b\d[\w\#]*(?:\.\d\w*)? )
    | (?<=[\w\]])\.(?:%(?P<size>[A-Z]?))?(?P<bit>\d+)\b
    | (?P<using> \bUSING\s+[A-Za-z_][\w.,\s]*; )
    | (?P<retain> \b(?:RETAIN\s+PERSISTENT|PERSISTENT\s+RETAIN|PERSISTENT)\b )
    | (?P<head> \b(?:FUNCTION_BLOCK|FUNCTION)\s+(?:(?:PUBLIC|INTERNAL|PRIVATE|PROTECTED|FINAL)\s+)+ )
    | (?P<plain> \bFUNCTION\s+\w++(?=(?:\s|\(\*.*?\*\)|//[^\n]*\n)*+[^\s:;]) )
    | (?P<based> \)\s*(?:[US]?[SDL]?INT|BYTE|WORD|DWORD|LWORD)(?=\s*(?::=|;)) )
    | (?P<word> [A-Za-z_]\w* ) | .
    """,
    re.VERBOSE | re.DOTALL | re.IGNORECASE,
)  # fmt: skip
_SAID = re.compile(r"\{\s*(?:(?:end)?region|text|info|warning)\b.*\}", re.IGNORECASE | re.DOTALL)
"""What a compiler prints or folds."""
_ATTRIBUTE = re.compile(r"\{\s*attribute\s*'([^']*)'(?:\s*:=\s*'([^']*)')?\s*\}", re.IGNORECASE)


@dataclass(frozen=True)
class Using:
    """A namespace whose names a file uses without it."""

    namespace: str
    place: Place


def prepared(text: str, file: str) -> tuple[str, list[Using]]:
    """The text for the grammar, and what was behind USING. Raises Unjudged with file and line."""
    line, in_types = 1, False
    parts: list[str] = []
    using: list[Using] = []
    for match in _TOKEN.finditer(text):
        found, kind, place = match[0], match.lastgroup or "", Place(file, line)
        if kind == "word" and found.upper() in ("TYPE", "END_TYPE"):
            in_types = found.upper() == "TYPE"
        if kind == "using":
            names = re.sub(r"\s+", "", found.strip()[5:-1]).split(",")
            using += [Using(name, place) for name in names]
        parts.append(found if kind == "based" and not in_types else _changed(match, kind, place))
        line += found.count("\n")
    return "".join(parts), using


def _changed(match: re.Match[str], kind: str, place: Place) -> str:
    found = match[0]
    match kind:
        case "comment" if not found.startswith("//"):
            if any(mark in found[2:-2] for mark in ("(*", "/*")):
                raise place.refuse("a comment within a comment is not supported: compilers differ here")
            if found.startswith("/*"):
                return f"(*{found[2:-2].replace('*)', '* )')}*)"
        case "open":
            raise place.refuse(f"{found} begins a comment that does not end")
        case "pragma":
            return _pragma(found, place)
        case "address" if found.endswith("*"):
            return found[:-1] + ANYWHERE
        case "using" | "based":
            return _blank(found) if kind == "using" else ")" + _blank(found[1:])
        case "time":
            return found.replace("_", "")
        case "member" if found[:-1].upper() not in _PREFIXES:
            return f"{found[:-1]}."
        case "bit":
            if (match["size"] or "X").upper() != "X":
                raise place.refuse(f"{found}: bytes and words of a bit string are not supported: use SHR")
            return f".{BIT}{int(match['bit'])}"
        case "retain":
            return "RETAIN" + _blank(found)
        case "head":
            return found.split()[0] + " " + _blank(found)
        case "plain":
            return f"{found} : {NO_RESULT}"
        case "word" if found.upper() in ("AND_THEN", "OR_ELSE"):
            return found.partition("_")[0] + THEN
        case "word" if found.upper().startswith(BIT):
            raise place.refuse(f"{found}: give this another name")
    if "\x01" in found or "\x02" in found:
        raise place.refuse("a control character is not expected here")
    return found


def _pragma(found: str, place: Place) -> str:
    attribute = _ATTRIBUTE.fullmatch(found)
    if attribute is None and not _SAID.fullmatch(found):
        shown = " ".join(found.split())[:50]
        raise place.refuse(f"pragma {shown} may change what the program does; take it out")
    if attribute is not None and retained(attribute[1]):
        return RETAINS + _blank(found)
    if attribute is not None and not dropped(attribute[1], attribute[2] or ""):
        raise place.refuse(refusal(attribute[1]))
    return _blank(found)


def _blank(text: str) -> str:
    """The line breaks of a text."""
    return "\n" * text.count("\n") or " "
