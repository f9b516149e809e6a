"""The one class of error that a user is meant to see: a clear line and exit status 2."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence

from modeproof.kit.errors import plain

EXIT_AS_EXPECTED = 0
EXIT_NOT_AS_EXPECTED = 1
EXIT_UNJUDGED = 2
LONGEST = 4000
"""Characters of a message."""
MANY = 40
"""More names than these are not listed in one line, if one of them is close."""


class Unjudged(Exception):
    """Something could not be judged: a file is missing or malformed, a tool did not start, the disk is full.

    The message is one line that names the place and the cause. It is never a pass: the exit status is 2.
    """

    def __init__(self, message: str) -> None:
        super().__init__(plain(" ".join(message.split()), LONGEST))

    @property
    def message(self) -> str:
        """The line to print."""
        return str(self.args[0])


def first_of(problems: Sequence[str]) -> str:
    """The first problem, and how many more there are; "" where there is none."""
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return f"{problems[0]}{more}" if problems else ""


def suggestion(name: str, allowed: Iterable[str]) -> str:
    """The words `did you mean ..; allowed: ..` for a name that is not allowed."""
    names = list(allowed)
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    mean = f"did you mean {close[0]!r}? " if close else ""
    if mean and len(names) > MANY:
        return f"{mean}{len(names):,} names are allowed"
    return f"{mean}allowed: {', '.join(names) if names else 'nothing'}"
