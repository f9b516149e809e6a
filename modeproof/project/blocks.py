"""Which published target a program unit of a user's may be, and how its names are bound to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache

from modeproof.ground.errors import Unjudged
from modeproof.project.names import SURE, likeness, matched, weight, weights
from programs.equality.binding import Binding
from programs.language.tree import Scalar, Source, Unit
from programs.semantics.reference import Reference, reference, targets

ENOUGH = 0.6
"""The part of a target's names, by their weight, that a unit has at least. Inputs that it has
besides count against it.
"""
OF_ITS_NAME = 0.3
"""The same of a unit whose name is that of the target."""


@dataclass(frozen=True)
class Fit:
    """A unit beside a target. names: those to bind. empty: signals without a name, and what they could be."""

    target: str
    unit: Unit
    share: float
    names: dict[str, str] = field(default_factory=dict)
    empty: dict[str, list[str]] = field(default_factory=dict)
    outputs: tuple[str, ...] = ()
    """Which of the empty ones are outputs."""
    spare: tuple[str, ...] = ()
    """Inputs of the unit that no signal took."""
    why: str = ""
    """Why it would be refused all the same."""

    @property
    def exact(self) -> bool:
        """Whether there is nothing to bind."""
        return not (self.names or self.empty or self.why)


def best_fit(source: Source, unit: Unit) -> Fit | None:
    """The target that a unit fits best, if it has most of its names."""
    for target in targets():
        try:
            Binding(reference(target), source, unit)
        except Unjudged:
            continue
        return Fit(target, unit, 1.0)
    fits = [fit for target in targets() if (fit := _fit(source, unit, reference(target))) is not None]
    return max(fits, key=lambda fit: fit.share, default=None)


def _fit(source: Source, unit: Unit, of: Reference) -> Fit | None:
    names: dict[str, str] = {}
    empty: dict[str, list[str]] = {}
    have = whole = 0.0
    taken: set[str] = set()
    for group, section in (("inputs", "input"), ("outputs", "output"), ("parameters", "input")):
        signals = of.signals(group)
        left = [name for name in unit.of(section) if name not in taken]

        def fits(signal: str, name: str, group: str = group, section: str = section) -> bool:
            kind = unit.of(section)[name].type
            wanted = of.signals(group)[signal].type
            return (wanted == "bool") == (isinstance(kind, Scalar) and kind.kind == "bool")

        found, doubtful = matched(list(signals), left, fits)
        if group != "parameters":
            whole += sum(weight(signal, _weights()) for signal in signals)
            have += sum(weight(signal, _weights()) for signal in found)
            lost = [signal for signal in signals if signal not in found]
            could = {
                signal: [name for name in left if name not in found.values() and fits(signal, name)]
                for signal in lost
            }
            if len(lost) == 1 and len(could[lost[0]]) == 1:  # the only one that is left
                found[lost[0]] = could[lost[0]][0]
            empty |= {signal: doubtful.get(signal, could[signal]) for signal in lost if signal not in found}
        taken |= set(found.values())
        names |= {signal: name for signal, name in found.items() if likeness(signal, name) != SURE}
    spare = tuple(name for name in unit.of("input") if name not in taken)
    nameless = sum(name in of.signals("inputs") for name in empty)
    share = have / (whole + max(0, len(spare) - nameless)) if whole else 0.0
    if share < (OF_ITS_NAME if likeness(of.device.name, unit.name) else ENOUGH):
        return None
    outputs = tuple(name for name in empty if name in of.signals("outputs"))
    why = "" if empty else _why(source, unit, of, names)
    return Fit(of.device.name, unit, share, names, empty, outputs, spare, why)


def _why(source: Source, unit: Unit, of: Reference, names: dict[str, str]) -> str:
    """Why the unit would be refused with these names; nothing where it would not."""
    try:
        Binding(of, source, unit, names)
    except Unjudged as error:
        return error.message
    return ""


@cache
def _weights() -> dict[str, float]:
    groups: Sequence[str] = ("inputs", "outputs")
    return weights(
        {name: [s for group in groups for s in reference(name).signals(group)] for name in targets()}
    )
