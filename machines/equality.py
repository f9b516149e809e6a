"""A program beside the machine that a wiring describes: does every output show the same, after every scan?

Both are one program here: its own scan, then that of the wiring on the same inputs, and a comparison of each
output. Relations between the two memories are found from runs, and a solver drops what does not last.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from machines.candidate_invariants import Candidates, Sample
from machines.composed_program import unit as wired_unit
from machines.concrete_runs import Runner
from machines.user_program import ProgramMachine, ProgramRunner
from machines.verdicts import Verdict
from programs.language.tree import BOOL, Assign, Binary, Name, Unit, Variable
from programs.properties.property_file import Questions
from programs.properties.transition_system import Cell

RUNS = 40
"""Random runs: each scan of both is run, so it takes twice as long."""
PREFIX, DIFFERS = "WIRED_", "DIFFERS_"
"""Before the names of the wiring's own values, and before those that say whether an output differs."""


@dataclass
class Equality(ProgramMachine):
    """A program and a wiring."""

    runs: int = RUNS

    @cached_property
    def every(self) -> Questions:
        """One question for each output."""
        rows = tuple(
            {
                "id": f"{name}-as-wired",
                "sentence": f"{name} is after every scan what the wiring gives.",
                "hazard": "The program does what nobody proved of the wiring.",
                "cites": [],
                "never": f"{DIFFERS}{name}",
            }
            for name in self.wiring.table.outputs
        )
        return Questions(self.wiring.table.scan_ms, rows, self.file, "")

    @cached_property
    def lacking(self) -> Mapping[str, str]:
        """Nothing: the questions are made from the wiring."""
        return {}

    def left_out(self) -> Iterator[Verdict]:
        """Nothing: every output is compared."""
        return iter(())

    @cached_property
    def cell(self) -> Cell:
        """Both as one program. Raises Unjudged."""
        own, wiring = self.own, self.wiring
        other = wired_unit(wiring)
        mine = {key for key, variable in other.variables.items() if variable.section != "input"}
        variables = dict(own.variables)
        for key in mine:
            variable = other.variables[key]
            section = "var" if variable.section == "output" else variable.section
            variables[f"{PREFIX}{key}"] = replace(variable, name=f"{PREFIX}{variable.name}", section=section)
        body = [*own.body, *(_renamed(statement, mine) for statement in other.body)]
        for name in wiring.table.outputs:
            variables[f"{DIFFERS}{name}".upper()] = Variable(f"{DIFFERS}{name}", BOOL, "var", None, own.place)
            sides = Name(name, own.place), Name(f"{PREFIX}{name}", own.place)
            body.append(
                Assign(Name(f"{DIFFERS}{name}", own.place), Binary("<>", *sides, own.place), own.place)
            )
        whole: Unit = replace(own, variables=variables, body=tuple(body))
        units = {**self.source.units, own.name.upper(): whole}
        return Cell.of(replace(self.source, units=units), whole, wiring.table.scan_ms)

    @cached_property
    def runner(self) -> Runner:
        """What runs both."""
        found = super().runner
        assert isinstance(found, ProgramRunner)
        return replace(found, shown=[f"{DIFFERS}{name}" for name in self.wiring.table.outputs])

    def candidates(self, samples: Sequence[Sample]) -> Candidates:
        """Relations between the two memories."""
        found = Candidates(self.cell, self.system, samples)
        found.find_pairs(PREFIX)
        return found


def _renamed(node: Any, names: set[str]) -> Any:
    """A statement or expression in which these variables have the prefix."""
    if isinstance(node, tuple):
        return tuple(_renamed(part, names) for part in node)
    if isinstance(node, Name):
        return Name(f"{PREFIX}{node.name}", node.place) if node.name.upper() in names else node
    if not hasattr(node, "place"):
        return node
    return type(node)(**{name: _renamed(part, names) for name, part in vars(node).items()})
