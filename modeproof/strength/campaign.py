"""One campaign: the mutants of a document and who judges them.

What is known already is not judged again, the rest is judged in parallel, and each answer is kept at once
as a line of JSON in build/strength. Mutants of the specification are judged by its properties
(by_properties.py), mutants of the code by theorems (by_theorems.py) or by vectors (by_vectors.py).
"""

from __future__ import annotations

import contextlib
import fnmatch
import threading
import time
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from modeproof.ground import evidence
from modeproof.ground.places import build
from modeproof.ground.processes import in_forks
from modeproof.ground.progress import Progress
from modeproof.strength.mutant import Mutant
from modeproof.strength.register import Explained
from modeproof.strength.results import Results
from modeproof.tlc.children import stop_all

WORDS = ("KILLED", "EQUIVALENT", "SURVIVED", "INVALID", "UNMEASURED")
KIND = "strength"
Answers = Mapping[str, Any]
"""The record of a judgement: verdict, killers, reason, answers of single judges, seconds, and more."""


class Judges(ABC):
    """Who judges the mutants of one campaign, and what an answer of theirs rests on."""

    what: Literal["spec", "impl", "vectors"]
    """Also the name of the file of answers."""
    suffix: str
    """Of the files that are edited: tla or py."""
    command: str
    place: Path
    document: str
    register: Path
    """The register that explains survivors."""
    explained: Sequence[Explained]
    limit_s: float | None = None
    """Wall-clock time for a mutant, which gets a process; None: a thread, and the judges have limits."""

    @property
    @abstractmethod
    def mutants(self) -> tuple[Mutant, ...]:
        """Every mutant. Raises Unjudged when a module has none."""

    @property
    @abstractmethod
    def names(self) -> Sequence[str]:
        """All that can kill, in the order of asking."""

    @property
    def notes(self) -> Sequence[str]:
        """Lines to print before the counts."""
        return ()

    @property
    def out_of_scope(self) -> int:
        """The number of mutants that these judges cannot see."""
        return 0

    @property
    @abstractmethod
    def rests_on(self) -> Sequence[Path]:
        """The files that the evidence names."""

    @property
    @abstractmethod
    def tools(self) -> Mapping[str, Mapping[str, str | None]]:
        """The tools that judge."""

    @abstractmethod
    def lines_of(self, mutant: Mutant) -> Sequence[str]:
        """The text of a mutant's module without the edit."""

    @abstractmethod
    def prepare(
        self, waiting: Sequence[Mutant], complete: bool, jobs: int, tell: Callable[[str], None]
    ) -> None:
        """Show on the shipped text that the judges judge. Raises Unjudged when they do not."""

    @abstractmethod
    def judge(self, mutant: Mutant, complete: bool, before: Sequence[Answers]) -> dict[str, Any]:
        """What becomes of a mutant, as JSON; `before` are the records that there are of it."""

    def decided(self, mutant: Mutant, found: Answers) -> dict[str, Any]:
        """What `judge` gave, completed in this process."""
        return dict(found)

    @abstractmethod
    def stamp(self, record: Answers) -> str:
        """The hash of what a judgement rests on now; empty when a judge of it is gone."""

    def find(self, mutant: Mutant, complete: bool, before: Sequence[Answers]) -> dict[str, Any] | None:
        """The last judgement that still holds. With `complete`, all judges must have been asked."""
        holding = [
            record
            for record in before
            if record["inputs"] == self.stamp(record) and (record["complete"] or not complete)
        ]
        return dict(holding[-1]) if holding else None

    @abstractmethod
    def asked(self, record: Answers) -> Iterable[str]:
        """The names of those whom the mutant was put to."""

    @abstractmethod
    def shown(self, mutant: Mutant, record: Answers) -> Iterable[str]:
        """What each judge said, in lines."""


@dataclass(frozen=True)
class Judged:
    """A mutant and the record of its judgement."""

    mutant: Mutant
    record: Answers

    @property
    def word(self) -> str:
        """The verdict."""
        return str(self.record["verdict"])

    @property
    def killers(self) -> tuple[str, ...]:
        """What the mutant breaks, in the order in which it was found."""
        return tuple(self.record["killers"])


@dataclass
class Campaign:
    """The mutants of one document, their judges, and the answers so far."""

    judges: Judges
    results: Results

    @property
    def mutants(self) -> tuple[Mutant, ...]:
        """Every mutant."""
        return self.judges.mutants

    def find(self, mutant: Mutant, complete: bool = False) -> dict[str, Any] | None:
        """The judgement that holds now."""
        return self.judges.find(mutant, complete, self.results.of(mutant.id))

    @property
    def known(self) -> list[Judged]:
        """The mutants that are judged for the texts as they are now."""
        found = ((mutant, self.find(mutant)) for mutant in self.mutants)
        return [Judged(mutant, record) for mutant, record in found if record is not None]

    def run(
        self, chosen: Sequence[Mutant], progress: Progress, jobs: int, complete: bool = False
    ) -> list[Judged]:
        """The judgement of each chosen mutant, in their order.

        Raises Unjudged when the judges do not pass what is shipped. Ctrl-C ends what runs; what was judged
        stays. A mutant that takes too long, or whose process dies, is UNMEASURED.
        """
        known = {mutant.id: found for mutant in chosen if (found := self.find(mutant, complete)) is not None}
        waiting = [mutant for mutant in chosen if mutant.id not in known]
        if self.results.remark:
            progress.say(self.results.remark)
        if known:
            progress.say(f"{len(known)} of {len(chosen)} mutants were judged before")

        def tell(text: str) -> None:
            progress.update("mutants", text)

        if waiting:
            progress.expect(1)
            progress.begin("mutants")
            try:
                self.judges.prepare(waiting, complete, jobs, tell)
                began, done = time.monotonic(), 0
                with contextlib.closing(self._records(waiting, jobs, complete)) as records:
                    for record in records:
                        if record is not None:
                            known[record["mutant"]] = record
                            done += 1
                        tell(so_far(len(waiting), done, time.monotonic() - began, known))
            finally:
                progress.end("mutants")
        return [Judged(mutant, known[mutant.id]) for mutant in chosen]

    def _records(
        self, waiting: Sequence[Mutant], jobs: int, complete: bool
    ) -> Generator[dict[str, Any] | None, None, None]:
        """Each record after it is written to the disk. Now and then it yields None."""
        limit_s = self.judges.limit_s

        def judge(mutant: Mutant) -> dict[str, Any]:
            began = time.monotonic()
            found = self.judges.judge(mutant, complete, self.results.of(mutant.id))
            return {"seconds": round(time.monotonic() - began, 2), **found}

        def keep(mutant: Mutant, found: Mapping[str, Any]) -> dict[str, Any]:
            record = {**about(mutant), "complete": complete, **found}
            record["inputs"] = self.judges.stamp(record)
            self.results.add(record)
            return record

        if limit_s is None:
            yield from _in_threads(judge, keep, waiting, jobs)
            return
        for outcome in in_forks(judge, waiting, jobs, limit_s):
            if outcome is None:
                yield None
            else:
                mutant, found = waiting[outcome.number], outcome.result
                if found is None:
                    found = {**UNMEASURED, "reason": outcome.why, "seconds": limit_s}
                yield keep(mutant, self.judges.decided(mutant, found) if outcome.result else found)

    def record(self, judged: Sequence[Judged]) -> dict[str, Any]:
        """Write the evidence of a campaign over every mutant, of which `judged` have a verdict that holds.

        KILLED: each mutant is killed, proved equivalent, refused by the tools, or a survivor that is
        explained. UNMEASURED where one is not judged, SURVIVED where a survivor is not explained. Raises
        Unjudged when it cannot be written.
        """
        judges, every = self.judges, self.mutants
        counts = Counter(judgement.word for judgement in judged)
        missing = len(every) - len(judged)
        open_ones = unexplained(judges.explained, judged)
        problems = explanation_problems(judges.explained, judged, complete=not missing)
        verdict, reason = "KILLED", problems[0] if problems else ""
        if missing or counts["UNMEASURED"]:
            verdict = "UNMEASURED"
            reason = f"{missing + counts['UNMEASURED']} of {len(every)} mutants are not judged"
        elif open_ones:
            verdict = "SURVIVED"
            reason = f"{open_ones[0].mutant.id} survives without an explanation ({len(open_ones)} in all)"
        asked = Counter(
            name for judgement in judged for name in dict.fromkeys(judges.asked(judgement.record))
        )
        made = evidence.make(
            kind=KIND,
            id=f"{KIND}_{judges.what}",
            document=judges.document,
            verdict=verdict,
            expected="KILLED",
            as_expected=verdict == "KILLED" and not problems,
            strength=f"every single edit by the rules: {len(every)} mutants",
            command=judges.command,
            started=time.time(),
            seconds=float(sum(judgement.record["seconds"] for judgement in judged)),
            inputs=evidence.hashes(judges.place, judges.rests_on),
            tools=judges.tools,
            result={
                "campaign": judges.what,
                "every": len(every),
                "out_of_scope": judges.out_of_scope,
                "judges": {name: asked[name] for name in dict.fromkeys([*judges.names, *sorted(asked)])},
                "mutants": [_told(judgement, judges.explained) for judgement in judged],
                "problems": problems,
            },
            reason=reason,
        )
        evidence.write(judges.place, made)
        return made


UNMEASURED: Answers = {"verdict": "UNMEASURED", "killers": [], "witness": "", "answers": []}


def results_path(place: Path, document: str, what: str) -> Path:
    """Where the answers of a campaign lie; `what` is spec, impl or vectors."""
    return build(place) / "strength" / document / f"{what}.jsonl"


def about(mutant: Mutant) -> dict[str, Any]:
    """What a record says of its mutant."""
    return {
        "mutant": mutant.id,
        "module": mutant.module,
        "operator": mutant.operator,
        "definition": mutant.definition,
    }


def so_far(total: int, done: int, seconds: float, known: Mapping[str, Answers]) -> str:
    """How far a campaign has come, its rate, and the counts of verdicts, in one line."""
    counts = Counter(record["verdict"] for record in known.values())
    rate = done / seconds if seconds > 0 else 0.0
    left = f"{(total - done) / rate / 60:.0f} min remaining" if rate > 0 else "no rate yet"
    words = ", ".join(f"{counts[word]} {word}" for word in WORDS if counts[word])
    return f"{done} of {total}, {rate * 60:.0f} a minute, {left}; {words}"


def summary(judged: Sequence[Judged], unexplained_count: int) -> str:
    """Counts and score in one line: killed of those that are neither invalid nor equivalent."""
    counts = Counter(judgement.word for judgement in judged)
    real = counts["KILLED"] + counts["SURVIVED"] + counts["UNMEASURED"]
    score = f"{100 * counts['KILLED'] / real:.1f} %" if real else "none"
    words = ", ".join(f"{counts[word]} {word}" for word in WORDS)
    return (
        f"{len(judged)} mutants: {words}; score {counts['KILLED']} of {real} ({score}); "
        f"{unexplained_count} unexplained"
    )


def _told(judgement: Judged, explained: Sequence[Explained]) -> dict[str, Any]:
    """A mutant as the evidence has it."""
    mutant = judgement.mutant
    told: dict[str, Any] = {
        "id": mutant.id,
        "module": mutant.module,
        "definition": mutant.definition,
        "operator": mutant.operator,
        "line": mutant.line,
        "old": mutant.old,
        "new": mutant.new,
        "verdict": judgement.word,
        "killers": list(judgement.killers),
    }
    if judgement.record["reason"] and judgement.word != "KILLED":
        told["reason"] = str(judgement.record["reason"])[:200]
    found = explanation_of(explained, mutant.id) if judgement.word == "SURVIVED" else None
    return told if found is None else {**told, "kind": found.kind, "why": found.why}


# ---------------------------------------------------------------------------------------- explanations


def explanation_of(explained: Sequence[Explained], mutant: str) -> Explained | None:
    """The explanation that names a mutant, if there is one."""
    for row in explained:
        if any(fnmatch.fnmatchcase(mutant, pattern) for pattern in row.ids):
            return row
    return None


def unexplained(explained: Sequence[Explained], judged: Sequence[Judged]) -> list[Judged]:
    """The survivors that nobody has explained."""
    return [
        judgement
        for judgement in judged
        if judgement.word == "SURVIVED" and explanation_of(explained, judgement.mutant.id) is None
    ]


def explanation_problems(
    explained: Sequence[Explained], judged: Sequence[Judged], complete: bool
) -> list[str]:
    """Explanations that explain nothing: of a mutant that is no survivor, or (when all mutants were judged)
    that is not there any more; and mutants that are explained twice.
    """
    problems: list[str] = []
    words = {judgement.mutant.id: judgement.word for judgement in judged}
    seen: set[str] = set()
    for row in explained:
        for pattern in row.ids:
            matched = fnmatch.filter(words, pattern)
            if not matched and complete:
                problems.append(f"{pattern} is explained and is no mutant")
            for name in matched:
                if words[name] != "SURVIVED":
                    problems.append(f"{name} is explained as a survivor and is {words[name]}")
                if name in seen:
                    problems.append(f"{name} is explained twice")
                seen.add(name)
    return problems


# --------------------------------------------------------------------------------------------- threads


def _in_threads(
    judge: Callable[[Mutant], dict[str, Any]],
    keep: Callable[[Mutant, Mapping[str, Any]], dict[str, Any]],
    waiting: Sequence[Mutant],
    jobs: int,
) -> Iterator[dict[str, Any] | None]:
    """Each record as it comes. Each is kept in its thread, so that an interruption loses none.

    However this ends, no process that a thread has started is left behind.
    """
    stop = threading.Event()

    def work(mutant: Mutant) -> dict[str, Any] | None:
        if stop.is_set():
            return None
        found = judge(mutant)
        return None if stop.is_set() else keep(mutant, found)  # if set, we ended TLC

    pool = ThreadPoolExecutor(max_workers=jobs)
    running: set[Future[dict[str, Any] | None]] = {pool.submit(work, mutant) for mutant in waiting}
    try:
        while running:
            finished, running = wait(running, timeout=1.0, return_when=FIRST_COMPLETED)
            for future in finished:
                yield future.result()
            yield None
    finally:
        stop.set()
        for future in running:
            future.cancel()
        if running:
            stop_all()
        pool.shutdown(wait=True, cancel_futures=True)
