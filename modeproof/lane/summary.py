"""The one screen at the end of `modeproof verify`, from evidence and the register of properties alone."""

from __future__ import annotations

import shutil
from collections.abc import Sequence

from modeproof.lane.agreement import line as agreement_line
from modeproof.report.demanded import KIND
from modeproof.report.verdicts import ASIDE, Line, Record

GROUPS = (
    ("NEG", "negatives", "VIOLATED, as expected, by the named property"),
    ("WIT", "witnesses", "REACHED"),
    ("OPEN", "graphs", "complete"),
)
"""Kinds of runs that have one line together."""


def _cell(value: float | int | None, form: str) -> str:
    return "" if value is None else format(value, form)


def _fit(text: str, width: int) -> str:
    return text if len(text) <= width else text[: width - 2] + ".."


def table(lines: Sequence[Line], width: int) -> list[str]:
    """The property lines as a table that is at most `width` columns wide."""
    if not lines:
        return []
    names = max(len("property"), *(len(line.property) for line in lines))
    words = max(len("verdict"), *(len(line.verdict) for line in lines))
    places = max(len("environment"), *(len(line.environment) for line in lines))
    strength = max(12, width - names - words - places - 11 - 8 - 5)

    def row(name: str, word: str, place: str, how: str, distinct: str, seconds: str) -> str:
        cells = f"{name:<{names}} {word:<{words}} {place:<{places}} {_fit(how, strength):<{strength}}"
        return f"{cells} {distinct:>11} {seconds:>8}"

    rows = [row("property", "verdict", "environment", "strength", "distinct", "seconds")]
    for line in lines:
        counts = _cell(line.distinct, ",d"), _cell(line.seconds, ".1f")
        rows.append(row(line.property, line.verdict, line.environment, line.strength, *counts))
    return rows


def counted(label: str, records: Sequence[Record], words: str) -> str:
    """One line for a group of runs: how many of how many are as expected, and the first ones that are not."""
    good = sum(1 for r in records if r["as_expected"])
    seconds = sum(float(r["seconds"]) for r in records)
    line = f"{label:<12} {good} of {len(records)} {words}, {seconds:.1f} s"
    bad = [str(r["id"]) for r in records if not r["as_expected"]]
    return line + (f"; NOT: {', '.join(bad[:4])}{' ..' if len(bad) > 4 else ''}" if bad else "")


def render(document: str, lines: Sequence[Line], records: Sequence[Record], width: int | None = None) -> str:
    """The summary of one document."""
    columns = width if width is not None else min(160, shutil.get_terminal_size((120, 40)).columns)
    aside = [line for line in lines if line.verdict == ASIDE]
    out = [f"== {document}", *table([line for line in lines if line.verdict != ASIDE], columns)]
    if aside:
        names = ", ".join(f"{line.property} ({line.environment})" for line in aside)
        checked = f"{len(lines) - len(aside)} of {len(lines)} properties checked"
        out.append(_fit(f"{checked}, by environment; {ASIDE}: {names}", columns))
    tlc = [r for r in records if r["kind"] == "tlc"]
    for kind, label, words in GROUPS:
        group = [r for r in tlc if r["result"].get("run") == kind]
        if group:
            out.append(counted(label, group, words))
    out += [
        f"{'conformance':<12} {r['id']}: {r['verdict']}; {r['strength']}; {r['seconds']:.1f} s"
        for r in records
        if r["kind"] == "conformance"
    ]
    if notes := {r["result"]["jar_note"] for r in tlc if "jar_note" in r["result"]}:
        out.append(f"{'note':<12} {'; '.join(sorted(notes))}")
    proofs = [r for r in records if r["kind"] == "proof"]
    if proofs:
        out.append(counted("proofs", proofs, "PROVED by Z3, re-checked by cvc5"))
    if demands := [r for r in records if r["kind"] == KIND]:
        out.append(counted(KIND, demands, "PROVED of refimpl by Z3, re-checked by cvc5"))
    agreement = [r for r in records if r["kind"] == "agreement"]
    if agreement:
        out.append(agreement_line(agreement))
    registers = [r for r in records if r["kind"] == "registers"]
    if registers:
        out.append(counted("registers", registers, "consistent"))
    return "\n".join(out)


def total(count: int, lines: Sequence[Line], records: Sequence[Record], seconds: float) -> str:
    """All documents together, in the words of their screens; `seconds` by the clock."""
    shown = [line for line in lines if line.verdict != ASIDE]
    good = sum(1 for line in shown if not line.status)
    asked = f"{len(shown)} of {len(lines)} checked in this lane, " if len(shown) < len(lines) else ""
    tlc = [record for record in records if record["kind"] == "tlc"]
    out = [f"== {count} documents", f"{'properties':<12} {asked}{good} of {len(shown)} hold, by environment"]
    groups = [
        (label, [record for record in tlc if record["result"].get("run") == kind], words)
        for kind, label, words in GROUPS
    ]
    groups += [
        (kind + ending, [record for record in records if record["kind"] == kind], words)
        for kind, ending, words in (
            ("conformance", "", "EQUAL or CONFORMS"),
            ("proof", "s", "PROVED by Z3, re-checked by cvc5"),
            (KIND, "", "PROVED of refimpl by Z3, re-checked by cvc5"),
            ("registers", "", "consistent"),
        )
    ]
    out += [counted(label, group, words) for label, group, words in groups if group]
    out.append(f"{'time':<12} {seconds:,.0f} s")
    return "\n".join(out)


def machine_line(record: Record) -> str:
    """A machine of the project's own: it is shown apart, and is counted with no document."""
    rows = record["result"].get("verdicts", [])
    good = sum(row["verdict"] == "PROVED" for row in rows)
    words = f"{good} of {len(rows)} PROVED by Z3, re-checked by cvc5" if rows else record["verdict"]
    falls = len(record["result"].get("killers", []))
    models = record["result"].get("models", [])
    kept = sum(row["as_expected"] for row in models)
    line = f"{'machine':<12} {words}, {record['seconds']:.1f} s; {falls} of {len(rows)} are broken by an edit"
    line += f"; {kept} of {len(models)} runs of TLC as expected" if models else "; no run of TLC"
    return f"{line}; {record['document']} is our own design, no document"


def failures(records: Sequence[Record], lines: Sequence[Line]) -> list[str]:
    """One line for everything that is not as expected, with its reason."""
    found = [
        f"{r['document']}/{r['id']}: {r['verdict']}: {r['reason']}" for r in records if not r["as_expected"]
    ]
    found += [
        f"property {line.property} ({line.environment}): {line.verdict}: {line.strength}"
        for line in lines
        if line.status and line.distinct is None and line.seconds is None
    ]
    return found
