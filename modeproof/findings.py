"""The command `modeproof findings`: the pages of the findings, from registers and evidence.

Without --render it says for each finding what shows it, renders all pages in memory and compares them with
those in docs/. With --render it writes them. Both need the evidence of every run and theorem that a finding
names.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from modeproof import evidence
from modeproof.errors import EXIT_AS_EXPECTED, EXIT_NOT_AS_EXPECTED, Unjudged
from modeproof.evidence.files import write_whole
from modeproof.places import add_document_option, chosen_documents
from modeproof.places import root as repository_root
from modeproof.registers.citations import read_sources
from modeproof.registers.load import load_document
from modeproof.registers.made import cfg_text, read_cfg
from modeproof.registers.replay import has_replay, load_replay
from modeproof.registers.rows import Document
from modeproof.registers.runs import Run, load_runs
from modeproof.registers.stamps import REMEDY, folder_of
from modeproof.registers.switches import restored
from modeproof.report.findings import Material, render
from modeproof.tlc.toolchain import find_toolchain
from modeproof.tlc.walk import recorded, walk_all

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

SECONDS = re.compile(r"\| \d+\.\d \|")
"""How long a run took, in a table: not the same twice, so it is not compared."""
STAMP = re.compile(r"text \w{12} -->")


def add_parser(subparsers: Subparsers) -> argparse.ArgumentParser:
    """Add the command; `args.run(args)` returns 0 as expected, 1 not as expected, and raises Unjudged."""
    parser = subparsers.add_parser(
        "findings",
        help="compare or render the pages of the findings (docs/<document>/findings.md)",
        description="Compares the pages of the findings with registers and evidence, or renders them anew. "
        "Needs the evidence of every run and theorem that a finding names (modeproof verify makes it). "
        "Exit status: 0 as expected, 1 a page has drifted, 2 could not be judged.",
    )
    add_document_option(parser)
    parser.add_argument("--render", action="store_true", help="write the pages (all of them, or none)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result as JSON as well")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = repository_root()
    chosen = [name for name in chosen_documents(place, args.document) if has_replay(place, name)]
    if not chosen:
        raise Unjudged("no document has a replay.toml, so there is no page to render")
    pages: dict[str, str] = {}
    for name in chosen:
        pages |= render(gather(place, name))
    folders = [folder_of(name) for name in chosen]
    drifted: list[str] = []
    if args.render:
        status = _write(place, pages, folders)
    else:
        status, drifted = _compare(place, pages, folders)
    if args.json is not None:
        content = {"command": "findings", "status": status, "pages": sorted(pages), "drifted": drifted}
        write_whole(args.json, (json.dumps(content, indent=1) + "\n").encode("utf-8"))
    return status


def gather(place: Path, name: str) -> Material:
    """Everything that the pages of a document are made from.

    Raises Unjudged with the run and the command that is needed: evidence that is missing, not as expected,
    or of other pins than runs.toml has.
    """
    document = load_document(place, name)
    sources = read_sources(document)
    traces = load_replay(place, name)
    declared = {one.id: one for one in load_runs(place, name)}
    constants = {one.id: read_cfg(place, one).constants for one in document.runs}
    shown = _shown(document)
    restoring = [one.id for one in document.runs if restored(constants[one.id], traces.literal)]
    breaking = [name for one in document.assumptions for name in one.breaks]
    wanted = list(dict.fromkeys([*shown, *restoring, *breaking]))
    found = {one: _evidence(place, name, one, declared) for one in wanted}
    traced = [recorded(found[one]) for one in shown if found[one]["result"].get("trace")]
    walks = walk_all(place, name, traced, find_toolchain()) if traced else {}
    return Material(document, sources, traces, found, walks, constants)


def _shown(document: Document) -> list[str]:
    """The runs and theorems that findings name; clause ids among the evidence are none."""
    clauses = {one.id for one in document.clauses}
    return [name for one in document.findings for name in one.evidence if name not in clauses]


def _evidence(place: Path, document: str, name: str, declared: Mapping[str, Run]) -> dict[str, Any]:
    one = declared.get(name)
    command = f"modeproof {'check' if one is not None else 'prove'} {name}"
    try:
        record = evidence.read(evidence.evidence_path(place, document, name))
    except Unjudged as error:
        raise Unjudged(f"{name}: no evidence to render ({error.message}); run {command}") from None
    fault = _fault(place, document, record, one)
    if fault:
        raise Unjudged(f"{name}: {fault}; run {command}")
    return record


def _fault(place: Path, document: str, record: Mapping[str, Any], run: Run | None) -> str:
    """Why a piece of evidence cannot be shown: not as expected, or not by the pins that runs.toml has now."""
    if record["verdict"] != record["expected"]:
        return f"its evidence is not as expected: {record['verdict']}"
    if run is None:
        return "" if record["as_expected"] else "its evidence is not as expected"
    digest = hashlib.sha256(cfg_text(place, run).encode("utf-8")).hexdigest()
    if record["inputs"].get(run.config) != digest:
        return f"its evidence is of another {run.config}"
    result = record["result"]
    if run.property and result.get("violated") != run.property:
        return f"its evidence violates {result.get('violated')}, not {run.property}"
    for pin, got in (
        (run.cfg_sha256, digest),
        (run.trace_length, result.get("trace_length")),
        (run.distinct, result.get("distinct")),
        (run.generated, result.get("generated")),
    ):
        if pin is not None and pin != got:
            return f"its evidence has {got} where runs.toml pins {pin}"
    return ""


def _without_finding(place: Path, pages: Mapping[str, str], folders: Sequence[str]) -> list[str]:
    """Pages of findings that no finding with evidence has."""
    there = [f"{folder}/{path.name}" for folder in folders for path in (place / folder).glob("*.md")]
    return sorted(name for name in there if name not in pages)


def _write(place: Path, pages: Mapping[str, str], folders: Sequence[str]) -> int:
    stale = _without_finding(place, pages, folders)
    for name, text in sorted(pages.items()):
        write_whole(place / name, text.encode("utf-8"))
    for path in stale:
        (place / path).unlink()
    print(f"{len(pages)} pages rendered" + (f", {len(stale)} removed" if stale else ""))
    return EXIT_AS_EXPECTED


def _compare(place: Path, pages: Mapping[str, str], folders: Sequence[str]) -> tuple[int, list[str]]:
    drifted = []
    for name, text in sorted(pages.items()):
        path = place / name
        if not path.is_file():
            drifted.append(f"{name}: the page is missing")
        elif _comparable(path.read_text(encoding="utf-8")) != _comparable(text):
            drifted.append(f"{name}: the page differs from what registers and evidence give")
    for name in _without_finding(place, pages, folders):
        drifted.append(f"{name}: no finding with evidence has this page")
    for line in drifted:
        print(f"  {line}; {REMEDY}")
    print(f"{len(pages) - len(drifted)} of {len(pages)} pages as registers and evidence give them")
    return (EXIT_NOT_AS_EXPECTED if drifted else EXIT_AS_EXPECTED), drifted


def _comparable(text: str) -> str:
    return STAMP.sub("text", SECONDS.sub("| s |", text))
