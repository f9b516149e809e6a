"""The command `modeproof report`: one HTML file and JSON, from registers and evidence alone."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from modeproof.evidence.files import write_whole
from modeproof.places import build
from modeproof.places import root as repository_root
from modeproof.report.baseline import NAME, PREVIOUS, Baseline, choose, read_report
from modeproof.report.build import make
from modeproof.report.sources import DIFFERS, HOLE, NOTE

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

PAGE = "report.html"
WORDS = {NOTE: "NOTE", DIFFERS: "NOT AS EXPECTED", HOLE: "NOT THERE"}


def add_parser(subparsers: Subparsers) -> argparse.ArgumentParser:
    """Add the command; `args.run(args)` returns 0, 1 (not as expected) or 2 (something is missing)."""
    parser = subparsers.add_parser(
        "report",
        help="the assessor's report: one HTML file, from registers and evidence",
        description="Makes build/report/report.html and report.json from the registers and from what lies in "
        "build/evidence/. Exit status: 0 complete and as expected, 1 something is not as expected or "
        "contradicts something else, 2 something is missing; the report is made in every case.",
    )
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="where to (default: build/report)")
    parser.add_argument(
        "--previous",
        type=Path,
        metavar="FILE",
        help="the report.json to compare with (default: the one that was in the folder before)",
    )
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = repository_root()
    folder = args.out or build(place) / "report"
    given = None if args.previous is None else read_report(args.previous)[1]
    report = make(place, lambda digest: choose(folder, digest) if given is None else Baseline(given))
    if report.baseline.keep is not None:
        write_whole(folder / PREVIOUS, report.baseline.keep.encode("utf-8"))
    write_whole(folder / NAME, report.json.encode("utf-8"))
    write_whole(folder / PAGE, report.html.encode("utf-8"))
    for name, content in report.attachments.items():
        write_whole(folder / name, content)
    for one in report.troubles:
        print(f"{WORDS[one.status]}  {one.what}" + (f"; run {one.remedy}" if one.remedy else ""))
    print(f"report: {folder / PAGE} ({len(report.html.encode()):,} bytes)")
    return report.status
