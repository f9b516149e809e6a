"""Moves the pins of a run: the only way, and never silently.

It prints each pin's old and new value and what changed in the cfg, and asks for a reason, which is kept once,
in the list `moved` of runs.toml.
"""

from __future__ import annotations

import difflib
import hashlib
import json
import re
import subprocess
import time
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import tomlkit
from tomlkit.exceptions import TOMLKitError

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.tlc.check import Checked, read_cfg
from modeproof.tlc.run_judge import HOLDS, REACHED, VIOLATED, judge

COUNTS = ("distinct", "generated")
"""What `counts` of a row holds, in this order."""
_HISTORY = 200
"""So many commits back the pinned version of a cfg is looked for."""


@dataclass(frozen=True)
class Move:
    """One pin that moves; `table` is "" for the run itself, "graph" for its graph, and "also" in the row that
    makes it.
    """

    table: str
    key: str
    old: int | str | list[int] | None
    new: int | str | list[int] | None

    def __str__(self) -> str:
        name = f"{self.table}.{self.key}" if self.table else self.key
        return f"{name}: {_show(self.old)} -> {_show(self.new)}"


def _show(value: int | str | list[int] | None) -> str:
    if value is None:
        return "none"
    if isinstance(value, list):
        return " of ".join(map(_show, value)) or "none"
    return f"{value:,}" if isinstance(value, int) else value


def moves(place: Path, checked: Checked) -> tuple[Move, ...]:
    """The pins that this outcome would move.

    Raises Unjudged when the outcome may not be pinned: wrong verdict, wrong property, or a property list that
    differs from the cfg (which is corrected by hand in runs.toml, where it is reviewed).
    """
    run, judgement, outcome = checked.run, checked.judgement, checked.outcome
    if outcome is None or not judgement.judged or (outcome.log.counts is None and run.kind != "NEG"):
        raise Unjudged(f"{run.name}: {judgement.verdict}, nothing to pin: {judgement.reason}")
    right = {"NEG": VIOLATED, "WIT": REACHED}.get(run.kind, HOLDS)
    if judgement.verdict != right or (run.kind == "NEG" and judgement.violated != run.property):
        raise Unjudged(f"{run.name}: {judgement.verdict} is not what the run must show: {judgement.reason}")
    log = outcome.log
    wanted = [] if run.base else [Move("", "cfg_sha256", run.cfg_sha256, checked.cfg_sha256)]
    if run.kind == "NEG" and run.workers == 1:
        wanted.append(Move("", "trace_length", run.trace_length, len(log.trace)))
    if log.counts is not None:
        counts = Move("", "distinct", run.distinct, log.counts.distinct)
        generated = Move("", "generated", run.generated, log.counts.generated)
        wanted += [pin for pin in (counts, generated) if run.kind != "NEG" or pin.old is not None]
    if run.graph is not None and log.initial is not None:
        states, edges = log.tags.get("STATE", 0), log.tags.get("EDGE", 0)
        wanted.append(Move("graph", "states", run.graph.states, states))
        wanted.append(Move("graph", "edges", run.graph.edges, edges))
    _refuse_other_faults(place, checked, wanted)
    if run.of:
        old = [pin for pin in (run.distinct, run.generated) if pin is not None]
        wanted = [Move("also", run.of[1], old, [pin.new for pin in wanted if isinstance(pin.new, int)])]
    return tuple(move for move in wanted if move.old != move.new)


def _refuse_other_faults(place: Path, checked: Checked, wanted: list[Move]) -> None:
    """With the new pins the run must be as expected: whatever else is wrong is no matter of pins."""
    run, outcome = checked.run, checked.outcome
    assert outcome is not None
    pins: dict[str, Any] = {move.key: move.new for move in wanted if not move.table}
    if run.graph is not None:
        counts: dict[str, Any] = {move.key: move.new for move in wanted if move.table}
        pins["graph"] = msgspec.structs.replace(run.graph, **counts)
    cfg, digest = read_cfg(place, run)
    again = judge(msgspec.structs.replace(run, **pins), cfg, digest, outcome)
    if not again.as_expected:
        raise Unjudged(f"{run.name}: not a matter of pins: {again.reason}")


def cfg_diff(place: Path, checked: Checked) -> str:
    """What changed in the cfg since it was pinned, as a unified diff, from the history of git if there is
    one.
    """
    run = checked.run
    path = place / run.config
    name = run.config
    if run.base:
        return f"{name}: made from runs.toml, whose row is the pin"
    if not run.cfg:
        return f"{name}: made from runs.toml; git shows what changed in its row"
    if run.cfg_sha256 is None:
        return f"{name}: pinned for the first time"
    if run.cfg_sha256 == checked.cfg_sha256:
        return f"{name}: unchanged"
    old = _pinned_version(place, name, run.cfg_sha256)
    if old is None:
        return f"{name}: the pinned version is not in the history of git; the whole file is new to the pins"
    new = path.read_text(encoding="utf-8", errors="replace")
    lines = difflib.unified_diff(
        old.splitlines(), new.splitlines(), f"{name} (pinned)", f"{name} (now)", lineterm="", n=1
    )
    return "\n".join(lines)


def _git(place: Path, *arguments: str) -> bytes | None:
    try:
        done = subprocess.run(
            ["git", "-C", str(place), *arguments], capture_output=True, timeout=20, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout if done.returncode == 0 else None


def _pinned_version(place: Path, name: str, digest: str) -> str | None:
    commits = _git(place, "log", f"-{_HISTORY}", "--format=%H", "--", name)
    for commit in (commits or b"").decode("ascii", "replace").split():
        content = _git(place, "show", f"{commit}:./{name}")
        if content is not None and hashlib.sha256(content).hexdigest() == digest:
            return content.decode("utf-8", "replace")
    return None


def apply(place: Path, changes: dict[str, dict[str, tuple[Move, ...]]], reason: str) -> None:
    """Write the moves into runs.toml, per document and run id, and the reason into `moved`.

    Comments and layout stay as they are. Raises Unjudged when a file cannot be read or written; each file is
    replaced whole or not at all.
    """
    note = f"{time.strftime('%Y-%m-%d', time.gmtime())}: {reason}"
    for document, of_run in changes.items():
        path = place / "spec" / document / "runs.toml"
        try:
            old = path.read_text(encoding="utf-8")
            data = tomlkit.parse(old)
        except (OSError, UnicodeDecodeError, TOMLKitError) as error:
            raise Unjudged(f"spec/{document}/runs.toml: {error}") from None
        wanted = tomllib.loads(old)
        for table in (data, wanted):
            rows = dict(_rows(table))
            for id, moved in of_run.items():
                for move in moved:
                    _set(rows[id], move)
        text = tomlkit.dumps(data)
        if tomllib.loads(text) != wanted:  # more than the pins would change
            raise Unjudged(f"spec/{document}/runs.toml: the pins cannot be moved here; edit the file by hand")
        write_whole(path, _with_reason(text, data, note).encode("utf-8"))


def _rows(data: Any) -> Iterator[tuple[str, Any]]:
    """The rows of runs.toml by their ids: [run.ID], [[run]], and [based.RUN]."""
    rows = data["run"]
    yield from rows.items() if isinstance(rows, Mapping) else ((str(row["id"]), row) for row in rows)
    for group in data.get("based", {}).values():
        yield from group.items()


def _set(row: Any, move: Move) -> None:
    """Write a pin into its row. Counts are in one list, where none of them has a key of its own."""
    target = row[move.table] if move.table else row
    key, new = move.key, move.new
    if not move.table and key in COUNTS and not any(name in target for name in COUNTS):
        counts: Any = list(target.get("counts", [new, new]))
        counts[COUNTS.index(key)] = new
        key, new = "counts", counts
    if key in target or not isinstance(target, tomlkit.items.Table):
        target[key] = new
        return
    plain = [key for key, value in target.items() if not isinstance(value, tomlkit.items.Table)]
    if plain:  # after the last plain key, before any sub-table
        target.value._insert_after(plain[-1], key, tomlkit.item(new))
    else:
        target.add(key, tomlkit.item(new))


def _with_reason(text: str, data: Any, note: str) -> str:
    """The text with one more reason in `moved`, or with the list before the first table."""
    if note in data.get("moved", ()):
        return text
    line = f"    {json.dumps(note, ensure_ascii=False)},\n"
    if "moved" in data:
        whole = re.search(r"^moved = \[(.*?),?\s*\]\n", text, re.MULTILINE | re.DOTALL)
        assert whole is not None
        comma = "," if whole[1].strip() else ""
        return f"{text[: whole.end(1)].rstrip()}{comma}\n{line}]\n{text[whole.end() :]}"
    first = re.search(r"^\[", text, re.MULTILINE)
    at = first.start() if first else 0
    return f"{text[:at]}moved = [\n{line}]\n\n{text[at:]}"
