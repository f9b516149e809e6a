"""Namespaces: every unit keeps its plain name, for no two units that are read together have the same one.

So a namespace never chooses between units. It only says whether a name may be used where it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from modeproof.ground.errors import Unjudged, suggestion
from programs.language.calls import called_functions
from programs.language.tree import Array, Call, Function, Instance, Member, Name, Place, Type, Unit


def resolved(units: Mapping[str, Unit]) -> dict[str, Unit]:
    """The units with plain names in the place of `Space.Name`.

    Raises Unjudged: a name from a namespace that is not used there, or USING of one that is not there.
    """
    spaces = {space for unit in units.values() for space in _outer(unit.namespace)}
    if not spaces and not any(unit.using for unit in units.values()):
        return dict(units)
    for unit in units.values():
        for name, place in unit.using:
            if not any(one in spaces for one in _candidates(name, unit.namespace)):
                raise place.refuse(
                    f"USING {name}: no file that is given has this namespace; give the file that has it too, "
                    "or take the line out"
                )
    return {key: _Names(units, unit).plain() for key, unit in units.items()}


def _outer(namespace: str) -> list[str]:
    """A namespace in upper case, and those around it."""
    parts = namespace.upper().split(".") if namespace else []
    return [".".join(parts[:number]) for number in range(1, len(parts) + 1)]


def _candidates(name: str, namespace: str) -> list[str]:
    """What a namespace may be called in full, where it is used within another."""
    return [name.upper(), *(f"{outer}.{name.upper()}" for outer in _outer(namespace))]


class _Names:
    """The names that one unit uses."""

    def __init__(self, units: Mapping[str, Unit], unit: Unit) -> None:
        self.units, self.unit = units, unit

    def plain(self) -> Unit:
        """The unit with plain names."""
        variables = {
            key: replace(variable, type=self.type(variable.type, variable.place))
            for key, variable in self.unit.variables.items()
        }
        for name in called_functions(self.unit.body):
            if "." not in name and name not in variables:
                self.look(name, self.unit.place)
        return replace(self.unit, variables=variables, body=self.inner(self.unit.body))

    def type(self, kind: Type, place: Place) -> Type:
        if isinstance(kind, Array):
            return replace(kind, element=self.type(kind.element, place))
        return Instance(self.look(kind.block, place)) if isinstance(kind, Instance) else kind

    def inner(self, part: Any) -> Any:
        """A part of a body with plain names of functions."""
        if isinstance(part, tuple):
            return tuple(self.inner(one) for one in part)
        if not hasattr(part, "place"):
            return part
        made = type(part)(**{name: self.inner(value) for name, value in vars(part).items()})
        if isinstance(made, Function) and "." in made.name and not self.declared(made.name):
            return replace(made, name=self.look(made.name, made.place))
        if isinstance(made, Call) and isinstance(made.instance, Member):
            whole = _dotted(made.instance)
            if whole and not self.declared(whole):
                return replace(made, instance=Name(self.look(whole, made.place), made.place))
        return made

    def declared(self, name: str) -> bool:
        """Whether a name with dots begins with a variable, so that it is no namespace."""
        return name.partition(".")[0].upper() in self.unit.variables

    def look(self, name: str, place: Place) -> str:
        """The plain name of what a name means here; a name that no unit has stays."""
        space, _, tail = name.rpartition(".")
        found = self.units.get(tail.upper())
        if found is None and not space:
            return name
        here = [
            _outer(self.unit.namespace),
            *(_candidates(one, self.unit.namespace) for one, _ in self.unit.using),
        ]
        near = ["", *(one for group in here for one in group)]
        allowed = _candidates(space, self.unit.namespace) if space else near
        if found is None or found.namespace.upper() not in allowed:
            raise self.unknown(name, found, place)
        return tail

    def unknown(self, name: str, found: Unit | None, place: Place) -> Unjudged:
        if found is None:
            known = [f"{unit.namespace}.{unit.name}".lstrip(".") for unit in self.units.values()]
            return place.refuse(f"{name} is not known; {suggestion(name, known)}")
        where = f"is in the namespace {found.namespace}" if found.namespace else "is in no namespace"
        advice = f"; write {found.namespace}.{found.name} or USING {found.namespace}" * bool(found.namespace)
        return place.refuse(f"{name}: {found.name} {where}{advice}")


def _dotted(node: Any) -> str:
    """A.B.C; empty: it is made of something else."""
    if isinstance(node, Name):
        return node.name
    above = _dotted(node.of) if isinstance(node, Member) else ""
    return f"{above}.{node.name}" if above else ""
