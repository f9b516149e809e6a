"""The one error of the kit."""

from __future__ import annotations


class Unjudged(Exception):
    """The adapter or the vectors could not be used. The message is one line with place and cause."""

    def __init__(self, message: str) -> None:
        super().__init__(" ".join(message.split())[:600])
