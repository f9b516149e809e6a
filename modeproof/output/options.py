"""What the commands of users share: the options for records and other forms, and how a run ends with them."""

from __future__ import annotations

import argparse
import contextlib
import re
import time
from collections.abc import Callable
from pathlib import Path

from modeproof.ground.evidence import day
from modeproof.ground.places import build, root
from modeproof.output.outcome import Outcome, write

RECORDS = "records"
"""The folder of the records below that of results."""


def add_options(parser: argparse.ArgumentParser, judge: Callable[[argparse.Namespace], Outcome]) -> None:
    """Add the options. `judge` prints, and returns what was found; it stays at hand as `args.judge`."""
    parser.add_argument(
        "--record", type=Path, metavar="FILE", help="write the record there, not to the folder of records"
    )
    parser.set_defaults(judge=judge)


def carried_out(args: argparse.Namespace) -> Outcome:
    """Judge, and write what the options ask for. Raises Unjudged; then no record of an earlier run stays."""
    if args.record is not None:
        with contextlib.suppress(OSError):
            args.record.unlink(missing_ok=True)
    judge: Callable[[argparse.Namespace], Outcome] = args.judge
    found = judge(args)
    write(args.record or records() / f"{name_of(found)}.json", found)
    return found


def records() -> Path:
    """The folder of the records of this project."""
    return build(root()) / RECORDS


def name_of(found: Outcome) -> str:
    """The name of a record that got none."""
    words = re.sub(r"[^A-Za-z0-9.]+", "-", f"{found.subject}-{found.target}").strip("-.")
    return f"{found.command}-{words[:80]}"


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
