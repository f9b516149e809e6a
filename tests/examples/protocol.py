"""Lines of adapter protocol 1 for target fplc, good ones and such as every adapter must refuse."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

HELLO = {"op": "hello", "protocol": 1, "target": "fplc"}
RESET: dict[str, Any] = {"op": "reset"}
BYE = {"op": "bye"}
DARK = {
    "MW01": "0000",
    "MW05": "0000",
    "MSO_0": False,
    "MSO_1": False,
    "MSO_2": False,
    "MSO_3": False,
    "MSO_4": False,
    "ERROR": False,
}


def wire(LA: bool = False, on: str = "", MW03: str = "0000", MW07: str = "0000") -> dict[str, Any]:
    return {
        "LA": LA,
        **{name: name in on.split() for name in ("A", "B", "C", "D", "STR")},
        "MW03": MW03,
        "MW07": MW07,
    }


def scan(dt_ms: Any = 10, **inputs: Any) -> dict[str, Any]:
    return {"op": "scan", "dt_ms": dt_ms, "in": wire(**inputs)}


def talk(command: Sequence[str], lines: Sequence[Any], cwd: Path) -> list[dict[str, Any]]:
    """Run the adapter on these lines (text is sent as it is) and return one reply a line."""
    text = "".join(line if isinstance(line, str) else json.dumps(line) + "\n" for line in lines)
    done = subprocess.run(
        command,
        input=text.encode("utf-8", "surrogateescape"),
        capture_output=True,
        cwd=cwd,
        timeout=600,
        check=True,
    )
    assert done.stderr == b""
    return [json.loads(line) for line in done.stdout.decode().splitlines()]


def without(name: str) -> dict[str, Any]:
    entry = scan()
    del entry["in"][name]
    return entry


REFUSED = [
    ("not JSON at all\n", "JSONDecodeError"),
    ("\n", "JSONDecodeError"),
    ('{"op":"scan"\n', "JSONDecodeError"),
    ("[1,2]\n", "error"),
    ("3\n", "error"),
    ("{}\n", "op"),
    ("\udcff\udcfe\n", "error"),
    ({"op": "jump"}, "jump"),
    ({"op": None}, "None"),
    ({"op": "hello", "protocol": 2, "target": "fplc"}, "protocol 1"),
    ({"op": "hello", "protocol": 1, "target": "plc"}, "fplc"),
    ({"op": "reset", "params": {"T_HUH_ms": 1}}, "T_HUH_ms"),
    ({"op": "reset", "params": {"T_ON_ms": "1000"}}, "T_ON_ms"),
    ({"op": "reset", "params": {"T_REM_ms": 500, "T_DWELL_ms": 500}}, "T_DWELL_ms"),
    ({"op": "reset", "params": {"T_ON_ms": 1001, "T_SEQ_FROM": "LA"}}, "T_SEQ_ms"),
    ({"op": "reset", "params": {"T_SEQ_FROM": "zeros"}}, "T_SEQ_FROM"),
    *[
        ({"op": "reset", "params": {"PERMITS_1": wrong}}, "PERMITS_1")
        for wrong in ([1, 0], [0, 0, 1], [1, 5], [0], [1, 2], [], 1, None, "1", [True], [1.0], [None], [[1]])
    ],
    ({"op": "reset", "params": {"PERMITS_5": [1]}}, "PERMITS_5"),
    ({"op": "reset", "parameters": {}}, "parameters"),
    ({"op": "scan", "dt_ms": 10}, "in"),
    ({"op": "scan", "in": wire()}, "dt_ms"),
    (scan() | {"extra": 1}, "in"),
    (without("MW07"), "MW07"),
    (without("LA"), "LA"),
    ({"op": "scan", "dt_ms": 10, "in": wire() | {"MW09": "0000"}}, "in"),
    (scan(MW03="ff0"), "MW03"),
    (scan(MW03="0ff0"), "MW03"),
    (scan(MW03="10000"), "MW03"),
    (scan(MW03="-001"), "MW03"),
    (scan(dt_ms=-1), "dt_ms"),
    (scan(dt_ms="10"), "dt_ms"),
    (scan(dt_ms=True), "dt_ms"),
    ({"op": "scan", "dt_ms": 10, "in": wire() | {"LA": 1}}, "LA"),
    ({"op": "scan", "dt_ms": 10, "in": wire() | {"MW07": 4080}}, "error"),
    ({"op": "scan", "dt_ms": 10, "in": wire() | {"STR": None}}, "STR"),
    ({"op": "scans", "list": [{"dt_ms": 10, "in": {}}]}, "in"),
    ({"op": "scans"}, "list"),
]
