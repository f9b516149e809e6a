"""The verdict on a log, to read and as a record."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from modeproof.trace.follow import Followed, NotFollowed
from modeproof.trace.judge import Judgement
from modeproof.trace.log import Row
from modeproof.trace.targets import Target


def as_text(target: Target, found: Judgement, samples: bool = False) -> str:
    """What to print; the last line is the verdict."""
    log = found.log
    total = len(log.rows)
    unit = "samples" if samples else "scans"
    lines = [f"{log.name}: {found.accepted:,} of {total:,} {unit} of {target.id} fit the specification"]
    lines += [f"  {line}" for line in _observed(target, found)]
    lines.append(f"  by graph: {_followed(found.followed, unit)}")
    lines.append(f"  by TLC:   {found.accepted:,} {unit}{_exactness(target, found, samples)}")
    if found.accepted < total:
        row = log.rows[found.accepted]
        lines.append(f"first impossible {unit[:-1]}: {found.accepted + 1:,}, line {row.line} of the log")
        lines += [f"  {line}" for line in _row(target, row)]
    lines.append(f"{found.verdict}({'samples' if samples else 'exact'}, {log.name})")
    return "\n".join(lines)


def _observed(target: Target, found: Judgement) -> list[str]:
    lines = []
    for name, part in target.parts.items():
        signals = [*part.device.inputs, *part.device.outputs]
        seen = found.log.observed(name)
        blind = [signal for signal in signals if signal not in seen]
        if blind:
            lines.append(f"not observed of {name}: {', '.join(blind)}")
    return lines or ["every signal was observed"]


def _followed(one: Followed | NotFollowed, unit: str) -> str:
    if isinstance(one, NotFollowed):
        return f"not followed; {one.reason}"
    how = f"; left open: {'; '.join(one.open)}" if one.open else ", exactly"
    return f"{one.accepted:,} {unit} through {' '.join(one.runs)}{how}"


def _exactness(target: Target, found: Judgement, samples: bool) -> str:
    timed = any(target.timed(device) for device in target.parts)
    if samples and timed:
        return "; the time of the scans between two samples is left open"
    if timed and any(row.dt_ms is None and target.timed(row.device) for row in found.log.rows):
        return "; times that were not observed are left open"
    return ", exactly"


def _row(target: Target, row: Row) -> list[str]:
    part = target.parts[row.device]
    lines = []
    for title, signals, values in (
        ("inputs", part.device.inputs, row.inputs),
        ("outputs", part.device.outputs, row.outputs),
    ):
        shown = [
            f"{name}={shown_value(target, row.device, name, values[name])}"
            for name in signals
            if name in values
        ]
        time = [] if row.dt_ms is None or title == "outputs" else [f"dt_ms={row.dt_ms}"]
        lines.append(f"{title:<8} {' '.join([*time, *shown]) or 'not observed'}")
    return lines


def shown_value(target: Target, device: str, name: str, value: Any) -> str:
    """A value as on the wire."""
    one = target.parts[device].device
    signal = one.inputs.get(name) or one.outputs[name]
    wire = target.forms.to_wire(signal, value)
    return wire if isinstance(wire, str) else json.dumps(wire, separators=(",", ":"))


def as_record(target: Target, found: Judgement) -> dict[str, Any]:
    """The judgement as plain data."""
    one = found.followed
    return {
        "accepted": found.accepted,
        "line": None if found.status == 0 else found.log.rows[found.accepted].line,
        "unobserved": {
            name: [
                signal
                for signal in (*part.device.inputs, *part.device.outputs)
                if signal not in found.log.observed(name)
            ]
            for name, part in target.parts.items()
        },
        "params": {device: dict(values) for device, values in found.log.params.items()},
        "graph": {"not_followed": one.reason}
        if isinstance(one, NotFollowed)
        else {"accepted": one.accepted, "left_open": list(one.open), "runs": list(one.runs)},
        "tlc": {"accepted": found.matched.accepted, "states": [dict(view) for view in found.matched.views]},
    }


def as_json(command: str, status: int, record: Mapping[str, Any]) -> bytes:
    """The content of --json."""
    text = json.dumps({"command": command, "status": status, "trace": record}, indent=1, ensure_ascii=False)
    return (text + "\n").encode("utf-8")
