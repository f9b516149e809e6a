"""A small device as an OPEN_ model would print it, and faults to plant in the print.

The device `lamp` has a button and a word: pressed with the code 0FF0 it goes on; on for two ticks it goes
off.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from modeproof.graph.device import DeviceGraph, graph_file, join, open_runs
from modeproof.graph.implementation import Implementation, from_module
from modeproof.graph.read import read_graph
from modeproof.graph.values import ValueForms
from modeproof.ground import evidence
from modeproof.registers.rows import Device, Signal
from modeproof.tlc.rests import declaration_sha256, inputs_of

CODE, OTHER, TICK_MS, LIMIT = 0x0FF0, 1, 250, 2

State = tuple[str, int]
Letter = tuple[bool, int, int]

LETTERS: tuple[Letter, ...] = tuple(
    (press, word, dt) for press in (False, True) for word in (0, CODE, OTHER) for dt in (0, 1, 2)
)


def successor(state: State, letter: Letter) -> tuple[str, State]:
    """One scan in the words of the specification."""
    (name, elapsed), (press, word, dt) = state, letter
    if name == "Off":
        if press and word == CODE:
            return "SwitchOn", ("On", 0)
        return "StayOff", ("Off", 0)
    if elapsed + dt >= LIMIT:
        return "Expire", ("Off", 0)
    return "StayOn", ("On", elapsed + dt)


def view(state: State) -> str:
    return f'<<"{state[0]}", {{}}, {state[1]}>>'


def row(state: State) -> str:
    on = state[0] == "On"
    return f"[LAMP |-> {str(on).upper()}, MW |-> {CODE if on else 0}]"


def lines() -> list[str]:
    """What TLC prints, unquoted."""
    printed = [
        f'<<"INPUT", {n}, [dt |-> {dt}, press |-> {str(press).upper()}, word |-> {word}]>>'
        for n, (press, word, dt) in enumerate(LETTERS)
    ]
    start: State = ("Off", 0)
    printed += [f'<<"INIT", {view(start)}>>', f'<<"STATE", {view(start)}, {row(start)}>>']
    seen, queue = {start}, [start]
    for state in queue:
        for n, letter in enumerate(LETTERS):
            step, after = successor(state, letter)
            printed.append(f'<<"EDGE", {view(state)}, "{step}", {n}, {view(after)}>>')
            if after not in seen:
                seen.add(after)
                queue.append(after)
                printed.append(f'<<"STATE", {view(after)}, {row(after)}>>')
    return printed


def quoted(line: str) -> str:
    return '"' + line.replace("\\", "\\\\").replace('"', '\\"') + '"'


def write(path: Path, printed: Iterable[str]) -> Path:
    path.write_text("".join(f"{line}\n" for line in printed), encoding="utf-8")
    return path


def vouch(place: Path, document: str) -> None:
    """Write the evidence of each printed graph, as if TLC had made it from what is there now."""
    for run in open_runs(place, document):
        printed = graph_file(place, run)
        (name, digest), *_ = evidence.hashes(place, [printed]).items()
        record = evidence.make(
            kind="tlc",
            id=run.id,
            document=document,
            verdict="HOLDS",
            expected="HOLDS",
            as_expected=True,
            command="modeproof check",
            started=0.0,
            seconds=1.0,
            inputs=inputs_of(place, run),
            result={"declaration": declaration_sha256(run), "graph": {"file": name, "sha256": digest}},
        )
        evidence.write(place, record)


def signal(name: str, kind: str, **more: Any) -> Signal:
    return Signal(name=name, type=kind, clauses=(), why="test", python=name, tla=name, **more)


DEVICE = Device(
    id="lamp",
    title="a lamp",
    module="Lamp",
    published=True,
    states=("Off", "On"),
    steps=("StayOff", "SwitchOn", "StayOn", "Expire"),
    memory={},
    inputs={"press": signal("press", "bool"), "word": signal("word", "word")},
    outputs={"LAMP": signal("LAMP", "bool"), "MW": signal("MW", "word")},
    parameters={"T_ms": signal("T_ms", "ms", minimum=1, default=500)},
)

SEQUENCES = """
[tables]
CODE = ["0FF0"]
[groups]
buttons = ["press"]
[[flow]]
name = "shine"
device = "lamp"
graph = "OPEN_Lamp"
for = { n = [0] }
why = "Figure {n}: the button is pressed with the code, and the lamp shines for its time."
clauses = ["TOY-1"]
scans = [
    { set = { buttons = [], word = "0000" }, dt_ms = 250, step = "StayOff" },
    { set = { buttons = ["press"], word = "CODE[n]" }, step = "SwitchOn" },
    { set = { buttons = [] }, dt_ms = 0, times = 2, step = "StayOn" },
    { dt_ms = 500, step = "Expire" },
]
[[branch]]
of = "shine"
at = ["SwitchOn"]
why = "Figure {n}: a word that is no code, and {at} does not come."
clauses = ["TOY-1"]
basis = "finding:T-01"
scans = [{ set = { buttons = ["press"], word = "0001" }, step = "StayOff" }]
[[branch]]
of = "shine"
why = "Figure {n}: and once more."
clauses = ["TOY-1", "TOY-1"]
scans = [{ set = { press = true }, dt_ms = 0, step = "SwitchOn" }]
"""
"""What the lamp's diagram would be."""

WORDS = '[[class]]\ndevice = "lamp"\nrule = "words"\nfield = "word"\nrepresentative = "0001"\n'


def lamp_graph(
    folder: Path, printed: Iterable[str] | None = None, classes: str = WORDS, sequences: str = SEQUENCES
) -> DeviceGraph:
    """The graph of the lamp, joined with its declaration."""
    room = folder / "spec" / "toy"
    room.mkdir(parents=True, exist_ok=True)
    (room / "interface.toml").write_text(classes, encoding="utf-8")
    (room / "sequences.toml").write_text(sequences, encoding="utf-8")
    graph = read_graph(write(folder / "OPEN_Lamp.txt", lines() if printed is None else printed))
    return join(
        "toy",
        "OPEN_Lamp",
        DEVICE,
        ValueForms([0, 1]),
        graph,
        tick_ms=TICK_MS,
        params={"T_ms": 500},
        passed={},
        place=folder,
    )


@dataclass(frozen=True)
class Params:
    T_ms: int = 500


@dataclass(frozen=True)
class Memory:
    params: Params
    on: bool
    elapsed_ms: int
    extra: int = 0


@dataclass(frozen=True)
class Inputs:
    dt_ms: int
    press: bool
    word: int


@dataclass(frozen=True)
class Outputs:
    LAMP: bool
    MW: int


def power_up(params: Params) -> Memory:
    return Memory(params, False, 0)


def step(state: Memory, i: Inputs) -> tuple[Memory, Outputs]:
    """The lamp as a programmer would write it."""
    elapsed = state.elapsed_ms + i.dt_ms
    if not state.on and i.press and i.word == CODE:
        after = Memory(state.params, True, 0)
    elif state.on and elapsed < state.params.T_ms:
        after = Memory(state.params, True, elapsed)
    else:
        after = Memory(state.params, False, 0)
    return after, row_of(after)


def row_of(after: Memory) -> Outputs:
    return Outputs(after.on, CODE if after.on else 0)


def lamp(**changed: Any) -> Implementation:
    """The lamp, or a variant with some of its five names replaced."""
    names = {"Params": Params, "Inputs": Inputs, "Outputs": Outputs, "power_up": power_up, "step": step}
    return from_module(SimpleNamespace(**{**names, **changed}), "lamp")
