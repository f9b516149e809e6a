"""The TLA+ text of what a log shows: its lines, and the constants that its parameters set."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.rows import Device, Signal
from modeproof.trace.alphabet import Alphabet
from modeproof.trace.follow import passes, words_of
from modeproof.trace.log import Log, Row
from modeproof.trace.targets import PLACEHOLDER, SEEN, WORDS, Target

TLC_INTEGER = 2**31 - 1
MOST_CANDIDATES = 20_000
"""A line for which so many inputs are possible says nothing; it is refused rather than searched."""

Candidates = Sequence[Mapping[str, Any]]


def tla_value(signal: Signal, value: Any) -> str:
    """A value in Python form as TLA+ text.

    A number of a range beyond TLC's integers becomes a text, which is equal to itself only.
    """
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    if signal.type == "modes":
        return "{" + ", ".join(str(n) for n, member in enumerate(value) if member) + "}"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if signal.type == "int" and (signal.maximum is None or signal.maximum > TLC_INTEGER):
        return f'"{value}"'
    return str(value)


def record(fields: Mapping[str, str]) -> str:
    """A TLA+ record; the empty one is a function without arguments."""
    if not fields:
        return "[none \\in {} |-> 0]"
    return "[" + ", ".join(f"{name} |-> {value}" for name, value in fields.items()) + "]"


def input_record(device: Device, values: Mapping[str, Any], dt: int | None) -> str:
    """The inputs of one scan as a record, with `dt` and the device's name unless `dt` is None."""
    fields = {name: tla_value(signal, values[name]) for name, signal in device.inputs.items()}
    if dt is not None:
        fields |= {"dt": str(dt), "device": f'"{device.id}"'}
    return record(fields)


class Reading:
    """What the lines of a log can have been: for each line all possible inputs."""

    def __init__(self, target: Target, log: Log, alphabets: Mapping[str, Alphabet]) -> None:
        self.target = target
        self.log = log
        self._alphabets = alphabets
        self._words = {
            name: words_of(target, log, name) | {0, target.copies.other}
            for name in target.parts
            if target.copies is not None
        }

    def candidates(self, row: Row) -> Candidates:
        """All complete inputs that a line can stand for.

        Raises Unjudged when the line leaves too much open.
        """
        device = self.target.parts[row.device].device
        if all(name in row.inputs for name in device.inputs):
            return [row.inputs]
        alphabet = self._alphabets.get(row.device)
        if alphabet is None:
            missing = next(name for name in device.inputs if name not in row.inputs)
            raise Unjudged(
                f"{self.log.name}: line {row.line}: {missing} was not observed, and no graph of {device.id} "
                "tells what it can be"
            )
        found = alphabet.completions(row.inputs, self._words.get(row.device))
        if len(found) > MOST_CANDIDATES:
            raise Unjudged(
                f"{self.log.name}: line {row.line}: {len(found):,} inputs are possible; such a line is no "
                "evidence of anything"
            )
        return found

    def times(self, row: Row) -> Sequence[int]:
        """The time of the line; if it was not observed, one for each side of every deadline."""
        if row.dt_ms is not None:
            return (row.dt_ms,)
        device = self.target.parts[row.device].device
        if not self.target.timed(row.device):
            return (0,)
        return sorted({0, *self.deadlines(device)})

    def deadlines(self, device: Device) -> Iterable[int]:
        """The device's parameters in ms."""
        given = self.log.params[device.id]
        return (
            int(given[parameter.name]) for parameter in device.parameters.values() if parameter.type == "ms"
        )

    def line(self, row: Row, passed: Mapping[str, str]) -> tuple[str, str, str]:
        """One line in TLA+: the sets of its possible inputs and times, and a record of its observed outputs.

        Inputs are a tuple that begins with the device.
        """
        device = self.target.parts[row.device].device
        inputs = [
            ", ".join(
                [f'"{row.device}"', *(tla_value(of, values[name]) for name, of in device.inputs.items())]
            )
            for values in self.candidates(row)
            if passes(passed, row, (Row(row.line, row.device, row.dt_ms, values, {}),))
        ]
        outputs = {
            name: tla_value(device.outputs[name], value)
            for name, value in row.outputs.items()
            if name not in passed
        }
        times = ", ".join(map(str, self.times(row)))
        return "{" + ", ".join(f"<<{one}>>" for one in inputs) + "}", "{" + times + "}", record(outputs)


def read_inputs(target: Target) -> list[str]:
    """TLA+ that makes a record of the inputs of a scan from such a tuple and a time."""
    cases = [
        f'v[1] = "{name}" -> '
        + record(
            {
                **{signal: f"v[{n}]" for n, signal in enumerate(part.device.inputs, 2)},
                "dt": "t",
                "device": f'"{name}"',
            }
        )
        for name, part in target.parts.items()
    ]
    return ["LogRead(v, t) == CASE " + "\n    [] ".join(cases)]


def constants(target: Target, readings: Sequence[Reading]) -> dict[str, str]:
    """The constants of a target as TLA+; all logs must have the same parameters.

    Raises Unjudged when two devices have one parameter with different values.
    """
    params = readings[0].log.params
    _agree(target, readings[0].log)
    values = {}
    for constant, text in target.constants.items():
        values[constant] = PLACEHOLDER.sub(
            lambda match: _placeholder(target, readings, params, match.group(1), match.group(2)), text
        )
    return values


def _agree(target: Target, log: Log) -> None:
    seen: dict[str, tuple[str, Any]] = {}
    for device, given in log.params.items():
        for name, value in given.items():
            if name in seen and seen[name][1] != value and target.system:
                raise Unjudged(
                    f"{log.name}: {name} of {seen[name][0]} is {seen[name][1]!r}, of {device} {value!r}; "
                    f"the specification of {target.id} has one for both"
                )
            seen.setdefault(name, (device, value))


def _placeholder(
    target: Target,
    readings: Sequence[Reading],
    params: Mapping[str, Mapping[str, Any]],
    group: str,
    name: str,
) -> str:
    if group == WORDS:
        words = {word for reading in readings for word in words_of(target, reading.log, name)}
        return "{" + ", ".join(map(str, sorted(words))) + "}"
    if group == SEEN:
        device = target.parts[name].device
        found = {
            input_record(device, values, None): None
            for reading in readings
            for row, _ in reading.log.rows.kinds()
            if row.device == name
            for values in reading.candidates(row)
        }
        return "<<" + ", ".join(found) + ">>"
    signal = target.parts[group].device.parameters[name]
    wire = params[group][name]
    if signal.type == "function":
        return str(int(wire, 16))
    return tla_value(signal, target.forms.from_wire(signal, wire, f"parameter {name}"))
