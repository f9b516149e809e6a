"""Makes scans fewer, by running parts of them again with plain values."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Protocol, TypeVar

from programs.equality.binding import Binding
from programs.equality.replay import Difference, Run, Scans, replay


class Shown(Protocol):
    """What a run shows."""

    @property
    def run(self) -> Run:
        """The scans, of which the last shows it."""


T = TypeVar("T", bound=Shown)


def fewer(known: T, shows: Callable[[Run], T | None], longest: int | None) -> T:
    """The same in scans of which none can be left out, by itself or with its time in the next one.

    shows: what a run shows, up to the scan that shows it; None: nothing. longest: of a scan, in ms.
    """
    size = len(known.run.scans) // 2
    while size:
        first = 0
        while first + size < len(known.run.scans):  # the last scan stays
            found = _without(known, shows, longest, first, size)
            if found is None:
                first += size
            else:
                known = found
        size //= 2
    return known


def _without(
    known: T, shows: Callable[[Run], T | None], longest: int | None, first: int, size: int
) -> T | None:
    scans: Scans = list(known.run.scans)
    gone = sum(dt_ms for dt_ms, _ in scans[first : first + size])
    later, inputs = scans[first + size]
    for dt_ms in dict.fromkeys((later, later + gone)):
        if dt_ms <= (longest or dt_ms):
            left = [*scans[:first], (dt_ms, inputs), *scans[first + size + 1 :]]
            found = shows(Run(known.run.parameters, left, known.run.retained))
            if found is not None:
                return found
    return None


def shortened(binding: Binding, wrap: bool, difference: Difference) -> Difference:
    """A difference in scans of which none can be left out."""

    def shows(run: Run) -> Difference | None:
        found = replay(binding, wrap, run, difference.found_by)
        return None if found is None else replace(found, found_by=difference.found_by)

    return fewer(difference, shows, binding.longest_scan)
