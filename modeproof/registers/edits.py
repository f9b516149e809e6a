"""Edits that are to break a property or to refute a theorem: the text with an edit, and the stamps of edits.

A stamp is a hash of what the judgement of an edit rests on; pins.toml has a table of them for each kind.
"""

from __future__ import annotations

from collections.abc import Mapping

import tomlkit

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.registers.files import read_text
from modeproof.registers.pins import HEADER, load_pins
from modeproof.registers.rows import Document, Problem
from modeproof.registers.stale import stale


def applied(text: str, file: str, old: str, new: str) -> tuple[str, int, int]:
    """The text of a file with an edit, and the first and the last line that it changes.

    Raises Unjudged: a text that is not there once, an edit that is none.
    """
    if text.count(old) != 1:
        raise Unjudged(f"{old!r} is in {file} {text.count(old)} times, not once")
    if old == new:
        raise Unjudged("edits nothing")
    at = text.index(old) + len(old) - len(old.lstrip())
    first, last = (text.count("\n", 0, end) + 1 for end in (at, at + len(old.strip())))
    return text.replace(old, new), first, last


def check_stamps(
    document: Document, table: str, file: str, stamps: Mapping[str, str | Unjudged], of: str = ""
) -> list[Problem]:
    """Every edit that cannot be judged or was not judged on this text, and every stamp without an edit.

    table: that of pins.toml. of: what comes before the name of an edit of `file`.
    """
    known: Mapping[str, str] = getattr(load_pins(document), table)
    problems: list[Problem] = []
    for name, now in stamps.items():
        if isinstance(now, Unjudged):
            problems.append(Problem(file, f"{of}{name}", now.message))
        elif known.get(name) != now:
            what = "was judged on another text" if name in known else "has not been judged"
            problems.append(Problem(file, f"{of}{name}", stale(what, document.name)))
    what = stale("no edit of this name is left", document.name)
    gone = (name for name in known if name not in stamps)
    return [*problems, *(Problem(document.source("pins"), f"{table}.{name}", what) for name in gone)]


def write_stamps(document: Document, table: str, stamps: Mapping[str, str]) -> None:
    """Write these stamps, and take away all others. Raises Unjudged when the file cannot be written."""
    path = document.root / document.source("pins")
    rows = tomlkit.parse(read_text(document.root, path) if path.is_file() else HEADER)
    rows.setdefault("document", document.name)
    rows[table] = dict(stamps)
    write_whole(path, tomlkit.dumps(rows).encode("utf-8"))
