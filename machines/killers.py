"""What breaks each property of the machine: one edit of the wiring, and the scans from power-up.

A property that nothing breaks says nothing. So each has a row in killers.toml, and whoever judges the
machine plays the scans again: the edited wiring breaks the property in the last of them, the wiring as it is
does not.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import groupby
from pathlib import Path
from typing import Any

import msgspec

from machines.concrete_runs import Runner, Scan, Seen, look, rule_of
from machines.trial import Edit, edits
from machines.trial_record import basis_of, read_outcomes
from machines.verdicts import Machine
from modeproof.ground.errors import Unjudged
from modeproof.registers.typed import Entry, Text, grouped, typed
from refimpl.machine_cell.expression import Value

RUNS = 60
TRIES = 250
HEADER = """\
# What makes each property fall: one edit of wiring.toml (`in` this row `new`), and the scans from power-up:
# `ms since the scan before: inputs that change; ms of scans behind it in which nothing changes`. Made by
# `modeproof machine --killers`; `modeproof verify` plays them again. Our own design: no claim about a paper.
"""


class Killer(Entry, frozen=True, kw_only=True):
    """A row: the property, the row of the wiring and its other text, the scans."""

    property: Text
    row: Text = msgspec.field(name="in")
    text: str = msgspec.field(name="new")
    scans: list[Text]


def name_of(killer: Killer) -> str:
    """The name of the edit."""
    return f"{killer.row} = {killer.text}"


def read_killers(path: Path) -> list[Killer]:
    """The rows; none if there is no file. Raises Unjudged."""
    try:
        table = tomllib.loads(path.read_text("utf-8")) if path.exists() else {}
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Unjudged(f"{path}: cannot be read: {error}") from None
    rows = grouped(str(path), table, "killer", "property")
    return [typed(Killer, row, f"{path}: killer.{row['property']}") for row in rows]


@dataclass(frozen=True)
class Killers:
    """Judges and looks for what breaks the properties of a machine."""

    machine: Machine

    @cached_property
    def edits(self) -> Mapping[str, Edit]:
        """The edits by their names."""
        return {edit.id: edit for edit in edits(self.machine.text, self.machine.wiring)}

    @cached_property
    def rows(self) -> Mapping[str, Mapping[str, Any]]:
        """The properties that are judged, by their ids."""
        return {row["id"]: row for row in self.machine.questions.rows}

    def runner(self, edit: Edit) -> Runner:
        """What runs the edited machine. Raises Unjudged."""
        base = self.machine
        given = edit.after, base.file, base.properties, base.use
        return Machine(*given, leave_out=base.leave_out).runner

    def doubt(self, killer: Killer) -> str:
        """Why a row does not show that its property can fail; nothing if it does."""
        row, edit = self.rows.get(killer.property), self.edits.get(name_of(killer))
        if row is None or edit is None:
            return "there is no such property" if row is None else "this is no edit of the wiring"
        try:
            scans, edited = self.scans(killer), self.runner(edit)
        except Unjudged as error:
            return error.message
        if edited.broken(scans, rule_of(row, [], edited.named)) != len(scans):
            return "the scans do not break the property of the edited wiring"
        own = self.machine.runner
        if own.broken(scans, rule_of(row, [], own.named)) is not None:
            return "the scans break the property of the wiring as it is"
        return ""

    def problems(self, killers: Sequence[Killer]) -> dict[str, str]:
        """By property why its row shows nothing, or that it has none."""
        there = {one.property: one for one in killers if one.property not in self.machine.lacking}
        found = {
            id: f"{name_of(killer)}: {why}" for id, killer in there.items() if (why := self.doubt(killer))
        }
        missing = "no edit of the wiring is known that breaks it"
        return found | {id: missing for id in self.rows if id not in there}

    def scans(self, killer: Killer) -> list[Scan]:
        """The scans of a row. Raises Unjudged."""
        kinds = self.machine.runner.cell.inputs
        inputs: dict[str, Value] = {name: kind == "WORD" and 0 for name, kind in kinds.items()}
        found: list[Scan] = []
        for line in killer.scans:
            scan, _, quiet = line.partition(";")
            dt_ms, _, changes = scan.partition(":")
            try:
                for change in filter(None, map(str.strip, changes.split(","))):
                    name, _, value = change.partition("=")
                    inputs[name] = int(value, 16) if kinds[name] == "WORD" else bool(int(value, 2))
                found.append((int(dt_ms), dict(inputs)))
                for part in filter(None, map(str.strip, quiet.split(","))):
                    many, _, ms = part.rpartition(" x ")
                    found += [(int(ms), dict(inputs))] * int(many or 1)
            except (KeyError, ValueError):
                raise Unjudged(f"{killer.property}: {line!r} is no scan of this machine") from None
        return found

    def sought(self, ids: Sequence[str], names: Sequence[str]) -> dict[str, Killer]:
        """For properties an edit of these that breaks each, as far as runs find one, and its scans."""
        found: dict[str, Killer] = {}
        for name in names:
            left = [id for id in ids if id not in found]
            if not left or (edit := self.edits.get(name)) is None:
                continue
            self.machine.tell(f"{len(left)} without an edit, {name}")
            try:
                runner = self.runner(edit)
            except Unjudged:
                continue
            rules = {id: rule_of(self.rows[id], [], runner.named) for id in left}
            runs = look(runner, list(rules.values()), range(RUNS), partial(_all, len(rules)))
            for id, scans in runs.broken.items():
                short = list(lines_of(runner.shortened(scans, rules[id], TRIES)))
                killer = Killer(property=id, row=edit.row, text=edit.text, scans=short)
                if not self.doubt(killer):
                    found[id] = killer
        return found

    def renewed(self, killers: Sequence[Killer], outcomes: Path) -> list[Killer]:
        """The rows that still show something, and new ones for the other properties where there are any.

        First an edit is sought that was in the row or that the trial found to break the property, then any.
        """
        good = {killer.property: killer for killer in killers if not self.doubt(killer)}
        record = read_outcomes(outcomes, basis_of(self.machine))
        for id in self.rows:
            if id not in good:
                names = [name for name, row in record.items() if id in row["by"] and row["scans"]]
                names.sort(key=lambda name: (record[name]["by"][0] != id, record[name]["scans"]))
                was = [name_of(killer) for killer in killers if killer.property == id]
                good |= self.sought([id], [*was, *names])
        good |= self.sought([id for id in self.rows if id not in good], list(self.edits))
        return [good[id] for id in self.rows if id in good]


def _all(count: int, seen: Seen) -> bool:
    return len(seen.broken) == count


def lines_of(scans: Sequence[Scan]) -> Iterator[str]:
    """Scans as they are in the file: one in which an input changes, then those in which none does."""
    before: Mapping[str, Value] = {}
    lines: list[tuple[str, list[int]]] = []
    for dt_ms, given in scans:
        changes = changed(before, given)
        if changes or not lines:
            lines.append((f"{dt_ms}: {changes}".rstrip(), []))
        else:
            lines[-1][1].append(dt_ms)
        before = given
    for line, quiet in lines:
        runs = [(ms, len(list(same))) for ms, same in groupby(quiet)]
        rest = ", ".join(f"{many} x {ms}" if many > 1 else f"{ms}" for ms, many in runs)
        yield f"{line}; {rest}" if rest else line


def changed(before: Mapping[str, Any], values: Mapping[str, Any]) -> str:
    """What is not as before; at first, what is not FALSE or 0. Words are hexadecimal."""
    return ", ".join(
        f"{name}={int(value)}" if isinstance(value, bool) else f"{name}={value:04X}"
        for name, value in values.items()
        if int(before.get(name, 0)) != int(value)
    )


def as_toml(killers: Sequence[Killer]) -> str:
    """The file."""
    lines = [HEADER]
    for killer in killers:
        scans = "\n".join(f"    {json.dumps(line)}," for line in killer.scans)
        lines.append(
            f"[[killer.{killer.property}]]\nin = {json.dumps(killer.row)}\n"
            f"new = {json.dumps(killer.text)}\nscans = [\n{scans}\n]\n"
        )
    return "\n".join(lines)
