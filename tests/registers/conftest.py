"""A small document of its own, "a door with a latch", on which every check is seen to pass and to fail."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from modeproof.registers.citations import read_sources
from modeproof.registers.load import load_document
from modeproof.registers.pins import repin
from modeproof.registers.register_judge import judge

FILES = {
    "spec/door/clauses.toml": """
[paper]
title = "A door"
number = "D-1"
edition = "1"
publisher = "nobody"
prefix = "DR"
seed = "none"
sha256 = "0000000000000000000000000000000000000000000000000000000000000000"
available = ["the text"]
not_available = ["the drawings"]
not_endorsed = "nobody endorses this"
[[clause]]
id = "DR-1-1"
title = "the latch shuts"
text = "When the door is closed the latch shuts."
kind = "behaviour"
device = ["latch"]

[[clause]]
id = "DR-1-2"
title = "never locked open"
text = "An open door is not locked."
kind = "property"
device = ["latch"]

[[clause]]
id = "DR-1-3"
title = "one door"
text = "There is one door."
kind = "assumption"
device = []

[[clause]]
id = "DR-1-4"
title = "colour"
text = "The door is green."
kind = "not modelled"
device = []
because = "colour decides nothing"
""",
    "spec/door/interface.toml": """
document = "door"
[constants]
DOORS = [1]
[devices.latch]
title = "the latch"
module = "Latch"
published = true
states = ["Open", "Shut"]
steps = ["CloseLatch", "OpenLatch"]
[devices.latch.memory]
state = { type = "text", clauses = ["DR-1-1"], why = "what the latch does" }
[devices.latch.inputs]
door_closed = { type = "bool", clauses = ["DR-1-1"], why = "the door is closed" }
[devices.latch.outputs]
LOCK_1 = { type = "bool", clauses = ["DR-1-1"], why = "the bolt is out" }
CODE = { type = "word", clauses = ["DR-1-1"], why = "a word" }
[devices.latch.parameters]
T_HOLD_ms = { type = "ms", min = 1, max = 1000, default = 100, clauses = ["DR-1-1"], why = "time to wait" }
""",
    "spec/door/properties.toml": """
[[property]]
id = "OpenIsUnlocked"
title = "an open door is not locked"
sentence = "While the door is open the bolt is in."
hazard = "the bolt hits the frame"
clauses = ["DR-1-2", "DR-1-1"]
findings = ["E-01"]
tla = "OpenIsUnlocked"
module = "Latch"
kind = "invariant"
environments = ["honest"]
antecedent = "open_seen"
""",
    "spec/door/killers.toml": """
[by_construction]
OpenIsUnlocked = "no run of this door can be started"
""",
    "spec/door/findings.toml": """
[[finding]]
id = "E-01"
title = "when it opens"
clauses = ["DR-1-1"]
says = "nothing"
readings = ["at once", "later"]
consequence = "none"
decision = "at once"
drawing_could_settle = true
tries = []
evidence = ["NEG_Latch", "the_bolt_moves"]
""",
    "spec/door/assumptions.toml": """
[[assumption]]
id = "A-01"
title = "one door"
text = "There is one door only."
kind = "assumption"
clauses = ["DR-1-3"]
who = "the builder"
check = "count"
breaks = ["NEG_Latch"]
""",
    "spec/door/runs.toml": """
[[run]]
id = "MC_Latch"
module = "Latch"
cfg = "models/MC_Latch.cfg"
lanes = ["smoke", "full"]
environment = "honest"
properties = ["TypeOK", "OpenIsUnlocked"]

[[run]]
id = "NEG_Latch"
module = "Latch"
cfg = "models/NEG_Latch.cfg"
lanes = ["full"]
environment = "honest"
properties = ["OpenIsUnlocked"]
property = "OpenIsUnlocked"

[[run]]
id = "WIT_Latch"
module = "Latch"
cfg = "models/WIT_Latch.cfg"
lanes = ["full"]
environment = "honest"
properties = []
witnesses = ["open_seen"]

[[run]]
id = "OPEN_Latch"
module = "Latch"
cfg = "models/OPEN_Latch.cfg"
lanes = ["full"]
environment = "honest"
properties = ["TypeOK", "PrintState"]
[run.graph]
device = "latch"
tick_ms = 10
params = { T_HOLD_ms = 20 }
""",
    "spec/door/Latch.tla": """------------------------------- MODULE Latch -------------------------------
(* The latch of the door; DR-1-1. *)
EXTENDS Naturals
CONSTANTS
    T_HOLD,  \\* ticks
    LITERAL
VARIABLES latchState  \\* what the latch does
Init == latchState = "Open"
\\* DR-1-1, E-01
CloseLatch(i) == latchState = "Open" /\\ i.door_closed /\\ latchState' = "Shut"
\\* DR-1-1
OpenLatch(i) ==
    \\* the other way
    latchState = "Shut" /\\ latchState' = "Open"
LOCK_1 == latchState = "Shut"
CODE == 0
TypeOK == latchState \\in {"Open", "Shut"}
PrintState == TRUE
(* DR-1-2 *)
OpenIsUnlocked == latchState = "Open" => ~LOCK_1
=============================================================================
""",
    "refimpl/__init__.py": "",
    "refimpl/door/__init__.py": "",
    "refimpl/door/latch.py": '''
"""The latch."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Step(Enum):
    """The states."""

    OPEN = "Open"
    SHUT = "Shut"


@dataclass(frozen=True)
class Params:
    """Times."""

    T_HOLD_ms: int = 100


@dataclass(frozen=True)
class State:
    """Memory."""

    params: Params
    state: Step


@dataclass(frozen=True)
class Inputs:
    """Inputs."""

    dt_ms: int
    door_closed: bool


@dataclass(frozen=True)
class Outputs:
    """Outputs."""

    LOCK_1: bool
    CODE: int


def power_up(params: Params) -> State:
    """At first open. DR-1-1"""
    return State(params, Step.OPEN)


def step(state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One scan."""
    # DR-1-1
    return state, Outputs(False, 0)


def _shut(state: State) -> State:
    """E-01"""
    return state
''',
    "proofs/__init__.py": "",
    "proofs/door/__init__.py": "",
    "proofs/door/strength.toml": """
[by_construction]
the_bolt_moves = "A toy: nothing proves it."
""",
    "proofs/door/bolt.py": '''
from proofs.theorem import theorem


@theorem(clauses=["DR-1-2"], findings=["E-01"])
def the_bolt_moves():
    """The bolt moves.

    More words.
    """
''',
    "modeproof/__init__.py": "",
    "README.md": "# A door\n",
}


class Tree:
    """A repository in a temporary folder, whose files a test edits."""

    def __init__(self, root: Path) -> None:
        self.root = root
        for name, text in FILES.items():
            self.write(name, text.lstrip("\n"))
        self.pin()

    def pin(self) -> None:
        """What properties and theorems say now is what they are to say."""
        document = load_document(self.root, "door")
        repin(document, read_sources(document), "a test")

    def problems(self) -> list[str]:
        """All that `modeproof registers` has to say of the door."""
        return [str(problem) for problem in judge(load_document(self.root, "door")).problems]

    def write(self, name: str, text: str) -> None:
        """Create or replace a file."""
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def edit(self, name: str, old: str, new: str) -> None:
        """Replace a text that must be there; a fault that was not planted would prove nothing."""
        text = (self.root / name).read_text(encoding="utf-8")
        assert old in text, f"{old!r} is not in {name}"
        self.write(name, text.replace(old, new, 1))


@pytest.fixture
def tree(tmp_path: Path) -> Tree:
    """The door, in a folder whose name has a space."""
    return Tree(tmp_path / "a door")


@pytest.fixture
def real_root() -> Path:
    """The root of this repository."""
    return Path(__file__).resolve().parents[2]


@pytest.fixture
def registers_command(monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """Run the command in a tree and give its exit status."""
    import argparse

    from modeproof.registers.registers_command import add_parser

    def call(root: Path, *arguments: str) -> int:
        monkeypatch.setenv("MODEPROOF_ROOT", str(root))
        parser = argparse.ArgumentParser()
        add_parser(parser.add_subparsers())
        args = parser.parse_args(["registers", *arguments])
        status: int = args.run(args)
        return status

    return call
