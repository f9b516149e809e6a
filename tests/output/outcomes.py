"""Outcomes made by hand, with text that somebody else wrote."""

from __future__ import annotations

from typing import Any

from modeproof.output.outcome import (
    Counterexample,
    Demand,
    File,
    Outcome,
    Problem,
    Rule,
    Scan,
    Spot,
    Tool,
)

FOREIGN = "</title><script>alert(1)</script>|`x` [a](http://evil) @me #1 _b_\n\x1b[31m&\ud800"
CLAUSE = Rule(id="AB-1", kind="clause", sentence="The lamp follows the key {0}.", source="A paper, page 2")
SCANS = [
    Scan(dt_ms=0, inputs={"Key": False, "W": "0000"}, given={"Lamp": False}, expected={"Lamp": False}),
    Scan(dt_ms=10, inputs={"Key": False, "W": "0000"}, given={"Lamp": False}, expected={"Lamp": False}),
    Scan(dt_ms=10, inputs={"Key": False, "W": "0000"}, given={"Lamp": False}, expected={"Lamp": False}),
    Scan(dt_ms=10, inputs={"Key": True, "W": "0FF0"}, given={"Lamp": False}, expected={"Lamp": True}),
]


def outcome(**changes: Any) -> Outcome:
    """A block whose lamp stays dark."""
    rule = Rule(id="lamp", kind="target", sentence="Block has the outputs of lamp.")
    problem = Problem(
        rule=rule,
        others=[CLAUSE],
        message="after 4 scans Lamp is FALSE, expected TRUE",
        spot=Spot(file="plc/my lamp.st", line=7),
        counterexample=Counterexample(scans=SCANS, wrong=["Lamp"], found_by="search", parameters={"T_ms": 5}),
    )
    demand = Demand(id="lamp", word="REFUTED", sentence="Block has the outputs of lamp.", problems=[problem])
    fields: dict[str, Any] = {
        "command": "prove-program",
        "subject": "Block",
        "target": "lamp",
        "word": "REFUTED",
        "status": 1,
        "sentence": "REFUTED: Block is not equal to lamp",
        "again": "modeproof prove-program 'plc/my lamp.st' --target lamp",
        "started": "2026-01-01T00:00:00Z",
        "seconds": 1.5,
        "demands": [demand],
        "files": [File(path="plc/my lamp.st", sha256="0" * 64, role="program")],
        "tools": [Tool(name="modeproof", version="1", sha256="1" * 64), Tool(name="python", version="3")],
        "not_shown": ["what the compiler makes of it"],
        **changes,
    }
    return Outcome(**fields)
