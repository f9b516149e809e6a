"""The command `modeproof report`: one HTML file and JSON, from registers and evidence alone."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from modeproof.evidence.files import write_whole
from modeproof.places import build
from modeproof.places import root as repository_root
from modeproof.report.build import make

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]


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
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = repository_root()
    report = make(place)
    folder = args.out or build(place) / "report"
    write_whole(folder / "report.json", report.json.encode("utf-8"))
    write_whole(folder / "report.html", report.html.encode("utf-8"))
    for name, content in report.attachments.items():
        write_whole(folder / name, content)
    for one in report.troubles:
        word = "NOT AS EXPECTED" if one.status == 1 else "NOT THERE"
        print(f"{word}  {one.what}" + (f"; run {one.remedy}" if one.remedy else ""))
    print(f"report: {folder / 'report.html'} ({len(report.html.encode()):,} bytes)")
    return report.status
