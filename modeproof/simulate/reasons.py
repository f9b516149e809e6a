"""Why a device refuses and how to get out: scenes/<document>/reasons.toml, checked against the registers."""

from __future__ import annotations

import string
import tomllib
from collections.abc import Collection, Mapping
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.rows import Device, Document
from modeproof.simulate.program.reasons import ANYWHERE

KEYS = {"why": {"device", "step", "from", "by", "say"}, "stands": {"device", "state", "by", "say"}}


def of_document(document: Document, steps: Mapping[str, Mapping[str, Collection[str]]]) -> dict[str, Any]:
    """For each device its sentences by step and state of origin (`why`) and by state (`stands`).

    `steps` are the ids that each step of a device cites in the specification. Raises Unjudged where a row
    names what is not there, has no sentence, or stands twice.
    """
    path = document.root / "scenes" / document.name / "reasons.toml"
    if not path.is_file():
        return {}
    rows = tomllib.loads(path.read_text(encoding="utf-8"))
    found: dict[str, Any] = {}
    for kind in ("why", "stands"):
        for row in rows.get(kind, ()):
            head = f"{path}: {kind} {row.get('step') or row.get('state')}"
            device = _device(document, head, row, KEYS[kind])
            told = found.setdefault(device.id, {"why": {}, "stands": {}})
            _placeholders(head, row["say"], device)
            cited = steps[device.id].get(row["step"]) if kind == "why" else _ids(document)
            if cited is None:
                raise Unjudged(f"{head}: {device.id} has no such step")
            if strange := [id for id in row["by"] if id not in cited]:
                raise Unjudged(f"{head}: by {strange[0]}, which the specification does not cite there")
            states = row.get("from", [ANYWHERE]) if kind == "why" else row["state"]
            place = told["why"].setdefault(row["step"], {}) if kind == "why" else told["stands"]
            for state in states:
                if state not in (*device.states, *([ANYWHERE] if kind == "why" else [])):
                    raise Unjudged(f"{head}: {device.id} has no state {state}")
                if state in place:
                    raise Unjudged(f"{head}: {state} has two sentences")
                place[state] = {"say": row["say"], "by": row["by"]}
    return found


def cited(reasons: Mapping[str, Any]) -> set[str]:
    """The ids that the sentences name."""
    rows = [row for told in reasons.values() for of in told["why"].values() for row in of.values()]
    rows += [row for told in reasons.values() for row in told["stands"].values()]
    return {id for row in rows for id in row["by"]}


def _device(document: Document, head: str, row: Mapping[str, Any], keys: Collection[str]) -> Device:
    missing = [key for key in sorted(keys) if key != "from" and not row.get(key)]
    if missing or not set(row) <= set(keys):
        what = f"{missing[0]} is missing" if missing else f"{min(set(row) - set(keys))} is not known"
        raise Unjudged(f"{head}: {what}")
    device = document.interface.devices.get(row["device"])
    if device is None:
        raise Unjudged(f"{head}: there is no device {row['device']}")
    return device


def _ids(document: Document) -> set[str]:
    return {clause.id for clause in document.clauses} | {finding.id for finding in document.findings}


def _placeholders(head: str, text: str, device: Device) -> None:
    for _, name, _, _ in string.Formatter().parse(text):
        if name is not None and name not in device.parameters:
            raise Unjudged(f"{head}: {device.id} has no parameter {name}")
