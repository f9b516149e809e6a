"""The one error of the kit, foreign text made harmless, and what somebody may have meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

LONGEST = 600
"""Characters of a message, and of a piece of foreign text in it."""
MANY = 40
"""More names than these are not listed in one line, if one of them is close."""


class Unjudged(Exception):
    """The adapter or the vectors could not be used. The message is one line with place and cause."""

    def __init__(self, message: str) -> None:
        super().__init__(plain(" ".join(message.split())))


def plain(text: object, longest: int = LONGEST) -> str:
    """Text that somebody else wrote, as one line that no terminal obeys, of `longest` characters at most.

    Control characters, line ends, halves of surrogate pairs and marks that turn the direction of writing
    become escapes. All that the kit prints goes through here.
    """
    line = str(text)
    if len(line) > longest:
        line = line[: longest - 3] + "..."
    if line.isprintable():
        return line
    return "".join(one if one.isprintable() else one.encode("unicode_escape").decode("ascii") for one in line)


def suggestion(name: str, allowed: Iterable[str]) -> str:
    """The words `did you mean ..; allowed: ..` for a name that is not allowed.

    Capitals, hyphens and other marks make no difference to what is close.
    """
    names = list(dict.fromkeys(allowed))
    close = nearest(name, names)
    mean = f"did you mean {close[0]!r}? " if close else ""
    if mean and len(names) > MANY:
        return f"{mean}{len(names):,} names are allowed"
    return f"{mean}allowed: {', '.join(names)}" if names else "there are none"


def nearest(name: str, allowed: Iterable[str], most: int = 1) -> list[str]:
    """The allowed names that somebody may have meant, the closest first."""
    bare = {_bare(known): known for known in reversed(list(dict.fromkeys(allowed)))}
    return [bare[one] for one in difflib.get_close_matches(_bare(name), bare, n=most, cutoff=0.5)]


def _bare(name: str) -> str:
    return "".join(char for char in name.casefold() if char.isalnum())
