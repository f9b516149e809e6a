"""A graph as the report reads it: small, in wire form, with the names of what each state remembers.

build/export/<document>/<RUN>.json.gz holds one object; the same graph gives the same bytes:

    format      1
    document, run, device, tick_ms, params, passed   as the run declares them
    memory      [{name, type, ms}]   what a state remembers, in the order of its values
    control     which of them names the state for a reader
    initial     the state after power-up
    states      for each state the values of its memory
    outputs     {names, rows, row_of}: the distinct rows of outputs, and which one a state has
    inputs      {names, values, letters}: each letter gives, for each name, which of its values it takes;
                the last name is dt_ms, the time since the scan before
    columns     for each letter its column: letters that no state tells apart share one
    steps       the names of the actions
    moves       for each state and column: step * number of states + next state
    classes     [{name, fields, members}]: letters with these values stand for so many others
    copied      {fields, words}, or null: in these inputs the two words stand for any words but zero
"""

from __future__ import annotations

import gzip
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modeproof.graph.columns import merge_columns
from modeproof.graph.device import DeviceGraph
from modeproof.graph.values import NONE
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import build
from modeproof.registers.made import read_cfg
from modeproof.registers.rows import Signal
from modeproof.registers.runs import Run
from modeproof.registers.tla import closure, read_modules
from modeproof.tlc.tla_values import parse

FORMAT = 1
_NAME = re.compile(r"[A-Za-z_]\w*")
_TUPLE = re.compile(r"<<((?:\s*[A-Za-z_]\w*\s*,)*\s*[A-Za-z_]\w*\s*)>>")


def export_file(place: Path, document: str, run: str) -> Path:
    """Where the export of a run lies."""
    return build(place) / "export" / document / f"{run}.json.gz"


def write_export(place: Path, run: Run, device: DeviceGraph) -> Path:
    """Write the export of a graph; its path. Raises Unjudged when it cannot be written."""
    if run.graph is None:
        raise Unjudged(f"{run.name} prints no graph")
    content = as_export(device, view_names(place, run), run.graph.tick_ms)
    text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    path = export_file(place, run.document, run.id)
    write_whole(path, gzip.compress(text.encode("utf-8"), 6, mtime=0))
    return path


def view_names(place: Path, run: Run) -> tuple[str, ...]:
    """The variables in the view of a run, in its order; () where its text does not name them one by one."""
    try:
        view = read_cfg(place, run).view
        modules = closure(read_modules(place, run.document), run.module)
    except Unjudged:
        return ()
    bodies = {definition.name: definition.body for module in modules for definition in module.definitions}
    followed: set[str] = set()
    while view in bodies and view not in followed:
        followed.add(view)
        body = bodies[view].partition("==")[2].strip()
        listed = _TUPLE.fullmatch(body)
        if listed is not None:
            return tuple(_NAME.findall(listed.group(1)))
        view = body
    return ()


def as_export(device: DeviceGraph, names: Sequence[str], tick_ms: int) -> dict[str, Any]:
    """The object described at the top; `names` are the variables of the views, as far as they are known."""
    graph = device.graph
    views = [parse(view) for view in graph.views]
    width = len(views[0])
    if any(len(view) != width for view in views):
        raise Unjudged(f"{device.name}: views of different lengths")
    variables = tuple(names) if len(names) == width else tuple(f"part {n + 1}" for n in range(width))
    memory = list(device.device.memory.values())
    signals = {
        spelled: declared
        for declared in memory
        if declared.tla
        for spelled in (declared.tla, f"{device.device.id}{declared.tla[:1].upper()}{declared.tla[1:]}")
    }
    declared = [signals.get(name) for name in variables]
    control = declared.index(memory[0]) if memory and memory[0] in declared else 0
    states = [
        [_remembered(device, signal, value, tick_ms) for signal, value in zip(declared, view, strict=True)]
        for view in views
    ]
    columns = merge_columns(device)
    column_of = [0] * len(device.alphabet)
    for column, letters in enumerate(columns.members):
        for letter in letters:
            column_of[letter] = column
    count = len(states)
    return {
        "format": FORMAT,
        "document": device.document,
        "run": device.run,
        "device": device.device.id,
        "tick_ms": tick_ms,
        "params": dict(device.params),
        "passed": dict(device.passed),
        "memory": [
            {"name": signal.name, "type": signal.type} if signal is not None else {"name": name, "type": ""}
            for name, signal in zip(variables, declared, strict=True)
        ],
        "control": control,
        "initial": graph.initial,
        "states": states,
        "outputs": _outputs(device),
        "inputs": _inputs(device),
        "columns": column_of,
        "steps": list(graph.steps),
        "moves": [
            [step * count + after for step, after in zip(steps, nexts, strict=True)]
            for steps, nexts in zip(columns.step_of, columns.next_of, strict=True)
        ],
        "classes": [
            {
                "name": class_.name,
                "fields": {name: _wire(device, name, value) for name, value in class_.representative.items()},
                "members": len(class_.members),
            }
            for class_ in device.classes
        ],
        "copied": _copied(device),
    }


def _remembered(device: DeviceGraph, signal: Signal | None, value: Any, tick_ms: int) -> Any:
    """One value of a view as JSON: words in hex, times in ms, no mode as null, a set as a sorted list."""
    if isinstance(value, frozenset):
        members = sorted(value)
        if signal is not None and signal.type == "mode" and len(members) < 2:
            return members[0] if members else None
        return members
    if isinstance(value, tuple):
        return [_remembered(device, None, member, tick_ms) for member in value]
    if isinstance(value, dict):
        return {key: _remembered(device, None, one, tick_ms) for key, one in value.items()}
    if signal is None:
        return value
    if signal.type == "ms" and type(value) is int:
        return value * tick_ms
    if type(value) is int and value == NONE and signal.minimum is None:
        return None
    return device.forms.to_wire(signal, value) if signal.type == "word" else value


def _copied(device: DeviceGraph) -> dict[str, Any] | None:
    if device.copied is None:
        return None
    fields = device.copied.fields
    return {"fields": list(fields), "words": [_wire(device, fields[0], word) for word in device.copied.words]}


def _wire(device: DeviceGraph, name: str, value: Any) -> Any:
    return device.forms.to_wire(device.device.inputs[name], value)


def _outputs(device: DeviceGraph) -> dict[str, Any]:
    outputs = device.device.outputs
    names = [name for name in outputs if name not in device.passed]
    rows: dict[str, int] = {}
    row_of = []
    for row in device.rows:
        values = [device.forms.to_wire(outputs[name], row[name]) for name in names]
        row_of.append(rows.setdefault(json.dumps(values), len(rows)))
    return {"names": names, "rows": [json.loads(row) for row in rows], "row_of": row_of}


def _inputs(device: DeviceGraph) -> dict[str, Any]:
    """The alphabet by its factors: a letter is a list of places in the lists of values."""
    letters = [{**device.wire_inputs(values), "dt_ms": values["dt_ms"]} for values in device.alphabet]
    names = list(letters[0])
    places: list[dict[str, int]] = [{} for _ in names]
    rows = [
        [
            known.setdefault(json.dumps(letter[name]), len(known))
            for name, known in zip(names, places, strict=True)
        ]
        for letter in letters
    ]
    return {
        "names": names,
        "values": [[json.loads(value) for value in known] for known in places],
        "letters": rows,
    }
