"""The one class of error that a user is meant to see: a clear line and exit status 2."""

from __future__ import annotations

from collections.abc import Sequence

from modeproof.kit.errors import plain
from modeproof.kit.errors import suggestion as suggestion

EXIT_AS_EXPECTED = 0
EXIT_NOT_AS_EXPECTED = 1
EXIT_UNJUDGED = 2
LONGEST = 4000
"""Characters of a message."""


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
