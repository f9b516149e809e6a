"""The command `report`: in a user's project its dossier; in the tool's checkout the assessor's report."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from modeproof.dossier.entries import STANDS, gather
from modeproof.dossier.page import page
from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import PROJECT_FILE, build, in_checkout, project, root
from modeproof.kit.by_name import module_named
from modeproof.output.outcome import shown_path
from modeproof.report.filing import day_of

ASSESSORS = "modeproof.report.report_command"
NAME = "dossier.html"


def add_parser(commands: Any) -> None:
    """Add `report` to the commands."""
    if in_checkout(root()):
        module_named(ASSESSORS).add_parser(commands)
        return
    parser = commands.add_parser(
        "report",
        description="Makes the dossier about your programs, machines, adapters and logs, from the records "
        "that the commands have left: one HTML file, which prints on a few sheets. What is wrong, or has "
        "changed since it was judged, stands first. See docs/outputs.md.",
        epilog="exit status: 0 all of it stands, 1 an entry is not as expected, else 2: one is stale, or was "
        "not judged; the dossier is made in every case",
    )
    parser.add_argument("--date", metavar="YYYY-MM-DD", help="the day that the dossier is filed under")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="where to (default: .modeproof/report)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the states of the entries as JSON")
    parser.add_argument("--quiet", action="store_true", help="say only where the dossier is")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Make the dossier; the exit status is that of what stands in it. Raises Unjudged: there is nothing."""
    day = "" if args.date is None else day_of(args.date)
    entries = gather()
    if not entries.rows and not entries.troubles:
        raise Unjudged(
            f"{project()}: nothing was judged here yet; `modeproof init` writes {PROJECT_FILE}, and "
            "`modeproof judge` judges what it lists"
        )
    file = (args.out or build(root()) / "report") / NAME
    write_whole(file, page(entries, day).encode("utf-8"))
    for line in entries.troubles:
        print(f"not read: {line}")
    for entry in entries.rows:
        if entry.state != STANDS and not args.quiet:
            said = entry.found.sentence if entry.found is not None else entry.trouble
            why = "; ".join([said, *entry.stale])
            print(f"{entry.state}: {entry.name}: {why}; run `{entry.again}`")
    print(f"dossier: {shown_path(file)}")
    if args.json is not None:
        rows = [{"name": one.name, "state": one.state, "stale": list(one.stale)} for one in entries.rows]
        record = {"command": "report", "status": entries.status, "dossier": shown_path(file), "entries": rows}
        write_whole(args.json, (json.dumps(record, indent=1, ensure_ascii=False) + "\n").encode("utf-8"))
    return entries.status
