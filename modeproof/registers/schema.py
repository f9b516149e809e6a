"""Judges a register by its JSON Schema and says in one line what is wrong, where, and what is allowed."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import resources
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from modeproof.ground.errors import Unjudged, suggestion

REGISTERS = ("document", "clauses", "interface", "properties", "findings", "assumptions")
"""The registers of every document that have a schema, in the order in which a reader meets them."""

OPTIONAL = ("faults",)
"""Registers that a document may have."""

TYPE_WORDS = {
    "string": "a text in quotes",
    "integer": "an integer",
    "number": "a number",
    "boolean": "true or false",
    "array": "a list",
    "object": "a table",
}


@cache
def schema(register: str) -> Mapping[str, Any]:
    """The JSON Schema (draft 2020-12) of one register."""
    source = resources.files("modeproof.registers").joinpath("schemas", f"{register}.schema.json")
    loaded: dict[str, Any] = json.loads(source.read_text(encoding="utf-8"))
    return loaded


def check_schema(register: str, source: str, data: Mapping[str, Any]) -> None:
    """Raise Unjudged with the first fault, and the number of the others. `source` names the file."""
    faults = sorted(Draft202012Validator(schema(register)).iter_errors(data), key=_order)
    if faults:
        first = faults[0]
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        raise Unjudged(f"{source}: {_place(data, list(first.absolute_path))}{_explain(first)}{more}")


def _order(fault: ValidationError) -> tuple[list[tuple[int, int, str]], bool]:
    """By place; an unknown key before the missing one that it was meant to be."""
    path = [(0, part, "") if isinstance(part, int) else (1, 0, str(part)) for part in fault.absolute_path]
    return path, fault.validator != "additionalProperties"


def _place(data: Mapping[str, Any], path: Sequence[str | int]) -> str:
    """Where a fault stands: the row by its id where it has one, then the key."""
    parts = list(path)
    words = ""
    if len(parts) >= 2 and isinstance(parts[1], int):
        key, index = str(parts[0]), parts[1]
        row = data[key][index]
        identity = row.get("id") if isinstance(row, Mapping) else None
        words = f"[[{key}]] {identity if isinstance(identity, str) else f'number {index + 1}'}: "
        parts = parts[2:]
    if not parts:
        return words
    dotted = ""
    for part in parts:
        dotted += f"[{part}]" if isinstance(part, int) else f".{part}"
    return f"{words}{dotted.lstrip('.')}: "


def _explain(fault: ValidationError) -> str:
    rule: Any = fault.validator
    instance: Any = fault.instance
    value: Any = fault.validator_value
    rules: Any = fault.schema
    if rule == "additionalProperties":
        known = list(rules.get("properties", {}))
        extra = next(key for key in instance if key not in known)
        return f"unknown key {extra!r}; {suggestion(extra, known)}"
    if rule == "required":
        missing = [key for key in value if key not in instance]
        return f"key {missing[0]!r} is missing"
    if rule == "enum":
        names = [str(allowed) for allowed in value]
        return f"{instance!r} is not allowed; {suggestion(str(instance), names)}"
    if rule == "type":
        names = [value] if isinstance(value, str) else list(value)
        return f"must be {' or '.join(TYPE_WORDS[name] for name in names)}, not {_short(instance)}"
    if rule == "pattern":
        return f"{_short(instance)} is not {rules.get('description', f'of the form {value}')}"
    if rule in ("minLength", "minItems", "minProperties"):
        return "must not be empty"
    if rule == "uniqueItems":
        twice = next(entry for n, entry in enumerate(instance) if entry in instance[:n])
        return f"holds {twice!r} twice"
    if rule in ("minimum", "exclusiveMinimum"):
        return f"{instance!r} is too small; it must be {'at least' if rule == 'minimum' else 'above'} {value}"
    return str(fault.message)


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
