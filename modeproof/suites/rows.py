"""Inputs and outputs of scans as they are written; of a scan only what differs from the one before."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from modeproof.graph.device import DeviceGraph
from modeproof.registers.rows import Signal
from modeproof.suites.script import Shot

Pieces = tuple[str, ...]
"""Signals as they are written, `"name":value` each, in the order of the names."""
_ENCODE = json.JSONEncoder(separators=(",", ":")).encode


class Rows:
    """The pieces of scans of one graph; what repeats is made once."""

    def __init__(self, device: DeviceGraph) -> None:
        self.device = device
        self._in: dict[int, Pieces] = {}
        self._out: dict[tuple[Any, ...], Pieces] = {}

    def pieces(self, shot: Shot, state: int, renamed: Mapping[int, int]) -> tuple[Pieces, Pieces]:
        """The inputs of a shot, and the outputs after it in `state`."""
        device = self.device
        values = {**device.alphabet[shot.letter], **shot.values}
        if renamed:
            expected = _renamed(device.device.outputs, device.expected(state, values), renamed)
            values = _renamed(device.device.inputs, values, renamed)
            return _pieces(device.wire_inputs(values)), _pieces(device.wire_outputs(expected))
        if shot.values:
            now_in = _pieces(device.wire_inputs(values))
        else:
            if shot.letter not in self._in:
                self._in[shot.letter] = _pieces(device.wire_inputs(values))
            now_in = self._in[shot.letter]
        key = (state, *[values[name] for name in device.passed.values()])
        if key not in self._out:
            self._out[key] = _pieces(device.wire_outputs(device.expected(state, values)))
        return now_in, self._out[key]


def _pieces(values: Mapping[str, Any]) -> Pieces:
    return tuple(f"{_ENCODE(name)}:{_ENCODE(values[name])}" for name in sorted(values))


def _renamed(
    signals: Mapping[str, Signal], values: Mapping[str, Any], names: Mapping[int, int]
) -> dict[str, Any]:
    """The values with other words for the words in `names`, in signals of type word only."""
    return {
        name: names.get(value, value) if name in signals and signals[name].type == "word" else value
        for name, value in values.items()
    }


def changed(before: Pieces, now: Pieces) -> str:
    """What of `now` differs from `before`; all of it where nothing was before."""
    if not before:
        return ",".join(now)
    return ",".join([new for old, new in zip(before, now, strict=True) if old != new])
