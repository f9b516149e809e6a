"""Makes the page: one HTML file without outer resources, which prints as a dossier."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from importlib import resources
from typing import Any

import jinja2
from markupsafe import Markup

from modeproof.dossier.entries import FAILED, OPEN, ORDER, STALE, STANDS, Entries, Entry, shown_folder
from modeproof.ground.evidence import own_tools
from modeproof.ground.places import documents, project, root
from modeproof.output.diagram import STYLE, drawn, latest
from modeproof.output.outcome import Counterexample, Demand, Problem, Scan
from modeproof.output.words import changed, row, wrong_of
from modeproof.registers.load import load_clauses
from modeproof.report.environment import environment

WORDS = {FAILED: "NOT as expected", STALE: "stale", OPEN: "not judged", STANDS: "stands"}
MOST_COLUMNS = 14
"""Of a diagram here; `--diagram` draws all."""
MOST_SCANS = 10
"""Of a counterexample in the table; the diagram has all."""


def page(entries: Entries, day: str) -> str:
    """The page. day: YYYY-MM-DD, or empty. The same records and files give the same page."""
    found = environment().overlay(
        loader=jinja2.ChoiceLoader(
            [
                jinja2.PackageLoader("modeproof.dossier", "page"),
                jinja2.PackageLoader("modeproof.report", "page"),
            ]
        )
    )
    macros = found.get_template("macros.html.j2").module
    digest = hashlib.sha256(json.dumps(dict(entries.files), sort_keys=True).encode()).hexdigest()
    counts = [(WORDS[state], sum(entry.state == state for entry in entries.rows)) for state in ORDER]
    counts = [("stand" if word == WORDS[STANDS] and count > 1 else word, count) for word, count in counts]
    own = own_tools()
    styles = resources.files("modeproof.report").joinpath("page", "report.css").read_text("utf-8")
    own_styles = resources.files("modeproof.dossier").joinpath("page", "dossier.css").read_text("utf-8")
    return found.get_template("dossier.html.j2").render(
        m=macros,
        title=shown_folder(project()),
        day=day,
        digest=digest,
        entries=[_entry(number, entry) for number, entry in enumerate(entries.rows, 1)],
        counts=[(word, count) for word, count in counts if count],
        status=entries.status,
        troubles=entries.troubles,
        limits=_limits(entries.rows),
        documents=_documents(entries.rows),
        own={"version": own["modeproof"]["version"], "sha256": own["modeproof"]["sha256"]},
        others=_others(entries.rows, own["modeproof"]["sha256"]),
        styles=Markup(styles + own_styles + STYLE),
    )


def _entry(number: int, entry: Entry) -> dict[str, Any]:
    """What the template needs of an entry."""
    found = entry.found
    shown: dict[str, Any] = {
        "anchor": f"entry-{number}",
        "name": entry.name,
        "state": WORDS[entry.state],
        "good": {FAILED: False, STANDS: True}.get(entry.state),
        "stale": list(entry.stale),
        "trouble": entry.trouble,
        "again": entry.again,
        "found": found,
        "problems": [],
    }
    if found is not None:
        shown["verdict"] = None if entry.stale else {0: True, 1: False, 2: None}[found.status]
        shown["sentence"] = found.sentence.removeprefix(f"{found.word}: ")
        shown["demands"] = sorted(found.demands, key=lambda demand: not demand.problems)
        shown["counts"] = _counts(found.demands)
        shown["problems"] = [_problem(demand, problem) for demand, problem in found.problems]
    return shown


def _problem(demand: Demand, problem: Problem) -> dict[str, Any]:
    shown: dict[str, Any] = {"demand": demand, "problem": problem, "diagram": None}
    if (example := problem.counterexample) is not None:
        short = latest(example, MOST_COLUMNS)
        shown |= {
            "diagram": drawn(short, demand.sentence, problem.message),
            "begins": short.first if short is not example else 0,
            "scans": _scans(example),
            "lines": any(scan.spot is not None for scan in example.scans),
            "left_out": max(0, len(example.scans) - MOST_SCANS),
            "set": row(example.parameters),
        }
    return shown


def _counts(demands: Sequence[Any]) -> str:
    words = [demand.word for demand in demands]
    return ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words))


def _scans(example: Counterexample) -> list[dict[str, Any]]:
    rows = []
    before: Scan | None = None
    for number, scan in enumerate(example.scans, example.first):
        last = scan is example.scans[-1]
        outputs = row(changed(before.given if before else {}, scan.given)) or "the same"
        rows.append(
            {
                "number": number,
                "dt_ms": "" if scan.dt_ms is None else scan.dt_ms,
                "inputs": row(changed(before.inputs if before else {}, scan.inputs)) or "the same",
                "outputs": wrong_of(scan, example) if last else outputs,
                "line": scan.spot.line if scan.spot else "",
                "wrong": last,
            }
        )
        before = scan
    return rows[-MOST_SCANS:]


def _limits(rows: Sequence[Entry]) -> list[tuple[str, list[str]]]:
    """What was not shown, with the entries of which that is so."""
    said: dict[str, list[str]] = {}
    for entry in rows:
        if entry.found is not None:
            for text in entry.found.not_shown:
                said.setdefault(text, []).append(entry.name)
    return list(said.items())


def _documents(rows: Sequence[Entry]) -> list[dict[str, str]]:
    """The papers that the verdicts are about, by reference."""
    place = root()
    named = {entry.found.document for entry in rows if entry.found is not None}
    found = []
    for name in documents(place):
        if name in named and (place / "spec" / name / "clauses.toml").is_file():
            about, _ = load_clauses(place, name)
            found.append(
                {
                    "name": name,
                    "title": about.title,
                    "number": about.number,
                    "edition": about.edition,
                    "publisher": about.publisher,
                    "sha256": about.sha256,
                }
            )
    return found


def _others(rows: Sequence[Entry], own: str | None) -> list[str]:
    """The entries that another modeproof judged than the one that makes this page."""
    return [
        entry.name
        for entry in rows
        if entry.found is not None
        and any(tool.name == "modeproof" and tool.sha256 != own for tool in entry.found.tools)
    ]
