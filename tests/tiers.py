"""The two tiers of tests: `make test` runs the first, `make test-deep` the second.

A test marked `deep` is of the second tier. Of a test marked `sampled(n)` every n-th case, beginning with the
first, is of the first tier and all other cases are of the second; without n the first case alone.
A test or case marked `long` is of the second tier and runs only where MODEPROOF_LONG is set: it is one more
of a kind that the second tier has seen, or takes a minute and more.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable

import pytest


def divide(items: Iterable[pytest.Item]) -> None:
    """Mark the cases of sampled tests that are of the second tier.

    Raises pytest.UsageError for a mark that names no positive number.
    """
    cases: Counter[str] = Counter()
    for item in items:
        if item.get_closest_marker("long"):
            item.add_marker(pytest.mark.deep)
            if "MODEPROOF_LONG" not in os.environ:
                item.add_marker(pytest.mark.skip(reason="long: MODEPROOF_LONG=1 make test-deep"))
        mark = item.get_closest_marker("sampled")
        if mark is None:
            continue
        every = mark.args[0] if mark.args else None
        if every is not None and (not isinstance(every, int) or every < 1):
            raise pytest.UsageError(f"{item.nodeid}: sampled takes a number of 1 or more, not {every!r}")
        test = item.nodeid.partition("[")[0]
        place, cases[test] = cases[test], cases[test] + 1
        if place % every if every is not None else place:
            item.add_marker(pytest.mark.deep)
