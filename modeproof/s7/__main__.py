"""The adapter: one line of JSON in, one line of JSON out, and between them the memory of a PLC."""

from __future__ import annotations

import json
import signal
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from modeproof.kit.again import TEST_RIG
from modeproof.kit.errors import Unjudged
from modeproof.kit.parser import Parser
from modeproof.kit.signals import Signal, loads, read_signals, shown
from modeproof.kit.vectors import Suite, open_suite
from modeproof.s7.program import S7Program, connect

FIELDS = {"hello": {"protocol", "target"}, "reset": {"params"}, "scan": {"dt_ms", "in"}, "bye": set[str]()}


class Adapter:
    """Answers the requests of protocol 1. The connection is made when hello comes."""

    def __init__(self, host: str, places: Path, suite: Suite, timeout_s: float) -> None:
        self._host, self._places, self._suite, self._timeout_s = host, places, suite, timeout_s
        self._parameters = read_signals(suite.parameters, "parameters")
        self._plc: S7Program | None = None
        self._ready = False
        self.ended = False

    def answer(self, line: bytes) -> dict[str, Any]:
        """The answer to one request; what cannot be done is refused in one line."""
        try:
            request = loads(line.decode("utf-8"))
            if not isinstance(request, dict):
                raise Unjudged(f"an object expected, got {shown(request)}")
            op = request.pop("op", None)
            if not isinstance(op, str) or op not in FIELDS:
                raise Unjudged(f"op must be one of {', '.join(FIELDS)}, got {shown(op)}")
            if set(request) - FIELDS[op] or (op != "reset" and FIELDS[op] - set(request)):
                raise Unjudged(f"{op} has {', '.join(FIELDS[op]) or 'no fields'}, got {shown(list(request))}")
            return {"hello": self._hello, "reset": self._reset, "scan": self._scan, "bye": self._bye}[op](
                request
            )
        except (Unjudged, ValueError, RecursionError) as error:
            return {"error": " ".join(str(error).split()) or type(error).__name__}

    def _hello(self, request: Mapping[str, Any]) -> dict[str, Any]:
        if type(request["protocol"]) is not int or request["protocol"] != 1:
            raise Unjudged(f"protocol 1 expected, got {shown(request['protocol'])}")
        if request["target"] != self._suite.target:
            raise Unjudged(f"the vectors are of {self._suite.target}, not of {shown(request['target'])}")
        if self._plc is None:
            self._plc = connect(self._host, self._places, self._suite, self._timeout_s)
        return dict(self._plc.hello(self._suite.target))

    def _reset(self, request: Mapping[str, Any]) -> dict[str, Any]:
        params = request.get("params", {})
        _check(params, self._parameters)
        self._connected().reset(params)
        self._ready = True
        return {"ok": True}

    def _scan(self, request: Mapping[str, Any]) -> dict[str, Any]:
        inputs, dt_ms = request["in"], request["dt_ms"]
        if not self._ready:
            raise Unjudged("scan before reset")
        if type(dt_ms) is not int or dt_ms < 0:
            raise Unjudged(f"dt_ms: milliseconds from 0 expected, got {shown(dt_ms)}")
        _check(inputs, self._suite.inputs)
        if missing := [name for name in self._suite.inputs if name not in inputs]:
            raise Unjudged(f"input {missing[0]} is missing")
        return {"out": dict(self._connected().scan(dt_ms, inputs))}

    def _bye(self, request: Mapping[str, Any]) -> dict[str, Any]:
        self.ended = True
        self.close()
        return {"ok": True}

    def _connected(self) -> S7Program:
        if self._plc is None:
            raise Unjudged("hello must come first")
        return self._plc

    def close(self) -> None:
        """Put back what was written, and hang up."""
        if self._plc is not None:
            self._plc.close()


def _check(values: Any, signals: Mapping[str, Signal]) -> None:
    """Raises Unjudged for values that are no values of these signals."""
    if not isinstance(values, dict):
        raise Unjudged(f"an object expected, got {shown(values)}")
    for name, value in values.items():
        fault = signals[name].fault(value) if name in signals else f"{name}: not known"
        if fault:
            raise Unjudged(fault)


def main(argv: list[str] | None = None) -> int:
    """Serve until bye or the end of the input."""
    parser = Parser(prog="python -m modeproof.s7", description="a PLC as an adapter")
    parser.add_argument("target", metavar="TARGET", help="what the program in the PLC claims to be")
    parser.add_argument("--host", required=True, metavar="HOST[:PORT]", help="the PLC; the port of S7 is 102")
    parser.add_argument(
        "--map", type=Path, required=True, metavar="FILE", help="addresses of the signals, CSV"
    )
    parser.add_argument(
        "--vectors",
        type=Path,
        required=True,
        metavar="FILE",
        help="any vectors of TARGET: their header has its signals",
    )
    parser.add_argument("--member", default="", metavar="NAME", help="the vector file in the archive FILE")
    parser.add_argument("--timeout", type=float, default=10.0, metavar="S", help="limit for the PLC (10 s)")
    parser.add_argument(TEST_RIG, dest="test_rig", action="store_true", help="no machine hangs on this PLC")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(2))  # so that what was written is put back
    try:
        args = parser.parse_args(argv)
        if not args.test_rig:
            raise Unjudged(f"this writes into the memory of a PLC: {TEST_RIG} is missing (docs/s7.md)")
        suite = open_suite(args.vectors, args.member)
        if suite.target != args.target:
            raise Unjudged(f"{args.vectors}: vectors of {suite.target}, not of {args.target}")
    except Unjudged as error:
        print(f"modeproof.s7: {error}", file=sys.stderr)
        return 2
    adapter = Adapter(args.host, args.map, suite, args.timeout)
    try:
        while not adapter.ended and (line := sys.stdin.buffer.readline()):
            print(json.dumps(adapter.answer(line), separators=(",", ":")), flush=True)
    finally:
        adapter.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
