"""`modeproof prove --coverage`: what of each step the feasible paths pass through."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import Unjudged, first_of
from modeproof.ground.lock import only_one
from modeproof.ground.options import write_json
from modeproof.ground.solvers import needing_solvers
from modeproof.kit.by_name import module_named
from modeproof.report.verdicts import status_of


def cover_documents(args: argparse.Namespace, place: Path, names: Sequence[str], progress: Any) -> int:
    """Cover the devices of documents, print it, and return the worst status. Raises Unjudged."""
    if args.theorems:
        raise Unjudged("--coverage speaks of devices, not of theorems: give it no name")
    with only_one(place):
        records = [cover_document(place, name, progress) for name in names]
    for record in records:
        print("\n".join(_coverage_lines(record)))
    status = max(status_of(record) for record in records)
    write_json(args, status, coverage=records)
    return status


def cover_document(place: Path, document: str, progress: Any) -> dict[str, Any]:
    """What of each device's step its feasible paths pass through, beside the register of what they do not.

    EQUAL: nothing is passed over that the register does not explain, and it explains nothing else. Writes
    one piece of evidence. Raises Unjudged when the document has no devices or they cannot be explored.
    """
    id = "coverage"
    evidence.discard(place, document, id)
    register = place / "proofs" / document / "strength.toml"
    started = time.time()
    devices: dict[str, Any] = {}
    try:
        with needing_solvers():
            from proofs.explorer import coverage, errors
        known = module_named(f"proofs.{document}.devices").DEVICES
    except ImportError as error:
        raise Unjudged(f"{document}: no devices to explore: {error}") from None
    for device in known:
        progress.say(f"{document}/{device.name}: every path from every control state")
        try:
            found = coverage.explained(device, register)
        except errors.ExplorationError as error:
            raise Unjudged(f"{document}/{device.name}: {' '.join(str(error).split())}") from None
        own = found.coverage
        devices[device.name] = {
            "states": own.states,
            "paths": own.paths,
            "lines": [len(own.passed_lines), len(own.lines)],
            "branches": [len(own.passed_branches), len(own.branches)],
            "answers": [len(own.passed_guards), len(own.guards)],
            "unreachable": [{"what": what, "why": why} for what, why in found.reasons],
            "unexplained": list(found.unexplained),
            "idle": list(found.idle),
        }
    problems = [
        f"{name}: {text}: {what}"
        for name, one in devices.items()
        for text, places in (
            ("on no feasible path, and not explained", one["unexplained"]),
            (f"{register.name} explains what is passed or not there", one["idle"]),
        )
        for what in places
    ]
    paths = [*(place / "proofs" / "explorer").glob("*.py"), register]
    paths += [*(place / "refimpl").glob("*.py"), *(place / "refimpl" / document).glob("*.py")]
    record = evidence.make(
        kind="coverage",
        id=id,
        document=document,
        verdict="DIFFERS" if problems else "EQUAL",
        expected="EQUAL",
        as_expected=not problems,
        strength="a member of every feasible path, run in the plain interpreter",
        command=f"modeproof prove --coverage --document {document}",
        started=started,
        seconds=time.time() - started,
        inputs=evidence.hashes(place, paths),
        tools={"z3": evidence.package("z3-solver")},
        result={"devices": devices, "problems": problems},
        reason=first_of(problems),
    )
    evidence.write(place, record)
    return record


def _coverage_lines(record: dict[str, Any]) -> list[str]:
    """The coverage of a document for people: a table, what cannot be reached, and what is wrong."""
    devices = record["result"]["devices"]
    rows = [("device", "control states", "paths", "lines", "branches", "answers of guards by control state")]
    for name, one in devices.items():
        counts = [f"{one[key][0]} of {one[key][1]}" for key in ("lines", "branches", "answers")]
        rows.append((name, str(one["states"]), f"{one['paths']:,}", *counts))
    widths = [max(len(row[column]) for row in rows) for column in range(6)]
    lines = [f"== {record['document']}"]
    lines += ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    lines.append("unreachable for every memory, input and parameter in range:")
    for name, one in devices.items():
        for why in dict.fromkeys(entry["why"] for entry in one["unreachable"]):
            lines += [f"  {name}  {entry['what']}" for entry in one["unreachable"] if entry["why"] == why]
            lines.append(f"      {why}")
    lines += record["result"]["problems"]
    count = sum(len(device["unreachable"]) for device in devices.values())
    words = "" if record["as_expected"] else f"; NOT: {len(record['result']['problems'])} problems"
    lines.append(
        f"coverage     {record['verdict']}; all but {count} unreachable places lie on a feasible path, "
        f"{record['seconds']:.1f} s{words}"
    )
    return lines
