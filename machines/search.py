"""The fewest scans from power-up that break a property, or bring about what it is about.

All inputs and scan times are looked at: where nothing is found in so many scans, none of that many do it.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import z3

from machines.concrete_runs import Scan
from machines.wiring import Input
from programs.invariants import induction
from programs.invariants.bounded_search import BoundedSearch, Searched
from programs.invariants.gates import NoGates
from programs.invariants.induction import System, Way

FIRST_S, DEEPER_S = 10, 30
"""Of CPU: for all properties together before anything else, and for what is neither found nor proved then."""
FIRST, DEEPER = 24, 100
"""Scans, where the time is enough."""


def trigger(id: str, number: int) -> str:
    """The name of a trigger of a property among the targets."""
    return f"{id}, trigger {number + 1}"


@dataclass
class Search:
    """Looks for the targets of one machine, scan by scan; what was looked at is not looked at again."""

    system: System
    targets: Mapping[str, z3.BoolRef]
    inputs: Mapping[str, Input]
    found: Searched = field(default_factory=Searched)

    @cached_property
    def gates(self) -> BoundedSearch | None:
        """What looks; None: a term of the system has no gates, and z3 looks for each target alone."""
        try:
            return BoundedSearch(self.system, self.targets)
        except NoGates:
            return None

    def look(self, names: Sequence[str], seconds: float, most: int = FIRST) -> None:
        """Look for these in up to `most` scans. seconds: of CPU."""
        until = time.process_time() + seconds
        try:
            if self.gates is not None:
                self.gates.look(names, most, until, self.found)
                return
        except NoGates:
            self.gates = None
        for name in names:
            part = time.process_time() + seconds / len(names)
            way, scans = induction.shortest(self.system, self.targets[name], most, part)
            if way is not None:
                self.found.ways[name] = way
            self.found.clean[name] = max(scans - (way is not None), self.found.clean.get(name, 0))

    def clean(self, name: str) -> int:
        """In how many scans it does not come about, whatever the inputs and the scan times are."""
        return self.found.clean.get(name, 0)

    def scans(self, name: str) -> list[Scan] | None:
        """The fewest scans after which it is there; None: they were not found."""
        way = self.found.ways.get(name)
        return None if way is None else [self._scan(way, number) for number in range(len(way.scans))]

    def _scan(self, way: Way, number: int) -> Scan:
        values = way.scans[number]
        return values["dt_ms"], {name: values[name.upper()] for name in self.inputs}
