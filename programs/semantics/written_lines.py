"""In which line a program set a variable: runs like the interpreter, and notes where each value came from."""

from __future__ import annotations

from typing import Any

from programs.language.tree import Expression, Place, Source, Unit, root_of
from programs.semantics.interpreter import Machine
from programs.semantics.memory_of_units import Frame


class Noting(Machine):
    """A program at power-up. `lines`: of each of its variables that was set, the place that set it last."""

    def __init__(self, source: Source, unit: Unit, wrap: bool = False) -> None:
        super().__init__(source, unit, wrap)
        self.lines: dict[str, Place] = {}

    def store(self, frame: Frame, target: Expression, value: Any) -> None:
        """Keep a value; of the program's own variables note where that was."""
        if frame is self.memory and hasattr(target, "place"):
            self.lines[root_of(target)] = target.place
        super().store(frame, target, value)
