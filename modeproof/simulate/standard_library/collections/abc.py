"""Names of annotations, which may be given parameters."""

from __future__ import annotations


class _Name:
    def __getitem__(self, parameters: object) -> _Name:
        return self


Callable = Iterable = Iterator = Mapping = Sequence = _Name()
