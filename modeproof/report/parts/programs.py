"""Verdicts on programs of users, which `prove-program` left in build/programs, judged again."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from typing import Any

from modeproof.ground.places import build
from modeproof.report.part import Part
from modeproof.report.sources import DIFFERS, NOTE, Sources, Trouble

REMEDY = "modeproof prove-program FILE --target T"


def part(sources: Sources) -> Part:
    """One row for the last run on each program; a record that contradicts itself is a trouble."""
    rows, troubles = [], []
    folder = build(sources.root) / "programs"
    for path in sorted(folder.glob("*.json")) if folder.is_dir() else ():
        place = str(path.relative_to(sources.root))
        try:
            record = json.loads(sources.content(place) or b"")
            doubt = contradiction(record)
            rows.append(_row(place, record, doubt))
            changed = list(_changed(sources, record))
        except (LookupError, TypeError, ValueError, AttributeError) as error:
            doubt, changed = f"its figures cannot be judged ({type(error).__name__}: {error})", []
        if doubt:
            troubles.append(Trouble(DIFFERS, "programs", f"{place}: {doubt}", REMEDY))
        if changed:
            what = f"{place}: the program has changed since or is not there"
            troubles.append(Trouble(NOTE, "programs", what, REMEDY, tuple(changed)))
    return Part("programs", "Programs of users", {"rows": rows}, tuple(troubles))


def contradiction(record: Mapping[str, Any]) -> str:
    """What a record says otherwise than its own figures do; empty: nothing."""
    word, difference = record["verdict"], record.get("difference")
    if record["status"] != {"PROVED": 0, "REFUTED": 1, "UNKNOWN": 2}[word]:
        return f"{word} with status {record['status']}"
    if not record["compared"]:
        return f"{word}, and no output was compared"
    if word == "REFUTED":
        return _no_difference(difference)
    if difference is not None:
        return f"{word}, and it holds a difference"
    if word == "PROVED" and (record["missing"] or min(record["pairs"], record["queries"]) < 1):
        missing = record["missing"] or f"{record['pairs']} pairs and {record['queries']} questions"
        return f"PROVED, and its figures say: {missing}"
    return "" if word == "PROVED" or record["missing"] else "UNKNOWN, and nothing is missing"


def _no_difference(difference: Mapping[str, Any] | None) -> str:
    if difference is None or not difference["scans"]:
        return "REFUTED without scans"
    if difference["stopped"]:
        return ""
    last, own = difference["reference"][-1], difference["program"][-1]
    differing = [name for name, value in own.items() if value != last[name]]
    if not differing or differing != difference["differing"]:
        return f"REFUTED, and in its last scan these outputs differ: {', '.join(differing) or 'none'}"
    return ""


def _changed(sources: Sources, record: Mapping[str, Any]) -> Iterator[str]:
    for name, digest in record["sources"].items():
        try:
            content = (sources.root / name).read_bytes()
        except OSError:
            yield name
            continue
        if hashlib.sha256(content).hexdigest() != digest:
            yield name


def _row(place: str, record: Mapping[str, Any], doubt: str) -> dict[str, Any]:
    scans = len(record["difference"]["scans"]) if record["verdict"] == "REFUTED" and not doubt else 0
    return {
        "unit": record["unit"],
        "sources": list(record["sources"]),
        "target": record["target"],
        "verdict": "UNJUDGED" if doubt else record["verdict"],
        "compared": record["compared"],
        "left_out": record["left_out"],
        "pairs": record["pairs"],
        "scans": scans,
        "missing": record["missing"],
        "record": place,
    }
