"""A wiring with blocks that the reference has not: those of one's own, and more of the standard ones.

What runs and what is proved is the program that the wiring describes, with the source of these blocks.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from machines.composed_program import with_own_wires
from machines.coverage import unread
from machines.user_program import ProgramMachine
from machines.verdicts import Machine
from modeproof.ground.errors import Unjudged
from programs.language.shared_memory import completed
from programs.language.tree import Source, Unit
from programs.semantics import document_blocks as blocks


@dataclass
class OwnMachine(ProgramMachine):
    """The composed program with the blocks of one's own, judged as a program."""

    sources: Sequence[Path] = field(default=(), kw_only=True)

    @cached_property
    def composed(self) -> Unit:
        """The program of the wiring, each wire under a name of its own. Raises Unjudged."""
        made = with_own_wires(self.wiring)
        if (other := self.wiring.source.units.get(made.name.upper())) is not None:
            raise other.place.refuse(f"{other.name} is the name of the machine itself; take another")
        return made

    @cached_property
    def source(self) -> Source:
        """All of it. Raises Unjudged with file, line and cause."""
        own = self.wiring.source
        return replace(own, units={**own.units, self.composed.name.upper(): self.composed})

    @cached_property
    def own(self) -> Unit:
        """The unit that is the machine."""
        return completed(blocks.with_blocks(self.source), self.composed)

    def spelled(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
        """As `Machine.spelled`: the standard blocks are those of the wiring."""
        return Machine.spelled(self, row)

    @cached_property
    def _wires(self) -> set[str]:
        return set(self.wiring.signals)

    @property
    def _blocks(self) -> list[str]:
        return list(self.wiring.kinds)

    @property
    def unread(self) -> Iterator[str]:
        """The inputs that reach no block and no output."""
        return unread(self.wiring)


def refuse_own(machine: Machine, what: str) -> None:
    """Raises Unjudged where a wiring has a block that is known by its source alone. what: what has it not."""
    if names := machine.wiring.only_by_source:
        raise Unjudged(f"{machine.file}: {what} has no {', '.join(names)}: known here by source alone")
