"""Mutants of the specification, judged by its properties: see mutant_judge.py for how TLC is asked."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from functools import cached_property
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.made import cfg_text
from modeproof.strength.campaign import Answers, Judges
from modeproof.strength.mutant import Mutant
from modeproof.strength.mutant_judge import Bench, as_record, judge
from modeproof.strength.operators import mutants
from modeproof.strength.register import Tier, path_of
from modeproof.strength.results import digest, without_comments
from modeproof.tlc.start_up import entries

GRAPHS = "all graphs"
"""Stands for the tiers that compare graphs."""


class ByProperties(Judges):
    """The device modules of one document and the tiers that judge their mutants."""

    what = "spec"
    suffix = "tla"

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.place, self.document = bench.place, bench.strength.document
        self.command = f"modeproof mutate spec --document {self.document}"
        self.register = path_of(self.place, self.document)
        self.explained = bench.strength.explained

    @cached_property
    def mutants(self) -> tuple[Mutant, ...]:
        """Every mutant of every declared module. Raises Unjudged when a module gives none."""
        found: list[Mutant] = []
        untouched = self._stated()
        for module, rule in self.bench.strength.rules.items():
            of_module = mutants(self.bench.tree_of(module), module, rule, untouched)
            if not of_module:
                raise Unjudged(f"module {module} has no mutants; look at its behaviour in strength.toml")
            found += of_module
        twice = [name for name, count in Counter(mutant.id for mutant in found).items() if count > 1]
        if twice:
            raise Unjudged(f"two mutants have the id {twice[0]}")
        return tuple(found)

    def _stated(self) -> frozenset[str]:
        """The names that are checked by the runs of the tiers: properties and type invariants."""
        tiers = self.bench.strength.tiers
        return frozenset(name for tier in tiers for name in (*tier.run.properties, *tier.types))

    @property
    def names(self) -> Sequence[str]:
        """The properties of the tiers."""
        tiers = self.bench.strength.tiers
        return tuple(dict.fromkeys(name for tier in tiers for name in tier.run.properties))

    @property
    def rests_on(self) -> Sequence[Path]:
        """The register, the device modules, and the runs of the tiers."""
        folder, strength = self.bench.folder, self.bench.strength
        modules = [folder / f"{module}.tla" for module in strength.rules]
        return [self.register, *modules, folder / "runs.toml"]

    @property
    def tools(self) -> Mapping[str, Mapping[str, str | None]]:
        """TLC and its Java."""
        tools = self.bench.tools
        version = "pinned" if tools.pinned else "not pinned"
        return {
            "tla2tools": {"version": version, "sha256": tools.jar_sha256},
            "java": entries(tools)["java"],
        }

    def lines_of(self, mutant: Mutant) -> Sequence[str]:
        """The module without the edit."""
        return self.bench.tree_of(mutant.module).texts[mutant.module]

    # ---- judging

    def prepare(
        self, waiting: Sequence[Mutant], complete: bool, jobs: int, tell: Callable[[str], None]
    ) -> None:
        """Put every tier that always asks to the original first: a tier that does not pass judges nobody."""
        modules = {mutant.module for mutant in waiting}
        tiers = [tier for tier in self.bench.strength.tiers if modules & set(tier.modules)]
        tell("the original")
        for tier in tiers:
            self.bench.trial(tier)
        first = [tier for tier in tiers if tier.asks != "graph" and tier.when != "left"]
        with ThreadPoolExecutor(max_workers=jobs) as pool:
            list(pool.map(self.bench.control, first))

    def judge(self, mutant: Mutant, complete: bool, before: Sequence[Answers]) -> dict[str, Any]:
        """What becomes of a mutant."""
        verdict = judge(self.bench, mutant, complete)
        return {**as_record(verdict), "seconds": round(verdict.seconds, 2)}

    # ---- what a judgement rests on

    @cached_property
    def stamps(self) -> Mapping[str, Mapping[str, str]]:
        """For each module and tier a hash of all that the tiers up to it rest on; also GRAPHS."""
        return {module: self._stamps_of(module) for module in self.bench.strength.rules}

    def _stamps_of(self, module: str) -> dict[str, str]:
        bench = self.bench
        stamps: dict[str, str] = {}
        before = graphs = digest([bench.tools.jar_sha256, module])
        for tier in bench.strength.tiers_of(module):
            told = {key: value for key, value in asdict(tier).items() if key != "run"}
            texts = (without_comments(text) for _, text in sorted(bench.texts(tier).items()))
            parts = [json.dumps(told, sort_keys=True), cfg_text(bench.place, tier.run), *texts]
            if tier.asks == "graph":
                graphs = digest([graphs, *parts])
            stamps[tier.id] = before = digest([before, *parts])
        return {GRAPHS: graphs, **stamps}

    def stamp(self, record: Answers) -> str:
        """The hash of what a judgement rests on now; empty when a tier of it is gone."""
        module = str(record["module"])
        stamps = self.stamps[module]
        rests = rests_on(self.bench.strength.tiers_of(module), record)
        if rests != GRAPHS and any(answer["tier"] not in stamps for answer in record["answers"]):
            return ""
        return stamps[rests]

    def asked(self, record: Answers) -> Iterable[str]:
        """The properties that were asked."""
        return (name for answer in record["answers"] for name in answer.get("asked", ()))

    def shown(self, mutant: Mutant, record: Answers) -> Iterable[str]:
        """What each tier said."""
        for answer in record["answers"]:
            broken = ", ".join(answer["broken"])
            said = f"{answer['tier']}: {answer['result']}{': ' if broken else ''}{broken}"
            yield f"    {said}, {answer['seconds']} s"


def rests_on(tiers: Sequence[Tier], record: Answers) -> str:
    """What a judgement rests on: GRAPHS for equal graphs, else the tiers up to the one with this id.

    What a killed mutant never meets decides nothing about it.
    """
    if record["verdict"] == "EQUIVALENT":
        return GRAPHS
    asked = {answer["tier"] for answer in record["answers"]}
    if not asked or record["complete"] or record["verdict"] not in {"KILLED", "INVALID"}:
        return tiers[-1].id
    return [tier.id for tier in tiers if tier.id in asked or tier.when == "always"][-1]
