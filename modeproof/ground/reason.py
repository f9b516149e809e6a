"""Why pins move: a person says so, and the reason is kept beside them."""

from __future__ import annotations

import os
import sys

from modeproof.ground.errors import Unjudged


def refuse_in_ci() -> None:
    """Raise Unjudged when the environment variable CI is set: a robot has no reason to give."""
    if os.environ.get("CI"):
        raise Unjudged("--repin is refused in CI: pins are moved by a person, with a reason")


def ask_reason(given: str | None) -> str:
    """The reason for moving pins: as given on the command line, else asked for on the terminal.

    Raises Unjudged without one.
    """
    reason = given
    if reason is None:
        if not sys.stdin.isatty():
            raise Unjudged("--repin needs a reason: give --reason TEXT")
        try:
            reason = input("reason for moving these pins: ")
        except EOFError:
            reason = ""
    reason = " ".join(reason.split())
    if not reason:
        raise Unjudged("--repin needs a reason; nothing was changed")
    return reason
