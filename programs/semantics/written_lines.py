"""In which line a program set a variable: runs like the interpreter, and notes where each value came from."""

from __future__ import annotations

from typing import Any

from programs.language.tree import Expression, Place, root_of
from programs.semantics.interpreter import Machine
from programs.semantics.memory_of_units import Frame


class Noting(Machine):
    """A program at power-up. `lines`: of each variable of its own the place that set it last in this scan."""

    lines: dict[str, Place]

    def scan(self, inputs: Any, dt_ms: int) -> dict[str, Any]:
        """One scan, as the interpreter does it."""
        self.lines = {}
        return super().scan(inputs, dt_ms)

    def store(self, frame: Frame, target: Expression, value: Any) -> None:
        """Keep a value; of the program's own variables note where that was."""
        if frame is self.memory and hasattr(target, "place"):
            self.lines[root_of(target)] = target.place
        super().store(frame, target, value)
