"""The verdict on a program: PROVED equal, REFUTED by scans that were replayed, or UNKNOWN."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from programs.equality.fixpoint import Search, prune
from programs.equality.product import OUTPUTS, Owed, Product, shown
from programs.equality.replay import Difference, Replayed, published, replay, run_of
from programs.equality.shorten import shortened
from programs.equality.shortest_path import shortest, through
from programs.semantics.terms import names_in

LONGEST = 24
"""Scans of a counterexample that is searched for along the pairs."""
SHALLOW = 0.3
"""Part of the time of a search in which the shortest is looked for."""
FIRST_S, SEARCH_S = 20.0, 60.0
"""For the search before other control variables are tried, and for the one after that."""
MOST_SPLIT = 6
"""BOOL variables that are made control variables at once."""
Tell = Callable[[str], None]


@dataclass(frozen=True)
class Verdict:
    """What came out. `difference` belongs to REFUTED, with the `reading` that explains it, `missing` to
    UNKNOWN.
    """

    word: Literal["PROVED", "REFUTED", "UNKNOWN"]
    product: Product
    replayed: Replayed | None = None
    difference: Difference | None = None
    missing: str = ""
    reading: str = ""


def judge(product: Product, vectors: Path, seconds: float, tell: Tell, fewest: bool = True) -> Verdict:
    """Replay the published vectors, find the pairs, show what is owed, and look for scans where that fails.

    seconds: limit of the search for pairs. fewest: search for fewer scans where a vector shows a difference;
    else scans are only left out. Raises Unjudged for a vector file that cannot be read.
    """
    first = published(product.binding, product.wrap, vectors)
    return judge_after(product, first, seconds, tell, fewest)


def judge_after(
    product: Product, first: Difference | Replayed, seconds: float, tell: Tell, fewest: bool = True
) -> Verdict:
    """The same, after scans that were run on both: a difference, or what was met."""
    if isinstance(first, Difference):
        return Verdict("REFUTED", product, difference=_fewest(product, first, seconds, tell, fewest))
    tell(f"{first.cases} runs replayed, {first.scans:,} scans")
    try:
        doubts = _doubts(product, first, seconds, tell)
        if doubts and (found := _refuted(product, doubts, first, FIRST_S, tell)):
            return Verdict("REFUTED", product, first, found)
        if doubts and (flags := _flags(product, doubts)):
            finer = replace(product, split=flags, nodes={})
            if not (left := _doubts(finer, first, seconds, tell)):
                product, doubts = finer, left
    except TimeoutError as error:
        return Verdict("UNKNOWN", product, first, missing=str(error))
    if not doubts:
        return Verdict("PROVED", product, first)
    if found := _refuted(product, doubts, first, SEARCH_S, tell):
        return Verdict("REFUTED", product, first, found)
    return Verdict("UNKNOWN", product, first, missing="not shown: " + "; ".join(map(_words, doubts[:3])))


def _fewest(product: Product, known: Difference, seconds: float, tell: Tell, search: bool) -> Difference:
    """A difference in the fewest scans that are found: by leaving some out, then by the search."""
    known = shortened(product.binding, product.wrap, known)
    if not search:
        return known
    try:
        Search(product, {}, time.process_time() + min(seconds, SEARCH_S), tell).run()
        doubts = list(product.doubts())
        way = shortest(product, doubts, len(known.scans) - 1, FIRST_S)
    except TimeoutError:
        return known
    if way is None:
        return known
    run = run_of(product, way)
    found = replay(product.binding, product.wrap, run, f"{known.found_by}, made shorter by the search")
    return known if found is None else found


def _doubts(product: Product, replayed: Replayed, seconds: float, tell: Tell) -> list[Owed]:
    """What cannot be shown; if that is nothing, only the relations are kept that the proof needs."""
    Search(product, replayed.samples(product), time.process_time() + seconds, tell).run()
    doubts = list(product.doubts())
    if not doubts:
        prune(product)
        doubts = list(product.doubts())
    return sorted(doubts, key=lambda doubt: (doubt.what != OUTPUTS, not doubt.place))


def _flags(product: Product, doubts: Sequence[Owed]) -> tuple[str, ...]:
    """BOOL variables that may tell states apart: read before they are written, free in a doubtful pair."""
    scan = product.translated
    read = names_in([*scan.after.values(), *scan.outputs.values()])
    fixed = {
        relation.left
        for doubt in doubts
        for relation in product.nodes[doubt.pair].relations
        if relation.kind in ("constant", "equal", "unequal")
    }
    found = [
        path
        for path, slot in product.slots.items()
        if slot.type.kind == "bool" and slot.initial is not None and path not in product.control
        if f"p.{path}" in read and f"p:{path}" not in fixed and slot.section != "input"
    ]
    return tuple(found[:MOST_SPLIT])


def _words(doubt: Owed) -> str:
    return f"{doubt.place + ': ' if doubt.place else ''}{doubt.what} (pair {shown(doubt.pair)})"


def _refuted(
    product: Product, doubts: Sequence[Owed], replayed: Replayed, seconds: float, tell: Tell
) -> Difference | None:
    """Scans along the pairs that differ when they are replayed with plain values; None: not found."""
    tell(f"not shown: {_words(doubts[0])}; looking for scans from power-up")
    try:
        way = shortest(product, doubts, LONGEST, SHALLOW * seconds)
        fewest = way is not None
        if way is None:
            way = through(product, doubts, replayed.routes(product), LONGEST, (1 - SHALLOW) * seconds)
    except TimeoutError:
        return None
    if way is None:
        return None
    found = replay(product.binding, product.wrap, run_of(product, way), "search along the pairs")
    return found if found is None or fewest else shortened(product.binding, product.wrap, found)
