"""What `init` looks at: the files of a folder that may be programs, wirings, properties or logs."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged

TEXTS = (".st", ".scl", ".awl", ".stl")
"""Programs as text."""
LOGS = (".jsonl", ".csv")
ELSEWHERE = frozenset({"node_modules", "__pycache__", "site-packages"})
EXPORT = "a file of a tool, which only it can read; export the program as {}, and run `modeproof init` then"
FOREIGN = {
    ".tcpou": EXPORT.format("PLCopen XML, or as text (.st)"),
    ".project": EXPORT.format("PLCopen XML"),
    ".projectarchive": EXPORT.format("PLCopen XML"),
    **dict.fromkeys((f".ap{n}" for n in range(13, 22)), EXPORT.format("a source of SCL (.scl)")),
    ".s7p": EXPORT.format("a source of the statement list (.awl)"),
}
"""Ends of files that hold programs and that nothing here can read."""
MOST = 20_000
"""Files that are looked at."""
HEAD = 4_000
"""Bytes at the beginning of an XML file that must have PLCopen's name."""


@dataclass
class Found:
    """The files by what they may be, each as a path from the folder."""

    folder: Path
    programs: list[str] = field(default_factory=list)
    wirings: list[str] = field(default_factory=list)
    properties: list[str] = field(default_factory=list)
    uses: list[str] = field(default_factory=list)
    logs: list[str] = field(default_factory=list)
    others: dict[str, str] = field(default_factory=dict)
    """What cannot be listed, and why."""


def look(folder: Path) -> Found:
    """Sort the files of a folder and of those below. Raises Unjudged: there are too many of them."""
    found = Found(folder)
    for number, name in enumerate(_names(folder)):
        if number >= MOST:
            raise Unjudged(f"{folder}: more than {MOST:,} files; run `modeproof init` nearer to the programs")
        end, path = Path(name).suffix.lower(), folder / name
        if end in FOREIGN:
            found.others[name] = FOREIGN[end]
        elif end in TEXTS or (end == ".xml" and _is_plcopen(path)):
            found.programs.append(name)
        elif end in LOGS:
            found.logs.append(name)
        elif end == ".toml":
            _sort_toml(found, name)
    beside = {beside for name in found.programs for beside in _tables_of(name)}
    found.logs = [name for name in found.logs if name not in beside]
    return found


def _names(folder: Path) -> Iterator[str]:
    for place, folders, names in os.walk(folder):
        here = Path(place)
        folders[:] = sorted(
            name
            for name in folders
            if not name.startswith(".")
            and name not in ELSEWHERE
            and not (here / name / "pyvenv.cfg").exists()
        )
        for name in sorted(names):
            if not name.startswith("."):
                yield (here / name).relative_to(folder).as_posix()


def _is_plcopen(path: Path) -> bool:
    try:
        with path.open("rb") as stream:
            return b"plcopen" in stream.read(HEAD).lower()
    except OSError:
        return False


def _tables_of(name: str) -> tuple[str, ...]:
    """The tables that belong to a statement list."""
    path = Path(name)
    if path.suffix.lower() not in (".awl", ".stl"):
        return ()
    return path.with_name("symbols.csv").as_posix(), path.with_suffix(".map.csv").as_posix()


def _sort_toml(found: Found, name: str) -> None:
    table = _table(found.folder / name)
    if "block" in table and "order" in table:
        found.wirings.append(name)
    elif isinstance(table.get("property"), list):
        found.properties.append(name)
    elif "story" in table or ("rest" in table and "follows" in table):
        found.uses.append(name)


def _table(path: Path) -> dict[str, Any]:
    """The tables of a TOML file; none of one that is not ours to complain of."""
    try:
        return tomllib.loads(path.read_text("utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
