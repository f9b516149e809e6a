"""A program in a PLC over the S7 protocol: inputs are written into its memory, outputs read out of it.

Needs python-snap7, an extra of modeproof that is imported only here and only when it is used. The address
map (`modeproof.s7.map`) says where everything lies. How the program is stepped depends on the symbols that
the map has for it:

    @magic DINT         always: holds MAGIC_NUMBER in a PLC that is a test rig; else nothing is written
    @reset BOOL         always: set by us; the program puts itself in its power-up state and clears it
    @scan, @done WORD   virtual time: we count @scan up, the program runs once and copies it to @done
    @dt_ms DINT         with these: the time since the scan before, in ms
    @cycle WORD         real time: the program counts its own cycles there

With real time nothing stops the program between two cycles; so an input counts as seen when @cycle has gone
on by two, and relation exact is not possible. What is written into the memory of an F-CPU is not what its
inputs are: see docs/s7.md. What was written is put back at the end, but for @scan, which would start a scan.
Before each scan, and before anything is put back, @magic is read again. Bits that have no name in the map are
somebody else's: they are written as they were found, and where one changes within a case, nothing is written.
"""

from __future__ import annotations

import contextlib
import logging
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import Signal, read_signals
from modeproof.kit.vectors import Suite
from modeproof.s7.map import (
    BYTES,
    CYCLE,
    DONE,
    MAGIC,
    MAGIC_NUMBER,
    RESET,
    STEP,
    TIME,
    AddressMap,
    Place,
    bytes_of,
    decode,
    encode,
    read_map,
)

PORT = 102
RACK, SLOT = 0, 2
"""Where the CPU of an S7-300 sits."""
LONGEST_MS = 3_600_000
"""A longer time between two scans says nothing more, and might not fit."""
CYCLES = 2
"""So many cycles after a write have surely read it: the write may have come into the middle of one."""
SEEN_SCANS = 2
"""With real time, inputs that are written in two telegrams may be read in two cycles."""
GAP = 16
"""Places that are so many bytes apart at most are read together."""


@dataclass(frozen=True)
class Block:
    """Bytes that are read or written in one telegram."""

    area: str
    block: int
    first: int
    last: int

    @property
    def size(self) -> int:
        """How many bytes."""
        return self.last - self.first + 1

    def holds(self, place: Place) -> bool:
        """Whether a place lies in it."""
        own = (self.area, self.block) == (place.area, place.block)
        return own and self.first <= place.byte and place.last <= self.last


def blocks_of(places: Iterable[Place], gap: int) -> list[Block]:
    """The fewest blocks that hold these places and no more than `gap` bytes between two of them."""
    found: list[Block] = []
    for area, block, byte in sorted({one for place in places for one in bytes_of(place)}):
        before = found[-1] if found else None
        if before and (before.area, before.block) == (area, block) and byte - before.last <= gap + 1:
            found[-1] = Block(area, block, before.first, byte)
        else:
            found.append(Block(area, block, byte, byte))
    return found


def connect(address: str, map_file: Path, suite: Suite, timeout_s: float = 10.0) -> S7Program:
    """The program behind HOST[:PORT], as the map has it.

    Raises Unjudged: no python-snap7, an address or a map that cannot be used, nobody there.
    """
    host, port = split_address(address)
    parameters = read_signals(suite.parameters, f"{suite.path.name}: parameters")
    places = read_map(map_file, suite.inputs, suite.outputs, parameters)
    defaults = {name: row.get("default") for name, row in suite.parameters.items()}
    try:
        import snap7
    except ImportError:
        raise Unjudged("--s7 needs python-snap7: pip install 'python-snap7>=3.3,<4'") from None
    logging.getLogger("snap7").setLevel(logging.CRITICAL + 1)  # what goes wrong is said once, by us
    signals = {**suite.inputs, **suite.outputs, **parameters}
    return S7Program(snap7, host, port, places, signals, defaults, timeout_s)


def split_address(address: str) -> tuple[str, int]:
    """Host and port of HOST[:PORT]; the port of S7 is 102. Raises Unjudged."""
    host, colon, port = address.rpartition(":")
    if not colon:
        host, port = address, str(PORT)
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise Unjudged(f"--s7: HOST[:PORT] expected, got {address}")
    return host, int(port)


class S7Program:
    """A program in a PLC; its methods are those of `modeproof.kit.adapter.Program`."""

    def __init__(
        self,
        snap7: Any,
        host: str,
        port: int,
        places: AddressMap,
        signals: Mapping[str, Signal],
        defaults: Mapping[str, Any],
        timeout_s: float,
    ) -> None:
        self._places, self._signals, self._defaults = places, signals, defaults
        self._timeout_s = timeout_s
        self._where = f"{host}:{port}"
        self._snap7 = snap7
        self._areas = {"I": snap7.Area.PE, "Q": snap7.Area.PA, "M": snap7.Area.MK, "DB": snap7.Area.DB}
        controls = places.controls
        stepped = {STEP, DONE, TIME} <= set(controls)
        for needed, why in ((MAGIC, "nothing tells a test rig from a machine"), (RESET, "no case can begin")):
            if needed not in controls:
                raise Unjudged(f"the map has no {needed}, so {why}; see docs/s7.md")
        if not stepped and (CYCLE not in controls or {STEP, DONE, TIME} & set(controls)):
            raise Unjudged(f"the map needs {STEP}, {DONE} and {TIME} (virtual time), or {CYCLE} (real time)")
        self.virtual = stepped
        self._number = 0
        self._last_scan = time.monotonic()
        self._observed = blocks_of(places.outputs.values(), GAP)
        self._written = blocks_of([*places.inputs.values(), *([controls[TIME]] if stepped else [])], 0)
        self._set = blocks_of(places.parameters.values(), 0)
        self._touched = False
        self._before: dict[Block, bytes] = {}
        self._others: dict[Block, bytes] = {}
        self._client = snap7.Client()
        self._connect(host, port)
        try:
            self._recognize()
            for block in (*self._written, *self._set, self._block_of(RESET)):
                self._before[block] = self._read(block)
        except Unjudged:
            self._hang_up()
            raise

    def _connect(self, host: str, port: int) -> None:
        try:
            self._client.connect(host, RACK, SLOT, port)
            self._client.connection.timeout = self._timeout_s
            self._client.connection.socket.settimeout(self._timeout_s)
        except (self._snap7.error.S7Error, OSError, RuntimeError, ValueError) as error:
            raise Unjudged(
                f"no S7 server at {self._where}: {error}; is the address right, the CPU on?"
            ) from None

    def _recognize(self) -> None:
        """Raises Unjudged when the PLC does not hold the magic number: it may run a machine."""
        found = self._read_control(MAGIC) % (1 << 32)
        if found != MAGIC_NUMBER:
            raise Unjudged(
                f"S7 server {self._where}: {MAGIC} {self._places.controls[MAGIC].address} holds "
                f"16#{found:08X} and not 16#{MAGIC_NUMBER:08X}, so this PLC is no test rig; "
                f"nothing {'more is' if self._touched else 'was'} written"
            )

    # ------------------------------------------------------------------------------------------ program

    def hello(self, target: str) -> Mapping[str, Any]:
        """As `Program.hello`; nothing is asked of the PLC."""
        return {
            "ok": True,
            "name": f"S7 {self._where}",
            "version": "",
            "time": "virtual" if self.virtual else "real",
            "relations": ["exact", "settled", "monitor"] if self.virtual else ["settled", "monitor"],
            "max_latency_scans": 0 if self.virtual else SEEN_SCANS,
            "unobserved": list(self._places.unobserved),
        }

    def reset(self, params: Mapping[str, Any]) -> None:
        """Write the parameters and let the program do its power-up, once the PLC is known for a test rig."""
        self._recognize()
        values = {}
        for name, value in {**self._defaults, **params}.items():
            if name in self._places.parameters:
                values[name] = value
            elif name not in self._defaults or value != self._defaults[name]:
                raise Unjudged(f"parameter {name} is {value} in this case, and the map has no address for it")
        self._write(self._set, self._numbers(values))
        self._write_control(RESET, 1)
        self._wait(lambda: not self._read_control(RESET), f"{RESET} was not cleared")
        self._others.clear()  # the program's power-up may have changed them
        if self.virtual:
            self._number = self._read_control(DONE)
        self._last_scan = time.monotonic()

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """As `Program.scan`; nothing is written into a PLC that is no test rig any more."""
        self._recognize()
        numbers = self._numbers(inputs)
        if self.virtual:
            numbers[TIME] = min(dt_ms, LONGEST_MS)
            self._write(self._written, numbers)
            self._number = (self._number + 1) & 0xFFFF
            self._write_control(STEP, self._number)
            self._wait(lambda: self._read_control(DONE) == self._number, f"{DONE} did not follow {STEP}")
        else:
            rest = self._last_scan + dt_ms / 1000 - time.monotonic()
            if rest > 0:
                time.sleep(rest)
            self._last_scan = time.monotonic()
            self._write(self._written, numbers)
            before = self._read_control(CYCLE)
            self._wait(
                lambda: (self._read_control(CYCLE) - before) & 0xFFFF >= CYCLES, f"{CYCLE} does not go on"
            )
        return self._outputs()

    def close(self) -> None:
        """Put back what was written, if the PLC is still a test rig, and hang up; may be called twice."""
        before, self._before = (self._before if self._touched else {}), {}
        try:
            if before:
                self._recognize()
            for block, data in before.items():
                self._others.pop(block, None)  # whoever wrote the other bits: they stay as they are now
                self._put(block, self._with_others(block, data))
        except Unjudged as error:
            print(f"modeproof.s7: what was written is not put back: {error}", file=sys.stderr)
        self._hang_up()

    def _hang_up(self) -> None:
        with contextlib.suppress(Exception):
            self._client.disconnect()

    def __enter__(self) -> S7Program:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # ------------------------------------------------------------------------------------------ memory

    def _numbers(self, values: Mapping[str, Any]) -> dict[str, int]:
        places = {**self._places.inputs, **self._places.parameters}
        return {name: encode(self._signals[name], places[name], value) for name, value in values.items()}

    def _write(self, blocks: Sequence[Block], numbers: Mapping[str, int]) -> None:
        """Whole blocks, one telegram each; bits that have no name must be as they were found, and stay so."""
        places = self._places_written()
        for block in blocks:
            data = self._with_others(block, self._before.get(block, bytes(block.size)))
            for name, number in numbers.items():
                place = places[name]
                if not block.holds(place):
                    continue
                at = place.byte - block.first
                if place.bit >= 0:
                    data[at] = data[at] & ~(1 << place.bit) | number << place.bit
                else:
                    size = BYTES[place.type]
                    data[at : at + size] = (number % (1 << 8 * size)).to_bytes(size, "big")
            self._touched = True
            self._put(block, data)

    def _places_written(self) -> dict[str, Place]:
        return {**self._places.inputs, **self._places.parameters, **self._places.controls}

    def _named(self, block: Block) -> bytes:
        """The bits of a block that the map names, as a mask of each byte."""
        mask = bytearray(block.size)
        for place in self._places_written().values():
            if not block.holds(place):
                continue
            for byte in range(place.byte, place.last + 1):
                mask[byte - block.first] |= 1 << place.bit if place.bit >= 0 else 0xFF
        return bytes(mask)

    def _with_others(self, block: Block, own: bytes) -> bytearray:
        """These bytes, with the bits that the map does not name as they are now.

        Raises Unjudged where such a bit is not as it was found: it might change again before we write.
        """
        named = self._named(block)
        if min(named) == 0xFF:
            return bytearray(own)
        now = self._read(block)
        found = self._others.setdefault(block, now)
        for at, (was, bits, ours) in enumerate(zip(found, now, named, strict=True)):
            if (was ^ bits) & ~ours:
                byte = Place(block.area, block.block, block.first + at, -1, "BYTE").address
                raise Unjudged(
                    f"S7 server {self._where}: a bit of {byte} that the map does not name has changed, so "
                    "others write there; nothing more is written: give what the map names its own byte"
                )
        return bytearray(mine & ours | bits & ~ours for mine, bits, ours in zip(own, now, named, strict=True))

    def _put(self, block: Block, data: bytes | bytearray) -> None:
        area = self._areas[block.area]
        self._ask(partial(self._client.write_area, area, block.block, block.first, bytearray(data)))

    def _block_of(self, name: str) -> Block:
        place = self._places.controls[name]
        return Block(place.area, place.block, place.byte, place.last)

    def _write_control(self, name: str, number: int) -> None:
        self._write([self._block_of(name)], {name: number})

    def _read(self, block: Block) -> bytes:
        area = self._areas[block.area]
        data = self._ask(partial(self._client.read_area, area, block.block, block.first, block.size))
        if len(data) != block.size:
            raise Unjudged(f"S7 server {self._where}: {len(data)} bytes for {block.size} that were asked for")
        return bytes(data)

    def _read_control(self, name: str) -> int:
        place = self._places.controls[name]
        return number_at(place, self._read(self._block_of(name)), place.byte)

    def _outputs(self) -> dict[str, Any]:
        found = {}
        for block in self._observed:
            data = self._read(block)
            for name, place in self._places.outputs.items():
                if block.holds(place):
                    found[name] = decode(self._signals[name], number_at(place, data, block.first))
        return found

    def _ask(self, call: Callable[[], Any]) -> Any:
        try:
            return call()
        except (self._snap7.error.S7Error, OSError, RuntimeError, ValueError) as error:
            raise Unjudged(f"S7 server {self._where}: {error or type(error).__name__}") from None

    def _wait(self, ready: Callable[[], bool], what: str) -> None:
        end = time.monotonic() + self._timeout_s
        while not ready():
            if time.monotonic() > end:
                raise Unjudged(
                    f"S7 server {self._where}: {what} within {self._timeout_s:g} s; is the CPU in RUN, "
                    "is the test harness loaded?"
                )
            time.sleep(0.0005)


def number_at(place: Place, data: bytes, first: int) -> int:
    """The number at a place in bytes that begin at byte `first`."""
    at = place.byte - first
    if place.bit >= 0:
        return data[at] >> place.bit & 1
    signed = place.type in ("INT", "DINT", "TIME")
    return int.from_bytes(data[at : at + BYTES[place.type]], "big", signed=signed)
