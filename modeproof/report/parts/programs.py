"""Verdicts on programs of users, which `prove-program` left in build/programs, judged again."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from modeproof.ground.places import build, within
from modeproof.report.part import Part
from modeproof.report.sources import DIFFERS, NOTE, Sources, Trouble

REMEDY = "modeproof prove-program FILE ..."


def part(sources: Sources) -> Part:
    """The last run on each program: its verdicts, and what they rest on.

    A record that contradicts itself is a trouble.
    """
    rows: list[dict[str, Any]] = []
    programs, troubles = [], []
    folder = build(sources.root) / "programs"
    for path in sorted(folder.glob("*.json")) if folder.is_dir() else ():
        place = within(sources.root, path)
        try:
            record = json.loads(sources.content(place) or b"")
            doubt = contradiction(record)
            changed = list(_changed(sources, record))
            since = "; of files that have changed since" if changed else ""
            rows += [row | {"how": row["how"] + since} for row in _rows(record, path.stem, doubt)]
            programs.append(_program(record, path.stem, place, changed))
        except (LookupError, TypeError, ValueError, AttributeError) as error:
            doubt, changed = f"its figures cannot be judged ({type(error).__name__}: {error})", []
        if doubt:
            troubles.append(Trouble(DIFFERS, "programs", f"{place}: {doubt}", REMEDY))
        if changed:
            what = f"{place}: what the verdict rests on has changed since or is not there"
            troubles.append(Trouble(NOTE, "programs", what, REMEDY, tuple(changed)))
    return Part("programs", "Programs of users", {"rows": rows, "programs": programs}, tuple(troubles))


def contradiction(record: Mapping[str, Any]) -> str:
    """What a record says otherwise than its own figures do; empty: nothing."""
    return _of_properties(record) if "verdicts" in record else _of_target(record)


def _of_target(record: Mapping[str, Any]) -> str:
    follows, same, asked = record["follows"], record["same"], record["same_asked"]
    words = [row["verdict"] for row in follows["demands"]]
    if not set(words) <= {"PROVED", "BROKEN", "UNKNOWN"} or not any(
        row["clauses"] for row in follows["demands"]
    ):
        return f"no verdicts on demands: {', '.join(map(str, words)) or 'none'}"
    whole = set(words) == {"PROVED"} and not follows["unjudged"]
    word = "BREAKS" if "BROKEN" in words else "FOLLOWS" if whole else "UNKNOWN"
    if follows["verdict"] != word:
        return f"{follows['verdict']}, and its demands say {word}"
    for row in follows["demands"]:
        if row["verdict"] == "BROKEN" and not row.get("broken", {}).get("scans"):
            return f"{row['id']}: BROKEN without scans"
    word = same["verdict"] if asked and same is not None and word != "BREAKS" else word
    statuses = {"FOLLOWS": 0, "BREAKS": 1, "PROVED": 0, "REFUTED": 1, "UNKNOWN": 2}
    if (record["verdict"], record["status"]) != (word, statuses[word]):
        return f"{record['verdict']} with status {record['status']}, and its figures say {word}"
    return "" if same is None else _of_equality(same)


def _of_equality(record: Mapping[str, Any]) -> str:
    word, difference = record["verdict"], record.get("difference")
    if word not in ("PROVED", "REFUTED", "UNKNOWN"):
        return f"no verdict on equality: {word}"
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


def _of_properties(record: Mapping[str, Any]) -> str:
    words = [row["verdict"] for row in record["verdicts"]]
    if not set(words) <= {"PROVED", "REFUTED", "HOLDS", "EMPTY", "UNKNOWN"} or len(words) < 2:
        return f"no verdicts on properties: {', '.join(map(str, words)) or 'none'}"
    status = 1 if "REFUTED" in words else 0 if set(words) == {"PROVED"} else 2
    if record["status"] != status:
        return f"{', '.join(sorted(set(words)))} with status {record['status']}"
    for row in record["verdicts"]:
        if row["verdict"] == "REFUTED" and not row.get("trace", {}).get("scans"):
            return f"{row['id']}: REFUTED without scans"
        if row["verdict"] == "HOLDS" and not row["bound_in_scans"]:
            return f"{row['id']}: HOLDS without a bound"
    return ""


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
    for name, digest in _files(record).items():
        try:
            content = (sources.root / name).read_bytes()
        except OSError:
            yield name
            continue
        if hashlib.sha256(content).hexdigest() != digest:
            yield name


def _files(record: Mapping[str, Any]) -> dict[str, str]:
    """The SHA-256 of everything that the verdict is about."""
    named = ("binding_file", "properties", "reference")
    return {**record["sources"], **{name: one for key in named for name, one in record.get(key, {}).items()}}


def _rows(record: Mapping[str, Any], key: str, doubt: str) -> Iterator[dict[str, Any]]:
    """The lines of a record in the table of verdicts."""
    common = {"unit": record["unit"], "key": key}
    if "verdicts" in record:
        for row in record["verdicts"]:
            scans = len(row["trace"]["scans"]) if row["verdict"] == "REFUTED" and not doubt else 0
            yield common | {
                "about": f"{row['id']}: {row['sentence']}",
                "verdict": "UNJUDGED" if doubt else row["verdict"],
                "how": f"false after {scans} scans" if scans else row["how"],
            }
        return
    follows = record["follows"]
    rows = [row for row in follows["demands"] if row["clauses"]]
    broken = [row["id"] for row in follows["demands"] if row["verdict"] == "BROKEN"]
    proved = sum(row["verdict"] == "PROVED" for row in rows)
    yield common | {
        "about": f"follows the page of {record['target']}",
        "verdict": "UNJUDGED" if doubt else follows["verdict"],
        "how": f"breaks {', '.join(broken)}"
        if broken
        else f"{proved} of {len(rows) + len(follows['unjudged'])} demands, latency {follows['latency']}",
    }
    if (same := record["same"]) is None:
        return
    scans = len(same["difference"]["scans"]) if same["verdict"] == "REFUTED" and not doubt else 0
    shown = f"{same['pairs']} pairs" if same["verdict"] == "PROVED" else same["missing"]
    yield common | {
        "about": f"equal to {record['target']}: {', '.join(same['compared'])}",
        "verdict": "UNJUDGED" if doubt else same["verdict"],
        "how": f"differs after {scans} scans" if scans else shown,
    }


def _program(record: Mapping[str, Any], key: str, place: str, changed: Sequence[str]) -> dict[str, Any]:
    """What the section on one program shows."""
    files = [
        {"name": name, "sha256": digest, "changed": name in changed}
        for name, digest in _files(record).items()
    ]
    return {
        "key": key,
        "unit": record["unit"],
        "record": place,
        "files": files,
        "trusted": record.get("trusted", []),
        "tools": record.get("tools", {}),
        "not_shown": record.get("not_shown", []),
        "states": record.get("states", []),
    }
