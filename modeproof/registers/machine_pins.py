"""What must be true of a machine of the project's own, pinned as text: spec/<machine>/pins.toml.

A proof goes through of whatever a property says. So each has a hash of its expressions and of the observers
that they refer to; the sentence beside it is free. It moves as the pins of documents do.
"""

from __future__ import annotations

import json
import re
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomlkit

from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import machines
from modeproof.registers.files import read_text, read_toml, shown
from modeproof.registers.pins import digest
from modeproof.registers.rows import Problem
from modeproof.registers.stale import stale

WORDS = ("id", "sentence", "hazard", "cites")
"""Of a property, what a person reads."""
TABLE = "checked"
HEADER = """\
# What each property of safety.toml says: a hash of its text and of the observers that it refers to.
# Moved only by `modeproof renew --reason TEXT`. Our own design: no claim about a paper.
"""


def check_machine_pins(root: Path, *names: str) -> list[Problem]:
    """Every property of these machines (of all) that is not the pinned one. Raises Unjudged: a file cannot be
    read.
    """
    problems = []
    for name in names or machines(root):
        path, now = _file(root, name), _digests(root, name)
        pinned = _pinned(root, path)
        for id in dict.fromkeys((*now, *pinned)):
            if id not in now:
                what = "nothing of this name is left"
            elif id not in pinned:
                what = "is not pinned"
            elif pinned[id] != now[id]:
                what = "it, or an observer that it refers to, is not the text that was pinned"
            else:
                continue
            problems.append(Problem(shown(root, path), f"{TABLE}.{id}", stale(what, reason=True)))
    return problems


def repin_machines(root: Path, reason: str) -> list[str]:
    """`repin_machine` for every machine of the tree."""
    return [
        line
        for name in machines(root)
        for line in repin_machine(root, name, reason) or [f"{name}: no pin moved"]
    ]


def repin_machine(root: Path, name: str, reason: str) -> list[str]:
    """Write the hashes of the present texts; one line for each that moved. Raises Unjudged."""
    path, now = _file(root, name), _digests(root, name)
    old = tomlkit.parse(read_text(root, path) if path.is_file() else HEADER)
    first = TABLE not in old
    rows = old.setdefault(TABLE, tomlkit.table())
    moved = [f"{name}: {TABLE}.{id}: {rows.pop(id)} -> none" for id in [id for id in rows if id not in now]]
    for id, value in now.items():
        if (was := rows.get(id)) != value:
            rows[id] = value
            if not first:
                rows[id].comment(f"{time.strftime('%Y-%m-%d', time.gmtime())}: {reason}")
            moved.append(f"{name}: {TABLE}.{id}: {was or 'none'} -> {value}")
    if moved:
        write_whole(path, tomlkit.dumps(old).encode("utf-8"))
    return moved


def _file(root: Path, name: str) -> Path:
    return root / "spec" / name / "pins.toml"


def _pinned(root: Path, path: Path) -> Mapping[str, str]:
    found: Mapping[str, str] = read_toml(root, path).get(TABLE, {}) if path.is_file() else {}
    return found


def _digests(root: Path, name: str) -> dict[str, str]:
    """By property the hash of what it says."""
    table = read_toml(root, root / "spec" / name / "safety.toml")
    observers: Mapping[str, Any] = table.get("observer", {})
    return {row["id"]: digest(_said(row, observers)) for row in table.get("property", [])}


def _said(row: Mapping[str, Any], observers: Mapping[str, Any]) -> str:
    parts = {key: value for key, value in row.items() if key not in WORDS}
    waiting = [json.dumps(parts, sort_keys=True)]
    used: dict[str, Any] = {}
    for text in waiting:  # it grows
        for word in re.findall(r"\w+", text):
            if word in observers and word not in used:
                used[word] = observers[word]
                waiting.append(json.dumps(observers[word], sort_keys=True))
    return json.dumps([parts, used], sort_keys=True)
