"""A difference from the reference in scans in which what the page calls constant does not change."""

from __future__ import annotations

import time
from pathlib import Path

from programs.demands.assumptions import Assumed
from programs.equality.product import Product
from programs.equality.replay import Difference, published_runs, replay
from programs.equality.shorten import shortened

LOOKING_S = 5.0
"""CPU seconds; no run is begun after this time."""


def changing(assumed: Assumed, found: Difference) -> list[str]:
    """The inputs that the page calls constant and that change in the scans of a difference."""
    rows = [inputs for _, inputs in found.scans]
    return [name for name in assumed.by_page if any(row[name] != rows[0][name] for row in rows)]


def steady_difference(assumed: Assumed, product: Product, known: Difference, vectors: Path) -> Difference:
    """Such a difference: in the scans of the known one, else in a published vector; else the known one, which
    `changing` then names. Raises Unjudged as reading vectors does.
    """
    if not changing(assumed, known):
        return known
    until = time.process_time() + LOOKING_S
    runs = [(known.found_by, known.run)]
    for where, run in (*runs, *published_runs(product.binding, vectors)):
        if time.process_time() > until:
            break
        if found := replay(product.binding, product.wrap, assumed.steadied(run), where):
            return shortened(product.binding, product.wrap, found)
    return known
