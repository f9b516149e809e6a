"""The state chart of a device: its complete graph with all states of the same control state as one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from modeproof.graph.device import DeviceGraph
from modeproof.ground.errors import Unjudged
from modeproof.tlc.tla_values import TlaError, parse


@dataclass(frozen=True)
class Move:
    """All transitions of one step from one control state to one other (or the same)."""

    source: str
    step: str
    target: str
    transitions: int


@dataclass(frozen=True)
class Chart:
    """`states` counts the states of the graph by control state, in the order of interface.toml; a declared
    control state that the graph never enters counts 0. `initial` is the one after power-up. `outputs` holds
    for each control state those outputs (wire values) that are the same in all its states.
    """

    initial: str
    states: dict[str, int]
    outputs: dict[str, dict[str, Any]]
    moves: tuple[Move, ...]


def chart(device: DeviceGraph) -> Chart | None:
    """The chart of a device's graph; None when its states do not show a control state.

    The control state is the component of a state that always is one of the `states` of interface.toml; there
    must be exactly one. Raises Unjudged when a state is no TLA+ tuple.
    """
    graph, declared = device.graph, device.device.states
    control = _control_states(device)
    if not control:
        return None
    steps = graph.steps
    counted: Counter[tuple[str, str, str]] = Counter()
    for here, taken, following in zip(control, graph.step_of, graph.next_of, strict=True):
        for (step, after), count in Counter(zip(taken, following, strict=True)).items():
            counted[here, steps[step], control[after]] += count
    order = {state: n for n, state in enumerate(declared)}
    place = {step: n for n, step in enumerate(device.device.steps)}
    moves = sorted(counted, key=lambda one: (order[one[0]], order[one[2]], place[one[1]]))
    entered = Counter(control)
    return Chart(
        initial=control[graph.initial],
        states={state: entered[state] for state in declared},
        outputs=_outputs(device, control),
        moves=tuple(Move(*move, counted[move]) for move in moves),
    )


def _outputs(device: DeviceGraph, control: Sequence[str]) -> dict[str, dict[str, Any]]:
    """What the outputs of each control state always are; an output that repeats an input is left out."""
    found: dict[str, dict[str, Any]] = {}
    for here, row in zip(control, device.rows, strict=True):
        known = found.setdefault(here, dict(row))
        for name in [name for name, value in known.items() if row[name] != value]:
            del known[name]
    types = device.device.outputs
    return {
        state: {name: device.forms.to_wire(types[name], value) for name, value in found[state].items()}
        for state in device.device.states
        if state in found
    }


def _control_states(device: DeviceGraph) -> list[str]:
    """The control state of each state of the graph; nothing where they do not show it."""
    try:
        views = [parse(view) for view in device.graph.views]
    except TlaError as error:
        raise Unjudged(f"{device.graph.source}: a state cannot be read: {error}") from None
    declared = set(device.device.states)
    places = [
        n
        for n in range(min(map(len, views)))
        if all(isinstance(view[n], str) and view[n] in declared for view in views)
    ]
    return [str(view[places[0]]) for view in views] if len(places) == 1 else []
