"""Runs a suite against an adapter and judges the answers, relation `exact`: every output of every scan.

Where a case holds requests that protocol 1 forbids, the adapter must refuse them; one that does not is told
apart from a program that differs.
"""

from __future__ import annotations

import json
import marshal
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from modeproof.kit.adapter import Adapter, parse_answer
from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import loads, shown
from modeproof.kit.vectors import Case, Scan, Suite

CONFORMS, DIFFERS, UNJUDGED = "CONFORMS", "DIFFERS", "UNJUDGED"
EXIT = {CONFORMS: 0, DIFFERS: 1, UNJUDGED: 2}
PROTOCOL = "protocol"
"""Stands for the step where an adapter answered what it must refuse."""
BATCH = 64
"""Scans in one `scans` request."""
_REMEMBERED = 20_000
_ENCODE = json.JSONEncoder(separators=(",", ":")).encode


@dataclass(frozen=True)
class Hello:
    """What the adapter said about itself."""

    name: str
    version: str
    unobserved: tuple[str, ...]
    lists: bool


@dataclass(frozen=True)
class Difference:
    """The first scan that came out wrong. `scan` counts from 1; `expected` and `got` hold what differs only.

    `shortest` is the shortest case that leads to the same scan, `confirmed` whether it showed a difference
    too.
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


@dataclass
class Verdict:
    """The result of a run; `covered` counts for each step the transitions seen and all there are."""

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
    covered: dict[str, tuple[int, int]] = field(default_factory=dict)
    difference: Difference | None = None
    reason: str = ""

    @property
    def status(self) -> int:
        """The exit status."""
        return EXIT[self.word]


def run_suite(
    suite: Suite,
    start: Callable[[], Adapter],
    *,
    only: str | None = None,
    on_progress: Callable[[int, int], None] | None = None,
) -> Verdict:
    """Judge an adapter by a suite, or by the one case whose id is `only`.

    Ends with the first difference. Whatever cannot be judged ends in the verdict UNJUDGED; nothing is raised
    for it, and the adapter is ended in every case. `on_progress` gets the scans done and all there are.
    """
    verdict = Verdict(UNJUDGED, suite.target, suite.name, suite.relation, cases_total=suite.case_count)
    if only is not None:
        verdict.cases_total = 1
    began = time.monotonic()
    run = _Run(suite, verdict, on_progress)
    try:
        if suite.relation != "exact":
            raise Unjudged(f"relation {suite.relation!r} is not known to this kit")
        with start() as adapter:
            run.with_adapter(adapter, only)
    except Unjudged as error:
        verdict.word = UNJUDGED
        verdict.difference = None
        verdict.reason = f"{run.place}: {error}" if run.place else str(error)
    verdict.seconds = time.monotonic() - began
    verdict.covered = run.covered()
    return verdict


class _Run:
    def __init__(
        self, suite: Suite, verdict: Verdict, on_progress: Callable[[int, int], None] | None
    ) -> None:
        self.suite, self.verdict, self.on_progress = suite, verdict, on_progress
        self.place = ""
        self.compared: tuple[str, ...] = ()
        self.known: dict[bytes, Mapping[str, Any]] = {}
        self.good: set[bytes] = set()
        self.seen: list[set[tuple[int, int, int]]] = [set() for _ in suite.steps]
        self.reported = time.monotonic()

    def with_adapter(self, adapter: Adapter, only: str | None) -> None:
        verdict, suite = self.verdict, self.suite
        self.place = "hello"
        hello = read_hello(parse_answer(adapter.ask(_hello(suite.target))), suite)
        verdict.adapter = f"{hello.name} {hello.version}".strip()
        verdict.unobserved = hello.unobserved
        self.compared = tuple(name for name in suite.outputs if name not in hello.unobserved)
        if not self.compared:
            raise Unjudged("every output is unobserved, so nothing can be compared")
        for case in suite.cases():
            if only is not None and case.id != only:
                continue
            found = self._case(adapter, hello, case, counted=True)
            if found is not None:
                at, got = found
                adapter.quiet()
                verdict.difference = self._explain(adapter, hello, case, at, got)
                verdict.word = DIFFERS
                if case.scans[at].request is not None:
                    verdict.reason = (
                        "the adapter answers a request that protocol 1 tells it to refuse; "
                        "this says nothing about the program behind it"
                    )
                break
            verdict.cases += 1
        else:
            if verdict.cases == 0:
                raise Unjudged(f"no case with the id {only}" if only else "no case was run")
            self.place = "bye"
            adapter.bye()
            verdict.word = CONFORMS
            return
        if verdict.word == DIFFERS:
            self.place = ""

    def _case(
        self, adapter: Adapter, hello: Hello, case: Case, counted: bool
    ) -> tuple[int, Mapping[str, Any]] | None:
        """Run one case; the first wrong scan (from 0) and the outputs it gave, or None."""
        if case.reset:
            self.place = f"{case.id}, reset"
            answer = parse_answer(adapter.ask({"op": "reset", "params": case.params}))
            if answer != {"ok": True}:
                raise Unjudged(f"reset was answered with {shown(answer)}")
        compared = self.compared
        by_column = self.suite.header.get("counted_by") == "column"
        before = case.initial
        for n, got in enumerate(self._answers(adapter, hello, case)):
            scan = case.scans[n]
            wanted = scan.outputs
            if scan.request is not None:
                if got:
                    return n, got
                continue
            if counted:
                self.verdict.scans += 1
            if got != wanted and scan.compared and any(got[name] != wanted[name] for name in compared):
                return n, got
            if counted:
                self.seen[scan.step].add((case.graph, before, scan.column if by_column else scan.to))
                before = scan.to
        if counted:
            self._tell()
        return None

    def _answers(self, adapter: Adapter, hello: Hello, case: Case) -> Iterator[Mapping[str, Any]]:
        if hello.lists and not case.requests:
            for first in range(0, len(case.scans), BATCH):
                part = case.scans[first : first + BATCH]
                self.place = f"{case.id}, scans {first + 1} to {first + len(part)}"
                for n, out in enumerate(self._list(adapter, hello, part)):
                    self.place = f"{case.id}, scan {first + n + 1}"
                    yield self._checked(out, hello)
            return
        known = self.known
        for n, scan in enumerate(case.scans):
            self.place = f"{case.id}, scan {n + 1}"
            if scan.request is not None:
                yield _refusal(adapter.ask_line(_request_line(scan.request)))
                continue
            line = adapter.ask_line(_scan_line(scan))
            out = known.get(line)
            if out is None:
                answer = parse_answer(line)
                if set(answer) != {"out"}:
                    raise Unjudged(f'{{"out":{{..}}}} expected, got {shown(answer)}')
                out = self._checked(answer["out"], hello)
                if len(known) < _REMEMBERED:
                    known[line] = out
            yield out
        self.place = f"{case.id}, after the last scan"

    def _list(self, adapter: Adapter, hello: Hello, part: Sequence[Scan]) -> list[Any]:
        entries = [{"dt_ms": scan.dt_ms, "in": scan.inputs} for scan in part]
        answer = parse_answer(adapter.ask({"op": "scans", "list": entries}))
        outs = answer.get("list")
        if set(answer) != {"list"} or not isinstance(outs, list):
            raise Unjudged(f'{{"list":[..]}} expected, got {shown(answer)}')
        if len(outs) != len(part):
            raise Unjudged(f"{len(part)} answers expected, got {len(outs)}")
        for out in outs:
            if not isinstance(out, dict) or set(out) != {"out"}:
                raise Unjudged(f'{{"out":{{..}}}} expected, got {shown(out)}')
        return [out["out"] for out in outs]

    def _checked(self, out: Any, hello: Hello) -> Mapping[str, Any]:
        outputs = self.suite.outputs
        if not isinstance(out, dict):
            raise Unjudged(f"out must be an object, got {shown(out)}")
        # Most answers repeat an earlier one; marshal tells true from 1 and 1 from 1.0, which == does not.
        key = marshal.dumps(out)
        if key in self.good:
            return out
        for name in out:
            if name not in outputs:
                raise Unjudged(f"an output {name!r} that the target does not have")
        for name in self.compared:
            if name not in out:
                raise Unjudged(f"output {name} is missing")
            fault = outputs[name].fault(out[name])
            if fault:
                raise Unjudged(fault)
        if len(self.good) < _REMEMBERED:
            self.good.add(key)
        return out

    def _explain(
        self, adapter: Adapter, hello: Hello, case: Case, at: int, got: Mapping[str, Any]
    ) -> Difference:
        scan, suite = case.scans[at], self.suite
        if scan.request is not None:
            refused = {"error": "what is wrong, in one line"}
            shortest = suite.shortest(case, at)
            return Difference(case, at + 1, PROTOCOL, (), (), {"answer": refused}, got, shortest, True)
        step = suite.steps[scan.step]
        wrong = [name for name in self.compared if got[name] != scan.outputs[name]]
        shortest = suite.shortest(case, at)
        confirmed = len(shortest.scans) == at + 1
        if not confirmed:
            confirmed = self._case(adapter, hello, shortest, counted=False) is not None
            adapter.quiet()
        return Difference(
            case=case,
            scan=at + 1,
            step=step.name,
            clauses=step.clauses,
            findings=step.findings,
            expected={name: scan.outputs[name] for name in wrong},
            got={name: got[name] for name in wrong},
            shortest=shortest,
            confirmed=confirmed,
        )

    def _tell(self) -> None:
        now = time.monotonic()
        if self.on_progress is not None and now - self.reported >= 0.5:
            self.reported = now
            self.on_progress(self.verdict.scans, self.suite.scan_count)

    def covered(self) -> dict[str, tuple[int, int]]:
        seen: Counter[str] = Counter()
        for step, pairs in zip(self.suite.steps, self.seen, strict=True):
            seen[step.name] += len(pairs)
        return {step.name: (seen[step.name], step.transitions) for step in self.suite.steps}


def _hello(target: str) -> dict[str, Any]:
    return {"op": "hello", "protocol": 1, "target": target}


def _scan_line(scan: Scan) -> bytes:
    request = {"op": "scan", "dt_ms": scan.dt_ms, "in": scan.inputs}
    return _ENCODE(request).encode() + b"\n"


def _request_line(request: Mapping[str, Any] | str) -> bytes:
    text = request if isinstance(request, str) else _ENCODE(request)
    return text.encode() + b"\n"


def _refusal(line: bytes) -> Mapping[str, Any]:
    """Nothing for `{"error":"one line"}`, else what was answered. Raises Unjudged for what is no object."""
    try:
        answer = loads(line.decode("utf-8"))
    except (ValueError, RecursionError):
        answer = None
    if not isinstance(answer, dict):
        raise Unjudged(f"a refusal or an answer was expected, got {shown(line.decode('utf-8', 'replace'))}")
    error = answer.get("error")
    if set(answer) == {"error"} and isinstance(error, str) and error and "\n" not in error:
        return {}
    return {"answer": answer}


def read_hello(answer: Mapping[str, Any], suite: Suite) -> Hello:
    """Check the answer to hello. Raises Unjudged when the relation is not possible with it."""
    if answer.get("ok") is not True:
        raise Unjudged(f"hello was answered with {shown(answer, 200)}")
    relations = answer.get("relations", ["exact"])
    if not isinstance(relations, list) or suite.relation not in relations:
        raise Unjudged(f"the adapter does not offer relation {suite.relation}: {shown(relations)}")
    if answer.get("time", "virtual") != "virtual":
        raise Unjudged(f"relation exact needs virtual time, the adapter has {shown(answer.get('time'))}")
    latency = answer.get("max_latency_scans", 0)
    if type(latency) is not int or latency != 0:
        raise Unjudged(f"relation exact allows no latency, the adapter has {shown(latency)} scans")
    unobserved = answer.get("unobserved", [])
    if not isinstance(unobserved, list) or any(name not in suite.outputs for name in unobserved):
        raise Unjudged(f"unobserved must list outputs of the target, got {shown(unobserved)}")
    lists = answer.get("scans", False)
    if type(lists) is not bool:
        raise Unjudged(f"scans must be true or false, got {shown(lists)}")
    names = [str(answer.get(key, "")) for key in ("name", "version")]
    return Hello(names[0][:100] or "unnamed", names[1][:100], tuple(dict.fromkeys(unobserved)), lists)
