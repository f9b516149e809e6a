"""Interpreter and translator side by side in random scans."""

from __future__ import annotations

import random
from typing import Any

import z3

from programs.language.memory import leaves
from programs.language.shared_memory import completed, linked
from programs.language.subset import check
from programs.language.tree import Array, Source, Struct, Unit
from programs.readers.structured_text.units import read_all
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Overflow
from programs.semantics.terms import constant, slots, symbol
from programs.semantics.translator import Translator
from programs.semantics.value_paths import memory_of, value_at


def source_of(text: str, file: str = "b.st") -> Source:
    """The units of a text, with its globals."""
    read = read_all(text, file)
    units = {unit.name.upper(): unit for unit in read.units}
    return Source(linked(units, read.globals), {file: ""}, tasks=tuple(read.tasks))


def difference_of_text(text: str, seed: int, scans: int, wrap: bool = False) -> str:
    """As `difference_of_translator`, for the main unit of a text."""
    source = source_of(text)
    unit = completed(source, source.main())
    check(source, unit)
    return difference_of_translator(source, unit, seed, scans, wrap)


def difference_of_translator(source: Source, unit: Unit, seed: int, scans: int, wrap: bool = False) -> str:
    """Run random scans; where interpreter and terms do not agree, the first such place; else nothing."""
    known = {slot.path: slot for slot in slots(source, unit)}
    memory = {path: symbol(slot.type, path) for path, slot in known.items()}
    dt = z3.Int("dt")
    scan = Translator(source, unit, wrap).scan(memory, dt)
    paths = [path for path in known if path in scan.after]
    terms = [
        z3.And(*(owed.formula for owed in scan.obligations), True),
        *(scan.after[path] for path in paths),
    ]
    all_of = z3.Function("all", *(term.sort() for term in terms), z3.BoolSort())(*terms)
    values, of = random.Random(seed), Machine(source, unit, wrap)
    for number in range(scans):
        inputs = {name: random_value(values, kind.type) for name, kind in unit.of("input").items()}
        dt_ms = values.choice((0, 1, 10, 15, 30))
        before = memory_of(of) | dict(_flat(inputs, unit))
        where = [(memory[path], constant(slot.type, before[path])) for path, slot in known.items()]
        where.append((dt, z3.IntVal(dt_ms)))
        found = z3.simplify(z3.substitute(all_of, *where))
        owed = z3.is_true(found.arg(0))
        try:
            of.scan(inputs, dt_ms)
        except Overflow as error:
            if owed:
                return f"scan {number}: only the interpreter stops: {error}"
            of = Machine(source, unit, wrap)
            continue
        if not owed:
            return f"scan {number}: only the terms owe something"
        after = memory_of(of)
        for place, path in enumerate(paths, 1):
            if not found.arg(place).eq(constant(known[path].type, after[path])):
                return f"scan {number}: {path} is {after[path]}, the term gives {found.arg(place)}"
    return ""


def _flat(inputs: dict[str, Any], unit: Unit) -> Any:
    for name, value in inputs.items():
        for leaf in leaves(unit.variables[name.upper()].type):
            path = f"{name.upper()}{leaf}"
            yield path, value_at(unit, path, {name.upper(): value})


def random_value(values: random.Random, kind: Any) -> Any:
    """A value of a type, often near a limit."""
    if isinstance(kind, Array):
        return [random_value(values, kind.element) for _ in range(kind.low, kind.high + 1)]
    if isinstance(kind, Struct):
        return {name.upper(): random_value(values, inner) for name, inner, _ in kind.members}
    if kind.kind == "bool":
        return values.random() < 0.5
    if kind.kind == "bits":
        return values.choice((0, 1, kind.high, values.getrandbits(kind.width)))
    if kind.kind == "time":
        return values.choice((0, 10, 20, 25))
    near = (0, 1, 2, 3, 4, 5, 10, -1, -5, -6, kind.low, kind.high, values.randint(kind.low, kind.high))
    return values.choice([value for value in near if kind.low <= value <= kind.high])
