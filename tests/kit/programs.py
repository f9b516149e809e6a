"""Adapters that behave and misbehave: a Python program with one planted fault."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from modeproof.kit.adapter import Adapter

SERVE = """
import json, sys, time
HELLO = {"ok": True, "name": "lamp", "version": "1", "time": "virtual", "relations": ["exact"],
         "max_latency_scans": 0, "unobserved": [], "scans": False}
def say(x): sys.stdout.write(x if isinstance(x, str) else json.dumps(x) + "\\n"); sys.stdout.flush()
on, elapsed, scans = False, 0, 0
def scan(m):
    global on, elapsed
    i = m["in"]
    elapsed += m["dt_ms"]
    if not on and i["press"] and same(i["word"]): on, elapsed = True, 0
    elif not on or elapsed >= LIMIT: on, elapsed = False, 0
    return {"LAMP": on, "MW": "0FF0" if on else "0000"}
LIMIT = 500
same = lambda word: word == "0FF0"
def answer(m, out): say({"out": out})
def greet(): say(HELLO)
#FAULT
for line in sys.stdin:
    m = json.loads(line)
    if m["op"] == "hello": greet()
    elif m["op"] == "reset":
        on, elapsed = False, 0
        say({"ok": True})
    elif m["op"] == "scan":
        scans += 1
        answer(m, scan(m))
    elif m["op"] == "scans":
        say({"list": [{"out": scan(one)} for one in m["list"]]})
    elif m["op"] == "bye":
        say({"ok": True})
        break
"""


def program(folder: Path, fault: str = "") -> list[str]:
    """The command line of the lamp behind an adapter, with lines of code that spoil it."""
    path = folder / "lamp_adapter.py"
    path.write_text(SERVE.replace("#FAULT", fault), encoding="utf-8")
    return [sys.executable, "-S", str(path)]


def starter(folder: Path, fault: str = "", timeout_s: float = 5.0) -> Callable[[], Adapter]:
    """What starts such an adapter, and keeps the processes it started in `starter.made`."""
    command = program(folder, fault)

    def start() -> Adapter:
        made = Adapter(command, timeout_s)
        MADE.append(made)
        return made

    return start


MADE: list[Adapter] = []
"""All adapters that tests started, the last one at the end."""
