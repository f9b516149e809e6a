"""What spec/<document>/demands.toml says of a device, as the kit reads it.

    [device.lamp]                       by device
    constant = { press = ["TOY-2"] }    inputs that the document calls constant, with the clauses that do
    unproved = { ID = "why" }           these are not proved of the reference in a lane
    constants = { CODE = 0x0FF0 }       tables = ["RE"] takes a table of words from sequences.toml

    [device.lamp.rules]                 a value, { recent = .. }, or { memory = .., starts = .. }
    codes = { recent = "word == CODE" }

    [device.lamp.demand.LightNeedsCode]
    says = "The lamp goes on only with its code."
    clauses = ["TOY-1"]
    when = "LAMP and not was_LAMP"
    holds = "True in codes"             or comes = ".."

The notation is that of modeproof.kit.demands. A document without the file demands nothing: then there is no
relation `monitor`, and no program can be said to follow it.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.kit.demands import read_demands
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.signals import read_signals
from modeproof.registers.load import load_interface
from modeproof.registers.rows import Device, Signal

FILE = "demands.toml"
_ROW = {"tables", "constants", "constant", "unproved", "rules", "demand"}
_DEMAND = {"says", "clauses", "kind", "when", "holds", "comes"}


def _tables(place: Path, document: str, names: list[str], where: str) -> dict[str, list[int]]:
    """Tables of words that sequences.toml has, as numbers. Raises Unjudged for one that it does not have."""
    file = f"spec/{document}/sequences.toml"
    known = _toml(place / file, file).get("tables", {}) if names else {}
    for name in names:
        if name not in known:
            raise Unjudged(f"{where}: {file} has no table {name!r}; {suggestion(name, known)}")
    return {name: [int(word, 16) for word in known[name]] for name in names}


def load_demands(place: Path, document: str, device: Device) -> dict[str, Any] | None:
    """The demands on a device, or None where none are declared.

    Raises Unjudged with file and row for a key that does not exist, for an expression that cannot be
    evaluated, and for a name that no page prints: an output or a parameter that is ours.
    """
    path = place / "spec" / document / FILE
    if not path.is_file():
        return None
    where = f"spec/{document}/{FILE}"
    row = _toml(path, where).get("device", {}).get(device.id)
    if row is None:
        return None
    where = f"{where}: {device.id}"
    _only(row, _ROW, where)
    modes = load_interface(place, document).constants.get("MODES", ())
    rules = [_rule(name, rule, where) for name, rule in row.get("rules", {}).items()]
    demands = []
    for id, entry in row.get("demand", {}).items():
        _only(entry, _DEMAND, f"{where}: demand {id!r}")
        demands.append({"id": id, **{key: value for key, value in entry.items() if key != "kind"}})
    constants = {**_tables(place, document, row.get("tables", []), where), **row.get("constants", {})}
    table = {"constants": constants, "rules": rules, "demands": demands}
    if steady := row.get("constant", {}):
        table["constant"] = steady
    try:
        inputs, outputs = (
            read_signals(declare(signals, modes), where) for signals in (device.inputs, device.outputs)
        )
        printed = {name: signal for name, signal in outputs.items() if not signal.project}
        ours = {name for name, of in device.parameters.items() if of.project or of.cautious is not None}
        given = {name: row for name, row in declare_parameters(device, modes).items() if name not in ours}
        read_demands(table, inputs, printed, given, where)
    except KitUnjudged as error:
        raise Unjudged(str(error)) from None
    return table


def _rule(name: str, rule: Any, where: str) -> dict[str, Any]:
    """A rule as the header has it."""
    if isinstance(rule, str):
        return {"kind": "value", "name": name, "is": rule}
    kind = next((kind for kind in ("recent", "memory") if kind in rule), None)
    if kind is None:
        raise Unjudged(f"{where}: rule {name!r} is a text, or a table with recent, or with memory and starts")
    _only(rule, {kind, *(("starts",) if kind == "memory" else ())}, f"{where}: rule {name!r}")
    return {
        "kind": kind,
        "name": name,
        **{key: rule[key] for key in ("starts",) if key in rule},
        "is": rule[kind],
    }


def declare(signals: Mapping[str, Signal], modes: Sequence[Any]) -> dict[str, dict[str, Any]]:
    """Signals as a header declares them."""
    table = {}
    for name, signal in signals.items():
        row: dict[str, Any] = {"type": signal.type}
        if signal.minimum is not None:
            row["min"] = signal.minimum
        if signal.maximum is not None:
            row["max"] = signal.maximum
        if signal.values:
            row["values"] = list(signal.values)
        if signal.type in ("mode", "modes"):
            row["modes"] = list(modes)
        if signal.project:
            row["project"] = True
        table[name] = row
    return table


def declare_parameters(device: Device, modes: Sequence[Any]) -> dict[str, dict[str, Any]]:
    """Types and default values (on the wire) of the parameters that a run can give."""
    chosen = {name: of for name, of in device.parameters.items() if of.type != "function"}
    return {name: {**row, "default": chosen[name].default} for name, row in declare(chosen, modes).items()}


def _toml(path: Path, where: str) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise Unjudged(f"{where}: {error}") from None


def _only(row: Mapping[str, Any], allowed: set[str], where: str) -> None:
    unknown = set(row) - allowed
    if unknown:
        raise Unjudged(f"{where}: unknown key {', '.join(sorted(unknown))}")
