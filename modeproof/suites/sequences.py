"""Suite `sequences`: the document's own diagrams, walked as they are drawn.

spec/<document>/sequences.toml says how the scans of each diagram go: what is on the inputs, and which
step of the specification each scan takes. What the outputs must be, it does not say: that is the graph's.

    [tables]                            words and names by number
    CODE = ["0FF0", "3333"]
    BUTTON = ["A", "B"]

    [groups]                            inputs that are true or false together: those listed are true
    buttons = ["A", "B"]

    [[flow]]                            one good walk from power-up to the end
    name = "switch on"
    device = "lamp"
    graph = "OPEN_Lamp"
    for = { n = [0, 1] }                one case for each value; with several names for each combination
    why = "Figure 1: button {n} switches the lamp on."
    clauses = ["LAMP-1-1"]
    scans = [
        { set = { buttons = [], word = "0000" }, dt_ms = 10, step = "StayOff" },
        { set = { buttons = ["BUTTON[n]"], word = "CODE[n]" }, step = "SwitchOn" },
    ]

    [[branch]]                          another ending: the flow up to the step `at`, then these scans
    of = "switch on"
    at = ["SwitchOn"]                   one case for each; {at} names it; "end", or no `at`: after the flow
    why = "Figure 1: the word of the other button switches nothing on ({at} does not come)."
    clauses = ["LAMP-1-2"]
    for = { n = [0, 1], other = [0, 1] }
    when = "other != n"                 of the combinations only these: two names with <= < > >= == or !=
    scans = [{ set = { word = "CODE[other]" }, step = "StayOff" }]

`set` holds what changes (all of it in the first scan of a flow), `dt_ms` is as in the scan before where it
is left out, `times` repeats a scan; a list of steps is one scan for each. Clauses and basis may name tables
too. A branch has the flow's `for` and `when` unless it has its own, and its `graph`, which may be a list of
graphs: of each profile, for instance. With `basis` a case rests on a finding of ours and not on the document
alone, as in `basis = "finding:E-21"`.

A scan that takes another step than it says is refused: then the diagram, as it was read here, is not what the
specification does.
"""

from __future__ import annotations

import itertools
import operator
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph
from modeproof.ground.errors import Unjudged
from modeproof.registers.files import read_toml
from modeproof.suites.script import Alphabet, Script, Scripts, Shot

FILE = "sequences.toml"
END = "end"
"""Where a branch goes on after the whole flow."""
_FLOW = {"name", "device", "graph", "for", "when", "why", "clauses", "basis", "scans"}
_BRANCH = {"of", "at", "graph", "for", "when", "why", "clauses", "basis", "scans"}
_SCAN = {"set", "dt_ms", "step", "times"}
_ENTRY = re.compile(r"(\w+)\[(\w+)\]")
_WHEN = re.compile(r"(\w+) *(<=|>=|==|!=|<|>) *(\w+)")
_COMPARE: dict[str, Callable[[int, int], bool]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
}
Names = Mapping[str, int]


def plan(device: DeviceGraph, columns: Columns) -> Scripts:
    """The cases that the document's room declares for this graph; `notes` count them by flow."""
    found = _Cases(device)
    cases = list(found.cases())
    return Scripts(cases, {"clauses": sorted({clause for case in cases for clause in case.clauses})})


class Declared:
    """The rows of a document's file, each with all that it needs and nothing else. Raises Unjudged."""

    def __init__(self, rows: Mapping[str, Any], document: str) -> None:
        self.where = f"spec/{document}/{FILE}"
        self.tables: Mapping[str, list[Any]] = rows.get("tables", {})
        self.groups: Mapping[str, list[str]] = rows.get("groups", {})
        every = rows.get("flow", [])
        for row in every:
            self._only(row, _FLOW, row.get("name"))
        names = [row["name"] for row in every]
        if len(set(names)) != len(names):
            raise Unjudged(f"{self.where}: two flows have the same name")
        self.flows = {row["name"]: row for row in every}
        self.branches = []
        for row in rows.get("branch", []):
            self._only(row, _BRANCH, f"branch of {row.get('of')!r}")
            if row["of"] not in names:
                raise Unjudged(f"{self.where}: a branch of {row['of']!r}, which is no flow")
            self.branches.append(row)

    def _only(self, row: Mapping[str, Any], allowed: set[str], name: object) -> None:
        optional = {"for", "when", "basis"} | ({"graph", "at"} if "of" in allowed else set())
        missing = allowed - optional - set(row)
        if set(row) - allowed or missing:
            odd = sorted((set(row) - allowed) | missing)[0]
            raise Unjudged(f"{self.where}: {name}: {odd!r} is missing or unknown")
        for scan in row["scans"]:
            if set(scan) - _SCAN or "step" not in scan:
                raise Unjudged(f"{self.where}: {name}: a scan needs `step` and has set, dt_ms, times besides")


def read(place: Path, document: str) -> Declared:
    """What the document's room declares; nothing where it has no such file."""
    path = place / "spec" / document / FILE
    return Declared(read_toml(place, path) if path.is_file() else {}, document)


@dataclass(frozen=True)
class _Scan:
    """One scan as declared; `set` may still name tables."""

    set: Mapping[str, Any]
    dt_ms: int | None
    step: str


class _Cases:
    def __init__(self, device: DeviceGraph) -> None:
        self.device, self.alphabet = device, Alphabet(device)
        self.where = f"spec/{device.document}/{FILE}"
        declared = (
            Declared({}, device.document) if device.place is None else read(device.place, device.document)
        )
        self.tables, self.groups = declared.tables, declared.groups
        self.flows, self.branches = declared.flows, declared.branches

    def _is_mine(self, row: Mapping[str, Any]) -> bool:
        graphs = [row["graph"]] if isinstance(row["graph"], str) else row["graph"]
        return row["device"] == self.device.device.id and self.device.run in graphs

    # --------------------------------------------------------------------------------------------- cases

    def cases(self) -> Iterator[Script]:
        """Flows in the order of the file, each followed by its branches."""
        for name, flow in self.flows.items():
            if self._is_mine(flow):
                yield from self._each(name, flow, flow, self._scans(flow), {})
            for branch in self.branches:
                if branch["of"] == name and self._is_mine({**flow, **branch}):
                    yield from self._branch(name, flow, branch)

    def _branch(self, name: str, flow: Mapping[str, Any], branch: Mapping[str, Any]) -> Iterator[Script]:
        main = self._scans(flow)
        steps = [scan.step for scan in main]
        for at in branch.get("at", [END]):
            if at not in (*steps, END):
                raise Unjudged(f"{self.where}: a branch of {name} at {at}, which is no step of it")
            begins = len(steps) if at == END else steps.index(at)
            scans = [*main[:begins], *self._scans(branch)]
            yield from self._each(f"{name}, {at}", {**flow, **branch}, branch, scans, {"at": at})

    @staticmethod
    def _scans(row: Mapping[str, Any]) -> list[_Scan]:
        return [
            _Scan(scan.get("set", {}), scan.get("dt_ms"), step)
            for scan in row["scans"]
            for _ in range(scan.get("times", 1))
            for step in ([scan["step"]] if isinstance(scan["step"], str) else scan["step"])
        ]

    def _each(
        self,
        name: str,
        bounds: Mapping[str, Any],
        row: Mapping[str, Any],
        scans: Sequence[_Scan],
        words: Mapping[str, str],
    ) -> Iterator[Script]:
        counted: Mapping[str, list[int]] = bounds.get("for", {})
        for values in itertools.product(*counted.values()):
            names = dict(zip(counted, values, strict=True))
            if self._wanted(bounds.get("when", ""), names):
                where = f"{self.where}: {name}{''.join(f', {key} {value}' for key, value in names.items())}"
                shots, renamed = self._shots(where, scans, names)
                yield Script(
                    why=row["why"].format(**names, **words),
                    shots=shots,
                    renamed=renamed,
                    clauses=tuple(self._entry(where, clause, names) for clause in row["clauses"]),
                    basis=self._entry(where, row.get("basis", "document"), names),
                )

    def _wanted(self, when: str, names: Names) -> bool:
        if not when:
            return True
        found = _WHEN.fullmatch(when)
        if found is None:
            raise Unjudged(f"{self.where}: when = {when!r}: two names and a comparison expected")
        name, compare, other = found.groups()
        return _COMPARE[compare](self._number(name, names), self._number(other, names))

    def _number(self, text: str, names: Names) -> int:
        if text in names:
            return names[text]
        try:
            return int(text)
        except ValueError:
            raise Unjudged(f"{self.where}: {text!r} is no name of `for` and no number") from None

    # --------------------------------------------------------------------------------------------- scans

    def _shots(
        self, where: str, scans: Sequence[_Scan], names: Names
    ) -> tuple[list[Shot], Mapping[int, int]]:
        inputs: dict[str, Any] = {}
        dt_ms = None
        rows = []
        for scan in scans:
            inputs.update(self._values(where, scan.set, names))
            dt_ms = dt_ms if scan.dt_ms is None else scan.dt_ms
            rows.append({**inputs, "dt_ms": dt_ms})
        stands_for = self._stands_for(where, rows)
        shots = []
        graph, state = self.device.graph, self.device.graph.initial
        for number, (scan, row) in enumerate(zip(scans, rows, strict=True), 1):
            missing = set(self.device.alphabet[0]) - set(row)
            if missing or row["dt_ms"] is None:
                raise Unjudged(f"{where}: scan {number} does not say {sorted(missing) or 'dt_ms'}")
            letter = self.alphabet.find({key: stands_for.get(value, value) for key, value in row.items()})
            if letter is None:
                raise Unjudged(f"{where}: scan {number}: the graph {self.device.run} has no such input")
            step = graph.steps[graph.step_of[state][letter]]
            if step != scan.step:
                raise Unjudged(f"{where}: scan {number} takes the step {step}, not {scan.step}")
            state = graph.next_of[state][letter]
            shots.append(Shot(letter))
        return shots, {letter: word for word, letter in stands_for.items()}

    def _stands_for(self, where: str, rows: Sequence[Mapping[str, Any]]) -> dict[int, int]:
        """For words that a device passes on unread: which word of the alphabet stands for each."""
        copied = self.device.copied
        if copied is None:
            return {}
        words = list(dict.fromkeys(row[field] for row in rows for field in copied.fields if field in row))
        words = [word for word in words if word != 0]
        if len(words) > len(copied.words):
            raise Unjudged(f"{where}: more words at once than the graph has")
        return dict(zip(words, copied.words, strict=False))

    def _values(self, where: str, given: Mapping[str, Any], names: Names) -> dict[str, Any]:
        inputs = self.device.device.inputs
        found: dict[str, Any] = {}
        for name, value in given.items():
            if name in self.groups:
                chosen = {self._entry(where, member, names) for member in value}
                if chosen - set(self.groups[name]):
                    raise Unjudged(f"{where}: {sorted(chosen)} are not all in the group {name}")
                found.update({member: member in chosen for member in self.groups[name]})
            elif name in inputs:
                entry = self._entry(where, value, names)
                found[name] = int(entry, 16) if inputs[name].type == "word" else entry
            else:
                raise Unjudged(f"{where}: {self.device.device.id} has no input {name!r}")
        return found

    def _entry(self, where: str, value: Any, names: Names) -> Any:
        """A value, or the entry of a table that it names."""
        match = _ENTRY.fullmatch(value) if isinstance(value, str) else None
        if match is None:
            return names.get(value, value) if isinstance(value, str) else value
        table, index = match.groups()
        try:
            return self.tables[table][self._number(index, names)]
        except (KeyError, IndexError):
            raise Unjudged(f"{where}: no table has the entry {value}") from None
