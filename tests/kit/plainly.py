"""What the kit must say of a program, worked out plainly: no threads, no shrinking, nothing remembered.

It is written from the description of the three relations alone, and shares no code with the kit's judge.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from modeproof.kit.vectors import Case, Scan, Suite

Row = Mapping[str, Any]


@dataclass(frozen=True)
class Wrong:
    """The first wrong scan of a case: counted from 1, the outputs in it, and the steps that they rest on."""

    scan: int
    expected: Row
    got: Row
    steps: tuple[str, ...]
    held: int | None = None


def differing(
    suite: Suite, case: Case, program: Any, relation: str, seen: Sequence[str], latency: int
) -> Wrong | None:
    """The first wrong scan of a case, if there is one; `seen` are the outputs that are compared."""
    program.reset(case.params)
    found = _exact(case, program, seen) if relation == "exact" else _settled(case, program, seen, latency)
    if found is None:
        return None
    first, at, expected, got, held = found
    moved = {
        n
        for n in range(first, at + 1)
        for name in expected
        if _before(case, n).get(name) != case.scans[n].outputs[name]
    }
    chosen = [n for n in range(first, at + 1) if not moved or n in moved]
    steps = tuple(dict.fromkeys(suite.steps[case.scans[n].step].name for n in chosen))
    return Wrong(at + 1, expected, got, steps, held)


def _before(case: Case, n: int) -> Row:
    return case.scans[n - 1].outputs if n > 0 else {}


def _exact(case: Case, program: Any, seen: Sequence[str]) -> tuple[int, int, Row, Row, int | None] | None:
    for n, scan in enumerate(case.scans):
        out = program.scan(scan.dt_ms, scan.inputs)
        bad = [name for name in seen if out[name] != scan.outputs[name]]
        if bad and scan.compared:
            return n, n, {x: scan.outputs[x] for x in bad}, {x: out[x] for x in bad}, None
    return None


def changes_of(case: Case) -> Iterator[list[Scan]]:
    """The scans of each change of inputs: a change, and what follows until the outputs are compared."""
    found: list[Scan] = []
    for scan in case.scans:
        found.append(scan)
        if scan.compared:
            yield found
            found = []


def _settled(
    case: Case, program: Any, seen: Sequence[str], latency: int
) -> tuple[int, int, Row, Row, int | None] | None:
    done, before = 0, None
    for scans in changes_of(case):
        first, at, wanted = done, done + len(scans) - 1, scans[-1].outputs
        done += len(scans)
        may = [*([before] if before is not None else []), *(scan.outputs for scan in scans)]
        rows = (
            max(latency, len(scans) - 1) + 3
        )  # the scan of the change, those it may need, and two to stand still
        for n in range(rows):
            dt_ms = scans[n].dt_ms if n < len(scans) else 0
            out = program.scan(dt_ms, scans[0].inputs)
            for name in seen:
                if all(out[name] != row[name] for row in may):
                    return first, at, {name: wanted[name]}, {name: out[name]}, n
            bad = [name for name in seen if out[name] != wanted[name]]
            if bad and n >= rows - 2:
                return first, at, {x: wanted[x] for x in bad}, {x: out[x] for x in bad}, n
        before = wanted
    return None


def judged(
    suite: Suite, start: Callable[[], Any], relation: str, hidden: Sequence[str] = (), latency: int = 0
) -> dict[str, Any]:
    """What the verdict on all cases must say where every case that differs is to be named."""
    seen = [name for name in suite.outputs if name not in hidden]
    cases = list(suite.cases())
    wrong = {one.id: differing(suite, one, start(), relation, seen, latency) for one in cases}
    passed = [one for one in cases if wrong[one.id] is None]
    covered: dict[str, set[tuple[int, int]]] = {step.name: set() for step in suite.steps}
    for one in passed:
        before, last = one.initial, None
        for scan in one.scans:
            told = [name for name in scan.outputs if name in seen or name not in suite.codes]
            changed = {name for name in told if last is not None and last[name] != scan.outputs[name]}
            unobserved = set(hidden) - set(suite.codes)
            if not unobserved or not changed or changed - unobserved:
                covered[suite.steps[scan.step].name].add((before, scan.to))
            before, last = scan.to, scan.outputs
    return {
        "word": "DIFFERS" if len(passed) < len(cases) else "CONFORMS",
        "passed": [n for n, one in enumerate(cases) if wrong[one.id] is None],
        "wrong": {id: one for id, one in wrong.items() if one is not None},
        "covered": {name: len(pairs) for name, pairs in covered.items()},
    }
