"""Adapter protocol 1 for the statement-list programs in this folder. awlsim runs them, in this process alone.

Usage: python examples/awl/adapter.py TARGET [PROGRAM]     TARGET is fplc or plc, PROGRAM an AWL source with
                                                           symbols.csv beside it

Where an input, output or parameter lies in the memory of the CPU is read from TARGET.map.csv. Time is
virtual: dt_ms goes into a double word, and nothing in the programs asks a clock. awlsim is GPL-2.0-or-later
and is imported in this folder alone.
"""

from __future__ import annotations

import csv
import json
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

HERE = Path(__file__).resolve().parent
SYMBOLS = "symbols.csv"
LONGEST_MS = 3_600_000
"""No deadline is longer; a longer dt_ms is the same to the programs, and might overflow a double word."""
LONGEST_CYCLE_S = 600.0
"""awlsim's own watch looks at the clock, and a busy machine is no fault; the kit has a time limit too."""
TIME = "@dt_ms"
MODES = range(5)
LEVELS = {f"PERMITS_{level}": level for level in MODES}


@dataclass(frozen=True)
class Target:
    """Names on the wire; parameters with their defaults."""

    words: tuple[str, ...]
    bools: tuple[str, ...]
    outputs: tuple[str, ...]
    parameters: Mapping[str, Any]

    @property
    def inputs(self) -> tuple[str, ...]:
        """All inputs."""
        return (*self.bools, *self.words)


TARGETS = {
    "fplc": Target(
        words=("MW03", "MW07"),
        bools=("LA", "A", "B", "C", "D", "STR"),
        outputs=("MW01", "MW05", "MSO_0", "MSO_1", "MSO_2", "MSO_3", "MSO_4", "ERROR"),
        parameters={
            "T_ON_ms": 1000,
            "T_SEQ_ms": 1000,
            "T_REM_ms": 1000,
            "T_DWELL_ms": 0,
            "T_SEQ_FROM": "ones",
            "ON_ERROR": "hold",
            "SELECTIONS": "once",
            **{name: list(range(level + 1)) for name, level in LEVELS.items()},
        },
    ),
    "plc": Target(
        words=("MW01", "MW05", "SelectMSO", "SwitchMSO"),
        bools=(),
        outputs=("ReadAuthorization", "CheckMSO", "MW03", "MW07"),
        parameters={},
    ),
}
CHOICES = {"T_SEQ_FROM": ("LA", "ones"), "ON_ERROR": ("hold", "none"), "SELECTIONS": ("again", "once")}
BYE: dict[str, Any] = {"ok": True}


class Refused(Exception):
    """A request that protocol 1 forbids."""


# ------------------------------------------------------------------------------------------ what is asked for


def word(name: str, value: object) -> int:
    """A word of the wire."""
    if type(value) is not str or not re.fullmatch("[0-9A-F]{4}", value):
        raise Refused(f"{name}: four upper-case hex digits expected, got {value!r}")
    return int(value, 16)


def milliseconds(name: str, value: object, least: int = 0, most: int | None = None) -> int:
    """A time in ms."""
    if type(value) is not int or value < least or (most is not None and value > most):
        raise Refused(f"{name}: an integer {least}..{'' if most is None else most} expected, got {value!r}")
    return value


def parameter(name: str, value: object) -> int:
    """A parameter as a number: ms, 0 or 1 for a choice, a bit for each mode that a level permits."""
    if name in CHOICES:
        if type(value) is not str or value not in CHOICES[name]:
            raise Refused(f"{name}: one of {' '.join(CHOICES[name])} expected, got {value!r}")
        return CHOICES[name].index(value)
    if name in LEVELS:
        own = LEVELS[name]
        modes = [mode for mode in MODES if isinstance(value, list) and mode in value]
        if json.dumps(modes) != json.dumps(value) or own not in modes or modes[-1] != own:
            raise Refused(f"{name}: modes in order, {own} and none above it, expected, got {value!r}")
        return sum(1 << mode for mode in modes)
    return milliseconds(name, value, 0 if name == "T_DWELL_ms" else 1, LONGEST_MS)


def parameters(target: Target, given: object) -> dict[str, int]:
    """All parameters, given or default, if they go together (E-38, E-74)."""
    if not isinstance(given, dict) or set(given) - set(target.parameters):
        raise Refused(f"params: {' '.join(target.parameters) or 'nothing'} expected, got {given!r}")
    values = {name: parameter(name, value) for name, value in {**target.parameters, **given}.items()}
    if values:
        if values["T_DWELL_ms"] >= values["T_REM_ms"]:
            raise Refused("T_DWELL_ms: less than T_REM_ms expected")
        if not values["T_SEQ_FROM"] and values["T_SEQ_ms"] < values["T_ON_ms"]:
            raise Refused("T_SEQ_ms: at least T_ON_ms expected, as T_SEQ_FROM is LA")
    return values


def inputs(target: Target, entry: object) -> dict[str, int]:
    """The values of one scan, dt_ms among them."""
    if not isinstance(entry, dict) or set(entry) != {"dt_ms", "in"} or not isinstance(entry["in"], dict):
        raise Refused("a scan has dt_ms and in")
    given = entry["in"]
    if set(given) != set(target.inputs):
        wrong = " ".join(sorted(set(given) ^ set(target.inputs)))
        raise Refused(f"in: exactly {' '.join(target.inputs)} expected; missing or unknown: {wrong}")
    values = {TIME: min(milliseconds("dt_ms", entry["dt_ms"]), LONGEST_MS)}
    for name in target.bools:
        if type(given[name]) is not bool:
            raise Refused(f"{name}: true or false expected, got {given[name]!r}")
        values[name] = int(given[name])
    return values | {name: word(name, given[name]) for name in target.words}


# ------------------------------------------------------------------------------------------ the CPU


@dataclass(frozen=True)
class Place:
    """Where a value lies: area I, Q, M or a data block, first byte, bit of it or -1, number of bytes."""

    area: str
    byte: int
    bit: int
    length: int


ADDRESS = re.compile(
    r"(?:(?P<area>[IQM])|(?P<block>DB\d+)\.DB)(?P<size>[XWD]?)(?P<byte>\d+)(?:\.(?P<bit>[0-7]))?"
)
LENGTHS = {"X": 1, "": 1, "W": 2, "D": 4}


def read_map(path: Path) -> dict[str, Place]:
    """The places of a map: lines of symbol, address, type.

    DB3 is what a test harness copies to the inputs before each scan; here the inputs themselves are written.
    """
    places = {}
    with path.open(newline="", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            if row["symbol"] in ("@magic", "@non_retentive"):
                continue
            found = ADDRESS.fullmatch(row["address"])
            if found is None:
                raise SystemExit(f"{path.name}: {row['symbol']}: no address: {row['address']}")
            bit = -1 if found["bit"] is None else int(found["bit"])
            area = found["block"] or found["area"]
            area = "I" if area == "DB3" else area
            places[row["symbol"]] = Place(area, int(found["byte"]), bit, LENGTHS[found["size"]])
    return places


class Cpu:
    """awlsim with one program and its symbols, and the memory that the map names."""

    def __init__(self, program: Path, places: Mapping[str, Place]) -> None:
        from awlsim.common.exceptions import AwlSimError
        from awlsim_loader.core import AwlSim, SymTabParser  # isort: skip -- the compiler needs it first
        from awlsim_loader.awlcompiler import AwlParser

        self.fault: type[Exception] = AwlSimError
        self.sim = AwlSim()
        try:
            parser = AwlParser()
            parser.parseText(program.read_text(encoding="utf-8"))
            self.sim.loadSymbolTable(
                SymTabParser.parseText((program.parent / SYMBOLS).read_text(encoding="utf-8"))
            )
            self.sim.load(parser.getParseTree())
            self.sim.build()
        except AwlSimError as error:
            stop(program, error)
        self.program = program
        cpu = self.sim.cpu
        cpu.build = lambda: None  # done; a startup would build all blocks again
        cpu.setCycleTimeLimit(LONGEST_CYCLE_S)
        self.memory = {"I": cpu.inputs, "Q": cpu.outputs, "M": cpu.flags}
        self.memory |= {
            f"DB{one.index}": one.structInstance.memory for one in cpu.allDBs() if one.structInstance
        }
        self.bytes: dict[str, bytearray] = {area: one.getDataBytes() for area, one in self.memory.items()}
        self.loaded = {area: bytes(one) for area, one in self.bytes.items()}
        self.places = places
        for name, place in places.items():
            if place.area not in self.bytes or place.byte + place.length > len(self.bytes[place.area]):
                raise SystemExit(f"{name}: {program.name} has no {place}")

    def power_up(self, values: Mapping[str, int], keep: Sequence[str] = ()) -> None:
        """All memory but the areas in `keep` as it was loaded, then the settings, then OB100."""
        for area in set(self.loaded) - set(keep):
            self.bytes[area][:] = self.loaded[area]
        self.write(values)
        self.run(self.sim.startup)

    def scan(self, values: Mapping[str, int], outputs: Sequence[str]) -> dict[str, Any]:
        """OB1 once."""
        self.write(values)
        self.run(self.sim.runCycle)
        return {name: self.read(name) for name in outputs}

    def run(self, work: Callable[[], None]) -> None:
        """Let the CPU do something; a fault of the program ends the adapter."""
        try:
            work()
        except self.fault as error:
            stop(self.program, error)

    def write(self, values: Mapping[str, int]) -> None:
        """Values into memory; high byte first."""
        for name, value in values.items():
            place = self.places[name]
            memory = self.bytes[place.area]
            if place.bit < 0:
                memory[place.byte : place.byte + place.length] = value.to_bytes(place.length, "big")
            elif value:
                memory[place.byte] |= 1 << place.bit
            else:
                memory[place.byte] &= ~(1 << place.bit)

    def read(self, name: str) -> bool | str:
        """A value as it is on the wire."""
        place = self.places[name]
        memory = self.bytes[place.area]
        if place.bit >= 0:
            return bool(memory[place.byte] >> place.bit & 1)
        return memory[place.byte : place.byte + 2].hex().upper()


def stop(program: Path, error: Exception) -> NoReturn:
    """End with one line on standard error: the program cannot be run."""
    print(f"{program.name}: {' '.join(str(error).split())}", file=sys.stderr)
    raise SystemExit(3)


# ------------------------------------------------------------------------------------------ the protocol


class Session:
    """One target behind the protocol."""

    def __init__(self, name: str, program: Path) -> None:
        self.name, self.target = name, TARGETS[name]
        places = read_map(HERE / f"{name}.map.csv")
        self.cpu = Cpu(program, places)
        self.is_reset = False

    def answer(self, message: object) -> dict[str, Any]:
        """The answer to one message. Raises Refused, and has then done nothing."""
        if not isinstance(message, dict):
            raise Refused(f"a JSON object expected, got {message!r}")
        match message:
            case {"op": "hello", "protocol": 1, "target": self.name, **rest} if not rest:
                return {
                    "ok": True,
                    "name": f"{self.cpu.program.name} in awlsim",
                    "version": "1",
                    "time": "virtual",
                    "relations": ["exact", "settled", "monitor"],
                    "max_latency_scans": 0,
                    "unobserved": [],
                    "scans": True,
                }
            case {"op": "reset", **rest} if set(rest) <= {"params"}:
                self.cpu.power_up(parameters(self.target, rest.get("params", {})))
                self.is_reset = True
                return {"ok": True}
            case {"op": "scan", **entry}:
                (out,) = self.scans([entry])
                return out
            case {"op": "scans", "list": list(entries), **rest} if not rest:
                return {"list": self.scans(entries)}
            case {"op": "bye", **rest} if not rest:
                return BYE
        raise Refused(f"cannot serve {message}; protocol 1, target {self.name} only; scans has a list")

    def scans(self, entries: Sequence[object]) -> list[dict[str, Any]]:
        """Some scans, if all of them are well-formed."""
        if not self.is_reset:
            raise Refused("scan before reset")
        every = [inputs(self.target, entry) for entry in entries]
        return [{"out": self.cpu.scan(values, self.target.outputs)} for values in every]


def twins(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object; a key that stands twice is refused."""
    found = dict(pairs)
    if len(found) != len(pairs):
        raise Refused("an object names a key twice")
    return found


def main(arguments: Sequence[str]) -> None:
    """Answer line by line until "bye" or the end of the input."""
    if len(arguments) not in (1, 2) or arguments[0] not in TARGETS:
        raise SystemExit("usage: python adapter.py fplc|plc [PROGRAM]")
    answers, sys.stdout = sys.stdout, sys.stderr  # whatever awlsim may print is no answer
    name = arguments[0]
    try:
        session = Session(name, Path(arguments[1]) if arguments[1:] else HERE / f"{name}.awl")
    except ImportError as error:
        raise SystemExit(f"adapter.py: {error}; pip install -r examples/awl/requirements.lock") from None
    sys.stdin.reconfigure(encoding="utf-8", errors="replace")  # type: ignore[union-attr]
    reply: dict[str, Any] = {}
    while reply is not BYE and (line := sys.stdin.readline()):
        try:
            reply = session.answer(json.loads(line, object_pairs_hook=twins))
        except (Refused, ValueError, RecursionError) as error:
            reply = {"error": " ".join(f"{type(error).__name__}: {error}".split())[:300]}
        print(json.dumps(reply, separators=(",", ":")), file=answers, flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
