"""The statement-list programs behind the S7 protocol, as a CPU would be: awlsim's memory on the wire.

Usage: python examples/awl/server.py TARGET [PROGRAM] [--port N] [--cycle MS]

It listens on 127.0.0.1, prints "listening on 127.0.0.1:PORT", and ends when its standard input does. Memory
is that of TARGET.map.csv. Without --cycle the program runs once each time @scan is written, and @done then
equals it. With --cycle it runs by itself, so many ms apart, counts its scans in DB2.DBW8, and dt is the time
that passed. Needs awlsim (GPL, see adapter.py) and python-snap7; a real CPU has neither.
"""

from __future__ import annotations

import argparse
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path

from snap7 import Server, SrvArea

sys.path.insert(0, str(Path(__file__).resolve().parent))

from adapter import HERE, LONGEST_MS, TARGETS, TIME, Cpu, read_map

SETTINGS, CYCLE = "DB1", "DB2"
CYCLES = slice(8, 10)
MAGIC = b"RIG!"
RESET = 10
AREAS = {"I": SrvArea.PE, "Q": SrvArea.PA, "M": SrvArea.MK}


class Plc:
    """One CPU: its memory is shared with the server, so a write over S7 is in it at once."""

    def __init__(self, target: str, program: Path) -> None:
        self.places = read_map(HERE / f"{target}.map.csv")
        self.cpu = Cpu(program, self.places)
        self.lock = threading.Lock()
        self.control = self.cpu.bytes[CYCLE]
        self.inputs = bytearray(len(self.cpu.bytes["I"]))
        self.stepped = True
        self.cpu.power_up({})

    def serve(self, port: int) -> Server:
        """Start the server."""
        server = Server(log=False)
        for area, memory in self.cpu.bytes.items():
            if area in AREAS:
                server.register_area(AREAS[area], 0, memory)
            else:
                server.register_area(SrvArea.DB, int(area[2:]), memory)
        server.register_area(SrvArea.DB, 3, self.inputs)
        server.register_area(SrvArea.DB, 4, bytearray(MAGIC))
        server.set_events_callback(lambda _event: self.look())
        server.start_to("127.0.0.1", port)
        return server

    def look(self) -> None:
        """After a telegram, before its answer: is power-up or a scan asked for?"""
        with self.lock:
            if self.control[RESET] & 1:
                self.inputs[:] = bytes(len(self.inputs))
                self.cpu.power_up({}, keep=[SETTINGS] if SETTINGS in self.cpu.bytes else [])
            if self.stepped and self.control[4:6] != self.control[6:8]:
                self.scan()
                self.control[6:8] = self.control[4:6]

    def scan(self) -> None:
        """What is written for the inputs goes to the inputs, then OB1 once."""
        self.cpu.bytes["I"][:] = self.inputs
        self.cpu.run(self.cpu.sim.runCycle)

    def run_freely(self, cycle_ms: int) -> None:
        """Scan after scan, by the clock; does not return."""
        self.stepped = False
        before, number = time.monotonic(), 0
        while True:
            time.sleep(cycle_ms / 1000)
            with self.lock:
                passed = int((time.monotonic() - before) * 1000)  # whole ms; the rest counts in the next scan
                before += passed / 1000
                self.cpu.write({TIME: min(passed, LONGEST_MS)})
                self.scan()
                number = (number + 1) & 0xFFFF
                self.control[CYCLES] = number.to_bytes(2, "big")


def main(arguments: Sequence[str]) -> None:
    """Serve until standard input ends."""
    parser = argparse.ArgumentParser(description="A statement-list program behind the S7 protocol.")
    parser.add_argument("target", choices=sorted(TARGETS))
    parser.add_argument("program", nargs="?", type=Path)
    parser.add_argument("--port", type=int, default=0, help="0: any free one")
    parser.add_argument("--cycle", type=int, metavar="MS", help="run freely, so many ms apart")
    args = parser.parse_args(arguments)
    plc = Plc(args.target, args.program or HERE / f"{args.target}.awl")
    server = plc.serve(args.port)
    assert server.server_socket is not None
    print(f"listening on 127.0.0.1:{server.server_socket.getsockname()[1]}", flush=True)
    if args.cycle is not None:
        threading.Thread(target=plc.run_freely, args=(args.cycle,), daemon=True).start()
    sys.stdin.read()


if __name__ == "__main__":
    main(sys.argv[1:])
