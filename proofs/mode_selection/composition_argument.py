"""What makes an argument of the single formulas: who assumes what, in which order, and what is asked of it.

An invariant is proved by power-up and by every step of every actor; a consequence by the steps it speaks of.
Each names all that it assumes: guarantees of devices, assumptions of the register, other invariants and
consequences. The order must be one: what is assumed is discharged before. For every name that is assumed
there is a query that leaves it out and must then find a counterexample, so that none is there for nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import z3

from proofs.explorer.explore import disjunction
from proofs.mode_selection.composition_guarantees import Guarantee
from proofs.mode_selection.composition_system import (
    NEXT,
    NOW,
    STEP,
    STEPS,
    Assumption,
    Step,
    System,
    history_kept,
    others_stay,
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
        for one in (*guarantees, *assumptions, *proved):
            if one.name in self.premises:
                raise TheoremError(f"two formulas are called {one.name!r}")
            self.premises[one.name] = one
        self.proved = tuple(proved)
        self.order = tuple(one.name for one in proved)
        self._check_order({one.name for one in (*guarantees, *assumptions)})
        unused = [one.name for one in (*guarantees, *assumptions) if one.name not in self._assumed()]
        if unused:
            raise TheoremError(f"no proof uses {', '.join(map(repr, unused))}")

    def _check_order(self, discharged: set[str]) -> None:
        for one in self.proved:
            for name in one.assumes:
                if name not in self.premises:
                    raise TheoremError(f"{one.name!r} assumes {name!r}, which nothing discharges")
                if name not in discharged:
                    raise TheoremError(f"{one.name!r} assumes {name!r}, which is only proved later or from it")
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
        """The claims that prove an invariant or a consequence, and the controls that leave one premise out."""
        one = self.premises[name]
        if isinstance(one, Invariant):
            given = {"power-up": power_up(), **self._at(one.assumes)}
            yield from claim(f"{name}: at power-up", given, one.of(NOW), LOGIC)
            for actor in STEPS:
                yield from claim(f"{name}: {actor}", self._given(one, actor), one.of(NEXT), LOGIC)
        elif isinstance(one, Consequence):
            for actor in one.actors:
                yield from claim(f"{name}: {actor}", self._given(one, actor), one.of(STEP[actor]), LOGIC)
        else:
            raise TheoremError(f"{name!r} is not proved here")
        for left_out in one.assumes:
            yield self.without(one, left_out)

    def without(self, one: Proved, left_out: str) -> Query:
        """The query that must find a step against the formula when one of its premises is left out."""
        found: list[z3.BoolRef] = []
        for actor in one.actors if isinstance(one, Consequence) else STEPS:
            given = self._given(one, actor, left_out)
            then = one.of(NEXT) if isinstance(one, Invariant) else one.of(STEP[actor])
            found.append(z3.And(*given.values(), z3.Not(then)))
        return control(f"{one.name}: without {left_out}", {"some step": disjunction(found)}, LOGIC)

    def _given(self, one: Proved, actor: str, left_out: str = "") -> Mapping[str, z3.BoolRef]:
        step = STEP[actor]
        given = {
            "each device is in one of its states": z3.And(states_are_states(NOW), states_are_states(NEXT)),
            "nobody else acts": others_stay(step),
            "what the user did and saw": history_kept(step),
        }
        if isinstance(one, Invariant):
            given[f"{one.name}, before"] = one.of(NOW)
        for name in one.assumes:
            if name != left_out:
                given |= self._of(name, step)
        return given

    def _of(self, name: str, step: Step) -> dict[str, z3.BoolRef]:
        one = self.premises[name]
        if isinstance(one, Invariant):
            return {f"{name}, before": one.of(NOW), f"{name}, after": one.of(NEXT)}
        if isinstance(one, Consequence):
            return {name: one.of(step)} if step.actor in one.actors else {}
        if isinstance(one, Guarantee):
            return {name: one.of(step.scan)} if one.device.name == step.actor else {}
        formula = one.of(step)
        return {} if formula is None else {name: formula}

    def _at(self, assumes: Iterable[str]) -> dict[str, z3.BoolRef]:
        """The invariants among the names, at power-up."""
        found = [self.premises[name] for name in assumes]
        return {one.name: one.of(NOW) for one in found if isinstance(one, Invariant)}


