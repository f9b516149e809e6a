"""A row `block.NAME` of a wiring, and the pins of the kind of block that it names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import msgspec

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.typed import Entry, Text
from programs.language.tree import BOOL, TIME, Scalar, Unit


class Row(Entry, frozen=True, kw_only=True):
    """An instance of a block: the source of each input pin, the parameters that are not at their default."""

    of: Text
    why: Text
    inputs: dict[str, Text]
    parameters: dict[str, int | bool | str] = msgspec.field(default_factory=dict)


@dataclass(frozen=True)
class Pins:
    """The pins of a kind of block: name and type of inputs, parameters and outputs."""

    inputs: Mapping[str, Scalar]
    parameters: Mapping[str, Scalar]
    outputs: Mapping[str, Scalar]
    unit: Unit | None
    """Of a document's block."""
    own: Unit | None = None
    """Of a block of one's own (own_pins.py)."""


def check_row(row: Row, pins: Pins, refuse: Callable[[str, str], Unjudged], here: str, cycle_ms: int) -> None:
    """Each pin has its one source, each parameter a value that it can have. here: the name of the row.

    Raises what `refuse` gives for a row and a cause.
    """
    for pin in row.inputs:
        if pin in pins.parameters:
            raise refuse(f"{here}.inputs.{pin}", "is a parameter; it belongs in `parameters`")
        if pin not in pins.inputs:
            cause = f"{row.of} has no input {pin!r}; {suggestion(pin, pins.inputs)}"
            raise refuse(f"{here}.inputs.{pin}", cause)
    for pin in pins.inputs:
        if pin not in row.inputs:
            raise refuse(f"{here}.inputs.{pin}", f"an input without a source: {row.of} reads {pin}")
    for pin in pins.parameters:
        given = pins.own is not None and pins.own.of("input")[pin].initial is not None
        if pins.unit is None and pin not in row.parameters and not given:
            raise refuse(f"{here}.parameters.{pin}", f"a parameter without a value: {row.of} has no default")
    for pin, value in row.parameters.items():
        place = f"{here}.parameters.{pin}"
        if pin not in pins.parameters:
            known = suggestion(pin, pins.parameters) if pins.parameters else "it has none"
            raise refuse(place, f"{row.of} has no parameter {pin!r}; {known}")
        kind = pins.parameters[pin]
        if kind is TIME:
            if type(value) is not int or value < 0:
                raise refuse(place, f"a time in whole ms, not {value!r}")
            if value % cycle_ms:
                raise refuse(place, f"{value} ms is no multiple of the cycle, {cycle_ms} ms")
        elif kind is BOOL and type(value) is not bool:
            raise refuse(place, f"true or false, not {value!r}")
        elif kind.kind == "enum" and value not in kind.names:
            raise refuse(place, f"{value!r} is not allowed; {suggestion(str(value), kind.names)}")
        elif kind.kind not in ("bool", "enum") and type(value) is not int:
            raise refuse(place, f"a number, not {value!r}")
