"""Serve any target of refimpl over adapter protocol 1. Usage: python refimpl_adapter.py TARGET

The names and types of a target come from the registers spec/<document>/interface.toml, so a new document
needs no line here. Our own checks use this to run every published target over stdio; python_adapter.py is the
shorter example to start from.
"""

from __future__ import annotations

import json
import re
import sys
import tomllib
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from refimpl.errors import InputError, ParameterError, checked  # noqa: E402

BYE: dict[str, object] = {"ok": True}
NONE = -1


def find_target(name: str) -> tuple[dict[str, Any], ModuleType]:
    """The register entry and the code of a target. Raises SystemExit naming the targets there are."""
    known = []
    for register in sorted(ROOT.glob("spec/*/interface.toml")):
        devices = tomllib.loads(register.read_text(encoding="utf-8"))["devices"]
        if name in devices:
            return devices[name], import_module(f"refimpl.{register.parent.name}.{name}")
        known += list(devices)
    raise SystemExit(f"refimpl_adapter.py: no target {name!r}; there are: {', '.join(known)}")


def from_wire(field: str, signal: dict[str, Any], value: object) -> Any:
    """A value as Python has it;

    only the form is judged here, ranges are judged where Inputs and Params are built.
    """
    kind = signal["type"]
    if kind in ("word", "function"):
        if not isinstance(value, str) or not re.fullmatch("[0-9A-F]{4}", value):
            raise InputError(field, value, "four upper-case hex digits")
        word = int(value, 16)
        return word if kind == "word" else lambda _data: word
    if kind == "mode" and value is None:
        return NONE
    if kind == "modes":
        modes = [mode for mode in range(5) if isinstance(value, list) and mode in value]
        if json.dumps(modes) != json.dumps(value):  # not [true], not [1.0], not [1, 0]
            raise InputError(field, value, "an ascending list of modes 0..4")
        return tuple(mode in modes for mode in range(5))
    if kind == "mode" and value == NONE:
        raise InputError(field, value, "0..4 or null")
    if kind == "text" and "" in signal["values"]:
        if value == "":
            raise InputError(field, value, "null for nothing")
        return "" if value is None else value
    return value


def to_wire(signal: dict[str, Any], value: Any) -> object:
    """A value as the protocol has it."""
    kind = signal["type"]
    if kind == "word":
        return f"{value:04X}"
    if kind == "mode" and value == NONE:
        return None
    if kind == "modes":
        return [mode for mode, member in enumerate(value) if member]
    if kind == "text" and "" in signal["values"]:
        return value or None
    return value


class Target:
    """One target of refimpl behind the protocol; ``state`` is None until the first reset."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.device, self.code = find_target(name)
        self.state: Any = None

    def hello(self) -> dict[str, object]:
        """What the adapter says of itself; the HMI adds the layout of its screen."""
        reply: dict[str, object] = {"ok": True, "name": "refimpl", "version": "1", "time": "virtual"}
        reply |= {"relations": ["exact"], "max_latency_scans": 0, "unobserved": [], "scans": True}
        if hasattr(self.code, "DEFAULT_LAYOUT"):
            self.code.check_layout(self.code.DEFAULT_LAYOUT)
            reply["layout"] = self.code.layout_record(self.code.DEFAULT_LAYOUT)
        return reply

    def power_up(self, params: dict[str, Any]) -> Any:
        """The power-up state with these parameters; omitted ones take the defaults."""
        declared = self.device["parameters"]
        for name in params:
            if name not in declared:
                raise ParameterError(name, params[name], f"nothing (no such parameter of {self.name})")
        values = {name: from_wire(name, declared[name], value) for name, value in params.items()}
        return self.code.power_up(checked(self.code.Params, values, ParameterError))

    def step(self, state: Any, dt_ms: Any, inputs: dict[str, Any]) -> tuple[Any, dict[str, object]]:
        """The state after a scan and the outputs; every input must be there and no other."""
        declared = self.device["inputs"]
        values = {"dt_ms": dt_ms}
        for name, value in inputs.items():
            if name not in declared:
                raise InputError(name, value, f"nothing (no such input of {self.name})")
            values[name] = from_wire(name, declared[name], value)
        state, out = self.code.step(state, checked(self.code.Inputs, values))
        wire = {name: to_wire(signal, getattr(out, name)) for name, signal in self.device["outputs"].items()}
        return state, wire

    def scan(self, state: Any, entry: dict[str, Any]) -> tuple[Any, dict[str, object]]:
        """One scan from ``state``. Raises on whatever is no scan."""
        if state is None:
            raise ValueError("scan before reset")
        if set(entry) != {"dt_ms", "in"}:
            raise ValueError(f"a scan has dt_ms and in, got {' '.join(entry)}")
        state, wire = self.step(state, entry["dt_ms"], entry["in"])
        return state, {"out": wire}

    def answer(self, message: dict[str, Any]) -> dict[str, object]:
        """The reply to one message. Raises on whatever it cannot serve; the state is then the old one."""
        op = message.pop("op")
        if op == "hello" and message == {"protocol": 1, "target": self.name}:
            return self.hello()
        if op == "reset" and set(message) <= {"params"}:
            self.state = self.power_up(message.get("params", {}))
            return {"ok": True}
        if op == "scan":
            self.state, reply = self.scan(self.state, message)
            return reply
        if op == "scans":
            if set(message) != {"list"}:
                raise ValueError(f"scans has a list and nothing else, got {' '.join(message)}")
            state, replies = self.state, []
            for entry in message["list"]:
                state, reply = self.scan(state, entry)
                replies.append(reply)
            self.state = state
            return {"list": replies}
        if op == "bye":
            return BYE
        raise ValueError(f"cannot serve {op} {message}; protocol 1, target {self.name} only")


def serve(target: Target) -> None:
    """Answer line by line until "bye" or the end of the input."""
    sys.stdin.reconfigure(encoding="utf-8", errors="replace")  # type: ignore[union-attr]
    reply: dict[str, object] = {}
    while reply is not BYE and (line := sys.stdin.readline()):
        try:
            reply = target.answer(json.loads(line))
        except Exception as error:  # whatever is wrong with a line, the answer is one line
            reply = {"error": " ".join(f"{type(error).__name__}: {error}".split())}
        print(json.dumps(reply), flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit("usage: python refimpl_adapter.py TARGET")
    serve(Target(sys.argv[1]))
