"""Siemens SCL into Structured Text: a pass over the text that keeps every line where it is.

`#name` and, in declarations and calls, `"name"` become names; REGION lines, attributes in braces that change
nothing, VERSION, TITLE and BEGIN go; TON_TIME is TON, and W#16#FF is WORD#16#FF. Comments and strings are
left alone. The rest is Structured Text.
"""

from __future__ import annotations

import re

from programs.language.tree import Place

TIMERS = {"TON_TIME": "TON", "TOF_TIME": "TOF", "TP_TIME": "TP"}
HEADS = ("FUNCTION_BLOCK", "PROGRAM", "FUNCTION", "ORGANIZATION_BLOCK", "TYPE", "DATA_BLOCK")
PREFIXES = {"W#": "WORD#", "DW#": "DWORD#", "B#": "BYTE#"}
_TOKEN = re.compile(
    r"""
    (?P<comment> //[^\n]* | \(\*.*?\*\) | /\*.*?\*/ )
    | (?P<string> '(?:\$.|[^'$\n])*' )
    | (?P<open> \(\* | /\* | ' )
    | (?P<quoted> "[^"\n]*"? )
    | (?P<attributes> \{ (?: '(?:\$.|[^'$])*' | [^{}'] )* \} )
    | (?P<region> ^[ \t]*(?:END_)?REGION\b[^\n]* )
    | (?P<begin> ^[ \t]*BEGIN\b )
    | (?P<about> ^[ \t]*(?:(?:VERSION|AUTHOR|FAMILY|NAME)[ \t]*:(?!=)|TITLE[ \t]*=|KNOW_HOW_PROTECT)[^\n]*$ )
    | (?P<prefix> \b(?:W|DW|B)\#(?=[0-9]) )
    | (?P<timer> \b(?:TON|TOF|TP)_TIME\b )
    | (?P<literal> \b\w+\#[\w.#+-]* )
    | (?P<hash> \#(?=[A-Za-z_"]) )
    | (?P<stray> [{}#] )
    | (?P<word> \w+ ) | .
    """,
    re.VERBOSE | re.DOTALL | re.MULTILINE | re.IGNORECASE,
)  # fmt: skip
_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_ATTRIBUTE = re.compile(r"\s*(\w+)\s*:=\s*'((?:\$.|[^'$])*)'\s*", re.ASCII)
_DROPPED = frozenset({
    "s7_optimized_access", "externalaccessible", "externalvisible", "externalwritable", "instructionname",
    "libversion", "s7_m_c", "s7_shortcut", "s7_unit", "s7_visible", "s7_dynamic", "s7_param", "s7_link",
    "s7_string_0", "s7_string_1", "s7_tasklist", "s7_blockview", "s7_setpoint",
})  # fmt: skip
"""How data are kept and shown. What some mean at power-up, `_set_later` and `open_at_power_up` say."""


def structured_text(text: str, file: str) -> str:
    """SCL as Structured Text with the same lines. Raises Unjudged with the line."""
    line = 1
    parts: list[str] = []
    header = declares = typed = False  # typed: between TYPE and what is behind the name
    declared: set[str] = set()
    before = None
    for match in _TOKEN.finditer(text):
        found, kind = match[0], match.lastgroup
        if kind == "word" and found.upper() in HEADS:
            header, declared = True, set()
        elif kind == "begin" or (kind == "word" and found.upper().startswith(("VAR", "STRUCT"))):
            header, declares = False, kind == "word"
        elif kind == "word" and found.upper() in ("END_VAR", "END_STRUCT"):
            declares = False
        elif kind == "about" and not header:
            raise Place(file, line).refuse(f"{found.split()[0]} is understood in the head of a block only")
        elif declares and kind in ("word", "quoted"):
            declared.add(found.strip('"').upper())
        elif kind == "quoted" and before != "hash" and not header and _is_global(match, declared):
            raise Place(file, line).refuse(f"{found} is a global name, and those are not supported; #name?")
        if kind == "attributes" and _set_later(found):  # before the name, where Structured Text has it
            name = next((n for n in range(len(parts) - 1, -1, -1) if parts[n].strip()), 0)
            parts.insert(name, "{attribute 'TcInitSymbol'}")
        before = kind
        if kind == "word" and found.upper() == "TYPE":
            typed = True
        elif typed and (found == ":" or found.upper() in ("STRUCT", "END_TYPE")):
            parts.append(": " * (found.upper() == "STRUCT"))
            typed = False
        parts.append(_changed(found, kind or "", Place(file, line)))
        line += found.count("\n")
    return "".join(parts)


def open_at_power_up(text: str) -> set[str]:
    """The function blocks, in upper case, whose retention is not declared in the source.

    Without optimized access it is an attribute of the instance data block.
    """
    found: set[str] = set()
    block, named = "", False
    for match in _TOKEN.finditer(text):
        kind, word = match.lastgroup, match[0].strip('"').upper()
        if kind == "word" and word in HEADS:
            block, named = "", word == "FUNCTION_BLOCK"
        elif kind in ("word", "quoted") and named:
            block, named = word, False
            found.add(block)
        elif kind == "attributes" and any(
            (name.lower(), value.upper()) == ("s7_optimized_access", "TRUE")
            for name, value in _ATTRIBUTE.findall(match[0])
        ):
            found.discard(block)
    return found


def _set_later(found: str) -> bool:
    """Whether attributes say that the first value of a variable is one that was set at commissioning."""
    given = _ATTRIBUTE.findall(found)
    return any(name.lower() == "s7_setpoint" and value.lower() != "false" for name, value in given)


def _attributes(found: str, place: Place) -> str:
    """The line breaks of attributes that change nothing. Raises Unjudged for others."""
    left = _ATTRIBUTE.sub("", found[1:-1]).replace(";", "").strip()
    for name, _ in _ATTRIBUTE.findall(found):
        if name.lower() not in _DROPPED:
            raise place.refuse(f"attribute {name} may change what the program does; take it out")
    if left:
        raise place.refuse(f"{' '.join(found.split())[:40]}: NAME := 'value' is understood in braces")
    return "\n" * found.count("\n")


def _is_global(match: re.Match[str], declared: set[str]) -> bool:
    """Whether a quoted name in a body is no function of ours: what is declared in the block has a #."""
    called = match.string[match.end() :].lstrip().startswith("(")
    return not called or match[0].strip('"').upper() in declared


def _changed(found: str, kind: str, place: Place) -> str:
    match kind:
        case "region" if ":=" in found or found.rstrip().endswith(";"):
            raise place.refuse(f"{found.split()[0]}: a statement in this line would be lost")
        case "attributes":
            return _attributes(found, place)
        case "region" | "begin" | "about":
            return "\n" * found.count("\n")
        case "hash":
            return ""
        case "quoted":
            if not _NAME.fullmatch(found.strip('"')) or not found.endswith('"') or len(found) < 3:
                raise place.refuse(f"{found}: a name with other characters than letters and digits")
            return found.strip('"')
        case "prefix":
            return PREFIXES[found.upper()]
        case "timer":
            return TIMERS[found.upper()]
        case "open":
            raise place.refuse(f"{found} begins something that does not end")
        case "stray":
            raise place.refuse(f"{found!r} is not expected here")
        case "comment" if found.startswith("/*"):
            return f"(*{found[2:-2]}*)"
    return found
