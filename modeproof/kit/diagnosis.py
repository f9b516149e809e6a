"""What leads from a difference to its cause: states and steps on the way, what nobody saw, and the time."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from modeproof.kit.relation import Failure
from modeproof.kit.vectors import Case, Scan, Suite
from modeproof.kit.verdict import Difference

_NAME = re.compile(r'"(\w+)"')
LONGEST_MS = 1 << 17
"""A program is asked whether it is up to so much too late."""


def state_name(suite: Suite, case: Case, state: int) -> str:
    """What the specification calls a state: its control state, or the whole of what identifies it."""
    views = suite.header["graphs"][case.graph]["views"]
    view = str(views[state]) if 0 <= state < len(views) else ""
    found = _NAME.search(view)
    return found[1] if found else view


def step_there(suite: Suite, case: Case, at: int) -> str:
    """Which step leads from which state to which in a scan of the case; `at` counts from 0.

    Nothing where the specification's state is not known.
    """
    scan = case.scans[at]
    if scan.to < 0:
        return ""
    before = case.scans[at - 1].to if at else case.initial
    states = [state_name(suite, case, state) for state in (before, scan.to)]
    where = states[0] if states[0] == states[1] else " to ".join(states)
    return f"{suite.steps[scan.step].name}, in {where}" if where else suite.steps[scan.step].name


def unseen(suite: Suite, found: Difference) -> tuple[str, ...]:
    """The steps since an output last changed as expected: no output shows whether the program took them."""
    scans, at = found.case.scans, found.scan - 1
    first = at
    while first and scans[first - 1].request is None and not _shows(scans, first - 1):
        first -= 1
    names = [suite.steps[scans[n].step].name for n in range(max(0, first - 1), at) if scans[n].to >= 0]
    return tuple(name for name in dict.fromkeys(names) if name not in found.step.split(" > "))


def _shows(scans: tuple[Scan, ...], at: int) -> bool:
    return at == 0 or scans[at].outputs != scans[at - 1].outputs


def timing(case: Case, failure: Failure, judged: Callable[[Case], Failure | None]) -> str:
    """Whether the last scan of the case is right at another time: so many scans or ms too late or too early.

    `judged` runs a case, and raises StopIteration where there is no time left for it. Nothing where time does
    not explain the difference, or the case fails before its end.
    """
    *way, last = case.scans
    before = way[-1].outputs if way else {}
    if failure.at != len(way) or not way or not {*failure.got, *failure.expected} <= set(before):
        return ""  # also when a request was not refused: then nothing is compared with outputs
    stands = all(failure.got[name] == before[name] for name in failure.got)
    waits = all(failure.expected[name] == before[name] for name in failure.expected)

    def right(more_ms: int) -> bool:
        scans = (*way, replace(last, dt_ms=last.dt_ms + more_ms))
        return judged(replace(case, scans=scans)) is None

    try:
        if stands:
            again = (*way, replace(last, compared=False), replace(last, dt_ms=0))
            if judged(replace(case, scans=again)) is None:
                return "it comes one scan late"
            if late := _least(right, LONGEST_MS):
                return f"it comes {late:,} ms late"
        elif waits and last.dt_ms and (early := _least(lambda ms: right(-ms), last.dt_ms)):
            return f"it comes {early:,} ms early"
    except StopIteration:
        pass
    return ""


def _least(right: Callable[[int], bool], most: int) -> int:
    """The least number from 1 to `most` that is right, if larger ones are too; 0 where none is found."""
    wrong, good = 0, 1
    while not right(good):
        if good == most:
            return 0
        wrong, good = good, min(2 * good, most)
    while good - wrong > 1:
        middle = (wrong + good) // 2
        wrong, good = (wrong, middle) if right(middle) else (middle, good)
    return good
