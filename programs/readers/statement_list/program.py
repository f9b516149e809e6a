"""Statement list (STL, AWL) of an S7-300 into the language of `tree`: program, memory and signals.

awlsim's parser reads the source in a process of its own (examples/awl/tree.py). What OB100 leaves behind is
the memory at power-up (`awl_start`), and a scan is OB1. The map beside the source says where each signal
lies: what the program never writes is an input, unless it lies in Q; the rest are outputs. Calls are written
out.
"""

from __future__ import annotations

import csv
import json
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import root
from programs.language.tree import BOOL, SCALARS, Place, Scalar, Unit, Variable
from programs.readers.statement_list.instructions import Access, Cells, Fixed, Operand, Step
from programs.readers.statement_list.power_up import (
    NON_RETENTIVE,
    Cleared,
    at_power_up,
    keeps,
    must_not_matter,
)
from programs.readers.statement_list.translation import statements

READER = Path("examples", "awl", "tree.py")
LONGEST_S = 60
AREAS = {"MEM_M": "M", "MEM_E": "I", "MEM_A": "Q"}
TYPES = {"BOOL", "BYTE", "WORD", "INT", "DWORD", "DINT"}
MOST_STEPS = 20_000
"""Instructions of a scan with all calls in place."""
_ADDRESS = re.compile(r"(?:([IQM])|DB(\d+)\.DB)([XBWD]?)(\d+)(?:\.([0-7]))?", re.ASCII)
_WIDTHS = {"X": 1, "": 1, "B": 8, "W": 16, "D": 32}


def read_awl(path: Path) -> list[Unit]:
    """The program of one source as one unit, named like the file. Raises Unjudged with the line."""
    raw = _parsed(path)
    signals, cleared = _signals(path.with_suffix(".map.csv"))
    scan = _Flat(raw, path, "OB 1").steps
    if "OB 1" not in raw["blocks"]:
        raise Unjudged(f"{path}: no ORGANIZATION_BLOCK OB 1, so nothing is carried out in a scan")
    start = _Flat(raw, path, "OB 100").steps if "OB 100" in raw["blocks"] else []
    for name in raw["blocks"]:
        if name.startswith("OB ") and name not in ("OB 1", "OB 100"):
            raise Unjudged(f"{path}: {name} is not supported; OB 1 and OB 100 are")
    memory = _Memory(path, raw, signals, cleared, [*scan, *start])
    place = Place(str(path), scan[0].place.line if scan else 1)
    body, temporaries = statements(scan, memory.cells(scan))
    if not any(access for step in scan for access in step.writes()):
        raise Unjudged(f"{path}: OB 1 writes nothing")
    notes = [area.text for area in cleared]
    if memory.settings:
        notes.append(f"nothing writes {', '.join(memory.settings)}, so what is loaded stays there")
    unit = Unit(path.stem, "program", {**memory.variables, **temporaries}, body, place, notes=tuple(notes))
    for name in memory.unnamed:
        must_not_matter(unit, name)
        memory.variables[name] = replace(memory.variables[name], section="constant")
    unit = replace(unit, variables={**memory.variables, **temporaries})
    if not start:
        return [unit]
    begin, others = statements(start, memory.cells(start))
    first = Unit(path.stem, "program", {**memory.variables, **others}, begin, place)
    return [at_power_up(unit, first)]


def beside(path: Path) -> list[Path]:
    """The files that belong to a source: its map, and the symbols if there are any."""
    symbols = path.with_name("symbols.csv")
    return [path.with_suffix(".map.csv"), *([symbols] if symbols.is_file() else [])]


def _parsed(path: Path) -> Any:
    """What awlsim's parser makes of the source."""
    command = [sys.executable, str(root() / READER), str(path)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_S, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Unjudged(f"{path}: {READER} did not read it: {error}") from None
    if done.returncode == 3:
        fault = json.loads(done.stdout)
        raise Place(str(path), fault["line"]).refuse(fault["text"])
    if done.returncode:
        raise Unjudged(f"{path}: cannot be read; `make venv` installs awlsim: {done.stderr.strip()[-200:]}")
    return json.loads(done.stdout)


# ---------------------------------------------------------------- signals


@dataclass(frozen=True)
class Signal:
    """A line of the map."""

    name: str
    access: Access
    type: Scalar


def _signals(path: Path) -> tuple[list[Signal], list[Cleared]]:
    """The map beside a source: symbol, address, type, as for the kit over S7; and what is not retentive.

    DB3 is what a test harness copies to the inputs before each scan; the program reads I.
    """
    found: list[Signal] = []
    cleared: list[Cleared] = []
    try:
        with path.open(newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise Unjudged(f"{path}: the map of the signals cannot be read: {error}") from None
    for line, row in enumerate(rows, 2):
        place = Place(str(path), line)
        name, address, kind = (row.get(key) or "" for key in ("symbol", "address", "type"))
        if name == NON_RETENTIVE:
            cleared.append(Cleared.of(address.replace(" ", ""), place))
        if name.startswith("@") and name != "@dt_ms":
            continue
        match = _ADDRESS.fullmatch(address.replace(" ", ""))
        if match is None or kind not in TYPES or (match[3] in ("", "X")) != (match[5] is not None):
            raise place.refuse(f"{name}, {address}, {kind}: a symbol, an address and a type are needed")
        area = "I" if match[2] == "3" else match[1] or f"DB{match[2]}"
        access = Access(area, int(match[4]), int(match[5] or 0), _WIDTHS[match[3]])
        if access.width != SCALARS[kind].high.bit_length() + (SCALARS[kind].low < 0):
            raise place.refuse(f"{name}: {kind} does not have the {access.width} bits of {address}")
        name = name.removeprefix("@")
        if not re.fullmatch(r"[A-Za-z_]\w*", name, re.ASCII):
            raise place.refuse(f"{name!r} is no name")
        if name.upper() in {other.name.upper() for other in found}:
            raise place.refuse(f"{name} is there twice")
        if access in {other.access for other in found}:
            raise place.refuse(f"{name}: {address} is there twice")
        found.append(Signal(name, access, SCALARS[kind]))
    return found, cleared


# ---------------------------------------------------------------- calls in place of themselves


@dataclass(frozen=True)
class _Frame:
    """One call of a block: its number, its instance data block, and what its parameters stand for."""

    number: int
    instance: int
    actual: Mapping[str, Operand]
    above: tuple[str, ...]


class _Flat:
    """All instructions of an organization block, with calls replaced by what is called."""

    def __init__(self, raw: Any, path: Path, block: str) -> None:
        self.raw, self.path = raw, path
        self.steps: list[Step] = []
        self.frames = 0
        if block in raw["blocks"]:
            self.block(block, {}, -1, ())

    def block(self, name: str, actual: Mapping[str, Operand], instance: int, above: tuple[str, ...]) -> None:
        if name in above:
            chain = " calls ".join((*above, name))
            raise Unjudged(f"{self.path}: {chain}: a block must not call itself")
        self.frames += 1
        frame = _Frame(self.frames, instance, actual, (*above, name))
        instructions = self.raw["blocks"][name]["instructions"]
        targets = {one["target"] for one in instructions}
        line = 1
        for number, given in enumerate(instructions):
            line = given["line"] if given["line"] > 0 else line
            place = Place(str(self.path), line)
            if number in targets:
                self.add(Step("label", place, label=(frame.number, number)))
            if given["op"] == "CALL":
                self.call(given, frame, place)
                continue
            if given["op"] in ("BE", "BEU"):
                self.add(Step("JU", place, label=(frame.number, -1), leaves=True))
                continue
            if given["op"] == "BEC":
                self.add(Step("JC", place, label=(frame.number, -1), leaves=True))
                continue
            where = (frame.number, given["target"]) if given["target"] >= 0 else None
            if where is not None and given["target"] <= number:
                raise place.refuse(f"{given['op']}: a jump back is not supported")
            operands = tuple(
                self.operand(one, frame, place) for one in given["operands"] if one["kind"] != "LBL_REF"
            )
            self.add(Step(given["op"], place, operands, where))
        self.add(Step("label", Place(str(self.path), line), label=(frame.number, -1), leaves=True))

    def add(self, step: Step) -> None:
        self.steps.append(step)
        if len(self.steps) > MOST_STEPS:
            raise step.place.refuse(f"more than {MOST_STEPS:,} instructions in a scan")

    def operand(self, given: Any, frame: _Frame, place: Place) -> Operand:
        """What an operand is, as seen from its block."""
        kind, width = given["kind"], given["width"]
        if kind in ("IMM", "IMM_TIME"):
            return Fixed(given["value"], width, given["text"])
        if kind in AREAS:
            return Access(AREAS[kind], given["byte"], given["bit"], width)
        if kind == "MEM_DB" and given["db"] > 0:
            return Access(f"DB{given['db']}", given["byte"], given["bit"], width)
        if kind == "MEM_DI" and frame.instance > 0:
            return Access(f"DB{frame.instance}", given["byte"], given["bit"], width)
        if kind == "MEM_L":
            return Access(f"L{frame.number}", given["byte"], given["bit"], width)
        if kind == "NAMED_LOCAL":
            return frame.actual[given["text"].lstrip("#").upper()]
        raise place.refuse(f"operand {given['text']} is not supported")

    def call(self, given: Any, frame: _Frame, place: Place) -> None:
        """A call: hand over, carry out, hand back."""
        references = [one for one in given["operands"] if one["kind"].startswith("BLKREF")]
        name = references[0]["text"] if references else given["operands"][0]["text"]
        block = self.raw["blocks"].get(name)
        if block is None or len(references) != len(given["operands"]):
            raise place.refuse(f"CALL {name}: no such block is in the source; system functions and blocks")
        actual = {
            one["name"].upper(): self.operand(one["operand"], frame, place) for one in given["parameters"]
        }
        if name.startswith("FC"):
            self.apart(name, actual, place)
            self.add(Step("enter", place))
            self.block(name, actual, -1, frame.above)
            return
        instance = references[1]["byte"] if len(references) > 1 else -1
        formal = {
            one["name"].upper(): Access(f"DB{instance}", one["byte"], one["bit"], one["width"])
            for one in block["fields"]
        }
        for key, operand in actual.items():
            if block["sections"][key] != "out":
                self.add(Step("copy", place, (operand, formal[key])))
        self.add(Step("enter", place))
        self.block(name, {}, instance, frame.above)
        for key, operand in actual.items():
            if block["sections"][key] != "in":
                self.add(Step("copy", place, (formal[key], operand)))

    def apart(self, name: str, actual: Mapping[str, Operand], place: Place) -> None:
        """Refuse a function that could see what it is given in two ways, for then copies would matter."""
        sections = self.raw["blocks"][name]["sections"]
        places = [(key, one) for key, one in actual.items() if isinstance(one, Access)]
        for key, one in places:
            for other, access in places:
                both_in = sections[key] == sections[other] == "in"
                if key < other and one.overlaps(access) and not both_in:
                    raise place.refuse(f"CALL {name}: {key} and {other} share memory")
            for given in self.raw["blocks"][name]["instructions"]:
                for operand in given["operands"]:
                    if operand["kind"] in (*AREAS, "MEM_DB"):
                        seen = self.operand(operand, _Frame(0, -1, {}, ()), place)
                        writes = sections[key] != "in" or given["op"] in ("T", "=", "S", "R", "FP", "FN")
                        if isinstance(seen, Access) and writes and one.overlaps(seen):
                            raise place.refuse(f"CALL {name}: it uses {operand['text']} by itself, too")
            if any(one_of["op"] == "CALL" for one_of in self.raw["blocks"][name]["instructions"]):
                raise place.refuse(f"CALL {name}: a function with parameters that calls others")


# ---------------------------------------------------------------- memory


@dataclass
class _Memory:
    """Every piece of memory that the program uses, as variables."""

    path: Path
    raw: Any
    signals: Sequence[Signal]
    cleared: Sequence[Cleared]
    steps: Sequence[Step]
    variables: dict[str, Variable] = field(default_factory=dict)
    unnamed: list[str] = field(default_factory=list)
    """Inputs, flags and outputs that are read, are never written, and are no signals of the map."""
    settings: list[str] = field(default_factory=list)
    """Such data of data blocks: they keep what is loaded."""

    def __post_init__(self) -> None:
        written = {access for step in self.steps for access in step.writes()}
        every = {access for step in self.steps for access in step.accesses()}
        every |= {signal.access for signal in self.signals}
        self.units: list[Access] = []
        for group in _overlapping(every):
            self.units += _pieces(group)
        known = {signal.access: signal for signal in self.signals}
        place = Place(str(self.path), 1)
        for unit in sorted(self.units, key=lambda one: (one.area, one.byte, one.bit)):
            if unit.area.startswith("L"):
                continue
            changes = any(unit.overlaps(access) for access in written)
            signal = known.get(unit)
            kind = signal.type if signal is not None else self._declared(unit)
            if unit.area == "I" and changes:
                raise Unjudged(f"{self.path}: input {unit} is written")
            if signal is None and not changes:
                (self.settings if unit.area.startswith("DB") else self.unnamed).append(unit.name.upper())
            section = "var" if signal is None else "output" if changes or unit.area == "Q" else "input"
            name = unit.name if signal is None else signal.name
            if name.upper() in self.variables:
                raise Unjudged(f"{self.path}: {name} of the map is also the name of another piece of memory")
            initial = None if section == "input" else self._loaded(unit, kind)
            kept = changes and keeps(unit, self.cleared)
            self.variables[name.upper()] = Variable(name, kind, section, initial, place, kept)
        for signal in self.signals:
            if signal.access not in self.units:
                raise Unjudged(f"{self.path}: {signal.name} of the map overlaps other memory in part")

    def _declared(self, unit: Access) -> Scalar:
        """The type of a field of a data block; else a bit string."""
        if unit.area.startswith("DB"):
            for one in self.raw["data"].get(f"DB {unit.area[2:]}", {"fields": []})["fields"]:
                same = (one["byte"], one["bit"], one["width"]) == (unit.byte, unit.bit, unit.width)
                if same and one["type"] in TYPES:
                    return SCALARS[one["type"]]
        return {1: BOOL, 8: SCALARS["BYTE"], 16: SCALARS["WORD"], 32: SCALARS["DWORD"]}[unit.width]

    def _loaded(self, unit: Access, kind: Scalar) -> bool | int:
        """The value as it is loaded; flags and outputs are 0."""
        if not unit.area.startswith("DB"):
            return kind is not BOOL and 0
        block = self.raw["data"].get(f"DB {unit.area[2:]}")
        data = bytes.fromhex(block["bytes"]) if block else b""
        if unit.byte + (unit.width + 7) // 8 > len(data):
            raise Unjudged(f"{self.path}: {unit} is not in a data block")
        if unit.width == 1:
            return bool(data[unit.byte] >> unit.bit & 1)
        value = int.from_bytes(data[unit.byte : unit.byte + unit.width // 8], "big")
        return value - (1 << unit.width) if value > kind.high else value

    def cells(self, steps: Sequence[Step]) -> Cells:
        """How the translator reaches the pieces; those of temporary memory are its own."""
        names = {unit: unit.name for unit in self.units}
        names |= {signal.access: signal.name for signal in self.signals}
        types: dict[Access, Scalar] = {}
        for unit in self.units:
            variable = self.variables.get(names[unit].upper())
            types[unit] = self._temporary(unit) if variable is None else variable.type  # type: ignore[assignment]
        return Cells(names, types)

    def _temporary(self, unit: Access) -> Scalar:
        return {1: BOOL, 8: SCALARS["BYTE"], 16: SCALARS["WORD"], 32: SCALARS["DINT"]}[unit.width]


def _overlapping(accesses: set[Access]) -> Iterator[list[Access]]:
    """Groups of accesses that share memory."""
    by_area: dict[str, list[Access]] = defaultdict(list)
    for access in accesses:
        by_area[access.area].append(access)
    for found in by_area.values():
        group: list[Access] = []
        end = -1
        for access in sorted(found, key=lambda one: (one.first, one.last)):
            if group and access.first > end:
                yield group
                group, end = [], -1
            group.append(access)
            end = max(end, access.last)
        yield group


def _pieces(group: Sequence[Access]) -> Iterator[Access]:
    """What a group is kept as: as it is, in bytes, or in bits."""
    if len(group) == 1:
        yield group[0]
        return
    low, high = min(one.first for one in group), max(one.last for one in group)
    bits = any(one.width == 1 for one in group)
    for number in range(low, high + 1, 1 if bits else 8):
        yield Access(group[0].area, number // 8, number % 8, 1 if bits else 8)
