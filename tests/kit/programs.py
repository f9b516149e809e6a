"""Adapters that behave and misbehave: a Python program with one planted fault."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import IO

from modeproof.kit.adapter import Adapter
from modeproof.kit.lines import Lines, lines_of

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


def starter(folder: Path, fault: str = "", hangs_at: int | None = None) -> Callable[[], Adapter]:
    """What starts such an adapter, and keeps the processes it started in MADE.

    `hangs_at` is the number of the request, from 1 for hello, that it never answers.
    """
    command = program(folder, fault)

    def start() -> Adapter:
        made = Adapter(command, PATIENT_S) if hangs_at is None else Hanging(command, hangs_at)
        MADE.append(made)
        return made

    return start


PATIENT_S = 600.0
"""Limit for an answer that comes, on the busiest machine."""
IMPATIENT_S = 0.2
"""Limit for an answer that never comes."""


class Hanging(Adapter):
    """Waits as long as it takes for every answer but that to request `at`, which never comes."""

    def __init__(
        self, command: list[str], at: int, lines: Callable[[IO[bytes], int], Lines] = lines_of
    ) -> None:
        super().__init__(command, PATIENT_S, lines)
        self.left = at

    def ask_line(self, line: bytes, dt_ms: int = 0) -> bytes:
        self.left -= 1
        self.timeout_s = PATIENT_S if self.left else IMPATIENT_S
        return super().ask_line(line, dt_ms)


MADE: list[Adapter] = []
"""All adapters that tests started, the last one at the end."""
