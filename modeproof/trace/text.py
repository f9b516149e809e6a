"""The verdict on a log, to read and as a record."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from modeproof.ground.errors import LONGEST
from modeproof.kit.errors import plain
from modeproof.trace.exact import Scans
from modeproof.trace.follow import Followed, NotFollowed
from modeproof.trace.log import Row
from modeproof.trace.log_judge import Judgement
from modeproof.trace.targets import Target
from modeproof.trace.why import Missed, Taken, Why


def as_text(target: Target, found: Judgement, why: Why | None = None, samples: Scans | None = None) -> str:
    """What to print; the last line is the verdict."""
    log = found.log
    total = len(log.rows)
    unit = "samples" if samples else "scans"
    lines = [f"{log.name}: {found.accepted:,} of {total:,} {unit} of {target.id} fit the specification"]
    lines += [f"  {line}" for line in _observed(target, found)]
    lines.append(f"  by graph: {_followed(found.followed, unit)}")
    lines.append(f"  {f'by {found.by}:':<9} {found.accepted:,} {unit}{_exactness(target, found, samples)}")
    if found.accepted < total:
        row = log.rows[found.accepted]
        lines.append(f"first impossible {unit[:-1]}: {found.accepted + 1:,}, line {row.line} of the log")
        lines += [f"  {line}" for line in _row(target, row)]
        lines += [f"  {line}" for line in ([] if why is None else _why(target, row, why))]
    share = f"; {shared(found, unit)}" if found.status == 0 else ""
    lines.append(f"{found.verdict}({'samples' if samples else 'exact'}, {log.name}{share})")
    return "\n".join(plain(line, LONGEST) for line in lines)


def shared(found: Judgement, unit: str) -> str:
    """Which share of a log was compared."""
    counts = [count for outputs in found.compared.outputs.values() for count in outputs.values()]
    return (
        f"{sum(map(bool, counts))} of {len(counts)} outputs compared, in {found.compared.lines:,} of "
        f"{len(found.log.rows):,} {unit}"
    )


def _observed(target: Target, found: Judgement) -> list[str]:
    lines = []
    for name, outputs in found.compared.outputs.items():
        total = sum(number for row, number in found.log.rows.kinds() if row.device == name)
        if total and not any(outputs.values()) and target.system:
            lines.append(f"UNJUDGED: {name}, for no line shows an output of it")
            continue
        if not total:
            lines.append(f"UNJUDGED: {name}, for it has no line")
            continue
        never = [output for output, count in outputs.items() if not count]
        now_and_then = [f"{output} in {count:,}" for output, count in outputs.items() if 0 < count < total]
        if never:
            lines.append(f"UNJUDGED, for no line shows it: {', '.join(never)}")
        if now_and_then:
            lines.append(f"compared in a part of {total:,} lines of {name}: {', '.join(now_and_then)}")
    for name, part in target.parts.items():
        blind = [signal for signal in part.device.inputs if signal not in found.log.observed(name)]
        if blind:
            lines.append(f"inputs of {name} that were not observed, so may be anything: {', '.join(blind)}")
    if found.log.not_compared:
        names = ", ".join(found.log.not_compared)
        lines.append(
            f"not compared, for the document does not give the values (--codes does so by ours): {names}"
        )
    return lines or ["every signal was observed"]


def _followed(found: Followed | NotFollowed, unit: str) -> str:
    if isinstance(found, NotFollowed):
        return f"not followed; {found.reason}"
    how = f"; left open: {'; '.join(found.open)}" if found.open else ", exactly"
    return f"{found.accepted:,} {unit} through {' '.join(found.runs)}{how}"


def _exactness(target: Target, found: Judgement, samples: Scans | None) -> str:
    if samples:
        return f", with scans of {samples} ms and inputs that change once between two samples"
    if any(None in found.log.rows.times(device) for device in target.parts if target.timed(device)):
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


def _why(target: Target, row: Row, why: Why) -> list[str]:
    lines = []
    if why.before:
        memory = " ".join(f"{name}={value}" for name, value in why.before.items())
        others = f"; {why.states - 1:,} other states are possible" if why.states > 1 else ""
        lines.append(f"before   {memory}{others}")
    if why.wrong_input is not None:
        name, value, writer = why.wrong_input
        shown = shown_value(target, row.device, name, value)
        lines.append(f"the input {name} is not what {writer} last wrote: {shown}")
    elif why.fits_alone:
        lines.append(f"{row.device} alone can take this scan, but not with what the other devices last wrote")
    for taken in why.taken:
        if taken.wrong:
            lines += _taken(target, row, taken)
    for missed in why.missed:
        lines += _missed(missed)
    if why.lost:
        again = "one more scan" if why.lost == 1 else f"{why.lost} more scans"
        lines.append(f"after {again} with these inputs the line would fit: is a line missing before it?")
    return lines


def _taken(target: Target, row: Row, taken: Taken) -> list[str]:
    width = max(len("output"), *(len(name) for name in taken.wrong))
    lines = [f"{'output':<{width}}  expected   logged"]
    for name in taken.wrong:
        expected, logged = (
            shown_value(target, row.device, name, values[name]) for values in (taken.expected, row.outputs)
        )
        lines.append(f"{name:<{width}}  {expected:<9}  {logged}")
    if taken.place is not None:
        lines.append(f"the specification takes {taken.step} ({taken.place}: {', '.join(taken.cites)})")
    lines += [f"  {effect.place}: {effect.text}" for effect in taken.effects]
    lines += [f"  {place}: {text}" for text, place in taken.outputs]
    return lines


def _missed(missed: Missed) -> list[str]:
    one = missed.conjunct
    lines = [
        f"the log looks like {missed.step} ({missed.place}: {', '.join(missed.cites)}); its guard is false:",
        f"  {one.place}: {one.text}{f', in {chain}' if (chain := ' > '.join(one.chain)) else ''}",
    ]
    if one.meaning:
        lines.append(f"  where {one.meaning}")
    pairs = zip(missed.sides[::2], missed.sides[1::2], strict=True)
    lines += [f"  left {left}, right {right}" for left, right in pairs]
    return lines


def shown_value(target: Target, device: str, name: str, value: Any) -> str:
    """A value as on the wire."""
    one = target.parts[device].device
    signal = one.inputs.get(name) or one.outputs[name]
    wire = target.forms.to_wire(signal, value)
    return wire if isinstance(wire, str) else json.dumps(wire, separators=(",", ":"))


def as_record(target: Target, found: Judgement, why: Why | None = None) -> dict[str, Any]:
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
        "compared": {name: dict(outputs) for name, outputs in found.compared.outputs.items()},
        "lines_compared": found.compared.lines,
        "not_compared": list(found.log.not_compared),
        "params": {device: dict(values) for device, values in found.log.params.items()},
        "graph": {"not_followed": one.reason}
        if isinstance(one, NotFollowed)
        else {"accepted": one.accepted, "left_open": list(one.open), "runs": list(one.runs)},
        found.by.lower(): {
            "accepted": found.matched.accepted,
            "states": [dict(view) for view in found.matched.views],
        },
        "why": None if why is None else _why_record(target, found.log.rows[found.accepted], why),
    }


def _why_record(target: Target, row: Row, why: Why) -> dict[str, Any]:
    device = target.parts[row.device].device
    return {
        "device": why.device,
        "states": why.states,
        "before": dict(why.before),
        "wrong_input": None
        if why.wrong_input is None
        else {
            "input": why.wrong_input[0],
            "written": target.forms.to_wire(device.inputs[why.wrong_input[0]], why.wrong_input[1]),
            "by": why.wrong_input[2],
        },
        "taken": [
            {
                "step": action.step,
                "place": str(action.place or ""),
                "cites": list(action.cites),
                "expected": {
                    name: target.forms.to_wire(device.outputs[name], value)
                    for name, value in action.expected.items()
                },
                "wrong": list(action.wrong),
                "effects": [{"place": str(each.place), "text": each.text} for each in action.effects],
                "outputs": [{"place": str(place), "text": text} for text, place in action.outputs],
            }
            for action in why.taken
        ],
        "missed": [
            {
                "step": action.step,
                "place": str(action.place),
                "cites": list(action.cites),
                "conjunct": action.conjunct.text,
                "at": str(action.conjunct.place),
                "in": list(action.conjunct.chain),
                "sides": list(action.sides),
            }
            for action in why.missed
        ],
        "lost_scans": why.lost,
    }


def as_json(command: str, status: int, record: Mapping[str, Any]) -> bytes:
    """The content of --json."""
    text = json.dumps({"command": command, "status": status, "trace": record}, indent=1, ensure_ascii=False)
    return (text + "\n").encode("utf-8")
