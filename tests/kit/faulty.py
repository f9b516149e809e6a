"""Faulty programs in this process, and whether what the kit prints about them is true.

    python -m tests.kit.faulty [PROGRAMS] [REPLAYS]     counts wrong reproductions; by default 200 and 10,000

A faulty program is the reference implementation with one edit of its step (the mutation operators of
modeproof.strength), or with a mistake in its time base or in an output. A reproduction is wrong if the
reference implementation itself, which is right, does not pass it.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path
from types import ModuleType
from typing import Any

from modeproof.kit.builtin import Builtin
from modeproof.kit.relation import Session
from modeproof.kit.shrink import cut, read_part
from modeproof.kit.suite_judge import Options, Plan, run_suite
from modeproof.kit.vectors import Case, Suite, open_suite
from modeproof.kit.verdict import Difference
from modeproof.strength.mutant import applied
from modeproof.strength.python_module import Module
from modeproof.strength.python_operators import PythonRule, python_mutants

ROOT = Path(__file__).resolve().parents[2]
TARGETS = {
    "fplc": "mode_selection",
    "hmi": "mode_selection",
    "sf_edm": "edm",
    "sf_enable_switch": "enable_switch",
    "sf_guard_locking": "guard_locking",
    "sf_testable_safety_sensor": "testable_safety_sensor",
}
RUNS = (("times", "exact"), ("sic", "settled"), ("brief", "exact"), ("sic", "monitor"), ("words", "exact"))
"""Suites and relations, the ones with the most to be cut first."""
LARGEST = 150_000
"""Scans of a suite; a larger one takes half a minute for each program that it does not find."""


class Clumsy(Builtin):
    """The reference implementation with a mistake in its time base or in one output."""

    def __init__(self, suite: Suite, mistake: str) -> None:
        super().__init__("refimpl", suite)
        self.mistake, self.scans, self.total = mistake, 0, 0

    def reset(self, params: Mapping[str, Any]) -> None:
        super().reset(params)
        self.scans = self.total = 0

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        self.scans += 1
        before, self.total = self.total, self.total + dt_ms
        kind, _, name = self.mistake.partition(" ")
        if kind == "rounds":  # time counts in whole pieces
            dt_ms = self.total // int(name) * int(name) - before // int(name) * int(name)
        elif kind == "cuts":  # of each scan
            dt_ms = dt_ms // int(name) * int(name)
        elif kind == "wraps":
            dt_ms %= int(name)
        elif kind == "fast":
            dt_ms += int(name) if dt_ms else 0
        out = dict(super().scan(dt_ms, inputs))
        if kind == "tired" and self.scans > 12 and type(out[name]) is bool:
            out[name] = False
        elif kind == "stuck":
            signal = self._suite.outputs[name]
            out[name] = {"bool": False, "word": "0000", "modes": [], "int": 0}.get(signal.type, out[name])
        return out


@dataclass(frozen=True)
class Faulty:
    """A faulty program of a target: what is wrong with it, and the text of its step where that is edited."""

    target: str
    fault: str
    text: str = ""

    @property
    def package(self) -> str:
        """The name that `--builtin` takes; the module is made when it is asked for."""
        package = f"faulty_{hashlib.sha256(self.text.encode()).hexdigest()[:12]}"
        name = f"{package}.{TARGETS[self.target]}.{self.target}"
        if self.text and name not in sys.modules:
            made = sys.modules[name] = ModuleType(name)  # dataclasses look there
            exec(compile(self.text, package, "exec"), made.__dict__)
        return package

    def start(self, suite: Suite) -> Builtin:
        """The program, for a suite of its target."""
        return Builtin(self.package, suite) if self.text else Clumsy(suite, self.fault)


@cache
def suite_of(target: str, name: str) -> Suite | None:
    """The published suite, if there is one."""
    path = ROOT / "vectors" / target / f"{name}.jsonl.gz"
    return open_suite(path) if path.is_file() else None


@cache
def cases_of(target: str, name: str) -> dict[str, Case]:
    """Its cases by id."""
    suite = suite_of(target, name)
    return {} if suite is None else {case.id: case for case in suite.cases()}


def faulty_programs(target: str) -> Iterator[Faulty]:
    """All faulty programs of a target: first those in time and outputs, then the mutants of its step."""
    suite = suite_of(target, "brief")
    assert suite is not None
    times = [f"{kind} {ms}" for kind in ("rounds", "cuts") for ms in (2, 10, 100)]
    times += ["wraps 32768", "wraps 256", "fast 1"]
    outputs = [f"{kind} {name}" for name in suite.outputs for kind in ("stuck", "tired")]
    yield from (Faulty(target, mistake) for mistake in (*times, *outputs))
    name = f"refimpl.{TARGETS[target]}.{target}"
    module = Module(name, (ROOT / f"{name.replace('.', '/')}.py").read_text(encoding="utf-8"))
    functions = [one for one in module.functions if one not in ("power_up", "outputs")]
    for one in python_mutants(module, functions, frozenset(), PythonRule()):
        yield Faulty(target, str(one.mutant), applied(module.lines, one.mutant.edit))


def chosen(count: int, targets: Sequence[str] = tuple(TARGETS)) -> list[Faulty]:
    """So many faulty programs: of each target alike, and of all kinds."""
    each = -(-count // len(targets))
    found: list[Faulty] = []
    for target in targets:
        programs = list(faulty_programs(target))
        step = max(1, len(programs) // each)
        found += programs[::step][:each]
    return found[:count]


@dataclass
class Counts:
    """What was replayed: all, those that were made shorter, and the wrong ones by program and case."""

    programs: int = 0
    found: int = 0
    replayed: int = 0
    shorter: int = 0
    wrong: list[str] = field(default_factory=list)

    def __str__(self) -> str:
        return (
            f"{self.found} of {self.programs} programs differ; {self.replayed:,} reproductions replayed "
            f"({self.shorter:,} of them made shorter): {len(self.wrong)} wrong"
        )


def replay(counts: Counts, suite: Suite, relation: str, program: Faulty, one: Difference) -> None:
    """What `again:` would run, on the program that is right."""
    whole = cases_of(suite.target, suite.name)[one.case.id]  # the id names a case of the file
    part = cut(suite, whole, read_part(one.part, whole))
    session = Session(suite, Builtin("refimpl", suite), Options(relation))
    counts.replayed += 1
    counts.shorter += len(part.scans) < one.scan
    if session.case(part) is not None:
        counts.wrong.append(f"{program.target} {suite.name} {relation}: {program.fault}: {one.part}")


def runs_of(target: str) -> list[tuple[Suite, str]]:
    """The suites that are small enough to judge faulty programs of a target by, each with its relation."""
    found = [(suite_of(target, name), relation) for name, relation in RUNS]
    return [
        (suite, relation)
        for suite, relation in found
        if suite is not None and relation in suite.relations and suite.scan_count <= LARGEST
    ]


def campaign(programs: list[Faulty], most: int, enough: int = 10**9) -> Counts:
    """Judge each program by all suites, and replay each reproduction, until there are `enough`."""
    counts, different = Counts(), set()
    for program in programs:
        for suite, relation in runs_of(program.target):
            if counts.replayed >= enough:
                break
            plan = Plan(Options(relation), most=most, effort=60)
            verdict = run_suite(suite, partial(program.start, suite), plan=plan)
            for one in verdict.differences:
                replay(counts, suite, relation, program, one)
            if verdict.differences:
                different.add(program)
    counts.programs, counts.found = len(programs), len(different)
    return counts


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:]]
    done = campaign(chosen(numbers[0] if numbers else 200), 60, numbers[1] if len(numbers) > 1 else 10_000)
    print(done, *done.wrong[:20], sep="\n")
    sys.exit(bool(done.wrong))
