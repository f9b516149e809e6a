"""Reads the registers of a document into typed rows."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.places import documents
from modeproof.registers.files import read_toml
from modeproof.registers.rows import (
    About,
    Assumption,
    Clause,
    Device,
    Document,
    Fall,
    Fault,
    Finding,
    Interface,
    Matrix,
    Property,
    Signal,
)
from modeproof.registers.runs import load_runs
from modeproof.registers.schema import check_schema

Table = Mapping[str, Any]


def load_document(root: Path, name: str) -> Document:
    """All seven registers of one document.

    Raises Unjudged with one line (file, row, what is wrong, what is allowed): a file that is missing, cannot
    be read or is not TOML, a key or value that the schema does not allow, an id declared twice, a document
    that does not exist. Contradictions between registers are found by `cross_check`.
    """
    if not (root / "spec" / name).is_dir():
        raise Unjudged(f"spec/{name}: no such document; {suggestion(name, documents(root))}")
    faults = _faults(root, name)
    return Document(
        root=root,
        name=name,
        about=_about(read_register(root, name, "document")),
        clauses=tuple(_clause(row) for row in read_register(root, name, "clauses")["clause"]),
        interface=load_interface(root, name),
        properties=tuple(_property(row) for row in read_register(root, name, "properties")["property"]),
        findings=tuple(_finding(row) for row in read_register(root, name, "findings")["finding"]),
        assumptions=tuple(_assumption(row) for row in read_register(root, name, "assumptions")["assumption"]),
        runs=load_runs(root, name),
        faults=tuple(_fault(row) for row in faults.get("fault", [])),
        matrix=Matrix(**faults["matrix"]) if "matrix" in faults else None,
    )


def _faults(root: Path, name: str) -> dict[str, Any]:
    """The register of faults, empty where the document has none."""
    if not (root / "spec" / name / "faults.toml").exists():
        return {}
    return read_register(root, name, "faults")


def load_interface(root: Path, name: str) -> Interface:
    """The names that a document declares; needs no other register. Raises Unjudged like `load_document`."""
    table = read_register(root, name, "interface")
    devices = {key: _device(key, row) for key, row in table["devices"].items()}
    constants = {key: tuple(values) for key, values in table.get("constants", {}).items()}
    return Interface(table["document"], constants, devices)


def read_register(root: Path, name: str, register: str) -> dict[str, Any]:
    """One register as plain tables, judged by its schema. Raises Unjudged like `load_document`."""
    source = f"spec/{name}/{register}.toml"
    data = read_toml(root, root / "spec" / name / f"{register}.toml")
    check_schema(register, source, data)
    if data.get("document", name) != name:
        raise Unjudged(f"{source}: document: {data['document']!r} is not the name of its folder, {name!r}")
    for key, rows in data.items():
        if isinstance(rows, list) and rows and isinstance(rows[0], dict) and "id" in rows[0]:
            _refuse_twice(source, key, [row["id"] for row in rows])
    return data


def _refuse_twice(source: str, key: str, ids: list[str]) -> None:
    for n, row_id in enumerate(ids):
        if row_id in ids[:n]:
            first = ids.index(row_id) + 1
            raise Unjudged(f"{source}: [[{key}]] {row_id}: declared twice (rows {first} and {n + 1})")


def _names(row: Table, key: str) -> tuple[str, ...]:
    """A list of texts. A single text counts as a list with one entry, an empty text as an empty list."""
    value = row.get(key, [])
    if isinstance(value, str):
        return (value,) if value else ()
    return tuple(value)


def _about(row: Table) -> About:
    plain = {key: row[key] for key in ("title", "number", "edition", "publisher", "prefix", "seed", "sha256")}
    return About(
        **plain,
        available=_names(row, "available"),
        not_available=_names(row, "not_available"),
        not_endorsed=row["not_endorsed"],
        sources=_names(row, "sources"),
    )


def _clause(row: Table) -> Clause:
    return Clause(
        id=row["id"],
        title=row["title"],
        text=row["text"],
        kind=row["kind"],
        device=_names(row, "device"),
        because=row.get("because", ""),
        pages=row.get("pages", ""),
        figure=row.get("figure", ""),
    )


def _signal(name: str, row: Table) -> Signal:
    return Signal(
        name=name,
        type=row["type"],
        clauses=_names(row, "clauses"),
        why=row["why"],
        python=row.get("python", name),
        tla=row.get("tla", name),
        tag=row.get("tag", ""),
        minimum=row.get("min"),
        maximum=row.get("max"),
        values=_names(row, "values"),
        default=row.get("default"),
        required=row.get("required", False),
        project=row.get("project", False),
    )


def _device(name: str, row: Table) -> Device:
    return Device(
        id=name,
        title=row["title"],
        module=row["module"],
        published=row["published"],
        states=_names(row, "states"),
        steps=_names(row, "steps"),
        memory=_signals(row["memory"]),
        inputs=_signals(row["inputs"]),
        outputs=_signals(row["outputs"]),
        parameters=_signals(row["parameters"]),
    )


def _signals(table: Table) -> dict[str, Signal]:
    return {name: _signal(name, row) for name, row in table.items()}


def _property(row: Table) -> Property:
    return Property(
        id=row["id"],
        title=row["title"],
        sentence=row["sentence"],
        hazard=row["hazard"],
        clauses=_names(row, "clauses"),
        tla=row["tla"],
        module=row["module"],
        kind=row["kind"],
        environments=_names(row, "environments"),
        antecedent=row["antecedent"],
        findings=_names(row, "findings"),
        reason=row.get("reason", ""),
    )


def _finding(row: Table) -> Finding:
    return Finding(
        id=row["id"],
        title=row["title"],
        clauses=_names(row, "clauses"),
        says=row["says"],
        readings=_names(row, "readings"),
        consequence=row["consequence"],
        decision=row["decision"],
        severity=row["class"],
        drawing_could_settle=row["drawing_could_settle"],
        tries=_names(row, "tries"),
        parameter=row.get("parameter", ""),
        evidence=_names(row, "evidence"),
        evidence_open=row.get("evidence_open", ""),
    )


def _assumption(row: Table) -> Assumption:
    return Assumption(
        id=row["id"],
        title=row["title"],
        text=row["text"],
        kind=row["kind"],
        clauses=_names(row, "clauses"),
        who=row["who"],
        check=row["check"],
        breaks=_names(row, "breaks"),
        breaks_open=row.get("breaks_open", ""),
    )


def _fault(row: Table) -> Fault:
    return Fault(
        id=row["id"],
        kind=row["class"],
        title=row["title"],
        model=row["model"],
        detected_by=_names(row, "detected_by"),
        not_detected=row["not_detected"],
        holds=_names(row, "holds"),
        runs=_names(row, "runs"),
        falls=tuple(Fall(**fall) for fall in row.get("falls", [])),
        not_modelled=row.get("not_modelled", ""),
    )
