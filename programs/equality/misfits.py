"""All names of a program that do not fit a target, at once, with the binding to begin with."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from difflib import SequenceMatcher

from modeproof.registers import Signal
from programs.language.tree import Array, Scalar, Unit, Variable
from programs.semantics.reference import Reference

KINDS = {
    "bool": ("bool",),
    "word": ("bits",),
    "mode": ("int",),
    "int": ("int", "bits"),
    "ms": ("time", "int"),
    "text": ("int", "enum"),
    "modes": ("bits", "array"),
}
"""By the type of a signal: of what kind a variable for it is."""
LEAST = 0.35
"""Likeness of two names, from which on one is proposed for the other."""


def refuse(
    reference: Reference, unit: Unit, left_out: Collection[str], path: Callable[[str, str], str | None]
) -> None:
    """Refuse a program to which names are lacking, all at once.

    One that lacks alone, and is like nothing, has a message of its own. path: the variable that is a signal
    already. Raises Unjudged.
    """
    lacking: list[str] = []
    names: list[str] = []
    alone: list[str] = []
    number = 0
    for group, section in (("inputs", "input"), ("outputs", "output")):
        signals = {n: one for n, one in reference.signals(group).items() if n not in left_out}
        others = reference.signals("parameters") if section == "input" else {}
        taken = {name: path(name, section) for name in (*signals, *others)}
        missing = [name for name in signals if taken[name] is None]
        known = {*taken.values(), "DT_MS"}
        spare = {key: one for key, one in unit.of_keys(section).items() if key not in known}
        open_ones = {n: one for n, one in {**signals, **others}.items() if taken[n] is None}
        found = _proposals(open_ones, spare)
        if missing:
            lacking.append(f"has no {section} {', '.join(missing)}")
        if spare and section == "input":
            lacking.append(f"has {', '.join(one.name for one in spare.values())}, no signal of the target")
        names += [f'{name} = "{own}"' for name, own in found.items()]
        alone += [f'"{name}"' for name in missing if section == "output" and name not in found]
        number += len(missing)
    if number < 2 and not names:
        return
    if not lacking:
        return
    begin = [f"names = {{ {', '.join(names)} }}"] if names else []
    begin += [f"left_out = [{', '.join(alone)}]"] if alone else []
    advice = f"; a binding to begin with: {' and in another line '.join(begin)}" if begin else ""
    raise unit.place.refuse(f"{unit.name} {'; it '.join(lacking)}{advice}")


def _proposals(signals: Mapping[str, Signal], spare: Mapping[str, Variable]) -> dict[str, str]:
    """For each signal the variable that it may be: the likest names first, then what alone is of its kind."""
    likeness = sorted(
        (
            (_like(name, one.name), name, key)
            for name, signal in signals.items()
            for key, one in spare.items()
            if _kind(one) in KINDS.get(signal.type, ())
        ),
        reverse=True,
    )
    found: dict[str, str] = {}
    left = dict(spare)
    for like, name, key in likeness:
        others = [one for _, other, one in likeness if other == name and one in left]
        if name not in found and key in left and (like >= LEAST or others == [key]):
            found[name] = left.pop(key).name
    return found


def _kind(variable: Variable) -> str:
    if isinstance(variable.type, Array):
        return "array"
    return variable.type.kind if isinstance(variable.type, Scalar) else ""


def _like(one: str, other: str) -> float:
    first, second = (name.upper().replace("_", "") for name in (one, other))
    return SequenceMatcher(None, first, second).ratio()
