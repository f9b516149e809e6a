"""The command `judge`: all that the project file lists, by the commands that judge each entry alone."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from modeproof.ground.errors import EXIT_UNJUDGED, Unjudged
from modeproof.ground.places import PROJECT_FILE, project
from modeproof.ground.processes import cores
from modeproof.ground.progress import Progress
from modeproof.kit.files import write_text
from modeproof.output.junit import as_junit
from modeproof.output.markdown import as_markdown
from modeproof.output.sarif import as_sarif
from modeproof.project.checks import problems_of
from modeproof.project.file import Listed, Wrong, read
from modeproof.project.judging import Judged, Judging
from modeproof.project.table import lines_of, status_of, table_of
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
    parser.add_argument("--sarif", type=Path, metavar="FILE", help="write all as SARIF 2.1.0 as well")
    parser.add_argument("--junit", type=Path, metavar="FILE", help="write all as JUnit XML as well")
    parser.add_argument(
        "--markdown", type=Path, metavar="FILE", help="write a summary as well, for the page of a job"
    )
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
    if args.watch and any(getattr(args, form) is not None for form in FORMS):
        raise Unjudged(
            "--watch ends with Ctrl-C; --sarif, --junit and --markdown are of one run: leave them out"
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
    found = judging.all(entries, args.anew)
    show(judging, found)
    for form, made in FORMS.items():
        if (place := getattr(args, form)) is not None:
            write_text(place, made(found))
    if not args.watch:
        return status_of(found)
    print("watching; Ctrl-C ends it", file=sys.stderr, flush=True)
    return Watch(begin, found).run(judging, entries)


def begun(path: Path, args: argparse.Namespace) -> tuple[Judging, Sequence[Listed]]:
    """The project file as it is now, with the entries asked for. Raises Unjudged and Wrong."""
    read_in = read(path, Path(os.path.relpath(path)).as_posix())
    entries = read_in.chosen(args.names)
    if wrong := list(problems_of(read_in, entries)):
        raise Wrong(wrong)
    progress = Progress(quiet=args.quiet)

    def say(line: str) -> None:
        if not args.quiet:
            print(line, file=sys.stderr, flush=True)

    return Judging(read_in, args.jobs, progress, say), entries


def show(judging: Judging, found: Sequence[Judged]) -> None:
    """Print the table."""
    print("\n".join(lines_of(judging, found)), flush=True)


def _markdown(found: Sequence[Judged]) -> str:
    return "\n".join([*table_of(found), *(as_markdown(one.outcome) for one in found if one.outcome.status)])


FORMS: Mapping[str, Callable[[Sequence[Judged]], str]] = {
    "sarif": lambda found: as_sarif(*(one.outcome for one in found)),
    "junit": lambda found: as_junit({one.entry.name: one.outcome for one in found}),
    "markdown": _markdown,
}
"""What makes each form of all that was found."""
