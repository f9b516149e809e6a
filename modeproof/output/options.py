"""What the commands of users share: the options for records and other forms, and how a run ends with them."""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import io
import re
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence import day
from modeproof.ground.places import build, root
from modeproof.kit.files import STDOUT, can_be_written, write_text
from modeproof.output.diagram import as_svg
from modeproof.output.markdown import as_markdown
from modeproof.output.outcome import File, Outcome, shown_path, unjudged, write
from modeproof.output.sarif import as_sarif

RECORDS = "records"
"""The folder of the records below that of results."""


@dataclass(frozen=True)
class About:
    """What the arguments of a command name, before anything is read. files: by their role."""

    command: str
    subject: str
    target: str
    again: str
    files: Mapping[str, Sequence[Path | None]] = field(default_factory=dict)
    part: str = ""
    """What tells two runs on the same files apart: the unit that was chosen, a suite."""

    @property
    def name(self) -> str:
        """The name of the record, if no other is given."""
        words = (self.command, self.subject, self.target, self.part)
        slug = re.sub(r"[^A-Za-z0-9.]+", "-", " ".join(words)).strip("-.")
        return slug if len(slug) <= 80 else f"{slug[:70]}-{hashlib.sha256(slug.encode()).hexdigest()[:8]}"

    @property
    def hashed(self) -> list[File]:
        """The files that are there, with their hashes."""
        found = []
        for role, paths in self.files.items():
            for path in paths:
                with contextlib.suppress(OSError, AttributeError):
                    digest = hashlib.sha256(path.read_bytes()).hexdigest()  # type: ignore[union-attr]
                    found.append(File(path=shown_path(str(path)), sha256=digest, role=role))
        return found


def add_options(
    parser: argparse.ArgumentParser,
    judge: Callable[[argparse.Namespace], Outcome],
    about: Callable[[argparse.Namespace], About],
) -> None:
    """Add the options. `judge` prints, and returns what was found; `about` says what is asked for."""
    parser.add_argument(
        "--record", type=Path, metavar="FILE", help="write the record there, not to the folder of records"
    )
    parser.add_argument(
        "--sarif", type=Path, metavar="FILE", help="write it as SARIF 2.1.0, for a forge or editor"
    )
    parser.add_argument(
        "--markdown", type=Path, metavar="FILE", help="write a summary, for the page of a job"
    )
    parser.add_argument(
        "--diagram",
        type=Path,
        metavar="FOLDER",
        help="draw the scans of each problem there as SVG; a FILE.svg for the first alone",
    )
    parser.set_defaults(judge=judge, about=about)


def carried_out(args: argparse.Namespace) -> Outcome:
    """Judge, write what the options ask for, and then print. Raises Unjudged; the record says so as well.

    What is said on standard output is held back until all is written: whoever reads a verdict has its files.
    """
    held = io.StringIO()
    with contextlib.redirect_stdout(held):
        found, error = _judged(args)
    if error is not None:
        raise error
    print(held.getvalue(), end="", flush=True)
    return found


def found_by(args: argparse.Namespace) -> Outcome:
    """The same without a word on standard output; what cannot be judged is an outcome too."""
    with contextlib.redirect_stdout(io.StringIO()):
        found, _ = _judged(args)
    return found


def _judged(args: argparse.Namespace) -> tuple[Outcome, Unjudged | None]:
    for option in ("json", "junit", "vector", *FORMS):
        if (place := getattr(args, option, None)) is not None:
            can_be_written(place)
    about: About = args.about(args)
    path: Path = args.record or records() / f"{about.name}.json"
    known_before = path.exists()
    with contextlib.suppress(OSError):  # what was found before says nothing of this run
        path.unlink()
    judge: Callable[[argparse.Namespace], Outcome] = args.judge
    error, clock = None, Clock()
    try:
        found = judge(args)
    except Unjudged as refused:
        error = refused
        known: dict[str, Any] = {"started": clock.started, "seconds": clock.seconds, "files": about.hashed}
        found = unjudged(about.command, about.subject, about.target, about.again, refused.message, **known)
    if error is None or args.record is not None or known_before:  # a slip of the pen is no entry
        write(path, found)
    write_forms(args, found, about.name)
    return found, error


FORMS: Mapping[str, Callable[[Outcome], str]] = {"sarif": as_sarif, "markdown": as_markdown}


def write_forms(args: argparse.Namespace, found: Outcome, name: str) -> None:
    """Write the forms that the options ask for. name: how pictures begin. Raises Unjudged."""
    for form, made in FORMS.items():
        if (path := getattr(args, form)) is not None:
            write_text(path, made(found))
    if args.diagram is not None:
        for path, text in pictures(args.diagram, found, name):
            write_text(path, text)


def pictures(place: Path, found: Outcome, name: str) -> list[tuple[Path, str]]:
    """The pictures with their files; those of an earlier run are removed. Raises Unjudged."""
    one = place.suffix.lower() == ".svg"
    drawn = [
        (f"{name}-{number}.svg", as_svg(problem.counterexample, demand.sentence, problem.message))
        for number, (demand, problem) in enumerate(found.problems, 1)
        if problem.counterexample is not None
    ]
    try:
        if not one:
            place.mkdir(parents=True, exist_ok=True)
        for old in [place] if one else place.glob(f"{name}-*.svg"):
            if old != STDOUT and old.is_file():
                old.unlink()
    except OSError as error:
        raise Unjudged(f"{place}: cannot be written: {error.strerror or error}") from None
    return [(place, text) for _, text in drawn[:1]] if one else [(place / file, text) for file, text in drawn]


def records() -> Path:
    """The folder of the records of this project."""
    return build(root()) / RECORDS


class Clock:
    """When a run began, and for how long it goes on."""

    def __init__(self) -> None:
        self._began, self._clock = time.time(), time.monotonic()

    @property
    def started(self) -> str:
        """When it began, as records say it."""
        return day(self._began)

    @property
    def seconds(self) -> float:
        """Since then."""
        return round(time.monotonic() - self._clock, 3)
