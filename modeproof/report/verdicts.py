"""The verdict on each property in each environment, from evidence and the register of properties alone."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

Record = Mapping[str, Any]

ASIDE = "not in this lane"
NOT_AS_DECLARED = "HOLDS?"
"""It held, but the run is not the one that was declared: a count or a name differs."""
POSITIVE = ("MC", "LIVE", "OPEN")
"""Kinds of runs in which every property must hold."""
PROFILE: Final = re.compile(r"profile (\w+); ")
"""How the strength of a run begins where its document has two profiles."""


@dataclass(frozen=True)
class PropertyRow:
    """A property as the register declares it: id, TLA+ name and the environments under which it must hold."""

    id: str
    tla: str
    environments: tuple[str, ...]


@dataclass(frozen=True)
class Line:
    """One property in one environment; `status` 0 as expected, 1 not, 2 not judged.

    `run` is the id of the run that is shown; "" where there is none.
    """

    property: str
    verdict: str
    environment: str
    strength: str
    distinct: int | None
    seconds: float | None
    status: int
    run: str = ""


def status_of(record: Record) -> int:
    """Exit status of one piece of evidence."""
    if record["as_expected"]:
        return 0
    return 2 if record["verdict"] in ("INCONCLUSIVE", "UNJUDGED", "UNMEASURED", "UNKNOWN") else 1


def verdict_on_machine(result: Mapping[str, Any]) -> tuple[str, str]:
    """The verdict on a machine from those on its properties, and why it is not PROVED.

    SURVIVED: all are PROVED, and it is not seen that each can fail.
    """
    words = [row["verdict"] for row in result["verdicts"]]
    bad = [
        f"{row['id']}: {row['verdict']}: {row['how'] or 'no reason is known'}"
        for row in result["verdicts"]
        if row["how"] or row["verdict"] != "PROVED"
    ]
    bad += [f"{row['id']}: it was never reached" for row in result["verdicts"] if _unreached(row)]
    models = [row for row in result.get("models", ()) if not row["as_expected"]]
    bad += [f"run {row['run']}: {row['verdict']}: {row['reason']}" for row in models]
    first = (*bad, *result["problems"], "" if words else "no property was judged")[0:1]
    if "REFUTED" in words:
        return "REFUTED", next(text for text in bad if ": REFUTED: " in text)
    if any(row["judged"] for row in models):
        return "DIFFERS", next(text for text in bad if text.startswith("run "))
    if bad or set(words) != {"PROVED"}:
        return "UNKNOWN" if not models and {*words} <= {
            "PROVED",
            "UNKNOWN",
        } and words else "UNJUDGED", "".join(first)
    return ("SURVIVED", "".join(first)) if result["problems"] else ("PROVED", "")


def _unreached(row: Mapping[str, Any]) -> bool:
    return row["verdict"] == "PROVED" and None in row["reached_in_scans"]


def property_lines(
    properties: Sequence[PropertyRow], records: Sequence[Record], declared: Mapping[str, set[tuple[str, str]]]
) -> list[Line]:
    """A line per property and environment, from the runs that must hold.

    `declared` gives for each run id the pairs (property, environment) that any lane checks: a pair that no
    run of any lane checks is UNJUDGED; one that only another lane checks is shown and not counted. Runs stand
    in the order of runs.toml, the strongest first. A run with a reading says nothing of what was
    decided.
    """
    order = {run: place for place, run in enumerate(declared)}
    anywhere = set().union(*declared.values()) if declared else set()
    checked = [r for r in records if r["kind"] == "tlc" and r["result"].get("run") in POSITIVE]
    positive = [r for r in checked if not r["result"].get("readings")]
    lines = []
    for row in properties:
        for environment in row.environments:
            runs = [
                r
                for r in positive
                if r["environment"] == environment and row.tla in r["result"].get("properties", ())
            ]
            runs.sort(key=lambda r: order.get(r["id"], len(order)))
            lines.append(_line(row, environment, runs, (row.tla, environment) in anywhere))
    return lines


def _line(row: PropertyRow, environment: str, runs: Sequence[Record], elsewhere: bool) -> Line:
    if not runs:
        word, status = (ASIDE, 0) if elsewhere else ("UNJUDGED", 2)
        why = "" if elsewhere else "no run checks it"
        return Line(row.id, word, environment, why, None, None, status)
    # The weakest verdict counts; among equals the run that is declared first is shown.
    worst = max(runs, key=status_of)
    status = status_of(worst)
    verdict = str(worst["verdict"])
    if status and verdict == "VIOLATED" and worst["result"].get("violated") not in (row.tla, ""):
        verdict = (
            "INCONCLUSIVE"  # another property of the same run failed first: nothing is known of this one
        )
    elif status == 1 and verdict == "HOLDS":
        verdict = NOT_AS_DECLARED
    seconds = sum(float(r["seconds"]) for r in runs)
    distinct = worst["result"].get("distinct")
    strength = str(worst["strength"]) + ("" if status else _besides(worst, runs))
    return Line(row.id, verdict, environment, strength, distinct, seconds, status, str(worst["id"]))


def _besides(shown: Record, runs: Sequence[Record]) -> str:
    """The other profiles in which a property holds, after the strength of the run that is shown."""
    found = dict.fromkeys(match[1] for run in runs if (match := PROFILE.match(run["strength"])))
    here = PROFILE.match(shown["strength"])
    others = [name for name in found if name != "neither" and (here is None or name != here[1])]
    return f"; and in the profile {' and '.join(others)}" if others else ""


def never_needed(records: Sequence[Record]) -> list[str]:
    """Premises, by name, that some theorem has and no proof of any theorem needs."""
    names = dict.fromkeys(name for record in records for name in record["result"]["unused"])
    needed = {
        name
        for record in records
        for name in record["result"]["premises"]
        if name not in record["result"]["unused"]
    }
    return [name for name in names if name not in needed]
