"""Suite `refusals`: what an adapter must refuse, kept apart from what a program must answer.

Cases with `"judges": "adapter"` hold one request that protocol 1 forbids: a field that is missing, unknown,
of a wrong type or out of range, or a message of no known form. It is sent in a control state where the same
request without the fault would change the state; the answer must be a refusal, and what follows must come out
as if it had not been sent. Control states take turns.

Cases with `"judges": "program"` hold well-formed inputs that an adapter has no right to refuse, though they
mean nothing to the program: members of the classes of interface.toml, in every control state. The program
answers them as the specification does, with its error output or without.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph
from modeproof.registers.rows import Signal
from modeproof.suites.apart import Apart
from modeproof.suites.script import Script, Scripts, Shot, control_state, ways_from_power_up

MEMBERS = 24
"""So many members of a class are sent in each control state at most."""


def plan(device: DeviceGraph, columns: Columns) -> Scripts:
    """The cases for one graph; the one that comes before any reset is the first."""
    nearest = _nearest(device)
    adapter = list(_adapter(device, columns, nearest))
    program = list(_program(device, nearest))
    notes = {"adapter_cases": len(adapter), "program_cases": len(program)}
    return Scripts([*adapter, *program], notes)


def _nearest(device: DeviceGraph) -> list[tuple[str, int, tuple[int, ...]]]:
    """For each control state the state nearest to power-up with the way to it; far ones first."""
    ways = ways_from_power_up(device)
    found: dict[str, tuple[int, tuple[int, ...]]] = {}
    for state, way in enumerate(ways):
        control = control_state(device, state)
        if way is not None and (control not in found or len(way) < len(found[control][1])):
            found[control] = (state, way)
    order = sorted(found.items(), key=lambda item: (-len(item[1][1]), item[0]))
    return [(control, state, way) for control, (state, way) in order]


# --------------------------------------------------------------------------------------------- adapter


def _adapter(
    device: DeviceGraph, columns: Columns, nearest: list[tuple[str, int, tuple[int, ...]]]
) -> Iterator[Script]:
    apart = Apart(columns, device.seen)
    chances = []
    for control, state, way in nearest:
        for members, after in zip(columns.members, columns.next_of[state], strict=True):
            sequence = apart.sequence(state, after)
            if sequence is not None:
                chances.append((control, way, members[0], tuple(columns.members[c][0] for c in sequence)))
                break
    if not chances:
        return
    first = _message(device, chances[0][2])
    yield Script(
        "a scan before the first reset is refused", [Shot(refuse=first)], judges="adapter", reset=False
    )
    faults = len(list(_faults(device, first)))
    for n in range(faults):
        control, way, letter, following = chances[n % len(chances)]
        why, request = next(
            fault for k, fault in enumerate(_faults(device, _message(device, letter))) if k == n
        )
        shots = [
            *(Shot(letter_before) for letter_before in way),
            Shot(refuse=request),
            *(Shot(letter_after) for letter_after in following or (letter,)),
        ]
        yield Script(f"refused, and without effect, in {control}: {why}", shots, judges="adapter")


def _message(device: DeviceGraph, letter: int) -> dict[str, Any]:
    values = device.alphabet[letter]
    return {"op": "scan", "dt_ms": values["dt_ms"], "in": device.wire_inputs(values)}


def _faults(device: DeviceGraph, good: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any] | str]]:
    """Every request that protocol 1 forbids, made from a good one, with what is wrong in it."""
    inputs: Mapping[str, Any] = good["in"]
    for name, signal in device.device.inputs.items():
        yield f"{name} is missing", {**good, "in": {key: inputs[key] for key in inputs if key != name}}
        for value in wrong_values(signal, device.forms.modes):
            yield f"{name} is {json.dumps(value)}", {**good, "in": {**inputs, name: value}}
    yield "an input that the target does not have", {**good, "in": {**inputs, "no_such_input": True}}
    yield "inputs in a list", {**good, "in": list(inputs.values())}
    yield "no inputs at all", {key: good[key] for key in good if key != "in"}
    yield "no dt_ms", {key: good[key] for key in good if key != "dt_ms"}
    for value in (-1, 0.5, "10", True, None):
        yield f"dt_ms is {json.dumps(value)}", {**good, "dt_ms": value}
    yield "dt_ms is not a number", json.dumps({**good, "dt_ms": "?"}).replace('"?"', "NaN")
    yield "a field of the message that nobody knows", {**good, "no_such_field": 0}
    yield "an operation that nobody knows", {**good, "op": "no_such_operation"}
    yield "an object without op", {}
    yield "a list", "[1]"
    yield "no JSON", "scan"
    yield "half a message", json.dumps(good)[:-1]
    hello = {"op": "hello", "protocol": 1, "target": device.device.id}
    yield "another protocol", {**hello, "protocol": 2}
    yield "another target", {**hello, "target": "no_such_target"}
    yield "a parameter that the target does not have", _reset({"no_such_parameter": 1})
    yield "parameters in a list", {"op": "reset", "params": [1]}
    for name, signal in device.device.parameters.items():
        if signal.type != "function":
            for value in wrong_values(signal, device.forms.modes):
                yield f"the parameter {name} is {json.dumps(value)}", _reset({**device.params, name: value})


def _reset(params: Mapping[str, Any]) -> dict[str, Any]:
    return {"op": "reset", "params": dict(params)}


def wrong_values(signal: Signal, modes: tuple[int, ...]) -> list[Any]:
    """Wire values outside the type of a signal: wrong types, and just out of range."""
    if signal.type == "bool":
        return [0, 1, "true", None]
    if signal.type == "word":
        return [0, "", "FFF", "00FFF", "0ff0", "0x0F", "GGGG", " 0FF", None]
    if signal.type == "mode":
        return [modes[0] - 1, modes[-1] + 1, 0.5, "0", True, [0]]
    if signal.type == "modes":
        return [None, modes[0], [modes[-1] + 1], [True], [modes[0], modes[0]], "0"]
    if signal.type == "text":
        return [0, "no such text", *([""] if "" in signal.values else [None])]
    low, high = signal.minimum, signal.maximum
    ends = [*([] if low is None else [low - 1]), *([] if high is None else [high + 1])]
    return [*ends, 0.5, "1", True, None]


# --------------------------------------------------------------------------------------------- program


def _program(device: DeviceGraph, nearest: list[tuple[str, int, tuple[int, ...]]]) -> Iterator[Script]:
    graph = device.graph
    for control, state, way in nearest:
        for input_class in device.classes:
            letters = [
                n
                for n, have in enumerate(device.alphabet)
                if input_class.representative.items() <= have.items()
            ]
            members = input_class.members[:: max(1, len(input_class.members) // MEMBERS)][:MEMBERS]
            for n, member in enumerate(members):
                letter = letters[n * 7 % len(letters)]
                step = graph.steps[graph.step_of[state][letter]]
                shown = ", ".join(
                    f"{name} = {json.dumps(device.forms.to_wire(device.device.inputs[name], value))}"
                    for name, value in member.items()
                )
                yield Script(
                    f"no refusal but an answer of the program, in {control}: {shown}: {step}",
                    [*(Shot(back) for back in way), Shot(letter, member)],
                    about=(len(way),),
                    judges="program",
                )
    if device.copied is not None:
        letter = len(device.alphabet) - 1
        yield Script(
            "no refusal but an answer of the program: the words FFFF and FFFE",
            [Shot(letter)] * 2 * len(device.copied.fields),
            renamed=dict(zip(device.copied.words, (0xFFFF, 0xFFFE), strict=True)),
            judges="program",
        )
