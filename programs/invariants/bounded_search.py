"""The shortest way to each of several things that must not be: every scan from power-up, with all inputs.

The scans are unrolled as gates, and a SAT solver is asked one scan after the other whether one of the things
can be there. So the first way that is found is a shortest, and the answer no is for all inputs and times.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import z3
from pysat.solvers import Solver

from programs.invariants import induction
from programs.invariants.gates import TRUE, Circuit, Gates, NoGates, Number, Value
from programs.invariants.induction import System, Way, conjuncts
from programs.invariants.relations import plain

SOLVER = "cadical195"
CONFLICTS = 5_000
"""After so many it looks at the clock."""


@dataclass
class Searched:
    """What came out: the shortest ways, and how many scans the rest was looked for in."""

    ways: dict[str, Way] = field(default_factory=dict)
    clean: dict[str, int] = field(default_factory=dict)


class BoundedSearch:
    """Scans of a system from power-up, as many as are asked for. Raises NoGates: a term has no gates."""

    def __init__(self, system: System, targets: Mapping[str, z3.BoolRef]) -> None:
        self.system = system
        self.solver = Solver(name=SOLVER)
        self.gates = Gates(self.solver.add_clause)
        self.bounds = _bounds(system)
        terms = {f"then {path}": term for path, term in system.after.items()}
        terms |= {f"target {name}": term for name, term in targets.items()}
        self.circuit = Circuit.of({**terms, "assumed": system.assumed, "inside": system.inside})
        self.state: dict[str, Value] = {
            path: self._free(str(term), term) if (value := system.start[path]) is None else self._plain(value)
            for path, term in system.state.items()
        }
        self.start = dict(self.state)
        first = Circuit.of({"first": system.first})
        given = {str(term): self.state[path] for path, term in system.state.items()}
        self.solver.add_clause([first.values(self.gates, given)["first"]])
        self.read: list[dict[str, Value]] = []
        self.targets: list[dict[str, int]] = []
        self.inside: Any = TRUE

    def look(self, names: Sequence[str], most: int, until: float, found: Searched | None = None) -> Searched:
        """Look for these targets in up to `most` scans, until the CPU clock is past `until`.

        Scans that were looked at before are not looked at again.
        """
        found = found or Searched()
        left = [name for name in names if name not in found.ways]
        for number in range(most):
            asked = [name for name in left if found.clean.get(name, 0) <= number]
            if asked and time.process_time() > until:
                break
            if number == len(self.read):
                self._more()
            here = self.targets[number]
            while asked := [name for name in asked if name not in found.ways]:
                some = self.gates.one_of(here[name] for name in asked)
                answer = False if some == -TRUE else self._answer(some, until)
                if answer is None:
                    return found
                if answer:
                    model = set(self.solver.get_model())
                    way = self._way(model, number + 1)
                    found.ways |= {name: way for name in asked if here[name] in model}
                    continue
                for name in asked:
                    self.solver.add_clause([-here[name]])
                    found.clean[name] = number + 1
                break
            left = [name for name in left if name not in found.ways]
            if not left:
                break
        return found

    def _answer(self, literal: int, until: float) -> bool | None:
        """Whether it can be true; None: the clock is past `until`."""
        while True:
            self.solver.conf_budget(CONFLICTS)
            answer: bool | None = self.solver.solve_limited([literal])
            if answer is not None or time.process_time() > until:
                return answer

    def close(self) -> None:
        """Give the memory back."""
        self.solver.delete()

    def _more(self) -> None:
        """One scan more, with any inputs that are allowed."""
        self.solver.add_clause([self.inside])
        read = {str(term): self._free(str(term), term) for term in self.system.inputs.values()}
        given = {str(term): self.state[path] for path, term in self.system.state.items()} | read
        values: dict[str, Any] = dict(self.circuit.values(self.gates, given))
        self.solver.add_clause([values["assumed"]])
        self.inside = values["inside"]
        self.state = {path: values[f"then {path}"] for path in self.system.state}
        self.read.append(read)
        self.targets.append(
            {
                name.removeprefix("target "): value
                for name, value in values.items()
                if name.startswith("target ")
            }
        )

    def _free(self, name: str, term: Any) -> Value:
        if z3.is_bool(term):
            return self.gates.free()
        if z3.is_bv(term):
            return tuple(self.gates.free() for _ in range(term.size()))
        if name not in self.bounds:
            raise NoGates(f"{name} has no bounds")
        return self.gates.any_number(*self.bounds[name])

    def _plain(self, value: Any) -> Value:
        return Circuit.of({"value": value}).values(self.gates, {})["value"]

    def _way(self, model: set[int], scans: int) -> Way:
        """The scans of an answer."""
        by_name = {str(term): path for path, term in self.system.inputs.items()}
        start = {path: _read(value, model) for path, value in self.start.items()}
        read = [
            {by_name[name]: _read(value, model) for name, value in row.items()} for row in self.read[:scans]
        ]
        return Way(start, tuple(read))


def shortest(system: System, bad: z3.BoolRef, most: int, until: float) -> tuple[Way | None, int]:
    """As `induction.shortest`, by gates where the system has them."""
    try:
        search = BoundedSearch(system.cone(bad), {"bad": bad})
        found = search.look(["bad"], most, until)
    except NoGates:
        return induction.shortest(system, bad, most, until)
    way = found.ways.get("bad")
    return way, len(way.scans) if way is not None else found.clean.get("bad", 0)


def _read(value: Value, model: set[int]) -> Any:
    """The plain value in a model."""

    def true(literal: int) -> bool:
        return literal == TRUE or literal in model

    if isinstance(value, int):
        return true(value)
    bits = value.bits if isinstance(value, Number) else value
    found = sum(1 << at for at, literal in enumerate(bits) if true(literal))
    return found - (1 << len(bits)) if isinstance(value, Number) and true(bits[-1]) else found


def _bounds(system: System) -> dict[str, tuple[int, int]]:
    """The numbers of which `assumed` and `within` say the least and the greatest value."""
    low: dict[str, int] = {}
    high: dict[str, int] = {}
    for part in (*conjuncts(system.assumed), *conjuncts(system.within)):
        if (
            not (z3.is_le(part) or z3.is_ge(part))
            or not z3.is_int_value(part.arg(1))
            or part.arg(0).num_args()
        ):
            continue
        name, value = str(part.arg(0)), plain(part.arg(1))
        if z3.is_ge(part):
            low[name] = max(low.get(name, value), value)
        else:
            high[name] = min(high.get(name, value), value)
    return {name: (low[name], high[name]) for name in low if name in high}
