"""Writes test vectors of a whole machine, in the form of modeproof.kit.vectors.

The header holds the wiring, so that the kit can run the reference itself. `states` and `transitions` count
situations (machines.vector_cases) and changes of them in the cases, not the states of a graph.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from machines.concrete_runs import Inputs, read_use
from machines.vector_cases import Case, Cases, Mistakes, Situation
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_lines
from modeproof.kit.ids import case_id
from modeproof.kit.vectors import EXACT, FILE_NAME, KIND, VERSION, WIRING
from refimpl.machine_cell import cell as reference
from refimpl.machine_cell.expression import Value

TARGET = "machine_cell"
BASIS = "design"
"""Of every case: the project's own design, or that of whoever wrote the wiring; no paper."""
NO_GRAPH = (
    "the cases are runs of the composed reference; no model checker walked a graph of the whole machine, so "
    "what no case does is not judged"
)


@dataclass(frozen=True)
class Kind:
    """What a header says of a suite."""

    guarantees: str
    hypothesis: str
    does_not_show: str = NO_GRAPH


ALIKE = "the program treats situations alike that show the same safeguards, latches, errors and outputs"
SUITES = {
    "sequences": Kind(
        "the stories of how the machine is used, after each way to begin: each story that likes to follow "
        "another one does so, and each way to begin comes after each other one; a third of the cases has "
        "scans of the set time, a third of the shortest, a third of the longest",
        "none beyond these inputs: they are examples",
    ),
    "faults": Kind(
        "in each situation of the stories each input sticks, as it is or the other way (a word: one bit), to "
        "the end of the story; the cases are those of these runs that take a change of situation that no "
        "case before took",
        ALIKE,
        f"two faults at once; faults of outputs and of the controller; {NO_GRAPH}",
    ),
    "sic": Kind(
        "in each situation of the stories each input changes alone, is held, and changes back: those that "
        "change no situation in one case, and of the others those that take a change that no case of this "
        "suite before took",
        ALIKE,
    ),
    "mistakes": Kind(
        "for each edit of the wiring (a wire left out, bridged or crossed, another source, another order of "
        "calls, another row of the matrix) with which some run gave other outputs, a case of these suites "
        "does; `edits` counts them and names those that showed in no run",
        "a mistake of the program is like one of these edits",
        f"two mistakes at once; mistakes within a block, for which blocks are targets; {NO_GRAPH}",
    ),
}
"""All suites of a machine by name, in the order in which they are made."""


@dataclass
class Writer:
    """Cases as lines, and the header that counts them."""

    cases: Cases
    suite: str
    lines: list[str] = field(default_factory=list)
    ids: set[str] = field(default_factory=set)
    views: dict[Situation, int] = field(default_factory=lambda: {(): 0})
    steps: dict[str, int] = field(default_factory=dict)
    taken: set[tuple[int, int, int]] = field(default_factory=set)
    scans: int = 0

    def add(self, case: Case) -> None:
        """Write a case, unless its inputs are those of another one."""
        cell = self.cases.runner.cell
        state, before = reference.power_up(cell), 0
        inputs: dict[str, Any] = {}
        outputs: dict[str, Any] = {}
        rows: list[dict[str, Any]] = []
        for dt_ms, given in case.scans:
            state, gives = reference.step(cell, state, given, dt_ms)
            here = self.cases.situation(state, given)
            step = self.steps.setdefault(self._step(here), len(self.steps))
            to = self.views.setdefault(here, len(self.views))
            now_in, now_out = on_wire(given), on_wire(gives)
            row = {"dt_ms": dt_ms, "in": _changed(inputs, now_in), "out": _changed(outputs, now_out)}
            rows.append({**row, "step": step, "to": to, "column": 0})
            self.taken.add((before, step, to))
            inputs, outputs, before = now_in, now_out, to
        id = case_id(TARGET, {}, [(row["dt_ms"], row["in"]) for row in rows])
        if id in self.ids:
            return
        self.ids.add(id)
        self.scans += len(rows)
        about = {"id": id, "clauses": [], "basis": BASIS, "why": case.why, "timing": "exact", "params": {}}
        self.lines.append(_line({**about, "graph": 0, "scans": rows}))

    def _step(self, situation: Situation) -> str:
        active = [name for name in situation if name in self.cases.wiring.table.modes]
        return f"in {' and '.join(active)}" if active else "without a mode"

    def header(self, more: Mapping[str, Any]) -> dict[str, Any]:
        """The first line."""
        table, kind = self.cases.wiring.table, SUITES[self.suite]
        counts = Counter(step for _, step, _ in self.taken)
        types = {"BOOL": "bool", "WORD": "word"}
        outputs = {
            name: {"type": types[self.cases.wiring.type_of(tree).name]}
            for name, tree in self.cases.wiring.shown.items()
        }
        return {
            "kind": KIND,
            "version": VERSION,
            "target": TARGET,
            "document": TARGET,
            "protocol": 1,
            "suite": self.suite,
            "relations": [EXACT],
            "pace": "fast",
            "counted_by": "next state",
            "shrink": "prefix",
            "guarantees": kind.guarantees,
            "hypothesis": kind.hypothesis,
            "does_not_show": kind.does_not_show,
            "generator": "modeproof",
            "cases": len(self.lines),
            "scans": self.scans,
            "states": len(self.views),
            "columns": 1,
            "transitions": len(self.taken),
            "inputs": {name: {"type": types[row.type]} for name, row in table.inputs.items()},
            "outputs": outputs,
            "parameters": {},
            "steps": [
                {"name": name, "clauses": [], "findings": [], "transitions": counts[number]}
                for name, number in self.steps.items()
            ],
            "graphs": [
                {
                    "run": "the composed reference",
                    "params": {},
                    "initial": 0,
                    "views": [", ".join(view) or "nothing is on" for view in self.views],
                }
            ],
            WIRING: self.cases.table,
            **more,
        }


def write(folder: Path, file: Path, use: Path, say: Callable[[str], None]) -> Iterator[tuple[Path, str]]:
    """Write all suites of a wiring; each file and what is in it. Raises Unjudged.

    say is told what is being made.
    """
    text = _text(file)
    cases = Cases(text, str(file), read_use(use))
    if not cases.stories:
        raise Unjudged(f"machine: no story of {use} concerns {file}; --use names a file with some")
    mistakes = Mistakes(cases)
    made: list[Case] = []
    for name in SUITES:
        say(f"{name} of {file}")
        found = list(_cases(name, cases, mistakes, made))
        made += found if name != "sic" else []
        path, more = folder / FILE_NAME.format(suite=name), dict[str, Any]()
        if not found:
            path.unlink(missing_ok=True)
            yield path, "no case is needed"
            continue
        if name == "mistakes":
            more = {"edits": {"tried": mistakes.edits, "shown_nowhere": mistakes.unseen}}
        writer = Writer(cases, name)
        for case in found:
            writer.add(case)
        write_lines(path, [_line(writer.header(more)), *writer.lines])
        shown = f"; {mistakes.edits - len(mistakes.unseen)} of {mistakes.edits} edits show" if more else ""
        yield path, f"{len(writer.lines)} cases, {writer.scans:,} scans{shown}"


def _cases(name: str, cases: Cases, mistakes: Mistakes, made: Sequence[Case]) -> Iterable[Case]:
    if name == "mistakes":
        return mistakes.found(made)
    found: Iterable[Case] = getattr(cases, name)()
    return found


def on_wire(values: Inputs) -> dict[str, Any]:
    """Values as adapter protocol 1 has them."""
    return {name: _wire(value) for name, value in values.items()}


def _wire(value: Value) -> bool | str:
    return value if isinstance(value, bool) else f"{value:04X}"


def _changed(before: Mapping[str, Any], now: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in now.items() if name not in before or before[name] != value}


def _line(row: Mapping[str, Any]) -> str:
    return json.dumps(row, separators=(",", ":")) + "\n"


def _text(path: Path) -> str:
    try:
        return path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Unjudged(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
