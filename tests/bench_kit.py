"""Benchmarks of the kit, by `make bench`. Nothing here is a test: being slow fails nothing.

The suite `brief` of each published target, read, put to a program and compared: a program in this process
that only gives what is expected, the reference implementation in this process, and behind an adapter in
lock-step and in lists. Then all fast suites over the protocol, and how soon a wrong program is told so.
"""

from __future__ import annotations

import contextlib
import statistics
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from modeproof.kit.adapter import Adapter, Program
from modeproof.kit.builtin import Builtin
from modeproof.kit.suite_judge import Plan, run_suite
from modeproof.kit.vectors import Suite
from modeproof.suites.build import published, ready_suite
from modeproof.suites.kinds import SUITES
from modeproof.suites.write import NoCases
from tests.bench import REPEATS, measure, show

NOTHING = """
import json, sys
for line in sys.stdin:
    message = json.loads(line)
    sys.stdout.write('{"out":{}}\\n' if message["op"] == "scan" else '{"ok":true}\\n')
    sys.stdout.flush()
"""
STUCK = """
import sys
sys.argv = ["adapter", {target!r}]
text = open({path!r}).read().replace("Path(__file__)", "Path({path!r})")
exec(text.replace("self.state, reply =", "_, reply ="))
"""


class Expected:
    """A program that gives what the suite expects, and does nothing else."""

    keeps_answers = True

    def __init__(self, rows: Sequence[Mapping[str, Any]]) -> None:
        self._rows = iter(rows)

    def hello(self, target: str) -> Mapping[str, Any]:
        return {"ok": True, "name": "expected"}

    def reset(self, params: Mapping[str, Any]) -> None:
        pass

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        return next(self._rows)

    def close(self) -> None:
        pass


class Single(Adapter):
    """An adapter that is never sent a list."""

    def hello(self, target: str) -> Mapping[str, Any]:
        return {**super().hello(target), "scans": False}


def judge(suite: Suite, start: Callable[[], Program]) -> Callable[[], int]:
    """One run of a suite; gives the number of scans."""

    def work() -> int:
        verdict = run_suite(suite, start)
        if verdict.word != "CONFORMS":
            print(f"note: {suite.target} {suite.name}: {verdict.word} {verdict.reason}", file=sys.stderr)
        return verdict.scans

    return work


def lock_step(suite: Suite) -> Callable[[], int]:
    """Nothing but requests and answers of the protocol, with an adapter that does nothing."""
    scans = [scan for case in suite.cases() for scan in case.scans]

    def work() -> int:
        with Adapter([sys.executable, "-S", "-c", NOTHING]) as adapter:
            for scan in scans:
                adapter.scan(scan.dt_ms, scan.inputs)
        return len(scans)

    return work


def show_kit(place: Path) -> None:
    """All figures of the kit."""
    for target, document in published(place).items():
        path = str(place / "examples/adapters/refimpl_adapter.py")
        command = [sys.executable, path, target]
        suite = ready_suite(place, document, target, "brief")
        rows = [scan.outputs for case in suite.cases() for scan in case.scans]
        show(f"judge {target}, nothing", "scans", measure(judge(suite, lambda rows=rows: Expected(rows))))
        builtin = judge(suite, lambda suite=suite: Builtin("refimpl", suite))
        show(f"judge {target}, refimpl", "scans", measure(builtin))
        show(f"protocol {target}, nothing", "scans", measure(lock_step(suite)))
        single = judge(suite, lambda command=command: Single(command))
        show(f"protocol {target}, refimpl", "scans", measure(single))
        show(f"protocol {target}, lists", "scans", measure(judge(suite, lambda c=command: Adapter(c))))
        _show_fast(place, document, target, command)
        _show_first(suite, STUCK.format(target=target, path=path))


def _show_fast(place: Path, document: str, target: str, command: Sequence[str]) -> None:
    fast = []
    for name, kind in SUITES.items():
        with contextlib.suppress(NoCases):
            fast += [ready_suite(place, document, target, name)] if kind.fast else []
    # our own adapter refuses as it must, but knows no lists in the suite that asks for refusals
    began = time.perf_counter()
    scans = sum(judge(one, lambda: Adapter(command))() for one in fast)
    passed = time.perf_counter() - began
    print(
        f"{target}, {' '.join(one.name for one in fast)}: {scans:,} scans over the protocol, {passed:.1f} s"
    )


def _show_first(suite: Suite, code: str) -> None:
    """How long after its start the first wrong scan of a program that never changes its state is named."""
    took = []
    for _ in range(REPEATS):
        began = time.perf_counter()
        told: list[float] = []
        verdict = run_suite(
            suite,
            lambda: Adapter([sys.executable, "-c", code]),
            plan=Plan(effort=60, most=20),
            on_difference=lambda _, began=began, told=told: told.append(time.perf_counter() - began),
        )
        if verdict.word != "DIFFERS":
            print(f"note: {suite.target}: {verdict.word} {verdict.reason}", file=sys.stderr)
        took += told or [float("inf")]
    print(
        f"{suite.target}: first failure of a wrong program {statistics.median(took):.2f} s after the start, "
        f"at most {max(took):.2f} s, {len(took)} repetitions"
    )
