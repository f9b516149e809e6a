"""Siemens SCL into Structured Text: a pass over the text that keeps every line where it is.

`#name` and `"name"` become names, with `_` for what Structured Text does not have in a name; REGION lines,
attributes in braces that change nothing, VERSION, TITLE and BEGIN go; TON_TIME is TON, and W#16#FF is
WORD#16#FF; `a += b` is `a := a + (b)`, and an ORGANIZATION_BLOCK is a PROGRAM. Comments and strings are left
alone. The rest is Structured Text.
"""

from __future__ import annotations

import re

from programs.language.tree import Place

TIMERS = {"TON_TIME": "TON", "TOF_TIME": "TOF", "TP_TIME": "TP"}
HEADS = ("FUNCTION_BLOCK", "PROGRAM", "FUNCTION", "ORGANIZATION_BLOCK", "TYPE", "DATA_BLOCK")
UNITS = {"ORGANIZATION_BLOCK": "PROGRAM", "END_ORGANIZATION_BLOCK": "END_PROGRAM"}
BEFORE_STATEMENTS = (";", ":", "THEN", "ELSE", "DO", "REPEAT")
PREFIXES = {"W#": "WORD#", "DW#": "DWORD#", "B#": "BYTE#"}
TOKEN = re.compile(
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
    | (?P<hash> \#(?=[^\W\d]|") )
    | (?P<update> [-+*/]= )
    | (?P<stray> [{}#] )
    | (?P<word> \w+ ) | .
    """,
    re.VERBOSE | re.DOTALL | re.MULTILINE | re.IGNORECASE,
)  # fmt: skip
_ATTRIBUTE = re.compile(r"\s*(\w+)\s*:=\s*'((?:\$.|[^'$])*)'\s*", re.ASCII)
DROPPED = frozenset({
    "s7_optimized_access", "externalaccessible", "externalvisible", "externalwritable", "instructionname",
    "libversion", "s7_m_c", "s7_shortcut", "s7_unit", "s7_visible", "s7_dynamic", "s7_param", "s7_link",
    "s7_string_0", "s7_string_1", "s7_tasklist", "s7_blockview", "s7_setpoint",
})  # fmt: skip
"""How data are kept and shown. What some mean at power-up, `_set_later` and `open_at_power_up` say."""
_CLIENTS = ("db_accessible_from_opc_ua", "db_accessible_from_webserver")


def named(text: str) -> str:
    """A name of TIA, without quotation marks, as one of Structured Text. `names_of` sees two that are one."""
    plain = re.sub(r"[^A-Za-z0-9_]", "_", text)
    return f"_{plain}" if plain[:1].isdigit() else plain


def names_of(text: str) -> dict[str, str]:
    """The names and words of a text that are written otherwise here, by what they become in upper case."""
    found: dict[str, str] = {}
    for match in TOKEN.finditer(text):
        if match.lastgroup in ("quoted", "word"):
            found.setdefault(named(match[0].strip('"')).upper(), match[0].strip('"').upper())
    return found


def structured_text(text: str, file: str) -> str:
    """SCL as Structured Text with the same lines. Raises Unjudged with the line."""
    line = 1
    parts: list[str] = []
    header = declares = typed = updates = False  # typed: between TYPE and what is behind the name
    declared: set[str] = set()
    before, begin, names = None, 0, True  # names: what is declared comes next, not its type
    for match in TOKEN.finditer(text):
        found, kind = match[0], match.lastgroup
        if kind == "word" and found.upper() in HEADS:
            header, declared = True, set()
        elif kind == "begin" or (kind == "word" and found.upper().startswith(("VAR", "STRUCT"))):
            header, declares, names = False, kind == "word", True
        elif kind == "word" and found.upper() in ("END_VAR", "END_STRUCT"):
            declares = False
        elif kind == "about" and not header:
            raise Place(file, line).refuse(f"{found.split()[0]} is understood in the head of a block only")
        elif declares and found in (";", ":"):
            names = found == ";"
        elif declares and names and kind in ("word", "quoted"):
            declared.add(found.strip('"').upper())
        elif (
            kind == "quoted"
            and before != "hash"
            and not (header or declares)
            and _hides(found, declared, parts)
        ):
            text = f"{found} is a global name, and the block declares one of its own: rename one, or #name?"
            raise Place(file, line).refuse(text)
        if kind == "attributes" and _set_later(found):  # before the name, where Structured Text has it
            name = next((n for n in range(len(parts) - 1, -1, -1) if parts[n].strip()), 0)
            parts.insert(name, "{attribute 'TcInitSymbol'}")
        before = kind
        if kind == "word" and found.upper() == "TYPE":
            typed = True
        elif typed and (found == ":" or found.upper() in ("STRUCT", "END_TYPE")):
            parts.append(": " * (found.upper() == "STRUCT"))
            typed = False
        if kind == "update":
            target = "".join(part for part in parts[begin:] if not part.startswith(("//", "(*")))
            parts.append(f":= {' '.join(target.split())} {found[0]} (")
            updates = True
            continue
        if updates and found == ";":
            parts.append(")")
            updates = False
        parts.append(_changed(found, kind or "", Place(file, line)))
        if kind in ("begin", "region") or found.upper() in BEFORE_STATEMENTS:
            begin = len(parts)
        line += found.count("\n")
    return "".join(parts)


def open_at_power_up(text: str) -> set[str]:
    """The function blocks, in upper case, whose retention is not declared in the source.

    Without optimized access it is an attribute of the instance data block.
    """
    found: set[str] = set()
    block, heading = "", False
    for match in TOKEN.finditer(text):
        kind, word = match.lastgroup, named(match[0].strip('"')).upper()
        if kind == "word" and word in HEADS:
            block, heading = "", word == "FUNCTION_BLOCK"
        elif kind in ("word", "quoted") and heading:
            block, heading = word, False
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
    for name, value in _ATTRIBUTE.findall(found):
        if name.lower() in _CLIENTS and value.lower() != "false":
            raise place.refuse(f"attribute {name} lets a client write the data: set it to 'FALSE'")
        if name.lower() not in (*DROPPED, *_CLIENTS):
            raise place.refuse(f"attribute {name} may change what the program does; take it out")
    if left:
        raise place.refuse(f"{' '.join(found.split())[:40]}: NAME := 'value' is understood in braces")
    return "\n" * found.count("\n")


def _hides(found: str, declared: set[str], parts: list[str]) -> bool:
    """Whether a quoted name in a body is that of a variable of the block too, which would have a #."""
    behind = next((part for part in reversed(parts) if part.strip()), "")
    return behind != "." and found.strip('"').upper() in declared


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
            if not found.endswith('"') or not found.strip('" '):
                raise place.refuse(f"{found}: a name in quotation marks does not end")
            return named(found.strip('"'))
        case "word":
            return UNITS.get(found.upper(), named(found) if not found.isascii() else found)
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
