"""Adapter protocol 1 in Python: one line of JSON in, one line of JSON out.

Usage: python python_adapter.py fplc

It serves our reference implementation as target fplc. For a program of your own, replace the lines marked
<--.
"""

import json
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # <-- where the program is found
from refimpl.mode_selection import fplc

WORDS, BOOLS = {"MW03", "MW07"}, {"LA", "A", "B", "C", "D", "STR"}
HELLO = {"ok": True, "name": "refimpl", "version": "1", "time": "virtual", "relations": ["exact"]}
HELLO |= {"max_latency_scans": 0, "unobserved": [], "scans": True}
BYE = {"ok": True}


def parameters(wire):
    values = dict(wire)
    for name in [name for name in wire if name.startswith("PERMITS_")]:
        permitted = [mode for mode in range(5) if isinstance(wire[name], list) and mode in wire[name]]
        if json.dumps(permitted) != json.dumps(wire[name]):  # not [true], not [1.0], not [1, 0]
            raise ValueError(f"{name}: an ascending list of modes 0..4 expected, got {wire[name]}")
        values[name] = tuple(mode in permitted for mode in range(5))
    return fplc.Params(**values)


def scan(state, entry):
    if state is None:
        raise ValueError("scan before reset")
    if set(entry) != {"dt_ms", "in"} or set(entry["in"]) != WORDS | BOOLS:
        raise ValueError(f"a scan has dt_ms and in, with exactly {' '.join(sorted(WORDS | BOOLS))}")
    values = dict(entry["in"])
    for name in WORDS:
        if not re.fullmatch("[0-9A-F]{4}", values[name]):
            raise ValueError(f"{name}: four upper-case hex digits expected, got {values[name]}")
        values[name] = int(values[name], 16)
    state, out = fplc.step(state, fplc.Inputs(entry["dt_ms"], **values))  # <-- one scan
    wire = {name: getattr(out, name) for name in out.__slots__}
    return state, wire | {name: f"{wire[name]:04X}" for name in ("MW01", "MW05")}


def answer(state, op, message):
    if op == "hello" and message == {"protocol": 1, "target": "fplc"} and sys.argv[1:] == ["fplc"]:
        return state, HELLO
    if op == "reset" and set(message) <= {"params"}:
        return fplc.power_up(parameters(message.get("params", {}))), {"ok": True}  # <-- power-up
    if op == "scan":
        state, out = scan(state, message)
        return state, {"out": out}
    if op == "scans":  # optional, for speed
        outs = []
        for entry in message["list"]:
            state, out = scan(state, entry)
            outs.append({"out": out})
        return state, {"list": outs}
    if op == "bye":
        return state, BYE
    raise ValueError(f"cannot serve {op} {message}; protocol 1, target fplc only")


sys.stdin.reconfigure(encoding="utf-8", errors="replace")
state, reply = None, None
while reply is not BYE and (line := sys.stdin.readline()):
    try:
        message = json.loads(line)
        state, reply = answer(state, message.pop("op"), message)
    except Exception as error:  # whatever is wrong with a line, the answer is one line
        reply = {"error": " ".join(f"{type(error).__name__}: {error}".split())}
    print(json.dumps(reply), flush=True)
