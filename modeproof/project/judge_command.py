"""The command `judge`: all that the project file lists, by the commands that judge each entry alone."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from modeproof.ground.errors import EXIT_UNJUDGED, Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import PROJECT_FILE, build, project, root
from modeproof.ground.processes import cores
from modeproof.ground.progress import Progress
from modeproof.project import forms
from modeproof.project.checks import problems_of
from modeproof.project.file import Listed, Wrong, read
from modeproof.project.judging import Judged, Judging, from_here
from modeproof.project.table import lines_of, status_of
from modeproof.project.watch import Watch


def add_parser(commands: Any) -> argparse.ArgumentParser:
    """Add `judge` to the commands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "judge",
        description=f"Judge all that {PROJECT_FILE} lists, each entry by its own command. A result whose "
        "files, options and tool are the same as before is kept. See docs/your-project.md.",
        epilog="exit status: 0 all as expected, 1 an entry is not, else 2: one could not be judged",
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these entries")
    parser.add_argument("--anew", action="store_true", help="judge all of them, whatever was kept")
    parser.add_argument("--watch", action="store_true", help="judge again when a file is saved, until Ctrl-C")
    parser.add_argument(
        "--jobs", type=_jobs, default=cores(), metavar="N", help=f"so many at once (default {cores()})"
    )
    forms.add_options(parser)
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.set_defaults(run=run)
    return parser


def _jobs(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 1000:
        raise argparse.ArgumentTypeError("1 to 1000 expected")
    return int(text)


def run(args: argparse.Namespace) -> int:
    """Judge, and print the table; the exit status is that of all entries. Raises Unjudged."""
    path = project() / PROJECT_FILE
    if not path.is_file():
        raise Unjudged(
            f"no {PROJECT_FILE} in {path.parent}, nor above it: `modeproof init` writes one from what is here"
        )
    begin = partial(begun, path, args)
    try:
        judging, entries = begin()
    except Wrong as error:
        for line in error.lines:
            print(f"modeproof: {line}", file=sys.stderr)
        return EXIT_UNJUDGED
    if not entries:
        raise Unjudged(f"{judging.project.shown}: lists nothing to judge (docs/your-project.md)")
    _keep_out_of_git(build(root()))
    watch = Watch(partial(begin, quiet=True), judging, entries) if args.watch else None
    found = judging.all(entries, args.anew)
    show(judging, found)
    forms.write(args, found)
    if watch is None:
        return status_of(found)
    print("watching; Ctrl-C ends it", file=sys.stderr, flush=True)
    return watch.run(found)


def _keep_out_of_git(state: Path) -> None:
    """Results are no sources: what makes their folder says so to git. Raises Unjudged."""
    ours = state / ".gitignore"
    if state == project() / ".modeproof" and not ours.exists():
        write_whole(ours, b"*\n")


def begun(path: Path, args: argparse.Namespace, quiet: bool = False) -> tuple[Judging, Sequence[Listed]]:
    """The project file as it is now, with the entries asked for. Raises Unjudged and Wrong."""
    read_in = read(path, from_here(path))
    entries = read_in.chosen(args.names)
    if wrong := list(problems_of(read_in, entries)):
        raise Wrong(wrong)
    quiet = quiet or args.quiet
    progress = Progress(quiet=quiet)

    def say(line: str) -> None:
        if not quiet:
            print(line, file=sys.stderr, flush=True)

    return Judging(read_in, args.jobs, progress, say), entries


def show(judging: Judging, found: Sequence[Judged]) -> None:
    """Print the table."""
    print("\n".join(lines_of(judging, found)), flush=True)
