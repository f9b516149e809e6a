"""`Any` and `TypeVar`, which say nothing at run time."""

from __future__ import annotations

Any = object


class TypeVar:
    """A name in an annotation."""

    def __init__(self, name: str) -> None:
        self.name = name
