"""Runs a suite against programs behind adapters, one or several at a time, and makes the verdict.

Where a case holds requests that protocol 1 forbids, the adapter must refuse them; one that does not is told
apart from a program that differs.
"""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace

from modeproof.kit.adapter import Program
from modeproof.kit.builtin import reference
from modeproof.kit.demands import Watch
from modeproof.kit.diagnosis import timing
from modeproof.kit.errors import Unjudged, suggestion
from modeproof.kit.hello import Hello, read_hello
from modeproof.kit.relation import Failure, Options, Session
from modeproof.kit.shrink import Part, Shrinker, cut, read_part
from modeproof.kit.vectors import EXACT, MONITOR, WIRING, Case, Scan, Suite
from modeproof.kit.verdict import (
    BREAKS,
    CONFORMS,
    DIFFERS,
    EXIT,
    FOLLOWS,
    PROTOCOL,
    UNJUDGED,
    Difference,
    Plan,
    Verdict,
)

__all__ = ["CONFORMS", "DIFFERS", "EXIT", "UNJUDGED", "Difference", "Hello", "Options", "Plan", "Verdict"]
__all__ += ["read_hello", "run_suite"]

SHRINKING_S = 5.0
"""No new attempt to make a case shorter begins after this time."""
TIMING = 40
"""How often a shortest case is run again to find out whether the time is wrong."""
ENDING_S = 5.0
"""How long several programs may take to end after an interruption."""
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
    on_hello: Callable[[Hello], None] | None = None,
) -> Verdict:
    """Judge a program by a suite, or by the one case whose id is `only`.

    Whatever cannot be judged ends in the verdict UNJUDGED, with what was found so far; nothing is raised for
    it, and every program is closed. `on_hello` is told what a program says of itself, and may raise Unjudged;
    `on_difference` is called at once with the first one, before it is made shorter, `on_passed` with the
    number of each case that passed. An interruption from the keyboard is UNJUDGED too.
    """
    plan = plan or Plan(only=only)
    verdict = Verdict(UNJUDGED, suite.target, suite.name, plan.options.relation)
    verdict.cases_total = 1 if plan.only is not None else suite.case_count
    if plan.only is not None:
        verdict.only = f"scans {plan.part} of case {plan.only}" if plan.part else f"case {plan.only}"
    run = _Run(suite, verdict, plan, on_progress, on_difference)
    run.on_passed, run.on_hello = on_passed, on_hello
    began = time.monotonic()
    try:
        run.all(start)
    except KeyboardInterrupt:
        run.stop.set()
        verdict.word, verdict.reason = UNJUDGED, f"interrupted after {verdict.cases:,} cases"
        verdict.interrupted = True
    verdict.seconds = time.monotonic() - began
    run.cover()
    if verdict.word == DIFFERS and verdict.difference is not None:
        verdict.reason = verdict.reason or verdict.difference.in_a_line
    if verdict.word == CONFORMS:
        verdict.reason = run.too_little()
        verdict.word = UNJUDGED if verdict.reason else CONFORMS
    if plan.options.relation == MONITOR:
        verdict.word = {CONFORMS: FOLLOWS, DIFFERS: BREAKS}.get(verdict.word, verdict.word)
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
        self.on_hello: Callable[[Hello], None] | None = None
        self.hello: Hello | None = None
        self.hidden: frozenset[str] = frozenset()
        self.left_out: frozenset[str] = frozenset()
        self.watch: Watch | None = None
        self.programs: list[Program] = []
        self.seen: list[set[tuple[int, int, int]]] = [set() for _ in suite.steps]
        self.lock = threading.Lock()
        self.stop = threading.Event()
        self.began = self.reported = time.monotonic()
        self.todo = self._todo()
        self.troubles: list[str] = []
        self.causes: set[tuple[str, ...]] = set()

    def _todo(self) -> Iterator[tuple[int, Case]]:
        for number, case in self._cases():
            if number in self.plan.skip:
                self.verdict.earlier += 1
                self._passed(number, case)
            else:
                yield number, case

    def _cases(self) -> Iterator[tuple[int, Case]]:
        plan, found = self.plan, False
        ids: list[str] = []
        for number, case in enumerate(self.suite.cases()):
            if plan.only is not None:
                if case.id != plan.only:
                    ids.append(case.id)
                    continue
                found = True
                if plan.part is not None:
                    case = cut(self.suite, case, read_part(plan.part, case))
            yield number, case
        if plan.only is not None and not found:
            where = f"in the suite {self.suite.name} of {self.suite.target}"
            raise Unjudged(f"no case with the id {plan.only} {where}; {suggestion(plan.only, ids)}")

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
                for program in self.programs:  # whoever waits for an answer hears of its end
                    program.close()
                for thread in threads:
                    thread.join(ENDING_S)
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
        else:
            verdict.word = CONFORMS

    def too_little(self) -> str:
        """Why nothing that differs is no pass yet: what was not judged; nothing where all was."""
        verdict = self.verdict
        if verdict.cases != verdict.cases_total:
            return f"{verdict.cases:,} of {verdict.cases_total:,} cases were judged"
        if verdict.earlier == verdict.cases:
            return "all cases passed in an earlier run, so nothing was run; remove the note to judge again"
        if not verdict.compared:
            return "no output was compared in any scan"
        if verdict.relation == MONITOR:
            return self._never_put()
        if self.hidden and not verdict.transitions[0]:
            return "none of the transitions shows in the outputs that are observed"
        return ""

    def _never_put(self) -> str:
        """Demands that this suite puts to the reference, and that were never put to this program."""
        assert self.watch is not None
        demands = self.watch.demands
        if not any(demands.speak_of(case.params) for _, case in self._cases()):
            return f"no page speaks of a program with other values of {', '.join(demands.own)}"
        missing = {name for name, count in self.verdict.properties.items() if not count}
        if len(missing) < len(self.verdict.properties):
            if due := {one.id for one in self.watch.judged if one.comes}:
                missing &= due  # a program that does nothing breaks one of those, and keeps each `only if`
            for _, case in self._cases() if missing else ():
                self.watch.reset(case.params)
                for scan in case.scans:
                    if scan.request is None:
                        self.watch.scan(scan.dt_ms, scan.inputs, scan.outputs)
            missing = {name for name in missing if self.watch.counts[name]}
        if not missing:
            return ""
        names = ", ".join(name for name in self.verdict.properties if name in missing)
        return (
            f"{len(missing)} of {len(self.verdict.properties)} demands were never put to the "
            f"program, for it never did what they are about: {names}"
        )

    def _work(self, start: Callable[[], Program]) -> None:
        """Take cases until none is left, or something ends it all."""
        session: Session | None = None
        program: Program | None = None
        try:
            program = start()
            self.programs.append(program)
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
        except Exception as error:
            self.stop.set()
            place = session.place if session is not None and program is not None else ""
            words = str(error) if isinstance(error, Unjudged) else f"{type(error).__name__}: {error}"
            self.troubles.append(f"{place}: {words}" if place else words)

    def _greet(self, session: Session) -> None:
        verdict, hello = self.verdict, session.hello
        with self.lock:
            if self.hello not in (None, hello):
                raise Unjudged(
                    "one of the programs says of itself what the others do not, so no two are alike"
                )
            if self.hello is None and self.on_hello is not None:
                self.on_hello(hello)
            self.hello = hello
            self.hidden = frozenset(hello.unobserved) - frozenset(self.suite.codes)
            self.left_out = frozenset(self.suite.codes) - frozenset(session.compared)
            verdict.outputs = (len(session.compared), len(self.suite.outputs) - len(session.not_compared))
            verdict.adapter = f"{hello.name} {hello.version}".strip()
            verdict.unobserved = hello.unobserved
            verdict.not_compared = session.not_compared
            verdict.latency = session.granted if session.watch is not None else session.latency
            if session.watch is not None:
                verdict.unjudged = session.watch.unjudged
                self.watch = Watch(session.watch.demands, session.granted, session.hidden)

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
            if self.enough():
                return
            at = len(self.verdict.differences)
            self.verdict.differences.append(found)
            self.verdict.ids[case.id] = "differs"
            if self.enough():
                self.stop.set()
        if first and self.on_difference is not None:
            self.on_difference(found)
        if new:
            found = _shrunk(self.suite, session, found, failure, self.plan)
            with self.lock:
                self.verdict.differences[at] = found

    def enough(self) -> bool:
        """Whether so many cases differ as were asked for. All requests that must be refused are tried."""
        return sum(one.step != PROTOCOL for one in self.verdict.differences) >= self.plan.most

    def _passed(self, number: int, case: Case) -> None:
        self.verdict.cases += 1
        self.verdict.passed.append(number)
        by_column = self.suite.header.get("counted_by") == "column"
        before, last, shows = case.initial, None, not self.hidden
        for scan in case.scans:
            self.verdict.compared += scan.compared
            if scan.request is None:
                if self._shows(last, scan):
                    self.seen[scan.step].add((case.graph, before, scan.column if by_column else scan.to))
                    shows = True
                before, last = scan.to, scan
        self.verdict.ids[case.id] = "passed" if shows else "not seen"

    def _shows(self, last: Scan | None, scan: Scan) -> bool:
        """Whether a compared output changes in this scan, or none does: else nobody saw what happened.

        What the document gives no values for says nothing here, unless it is compared.
        """
        if not self.hidden or last is None or last.outputs is scan.outputs:
            return True
        changed = {
            name for name, value in scan.outputs.items() if last.outputs[name] != value
        } - self.left_out
        return not changed or bool(changed - self.hidden)

    def _tell(self) -> None:
        now = time.monotonic()
        if self.on_progress is not None and now - self.reported >= 0.5:
            self.reported = now
            self.on_progress(self.verdict.scans, self.suite.scan_count)

    def cover(self) -> None:
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


def _steps(case: Case, failure: Failure) -> list[int]:
    """The steps on which the wrong outputs rest: those that change one, or else all since the input."""
    steps: dict[int, None] = {}
    for n in range(failure.first, failure.at + 1):
        scan, before = case.scans[n], case.scans[n - 1].outputs if n else {}
        if any(before.get(name) != scan.outputs.get(name) for name in failure.expected):
            steps[scan.step] = None
    every = dict.fromkeys(scan.step for scan in case.scans[failure.first : failure.at + 1])
    return list(steps or every)


def _difference(suite: Suite, case: Case, failure: Failure) -> Difference:
    """A failure in words; its shortest case is its beginning as yet."""
    scan = case.scans[failure.at]
    steps = [suite.steps[n] for n in _steps(case, failure)]
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
        confirmed=None,
        when=failure.when,
        part=str(part),
        broken=broken.id if broken is not None else "",
        says=broken.says if broken is not None else "",
    )


def _shrunk(suite: Suite, session: Session, found: Difference, failure: Failure, plan: Plan) -> Difference:
    """The difference with a shorter case, as far as `effort` and time go. May raise Unjudged."""
    left, ends = plan.effort, time.monotonic() + SHRINKING_S

    session.patient = failure.since is not None

    def judged(case: Case) -> Failure | None:
        nonlocal left
        if left <= 0 or time.monotonic() > ends:
            raise StopIteration
        left -= 1
        scans = session.scans
        again = session.case(case)
        session.scans = scans
        return again

    def fails(case: Case) -> bool:
        return judged(case) is not None

    whole = Part(tuple(range(found.scan)))
    if found.step == PROTOCOL:
        return _with(suite, found, whole, None)
    if plan.part is not None or plan.effort <= 0:
        return _with(suite, found, whole, None)
    anything = plan.options.relation == MONITOR or WIRING in suite.header
    best = Shrinker(suite, found.case, failure.at, fails, reference(suite), anything).run()
    confirmed = best != whole
    if not confirmed:
        left, ends = 1, time.monotonic() + SHRINKING_S
        confirmed = fails(cut(suite, found.case, whole))
    found = _with(suite, found, best, confirmed)
    if confirmed and plan.options.relation == EXACT and not session.hello.real_time:
        left, ends = TIMING, time.monotonic() + SHRINKING_S
        shown = judged(found.shortest)
        found = replace(found, time=timing(found.shortest, shown, judged) if shown is not None else "")
    session.quiet()
    return found


def _with(suite: Suite, found: Difference, part: Part, confirmed: bool | None) -> Difference:
    return replace(found, shortest=cut(suite, found.case, part), confirmed=confirmed, part=str(part))
