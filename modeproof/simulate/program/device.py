"""One device or block: the reference implementation's own code, its state, and the step that it took.

The step is told by a copy of the functions in which each `return` that the source marks with a step's name
reports it (`modeproof.simulate.step_marks`). The copy only names; what counts is the code itself, and both
are compared in every scan.
"""

from __future__ import annotations

import sys
from typing import Any

from modeproof.simulate.program.by_name import module_named

TOOK = "_took"
"""The name that a marked `return` of the copy calls."""


class Disagreement(Exception):
    """The copy that names the steps did something else than the code itself."""


class _Edited:
    """The names of an edited text of a module."""


def _program(module: str, source: str) -> Any:
    """An edited text as a program, under a name of its own: Brython keeps globals by the module's name."""
    name = f"{module}_edited_{len(sys.modules)}"
    room: dict[str, Any] = {"__name__": name}
    made: Any = _Edited()
    sys.modules[name] = made  # dataclasses look for the module of a class
    exec(source, room)
    for key, value in room.items():
        setattr(made, key, value)
    return made


class Device:
    """A device after power-up with these parameters (Python values); others have their defaults.

    `source` is what runs instead of the module's own text, where a reading of a document is to be seen.
    """

    def __init__(self, module: str, labelled: str, params: dict[str, Any], source: str = "") -> None:
        self.code: Any = _program(module, source) if source else module_named(module)
        self.state: Any = self.code.power_up(self.code.Params(**params))
        self.out: Any = self.code.outputs(self.state)
        self.step = ""
        self._labelled = labelled
        self._copy: Any = None
        self._control = next(
            field
            for field in self.code.State.__annotations__
            if type(getattr(self.state, field)) is self.code.Step
        )

    def power_up(self, params: dict[str, Any]) -> None:
        """Switch it off and on, with these parameters."""
        self.state = self.code.power_up(self.code.Params(**params))
        self.out = self.code.outputs(self.state)
        self.step = ""

    def scan(self, inputs: Any) -> Any:
        """One scan. Returns the outputs; raises Disagreement, and InputError of the implementation."""
        after, out = self.code.step(self.state, inputs)
        named: list[tuple[str, ...]] = []
        twin, _ = self._twin(named)(self.state, inputs)
        if twin != after:
            raise Disagreement(f"{named}: {twin} is not {after}")
        names = named[-1] if named else ("",)
        self.step = names[-1] if self.control(after) == self.control() else names[0]
        self.state, self.out = after, out
        return out

    def control(self, state: Any = None) -> str:
        """The control state: the one field of the state that is a `Step`."""
        of = self.state if state is None else state
        return str(getattr(of, self._control).value)

    def _twin(self, named: list[tuple[str, ...]]) -> Any:
        if self._copy is None:
            room = {name: getattr(self.code, name) for name in dir(self.code)}
            exec(self._labelled, room)
            self._copy = room

        def took(steps: tuple[str, ...], after: Any) -> Any:
            named.append(steps)
            return after

        self._copy[TOOK] = took
        return self._copy["step"]


def take(of: dict[str, Any], value: Any) -> Any:
    """A wire value (form of the adapter protocol) as the Python value of a signal."""
    kind = of["type"]
    if kind == "word":
        return int(value, 16)
    if kind == "mode":
        return -1 if value is None else value
    if kind == "modes":
        return tuple([mode in value for mode in range(5)])
    if kind == "text":
        return value or ""
    return value


def give(of: dict[str, Any], value: Any) -> Any:
    """The Python value of a signal as it goes over the wire."""
    kind = of["type"]
    if kind == "word":
        return f"{value:04X}"
    if kind == "mode":
        return None if value == -1 else value
    if kind == "modes":
        return [mode for mode, there in enumerate(value) if there]
    if kind == "text" and "" in of["values"]:
        return value or None
    return value


def inputs_of(code: Any, rows: dict[str, Any], dt_ms: int, wire: dict[str, Any]) -> Any:
    """The record of inputs of a scan from wire values. Raises InputError."""
    return code.Inputs(dt_ms, **{name: take(of, wire[name]) for name, of in rows.items()})


def on_wire(rows: dict[str, Any], record: Any) -> dict[str, Any]:
    """The fields of Inputs or Outputs as wire values, in the order of the interface."""
    return {name: give(of, getattr(record, name)) for name, of in rows.items()}
