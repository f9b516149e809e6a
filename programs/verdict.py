"""The verdict on a program: PROVED equal, REFUTED by scans that were replayed, or UNKNOWN."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from programs.product import OUTPUTS, Owed, Product, shown
from programs.replay import Difference, Replayed, published, replay
from programs.search import way_to

LONGEST = 20
"""Scans of a counterexample that is searched for along the pairs."""
SEARCH_S = 60.0


@dataclass(frozen=True)
class Verdict:
    """What came out. `difference` belongs to REFUTED, `missing` to UNKNOWN."""

    word: Literal["PROVED", "REFUTED", "UNKNOWN"]
    product: Product
    replayed: Replayed | None = None
    difference: Difference | None = None
    missing: str = ""


def judge(product: Product, vectors: Path, seconds: float, tell: Callable[[str], None]) -> Verdict:
    """Replay the published vectors, find the pairs, show what is owed, and look for scans where that fails.

    seconds: limit of the search for pairs. Raises Unjudged for a vector file that cannot be read.
    """
    first = published(product, vectors)
    if isinstance(first, Difference):
        return Verdict("REFUTED", product, difference=first)
    tell(f"{first.cases} published vectors replayed, {first.scans:,} scans")
    try:
        product.fixpoint(first.samples, time.monotonic() + seconds, tell)
        doubts = list(product.doubts())
    except TimeoutError as error:
        return Verdict("UNKNOWN", product, first, missing=str(error))
    if not doubts:
        return Verdict("PROVED", product, first)
    for doubt in sorted(doubts, key=lambda one: (one.what != OUTPUTS, not one.place)):
        tell(f"not shown: {_words(doubt)}; looking for scans from power-up")
        found = _refuted(product, doubt)
        if found is not None:
            return Verdict("REFUTED", product, first, found)
    return Verdict("UNKNOWN", product, first, missing="not shown: " + "; ".join(map(_words, doubts[:3])))


def _words(doubt: Owed) -> str:
    return f"{doubt.place + ': ' if doubt.place else ''}{doubt.what} (pair {shown(doubt.pair)})"


def _refuted(product: Product, doubt: Owed) -> Difference | None:
    """Scans along the pairs that differ when they are replayed with plain values; None: not found."""
    try:
        way = way_to(product, doubt, LONGEST, SEARCH_S)
    except TimeoutError:
        return None
    if way is None:
        return None
    reference = product.binding.reference
    parameters = reference.plain("parameters", way[0]["parameters"])
    scans: list[tuple[int, dict[str, Any]]] = [
        (scan["dt_ms"], reference.plain("inputs", scan)) for scan in way
    ]
    return replay(product.binding, product.wrap, parameters, scans, "search along the pairs")
