"""How one case is put to a program, and when its answers are right: the three relations.

`exact` compares all outputs in every scan. `settled` takes a case in groups, each one change of inputs and
the scans in which the specification comes to rest: the inputs are held for as many scans as the program may
need, and then the outputs must be those of the specification and stay so; in every scan each output must show
what it showed before, or what it shows on the way or at the end. `monitor` judges what the document demands,
and compares nothing with the specification.
"""

from __future__ import annotations

import marshal
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from modeproof.kit.adapter import Adapter, Program
from modeproof.kit.demands import Demand, Watch
from modeproof.kit.errors import Unjudged
from modeproof.kit.hello import read_hello
from modeproof.kit.signals import shown
from modeproof.kit.vectors import EXACT, MONITOR, SETTLED, Case, Scan, Suite

BATCH = 64
"""Scans in one `scans` request."""
LATENCY = 1
"""Scans that a program may take to show what its inputs ask for, unless it says or is told otherwise."""
PATIENT_SCANS = 80_000
"""Scans of a suite that are put once more by the page, with each row of inputs held: what must come may take
its time, and a suite that changes its inputs in every scan would never wait for it.
"""
PATIENCE = 24
"""Scans for which a row is held then, for each scan that a program may take."""
STABLE = 2
"""Scans for which settled outputs must stay."""
STILL, LASTING = "still", "lasting"
"""How time goes while rows are held patiently: after the first row it stands still, or it goes on."""
MOST_LATENCY = 10_000
_REMEMBERED = 20_000


@dataclass(frozen=True)
class Options:
    """How it is judged: the relation, and for programs that need several scans how inputs are held.

    `latency` is the most scans that an input may need to have all its effects (None: as hello says);
    `hold_ms` the time of a scan in which inputs are held; `slow` a factor for all times that the suite gives.
    With `codes` outputs are compared too whose values the document does not give.
    """

    relation: str = EXACT
    latency: int | None = None
    hold_ms: int = 0
    slow: int = 1
    codes: bool = False


@dataclass(frozen=True)
class Failure:
    """The first wrong scan of a case. `at` counts the scans of the case from 0.

    `expected` and `got` hold the outputs that differ only; of a safety property, what it rests on. `after`
    counts the scans for which inputs had been held since scan `since` of the case. `when` says in words what
    kind of failure it is.
    """

    at: int
    expected: Mapping[str, Any]
    got: Mapping[str, Any]
    when: str = ""
    after: int = 0
    broken: Demand | None = None
    since: int | None = None

    @property
    def first(self) -> int:
        """The scan in which the inputs changed that were held since."""
        return self.at if self.since is None else self.since


class Session:
    """One program under judgement. `place` says what it is doing, for messages."""

    def __init__(self, suite: Suite, program: Program, options: Options) -> None:
        self.suite, self.program, self.options = suite, program, options
        if options.relation not in suite.relations:
            raise Unjudged(
                f"suite {suite.name} is for relation {' or '.join(suite.relations)}, not {options.relation}"
            )
        self._where: tuple[Any, ...] = ("hello",)
        self.hello = read_hello(program.hello(suite.target), suite.outputs, options.relation)
        self.latency = self.hello.latency if options.latency is None else options.latency
        if not 0 <= self.latency <= MOST_LATENCY:
            raise Unjudged(f"a latency of 0 to {MOST_LATENCY} scans expected, not {self.latency}")
        left_out = () if options.codes else suite.codes
        self.hidden = hidden = (*self.hello.unobserved, *left_out)
        self.not_compared = tuple(name for name in left_out if name not in self.hello.unobserved)
        self.compared = tuple(name for name in suite.outputs if name not in hidden)
        if not self.compared:
            why = ", or its values are ours alone (--codes compares those)" if left_out else ""
            raise Unjudged(f"every output is unobserved{why}, so nothing can be compared")
        self.watch: Watch | None = None
        self.granted = max(LATENCY, self.latency) if options.latency is None else options.latency
        demands = suite.demands() if options.relation == MONITOR else None
        if demands is not None:
            self.watch = Watch(demands, self.granted, hidden)
        if options.relation == MONITOR and self.latency and SETTLED not in suite.relations:
            raise Unjudged(
                f"suite {suite.name} changes inputs in every scan, and the program may need {self.latency} "
                "scans for each, so what is demanded would say nothing: use a suite that holds inputs (sic)"
            )
        if options.relation == MONITOR and (self.watch is None or not self.watch.judged):
            raise Unjudged("nothing is demanded of the outputs that are compared")
        self.scans = 0
        self.patient = False
        self._patience = PATIENT_SCANS
        self._good: set[bytes] = set()
        self._kept: dict[int, Any] = {}
        self._keeps = bool(getattr(program, "keeps_answers", False))
        self._counting = _Counting(self)
        self._at = 0
        self._adapter = program if isinstance(program, Adapter) else None
        self._where = ()

    @property
    def place(self) -> str:
        """Case and scan, as far as it has come."""
        return ", scan ".join(str(part) for part in self._where)

    def case(self, case: Case) -> Failure | None:
        """Put one case to the program; the first failure, or None when all is right. May raise Unjudged."""
        if case.reset:
            self._where = (f"{case.id}, reset",)
            self.program.reset(self._slowed(case.params))
        self._where = (case.id,)
        if self.watch is not None:
            self.watch.reset(self._slowed(case.params))
        if self.options.relation == EXACT:
            failure = self._exact(case)
        elif self.options.relation == SETTLED or self.latency:
            failure = self._settled(case, self.latency)
        else:
            failure = self._watched(case)
            if failure is None and case.reset and not case.requests and (self.patient or self._patience > 0):
                failure = self._patiently(case)
        self._where = (f"{case.id}, after the last scan",)
        return failure

    def end(self) -> None:
        """Say goodbye to a program that knows how to."""
        self._where = ("bye",)
        if self._adapter is not None:
            self._adapter.bye()

    def quiet(self) -> None:
        """Make sure that what was just read was the answer to what was just asked."""
        if self._adapter is not None:
            self._adapter.quiet()

    # -------------------------------------------------------------------------------------------- exact

    def _exact(self, case: Case) -> Failure | None:
        if not case.requests and not (self.hello.lists and self._adapter is not None):
            return self._scan_by_scan(case)
        compared, every = self.compared, len(self.compared) == len(self.suite.outputs)
        for n, got in enumerate(self._answers(case)):
            scan = case.scans[n]
            if scan.request is not None:
                if got:
                    refused = {"answer": {"error": "what is wrong, in one line"}}
                    return Failure(n, refused, got, "not refused")
                continue
            self.scans += 1
            wanted = scan.outputs
            if got != wanted and scan.compared and (every or _differ(got, wanted, compared)):
                return self._difference(n, wanted, got)
        return None

    def _scan_by_scan(self, case: Case) -> Failure | None:
        """As `_exact`, for what is sent most: nothing here that is not needed."""
        ask, slow, compared, checked = self.program.scan, self.options.slow, self.compared, self._checked
        every, kept = len(compared) == len(self.suite.outputs), self._kept
        n = 0
        self._where = (case.id, self._counting)
        try:
            for scan in case.scans:
                self._at = n + 1
                got = ask(scan.dt_ms * slow, scan.inputs)
                if kept.get(id(got)) is not got:
                    got = checked(got)
                n += 1
                wanted = scan.outputs
                if got != wanted and scan.compared and (every or _differ(got, wanted, compared)):
                    return self._difference(n - 1, wanted, got)
        finally:
            self.scans += n
        return None

    def _difference(
        self, n: int, wanted: Mapping[str, Any], got: Mapping[str, Any], when: str = "", after: int = 0
    ) -> Failure:
        wrong = [name for name in self.compared if got[name] != wanted[name]]
        return Failure(
            n, {name: wanted[name] for name in wrong}, {name: got[name] for name in wrong}, when, after
        )

    def _answers(self, case: Case) -> Iterator[Mapping[str, Any]]:
        if self.hello.lists and self._adapter is not None and not case.requests:
            for first in range(0, len(case.scans), BATCH):
                part = case.scans[first : first + BATCH]
                self._where = (case.id, f"{first + 1} to {first + len(part)}")
                outs = self._adapter.scans([(scan.dt_ms * self.options.slow, scan.inputs) for scan in part])
                for n, out in enumerate(outs):
                    self._where = (case.id, first + n + 1)
                    yield self._checked(out)
            return
        ask, slow, checked, id = self.program.scan, self.options.slow, self._checked, case.id
        for n, scan in enumerate(case.scans, 1):
            self._where = (id, n)
            if scan.request is not None:
                if self._adapter is None:
                    raise Unjudged("what must be refused can only be sent to an adapter")
                yield self._adapter.refused(scan.request)
            else:
                yield checked(ask(scan.dt_ms * slow, scan.inputs))

    def _checked(self, out: Any) -> Mapping[str, Any]:
        # Most answers repeat an earlier one; marshal tells true from 1 and 1 from 1.0, which == does not.
        try:
            key = marshal.dumps(out)
        except ValueError:
            raise Unjudged(f"out must be an object of plain values, got {shown(out)}") from None
        if key in self._good:
            self._keep(out)
            return out  # type: ignore[no-any-return]
        outputs = self.suite.outputs
        if not isinstance(out, dict):
            raise Unjudged(f"out must be an object, got {shown(out)}")
        for name in out:
            if name not in outputs:
                raise Unjudged(f"an output {name!r} that the target does not have")
        for name in self.compared:
            if name not in out:
                raise Unjudged(f"output {name} is missing")
            fault = outputs[name].fault(out[name])
            if fault:
                raise Unjudged(fault)
        if len(self._good) < _REMEMBERED:
            self._good.add(key)
        self._keep(out)
        return out

    def _keep(self, out: Mapping[str, Any]) -> None:
        if self._keeps and len(self._kept) < _REMEMBERED:
            self._kept[id(out)] = out

    def _patiently(self, case: Case) -> Failure | None:
        """By the page once more, each row of inputs held: while time stands still after the first, and while
        it goes on.
        """
        scans, failure = self.scans, None
        for pace in (STILL, LASTING):
            self.program.reset(self._slowed(case.params))
            if self.watch is not None:
                self.watch.reset(self._slowed(case.params))
            failure = failure or self._settled(case, PATIENCE * max(1, self.granted), pace)
        self._patience -= self.scans - scans
        return failure

    # ------------------------------------------------------------------------------------------ settled

    def _settled(self, case: Case, hold: int, pace: str = "") -> Failure | None:
        """Each change of inputs held for so many scans, or as many as the case has, and some more."""
        before: Mapping[str, Any] | None = None
        clock = _Clock(case, self.options) if self.hello.real_time else None
        for first, last in groups(case):
            event, wanted = case.scans[first], case.scans[last].outputs
            allowed: dict[str, list[Any]] = {name: [] for name in self.compared}
            for row in (*((before,) if before else ()), *(s.outputs for s in case.scans[first : last + 1])):
                for name, values in allowed.items():
                    values.append(row[name])
            held = max(hold, last - first) + STABLE
            times = self._times(case, first, last, held, pace)
            for after, out in enumerate(self._held(case.id, first, event, times)):
                failure = self._passing(last, event, out, allowed, wanted, after, times[after])
                if failure is None and after > held - STABLE and _differ(out, wanted, self.compared):
                    when = f"held for {after} scans, and not what it settles to"
                    failure = self._difference(last, wanted, out, when, after)
                if failure is not None and self.options.relation == MONITOR and failure.broken is None:
                    failure = None
                if failure is not None:
                    return replace(failure, since=first)
            before = wanted
            if clock is not None:
                clock.check(sum(scan.dt_ms for scan in case.scans[first : last + 1]))
        return None

    def _times(self, case: Case, first: int, last: int, held: int, pace: str) -> list[int]:
        """The times of an event and of the scans in which its inputs are held: those of the case, as far as
        it has some, for in them something may happen by its time.
        """
        own = [scan.dt_ms * self.options.slow for scan in case.scans[first : last + 1]]
        if pace == STILL and first > 0:
            own = [0] * len(own)
        rest = own[0] if pace == LASTING or (pace == STILL and not first) else self.options.hold_ms
        held_for = [ms or rest for ms in own[1:]]
        return [own[0], *held_for, *[rest] * (held - len(held_for))]

    def _held(self, id: str, first: int, event: Scan, times: Sequence[int]) -> Iterator[Mapping[str, Any]]:
        """The outputs after an event and in the scans in which its inputs are held."""
        if self.hello.lists and self._adapter is not None:
            outs: Sequence[Mapping[str, Any]] = []
            for start in range(0, len(times), BATCH):
                self._where = (id, f"{first + 1}, held for {start} scans and more")
                outs = self._adapter.scans([(dt_ms, event.inputs) for dt_ms in times[start : start + BATCH]])
                for n, out in enumerate(outs, start):
                    self._where = (id, f"{first + 1}, held for {n} scans")
                    self.scans += 1
                    yield self._checked(out)
            return
        for n, dt_ms in enumerate(times):
            self._where = (id, f"{first + 1}, held for {n} scans")
            self.scans += 1
            yield self._checked(self.program.scan(dt_ms, event.inputs))

    def _passing(
        self,
        at: int,
        event: Scan,
        out: Mapping[str, Any],
        allowed: Mapping[str, Sequence[Any]],
        wanted: Mapping[str, Any],
        after: int,
        dt_ms: int,
    ) -> Failure | None:
        """What must hold in every scan, settled or not."""
        if self.watch is not None:
            broken = self.watch.scan(dt_ms, event.inputs, out)
            if broken is not None:
                return self._broken(at, broken, wanted, out, after)
        for name, values in allowed.items():
            if out[name] not in values:
                when = "shows what it may show neither before, nor on the way, nor settled"
                return Failure(at, {name: wanted[name]}, {name: out[name]}, when, after)
        return None

    def _broken(
        self, at: int, broken: Demand, wanted: Mapping[str, Any], out: Mapping[str, Any], after: int
    ) -> Failure:
        names = [name for name in self.compared if name in broken.outputs and out[name] != wanted[name]]
        names = names or [name for name in self.compared if name in broken.outputs]
        return Failure(
            at,
            {name: wanted[name] for name in names},
            {name: out[name] for name in names},
            f"breaks {broken.id}",
            after,
            broken,
        )

    # ------------------------------------------------------------------------------------------ monitor

    def _watched(self, case: Case) -> Failure | None:
        assert self.watch is not None
        for n, out in enumerate(self._answers(case)):
            scan = case.scans[n]
            self.scans += 1
            broken = self.watch.scan(scan.dt_ms * self.options.slow, scan.inputs, out)
            if broken is not None:
                return self._broken(n, broken, scan.outputs, out, 0)
        return None

    def _slowed(self, params: Mapping[str, Any]) -> Mapping[str, Any]:
        """Parameters with all times longer; what the suite leaves out takes its default, longer too."""
        if self.options.slow == 1:
            return params
        longer = {
            name: params.get(name, row["default"]) * self.options.slow
            for name, row in self.suite.parameters.items()
            if row["type"] == "ms"
        }
        return {**params, **longer}


class _Counting:
    """The scan that a session is at, when somebody asks."""

    def __init__(self, session: Session) -> None:
        self._session = session

    def __str__(self) -> str:
        return str(self._session._at)


class _Clock:
    """Real time goes on while inputs are held; more than the shortest time of a case would change it."""

    def __init__(self, case: Case, options: Options) -> None:
        self._slow = options.slow
        self._least = min((scan.dt_ms for scan in case.scans if scan.dt_ms), default=0) * options.slow
        self._began, self._meant = time.monotonic(), 0

    def check(self, passed_ms: int) -> None:
        """After each group, which takes so long in the case. Raises Unjudged when too much time has gone by
        beside it.
        """
        self._meant += passed_ms * self._slow
        over = (time.monotonic() - self._began) * 1000 - self._meant
        if self._least and over > self._least:
            raise Unjudged(
                f"holding the inputs took {over:.0f} ms, more than the case can bear ({self._least} ms); "
                f"--slow {int(self._slow * over / self._least) + 1} gives it more"
            )


def groups(case: Case) -> Iterator[tuple[int, int]]:
    """First and last scan of each change of inputs: up to a scan that is compared."""
    first = 0
    for n, scan in enumerate(case.scans):
        if scan.compared or n + 1 == len(case.scans):
            yield first, n
            first = n + 1


def _differ(got: Mapping[str, Any], wanted: Mapping[str, Any], names: Sequence[str]) -> bool:
    return any(got[name] != wanted[name] for name in names)
