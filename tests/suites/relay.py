"""A small device that passes two words on, as an OPEN_ model would print it, and the program for it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from modeproof.graph.device import DeviceGraph, join
from modeproof.graph.read import read_graph
from modeproof.graph.values import ValueForms
from modeproof.kit.adapter import Adapter
from modeproof.registers.rows import Device
from tests.graph.printed import signal, write
from tests.kit.programs import PATIENT_S

WORDS = (0, 0x33CC, 1)
CLASSES = """
[[class]]
device = "relay"
rule = "copied"
fields = ["A", "B"]
words = ["33CC", "0001"]
codes = ["33CC", "0FF0"]
"""
DEVICE = Device(
    id="relay",
    title="a relay",
    module="Relay",
    published=True,
    states=("CopyA", "CopyB"),
    steps=("CopyA", "CopyB"),
    memory={},
    inputs={"A": signal("A", "word"), "B": signal("B", "word")},
    outputs={"X": signal("X", "word"), "Y": signal("Y", "word")},
    parameters={},
)
SERVE = """
import json, sys
one = lambda word: word
#FAULT
turn, x, y = 0, "0000", "0000"
def say(x): sys.stdout.write(json.dumps(x) + "\\n"); sys.stdout.flush()
for line in sys.stdin:
    m = json.loads(line)
    if m["op"] == "scan":
        if turn == 0: x = one(m["in"]["A"])
        else: y = m["in"]["B"]
        turn = 1 - turn
        say({"out": {"X": x, "Y": y}})
    else:
        if m["op"] == "reset": turn, x, y = 0, "0000", "0000"
        say({"ok": True})
        if m["op"] == "bye": break
"""


def relay_graph(folder: Path, change: Callable[[str], str] = lambda text: text) -> DeviceGraph:
    """The graph of the relay: it copies one word a scan, A to X and B to Y in turn."""
    room = folder / "spec" / "toy"
    room.mkdir(parents=True, exist_ok=True)
    (room / "interface.toml").write_text(change(CLASSES), encoding="utf-8")
    letters = [(a, b) for a in WORDS for b in WORDS]
    printed = [f'<<"INPUT", {n}, [A |-> {a}, B |-> {b}, dt |-> 1]>>' for n, (a, b) in enumerate(letters)]
    start = ("CopyA", 0, 0)
    printed += [f'<<"INIT", {_view(start)}>>', _state(start)]
    seen = [start]
    for state in seen:
        turn, x, y = state
        for n, (a, b) in enumerate(letters):
            after = ("CopyB", a, y) if turn == "CopyA" else ("CopyA", x, b)
            printed.append(f'<<"EDGE", {_view(state)}, "{turn}", {n}, {_view(after)}>>')
            if after not in seen:
                seen.append(after)
                printed.append(_state(after))
    graph = read_graph(write(folder / "OPEN_Relay.txt", printed))
    return join(
        "toy", "OPEN_Relay", DEVICE, ValueForms([0]), graph, tick_ms=10, params={}, passed={}, place=folder
    )


def _view(state: tuple[str, int, int]) -> str:
    return f'<<"{state[0]}", {state[1]}, {state[2]}>>'


def _state(state: tuple[str, int, int]) -> str:
    return f'<<"STATE", {_view(state)}, [X |-> {state[1]}, Y |-> {state[2]}]>>'


def relay_starter(folder: Path, fault: str = "") -> Callable[[], Adapter]:
    """What starts the relay behind an adapter, with a line of code that spoils it."""
    path = folder / "relay_adapter.py"
    path.write_text(SERVE.replace("#FAULT", fault), encoding="utf-8")
    return lambda: Adapter([sys.executable, "-S", str(path)], PATIENT_S)
