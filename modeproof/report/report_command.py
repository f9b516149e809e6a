"""The command `modeproof report`: one HTML file and JSON, from registers and evidence alone."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import add_document_option, build, chosen_documents
from modeproof.ground.places import root as repository_root
from modeproof.ground.progress import Progress
from modeproof.report.baseline import NAME, PREVIOUS, Baseline, choose, read_report
from modeproof.report.build import SHOWN, Report, make
from modeproof.report.filing import Filing, day_of
from modeproof.report.part import plain
from modeproof.report.recheck import PAGE, recheck
from modeproof.report.sources import DIFFERS, HOLE, NOTE, Trouble

WORDS = {NOTE: "NOTE", DIFFERS: "NOT AS EXPECTED", HOLE: "NOT THERE"}
BESIDE = "build/report"


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns 0, 1 (not as expected) or 2 (something is missing)."""
    parser = commands.add_parser(
        "report",
        description="Makes build/report/report.html and report.json from the registers and from what lies in "
        "build/evidence/. Exit status: 0 complete and as expected, 1 something is not as expected or "
        "contradicts something else, 2 something is missing; the report is made in every case.",
    )
    add_document_option(parser)
    parser.add_argument("--date", metavar="YYYY-MM-DD", help="the day that the report is filed under")
    parser.add_argument(
        "--review",
        type=Path,
        metavar="FILE",
        help="an answered review sheet: its answers go into the report",
    )
    parser.add_argument(
        "--out",
        type=Path,
        metavar="FOLDER",
        help=f"where to (default: {BESIDE}, of chosen documents below it)",
    )
    parser.add_argument(
        "--previous",
        type=Path,
        metavar="FILE",
        help="the report.json to compare with (default: the one that was in the folder before)",
    )
    parser.add_argument(
        "--verify",
        nargs="?",
        type=Path,
        const=Path(BESIDE) / PAGE,
        metavar="FILE",
        help="make nothing; recompute all hashes of a report (page or JSON) and say which file differs, "
        "is gone or is new",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result as JSON")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Carry out the command."""
    place = repository_root()
    if args.verify is not None:
        return _verify(args, place)
    chosen = chosen_documents(place, args.document) if args.document else ()
    filing = Filing("" if args.date is None else day_of(args.date), chosen, args.review)
    folder = args.out or build(place) / "report" / "-".join(chosen)
    given = None if args.previous is None else read_report(args.previous)[1]
    report = _made(
        place, lambda digest: choose(folder, digest) if given is None else Baseline(given), filing, args.quiet
    )
    write(report, folder)
    for line in trouble_lines(report.troubles):
        print(line)
    print(f"report: {folder / PAGE} ({len(report.html.encode()):,} bytes)")
    _write_json(args, report.status, report=str(folder / PAGE), troubles=plain(report.troubles))
    return report.status


def _made(place: Path, baseline: Callable[[str], Baseline], filing: Filing, quiet: bool) -> Report:
    """The report; what is being made, and how long it may take, stands on standard error meanwhile."""
    progress = Progress(quiet=quiet)
    progress.expect(1)
    progress.begin("report")
    try:
        return make(place, baseline, filing, lambda part, share: progress.update("report", part, share))
    finally:
        progress.end("report")


def made_by_verify(place: Path, quiet: bool = False) -> list[str]:
    """Make the report where it belongs, at the end of a verification: lines for the terminal.

    Its status is its own: what this lane does not make may be of older texts, and is named, not judged here.
    Raises Unjudged when it cannot be made or written.
    """
    folder = build(place) / "report"
    report = _made(place, lambda digest: choose(folder, digest), Filing(), quiet)
    write(report, folder)
    bad = [trouble for trouble in report.troubles if trouble.status != NOTE]
    line = f"{'report':<12} {BESIDE}/{PAGE}"
    if not bad:
        return [f"{line}: complete"]
    worst = min(bad, key=lambda one: one.status)
    more = f" (and {len(bad) - 1} more)" if len(bad) > 1 else ""
    return [f"{line}: {WORDS[worst.status].lower()}: {worst.what}{more}; it says so"]


def write(report: Report, folder: Path) -> None:
    """Write page, JSON, what is beside them, and the report before. Raises Unjudged when it cannot."""
    if report.baseline.keep is not None:
        write_whole(folder / PREVIOUS, report.baseline.keep.encode("utf-8"))
    write_whole(folder / NAME, report.json.encode("utf-8"))
    write_whole(folder / PAGE, report.html.encode("utf-8"))
    for name, content in report.attachments.items():
        write_whole(folder / name, content)


def trouble_lines(troubles: Sequence[Trouble]) -> Iterator[str]:
    """The troubles for the terminal, the worst first; of many of one part the first, and how many more."""
    for status in (DIFFERS, HOLE, NOTE):
        parts: dict[str, list[Trouble]] = {}
        for trouble in troubles:
            if trouble.status == status:
                parts.setdefault(trouble.part, []).append(trouble)
        for part, some in parts.items():
            for one in some[:SHOWN]:
                yield f"{WORDS[status]}  {one.what}" + (f"; run {one.remedy}" if one.remedy else "")
            if len(some) > SHOWN:
                yield f"{WORDS[status]}  and {len(some) - SHOWN} more in the part {part} of the page"


def _verify(args: argparse.Namespace, place: Path) -> int:
    file = args.verify if args.verify != Path(BESIDE) / PAGE else build(place) / "report" / PAGE
    found = recheck(place, file)
    for difference in found.differences:
        print(f"{difference.word:<8} {difference.path}: {difference.why}")
    words = {0: "as it was made", DIFFERS: "NOT as it was made", HOLE: "NOT complete"}[found.status]
    if found.again:
        words += f"; {found.again} made again since: reproduced, same result"
    print(f"{file}: {found.compared} files: {words}")
    _write_json(args, found.status, report=str(file), differences=plain(found.differences))
    return found.status


def _write_json(args: argparse.Namespace, status: int, **content: Any) -> None:
    if args.json is not None:
        text = json.dumps({"command": "report", "status": status, **content}, indent=1, ensure_ascii=False)
        write_whole(args.json, f"{text}\n".encode())
