"""Serve a whole machine over adapter protocol 1: python machine_adapter.py [WIRING.toml]

It runs the composed reference, refimpl/machine_cell; without a file the shipped wiring. So vectors can be
tried on a wiring with a mistake before they are tried on a PLC.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from refimpl.errors import InputError  # noqa: E402
from refimpl.machine_cell import cell as reference  # noqa: E402

BYE: dict[str, object] = {"ok": True}
HELLO: dict[str, object] = {"ok": True, "name": "wiring", "version": "1", "time": "virtual", "scans": True}
HELLO |= {"relations": ["exact"], "max_latency_scans": 0, "unobserved": []}


class Machine:
    """A wiring behind the protocol; ``state`` is None until the first reset."""

    def __init__(self, path: Path) -> None:
        self.cell = reference.load(path)
        self.state: reference.State | None = None

    def scan(self, state: reference.State | None, entry: dict[str, Any]) -> tuple[reference.State, Any]:
        """One scan from ``state``; raises on whatever is no scan of this machine."""
        if state is None:
            raise ValueError("scan before reset")
        if set(entry) != {"dt_ms", "in"}:
            raise ValueError(f"a scan has dt_ms and in, got {' '.join(entry)}")
        inputs = {name: self.from_wire(name, value) for name, value in entry["in"].items()}
        state, out = reference.step(self.cell, state, inputs, entry["dt_ms"])
        wire = {name: value if isinstance(value, bool) else f"{value:04X}" for name, value in out.items()}
        return state, {"out": wire}

    def from_wire(self, name: str, value: Any) -> Any:
        """A value as Python has it; what is no word stays as it is, and the machine refuses it."""
        if self.cell.inputs.get(name) != "WORD":
            return value
        if not isinstance(value, str) or not re.fullmatch("[0-9A-F]{4}", value):
            raise InputError(name, value, "four upper-case hex digits")
        return int(value, 16)

    def answer(self, message: dict[str, Any]) -> dict[str, object]:
        """The reply to one message. Raises on whatever it cannot serve; the state is then the old one."""
        op = message.pop("op")
        if op == "hello" and message == {"protocol": 1, "target": "machine_cell"}:
            return HELLO
        if op == "reset" and not message.get("params") and set(message) <= {"params"}:
            self.state = reference.power_up(self.cell)
            return {"ok": True}
        if op == "scan":
            self.state, reply = self.scan(self.state, message)
            return dict(reply)
        if op == "scans" and set(message) == {"list"}:
            state, replies = self.state, []
            for entry in message["list"]:
                state, reply = self.scan(state, entry)
                replies.append(reply)
            self.state = state
            return {"list": replies}
        if op == "bye":
            return BYE
        raise ValueError(f"cannot serve {op} {message}; protocol 1, a machine without parameters")


def main(arguments: list[str]) -> None:
    """Answer line by line until "bye" or the end of the input."""
    if len(arguments) > 1:
        raise SystemExit("usage: python machine_adapter.py [WIRING.toml]")
    machine = Machine(Path(arguments[0]) if arguments else ROOT / "spec/machine_cell/wiring.toml")
    sys.stdin.reconfigure(encoding="utf-8", errors="replace")  # type: ignore[union-attr]
    reply: dict[str, object] = {}
    while reply is not BYE and (line := sys.stdin.readline()):
        try:
            reply = machine.answer(json.loads(line))
        except Exception as error:  # whatever is wrong with a line, the answer is one line
            reply = {"error": " ".join(f"{type(error).__name__}: {error}".split())}
        print(json.dumps(reply), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
