"""The address map of a target behind the S7 protocol: a CSV file with a line for each symbol.

    symbol,address,type
    BUTTON,DB3.DBX0.0,BOOL
    CODE,MW3,WORD
    LAMP,Q0.0,BOOL           only read: what is written lies in M or a data block, never in I or Q
    HORN,-,BOOL              an output that nobody reads: unobserved

Addresses are those of STEP 7, with bytes high before low; E and A may stand for I and Q. The type of a symbol
follows from its signal:

    bool   BOOL                          word   WORD
    mode   INT, -1 for none              modes  BYTE or WORD, bit i for mode i
    text   BYTE or INT, its place in the list of values from 0; BOOL where there are two
    int    INT or DINT                   ms     INT, DINT or TIME

Symbols that begin with @ are for the stepping of the program (see `modeproof.s7.program`). Nothing here needs
a network or a library.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import Signal

COLUMNS = ["symbol", "address", "type"]
BYTES = {"BOOL": 1, "BYTE": 1, "WORD": 2, "INT": 2, "DINT": 4, "TIME": 4}
"""For each type of STEP 7 its bytes; a BOOL is one bit of its byte."""
SIZES = {1: "B", 2: "W", 4: "D"}
RESET, STEP, DONE, TIME, CYCLE = "@reset", "@scan", "@done", "@dt_ms", "@cycle"
MAGIC = "@magic"
NON_RETENTIVE = "@non_retentive"
"""Such a line is for `prove-program` alone."""
MAGIC_NUMBER = int.from_bytes(b"RIG!", "big")
"""What the test harness in a PLC holds at @magic, in a data block of its own: 16#52494721."""
CONTROLS = {
    MAGIC: ("DINT",),
    RESET: ("BOOL",),
    STEP: ("WORD",),
    DONE: ("WORD",),
    TIME: ("DINT", "TIME"),
    CYCLE: ("WORD",),
}
"""The symbols that step the program, and their types."""
WRITTEN = (RESET, STEP, TIME)
UNOBSERVED = "-"
LARGEST = 65535
_ADDRESS = re.compile(
    r"([IQMEA])([BWD]?)(\d{1,5})(?:\.([0-7]))?|DB(\d{1,5})\.DB([XBWD])(\d{1,5})(?:\.([0-7]))?"
)
_OFTEN = {"E": "I", "A": "Q"}
_TYPES = {
    "bool": ("BOOL",),
    "word": ("WORD",),
    "mode": ("INT",),
    "modes": ("BYTE", "WORD"),
    "text": ("BYTE", "INT"),
    "int": ("INT", "DINT"),
    "ms": ("INT", "DINT", "TIME"),
}


@dataclass(frozen=True, order=True)
class Place:
    """Where a value lies: area I, Q, M or DB with its number, first byte, bit of it (-1: whole bytes)."""

    area: str
    block: int
    byte: int
    bit: int
    type: str

    @property
    def last(self) -> int:
        """The last byte."""
        return self.byte + BYTES[self.type] - 1

    @property
    def address(self) -> str:
        """As STEP 7 writes it."""
        size = "X" if self.bit >= 0 else SIZES[BYTES[self.type]]
        bit = f".{self.bit}" if self.bit >= 0 else ""
        if self.area == "DB":
            return f"DB{self.block}.DB{size}{self.byte}{bit}"
        return f"{self.area}{size if self.bit < 0 else ''}{self.byte}{bit}"

    def overlaps(self, other: Place) -> bool:
        """Whether the two share a bit."""
        if (self.area, self.block) != (other.area, other.block):
            return False
        if self.last < other.byte or other.last < self.byte:
            return False
        return self.bit < 0 or other.bit < 0 or self.bit == other.bit


@dataclass(frozen=True)
class AddressMap:
    """A map that fits a target: places of inputs, outputs and parameters, and of what steps the program."""

    inputs: Mapping[str, Place]
    outputs: Mapping[str, Place]
    parameters: Mapping[str, Place]
    controls: Mapping[str, Place]
    unobserved: tuple[str, ...]


def read_map(
    path: Path, inputs: Mapping[str, Signal], outputs: Mapping[str, Signal], parameters: Mapping[str, Signal]
) -> AddressMap:
    """Read and check a map for these signals.

    Every input and output needs a place (an output at least `-`), a parameter may lack one. Raises Unjudged
    naming line and symbol: unknown or missing symbol, a symbol twice, no address, a type that does not go
    with the signal or the address, two places that overlap, an output among the inputs of one byte.
    """
    places: dict[str, Place | None] = {}
    for line, row in _rows(path):
        symbol, place = row["symbol"], f"{path.name}: line {line}: {row['symbol'] or 'no symbol'}"
        if symbol in places:
            raise Unjudged(f"{place}: is there twice")
        signal = inputs.get(symbol) or outputs.get(symbol) or parameters.get(symbol)
        if signal is None and symbol not in CONTROLS:
            raise Unjudged(f"{place}: unknown symbol; the target has {_listed(inputs, outputs, parameters)}")
        wanted = types_of(signal) if signal is not None else CONTROLS[symbol]
        if row["type"] not in wanted:
            what = f"a {signal.type} needs" if signal is not None else "it needs"
            raise Unjudged(f"{place}: type {row['type'] or 'missing'}; {what} {' or '.join(wanted)}")
        if row["address"] == UNOBSERVED and symbol in outputs:
            places[symbol] = None
        else:
            places[symbol] = parse_address(row["address"], row["type"], place)
    missing = [name for name in (*inputs, *outputs) if name not in places]
    if missing:
        raise Unjudged(f"{path.name}: missing: {', '.join(missing)}; an unobserved output has the address -")
    known = {name: place for name, place in places.items() if place is not None}
    _refuse_overlap(path, known)
    for symbol, one in known.items():
        if one.area in "IQ" and symbol not in outputs and symbol not in (DONE, CYCLE):
            raise Unjudged(
                f"{path.name}: {symbol}: {one.address} would be written; use M or a data block, and let the "
                "test harness copy it (docs/s7.md)"
            )
    if MAGIC in known and known[MAGIC].area != "DB":
        raise Unjudged(f"{path.name}: {MAGIC} must lie in a data block")
    found = AddressMap(
        inputs={name: known[name] for name in inputs},
        outputs={name: known[name] for name in outputs if name in known},
        parameters={name: known[name] for name in parameters if name in known},
        controls={name: known[name] for name in CONTROLS if name in known},
        unobserved=tuple(name for name, place in places.items() if place is None),
    )
    _refuse_shared_bytes(path, found)
    return found


def types_of(signal: Signal) -> tuple[str, ...]:
    """The types of STEP 7 that can carry a signal."""
    if signal.type == "text" and len(signal.values) == 2:
        return ("BOOL", *_TYPES["text"])
    return _TYPES[signal.type]


def parse_address(address: str, kind: str, place: str) -> Place:
    """A place from its address and type. Raises Unjudged where they do not go together."""
    found = _ADDRESS.fullmatch(address)
    if found is None:
        raise Unjudged(
            f"{place}: {address or 'no address'}: an address such as I0.0, MW1 or DB1.DBX0.0 expected"
        )
    area, size, byte, bit, block, db_size, db_byte, db_bit = found.groups()
    if block is not None:
        area, size, byte, bit = "DB", "" if db_size == "X" else db_size, db_byte, db_bit
    if int(block or 0) > LARGEST or int(byte) > LARGEST:
        raise Unjudged(f"{place}: {address}: numbers go to {LARGEST}")
    wanted = "" if kind == "BOOL" else SIZES[BYTES[kind]]
    if size != wanted or (bit is not None) != (kind == "BOOL"):
        raise Unjudged(f"{place}: {address} is no address of a {kind}")
    return Place(_OFTEN.get(area, area), int(block or 0), int(byte), -1 if bit is None else int(bit), kind)


def _rows(path: Path) -> Iterable[tuple[int, Mapping[str, str]]]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise Unjudged(f"{path}: {getattr(error, 'strerror', None) or error}") from None
    try:
        lines = [[cell.strip() for cell in row] for row in csv.reader(io.StringIO(text), strict=True)]
    except csv.Error as error:
        raise Unjudged(f"{path.name}: {error}") from None
    if not lines or lines[0] != COLUMNS:
        raise Unjudged(f"{path.name}: the first line must be {','.join(COLUMNS)}")
    for number, cells in enumerate(lines[1:], 2):
        if len(cells) > 3 or (cells and len(cells) < 3):
            raise Unjudged(f"{path.name}: line {number}: three cells expected, got {len(cells)}")
        if cells and cells[0] != NON_RETENTIVE:
            yield number, dict(zip(COLUMNS, cells, strict=True))


def _listed(*tables: Mapping[str, Signal]) -> str:
    return ", ".join(name for table in tables for name in table)


def _refuse_overlap(path: Path, places: Mapping[str, Place]) -> None:
    names = sorted(places, key=lambda name: places[name])
    for n, first in enumerate(names):
        for second in names[n + 1 :]:
            if places[first].overlaps(places[second]):
                where = f"{first} {places[first].address} and {second} {places[second].address}"
                raise Unjudged(f"{path.name}: overlap: {where}")


def _refuse_shared_bytes(path: Path, found: AddressMap) -> None:
    """A byte is written as a whole, so it must not hold an output beside an input."""
    written = {**found.inputs, **found.parameters}
    written |= {name: place for name, place in found.controls.items() if name in WRITTEN}
    others = dict(found.outputs) | {
        name: place for name, place in found.controls.items() if name not in WRITTEN
    }
    mine = {byte: name for name, place in written.items() for byte in bytes_of(place)}
    for name, place in others.items():
        for byte in bytes_of(place):
            if byte in mine:
                raise Unjudged(
                    f"{path.name}: {mine[byte]} and {name} share a byte, which is written as a whole"
                )


def bytes_of(place: Place) -> Sequence[tuple[str, int, int]]:
    """The bytes that a place touches."""
    return [(place.area, place.block, byte) for byte in range(place.byte, place.last + 1)]


# ------------------------------------------------------------------------------------------ values


def encode(signal: Signal, place: Place, value: Any) -> int:
    """A wire value as the number that goes to its place. Raises Unjudged for one that does not fit."""
    fault = signal.fault(value)
    if fault:
        raise Unjudged(fault)
    if signal.type == "word":
        return int(value, 16)
    if signal.type == "mode":
        return -1 if value is None else int(value)
    if signal.type == "modes":
        return sum(1 << mode for mode in value)
    if signal.type == "text":
        return signal.values.index(value or "")
    number = int(value)
    if number.bit_length() >= 8 * BYTES[place.type]:
        raise Unjudged(f"{signal.name}: {number} does not fit into {place.address}")
    return number


def decode(signal: Signal, number: int) -> Any:
    """The wire value of the number at a place. Raises Unjudged for a number without meaning."""
    if signal.type == "bool":
        return bool(number)
    if signal.type == "word":
        return f"{number:04X}"
    if signal.type == "mode":
        return None if number == -1 else number
    if signal.type == "modes":
        return [mode for mode in range(number.bit_length()) if number >> mode & 1]
    if signal.type == "text":
        if not 0 <= number < len(signal.values):
            raise Unjudged(
                f"{signal.name}: a place in its list of {len(signal.values)} values expected, got {number}"
            )
        return signal.values[number] or None
    return number


# ------------------------------------------------------------------------------------------ a proposal


def proposed_map(
    inputs: Mapping[str, Signal],
    outputs: Mapping[str, Signal],
    parameters: Mapping[str, Signal],
    tags: Mapping[str, str],
) -> str:
    """A map to start from: words at the tags of the interface, bits and all else in blocks of their own.

    What has a tag that is an address goes there, if that may be written. Other outputs go to Q, parameters to
    DB1, what steps the program to DB2, and other inputs to DB3.
    """
    lines = [",".join(COLUMNS)]
    taken: list[Place] = []

    def put(name: str, signal: Signal | None, kind: str, area: str, block: int) -> None:
        tag = tags.get(name, "")
        place = _tagged(tag, kind)
        if place is None or (place.area != "M" and area == "DB") or any(place.overlaps(one) for one in taken):
            place = _next_free(taken, area, block, kind)
        taken.append(place)
        lines.append(f"{name},{place.address},{kind}")

    for table, area, block in ((inputs, "DB", 3), (outputs, "Q", 0)):
        for name, signal in table.items():
            put(name, signal, types_of(signal)[-1 if signal.type == "ms" else 0], area, block)
    for name, signal in parameters.items():
        put(name, signal, types_of(signal)[-1 if signal.type in ("ms", "modes") else 0], "DB", 1)
    for name in (TIME, STEP, DONE, RESET, MAGIC):
        put(name, None, CONTROLS[name][0], "DB", 2)
    return "\n".join(lines) + "\n"


def _tagged(tag: str, kind: str) -> Place | None:
    try:
        return parse_address(tag, kind, tag)
    except Unjudged:
        return None


def _next_free(taken: Iterable[Place], area: str, block: int, kind: str) -> Place:
    """The first place behind all others of its block; bits fill a byte, longer values begin at even bytes."""
    there = [place for place in taken if (place.area, place.block) == (area, block)]
    bits = [place for place in there if place.bit >= 0]
    last = max((place.last for place in there), default=-1)
    if kind == "BOOL" and bits:
        newest = max(bits, key=lambda place: (place.byte, place.bit))
        if newest.last == last and newest.bit < 7:
            return Place(area, block, newest.byte, newest.bit + 1, kind)
    byte = last + 1
    if BYTES[kind] > 1:
        byte += byte % 2
    return Place(area, block, byte, 0 if kind == "BOOL" else -1, kind)
