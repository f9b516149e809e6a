"""The command `modeproof registers`: judge the registers, print or write the matrix."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from modeproof.ground.errors import EXIT_AS_EXPECTED, EXIT_NOT_AS_EXPECTED, Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import add_document_option, chosen_documents
from modeproof.ground.places import root as repository_root
from modeproof.ground.progress import Progress
from modeproof.ground.reason import ask_reason, refuse_in_ci
from modeproof.registers.citations import read_sources
from modeproof.registers.load import load_document
from modeproof.registers.machine_pins import repin_machines
from modeproof.registers.pins import repin
from modeproof.registers.register_judge import Judgement, judge, judge_tree
from modeproof.registers.rows import Problem
from modeproof.registers.tables import matrix_csv, matrix_records, matrix_text


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns 0 as expected, 1 not as expected, and raises Unjudged."""
    parser = commands.add_parser(
        "registers",
        description="Judges the registers of every document: schemas, contradictions, citations, orphans, "
        "names. Exit status: 0 as expected, 1 not as expected, 2 could not be judged.",
    )
    add_document_option(parser)
    parser.add_argument("--matrix", action="store_true", help="print the matrix, one clause a line")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write matrix and problems as JSON")
    parser.add_argument("--csv", type=Path, metavar="FILE", help="write the matrix of one document as CSV")
    parser.add_argument("--repin", action="store_true", help="pin what properties and theorems say now")
    parser.add_argument("--reason", metavar="TEXT", help="why the pins move; kept beside them")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    root = repository_root()
    chosen = chosen_documents(root, args.document)
    if args.csv and len(chosen) != 1:
        raise Unjudged(f"--csv writes one document; choose it with --document ({', '.join(chosen)})")
    if args.repin:
        refuse_in_ci()
        reason = ask_reason(args.reason)
        for document in [load_document(root, name) for name in chosen]:
            print(
                "\n".join(repin(document, read_sources(document), reason)) or f"{document.name}: no pin moved"
            )
        if not args.document:
            print("\n".join(repin_machines(root, reason)))
    progress = Progress(quiet=args.quiet)
    judgements = [judge(load_document(root, name)) for name in progress.over("registers", chosen)]
    tree = judge_tree(root)
    for judgement in judgements:
        if args.matrix:
            print(matrix_text(judgement.rows))
        print(summary(judgement))
    problems = [*(problem for judgement in judgements for problem in judgement.problems), *tree]
    for problem in problems:
        print(f"  {problem}")
    print(f"registers: {'as expected' if not problems else f'not as expected, {len(problems)} problems'}")
    if args.json:
        text = json.dumps(record(judgements, tree), indent=2, ensure_ascii=False) + "\n"
        write_whole(args.json, text.encode("utf-8"))
    if args.csv:
        write_whole(args.csv, matrix_csv(judgements[0].rows).encode("utf-8"))
    as_expected = not problems and all(judgement.as_expected for judgement in judgements)
    return EXIT_AS_EXPECTED if as_expected else EXIT_NOT_AS_EXPECTED


def summary(judgement: Judgement) -> str:
    """One line of counts."""
    filled = {
        column: sum(bool(getattr(row, column)) for row in judgement.rows)
        for column in ("action", "step", "property", "theorem", "vector")
    }
    counts = ", ".join(f"{number} with {column}" for column, number in filled.items())
    words = {
        "negative": "broken by a negative",
        "edit": "by an edit",
        "by construction": "by construction",
        "nothing": "with nothing",
    }
    falls = ", ".join(
        f"{judgement.falls[kind]} {word}" for kind, word in words.items() if judgement.falls[kind]
    )
    return (
        f"{judgement.document}: {len(judgement.rows)} clauses ({counts}); "
        f"{judgement.citations} citations, {judgement.unresolved} unresolved; "
        f"{sum(judgement.falls.values())} properties ({falls}); "
        f"{len(judgement.problems)} problems"
    )


def record(judgements: list[Judgement], tree: list[Problem]) -> dict[str, object]:
    """Everything as plain data."""
    return {
        "documents": [
            {
                "document": judgement.document,
                "as_expected": judgement.as_expected,
                "citations": judgement.citations,
                "unresolved": judgement.unresolved,
                "problems": [str(problem) for problem in judgement.problems],
                "matrix": matrix_records(judgement.rows),
            }
            for judgement in judgements
        ],
        "problems": [str(problem) for problem in tree],
    }
