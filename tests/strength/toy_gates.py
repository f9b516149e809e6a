"""A small published device, its program, two suites of vectors for it, and a device that nobody publishes."""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.kit.vectors import case_id

GATE = """
from dataclasses import dataclass

LIMIT = 2
WORDS = (5, 9)


class GateError(ValueError):
    def __init__(self, field):
        super().__init__(f"{field}: cannot be")
        self.field = field


@dataclass(frozen=True)
class Params:
    T_OPEN_ms: int = 10


@dataclass(frozen=True)
class State:
    params: Params
    count: int


@dataclass(frozen=True)
class Inputs:
    dt_ms: int
    press: bool


@dataclass(frozen=True)
class Outputs:
    LAMP: bool
    MW: int


def power_up(params):
    return State(params, 0)


def step(state, inputs):
    count = counted(state.count, inputs.press)
    return State(state.params, count), Outputs(count == LIMIT, word(count))


def counted(count, press):
    if not press:
        return 0
    if count > LIMIT - 1:
        count = count - 1
    return count + 1


def word(count):
    if count == 0:
        return 0
    if count <= 2:
        return WORDS[count - 1]
    raise GateError("count")
"""
VALVE = "def step(state, inputs):\n    return state + 1, inputs\n"
INTERFACE = """
document = "toy"
[constants]
MODES = [0]
[devices.gate]
title = "the gate"
module = "Gate"
published = true
states = ["Counting"]
steps = ["Count"]
[devices.gate.memory]
count = { type = "int", min = 0, max = 2, clauses = [], why = "presses" }
[devices.gate.inputs]
press = { type = "bool", clauses = [], why = "pressed" }
[devices.gate.outputs]
LAMP = { type = "bool", clauses = [], why = "on" }
MW = { type = "word", clauses = [], why = "a word" }
[devices.gate.parameters]
T_OPEN_ms = { type = "ms", min = 1, max = 100, default = 10, clauses = [], why = "unused" }
"""
REGISTER = "[rule]\nturns = []\n"
PACKAGE = "toyimpl"


@dataclass
class Room:
    """Stands for the room of proofs: which code some step reaches."""

    place: Path
    theorem_names: Mapping[str, str] = field(default_factory=lambda: {"counts": "proofs.toy.counts"})

    def reached(self, document: str) -> Mapping[str, tuple[Path, frozenset[str]]]:
        folder = self.place / PACKAGE / "toy"
        functions = frozenset({"power_up", "step", "counted", "word"})
        return {
            f"{PACKAGE}.toy.gate": (folder / "gate.py", functions),
            f"{PACKAGE}.toy.valve": (folder / "valve.py", frozenset({"step"})),
        }

    def texts(self, document: str) -> Sequence[tuple[str, ...]]:
        return []

    def theorems(self, document: str) -> Mapping[str, str]:
        return self.theorem_names

    def bench_of(self, document: str) -> Any:
        raise AssertionError("no theorem is asked")

    def judged(self, bench: Any, change: Mapping[str, Any], complete: bool) -> Mapping[str, Any]:
        raise AssertionError("no theorem is asked")


def build_place(root: Path, gate: str = GATE) -> Path:
    """The tree, and the package loaded from it."""
    for file, text in (
        (f"{PACKAGE}/toy/gate.py", gate),
        (f"{PACKAGE}/toy/valve.py", VALVE),
        (f"{PACKAGE}/__init__.py", ""),
        (f"{PACKAGE}/toy/__init__.py", ""),
        ("spec/toy/interface.toml", INTERFACE),
        ("spec/toy/runs.toml", ""),
        ("proofs/toy/strength.toml", REGISTER),
        ("proofs/toy/counts.py", ""),
        ("proofs/toy/subjects.py", f"from {PACKAGE}.toy import gate\n"),
        ("proofs/mutants/bench.py", ""),
        ("docs/x.md", ""),
        ("refimpl/toy/__init__.py", ""),
    ):
        path = root / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    unload()
    sys.path.insert(0, str(root))
    importlib.invalidate_caches()
    for name in ("gate", "valve"):
        importlib.import_module(f"{PACKAGE}.toy.{name}")
    sys.path.remove(str(root))
    return root


def unload() -> None:
    """Forget the package, so that the next tree brings its own."""
    for name in [name for name in sys.modules if name == PACKAGE or name.startswith(f"{PACKAGE}.")]:
        del sys.modules[name]


def write_vectors(path: Path, suite: str, cases: Sequence[Sequence[bool]], **changes: Any) -> Path:
    """Vectors of the gate: each case is a row of presses; what must follow is counted here once more."""
    words, rows, scans = [0, 5, 9], [], 0
    for presses in cases:
        count, going_in, lines, before = 0, [], [], None
        for press in presses:
            count = min(count + 1, 2) if press else 0
            change = {} if press == before else {"press": press}
            before = press
            going_in.append((10, change))
            out = {"LAMP": count == 2, "MW": f"{words[count]:04X}"}
            lines.append({"dt_ms": 10, "in": change, "out": out, "step": 0, "to": 0, "column": 0, **changes})
        params = {"T_OPEN_ms": 10}
        rows.append(
            {
                "id": case_id("gate", params, going_in),
                "clauses": [],
                "basis": "document",
                "why": "it counts",
                "params": params,
                "graph": 0,
                "scans": lines,
            }
        )
        scans += len(lines)
    header = {
        "kind": "modeproof-vectors",
        "version": 1,
        "target": "gate",
        "document": "toy",
        "suite": suite,
        "relation": "exact",
        "inputs": {"press": {"type": "bool"}},
        "outputs": {"LAMP": {"type": "bool"}, "MW": {"type": "word"}},
        "steps": [{"name": "Count", "clauses": [], "findings": [], "transitions": 1}],
        "cases": len(rows),
        "scans": scans,
        "graphs": [{"initial": 0, "params": {}, "views": ["0"]}],
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(json.dumps(row) + "\n" for row in (header, *rows)), encoding="utf-8")
    return path
