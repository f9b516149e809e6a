"""What `judge` found, in the forms that others read: JSON, JUnit, SARIF, Markdown."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import msgspec

from modeproof.kit.files import write_json, write_text
from modeproof.output.junit import Case, Suite, junit_of_suites
from modeproof.output.markdown import as_markdown, code, escaped
from modeproof.output.outcome import Outcome
from modeproof.output.sarif import as_sarif_of
from modeproof.project.judging import Judged
from modeproof.project.table import about, status_of

VERSION = 1
COMMAND = "modeproof judge"


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add an option for each form; `-` is standard output."""
    for form, text in (
        ("json", "write all records there, as JSON"),
        ("junit", "write them as JUnit XML: a suite for each entry"),
        ("sarif", "write them as SARIF 2.1.0, for a forge or editor"),
        ("markdown", "write a summary, for the page of a job"),
    ):
        parser.add_argument(f"--{form}", type=Path, metavar="FILE", help=text)


def write(args: argparse.Namespace, found: Sequence[Judged]) -> None:
    """Write the forms that the options ask for. Raises Unjudged."""
    if args.json is not None:
        entries = [
            {
                "name": one.entry.name,
                "kind": one.entry.row.KIND,
                "kept": one.kept,
                "outcome": msgspec.to_builtins(one.outcome),
            }
            for one in found
        ]
        head = {"command": "judge", "schema_version": VERSION, "status": status_of(found)}
        write_json(args.json, {**head, "entries": entries})
    if args.junit is not None:
        write_text(args.junit, junit_of_suites([_suite(one) for one in found], COMMAND))
    if args.sarif is not None:
        runs = {f"modeproof/judge/{one.entry.name}/": one.outcome for one in found}
        write_text(args.sarif, as_sarif_of(runs))
    if args.markdown is not None:
        write_text(args.markdown, markdown_of(found))


def markdown_of(found: Sequence[Judged]) -> str:
    """The table, and the summary of each entry that is not well."""
    lines = [f"## {COMMAND}", "", "| entry | verdict | about | |", "|---|---|---|---|"]
    for one in found:
        kept = "kept" if one.kept else "judged"
        words = code(one.entry.name), f"**{escaped(one.outcome.word)}**", escaped(about(one.outcome)), kept
        lines.append(f"| {' | '.join(words)} |")
    return "\n".join([*lines, "", *(as_markdown(one.outcome) for one in found if one.outcome.status)])


def _suite(one: Judged) -> Suite:
    return Suite(one.entry.name, list(_cases(one.outcome)), one.outcome.seconds)


def _cases(found: Outcome) -> list[Case]:
    said = {"subject": found.subject, "target": found.target, "again": found.again}
    said |= {file.path: file.sha256 for file in found.files}
    cases = [
        Case(
            demand.id,
            demand.word,
            "\n".join([*(problem.message for problem in demand.problems), demand.sentence]),
            said,
            demand.required,
        )
        for demand in found.demands
    ]
    return cases or [Case(found.subject, found.word, found.reason or found.sentence, said)]
