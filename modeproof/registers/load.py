"""Reads the registers of a document into typed rows."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.places import documents
from modeproof.registers.demands import as_properties, load_demand_rows
from modeproof.registers.files import read_toml
from modeproof.registers.rows import (
    About,
    Assumption,
    Chain,
    Clause,
    Device,
    Document,
    Example,
    Fault,
    Faults,
    Finding,
    Interface,
    Property,
    Response,
    Responses,
    Signal,
)
from modeproof.registers.runs import load_runs
from modeproof.registers.standing import class_of
from modeproof.registers.typed import DEFAULT, Table, only_keys, tables, typed, typed_rows

Row = TypeVar("Row")
SIGNALS = ("memory", "inputs", "outputs", "parameters")
TIMES = ("response", "chain", "example")
"""What properties.toml has besides properties: how soon a device answers, and chains of that."""


def load_document(root: Path, name: str) -> Document:
    """All registers of one document.

    Raises Unjudged with one line (file, row, what is wrong, what is allowed): a file that is missing, cannot
    be read or is not TOML, a key or value that is not allowed, an id declared twice, a document that does not
    exist. Contradictions between registers are found by `cross_check`.
    """
    if not (root / "spec" / name).is_dir():
        raise Unjudged(f"spec/{name}: no such document; {suggestion(name, documents(root))}")
    about, clauses = load_clauses(root, name)
    assumed = read_register(root, name, "assumptions", "assumption", "fault", "faults")
    at_faults = f"spec/{name}/assumptions.toml"
    faults = typed(Faults, assumed.get("faults", {}), f"{at_faults}: [faults]")
    interface, demands, runs = load_interface(root, name), load_demand_rows(root, name), load_runs(root, name)
    return Document(
        root=root,
        name=name,
        about=about,
        clauses=clauses,
        interface=interface,
        properties=(
            *(
                prop if prop.tla else msgspec.structs.replace(prop, tla=prop.id)
                for prop in _rows(root, name, "properties", "property", Property, *TIMES)
            ),
            *as_properties(root, name, demands, interface),
        ),
        findings=tuple(
            msgspec.structs.replace(row, severity=class_of(row, runs)) for row in load_findings(root, name)
        ),
        assumptions=typed_rows(Assumption, at_faults, assumed, "assumption"),
        runs=runs,
        faults=typed_rows(Fault, at_faults, assumed, "fault") if "fault" in assumed else (),
        faults_summary=faults.summary,
        matrix=faults.matrix,
        responses=load_responses(root, name),
    )


def load_clauses(root: Path, name: str) -> tuple[About, tuple[Clause, ...]]:
    """Which paper it is, and its clauses; needs no other register. Raises Unjudged like `load_document`."""
    source = f"spec/{name}/clauses.toml"
    table = read_register(root, name, "clauses", "paper", "chapter", "clause")
    return typed(About, table.get("paper", {}), f"{source}: [paper]"), tuple(_clauses(source, table))


def load_findings(root: Path, name: str) -> tuple[Finding, ...]:
    """The findings, without their classes; needs no other register. Raises Unjudged like `load_document`."""
    found = _rows(root, name, "findings", "finding", Finding)
    if typed_one := next((row.id for row in found if row.severity), ""):
        raise Unjudged(
            f"spec/{name}/findings.toml: {typed_one}: severity is computed from the runs: remove it"
        )
    return found


def _clauses(source: str, data: Table) -> Iterator[Clause]:
    """The clauses; what those of a chapter have in common is in [chapter.ID], by how their ids begin."""
    chapters = typed(dict[str, dict[str, str]], data.get("chapter", {}), f"{source}: [chapter]")
    for id, row in tables(source, {**data, DEFAULT: {}}, "clause").items():
        own = next((common for begin, common in chapters.items() if id.startswith(f"{begin}-")), {})
        usual = data.get(DEFAULT, {}).get("clause", {})
        yield typed(Clause, {**usual, **own, **row}, f"{source}: [[clause]] {id}")


def load_responses(root: Path, name: str) -> Responses:
    """The response times of a document; empty where it states none. Raises Unjudged like `load_document`."""
    source = f"spec/{name}/properties.toml"
    table = read_register(root, name, "properties", "property", *TIMES)
    if "response" not in table:
        return Responses()
    return Responses(
        source,
        typed_rows(Response, source, table, "response"),
        typed_rows(Chain, source, table, "chain") if "chain" in table else (),
        typed(Example, table.get("example", {}), f"{source}: [example]"),
    )


def read_register(root: Path, name: str, register: str, *keys: str) -> dict[str, Any]:
    """One register as plain tables, without `document`. `keys`: all that it may have; none: not judged here.

    Raises Unjudged: no file, no TOML, another document's name, an unknown key.
    """
    source = f"spec/{name}/{register}.toml"
    data = read_toml(root, root / "spec" / name / f"{register}.toml")
    if not data:
        raise Unjudged(f"{source}: is empty")
    said = data.pop("document", name)
    if said != name:
        raise Unjudged(f"{source}: document: {said!r} is not the name of its folder, {name!r}")
    if keys:
        only_keys(source, data, ("document", *keys))
    return data


def _rows(root: Path, name: str, register: str, key: str, kind: type[Row], *others: str) -> tuple[Row, ...]:
    """The rows of one key; `others` are what the register may have besides."""
    table = read_register(root, name, register, key, *others)
    return typed_rows(kind, f"spec/{name}/{register}.toml", table, key)


def load_interface(root: Path, name: str) -> Interface:
    """The names that a document declares; needs no other register. Raises Unjudged like `load_document`."""
    source = f"spec/{name}/interface.toml"
    table = read_register(root, name, "interface", "constants", "devices", "class")
    devices = table.get("devices")
    if not isinstance(devices, dict) or not devices:
        raise Unjudged(f"{source}: there is no [devices.NAME]")
    constants = typed(dict[str, tuple[int | str, ...]], table.get("constants", {}), f"{source}: constants")
    return Interface(name, constants, {key: _device(source, key, row) for key, row in devices.items()})


def _device(source: str, name: str, row: Table) -> Device:
    place = f"{source}: devices.{name}"
    groups = {
        group: {key: _signal(f"{place}.{group}.{key}", group, key, own) for key, own in row[group].items()}
        for group in SIGNALS
        if isinstance(row.get(group), dict)
    }
    return typed(Device, {"id": name, **row, **groups}, place)


def _signal(place: str, group: str, name: str, row: Any) -> Signal:
    if not isinstance(row, dict):
        raise Unjudged(f"{place}: must be a table, not {row!r}")
    for key in ("default", "required", "cautious", "because"):
        if key in row and group != "parameters":
            raise Unjudged(f"{place}: {key} belongs to parameters")
    return typed(Signal, {"python": name, "tla": name, **row, "name": name}, place)
