"""Makes a case that shows a difference shorter, by running parts of it again.

A part begins in the power-up state, with a shortest way that the header knows to the state after some scan
(written `~17`), or with the first scan; the scans that follow (`18-20,25`) go on where the specification is
in the same state. The graph counts time in ticks, so the same state need not be the same time: before a part
is tried, the reference implementation must give all that the part expects. Without it scans are left out only
where the header knows a way to each state, for then all times are those of the graph. Where only safety
properties are judged any scans may be left out, since nothing is expected; so they may of a whole machine,
for its reference says anew what to expect.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace

from modeproof.kit.errors import Unjudged
from modeproof.kit.machine_reference import expected
from modeproof.kit.vectors import WIRING, Case, Scan, Suite, case_id, changes

_PART = re.compile(r"~?\d+|\d+-\d+")


@dataclass(frozen=True)
class Part:
    """Scans of a case by their numbers from 0, after a shortest way to where scan `way` leaves off.

    `way` is None when the part begins with scans of the case itself.
    """

    kept: tuple[int, ...]
    way: int | None = None

    def __str__(self) -> str:
        spans: list[list[int]] = []
        for n in self.kept:
            if spans and spans[-1][1] == n - 1:
                spans[-1][1] = n
            else:
                spans.append([n, n])
        words = [] if self.way is None else [f"~{self.way + 1}"]
        words += [f"{a + 1}" if a == b else f"{a + 1}-{b + 1}" for a, b in spans]
        return ",".join(words)


def read_part(text: str, case: Case) -> Part:
    """What `str` of a part gives, read again. Raises Unjudged for what is not a part of this case."""
    kept: list[int] = []
    way = None
    for n, word in enumerate(text.replace(" ", "").split(",")):
        if not _PART.fullmatch(word) or (word[0] == "~" and n):
            raise Unjudged(f"--scans: {word!r} is not a number, a span, or ~number at the beginning")
        if word[0] == "~":
            way = int(word[1:]) - 1
            continue
        first, _, last = word.partition("-")
        kept += range(int(first) - 1, min(int(last or first), len(case.scans) + 1))
    if not kept or kept != sorted(set(kept)) or not 0 <= kept[0] <= kept[-1] < len(case.scans):
        raise Unjudged(f"--scans: ascending numbers of 1 to {len(case.scans)} expected: {text}")
    if way is not None and not 0 <= way < len(case.scans):
        raise Unjudged(f"--scans: ~{way + 1} is no scan of the case")
    return Part(tuple(kept), way)


def cut(suite: Suite, case: Case, part: Part) -> Case:
    """The case of a part. Raises Unjudged where the suite knows no ways."""
    scans: tuple[Scan, ...] = tuple(case.scans[n] for n in part.kept)
    if part.way is not None:
        scans = (*suite.way(case, case.scans[part.way].to), *scans)
    if scans == case.scans:
        return case
    if WIRING in suite.header and part.kept[-1] + 1 != len(part.kept):
        scans = expected(suite, scans)
    return replace(
        case,
        id=case_id(suite.target, case.params, changes(scans)),
        why=f"scans {part} of {case.id}",
        scans=scans,
    )


class Shrinker:
    """Looks for a short part that still fails. `fails` runs one and says whether it does.

    `right` runs one by the reference implementation and says whether that gives what the part expects.
    """

    def __init__(
        self,
        suite: Suite,
        case: Case,
        at: int,
        fails: Callable[[Case], bool],
        right: Callable[[Case], bool] | None = None,
        anything: bool = False,
    ) -> None:
        self.suite, self.case, self.at = suite, case, at
        self._fails, self._right, self._anything = fails, right, anything
        self.best = Part(tuple(range(at + 1)))

    def run(self) -> Part:
        """The shortest part found before `fails` raises StopIteration. Raises what it raises else."""
        try:
            if self._anything:
                self._drop_anything()
            else:
                self._begin_late()
                if self._right is not None or self.suite.has_ways(self.case):
                    self._cut_loops()
        except StopIteration:
            pass
        return self.best

    def _try(self, part: Part) -> bool:
        case = cut(self.suite, self.case, part)
        expects = self._anything or self._right is None or self._right(case)
        if expects and self._fails(case):
            self.best = part
            return True
        return False

    def _begin_late(self) -> None:
        """A shortest way to the state before one of the last scans, and then those."""
        if not self.suite.has_ways(self.case):
            return
        back = 0
        while back < self.at:
            first = self.at - back
            if self._try(Part(tuple(range(first, self.at + 1)), first - 1)):
                return
            back = max(1, back * 2)

    def _cut_loops(self) -> None:
        """Leave out scans that lead back to a state where the specification was before, long ones first."""
        first = 0
        while first < len(self.best.kept) - 1:
            kept = self.best.kept
            start = self._before(first)
            for last in range(len(kept) - 2, first - 1, -1):
                if self._ends(kept[last]) and self.case.scans[kept[last]].to == start:
                    shorter = (*kept[:first], *kept[last + 1 :])
                    if self._try(Part(shorter, self.best.way)):
                        break
            else:
                first += 1

    def _before(self, position: int) -> int | None:
        """The state before a kept scan; None where a part may not go on, between settling scans."""
        if position:
            number = self.best.kept[position - 1]
            return self.case.scans[number].to if self._ends(number) else None
        return self.case.initial if self.best.way is None else self.case.scans[self.best.way].to

    def _ends(self, number: int) -> bool:
        return self.case.scans[number].compared

    def _drop_anything(self) -> None:
        """Leave out ever smaller pieces, as long as what is left fails."""
        size = len(self.best.kept) // 2
        while size:
            at = 0
            while at + size < len(self.best.kept):
                kept = self.best.kept
                if not self._try(Part((*kept[:at], *kept[at + size :]))):
                    at += size
            size //= 2
