"""The shipped step as mutants are compared with it: every path that memory in the invariant can take.

A path is kept with one member, and with the lines that the member passes. All members of a path take the same
way; so a path that does not pass the place of an edit ends in the mutant as it does in the shipped code, and
only the others are looked at. What the invariant excludes is never reached, neither by the shipped code nor
by a mutant that does the same wherever the invariant holds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import z3

from proofs.explorer import lint
from proofs.explorer.coverage import Watch, answering
from proofs.explorer.device import Device, Scan
from proofs.explorer.explore import Exploration, Path, conjunction, explore
from proofs.explorer.records import plain

POWER_UP: Final = "power-up"
"""Stands for the control state before the first scan: the state after power-up, and its outputs."""
LineOfFile = tuple[str, int]


@dataclass(frozen=True)
class Subject:
    """A device whose mutants are judged.

    known: what is true of a reachable state (a record with symbols), as one formula. answered: the theorem
    that says that every scan ends with a state and outputs.
    """

    device: Device
    known: Callable[[Any], z3.BoolRef]
    answered: str


@dataclass(frozen=True, eq=False)
class Way:
    """A path of the shipped code, with a member of it and the lines that it passes."""

    control: str
    scan: Scan | None
    """None at power-up."""
    arguments: tuple[Any, ...]
    premise: z3.BoolRef
    """The ranges, what the parameters fulfil, and what is known of the state."""
    path: Path
    member: tuple[Any, ...]
    result: Any
    lines: frozenset[LineOfFile]


@dataclass(frozen=True, eq=False)
class Shipped:
    """All ways of one device's step, and what they pass through."""

    subject: Subject
    ways: tuple[Way, ...]

    def passing(self, file: str, lines: tuple[int, int] | None) -> list[Way]:
        """The ways that pass one of these lines; all of them where no lines are given."""
        if lines is None:
            return list(self.ways)
        places = {(file, line) for line in range(lines[0], lines[1] + 1)}
        return [way for way in self.ways if way.lines & places]


def functions_of(device: Device) -> frozenset[tuple[str, str]]:
    """Module and name of every function that step or power-up reach, but what something stands in for."""
    skipped = [stand_in.name for stand_in in device.stand_ins]
    reached = [
        function
        for start in (device.module.step, device.module.power_up)
        for function in lint.reach_of(start, stand_ins=skipped).functions
    ]
    return frozenset((function.__module__, function.__qualname__) for function in reached)


def starts(device: Device) -> Any:
    """What is compared at power-up: the state after it, and its outputs."""

    def start(params: Any) -> tuple[Any, Any]:
        state = device.module.power_up(params)
        return state, device.module.outputs(state)

    return start


def entry(device: Device, control: str) -> Any:
    """What is run: `step`, or the start."""
    return starts(device) if control == POWER_UP else device.module.step


def run(device: Device, way: Way, model: z3.ModelRef | None = None) -> Any:
    """The member that the model gives, or the one that is kept, in the plain interpreter.

    An exception of the code is the result.
    """
    model, arguments = (
        (way.path.example, way.member)
        if model is None
        else (model, tuple(plain(argument, model) for argument in way.arguments))
    )
    with answering(device, model):
        try:
            return entry(device, way.control)(*arguments)
        except Exception as error:
            return error


def shipped(subject: Subject) -> Shipped:
    """Explore the shipped code of a device from every state of its invariant. Raises ExplorationError."""
    device = subject.device
    reach = lint.reach_of(device.module.step, stand_ins=[stand_in.name for stand_in in device.stand_ins])
    reach.refuse_faults()
    start = lint.reach_of(device.module.power_up)
    codes = {function.__code__ for function in (*reach.functions, *start.functions)}
    params = device.params()
    ways: list[Way] = []

    def add(control: str, arguments: tuple[Any, ...], known: z3.BoolRef, state: Any) -> None:
        fit = conjunction([device.parameters_fit(params), known])
        found = explore(entry(device, control), arguments, fit, device.stand_ins)
        scan = None
        if control != POWER_UP:
            scan = Scan(getattr(state, device.control), state, arguments[1], found)
        for path in found.paths:
            ways.append(_way(device, control, scan, arguments, found, path, codes))

    add(POWER_UP, (params,), z3.BoolVal(True), None)
    for control in device.module.Step:
        state = device.state(control, params)
        add(control.value, (state, device.inputs()), subject.known(state), state)
    return Shipped(subject, tuple(ways))


def _way(
    device: Device,
    control: str,
    scan: Scan | None,
    arguments: tuple[Any, ...],
    found: Exploration,
    path: Path,
    codes: Any,
) -> Way:
    watch = Watch(codes)
    member = tuple(plain(argument, path.example) for argument in arguments)
    with answering(device, path.example), watch:
        result = entry(device, control)(*member)
    return Way(control, scan, arguments, found.premise, path, member, result, frozenset(watch.lines))
