"""The command `modeproof render`: the page of each document, and the blocks in README.md and docs/.

A page is made from the registers. Its tables of counterexamples come from evidence and walks; where there is
no evidence, a table that the page already holds is kept if its run is still declared as it was.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground import evidence
from modeproof.ground.errors import EXIT_AS_EXPECTED, EXIT_NOT_AS_EXPECTED, Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import add_document_option, chosen_documents, documents
from modeproof.ground.places import root as repository_root
from modeproof.registers.citations import read_sources
from modeproof.registers.demands_page import demands_pages
from modeproof.registers.document_page import page, page_name, picture_name, tables_of, tellings
from modeproof.registers.findings_page import findings_pages
from modeproof.registers.load import load_document
from modeproof.registers.replay import load_replay
from modeproof.registers.rows import Document
from modeproof.registers.runs import Run, load_runs
from modeproof.registers.tables import pages, render_blocks
from modeproof.report.scaling import chart, curves_of
from modeproof.report.scan_table import scan_table
from modeproof.report.scan_table_cells import Cells
from modeproof.tlc.toolchain import find_toolchain
from modeproof.tlc.walk import recorded, walk_all


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns 0, or 1 where --check finds drift, and raises Unjudged."""
    parser = commands.add_parser(
        "render",
        description="Makes the page of each document from its registers, with tables of its most telling "
        "counterexamples from build/evidence/, then the blocks in README.md and docs/. "
        "Exit status: 0 written, 1 drifted (with --check), 2 evidence is missing.",
    )
    add_document_option(parser)
    parser.add_argument("--check", action="store_true", help="write nothing; say which pages would change")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = repository_root()
    loaded = [load_document(place, name) for name in documents(place)]
    chosen = chosen_documents(place, args.document)
    made: dict[str, str] = {}
    for document in loaded:
        if document.name in chosen:
            made |= rendered(document)
    changed = _changed(place, made)
    if not args.check:
        for name in changed:
            write_whole(place / name, made[name].encode("utf-8"))
    blocks = {}
    for path in pages(place):
        name = path.relative_to(place).as_posix()
        blocks[name] = render_blocks(made.get(name) or path.read_text(encoding="utf-8"), loaded, name)
    again = _changed(place, blocks)
    if not args.check:
        for name in again:
            write_whole(place / name, blocks[name].encode("utf-8"))
    changed = list(dict.fromkeys([*changed, *again]))
    for name in changed:
        print(f"{name} {'differs from registers and evidence' if args.check else 'rendered'}")
    if not changed:
        print("nothing has changed")
    return EXIT_NOT_AS_EXPECTED if args.check and changed else EXIT_AS_EXPECTED


def _changed(place: Path, texts: Mapping[str, str]) -> list[str]:
    """The files that are not there or hold another text."""
    return [
        name
        for name, text in texts.items()
        if not (place / name).is_file() or (place / name).read_text(encoding="utf-8") != text
    ]


def rendered(document: Document) -> dict[str, str]:
    """The page of a document, and its chart where growth was measured."""
    place, name = document.root, document.name
    texts = {
        page_name(name): page(document, read_sources(document), _tables(document)),
        **findings_pages(document),
        **demands_pages(document),
    }
    if curves := curves_of(place, name):
        texts[picture_name(name)] = chart(curves)
    return texts


def _tables(document: Document) -> dict[str, str]:
    """The table of each telling counterexample, from evidence where it fits, else from the page.

    Raises Unjudged with the command that is needed where there is neither.
    """
    place, name = document.root, document.name
    wanted = [telling.run for _, telling in tellings(document)]
    if not wanted:
        return {}
    declared = {run.id: run for run in load_runs(place, name)}
    if unknown := [run for run in wanted if run not in declared]:
        raise Unjudged(f"{document.source('findings')}: telling: no run {unknown[0]!r} in runs.toml")
    reasons = {run: _unfit(place, declared[run]) for run in wanted}
    path = place / page_name(name)
    tables = tables_of(document, path.read_text(encoding="utf-8")) if path.is_file() else {}
    missing = [run for run in wanted if reasons[run] and run not in tables]
    if missing:
        raise Unjudged(f"{missing[0]}: {reasons[missing[0]]}; run modeproof check {' '.join(missing)}")
    for run in wanted:
        if reasons[run]:
            print(f"{run}: its table is kept as it was: {reasons[run]}")
    kept = {run: tables[run] for run in wanted if reasons[run]}
    return kept | _walked(document, [run for run in wanted if run not in kept])


def _unfit(place: Path, run: Run) -> str:
    """Why the evidence of a run cannot be shown; empty where it fits specification and pins."""
    path = evidence.evidence_path(place, run.document, run.id)
    if not path.is_file():
        return "no evidence"
    record = evidence.read(path)
    if not record["as_expected"] or not record["result"].get("trace"):
        return f"its evidence is not as expected: {record['verdict']}"
    result = record["result"]
    pins = {"violated": run.property or None, "trace_length": run.trace_length, "distinct": run.distinct}
    for name, pin in pins.items():
        if pin is not None and result.get(name) != pin:
            return f"its evidence has {name} {result.get(name)}, runs.toml {pin}"
    for name, digest in record["inputs"].items():
        now = evidence.hashes(place, [place / name]) if (place / name).is_file() else {}
        if not name.endswith("/runs.toml") and now.get(name) != digest:
            return f"{name} has changed since its evidence was made"
    return ""


def _walked(document: Document, runs: Sequence[str]) -> dict[str, str]:
    place, name = document.root, document.name
    traces = load_replay(place, name)
    found = [recorded(evidence.read(evidence.evidence_path(place, name, run))) for run in runs]
    walks = walk_all(place, name, found, find_toolchain()) if found else {}
    return {
        run: scan_table(walk, traces, Cells(document.interface, traces, walk["tables"]))
        for run, walk in walks.items()
    }
