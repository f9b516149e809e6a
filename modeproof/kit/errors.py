"""The one error of the kit, and foreign text made harmless."""

from __future__ import annotations

LONGEST = 600
"""Characters of a message, and of a piece of foreign text in it."""


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
