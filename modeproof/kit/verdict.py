"""What a run is asked for and what it gives: the plan, a difference, the verdict."""

from __future__ import annotations

import json
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from modeproof.kit.errors import plain
from modeproof.kit.relation import Options
from modeproof.kit.vectors import Case

FOLLOWS, BREAKS = "FOLLOWS", "BREAKS"
"""A program and what its document demands."""
CONFORMS, DIFFERS, UNJUDGED = "CONFORMS", "DIFFERS", "UNJUDGED"
"""A program and the reference implementation."""
EXIT = {FOLLOWS: 0, BREAKS: 1, CONFORMS: 0, DIFFERS: 1, UNJUDGED: 2}
PROTOCOL = "protocol"
"""Stands for the step where an adapter answered what it must refuse."""
MOST_TOLD = 3
"""Outputs that a difference names in one line."""
LONGEST_REASON = 400
"""Characters of that line."""


@dataclass(frozen=True)
class Plan:
    """What is run: the `options`, one case (`only`) or a part of it (`part`), how many programs at once
    (`jobs`).

    After `most` differing cases it ends. `effort` is how often a case may be run again to find a shorter one.
    Cases whose number (from 0) is in `skip` passed in an earlier run.
    """

    options: Options = field(default_factory=Options)
    only: str | None = None
    part: str | None = None
    jobs: int = 1
    most: int = 1
    effort: int = 2
    skip: Container[int] = ()


@dataclass(frozen=True)
class Difference:
    """The first wrong scan of a case. `scan` counts from 1; `expected` and `got` hold what differs only.

    `part` names the scans of `shortest`, the shortest part that was found to show a difference; `confirmed`
    says whether it did so when it was run again, and is None where it was not run again.
    `time` says how much too late or too early the last scan of `shortest` is, where that explains it;
    `reading` which reading of a finding the program has there.
    """

    case: Case
    scan: int
    step: str
    clauses: tuple[str, ...]
    findings: tuple[str, ...]
    expected: Mapping[str, Any]
    got: Mapping[str, Any]
    shortest: Case
    confirmed: bool | None
    when: str = ""
    part: str = ""
    broken: str = ""
    says: str = ""
    time: str = ""
    reading: str = ""

    @property
    def cause(self) -> tuple[str, ...]:
        """What differences of one cause are likely to share: property or step, and the wrong outputs."""
        return (self.broken or self.step, *sorted(self.expected))

    @property
    def in_a_line(self) -> str:
        """Where the first wrong scan is, and what is wrong there."""
        wrong = [
            f"{name} is {json.dumps(self.got.get(name, self.got))}"
            + ("" if self.broken else f", expected {json.dumps(wanted)}")
            for name, wanted in self.expected.items()
        ]
        more = f", and {len(wrong) - MOST_TOLD} more" if len(wrong) > MOST_TOLD else ""
        about = f"breaks {self.broken}" if self.broken else self.step
        where = f"case {self.case.id}, scan {self.scan} ({about})"
        return plain(f"{where}: {'; '.join(wrong[:MOST_TOLD])}{more}", LONGEST_REASON)


@dataclass
class Verdict:
    """The result of a run; `covered` counts for each step the transitions seen and all there are.

    `differences` holds one for each case that came out wrong, up to the number asked for; `properties` in how
    many scans each safety property was put to the program; `passed` the numbers of the cases that passed;
    `not_compared` the outputs left out because the document does not give their values. `only` says which
    part of the suite was asked for, if not all of it; `profile` whose choices it is about, where the target
    has profiles; `params` which parameters were given; `compared` counts the scans whose outputs were
    compared and the requests that were refused, `outputs` the outputs that were compared and all; `earlier`
    cases passed in an earlier run. A transition is covered only if a compared output shows it. `page` is what
    the same cases say of the demands of the document, `same` whether equality with the reference was asked
    for besides; `constant` the inputs that were held because the document calls them constant.
    """

    word: str
    target: str
    suite: str
    relation: str
    cases: int = 0
    cases_total: int = 0
    scans: int = 0
    seconds: float = 0.0
    adapter: str = ""
    unobserved: tuple[str, ...] = ()
    not_compared: tuple[str, ...] = ()
    latency: int = 0
    covered: dict[str, tuple[int, int]] = field(default_factory=dict)
    clauses: dict[str, tuple[int, int]] = field(default_factory=dict)
    properties: dict[str, int] = field(default_factory=dict)
    unjudged: tuple[str, ...] = ()
    only: str = ""
    profile: str = ""
    params: tuple[str, ...] = ()
    compared: int = 0
    outputs: tuple[int, int] = (0, 0)
    earlier: int = 0
    interrupted: bool = False
    differences: list[Difference] = field(default_factory=list)
    first_difference_s: float | None = None
    passed: list[int] = field(default_factory=list)
    ids: dict[str, str] = field(default_factory=dict)
    reason: str = ""
    page: Verdict | None = None
    same: bool = False
    constant: tuple[str, ...] = ()

    @property
    def judged(self) -> Sequence[Verdict]:
        """What the exit status depends on: the page, where it could be judged, and the reference where that
        was asked for, or where the page says nothing of this suite.
        """
        if self.page is None or (self.page.word == UNJUDGED and not self.page.interrupted):
            return (self,)
        return (self.page, self) if self.same else (self.page,)

    @property
    def status(self) -> int:
        """The exit status."""
        return max(EXIT[verdict.word] for verdict in self.judged)

    @property
    def transitions(self) -> tuple[int, int]:
        """The transitions that were seen, and all."""
        return sum(have for have, _ in self.covered.values()), sum(all_ for _, all_ in self.covered.values())

    @property
    def difference(self) -> Difference | None:
        """The first difference, if there is one."""
        return self.differences[0] if self.differences else None

    def causes(self) -> list[tuple[tuple[str, ...], list[Difference]]]:
        """The differences grouped by likely cause, the largest group first."""
        found: dict[tuple[str, ...], list[Difference]] = {}
        for difference in self.differences:
            found.setdefault(difference.cause, []).append(difference)
        return sorted(found.items(), key=lambda item: -len(item[1]))
