"""What makes an argument of the single formulas: who assumes what, in which order, and what is asked of it.

An invariant is proved by power-up and by every step of every actor; a consequence by the steps it speaks of.
Each names all that it assumes: guarantees of devices, assumptions of the register, other invariants and
consequences. The order must be one: what is assumed is discharged before. For every name that is assumed
there is a query that leaves it out and must then find a counterexample, so that none is there for nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import z3

from proofs.explorer.explore import disjunction
from proofs.mode_selection.composition_guarantees import Guarantee
from proofs.mode_selection.composition_system import (
    NOW,
    STEP,
    STEPS,
    Assumption,
    Step,
    System,
    history_kept,
    power_up,
    states_are_states,
)
from proofs.theorem import Queries, Query, TheoremError, claim, control

LOGIC: Final = "QF_BV"


@dataclass(frozen=True)
class Invariant:
    """A formula about the system that holds at every moment."""

    name: str
    of: Callable[[System], z3.BoolRef]
    assumes: tuple[str, ...]
    theorem: str


@dataclass(frozen=True)
class Consequence:
    """A formula about each step of the given actors, which follows from what holds before and after it."""

    name: str
    of: Callable[[Step], z3.BoolRef]
    actors: tuple[str, ...]
    assumes: tuple[str, ...]
    theorem: str


Proved = Invariant | Consequence
Premise = Guarantee | Assumption | Proved


class Argument:
    """Guarantees, assumptions, and what is proved from them, in an order that is checked.

    Raises TheoremError: a name used twice; an assumption that nothing discharges or that is discharged only
    later, so that it would rest on itself; one that nothing uses.
    """

    def __init__(
        self,
        guarantees: Sequence[Guarantee],
        assumptions: Sequence[Assumption],
        proved: Sequence[Proved],
    ) -> None:
        self.premises: dict[str, Premise] = {}
        self.formulas: dict[tuple[str, str, bool], z3.BoolRef] = {}
        every: list[Premise] = list(guarantees)
        every += assumptions
        every += proved
        for formula in every:
            if formula.name in self.premises:
                raise TheoremError(f"two formulas are called {formula.name!r}")
            self.premises[formula.name] = formula
        self.proved = tuple(proved)
        self.order = tuple(formula.name for formula in proved)
        given = [formula.name for formula in every if not isinstance(formula, Invariant | Consequence)]
        self._check_order(set(given))
        unused = [name for name in given if name not in self._assumed()]
        if unused:
            raise TheoremError(f"no proof uses {', '.join(map(repr, unused))}")

    def _check_order(self, discharged: set[str]) -> None:
        for formula in self.proved:
            for name in formula.assumes:
                if name not in self.premises:
                    raise TheoremError(f"{formula.name!r} assumes {name!r}, which nothing discharges")
                if name not in discharged:
                    raise TheoremError(
                        f"{formula.name!r} assumes {name!r}, which is only proved later or from it"
                    )
            discharged.add(formula.name)

    def _assumed(self) -> set[str]:
        return {name for formula in self.proved for name in formula.assumes}

    def rests_on(self, name: str) -> tuple[str, ...]:
        """All that a proved formula rests on, directly or not, in the order of the argument."""
        found: set[str] = set()
        waiting = [name]
        while waiting:
            formula = self.premises[waiting.pop()]
            if isinstance(formula, Invariant | Consequence):
                waiting += [other for other in formula.assumes if other not in found]
                found.update(formula.assumes)
        return tuple(other for other in self.premises if other in found)

    # ---- queries

    def queries(self, name: str) -> Queries:
        """The claims that prove an invariant or a consequence, and the controls that leave one premise out.

        A step that touches nothing that an invariant speaks of needs no claim.
        """
        formula = self.premises[name]
        if isinstance(formula, Guarantee | Assumption):
            raise TheoremError(f"{name!r} is not proved here")
        if isinstance(formula, Invariant):
            given = {"power-up": power_up(), **self._at_power_up(formula)}
            yield from claim(f"{name}: at power-up", given, formula.of(NOW), LOGIC)
        for actor in self._actors(formula):
            yield from claim(
                f"{name}: {actor}", self._given(formula, actor), self._then(formula, actor), LOGIC
            )
        if isinstance(formula, Consequence) and "fplc" in formula.actors:
            switches = {**self._given(formula, "fplc"), "a mode is switched": STEP["fplc"].fplc.switches}
            yield control(f"{name}: a mode can be switched at all", switches, LOGIC)
        for left_out in formula.assumes:
            yield self.without(name, left_out)

    def without(self, name: str, left_out: str) -> Query:
        """The query that must find a step against the formula when one of its premises is left out."""
        formula = self.premises[name]
        if isinstance(formula, Guarantee | Assumption):
            raise TheoremError(f"{name!r} is not proved here")
        found: list[z3.BoolRef] = []
        for actor in self._actors(formula):
            given = self._given(formula, actor)
            fewer = self._given(formula, actor, left_out)
            if len(fewer) < len(given):
                found.append(z3.And(*fewer.values(), z3.Not(self._then(formula, actor))))
        return control(f"{name}: without {left_out}", {"some step": disjunction(found)}, LOGIC)

    def _actors(self, proved: Proved) -> tuple[str, ...]:
        if isinstance(proved, Consequence):
            return proved.actors
        return tuple(
            actor for actor in STEPS if not self._then(proved, actor).eq(self._formula(proved, actor, False))
        )

    def _then(self, proved: Proved, actor: str) -> z3.BoolRef:
        return self._formula(proved, actor, True)

    def _formula(self, premise: Premise, actor: str, after: bool) -> z3.BoolRef:
        """The formula of a premise about a step; of an invariant, before or after it."""
        key = (premise.name, actor, after)
        if key not in self.formulas:
            step = STEP[actor]
            if isinstance(premise, Invariant):
                self.formulas[key] = premise.of(step.after if after else step.before)
            else:
                self.formulas[key] = premise.of(step.scan if isinstance(premise, Guarantee) else step)
        return self.formulas[key]

    def _given(self, proved: Proved, actor: str, left_out: str = "") -> dict[str, z3.BoolRef]:
        step = STEP[actor]
        given = {
            "each device is in one of its states": z3.And(
                states_are_states(step.before), states_are_states(step.after)
            ),
            "what the user did and saw": history_kept(step),
        }
        if isinstance(proved, Invariant):
            given[f"{proved.name}, before"] = self._formula(proved, actor, False)
        for name in proved.assumes:
            if name != left_out:
                given |= self._premise(self.premises[name], actor)
        return given

    def _premise(self, premise: Premise, actor: str) -> dict[str, z3.BoolRef]:
        """What a premise says of a step of the actor, by name; nothing where it is about others."""
        if isinstance(premise, Invariant):
            before, after = (self._formula(premise, actor, when) for when in (False, True))
            return {f"{premise.name}, before": before} | (
                {} if after.eq(before) else {f"{premise.name}, after": after}
            )
        if isinstance(premise, Guarantee):
            return {premise.name: self._formula(premise, actor, True)} if premise.device.name == actor else {}
        if actor not in premise.actors:
            return {}
        return {premise.name: self._formula(premise, actor, True)}

    def _at_power_up(self, invariant: Invariant) -> dict[str, z3.BoolRef]:
        """The invariants that it assumes, at power-up."""
        found = [self.premises[name] for name in invariant.assumes]
        return {other.name: other.of(NOW) for other in found if isinstance(other, Invariant)}
