"""Which reading a program has where it differs from the reference.

Where a document can be read in more than one way, a parameter of the reference implementation chooses, and a
finding says why. So the reference is asked what it would give with another value of one such parameter, and
with all values of the other profile: who answers every scan of a case so has that reading there.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from modeproof.kit.adapter import Program
from modeproof.kit.builtin import Builtin, own_reference
from modeproof.kit.errors import Unjudged
from modeproof.kit.relation import Session
from modeproof.kit.vectors import MONITOR, READINGS, SETTLED, Case, Suite
from modeproof.kit.verdict import DIFFERS, PROTOCOL, Difference, Plan, Verdict

LOOKING_S = 5.0
"""No case is put to a program once more after this time."""
TYPES = ("text", "bool")
"""Types of the parameters that choose between readings. A time is given by the machine."""


@dataclass(frozen=True)
class Reading:
    """Values of parameters other than those that the reference had; `names` say of which finding each is."""

    changed: Mapping[str, Any]
    findings: Mapping[str, str]
    profile: str = ""

    def __str__(self) -> str:
        parts = [
            f"{name} = {str(value).upper() if isinstance(value, bool) else value}"
            + (f" ({self.findings[name]})" if name in self.findings else "")
            for name, value in self.changed.items()
        ]
        return ", ".join(parts) + (f": the profile {self.profile}" if self.profile else "")


@dataclass(frozen=True)
class Tried:
    """What a reading gave: how many cases are as the reference has them then, and the first that is not."""

    reading: Reading
    cases: int
    wrong: str = ""


def readings(
    choices: Mapping[str, Sequence[Any]],
    given: Mapping[str, Any],
    findings: Mapping[str, str],
    profiles: Mapping[str, Mapping[str, Any]],
) -> list[Reading]:
    """The other readings of what was `given`: one change at a time, then the profiles that change more."""
    found = [
        Reading({name: value}, findings)
        for name, values in choices.items()
        for value in values
        if value != given[name]
    ]
    for profile, values in profiles.items():
        changed = {name: value for name, value in values.items() if name in given and value != given[name]}
        if len(changed) > 1:
            found.append(Reading(changed, findings, profile))
    return found


def in_words(agree: Sequence[Tried], tried: Sequence[Reading], open_here: Sequence[str] = ()) -> str:
    """What came out. agree: the readings that explain the difference, and what else was tried with them;
    tried: all of them; open_here: the findings at the step.
    """
    if not agree:
        return f"none that the reference can have: {_none(tried, open_here)}"
    whole = [one for one in agree if not one.wrong]
    whole = [one for one in whole if not one.reading.profile] or whole  # one change before many
    if len(whole) == 1:
        cases = "this case" if whole[0].cases == 1 else f"all {whole[0].cases:,} cases that were tried"
        return f"the program has the reading {whole[0].reading}: so the reference does the same in {cases}"
    if whole:
        either = ", or ".join(str(one.reading) for one in whole)
        return f"either {either}: the cases that were tried do not tell them apart"
    parts = ", or ".join(f"{one.reading} (but not in case {one.wrong})" for one in agree)
    return f"in this case the program has the reading {parts}"


def _none(tried: Sequence[Reading], open_here: Sequence[str]) -> str:
    """Which parameters were tried, and which findings at the step have none."""
    known = {name: one.findings.get(name, "") for one in tried for name in one.changed}
    names = [f"{name} ({id})" if id else name for name, id in known.items()]
    text = f"no other value of {', '.join(names)} explains it"
    others = [id for id in open_here if id not in known.values()]
    return f"{text}; what {', '.join(others)} leaves open is no parameter" if others else text


def find_readings(suite: Suite, start: Callable[[], Program], plan: Plan, verdict: Verdict) -> None:
    """Say of one difference of each likely cause which reading explains it. Nothing is raised for it.

    Nothing is said where cases are not to be run again (`plan.effort`), or nothing is compared.
    """
    if verdict.word != DIFFERS or verdict.relation == MONITOR or plan.effort <= 0:
        return
    search: _Search | None = None
    for _, differences in verdict.causes():
        found = differences[0]
        if found.step == PROTOCOL or not (found.findings or _choices(suite)):
            continue
        try:
            if not _choices(suite):
                raise Unjudged("nothing that the document leaves open is a parameter of the reference")
            search = search or _Search(suite, start, plan, verdict)
            said = search.said(found)
        except Unjudged as error:
            said = f"not tried: {error}"
        verdict.differences[verdict.differences.index(found)] = replace(found, reading=said)
    if search is not None:
        search.program.close()


def _choices(suite: Suite) -> dict[str, Sequence[Any]]:
    """The values of each parameter that chooses between readings."""
    rows = suite.parameters
    return {name: row.get("values", (False, True)) for name, row in rows.items() if row["type"] in TYPES}


class _Search:
    def __init__(self, suite: Suite, start: Callable[[], Program], plan: Plan, verdict: Verdict) -> None:
        self.suite, self.plan, self.verdict = suite, plan, verdict
        self.reference = own_reference(suite)
        self.program = start()
        self.session = Session(suite, self.program, plan.options)
        self.until = time.monotonic() + LOOKING_S
        self.known: dict[str, Tried] = {}

    def said(self, found: Difference) -> str:
        """What is said of a difference. Raises Unjudged where it cannot be tried."""
        if self.session.hello.real_time:
            raise Unjudged("the program runs in real time")
        if not found.case.reset:
            raise Unjudged("the case does not begin with a reset")
        tried = self._readings(found.case)
        agree = [one for one in tried if self._agrees(found.case, one)]
        return in_words([self._elsewhere(found, one) for one in agree], tried, found.findings)

    def _readings(self, case: Case) -> list[Reading]:
        choices = _choices(self.suite)
        defaults = {name: self.suite.parameters[name].get("default") for name in choices}
        given = {name: case.params.get(name, default) for name, default in defaults.items()}
        header = self.suite.header
        return readings(choices, given, header.get(READINGS, {}), header.get("profiles", {}))

    def _agrees(self, case: Case, reading: Reading) -> bool:
        """Whether the program answers a case as the reference does with this reading. May raise Unjudged."""
        if time.monotonic() > self.until:
            raise Unjudged("no time was left")
        try:
            scans = tuple(_expected(self.reference, case, reading, self.plan.options.relation == SETTLED))
        except _Unsettled:
            return False
        return self.session.case(replace(case, scans=scans)) is None

    def _elsewhere(self, found: Difference, reading: Reading) -> Tried:
        """The reading in the other cases that were judged, as far as there is time."""
        if str(reading) in self.known:
            return self.known[str(reading)]
        cases, wrong = 1, ""
        for case in self._judged(found):
            try:
                right = self._agrees(case, reading)
            except Unjudged:
                break
            if not right:
                wrong = case.id
                break
            cases += 1
        self.known[str(reading)] = Tried(reading, cases, wrong)
        return self.known[str(reading)]

    def _judged(self, found: Difference) -> Iterator[Case]:
        """The other cases that this run has judged."""
        if self.plan.only is not None:
            return
        passed, ids = set(self.verdict.passed), {one.case.id for one in self.verdict.differences}
        for number, case in enumerate(self.suite.cases()):
            judged = number in passed or case.id in ids
            if judged and case.id != found.case.id and case.reset and not case.requests:
                yield case


class _Unsettled(Exception):
    """With this reading the outputs have not settled where they are compared."""


def _expected(reference: Builtin, case: Case, reading: Reading, settled: bool) -> Iterator[Any]:
    """The scans of a case with what the reference gives with this reading. The program is told nothing of it:
    its parameters are those of the case.
    """
    reference.reset({**case.params, **reading.changed})
    for scan in case.scans:
        outputs = {**scan.outputs, **reference.scan(scan.dt_ms, scan.inputs)}
        if settled and scan.compared and not reference.at_rest(scan.inputs):
            raise _Unsettled
        yield replace(scan, outputs=outputs)
