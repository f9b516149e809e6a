"""Runs a suite against programs behind adapters, one or several at a time, and makes the verdict.

Where a case holds requests that protocol 1 forbids, the adapter must refuse them; one that does not is told
apart from a program that differs.
"""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable, Container, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from modeproof.kit.adapter import Program
from modeproof.kit.errors import Unjudged
from modeproof.kit.relation import Failure, Hello, Options, Session, read_hello
from modeproof.kit.shrink import Part, Shrinker, cut, read_part
from modeproof.kit.vectors import MONITOR, Case, Suite

__all__ = ["CONFORMS", "DIFFERS", "UNJUDGED", "Difference", "Hello", "Options", "Plan", "Verdict"]
__all__ += ["read_hello", "run_suite"]

CONFORMS, DIFFERS, UNJUDGED = "CONFORMS", "DIFFERS", "UNJUDGED"
EXIT = {CONFORMS: 0, DIFFERS: 1, UNJUDGED: 2}
PROTOCOL = "protocol"
"""Stands for the step where an adapter answered what it must refuse."""
SHRINKING_S = 5.0
"""No new attempt to make a case shorter begins after this time."""


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
    says whether it did so when it was run again.
    """

    case: Case
    scan: int
    step: str
    clauses: tuple[str, ...]
    findings: tuple[str, ...]
    expected: Mapping[str, Any]
    got: Mapping[str, Any]
    shortest: Case
    confirmed: bool
    when: str = ""
    part: str = ""
    broken: str = ""
    says: str = ""

    @property
    def cause(self) -> tuple[str, ...]:
        """What differences of one cause are likely to share: property or step, and the wrong outputs."""
        return (self.broken or self.step, *sorted(self.expected))


@dataclass
class Verdict:
    """The result of a run; `covered` counts for each step the transitions seen and all there are.

    `differences` holds one for each case that came out wrong, up to the number asked for; `properties` in how
    many scans each safety property was put to the program; `passed` the numbers of the cases that passed;
    `not_compared` the outputs left out because the document does not give their values.
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
    differences: list[Difference] = field(default_factory=list)
    first_difference_s: float | None = None
    passed: list[int] = field(default_factory=list)
    ids: dict[str, str] = field(default_factory=dict)
    reason: str = ""

    @property
    def status(self) -> int:
        """The exit status."""
        return EXIT[self.word]

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


Progress = Callable[[int, int], None]
"""Gets the scans done and all there are."""


def run_suite(
    suite: Suite,
    start: Callable[[], Program],
    *,
    only: str | None = None,
    plan: Plan | None = None,
    on_progress: Progress | None = None,
    on_difference: Callable[[Difference], None] | None = None,
    on_passed: Callable[[int], None] | None = None,
) -> Verdict:
    """Judge a program by a suite, or by the one case whose id is `only`.

    Whatever cannot be judged ends in the verdict UNJUDGED, with what was found so far; nothing is raised for
    it, and every program is closed. `on_difference` is called at once with the first one, before it is made
    shorter, `on_passed` with the number of each case that passed. An interruption from the keyboard is
    UNJUDGED too.
    """
    plan = plan or Plan(only=only)
    verdict = Verdict(UNJUDGED, suite.target, suite.name, plan.options.relation)
    verdict.cases_total = 1 if plan.only is not None else suite.case_count
    run = _Run(suite, verdict, plan, on_progress, on_difference)
    run.on_passed = on_passed
    began = time.monotonic()
    try:
        run.all(start)
    except KeyboardInterrupt:
        run.stop.set()
        verdict.word, verdict.reason = UNJUDGED, f"interrupted after {verdict.cases:,} cases"
    verdict.seconds = time.monotonic() - began
    run.finish()
    return verdict


class _Run:
    def __init__(
        self,
        suite: Suite,
        verdict: Verdict,
        plan: Plan,
        on_progress: Progress | None,
        on_difference: Callable[[Difference], None] | None,
    ) -> None:
        self.suite, self.verdict, self.plan = suite, verdict, plan
        self.on_progress, self.on_difference = on_progress, on_difference
        self.on_passed: Callable[[int], None] | None = None
        self.seen: list[set[tuple[int, int, int]]] = [set() for _ in suite.steps]
        self.lock = threading.Lock()
        self.stop = threading.Event()
        self.began = self.reported = time.monotonic()
        self.todo = self._todo()
        self.troubles: list[str] = []
        self.causes: set[tuple[str, ...]] = set()

    def _todo(self) -> Iterator[tuple[int, Case]]:
        plan, found = self.plan, False
        for number, case in enumerate(self.suite.cases()):
            if plan.only is not None:
                if case.id != plan.only:
                    continue
                found = True
                if plan.part is not None:
                    case = cut(self.suite, case, read_part(plan.part, case))
            if number in plan.skip:
                self._passed(number, case)
            else:
                yield number, case
        if plan.only is not None and not found:
            raise Unjudged(f"no case with the id {plan.only}")

    def _next(self) -> tuple[int, Case] | None:
        with self.lock:
            return None if self.stop.is_set() else next(self.todo, None)

    def all(self, start: Callable[[], Program]) -> None:
        """Run all cases; the verdict has its word then."""
        verdict = self.verdict
        if self.plan.jobs <= 1:
            self._work(start)
        else:
            threads = [
                threading.Thread(target=self._work, args=(start,), daemon=True) for _ in range(self.plan.jobs)
            ]
            for thread in threads:
                thread.start()
            try:
                for thread in threads:
                    while thread.is_alive():
                        thread.join(0.2)
            except KeyboardInterrupt:
                self.stop.set()
                for thread in threads:
                    thread.join()
                raise
        if self.troubles:
            verdict.word, verdict.reason = UNJUDGED, self.troubles[0]
        elif verdict.differences:
            verdict.word = DIFFERS
            if all(difference.step == PROTOCOL for difference in verdict.differences):
                verdict.reason = (
                    "the adapter answers a request that protocol 1 tells it to refuse; "
                    "this says nothing about the program behind it"
                )
        elif verdict.cases == 0:
            verdict.reason = "no case was run"
        else:
            verdict.word = CONFORMS

    def _work(self, start: Callable[[], Program]) -> None:
        """Take cases until none is left, or something ends it all."""
        session: Session | None = None
        program: Program | None = None
        try:
            program = start()
            try:
                session = _open(self.suite, program, self.plan.options)
                self._greet(session)
                while (one := self._next()) is not None:
                    self._case(session, *one)
                if not self.stop.is_set():
                    session.end()
            finally:
                self._account(session)
                program.close()
        except Unjudged as error:
            place = session.place if session is not None and program is not None else ""
            self.stop.set()
            self.troubles.append(f"{place}: {error}" if place else str(error))

    def _greet(self, session: Session) -> None:
        verdict, hello = self.verdict, session.hello
        with self.lock:
            verdict.adapter = f"{hello.name} {hello.version}".strip()
            verdict.unobserved = hello.unobserved
            verdict.not_compared = session.not_compared
            verdict.latency = session.latency
            if session.watch is not None:
                verdict.unjudged = session.watch.unjudged

    def _account(self, session: Session | None) -> None:
        if session is None or session.watch is None:
            return
        with self.lock:
            for name, count in session.watch.counts.items():
                self.verdict.properties[name] = self.verdict.properties.get(name, 0) + count

    def _case(self, session: Session, number: int, case: Case) -> None:
        before = session.scans
        try:
            failure = session.case(case)
        finally:
            with self.lock:
                self.verdict.scans += session.scans - before
        if failure is None:
            with self.lock:
                self._passed(number, case)
                self._tell()
            if self.on_passed is not None:
                self.on_passed(number)
            return
        found = _difference(self.suite, case, failure)
        if found.cause not in self.causes:  # an answer too many would make anything look wrong
            session.quiet()
        with self.lock:
            new = found.cause not in self.causes
            self.causes.add(found.cause)
            first = self.verdict.first_difference_s is None
            if first:
                self.verdict.first_difference_s = time.monotonic() - self.began
            if len(self.verdict.differences) >= self.plan.most:
                return
            at = len(self.verdict.differences)
            self.verdict.differences.append(found)
            self.verdict.ids[case.id] = "differs"
            if len(self.verdict.differences) >= self.plan.most:
                self.stop.set()
        if first and self.on_difference is not None:
            self.on_difference(found)
        if new:
            found = _shrunk(self.suite, session, found, failure, self.plan)
            with self.lock:
                self.verdict.differences[at] = found

    def _passed(self, number: int, case: Case) -> None:
        self.verdict.cases += 1
        self.verdict.passed.append(number)
        self.verdict.ids[case.id] = "passed"
        by_column = self.suite.header.get("counted_by") == "column"
        before = case.initial
        for scan in case.scans:
            if scan.request is None:
                self.seen[scan.step].add((case.graph, before, scan.column if by_column else scan.to))
                before = scan.to

    def _tell(self) -> None:
        now = time.monotonic()
        if self.on_progress is not None and now - self.reported >= 0.5:
            self.reported = now
            self.on_progress(self.verdict.scans, self.suite.scan_count)

    def finish(self) -> None:
        """Work out what was covered."""
        seen: Counter[str] = Counter()
        total: Counter[str] = Counter()
        clauses: dict[str, tuple[int, int]] = {}
        for step, pairs in zip(self.suite.steps, self.seen, strict=True):
            seen[step.name] += len(pairs)
            total[step.name] += step.transitions
            for clause in step.clauses:
                have, all_ = clauses.get(clause, (0, 0))
                clauses[clause] = (have + len(pairs), all_ + step.transitions)
        self.verdict.covered = {name: (seen[name], count) for name, count in total.items()}
        self.verdict.clauses = dict(sorted(clauses.items()))


def _open(suite: Suite, program: Program, options: Options) -> Session:
    try:
        return Session(suite, program, options)
    except Unjudged as error:
        raise Unjudged(f"hello: {error}") from None


def _difference(suite: Suite, case: Case, failure: Failure) -> Difference:
    """A failure in words; its shortest case is its beginning as yet."""
    scan = case.scans[failure.at]
    steps = [
        suite.steps[n] for n in dict.fromkeys(s.step for s in case.scans[failure.first : failure.at + 1])
    ]
    name = " > ".join(step.name for step in steps)
    clauses = tuple(sorted({clause for step in steps for clause in step.clauses}))
    findings = tuple(sorted({finding for step in steps for finding in step.findings}))
    if scan.request is not None:
        name, clauses, findings = PROTOCOL, (), ()
    broken = failure.broken
    part = Part(tuple(range(failure.at + 1)))
    return Difference(
        case=case,
        scan=failure.at + 1,
        step=name,
        clauses=broken.clauses if broken is not None else clauses,
        findings=findings if broken is None else (),
        expected=failure.expected,
        got=failure.got,
        shortest=cut(suite, case, part),
        confirmed=False,
        when=failure.when,
        part=str(part),
        broken=broken.id if broken is not None else "",
        says=broken.says if broken is not None else "",
    )


def _shrunk(suite: Suite, session: Session, found: Difference, failure: Failure, plan: Plan) -> Difference:
    """The difference with a shorter case, as far as `effort` and time go. May raise Unjudged."""
    left, ends = plan.effort, time.monotonic() + SHRINKING_S

    def fails(case: Case) -> bool:
        nonlocal left
        if left <= 0 or time.monotonic() > ends:
            raise StopIteration
        left -= 1
        scans = session.scans
        again = session.case(case)
        session.scans = scans
        return again is not None

    if found.step == PROTOCOL:
        return _with(suite, found, Part(tuple(range(found.scan))), True)
    whole = Part(tuple(range(found.scan)))
    if plan.part is not None or plan.effort <= 0:
        return _with(suite, found, whole, True)
    anything = plan.options.relation == MONITOR
    best = Shrinker(suite, found.case, failure.at, fails, anything).run()
    confirmed = best != whole
    if not confirmed:
        left, ends = 1, time.monotonic() + SHRINKING_S
        confirmed = fails(cut(suite, found.case, whole))
    session.quiet()
    return _with(suite, found, best, confirmed)


def _with(suite: Suite, found: Difference, part: Part, confirmed: bool) -> Difference:
    values = {name: getattr(found, name) for name in Difference.__dataclass_fields__}
    values |= {"shortest": cut(suite, found.case, part), "confirmed": confirmed, "part": str(part)}
    return Difference(**values)
