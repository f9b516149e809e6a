"""What spec/<document>/contracts.toml says of a device, as it is in the header of its vector files.

    [contract.lamp]                     by device
    constants = { CODE = 0x0FF0 }       tables = ["RE"] takes a table of words from sequences.toml

    [contract.lamp.rules]               a value, { recent = .. }, or { memory = .., starts = .. }
    codes = { recent = "word == CODE" }

    [contract.lamp.property.LightNeedsCode]     by the id of properties.toml, which gives the clauses
    says = "The lamp goes on only with its code."
    when = "LAMP and not was_LAMP"
    holds = "True in codes"

The notation is that of modeproof.kit.contract. A document without the file has no contracts: then there is no
relation `monitor`, and `settled` watches nothing besides.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.kit.contract import read_contract
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.signals import read_signals
from modeproof.registers.rows import Device, Signal
from modeproof.registers.typed import tables

FILE = "contracts.toml"
_ROW = {"tables", "constants", "rules", "property"}
_PROPERTY = {"says", "when", "holds"}


def _tables(place: Path, document: str, names: list[str], where: str) -> dict[str, list[int]]:
    """Tables of words that sequences.toml has, as numbers. Raises Unjudged for one that it does not have."""
    file = f"spec/{document}/sequences.toml"
    known = _toml(place / file, file).get("tables", {}) if names else {}
    for name in names:
        if name not in known:
            raise Unjudged(f"{where}: {file} has no table {name!r}; {suggestion(name, known)}")
    return {name: [int(word, 16) for word in known[name]] for name in names}


def load_contract(place: Path, document: str, device: Device, modes: list[int]) -> dict[str, Any] | None:
    """The contract of a device for a header, or None where none is declared.

    Raises Unjudged with file and row for a key or a property that does not exist, and for an expression that
    cannot be evaluated.
    """
    path = place / "spec" / document / FILE
    if not path.is_file():
        return None
    where = f"spec/{document}/{FILE}"
    row = _toml(path, where).get("contract", {}).get(device.id)
    if row is None:
        return None
    where = f"{where}: {device.id}"
    _only(row, _ROW, where)
    clauses = _clauses(place, document)
    rules = [_rule(name, rule, where) for name, rule in row.get("rules", {}).items()]
    properties = []
    for id, entry in row.get("property", {}).items():
        _only(entry, _PROPERTY, f"{where}: property {id!r}")
        if id not in clauses:
            raise Unjudged(f"{where}: property {id!r} is not in properties.toml")
        properties.append({"id": id, **entry, "clauses": clauses[id]})
    constants = {**_tables(place, document, row.get("tables", []), where), **row.get("constants", {})}
    table = {"constants": constants, "rules": rules, "properties": properties}
    try:
        inputs, outputs = (
            read_signals(declare(signals, modes), where) for signals in (device.inputs, device.outputs)
        )
        read_contract(table, inputs, outputs, declare_parameters(device, modes), where)
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


def declare(signals: Mapping[str, Signal], modes: list[int]) -> dict[str, dict[str, Any]]:
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


def declare_parameters(device: Device, modes: list[int]) -> dict[str, dict[str, Any]]:
    """Types and default values (on the wire) of the parameters that a run can give."""
    chosen = {name: of for name, of in device.parameters.items() if of.type != "function"}
    return {name: {**row, "default": chosen[name].default} for name, row in declare(chosen, modes).items()}


def _clauses(place: Path, document: str) -> dict[str, list[str]]:
    where = f"spec/{document}/properties.toml"
    data = _toml(place / where, where)
    rows = tables(where, data, "property") if "property" in data else {}
    return {id: list(row.get("clauses", [])) for id, row in rows.items()}


def _toml(path: Path, where: str) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise Unjudged(f"{where}: {error}") from None


def _only(row: Mapping[str, Any], allowed: set[str], where: str) -> None:
    unknown = set(row) - allowed
    if unknown:
        raise Unjudged(f"{where}: unknown key {', '.join(sorted(unknown))}")
