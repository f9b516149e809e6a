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
        for one in every:
            if one.name in self.premises:
                raise TheoremError(f"two formulas are called {one.name!r}")
            self.premises[one.name] = one
        self.proved = tuple(proved)
        self.order = tuple(one.name for one in proved)
        given = [one.name for one in every if not isinstance(one, Invariant | Consequence)]
        self._check_order(set(given))
        unused = [name for name in given if name not in self._assumed()]
        if unused:
            raise TheoremError(f"no proof uses {', '.join(map(repr, unused))}")

    def _check_order(self, discharged: set[str]) -> None:
        for one in self.proved:
            for name in one.assumes:
                if name not in self.premises:
                    raise TheoremError(f"{one.name!r} assumes {name!r}, which nothing discharges")
                if name not in discharged:
                    raise TheoremError(
                        f"{one.name!r} assumes {name!r}, which is only proved later or from it"
                    )
            discharged.add(one.name)

    def _assumed(self) -> set[str]:
        return {name for one in self.proved for name in one.assumes}

    def rests_on(self, name: str) -> tuple[str, ...]:
        """All that a proved formula rests on, directly or not, in the order of the argument."""
        found: set[str] = set()
        waiting = [name]
        while waiting:
            one = self.premises[waiting.pop()]
            if isinstance(one, Invariant | Consequence):
                waiting += [other for other in one.assumes if other not in found]
                found.update(one.assumes)
        return tuple(other for other in self.premises if other in found)

    # ---- queries

    def queries(self, name: str) -> Queries:
        """The claims that prove an invariant or a consequence, and the controls that leave one premise out.

        A step that touches nothing that an invariant speaks of needs no claim.
        """
        one = self.premises[name]
        if isinstance(one, Guarantee | Assumption):
            raise TheoremError(f"{name!r} is not proved here")
        if isinstance(one, Invariant):
            given = {"power-up": power_up(), **self._at_power_up(one)}
            yield from claim(f"{name}: at power-up", given, one.of(NOW), LOGIC)
        for actor in self._actors(one):
            yield from claim(f"{name}: {actor}", self._given(one, actor), self._then(one, actor), LOGIC)
        if isinstance(one, Consequence) and "fplc" in one.actors:
            switches = {**self._given(one, "fplc"), "a mode is switched": STEP["fplc"].fplc.switches}
            yield control(f"{name}: a mode can be switched at all", switches, LOGIC)
        for left_out in one.assumes:
            yield self.without(name, left_out)

    def without(self, name: str, left_out: str) -> Query:
        """The query that must find a step against the formula when one of its premises is left out."""
        one = self.premises[name]
        if isinstance(one, Guarantee | Assumption):
            raise TheoremError(f"{name!r} is not proved here")
        found: list[z3.BoolRef] = []
        for actor in self._actors(one):
            given = self._given(one, actor)
            fewer = self._given(one, actor, left_out)
            if len(fewer) < len(given):
                found.append(z3.And(*fewer.values(), z3.Not(self._then(one, actor))))
        return control(f"{name}: without {left_out}", {"some step": disjunction(found)}, LOGIC)

    def _actors(self, one: Proved) -> tuple[str, ...]:
        if isinstance(one, Consequence):
            return one.actors
        return tuple(
            actor for actor in STEPS if not self._then(one, actor).eq(self._formula(one, actor, False))
        )

    def _then(self, one: Proved, actor: str) -> z3.BoolRef:
        return self._formula(one, actor, True)

    def _formula(self, one: Premise, actor: str, after: bool) -> z3.BoolRef:
        """The formula of a premise about a step; of an invariant, before or after it."""
        key = (one.name, actor, after)
        if key not in self.formulas:
            step = STEP[actor]
            if isinstance(one, Invariant):
                self.formulas[key] = one.of(step.after if after else step.before)
            else:
                self.formulas[key] = one.of(step.scan if isinstance(one, Guarantee) else step)
        return self.formulas[key]

    def _given(self, one: Proved, actor: str, left_out: str = "") -> dict[str, z3.BoolRef]:
        step = STEP[actor]
        given = {
            "each device is in one of its states": z3.And(
                states_are_states(step.before), states_are_states(step.after)
            ),
            "what the user did and saw": history_kept(step),
        }
        if isinstance(one, Invariant):
            given[f"{one.name}, before"] = self._formula(one, actor, False)
        for name in one.assumes:
            if name != left_out:
                given |= self._premise(self.premises[name], actor)
        return given

    def _premise(self, one: Premise, actor: str) -> dict[str, z3.BoolRef]:
        """What a premise says of a step of the actor, by name; nothing where it is about others."""
        if isinstance(one, Invariant):
            before, after = (self._formula(one, actor, when) for when in (False, True))
            return {f"{one.name}, before": before} | (
                {} if after.eq(before) else {f"{one.name}, after": after}
            )
        if isinstance(one, Guarantee):
            return {one.name: self._formula(one, actor, True)} if one.device.name == actor else {}
        if actor not in one.actors:
            return {}
        return {one.name: self._formula(one, actor, True)}

    def _at_power_up(self, one: Invariant) -> dict[str, z3.BoolRef]:
        """The invariants that it assumes, at power-up."""
        found = [self.premises[name] for name in one.assumes]
        return {other.name: other.of(NOW) for other in found if isinstance(other, Invariant)}
