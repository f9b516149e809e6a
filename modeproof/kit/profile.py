"""The cases of a suite that speak of one profile: a named set of values of the parameters that choose.

`letter` is what the document says, in its order; `cautious` is what the project recommends where that is
something else. A program that follows its page has no parameter for a choice. So the cases of the letter send
none: their values are the defaults. A time that chooses is in the letter with its default, and with any
other value in the cautious profile: the machine gives it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

from modeproof.kit.errors import Unjudged
from modeproof.kit.vectors import Case, Suite

LETTER, CAUTIOUS, ALL = "letter", "cautious", "all"
PROFILES = (LETTER, CAUTIOUS, ALL)
"""`all`: the cases of both, and those that mix them, for a program that takes each choice as a parameter."""


@dataclass(frozen=True)
class OfProfile(Suite):
    """The part of a suite that speaks of one profile."""

    whole: Suite | None = None
    profile: str = ""
    values: Mapping[str, Any] = field(default_factory=dict)

    def cases(self) -> Iterator[Case]:
        """Those of the suite in which every choice is that of the profile; what is a default is not sent."""
        assert self.whole is not None
        defaults = {name: row.get("default") for name, row in self.parameters.items()}
        for case in self.whole.cases():
            given = {**defaults, **case.params}
            if all(self._has(name, given[name]) for name in self.values):
                unsent = {name for name, value in self.values.items() if value == defaults[name]}
                params = {name: value for name, value in case.params.items() if name not in unsent}
                yield replace(case, params=params)

    def _has(self, name: str, value: Any) -> bool:
        """Whether the value of a choice is that of the profile."""
        row, wanted = self.parameters[name], self.values[name]
        if row.get("type") == "ms" and wanted != row.get("default"):
            return bool(value != row.get("default"))
        return bool(value == wanted)


def of_profile(suite: Suite, profile: str) -> Suite | None:
    """The part of a suite that speaks of a profile, counted; None where it has no case of it.

    A suite of a target without profiles is left as it is. Raises Unjudged as reading a suite does.
    """
    table = suite.header.get("profiles", {})
    if profile == ALL or not table:
        return suite
    if not isinstance(table, dict) or not isinstance(table.get(profile), dict):
        raise Unjudged(f"{suite.path.name}: header: it has no profile {profile}")
    values = {one.name: getattr(suite, one.name) for one in fields(Suite)}
    part = OfProfile(**values, whole=suite, profile=profile, values=table[profile])
    if strange := [name for name in part.values if name not in suite.parameters]:
        raise Unjudged(f"{suite.path.name}: header: profile {profile}: no parameter {strange[0]}")
    cases, scans, seen = 0, 0, set()
    by_column = suite.header.get("counted_by") == "column"
    for case in part.cases():
        cases, before = cases + 1, case.initial
        for scan in case.scans:
            if scan.request is None:
                scans += 1
                seen.add((case.graph, before, scan.step, scan.column if by_column else scan.to))
                before = scan.to
    if not cases:
        return None
    taken = Counter(step for _, _, step, _ in seen)
    steps = tuple(replace(step, transitions=taken[n]) for n, step in enumerate(suite.steps))
    return replace(part, case_count=cases, scan_count=scans, steps=steps)
