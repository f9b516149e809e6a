"""The memory of a program with plain values: one frame for each unit, with those of its instances below."""

from __future__ import annotations

from typing import Any

from programs.language.memory import default
from programs.language.tree import Array, Instance, Source, Struct, Type, Unit, blocks_in
from programs.language.types import Types
from programs.semantics.interpreter_blocks import Standard


class Frame:
    """The memory of one unit: its variables, and below them those of its instances."""

    def __init__(self, source: Source, unit: Unit, shared: dict[str, Any] | None = None) -> None:
        """shared: the variables of the unit that is the program, among which are the globals."""
        self.source, self.unit = source, unit
        self.types: Types = source.kept.setdefault(id(unit), Types(source, unit))
        self.temporary = {
            key: default(variable.type, variable.initial)
            for key, variable in unit.variables.items()
            if variable.section == "temp"
        }
        """What VAR_TEMP holds when a call begins."""
        self.values: dict[str, Any] = {}
        self.shared = self.values if shared is None or unit.whole else shared
        self.external = frozenset(unit.of_keys("external"))
        self.values |= {
            key: self.made(variable.type, variable.initial)
            for key, variable in unit.variables.items()
            if key not in self.external
        }
        self.state: Any = None
        self.since = 0
        if unit.device is not None:
            self.values |= unit.device.memory()

    def holder(self, name: str) -> dict[str, Any]:
        """Where a variable of this unit is kept, by its name in upper case."""
        return self.shared if name in self.external else self.values

    def made(self, kind: Type, initial: object) -> Any:
        """The first value of a variable, with the instances in it."""
        if isinstance(kind, Instance):
            block = kind.block.upper()
            known = self.source.units.get(block)
            return Standard(block) if known is None else Frame(self.source, known, self.shared)
        if isinstance(kind, Array) and any(blocks_in(kind)):
            return [self.made(kind.element, None) for _ in range(kind.low, kind.high + 1)]
        if isinstance(kind, Struct) and any(blocks_in(kind)):
            own = dict(initial) if isinstance(initial, tuple) else {}
            return {
                name.upper(): self.made(inner, own.get(name.upper(), value))
                for name, inner, value in kind.members
            }
        return default(kind, initial)
