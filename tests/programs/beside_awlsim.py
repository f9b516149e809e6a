"""Statement-list programs in our interpreter and in awlsim, scan by scan; random programs for that.

Usage: python -m tests.programs.beside_awlsim FIRST END SCANS     the random programs FIRST to END - 1
"""

from __future__ import annotations

import importlib.util
import random
import re
import sys
import tempfile
from pathlib import Path
from types import ModuleType
from typing import Any

from modeproof.ground.errors import Unjudged
from programs.language.subset import check
from programs.language.tree import Scalar
from programs.readers.sources import read_sources
from programs.semantics.interpreter import Machine

ROOT = Path(__file__).parents[2]
NAME = re.compile(r"(I|Q|M|DB\d+)_([XBWD])(\d+)(?:_(\d))?")
AREAS = {"I": "I", "Q": "Q", "M": "M"}
VALUES = (
    0,
    1,
    2,
    3,
    0x7F,
    0x80,
    0xFF,
    0x100,
    0x7FFF,
    0x8000,
    0xFFFF,
    0x10000,
    0x7FFFFFFF,
    0x80000000,
    0xFFFFFFFF,
)


def adapter() -> ModuleType:
    """examples/awl/adapter.py, which runs awlsim."""
    spec = importlib.util.spec_from_file_location("awl_adapter", ROOT / "examples" / "awl" / "adapter.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["awl_adapter"] = module
    spec.loader.exec_module(module)
    return module


def places_of(of: ModuleType, machine: Machine, path: Path) -> dict[str, Any]:
    """Where each variable of the program lies in the memory of the CPU."""
    mapped = {name.removeprefix("@").upper(): place for name, place in of.read_map(path).items()}
    found = {}
    for key in machine.unit.variables:
        match = NAME.fullmatch(key)
        if key in mapped:
            found[key] = mapped[key]
        elif match is not None:
            size = {"X": 1, "B": 1, "W": 2, "D": 4}[match[2]]
            found[key] = of.Place(match[1], int(match[3]), int(match[4]) if match[4] else -1, size)
    return found


def raw(value: Any, place: Any) -> int:
    """A value as the bits of its memory."""
    return int(value) % (1 << (1 if place.bit >= 0 else 8 * place.length))


def there(cpu: Any, place: Any) -> int:
    """The bits of a place in the memory of the CPU."""
    memory = cpu.bytes[place.area]
    if place.bit >= 0:
        return int(memory[place.byte] >> place.bit & 1)
    return int.from_bytes(memory[place.byte : place.byte + place.length], "big")


def any_value(values: random.Random, kind: Scalar) -> Any:
    """A random value of a type, often at an edge."""
    if kind.kind == "bool":
        return values.random() < 0.5
    size = kind.high - kind.low + 1
    number = values.choice(VALUES) if values.random() < 0.6 else values.getrandbits(32)
    return (number - kind.low) % size + kind.low


def difference(path: Path, seed: int, scans: int, given: dict[str, list[Any]] | None = None) -> str:
    """Random scans from power-up; the first piece of memory that differs, else nothing.

    given: the values to choose from for an input. Raises Unjudged if the program is refused.
    """
    source = read_sources([path])
    unit = source.main()
    check(source, unit)
    machine, of = Machine(source, unit, wrap=True), adapter()
    places = places_of(of, machine, path.with_suffix(".map.csv"))
    cpu = of.Cpu(path, of.read_map(path.with_suffix(".map.csv")))
    cpu.power_up({})
    values = random.Random(seed)
    for number in range(scans):
        inputs = {}
        for name, variable in unit.of("input").items():
            assert isinstance(variable.type, Scalar)
            inputs[name] = values.choice((given or {}).get(name.upper(), [any_value(values, variable.type)]))
        for name, value in inputs.items():
            place = places[name.upper()]
            cpu.places[name] = place
            cpu.write({name: raw(value, place)})
        machine.scan(inputs, 10)
        cpu.run(cpu.sim.runCycle)
        for key, place in places.items():
            own = raw(machine.memory.values[key], place)
            if own != there(cpu, place):
                return f"scan {number}: {key} is {own:X}, and awlsim has {there(cpu, place):X}"
    return ""


# ---------------------------------------------------------------- random programs

HEAD = """DATA_BLOCK DB 1
  STRUCT
    small : INT := 7;
    big : DINT := L#-9;
    word : WORD := W#16#8001;
    rest : WORD;
    flag : BOOL := TRUE;
    edge : BOOL;
    byte : BYTE;
  END_STRUCT;
BEGIN
END_DATA_BLOCK
FUNCTION FC 1 : VOID
VAR_INPUT
  a : WORD;
  b : BOOL;
END_VAR
VAR_OUTPUT
  c : WORD;
  d : BOOL;
END_VAR
BEGIN
      L     #a
      L     W#16#FF
      XOW
      T     #c
      AN    #b
      =     #d
END_FUNCTION
"""
MAP = """symbol,address,type
in0,I0.0,BOOL
in1,I0.1,BOOL
in2,I0.2,BOOL
inw,IW2,WORD
ind,ID4,DINT
outb,Q8.3,BOOL
outw,QW2,WORD
outd,QD4,DINT
"""
BITS = ["I 0.0", "I 0.1", "I 0.2", "M 0.0", "M 0.1", "M 0.7", "DB1.DBX 10.0", "DB1.DBX 10.1"]
WRITTEN = ["M 0.0", "M 0.1", "M 0.7", "DB1.DBX 10.0", "DB1.DBX 10.1", "Q 8.3"]
LOADED = [
    "IW 2",
    "ID 4",
    "MB 0",
    "MW 2",
    "MD 2",
    "MB 3",
    "DB1.DBW 0",
    "DB1.DBD 2",
    "DB1.DBW 6",
    "DB1.DBB 11",
    "5",
    "-3",
    "W#16#F0F0",
    "L#-2",
    "L#70000",
    "B#16#7F",
    "DW#16#80000001",
    "0",
]
STORED = ["QB 0", "QW 2", "QD 4", "MB 0", "MW 2", "MD 2", "MB 3", "DB1.DBW 0", "DB1.DBD 2", "DB1.DBW 6"]
PLAIN = [
    "+I",
    "-I",
    "+D",
    "-D",
    "AW",
    "OW",
    "XOW",
    "AD",
    "OD",
    "XOD",
    "INVI",
    "INVD",
    "ITD",
    "TAK",
    "SLW 3",
    "SRW 1",
    "SLD 5",
    "SRD 31",
    "SRW 16",
    "+ 4",
    "+ -1",
    "+ L#-100",
    "AW W#16#FF",
    "OD DW#16#F",
]
COMPARED = [f"{sign}{kind}" for sign in ("==", "<>", "<", "<=", ">", ">=") for kind in "ID"]


def random_program(seed: int, length: int = 30) -> str:
    """A program of the subset; some are refused."""
    values = random.Random(seed)
    lines: list[str] = []
    labels: list[str] = []
    depth = 0

    def add(text: str) -> None:
        lines.append(f"      {text}")

    for number in range(length):
        kind = values.random()
        if labels and not depth and values.random() < 0.12:
            lines.append(f"{labels.pop()}: NOP 0")
        if kind < 0.3:
            add(f"{values.choice(['A', 'AN', 'O', 'ON', 'X', 'XN'])} {values.choice(BITS)}")
        elif kind < 0.36:
            add(values.choice(["A(", "AN(", "O(", "ON(", "X("]))
            add(f"A {values.choice(BITS)}")
            depth += 1
        elif kind < 0.42 and depth:
            add(")")
            depth -= 1
        elif kind < 0.45 and not depth:
            add("O")
            add(f"A {values.choice(BITS)}")
        elif kind < 0.56 and not depth:
            add(f"{values.choice(['=', '=', 'S', 'R', 'FP', 'FN'])} {values.choice(WRITTEN)}")
        elif kind < 0.6:
            add(values.choice(["SET", "CLR", "NOT"]))
        elif kind < 0.74:
            add(f"L {values.choice(LOADED)}")
            if values.random() < 0.6:
                add(f"L {values.choice(LOADED)}")
        elif kind < 0.82:
            add(values.choice(PLAIN))
        elif kind < 0.87 and not depth:
            add(values.choice(COMPARED))
        elif kind < 0.94:
            add(f"T {values.choice(STORED)}")
        elif kind < 0.975 and not depth:
            label = f"L{number:03}"
            labels.append(label)
            values.shuffle(labels)
            add(f"{values.choice(['JU', 'JC', 'JCN', 'JC'])} {label}")
        elif kind < 0.985 and not depth:
            add("BEC")
        elif not depth:
            add(f"CALL FC 1 (a := MW 20, b := {values.choice(BITS[:3])}, c := MW 22, d := M 24.1)")
    lines += ["      )"] * depth
    lines += ["      = M 0.1"] * bool(depth)
    lines += [f"{label}: NOP 0" for label in labels]
    body = "\n".join(lines)
    begin = "ORGANIZATION_BLOCK OB 1\nBEGIN\n      L IW 2\n      L MW 2\n      A I 0.0\n"
    text = begin + body
    cleared = [flag for flag in ("MB 0", "MW 2", "MD 2", "MB 3", "MW 20") if flag in text]
    cleared_bits = [flag for flag in WRITTEN if flag[0] == "M" and flag in text]
    start = "".join(f"      T {flag}\n" for flag in cleared) + "      CLR\n"
    start += "".join(f"      = {flag}\n" for flag in cleared_bits)
    ob100 = f"ORGANIZATION_BLOCK OB 100\nBEGIN\n      L 0\n{start}END_ORGANIZATION_BLOCK\n"
    return f"{HEAD}{ob100}{text}\nEND_ORGANIZATION_BLOCK\n"


def random_difference(folder: Path, seed: int, scans: int) -> str:
    """One random program; `refused` with the reason, or the first difference, or nothing."""
    path = folder / f"p{seed}.awl"
    path.write_text(random_program(seed), "utf-8")
    path.with_suffix(".map.csv").write_text(MAP, "utf-8")
    (folder / "symbols.csv").write_text("", "utf-8")
    try:
        return difference(path, seed, scans)
    except Unjudged as error:
        return f"refused {error.message}"


def main(first: int, end: int, scans: int) -> int:
    """Run random programs; prints each difference and the count. The exit status is 1 if one differs."""
    said: dict[str, int] = {"equal": 0, "different": 0, "refused": 0}
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(first, end):
            found = random_difference(Path(folder), seed, scans)
            kind = "equal" if not found else "refused" if found.startswith("refused") else "different"
            said[kind] += 1
            if kind == "different":
                print(f"program {seed}: {found}", flush=True)
    print(f"{said}, {said['equal'] * scans:,} scans of equal programs")
    return bool(said["different"])


if __name__ == "__main__":
    raise SystemExit(main(*map(int, sys.argv[1:])))
