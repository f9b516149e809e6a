"""Memory of statement list at power-up: what a CPU keeps, what OB100 leaves, and what nobody writes.

A data block of an S7-300 keeps its values, and so do flags if the CPU is set up so. So either may hold any
value at power-up, unless OB100 writes it or the map says that it is not retentive. Outputs are cleared.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import z3

from programs.language.tree import Place, Scalar, Source, Unit
from programs.readers.statement_list.instructions import Access
from programs.semantics.terms import constant, in_range, slots, symbol
from programs.semantics.translator import Translator

NON_RETENTIVE = "@non_retentive"
LONGEST_MS = 60_000
_AREA = re.compile(r"(DB\d+)|MB(\d+)-MB(\d+)", re.ASCII)


@dataclass(frozen=True)
class Cleared:
    """An area that holds its first values at each power-up, as a line of the map says."""

    area: str
    first: int
    last: int
    """Of flags, the bytes."""
    text: str
    """For the verdict."""

    @classmethod
    def of(cls, address: str, place: Place) -> Cleared:
        """From a line of the map. Raises Unjudged."""
        match = _AREA.fullmatch(address)
        if match is None or (match[2] and int(match[2]) > int(match[3])):
            raise place.refuse(f"{NON_RETENTIVE}, {address}: DB10 or MB16-MB255 is needed")
        text = f"{address} is not retentive ({place.file}:{place.line})"
        if match[1]:
            return cls(match[1], 0, 0, text)
        return cls("M", int(match[2]), int(match[3]), text)

    def has(self, unit: Access) -> bool:
        """Whether a piece of memory is in it."""
        ends = unit.byte, unit.byte + (unit.width - 1) // 8
        return unit.area == self.area and (self.area != "M" or self.first <= ends[0] <= ends[1] <= self.last)


def keeps(unit: Access, cleared: Sequence[Cleared]) -> bool:
    """Whether a piece of memory may hold any value when OB100 begins."""
    return unit.area[0] in "MD" and not any(area.has(unit) for area in cleared)


def must_not_matter(unit: Unit, name: str) -> None:
    """Refuse a program to which memory makes a difference that it never writes and the map does not name.

    The others take it as 0.
    """
    source = Source({unit.name.upper(): unit}, {})
    memory = {slot.path: symbol(slot.type, slot.path) for slot in slots(source, unit)}
    scan = Translator(source, unit, wrap=True).scan(memory, z3.IntVal(0))
    kind = unit.variables[name].type
    assert isinstance(kind, Scalar)
    where = [(memory[name], constant(kind, False))]
    solver = _solver()
    solver.add(
        z3.Or([z3.substitute(term, *where) != term for path, term in scan.after.items() if path != name])
    )
    if solver.check() != z3.unsat:
        what = {"I": "input", "Q": "output"}.get(name[0], "flag")
        cause = "which is no signal of the map" + ", and never writes it" * (what != "input")
        raise unit.place.refuse(f"the program reads {what} {unit.variables[name].name}, {cause}")


def at_power_up(unit: Unit, first: Unit) -> Unit:
    """The unit with the memory that OB100 leaves: a value, or what was there.

    Raises Unjudged if that depends on an input or on what was kept.
    """
    source = Source({first.name.upper(): first}, {})
    known = {slot.path: slot for slot in slots(source, first)}
    memory = {
        path: symbol(slot.type, path)
        if slot.section == "input" or slot.initial is None
        else constant(slot.type, slot.initial)
        for path, slot in known.items()
    }
    scan = Translator(source, first).scan(memory, z3.IntVal(0))
    ranges = [in_range(slot.type, memory[path]) for path, slot in known.items()]
    for owed in scan.obligations:
        if not _always(owed.formula, ranges):
            raise owed.place.refuse(f"OB 100: {owed.text}: that is not clear")
    variables = dict(unit.variables)
    for path, slot in known.items():
        if slot.section == "input":
            continue
        term = z3.simplify(scan.after[path])
        if slot.initial is None and _always(term == memory[path], ranges):
            continue
        value = _value(term, ranges)
        if value is None:
            text = (
                f"OB 100: what it leaves in {variables[path].name} depends on an input or on what was there"
            )
            raise first.place.refuse(text)
        variables[path] = replace(variables[path], initial=value, retained=False)
    return replace(unit, variables=variables)


def _value(term: Any, known: Sequence[z3.BoolRef]) -> bool | int | None:
    """The one value that a term can have; None: there are several."""
    solver = _solver(*known)
    if solver.check() != z3.sat:
        return None
    found = solver.model().eval(term, model_completion=True)
    if not _always(term == found, known):
        return None
    return z3.is_true(found) if z3.is_bool(found) else found.as_long()  # type: ignore[no-any-return]


def _always(formula: z3.BoolRef, known: Sequence[z3.BoolRef]) -> bool:
    """Whether a formula is true of all values."""
    if z3.is_true(z3.simplify(formula)):
        return True
    solver = _solver(*known)
    solver.add(z3.Not(formula))
    return bool(solver.check() == z3.unsat)


def _solver(*known: z3.BoolRef) -> z3.Solver:
    solver = z3.Solver()
    solver.set("timeout", LONGEST_MS)
    solver.add(*known)
    return solver
