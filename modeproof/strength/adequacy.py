"""How strong the published vectors are: mutants of the shipped code, judged by the vectors alone.

The mutants are those that the theorems judge (implementation.py). Here each runs in a process of its own
against the suites of every published target that can reach its edit, the shortest suite first, and stops at
the first that tells it from the shipped code. One that the theorems have proved EQUIVALENT is not judged
again. Before the first long suite, what is left is put to an observer: it proves of some that nobody can tell
them from the shipped code by inputs and outputs. What reaches no published target is out of scope, and is
counted.

An answer holds as long as the code, the replay and that very suite are the same; so a suite that is new or
has changed is asked alone.
"""

from __future__ import annotations

import ast
import inspect
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol

from modeproof.errors import Unjudged
from modeproof.graph.implementation import from_module, load_implementation
from modeproof.graph.values import ValueForms
from modeproof.processes import in_forks
from modeproof.progress import Progress
from modeproof.registers.load import load_interface
from modeproof.registers.rows import Interface
from modeproof.strength import replay
from modeproof.strength.campaign import Judged, so_far
from modeproof.strength.implementation import Implementation, closure
from modeproof.strength.mutant import Mutant
from modeproof.strength.published import Published
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

    CopyError: type[Exception]

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


@dataclass
class Adequacy:
    """The mutants of one document's code and the suites that judge them; `proved`: what the theorems said."""

    code: Implementation
    copies: Copies
    observer: Observer
    suites: Sequence[Published]
    proved: Results
    interface: Interface = field(init=False)

    def __post_init__(self) -> None:
        self.interface = load_interface(self.place, self.code.document)

    @property
    def place(self) -> Path:
        """The root of the tree."""
        return self.code.place

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names of the suites in the order of asking."""
        return tuple(dict.fromkeys(one.name for one in self.suites))

    @cached_property
    def observes_before(self) -> str:
        """The suite before which the observer is asked: the first long one, or the last one."""
        scans = {
            name: sum(one.suite.scan_count for one in self.suites if one.name == name) for name in self.names
        }
        return next((name for name in self.names if scans[name] >= LONG), self.names[-1])

    @cached_property
    def targets(self) -> Mapping[str, str]:
        """The published targets that have vectors, and the module of each."""
        wanted = dict.fromkeys(one.target for one in self.suites)
        modules = {name.rpartition(".")[2]: name for name in self.code.reached}
        missing = [one for one in wanted if one not in modules]
        if missing:
            raise Unjudged(f"{missing[0]} has vectors, and no module of that name is judged")
        return {one: modules[one] for one in wanted}

    @cached_property
    def _reach(self) -> Mapping[str, frozenset[str]]:
        """For each target the modules that it can reach."""
        return {one: frozenset(closure(self.place, [module])) for one, module in self.targets.items()}

    def targets_of(self, mutant: Mutant) -> tuple[str, ...]:
        """The targets whose program the edit can change."""
        module = self.code.mutants[mutant.id][0]
        return tuple(one for one in self.targets if module in self._reach[one])

    @cached_property
    def every(self) -> tuple[Mutant, ...]:
        """Every mutant that can change a published target."""
        return tuple(one for one in self.code.every if self.targets_of(one))

    @cached_property
    def out_of_scope(self) -> tuple[Mutant, ...]:
        """The others."""
        return tuple(one for one in self.code.every if not self.targets_of(one))

    @cached_property
    def base(self) -> str:
        """A hash of the code and of what runs and compares it."""
        programs = [f"{name} {text}" for name, text in sorted(closure(self.place, self.code.reached).items())]
        return digest([*programs, _program_of(replay), _program_of(self.copies)])

    @cached_property
    def observes_by(self) -> str:
        """A hash of what the observer rests on."""
        return digest([self.base, self.code.base, _program_of(self.observer)])

    def theorems_say(self, mutant: Mutant) -> Mapping[str, Any] | None:
        """The judgement by theorems that holds for the code as it is now."""
        return self.code.find(self.proved, mutant)

    @cached_property
    def equivalent(self) -> frozenset[str]:
        """The mutants that the theorems have proved to be the shipped code."""
        said = ((one.id, self.theorems_say(one)) for one in self.every)
        return frozenset(
            id for id, record in said if record is not None and record["verdict"] == "EQUIVALENT"
        )

    def change(self, mutant: Mutant) -> Any:
        """The edit as what makes copies takes it."""
        told = self.code.change(mutant)
        return self.copies.Change(told["module"], told["definition"], told["text"], told["lines"])

    # ---- what is known

    def answers(self, results: Results, mutant: Mutant) -> list[dict[str, Any]]:
        """The answers that hold now, in the order of the suites."""
        record = results.records.get((mutant.id, self.base))
        if record is None:
            return []
        now = {(one.name, one.target): one.contents for one in self.suites}
        holding = [
            one for one in record["answers"] if now.get((one["suite"], one["target"]), "") == one["vectors"]
        ]
        return sorted(holding, key=lambda one: self.names.index(one["suite"]))

    def observed(self, results: Results, mutant: Mutant) -> Mapping[str, Any] | None:
        """What the observer said, if that holds now."""
        said = results.records.get((mutant.id, self.base), {}).get("observed")
        return said if said is not None and said["inputs"] == self.observes_by else None

    def to_ask(
        self,
        mutant: Mutant,
        answers: Sequence[Mapping[str, Any]],
        observed: Mapping[str, Any] | None,
        complete: bool,
    ) -> tuple[str, ...]:
        """The suites that are still to be asked: those up to the first that kills, or all.

        What is proved to be the same is asked of none; complete: of the short ones, as a check on both.
        """
        if any(one["result"] in (UNMEASURED, INVALID) for one in answers):
            return ()
        asked, caught = self.names, killers(answers)
        if mutant.id in self.equivalent or (observed is not None and observed["verdict"] == EQUIVALENT):
            asked = asked[: asked.index(self.observes_before)] if complete else ()
        elif caught and not complete:
            asked = asked[: asked.index(caught[0])]
        had = {(one["suite"], one["target"]) for one in answers}
        wanted = self.targets_of(mutant)
        open_ones = [
            one.name
            for one in self.suites
            if one.target in wanted
            and one.name in asked
            and one.name not in caught
            and (one.name, one.target) not in had
        ]
        return tuple(dict.fromkeys(open_ones))

    def judged(self, results: Results, mutant: Mutant, complete: bool = False) -> Judged | None:
        """The judgement, if all suites that must be asked have answered."""
        answers, observed = self.answers(results, mutant), self.observed(results, mutant)
        if self.to_ask(mutant, answers, observed, complete):
            return None
        record = results.records.get((mutant.id, self.base), {})
        return Judged(mutant, {**_about(mutant), **record, **self.verdict(mutant, answers, observed)})

    def known(self, results: Results) -> list[Judged]:
        """The mutants in scope that are judged."""
        found = (self.judged(results, one) for one in self.every)
        return [one for one in found if one is not None]

    def verdict(
        self, mutant: Mutant, answers: Sequence[Mapping[str, Any]], observed: Mapping[str, Any] | None
    ) -> dict[str, Any]:
        """The word, the suites that kill, and the reason, once all have answered.

        Raises Unjudged when a suite catches what is proved to be the same.
        """
        caught, word, reason = killers(answers), "SURVIVED", ""
        same = ""
        if mutant.id in self.equivalent:
            same = "the theorem campaign"
        elif observed is not None and observed["verdict"] == EQUIVALENT:
            same = "the observer: nobody can tell it by inputs and outputs"
        refusing = [one for one in answers if one["result"] == replay.REFUSES]
        unmeasured = [one for one in answers if one["result"] == UNMEASURED]
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
        elif any(one["result"] == INVALID for one in answers):
            word, reason = INVALID.upper(), answers[0]["detail"]
        elif refusing:
            caught = tuple(dict.fromkeys(one["suite"] for one in refusing))
            word, reason = "KILLED", f"{BY_REFUSAL}: {refusing[0]['detail']}"
        return {"verdict": word, "killers": list(caught), "reason": reason, "answers": list(answers)}


def killers(answers: Sequence[Mapping[str, Any]]) -> tuple[str, ...]:
    """The suites in which the mutant gives wrong outputs or raises, in the order of asking."""
    caught = (one["suite"] for one in answers if one["result"] in (replay.DIFFERS, replay.RAISES))
    return tuple(dict.fromkeys(caught))


def _about(mutant: Mutant) -> dict[str, Any]:
    return {
        "mutant": mutant.id,
        "module": mutant.module,
        "operator": mutant.operator,
        "definition": mutant.definition,
        "seconds": 0.0,
    }


def _program_of(module: object) -> str:
    """A module as a program without comments."""
    return ast.dump(ast.parse(inspect.getsource(module))) if isinstance(module, ModuleType) else ""


# ---------------------------------------------------------------------------------------------- the campaign


def judge_by_vectors(
    adequacy: Adequacy,
    chosen: Sequence[Mutant],
    results: Results,
    progress: Progress,
    jobs: int,
    complete: bool = False,
    limit: Callable[[float], float] = lambda shipped: max(LEAST_S, TIMES * shipped),
) -> list[Judged]:
    """The judgement of each chosen mutant, in their order; what is known already is not judged again.

    One suite after the other, the mutants that are left in parallel. Every suite must first pass the shipped
    code, and find a fault planted in it: Unjudged otherwise. `limit` gives the seconds for a mutant from
    those that the shipped code took. Ctrl-C ends the processes; what was judged stays. complete: also suites
    that come after the first killer, and of mutants that are proved EQUIVALENT the short ones, which must not
    kill them.
    """
    if results.remark:
        progress.say(results.remark)
    run = _Campaign(adequacy, results, progress, jobs, complete)
    before = sum(1 for one in chosen if adequacy.answers(results, one))
    if before:
        progress.say(f"{before} of {len(chosen)} mutants have answers from before")
    for name in adequacy.names:
        if name == adequacy.observes_before:
            run.observe(chosen)
        waiting = [one for one in chosen if name in run.to_ask(one)]
        if waiting:
            _Stage(run, name).run(waiting, limit)
    judged = [adequacy.judged(results, one, complete) for one in chosen]
    return [one for one in judged if one is not None]


@dataclass
class _Campaign:
    """What is known of the mutants so far, in the results; each new answer is written as it comes."""

    adequacy: Adequacy
    results: Results
    progress: Progress
    jobs: int
    complete: bool

    def answers(self, mutant: Mutant) -> list[dict[str, Any]]:
        """The answers of suites that hold."""
        return self.adequacy.answers(self.results, mutant)

    def to_ask(self, mutant: Mutant) -> tuple[str, ...]:
        """The suites that are still to be asked."""
        observed = self.adequacy.observed(self.results, mutant)
        return self.adequacy.to_ask(mutant, self.answers(mutant), observed, self.complete)

    def keep(
        self,
        mutant: Mutant,
        new: Sequence[dict[str, Any]] = (),
        observed: Mapping[str, Any] | None = None,
    ) -> None:
        """Write what is known of the mutant with what is new."""
        adequacy = self.adequacy
        answers = [*self.answers(mutant), *new]
        answers.sort(key=lambda one: adequacy.names.index(one["suite"]))
        said = observed or adequacy.observed(self.results, mutant)
        left = adequacy.to_ask(mutant, answers, said, self.complete)
        found = {"verdict": "", "killers": [], "reason": f"still to be asked: {', '.join(left)}"}
        if not left:
            found = adequacy.verdict(mutant, answers, said)
        self.results.add(
            {
                **_about(mutant),
                **found,
                "inputs": adequacy.base,
                "complete": not adequacy.to_ask(mutant, answers, said, True),
                "answers": answers,
                "observed": said,
                "seconds": round(sum(one["seconds"] for one in answers), 3),
            }
        )

    def each(
        self,
        task: str,
        work: Callable[[Mutant], Any],
        waiting: Sequence[Mutant],
        limit_s: float,
        take: Callable[[Mutant, Any, str], None],
    ) -> None:
        """Work on each mutant in a process of its own; `take` gets the result, or None and why."""
        began, done = time.monotonic(), 0
        for outcome in in_forks(work, waiting, self.jobs, limit_s):
            if outcome is not None:
                take(waiting[outcome.number], outcome.result, outcome.why)
                done += 1
            words = {one.id: self.results.records.get((one.id, self.adequacy.base), {}) for one in waiting}
            counted = {id: {"verdict": record.get("verdict", "")} for id, record in words.items()}
            self.progress.update(task, so_far(len(waiting), done, time.monotonic() - began, counted))

    def observe(self, chosen: Sequence[Mutant]) -> None:
        """Put what no suite has caught to the observer."""
        adequacy = self.adequacy
        waiting = [
            one
            for one in chosen
            if one.id not in adequacy.equivalent
            and self.to_ask(one)
            and adequacy.observed(self.results, one) is None
            and all(answer["result"] == replay.PASSES for answer in self.answers(one))
        ]
        if not waiting:
            return
        task = "observer"
        self.progress.expect(1)
        self.progress.begin(task)
        try:
            self.progress.update(task, "exploring the shipped code")
            bench = adequacy.observer.bench_of(adequacy.code.document)

            def work(mutant: Mutant) -> dict[str, Any]:
                change = adequacy.code.change(mutant)
                said = adequacy.observer.observe(bench, adequacy.change(mutant), change["file"])
                return {"verdict": said.verdict, "witness": said.witness, "reason": said.reason}

            def take(mutant: Mutant, said: dict[str, Any] | None, why: str) -> None:
                found = said or {"verdict": UNMEASURED.upper(), "witness": "", "reason": why}
                self.keep(mutant, observed={**found, "inputs": adequacy.observes_by})

            self.each(task, work, waiting, OBSERVER_S, take)
        finally:
            self.progress.end(task)


@dataclass
class _Stage:
    """One suite put to the mutants that are left."""

    campaign: _Campaign
    name: str
    vectors: dict[str, tuple[Vectors, str]] = field(default_factory=dict)

    @property
    def adequacy(self) -> Adequacy:
        """The mutants and the suites."""
        return self.campaign.adequacy

    def run(self, waiting: Sequence[Mutant], limit: Callable[[float], float]) -> None:
        """Judge them, and write each answer as it comes."""
        progress, task = self.campaign.progress, f"suite {self.name}"
        progress.expect(1)
        progress.begin(task)
        try:
            targets = {one for mutant in waiting for one in self.adequacy.targets_of(mutant)}
            limit_s = limit(self._load(task, targets))

            def take(mutant: Mutant, new: list[dict[str, Any]] | None, why: str) -> None:
                self.campaign.keep(mutant, new or [self._unmeasured(mutant, why, limit_s)])

            self.campaign.each(task, self._judge, waiting, limit_s, take)
        finally:
            progress.end(task)

    def _load(self, task: str, targets: set[str]) -> float:
        """Read the suite of each target, and let it judge the shipped code; the seconds that this takes."""
        adequacy, progress, seconds = self.adequacy, self.campaign.progress, 0.0
        document = adequacy.code.document
        forms = ValueForms([int(mode) for mode in adequacy.interface.constants.get("MODES", ())])
        for one in adequacy.suites:
            if one.name == self.name and one.target in targets:
                progress.update(task, f"reading {one.target}")
                package = adequacy.targets[one.target].split(".")[0]
                code = load_implementation(package, document, one.target)
                device = adequacy.interface.devices[one.target]
                vectors = vectors_of(one.suite, device, forms, code)
                progress.update(task, f"the shipped {one.target}, with a fault in its last scan")
                seconds += replay.control(vectors, code).seconds
                self.vectors[one.target] = vectors, one.contents
        return seconds

    def _judge(self, mutant: Mutant) -> list[dict[str, Any]]:
        """What this suite says of a mutant, for one target after the other until one catches it."""
        adequacy = self.adequacy
        wanted = [one for one in adequacy.targets_of(mutant) if one in self.vectors]
        had = {one["target"] for one in self.campaign.answers(mutant) if one["suite"] == self.name}
        found: list[dict[str, Any]] = []
        change = adequacy.change(mutant)
        try:
            copy = adequacy.copies.copied(change.module.rpartition(".")[0], change)
        except adequacy.copies.CopyError as error:
            return [self._answer(wanted[0], replay.Answer(INVALID, 0, detail=str(error)))]
        for target in wanted:
            if target not in had:
                module = adequacy.targets[target]
                code = from_module(copy.modules[module], f"{module} ({mutant.id})")
                found.append(self._answer(target, replay.replay(self.vectors[target][0], code)))
                if killers(found):
                    break
        return found

    def _answer(self, target: str, said: replay.Answer) -> dict[str, Any]:
        return {"suite": self.name, "target": target, "vectors": self.vectors[target][1], **asdict(said)}

    def _unmeasured(self, mutant: Mutant, why: str, limit_s: float) -> dict[str, Any]:
        target = next(one for one in self.adequacy.targets_of(mutant) if one in self.vectors)
        return self._answer(target, replay.Answer(UNMEASURED, 0, detail=why, seconds=limit_s))
