"""What becomes of a changed copy: KILLED by a theorem, EQUIVALENT, SURVIVED, INVALID or UNMEASURED.

First it is asked where the copy ends otherwise than the shipped code (differences.py). Nowhere: EQUIVALENT.
Else the theorems about the device are asked, in the order of the subject, about the copy where it ends
otherwise, and there alone: elsewhere it ends as the shipped code does, of which they are proved. The first
theorem with a counterexample kills. The counterexample is run on the copy in the plain interpreter, and must
end there as the explorer says; and the same theorem asked of the shipped code at the same place must have
none. A scan that raises breaks the theorem that every scan ends with a state and outputs.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import z3

from proofs.explorer.device import Device, Scan, judging
from proofs.explorer.errors import ExplorationError, TooManyPathsError, UndecidedError
from proofs.explorer.records import evaluated_plain
from proofs.mutants.copies import Change, CopyError, copied
from proofs.mutants.differences import (
    Difference,
    NoAnswer,
    as_scans,
    as_shipped_scans,
    difference,
)
from proofs.mutants.shipped import POWER_UP, Shipped, Way, run
from proofs.theorem import NotJudged, Query, Theorem, TheoremError

LIMIT_MS: Final = 20_000
"""For one question about a copy."""


@dataclass(frozen=True)
class Asked:
    """What a theorem says of a copy: refuted, holds, or unknown; `where`: the query that was refuted."""

    theorem: str
    result: str
    where: str = ""
    detail: str = ""
    seconds: float = 0.0


@dataclass(frozen=True)
class Found:
    """The verdict on a change. witness: where it first ended otherwise, and how."""

    verdict: str
    killers: tuple[str, ...] = ()
    reason: str = ""
    witness: str = ""
    asked: tuple[Asked, ...] = ()


@dataclass
class Bench:
    """The shipped devices of one package, explored once, and the theorems about each of them, in order."""

    package: str
    shipped: Mapping[str, Shipped]
    theorems: Mapping[str, Sequence[Theorem]]

    def judge(self, change: Change, file: str, complete: bool = False) -> Found:
        """What becomes of the change; `file` is that of the module. complete: ask every theorem."""
        try:
            copy = copied(self.package, change)
        except CopyError as error:
            return Found("INVALID", reason=str(error))
        trials = [
            _Trial(
                self, shipped, copy.of(shipped.subject.device), shipped.passing(file, change.lines), complete
            )
            for shipped in self.shipped.values()
        ]
        if not any(trial.ways for trial in trials):
            return Found("EQUIVALENT", reason="no path of the shipped code passes it")
        asked: list[Asked] = []
        try:
            for quick in (True, False):
                for trial in trials:
                    asked += trial.quickly() if quick else trial.thoroughly()
                    if killers := _killers(asked):
                        return Found("KILLED", killers, "", trial.witness, tuple(asked))
        except (NoAnswer, TheoremError, UndecidedError, TooManyPathsError) as error:
            return Found("UNMEASURED", reason=" ".join(str(error).split()), asked=tuple(asked))
        except ExplorationError as error:
            return Found("INVALID", reason=" ".join(str(error).split()), asked=tuple(asked))
        different = [trial for trial in trials if trial.differences]
        unknown = [answer for answer in asked if answer.result == "unknown"]
        if not different:
            return Found("EQUIVALENT", asked=tuple(asked))
        if unknown:
            return Found("UNMEASURED", (), unknown[0].detail, different[0].witness, tuple(asked))
        return Found("SURVIVED", (), "", different[0].witness, tuple(asked))


def _killers(asked: Iterable[Asked]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(answer.theorem for answer in asked if answer.result == "refuted"))


@dataclass
class _Trial:
    """One changed device before the theorems."""

    bench: Bench
    shipped: Shipped
    device: Device
    ways: Sequence[Way]
    complete: bool
    differences: list[Difference] = field(default_factory=list)
    tried: set[tuple[str, ...]] = field(default_factory=set)
    """Control states before and after (of the shipped code, of the copy), of which one difference was put to
    the theorems.
    """

    @property
    def witness(self) -> str:
        """Where the copy first ended otherwise."""
        if not self.differences:
            return ""
        first = self.differences[0]
        where = f"{self.device.name}, {first.way.control}: {first.member!r}"
        return f"{where}: {first.shipped!r}; now {first.other!r}"

    def quickly(self) -> list[Asked]:
        """One path of each kind whose member ends otherwise, before all others are looked at; first what
        raises.
        """
        asked: list[Asked] = []
        results = [(way, run(self.device, way)) for way in self.ways]
        results = [(way, result) for way, result in results if result != way.result]
        results.sort(key=lambda found: not isinstance(found[1], Exception))
        for way, result in results:
            if self._kind(way.control, way.result, result) not in self.tried:
                found = self._difference(way)
                if found is not None:
                    asked += self._put(found)
                    if _killers(asked):
                        break
        return asked

    def thoroughly(self) -> list[Asked]:
        """Every path; first what is new, one of each kind, then all of them together."""
        asked: list[Asked] = []
        known = {id(difference.way) for difference in self.differences}
        for way in self.ways:
            if id(way) not in known:
                found = self._difference(way)
                if found is not None and self._kind_of(found) not in self.tried:
                    asked += self._put(found)
                    if _killers(asked):
                        return asked
        if len(self.differences) > len(self.tried):
            asked += self._ask(self.differences)
        return asked

    def _kind_of(self, found: Difference) -> tuple[str, ...]:
        return self._kind(found.way.control, found.shipped, found.other)

    def _kind(self, control: str, *results: Any) -> tuple[str, ...]:
        ends = [
            "" if isinstance(result, Exception) else getattr(result[0], self.device.control).value
            for result in results
        ]
        return (control, *ends)

    def _difference(self, way: Way) -> Difference | None:
        found = difference(self.device, self.shipped.subject.device, way)
        if found is not None:
            self.differences.append(found)
        return found

    def _put(self, found: Difference) -> list[Asked]:
        self.tried.add(self._kind_of(found))
        return self._ask([found])

    def _ask(self, differences: list[Difference]) -> list[Asked]:
        raising = [difference for difference in differences if difference.raises is not None]
        if raising:
            return [_raised(self.device, self.shipped.subject.answered, raising[0])]
        asked: list[Asked] = []
        scans = as_scans(differences)
        for item in self.bench.theorems[self.device.name]:
            asked.append(self._theorem(item, differences, scans))
            if asked[-1].result == "refuted" and not self.complete:
                break
        return asked

    def _theorem(self, item: Theorem, differences: list[Difference], scans: tuple[Scan, ...]) -> Asked:
        began = time.monotonic()

        def said(result: str, where: str = "", detail: str = "") -> Asked:
            return Asked(item.name, result, where, detail, round(time.monotonic() - began, 3))

        unknown = ""
        with judging(self.device, scans):
            for query in claims(item):
                answer, model = _answer(query)
                if answer == z3.sat:
                    break
                if answer == z3.unknown:
                    unknown = unknown or f"{item.name}: {query.name}: {model}"
            else:
                return said("unknown", "", unknown) if unknown else said("holds")
        _replay(self.device, differences, model)
        with judging(self.shipped.subject.device, as_shipped_scans(differences)):
            for same in claims(item):
                if _answer(same)[0] != z3.unsat:
                    raise NoAnswer(f"{item.name} does not hold of the shipped code: {same.name}")
        return said("refuted", query.name)


def claims(item: Theorem) -> Iterator[Query]:
    """What the theorem says must have no counterexample; controls are not asked of a copy."""
    try:
        for query in item.build(*item.rows()):
            if query.expected == "unsat":
                yield query
    except (
        NotJudged
    ):  # the first control that speaks of a control state that is not judged; all claims come first
        return


def _answer(query: Query) -> tuple[z3.CheckSatResult, Any]:
    """The answer, with the model or the reason."""
    solver = z3.SimpleSolver()
    solver.set("timeout", LIMIT_MS)
    solver.add(*query.formulas.values())
    answer = solver.check()
    if answer == z3.sat:
        return answer, solver.model()
    return answer, solver.reason_unknown() if answer == z3.unknown else None


def _replay(device: Device, differences: list[Difference], model: z3.ModelRef) -> None:
    """The counterexample, run on the copy, ends as the explorer says. Raises NoAnswer when it does not."""
    for found in differences:
        for path in found.found.paths:
            if _true(model, found.way.path.condition) and _true(model, path.condition):
                got = run(device, found.way, model)
                if got != evaluated_plain(path.result, model):
                    raise NoAnswer(f"the counterexample, run in {found.way.control}, ends otherwise: {got!r}")
                return
    if not any(found.way.control == POWER_UP for found in differences):
        raise NoAnswer("the counterexample lies on no path of the copy")


def _true(model: z3.ModelRef, formula: z3.BoolRef) -> bool:
    return bool(z3.is_true(model.eval(formula, model_completion=True)))


def _raised(device: Device, theorem: str, found: Difference) -> Asked:
    path = found.raises
    assert path is not None
    got = run(device, found.way, path.example)
    if type(got) is not type(path.raised):
        raise NoAnswer(f"the scan that raises, run in {found.way.control}, gives {got!r}")
    return Asked(theorem, "refuted", found.way.control, f"raises {path.raised!r}")
