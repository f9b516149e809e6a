"""Judges each piece of evidence again, from its own figures: who edits a verdict must edit all of them.

The judges are those that judged the run: of TLC's output, of a theorem's queries, of two graphs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from modeproof.graph.equal import Comparison
from modeproof.ground.errors import Unjudged
from modeproof.registers.rows import Document
from modeproof.report.demanded import KIND, doubt_on_demands
from modeproof.report.verdicts import verdict_on_machine
from modeproof.tlc.run_judge_again import doubt
from proofs.verdict import judge

Record = Mapping[str, Any]


def contradiction(place: Path, document: Document, record: Record) -> str:
    """What a piece of evidence that is as expected says otherwise than its own figures do; empty: nothing."""
    if not record["as_expected"]:
        return ""
    expected = _EXPECTED.get(record["kind"], ())
    if expected and (record["expected"] not in expected or record["verdict"] != record["expected"]):
        return f"{record['verdict']} is as expected, it says, and it should be {' or '.join(expected)}"
    judge = _JUDGES.get(record["kind"])
    try:
        return judge(place, document, record) if judge is not None else ""
    except Unjudged as error:
        return error.message
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        return f"its figures cannot be judged ({type(error).__name__}: {error})"


def doubt_on_machine(record: Record) -> str:
    """The same of evidence on a machine."""
    if not record["as_expected"]:
        return ""
    try:
        verdict, reason = verdict_on_machine(record["result"])
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        return f"its figures cannot be judged ({type(error).__name__}: {error})"
    return "" if record["verdict"] == verdict == "PROVED" else f"its verdicts give {verdict}: {reason}"


def agreement_problems(rows: Sequence[Record]) -> list[str]:
    """Where the theorem on a property is not proved although the runs hold, or the other way about."""
    return [
        f"{row['id']} ({row['environment']}): {row['tlc']}, and {row['theorem']}: {row['proved']}"
        for row in rows
        if row["theorem"] and (row["tlc"], row["proved"]) != ("HOLDS", "PROVED")
    ]


def _tlc(place: Path, document: Document, record: Record) -> str:
    run = next((run for run in document.runs if run.id == record["id"]), None)
    return doubt(place, run, record) if run is not None else ""  # what no register declares is said elsewhere


def _proof(place: Path, document: Document, record: Record) -> str:
    queries = [SimpleNamespace(**query) for query in record["result"]["queries"]]
    verdict, reason = judge(queries)
    return "" if verdict == record["verdict"] else f"its queries give {verdict}, {reason}"


def _conformance(place: Path, document: Document, record: Record) -> str:
    result = record["result"]
    if record["verdict"] == "EQUAL":
        found = Comparison(**{one.name: result[one.name] for one in fields(Comparison) if one.name in result})
        pinned = next((run.graph for run in document.runs if f"{document.name}/{run.id}" == found.run), None)
        counts = (found.states, found.transitions)
        if pinned is not None and any(
            pin not in (None, count) for pin, count in zip((pinned.states, pinned.edges), counts, strict=True)
        ):
            return (
                f"it compared {found.states:,} states and {found.transitions:,} transitions, not those pinned"
            )
        return "" if found.equal else f"its figures give {found.summary()}"
    whole = 0 < result["cases"] == result["cases_total"] and result["scans"] > 0
    if whole and result["verdict"] == "CONFORMS" and result["difference"] is None:
        return ""
    return f"its figures give {result['verdict']}: {result['cases']} of {result['cases_total']} cases"


def _agreement(place: Path, document: Document, record: Record) -> str:
    rows = record["result"]["rows"]
    found = [*agreement_problems(rows), *record["result"]["problems"]]
    return "; ".join(found[:1]) if rows else "no property was compared"


def _problems(root: Path, document: Document, record: Record) -> str:
    result = record["result"]
    devices = result.get("devices", {})
    places = (place for one in devices.values() for place in (*one["unexplained"], *one["idle"]))
    if found := [*result["problems"], *places]:
        return f"it lists what is wrong: {found[0]}"
    return "" if devices or result.get("clauses") else "nothing was judged"


def _trace(place: Path, document: Document, record: Record) -> str:
    accepted, lines = record["result"]["accepted"], record["result"]["log"]["lines"]
    return "" if accepted == lines > 0 else f"{accepted} of {lines} lines were accepted"


def _demands(place: Path, document: Document, record: Record) -> str:
    return doubt_on_demands(place, document.name, record["result"])


_EXPECTED = {
    "proof": ("PROVED",),
    "conformance": ("EQUAL", "CONFORMS"),
    "agreement": ("EQUAL",),
    "registers": ("EQUAL",),
    "coverage": ("EQUAL",),
    "trace": ("CONFORMS",),
    "strength": ("KILLED",),
    KIND: ("PROVED",),
}
_JUDGES: dict[str, Callable[[Path, Document, Record], str]] = {
    "tlc": _tlc,
    "proof": _proof,
    "conformance": _conformance,
    "agreement": _agreement,
    "registers": _problems,
    "coverage": _problems,
    "trace": _trace,
    KIND: _demands,
}
