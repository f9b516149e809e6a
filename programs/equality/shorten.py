"""Makes the scans of a difference fewer, by running parts of them again with plain values."""

from __future__ import annotations

from dataclasses import replace

from programs.equality.binding import Binding
from programs.equality.replay import Difference, Run, replay


def shortened(binding: Binding, wrap: bool, difference: Difference) -> Difference:
    """A difference in scans of which none can be left out, by itself or with its time in the next one."""
    size = len(difference.scans) // 2
    while size:
        first = 0
        while first + size < len(difference.scans):  # the last scan stays
            found = _without(binding, wrap, difference, first, size)
            if found is None:
                first += size
            else:
                difference = found
        size //= 2
    return difference


def _without(
    binding: Binding, wrap: bool, difference: Difference, first: int, size: int
) -> Difference | None:
    scans = list(difference.scans)
    gone = sum(dt_ms for dt_ms, _ in scans[first : first + size])
    later, inputs = scans[first + size]
    for dt_ms in dict.fromkeys((later, later + gone)):
        if dt_ms > (binding.longest_scan or dt_ms):
            continue
        fewer = [*scans[:first], (dt_ms, inputs), *scans[first + size + 1 :]]
        run = Run(difference.parameters, fewer, difference.run.retained)
        found = replay(binding, wrap, run, difference.found_by)
        if found is not None:
            return replace(found, found_by=difference.found_by)
    return None
