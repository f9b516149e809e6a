"""One block on its own card: inputs as switches, calls of 20 ms, and a log of what was played."""

from __future__ import annotations

import json
from typing import Any

from modeproof.simulate.program.device import Device, give, inputs_of, on_wire, take
from modeproof.simulate.program.reasons import NOTHING, Reasons
from modeproof.simulate.program.vectors import played

CALL_MS = 20


class Block:
    """A block after power-up; `params` are wire values, all inputs are FALSE."""

    def __init__(self, id: str, facts: dict[str, Any], params: dict[str, Any]) -> None:
        self.id, self.facts, self.row = id, facts, facts["devices"][id]
        self.params = params
        self.reset()

    def reset(self) -> None:
        """Power off and on; the switches stay as they are at first: off."""
        own = self.row["parameters"]
        params = {name: take(own[name], value) for name, value in self.params.items()}
        self.device = Device(self.facts["module"] + self.id, self.facts["labelled"][self.id], params)
        defaults = {name: of["default"] for name, of in own.items() if "default" in of}
        self.reasons = Reasons(self.facts["reasons"].get(self.id, NOTHING), defaults | self.params)
        self.given = dict.fromkeys(self.row["inputs"], False)
        self.wrote = on_wire(self.row["outputs"], self.device.out)
        self.lines: list[dict[str, Any]] = []
        self.took: list[list[str]] = []
        self.clock = self.scans = 0
        self.differs = ""

    def do(self, text: str) -> None:
        """`set NAME 1`, `flip NAME`, `call [MS [TIMES]]`, `round [TIMES]`, `param NAME VALUE`, `reset`.

        Raises ValueError for what is no action, or a kind of it for values out of range.
        """
        word, _, rest = text.strip().partition(" ")
        name, _, value = rest.partition(" ")
        if word in ("set", "flip") and name in self.given:
            self.reasons.acted(self.device.control())
            self.given[name] = value == "1" if word == "set" else not self.given[name]
        elif word == "call":
            for _ in range(int(value or 1)):
                self.call(int(name or CALL_MS))
        elif word == "round":
            for _ in range(int(name or 1)):
                self.call(CALL_MS)
        elif word == "param" and name in self.row["parameters"]:
            self.params = {**self.params, name: _typed(self.row["parameters"][name], value)}
            self.reset()
        elif word == "reset":
            self.reset()
        else:
            raise ValueError(f"{text!r} is no action of {self.id}")

    def call(self, dt_ms: int) -> None:
        """One call of the block with the switches as they are."""
        state = self.device.control()
        out = self.device.scan(inputs_of(self.device.code, self.row["inputs"], dt_ms, self.given))
        self.reasons.scanned(state, self.device.step, self.device.control())
        self.wrote = on_wire(self.row["outputs"], out)
        self.lines.append({"dt_ms": dt_ms, "in": dict(self.given), "out": self.wrote})
        self.took.append([self.device.step, self.device.control()])
        self.clock += dt_ms
        self.scans += 1

    def log(self) -> str:
        """Every call since power-up as JSON Lines, with the parameters in front."""
        rows = [{"target": self.id, "params": self.params}, *self.lines]
        return "".join([json.dumps(row, separators=(",", ":")) + "\n" for row in rows])

    def vectors(self, name: str) -> tuple[dict[str, Any], dict[str, Any]]:
        """Every call since power-up as a test case. Raises ValueError where there is none."""
        return played(self.facts, name, self.params, self.lines, self.took)

    def begin_log(self, header: dict[str, Any]) -> None:
        """Power up with the parameters of a log. Raises ValueError for a log of something else."""
        if header.get("target") != self.id:
            raise ValueError(
                f"a log of {header.get('target')!r} cannot be played here, only one of {self.id!r}"
            )
        self.params = header.get("params", {})
        self.reset()

    def play(self, line: dict[str, Any]) -> None:
        """One line of a log: a call with the inputs that the line shows."""
        self.given = {name: line["in"][name] for name in self.row["inputs"]}
        self.call(line["dt_ms"])
        for output, logged in line.get("out", {}).items():
            if self.wrote[output] != logged and not self.differs:
                self.differs = f"call {self.scans}: {output} is {self.wrote[output]}, the log has {logged}"

    def show(self) -> dict[str, Any]:
        """What is where: texts, what is lit, the step."""
        lamps = {name: value for name, value in self.wrote.items() if isinstance(value, bool)}
        words = {name: str(value) for name, value in self.wrote.items() if not isinstance(value, bool)}
        state = self.device.control()
        text = {"time": f"{self.clock / 1000:.2f} s", "scans": str(self.scans), "differs": self.differs}
        return {
            "text": {**text, **words, "says": spelt(state)},
            "on": {**lamps, **{f"in.{name}": value for name, value in self.given.items()}},
            "open": {},
            "devices": {self.id: {"state": state, "step": self.device.step, "last": self.scans > 0}},
            "why": {self.id: self.reasons.show(state, bool(self.wrote.get("Error")), [])},
        }


def recorded(row: dict[str, Any], id: str, rows: list[dict[str, Any]]) -> dict[str, Any]:
    """The last of some recorded rows as the card shows it: what the evidence has, and nothing else.

    `row` is that of the block in the interface.
    """
    last = rows[-1]
    on: dict[str, bool] = {}
    text = {"time": "not recorded", "scans": str(sum([of["who"] == id for of in rows])), "differs": ""}
    for name, of in row["outputs"].items():
        if of["type"] == "bool":
            on[name] = bool(last["wires"].get(name))
        else:
            text[name] = str(give(of, last["wires"][name])) if name in last["wires"] else "not recorded"
    for name in row["inputs"]:
        on[f"in.{name}"] = bool(last["wires"].get(name))
    if not set(row["inputs"]) & set(last["wires"]):
        text["differs"] = "Inputs are not recorded in this model."
    state = last["states"].get(id, "")
    text["says"] = spelt(state)
    step = {"state": state, "step": last["step"] if last["who"] == id else "", "last": True}
    return {"text": text, "on": on, "open": {}, "devices": {id: step}}


def spelt(name: str) -> str:
    """A name of a state in words: its capitals and numbers begin words."""
    out = ""
    for at, sign in enumerate(name):
        before, after = name[at - 1 : at], name[at + 1 : at + 2]
        begins = sign.isupper() and (before.islower() or before.isdigit() or after.islower())
        begins = begins or (sign.isdigit() and not before.isdigit())
        out += (" " if begins and at else "") + sign
    words = [word if word.isupper() and len(word) > 1 else word.lower() for word in out.split(" ")]
    return " ".join(words)


def _typed(of: dict[str, Any], text: str) -> Any:
    if of["type"] in ("ms", "int"):
        return int(text)
    return text == "true" if of["type"] == "bool" else text
