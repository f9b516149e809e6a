"""Judges all mutants of a document: what is known already is not judged again, the rest in parallel."""

from __future__ import annotations

import json
import threading
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from modeproof.errors import Unjudged
from modeproof.progress import Progress
from modeproof.strength.judge import Bench, as_record, judge
from modeproof.strength.mutant import Mutant
from modeproof.strength.operators import mutants
from modeproof.strength.register import Strength, Tier
from modeproof.strength.results import Results, digest, without_comments
from modeproof.strength.trial import cfg_of
from modeproof.tlc.children import stop_all

GRAPHS = "all graphs"
"""Stands for the tiers that compare graphs."""
WORDS = ("KILLED", "EQUIVALENT", "SURVIVED", "INVALID", "UNMEASURED")


@dataclass(frozen=True)
class Judged:
    """A mutant and the record of its judgement."""

    mutant: Mutant
    record: Mapping[str, Any]

    @property
    def word(self) -> str:
        """The verdict."""
        return str(self.record["verdict"])

    @property
    def killers(self) -> tuple[str, ...]:
        """The properties that it breaks, the first one first."""
        return tuple(self.record["killers"])

    @property
    def asked(self) -> tuple[str, ...]:
        """The tiers that were asked."""
        return tuple(one["tier"] for one in self.record["answers"])


def all_mutants(bench: Bench) -> tuple[Mutant, ...]:
    """Every mutant of every declared module. Raises Unjudged when a module gives none."""
    found: list[Mutant] = []
    untouched = stated(bench.strength)
    for module, rule in bench.strength.rules.items():
        of_module = mutants(bench.tree_of(module), module, rule, untouched)
        if not of_module:
            raise Unjudged(f"module {module} has no mutants; look at its behaviour in strength.toml")
        found += of_module
    twice = [name for name, count in Counter(one.id for one in found).items() if count > 1]
    if twice:
        raise Unjudged(f"two mutants have the id {twice[0]}")
    return tuple(found)


def stated(strength: Strength) -> frozenset[str]:
    """The names that are checked by the runs of the tiers: properties and type invariants."""
    names = {name for tier in strength.tiers for name in tier.run.properties}
    return frozenset(names | {name for tier in strength.tiers for name in tier.types})


def stamps_of(bench: Bench, module: str) -> dict[str, str]:
    """For each tier of this module, by its id, a hash of all that the tiers up to it rest on; also GRAPHS."""
    stamps: dict[str, str] = {}
    before = graphs = digest([bench.tools.jar_sha256, module])
    for tier in bench.strength.tiers_of(module):
        told = {key: value for key, value in asdict(tier).items() if key != "run"}
        texts = (without_comments(text) for _, text in sorted(bench.texts(tier).items()))
        parts = [json.dumps(told, sort_keys=True), cfg_of(bench.folder, tier), *texts]
        if tier.asks == "graph":
            graphs = digest([graphs, *parts])
        stamps[tier.id] = before = digest([before, *parts])
    return {GRAPHS: graphs, **stamps}


def rests_on(tiers: Sequence[Tier], record: Mapping[str, Any]) -> str:
    """What a judgement rests on: GRAPHS for equal graphs, else the tiers up to the one with this id.

    What a killed mutant never meets decides nothing about it.
    """
    if record["verdict"] == "EQUIVALENT":
        return GRAPHS
    asked = {answer["tier"] for answer in record["answers"]}
    if not asked or record["complete"] or record["verdict"] not in {"KILLED", "INVALID"}:
        return tiers[-1].id
    return [tier.id for tier in tiers if tier.id in asked or tier.when == "always"][-1]


def inputs_of(bench: Bench, module: str) -> str:
    """A hash of all that the judgement of this module's mutants rests on."""
    return list(stamps_of(bench, module).values())[-1]


@dataclass(frozen=True)
class Known:
    """Which of the results on the disk hold for the specification and the tiers as they are now."""

    bench: Bench
    results: Results

    @cached_property
    def _stamps(self) -> dict[str, dict[str, str]]:
        return {module: stamps_of(self.bench, module) for module in self.bench.strength.rules}

    def stamp(self, record: Mapping[str, Any]) -> str:
        """The hash of what a judgement rests on now; empty when a tier of it is gone."""
        module = str(record["module"])
        tiers = self.bench.strength.tiers_of(module)
        stamps = self._stamps[module]
        rests = rests_on(tiers, record)
        if rests != GRAPHS and any(one["tier"] not in stamps for one in record["answers"]):
            return ""
        return stamps[rests]

    def find(self, mutant: Mutant, complete: bool = False) -> dict[str, Any] | None:
        """The judgement that holds; one of fewer tiers does not do when `complete` is asked for."""
        found = None
        for record in self.results.of(mutant.id):
            if record["inputs"] == self.stamp(record) and (record["complete"] or not complete):
                found = record
        return found


def judge_all(
    bench: Bench,
    chosen: Sequence[Mutant],
    results: Results,
    progress: Progress,
    jobs: int,
    complete: bool = False,
) -> list[Judged]:
    """The judgement of each chosen mutant, in their order.

    Raises Unjudged when the original does not pass a tier. Ctrl-C ends the TLC runs; what was judged stays.
    """
    holding = Known(bench, results)
    known = {one.id: found for one in chosen if (found := holding.find(one, complete)) is not None}
    waiting = [one for one in chosen if one.id not in known]
    if results.remark:
        progress.say(results.remark)
    if known:
        progress.say(f"{len(known)} of {len(chosen)} mutants were judged before")
    began, done = time.monotonic(), 0
    stop = threading.Event()

    def work(mutant: Mutant) -> dict[str, Any] | None:
        if stop.is_set():
            return None
        verdict = judge(bench, mutant, complete)
        if stop.is_set():  # TLC was ended by us
            return None
        record = {
            "mutant": mutant.id,
            "module": mutant.module,
            "operator": mutant.operator,
            "definition": mutant.definition,
            "complete": complete,
            "seconds": round(verdict.seconds, 2),
            **as_record(verdict),
        }
        record["inputs"] = holding.stamp(record)
        results.add(record)  # here, so that an interruption loses nothing that was judged
        return record

    progress.expect(1)
    progress.begin("mutants")
    pool = ThreadPoolExecutor(max_workers=jobs)
    running: set[Future[dict[str, Any] | None]] = set()
    try:
        _controls(bench, waiting, pool)
        running = {pool.submit(work, one) for one in waiting}
        while running:
            finished, running = wait(running, timeout=1.0, return_when=FIRST_COMPLETED)
            for one in finished:
                record = one.result()
                if record is not None:
                    known[record["mutant"]] = record
                    done += 1
            progress.update("mutants", so_far(len(waiting), done, time.monotonic() - began, known))
    finally:
        stop.set()
        for one in running:
            one.cancel()
        if running:
            stop_all()
        pool.shutdown(wait=True, cancel_futures=True)
        progress.end("mutants")
    return [Judged(one, known[one.id]) for one in chosen]


def _controls(bench: Bench, waiting: Sequence[Mutant], pool: ThreadPoolExecutor) -> None:
    """Put every tier that always asks to the original first: a tier that does not pass judges nobody."""
    modules = {one.module for one in waiting}
    tiers = [tier for tier in bench.strength.tiers if modules & set(tier.modules)]
    for tier in tiers:
        bench.trial(tier)
    if waiting:
        list(
            pool.map(bench.control, (tier for tier in tiers if tier.asks != "graph" and tier.when != "left"))
        )


def so_far(total: int, done: int, seconds: float, known: Mapping[str, Mapping[str, Any]]) -> str:
    """How far a campaign has come, its rate, and the counts of verdicts, in one line."""
    counts = Counter(one["verdict"] for one in known.values())
    rate = done / seconds if seconds > 0 else 0.0
    left = f"{(total - done) / rate / 60:.0f} min remaining" if rate > 0 else "no rate yet"
    words = ", ".join(f"{counts[word]} {word}" for word in WORDS if counts[word])
    return f"{done} of {total}, {rate * 60:.0f} a minute, {left}; {words}"


def inputs_now(bench: Bench) -> dict[str, str]:
    """The hash of the inputs of each module, as they are now."""
    return {module: inputs_of(bench, module) for module in bench.strength.rules}


def default_jobs(place: Path) -> int:
    """As many TLC runs at once as there are cores, and as memory allows at 768 MiB each."""
    from modeproof.processes import cores
    from modeproof.tlc.schedule import memory_mb

    return max(1, min(cores(), memory_mb() // 768))
