"""Values and scans in words, alike in all forms of an outcome."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from modeproof.kit.errors import plain
from modeproof.output.outcome import Counterexample, Scan

_NEW = object()


def shown(value: Any) -> str:
    """A value: TRUE and FALSE as in the languages of PLCs, lists as in JSON."""
    if isinstance(value, bool):
        return str(value).upper()
    return plain(value if isinstance(value, str) else json.dumps(value, ensure_ascii=False))


def row(values: Mapping[str, Any]) -> str:
    """Names with their values."""
    return ", ".join(f"{plain(name)}={shown(value)}" for name, value in values.items())


def changed(before: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """What is not as it was."""
    return {name: value for name, value in values.items() if before.get(name, _NEW) != value}


def in_scan(number: int, scan: Scan, before: Scan | None, example: Counterexample, last: bool) -> str:
    """One scan: its time, what changes at the inputs and outputs, and what is wrong in the last."""
    time = "" if scan.dt_ms is None else f", {scan.dt_ms:,} ms after the one before"
    inputs = changed(before.inputs if before else {}, scan.inputs)
    outputs = changed(before.given if before else {}, scan.given)
    text = f"Scan {number}{time}: {row(inputs) or 'the same inputs'}"
    if scan.given:
        text += f"; then {row(outputs) or 'the same outputs'}"
    if last:
        text += f". {wrong_of(scan, example)}"
    elif scan.note:
        text += f". {plain(scan.note)}"
    return text


def wrong_of(scan: Scan, example: Counterexample) -> str:
    """What is wrong in the last scan."""
    if example.stopped:
        return f"Wrong: the program stops: {plain(example.stopped)}"
    pairs = [
        f"{plain(name)} is {shown(scan.given.get(name))}, expected {shown(scan.expected[name])}"
        for name in example.wrong
        if name in scan.expected
    ]
    return f"Wrong: {'; '.join(pairs)}" if pairs else "Wrong: here the property is false"
