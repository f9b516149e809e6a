"""What a program owes so that its terms mean what it does: every value stays within its type."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import Any

import z3

from programs.language.tree import Place, Scalar, Source, Type, Unit
from programs.semantics.terms import Env, in_range


@dataclass(frozen=True)
class Obligation:
    """What must hold in every scan so that the program stays within its types."""

    formula: z3.BoolRef
    text: str
    place: Place


@dataclass
class Obliged(ABC):
    """What translates a unit, and what it owes. wrap: integers and times wrap and do not owe their range."""

    source: Source
    unit: Unit
    wrap: bool = False
    obligations: list[Obligation] = field(default_factory=list)

    @abstractmethod
    def call(self, unit: Unit, above: str, env: Env, here: z3.BoolRef, root: str = "") -> None:
        """One call of a unit; `here`: the condition under which it happens; root: the path above globals."""

    def fitted(self, term: Any, given: Type, kind: Scalar, place: Place, here: z3.BoolRef) -> Any:
        """A term of the type `given` as a value of the type `kind`."""
        assert isinstance(given, Scalar)
        inside = kind.low <= given.low and given.high <= kind.high
        return self.widened(term, given, kind) if inside else self.ranged(term, kind, place, here)

    def widened(self, term: Any, given: Type, kind: Scalar) -> Any:
        """A bit string as a longer one."""
        if kind.kind == "bits" and isinstance(given, Scalar) and given.width < kind.width:
            return z3.ZeroExt(kind.width - given.width, term)
        return term

    def ranged(self, term: Any, kind: Scalar, place: Place, here: z3.BoolRef) -> Any:
        """The term within the range of its type: as an obligation, or wrapped."""
        if kind.kind not in ("int", "time") or (
            z3.is_int_value(term) and kind.low <= term.as_long() <= kind.high
        ):
            return term
        if self.wrap and kind.base is None:
            return (term - kind.low) % (kind.high - kind.low + 1) + kind.low
        self.owe(z3.Implies(here, in_range(kind, term)), f"a value stays within {kind.name}", place)
        return term

    def owe(self, formula: z3.BoolRef, text: str, place: Place) -> None:
        """Note an obligation."""
        self.obligations.append(Obligation(formula, text, place))
