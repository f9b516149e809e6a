"""Mutants of the shipped code, judged by the published vectors alone.

Each mutant runs against the suites of every published target that can reach its edit, the shortest suite
first, up to the first that tells it from the shipped code. One that the theorems have proved EQUIVALENT is
not judged again. Before the first long suite, what is left is put to an observer: it proves of some that
nobody can tell them from the shipped code by inputs and outputs. What reaches no published target is out of
scope, and is counted.

An answer holds as long as the code, the replay and that very suite are the same; so a suite that is new or
has changed is asked alone.
"""

from __future__ import annotations

import ast
import inspect
import signal
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from functools import cached_property
from pathlib import Path
from types import FrameType, ModuleType
from typing import Any, Protocol

from modeproof.graph.implementation import from_module, load_implementation
from modeproof.graph.values import ValueForms
from modeproof.ground.errors import Unjudged
from modeproof.registers.load import load_interface
from modeproof.strength import replay
from modeproof.strength.by_theorems import ByTheorems
from modeproof.strength.campaign import Answers, Judges
from modeproof.strength.code import files_of, programs
from modeproof.strength.mutant import Mutant
from modeproof.strength.published import Published
from modeproof.strength.register import code_path
from modeproof.strength.replay import Vectors, vectors_of
from modeproof.strength.results import Results, digest

LEAST_S, TIMES = 20.0, 30
"""A mutant gets so many times as long as the shipped code took for a suite, and at least these seconds."""
UNMEASURED, INVALID = "unmeasured", "invalid"
EQUIVALENT = "EQUIVALENT"
BY_REFUSAL = "only refuses what it must answer"
LONG = 100_000
"""Scans of a suite that take as long as the observer needs for a mutant."""
OBSERVER_S = 600.0
"""Wall-clock time of the observer for one mutant."""


class Copies(Protocol):
    """What makes a copy of a package with one definition changed: see proofs/mutants/copies.py."""

    @property
    def CopyError(self) -> type[Exception]:
        """What it raises."""

    def Change(self, module: str, definition: str, text: str, lines: tuple[int, int] | None) -> Any:
        """A change."""

    def copied(self, package: str, change: Any) -> Any:
        """The copy; its `modules` are the copied modules by name."""


class Observer(Protocol):
    """What proves that nobody can tell a changed copy from the code: see proofs/mutants/observed.py."""

    def bench_of(self, document: str) -> Any:
        """What it needs to know of the shipped code."""

    def observe(self, bench: Any, change: Any, file: str) -> Any:
        """A verdict (EQUIVALENT, DIFFERS or UNMEASURED), a witness and a reason."""


class ByVectors(Judges):
    """The mutants of one document's code and the suites that judge them; `proved`: what the theorems said."""

    what = "vectors"
    suffix = "py"

    def __init__(
        self,
        theorems: ByTheorems,
        copies: Copies,
        observer: Observer,
        suites: Sequence[Published],
        proved: Results,
        limit: Callable[[float], float] = lambda shipped: max(LEAST_S, TIMES * shipped),
    ) -> None:
        """`limit` gives the seconds for a mutant and a suite from those that the shipped code took."""
        self.theorems, self.code, self.proved = theorems, theorems.code, proved
        self.copies, self.observer, self.suites, self.limit = copies, observer, suites, limit
        self.place, self.document = self.code.place, self.code.document
        self.command = f"modeproof mutate impl --judge vectors --document {self.document}"
        self.register = code_path(self.place, self.document)
        self.explained = theorems.code.register.explained("vectors")
        self.interface = load_interface(self.place, self.document)
        self._vectors: dict[tuple[str, str], tuple[Vectors, float]] = {}
        self._observer_bench: Any = None

    # ---- suites, targets, mutants

    @cached_property
    def names(self) -> Sequence[str]:
        """The names of the suites in the order of asking."""
        return tuple(dict.fromkeys(suite.name for suite in self.suites))

    @cached_property
    def observes_before(self) -> str:
        """The suite before which the observer is asked: the first long one, or the last one."""
        scans = dict.fromkeys(self.names, 0)
        for suite in self.suites:
            scans[suite.name] += suite.suite.scan_count
        return next((name for name in self.names if scans[name] >= LONG), self.names[-1])

    @cached_property
    def targets(self) -> Mapping[str, str]:
        """The published targets that have vectors, and the module of each."""
        wanted = dict.fromkeys(suite.target for suite in self.suites)
        modules = {name.rpartition(".")[2]: name for name in self.code.reached}
        missing = [target for target in wanted if target not in modules]
        if missing:
            raise Unjudged(f"{missing[0]} has vectors, and no module of that name is judged")
        return {target: modules[target] for target in wanted}

    @cached_property
    def _reach(self) -> Mapping[str, frozenset[str]]:
        """For each target the modules that it can reach."""
        return {target: frozenset(files_of(self.place, [name])) for target, name in self.targets.items()}

    def targets_of(self, mutant: Mutant) -> tuple[str, ...]:
        """The targets whose program the edit can change."""
        module = self.code.module_of(mutant)
        return tuple(target for target in self.targets if module in self._reach[target])

    @cached_property
    def mutants(self) -> tuple[Mutant, ...]:
        """Every mutant that can change a published target."""
        return tuple(mutant for mutant in self.code.mutants if self.targets_of(mutant))

    @property
    def out_of_scope(self) -> int:
        """The others."""
        return len(self.code.mutants) - len(self.mutants)

    @property
    def notes(self) -> Sequence[str]:
        """Who judges, and what is out of scope."""
        return (
            f"suites: {', '.join(self.names)}; targets: {', '.join(self.targets)}",
            f"{self.out_of_scope} mutants more reach no published target and are out of scope",
        )

    @property
    def rests_on(self) -> Sequence[Path]:
        """The register, the code, and the vector files."""
        return [self.register, *self.code.files, *(suite.suite.path for suite in self.suites)]

    @property
    def tools(self) -> Mapping[str, Mapping[str, str | None]]:
        """The suites are run in this process."""
        return {}

    def lines_of(self, mutant: Mutant) -> Sequence[str]:
        """The module without the edit."""
        return self.code.lines_of(mutant)

    # ---- what a judgement rests on

    @cached_property
    def base(self) -> str:
        """A hash of the code and of what runs and compares it."""
        code = programs(self.place, self.code.reached)
        return digest([*code, _program_of(replay), _program_of(self.copies)])

    @cached_property
    def observes_by(self) -> str:
        """A hash of what the observer rests on."""
        return digest([self.base, self.theorems.base, _program_of(self.observer)])

    def stamp(self, record: Answers) -> str:
        """The hash of the code and the replay. Each answer also holds the hash of its suite."""
        return self.base

    def theorems_say(self, mutant: Mutant) -> Answers | None:
        """The judgement by theorems that holds for the code as it is now."""
        return self.theorems.find(mutant, False, self.proved.of(mutant.id))

    @cached_property
    def equivalent(self) -> frozenset[str]:
        """The mutants that the theorems have proved to be the shipped code."""
        said = ((mutant.id, self.theorems_say(mutant)) for mutant in self.mutants)
        return frozenset(id for id, record in said if record is not None and record["verdict"] == EQUIVALENT)

    def answers(self, before: Sequence[Answers]) -> list[dict[str, Any]]:
        """The answers that hold now, in the order of the suites."""
        now = {(suite.name, suite.target): suite.contents for suite in self.suites}
        holding = [
            answer
            for record in before
            if record["inputs"] == self.base
            for answer in record["answers"]
            if now.get((answer["suite"], answer["target"]), "") == answer["vectors"]
        ]
        return self._in_order(holding)

    def observed(self, before: Sequence[Answers]) -> Mapping[str, Any] | None:
        """What the observer said, if that holds now."""
        said = [record.get("observed") for record in before if record["inputs"] == self.base]
        return next(
            (
                observed
                for observed in said
                if observed is not None and observed["inputs"] == self.observes_by
            ),
            None,
        )

    def _in_order(self, answers: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
        return sorted(answers, key=lambda answer: self.names.index(answer["suite"]))

    def find(self, mutant: Mutant, complete: bool, before: Sequence[Answers]) -> dict[str, Any] | None:
        """The judgement, if all suites that must be asked have answered."""
        answers, observed = self.answers(before), self.observed(before)
        if self.to_ask(mutant, answers, observed, complete):
            return None
        held = next((record for record in before if record["inputs"] == self.base), {})
        named = {"mutant": mutant.id, "complete": complete, "inputs": self.base, "seconds": 0.0}
        return {**named, **held, **self.verdict(mutant, answers, observed)}

    def asked(self, record: Answers) -> Iterable[str]:
        """The suites that were asked."""
        return (answer["suite"] for answer in record["answers"])

    def to_ask(
        self, mutant: Mutant, answers: Sequence[Answers], observed: Answers | None, complete: bool
    ) -> tuple[str, ...]:
        """The suites that are still to be asked: those up to the first that kills, or all.

        What is proved to be the same is asked of none; complete: of the short ones, as a check on both.
        """
        if any(answer["result"] in (UNMEASURED, INVALID) for answer in answers):
            return ()
        asked, caught = list(self.names), killers(answers)
        if mutant.id in self.equivalent or (observed is not None and observed["verdict"] == EQUIVALENT):
            asked = asked[: asked.index(self.observes_before)] if complete else []
        elif caught and not complete:
            asked = asked[: asked.index(caught[0])]
        had = {(answer["suite"], answer["target"]) for answer in answers}
        wanted = self.targets_of(mutant)
        left = [
            suite.name
            for suite in self.suites
            if suite.target in wanted
            and suite.name in asked
            and suite.name not in caught
            and (suite.name, suite.target) not in had
        ]
        return tuple(dict.fromkeys(left))

    def verdict(self, mutant: Mutant, answers: Sequence[Answers], observed: Answers | None) -> dict[str, Any]:
        """The word, the suites that kill, and the reason, once all have answered.

        Raises Unjudged when a suite catches what is proved to be the same.
        """
        caught, word, reason = killers(answers), "SURVIVED", ""
        same = ""
        if mutant.id in self.equivalent:
            same = "the theorem campaign"
        elif observed is not None and observed["verdict"] == EQUIVALENT:
            same = "the observer: nobody can tell it by inputs and outputs"
        refusing = [answer for answer in answers if answer["result"] == replay.REFUSES]
        unmeasured = [answer for answer in answers if answer["result"] == UNMEASURED]
        if same and (caught or refusing):
            name = (caught or [refusing[0]["suite"]])[0]
            raise Unjudged(
                f"{mutant.id} is proved EQUIVALENT by {same}, and the suite {name} tells it from the shipped "
                "code: one of the two judges is wrong"
            )
        if same:
            word, reason = EQUIVALENT, f"proved by {same}"
        elif caught:
            word = "KILLED"
        elif unmeasured:
            word, reason = UNMEASURED.upper(), unmeasured[0]["detail"]
        elif any(answer["result"] == INVALID for answer in answers):
            word, reason = INVALID.upper(), answers[0]["detail"]
        elif refusing:
            caught = tuple(dict.fromkeys(answer["suite"] for answer in refusing))
            word, reason = "KILLED", f"{BY_REFUSAL}: {refusing[0]['detail']}"
        return {"verdict": word, "killers": list(caught), "reason": reason, "answers": list(answers)}

    def shown(self, mutant: Mutant, record: Answers) -> Iterable[str]:
        """What each suite said, the observer, and the theorems."""
        for answer in record["answers"]:
            case = f"{answer['case']}, scan {answer['scan']}: " if answer["case"] else ""
            where = f"; {case}{answer['detail']}" if case or answer["detail"] else ""
            yield (
                f"    {answer['suite']} {answer['target']}: {answer['result']} after "
                f"{answer['scans']:,} scans{where}"
            )
        said = record.get("observed")
        if said:
            yield f"    observer: {said['verdict']}  {said['witness'] or said['reason']}"
        proved = self.theorems_say(mutant)
        if proved is not None:
            yield f"    by theorems: {proved['verdict']}  {', '.join(proved['killers'])}"

    # ---- judging

    def prepare(
        self, waiting: Sequence[Mutant], complete: bool, jobs: int, tell: Callable[[str], None]
    ) -> None:
        """Let every suite that may be asked judge the shipped code; explore it for the observer.

        Every suite must pass the shipped code, and find a fault planted in it: Unjudged otherwise.
        """
        targets = {target for mutant in waiting for target in self.targets_of(mutant)}
        forms = ValueForms([int(mode) for mode in self.interface.constants.get("MODES", ())])
        for suite in self.suites:
            if suite.target in targets:
                tell(f"suite {suite.name}: the shipped {suite.target}, with a fault in its last scan")
                package = self.targets[suite.target].split(".")[0]
                code = load_implementation(package, self.document, suite.target)
                vectors = vectors_of(suite.suite, self.interface.devices[suite.target], forms, code)
                seconds = replay.control(vectors, code).seconds
                self._vectors[suite.name, suite.target] = vectors, self.limit(seconds)
        if any(mutant.id not in self.equivalent for mutant in waiting):
            tell("observer: exploring the shipped code")
            self._observer_bench = self.observer.bench_of(self.document)
        self.limit_s = 60.0 + OBSERVER_S + sum(limit_s for _, limit_s in self._vectors.values())

    def judge(self, mutant: Mutant, complete: bool, before: Sequence[Answers]) -> dict[str, Any]:
        """What becomes of a mutant: the suites that are still to be asked, one after the other."""
        answers, observed = self.answers(before), self.observed(before)
        for name in self.names:
            if (
                name == self.observes_before
                and observed is None
                and self._undecided(mutant, answers, complete)
            ):
                observed = self._observe(mutant)
            if name in self.to_ask(mutant, answers, observed, complete):
                answers = self._in_order([*answers, *self._ask(name, mutant, answers)])
        return {
            "answers": answers,
            "complete": not self.to_ask(mutant, answers, observed, True),
            "observed": observed,
            "seconds": round(sum(answer["seconds"] for answer in answers), 3),
        }

    def decided(self, mutant: Mutant, found: Answers) -> dict[str, Any]:
        """The verdict from all answers. Raises Unjudged when two judges contradict each other."""
        return {**found, **self.verdict(mutant, found["answers"], found["observed"])}

    def _undecided(self, mutant: Mutant, answers: Sequence[Answers], complete: bool) -> bool:
        passes = all(answer["result"] == replay.PASSES for answer in answers)
        left = self.to_ask(mutant, answers, None, complete)
        return passes and bool(left) and mutant.id not in self.equivalent

    def _observe(self, mutant: Mutant) -> dict[str, Any]:
        said = self.observer.observe(
            self._observer_bench, self._change(mutant), self.code.change(mutant)["file"]
        )
        found = {"verdict": said.verdict, "witness": said.witness, "reason": said.reason}
        return {**found, "inputs": self.observes_by}

    def _change(self, mutant: Mutant) -> Any:
        """The edit as what makes copies takes it."""
        told = self.code.change(mutant)
        return self.copies.Change(told["module"], told["definition"], told["text"], told["lines"])

    def _ask(self, name: str, mutant: Mutant, answers: Sequence[Answers]) -> list[dict[str, Any]]:
        """What a suite says of a mutant, for one target after the other until one catches it."""
        wanted = [target for target in self.targets_of(mutant) if (name, target) in self._vectors]
        had = {answer["target"] for answer in answers if answer["suite"] == name}
        found: list[dict[str, Any]] = []
        change = self._change(mutant)
        for target in wanted:
            if target not in had:
                vectors, limit_s = self._vectors[name, target]
                try:
                    with _at_most(limit_s):
                        copy = self.copies.copied(change.module.rpartition(".")[0], change)
                        module = self.targets[target]
                        code = from_module(copy.modules[module], f"{module} ({mutant.id})")
                        said = replay.replay(vectors, code)
                except self.copies.CopyError as error:
                    said = replay.Answer(INVALID, 0, detail=str(error))
                except _TimeUp as up:
                    said = replay.Answer(UNMEASURED, 0, detail=str(up), seconds=limit_s)
                found.append({**self._about(name, target), **asdict(said)})
                if said.caught or said.result in (INVALID, UNMEASURED):
                    break
        return found

    def _about(self, name: str, target: str) -> dict[str, str]:
        contents = {(suite.name, suite.target): suite.contents for suite in self.suites}
        return {"suite": name, "target": target, "vectors": contents[name, target]}


def killers(answers: Sequence[Answers]) -> tuple[str, ...]:
    """The suites in which the mutant gives wrong outputs or raises, in the order of asking."""
    caught = (answer["suite"] for answer in answers if answer["result"] in (replay.DIFFERS, replay.RAISES))
    return tuple(dict.fromkeys(caught))


def _program_of(module: object) -> str:
    """A module as a program without comments."""
    return ast.dump(ast.parse(inspect.getsource(module))) if isinstance(module, ModuleType) else ""


class _TimeUp(BaseException):
    """The time for a suite is over. No `except Exception` of a mutant or of the replay catches it."""


@contextmanager
def _at_most(limit_s: float) -> Iterator[None]:
    """Raise _TimeUp when this takes longer, in the main thread of a process of its own."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise _TimeUp(f"the limit of {limit_s:.0f} s came first")

    signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, limit_s)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
