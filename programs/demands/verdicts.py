"""The verdict on each demand: PROVED for ever, BROKEN by scans that were replayed, or UNKNOWN."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import z3

from modeproof.ground.errors import Unjudged
from modeproof.kit.demands import Demand
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.vectors import open_suite
from programs.demands.watched import Beside, Broken
from programs.equality.replay import MOST_SCANS, SUITES, Run
from programs.equality.shorten import fewer
from programs.invariants.houdini import Houdini
from programs.invariants.induction import Proof, System, holds_up, induction, shortest, spacer
from programs.invariants.located import Located
from programs.invariants.word_numbers import spacer_over_numbers
from programs.semantics.terms import compared_with

Word = Literal["PROVED", "BROKEN", "UNKNOWN"]
TYPES = "types"
"""The id of what is asked of every program besides: that it stays within its types."""
FEW_SCANS, MOST_FOUND = 8, 40
"""Scans of a counterexample that is looked for at once, and in the end."""
SHORT_S = 5.0
"""CPU seconds for fewer scans than those that are known; the same for the rest, once a demand is broken."""
MOST_SAMPLES = 1_200
Tell = Callable[[str], None]


@dataclass(frozen=True)
class Asked:
    """A demand, or that the program stays within its types (no clauses)."""

    id: str
    says: str
    clauses: tuple[str, ...] = ()
    text: str = ""
    """The same in the notation of the register."""

    @staticmethod
    def of(row: Demand) -> Asked:
        """A row of the register."""
        verb = "comes" if row.comes else "holds"
        text = f"when {row.when.text}: {verb} {row.holds.text}"
        return Asked(row.id, row.says, row.clauses, " ".join(text.split()))


@dataclass(frozen=True)
class Found:
    """What came out for one demand. scans: as many from power-up were looked at without a break."""

    asked: Asked
    word: Word
    how: str
    broken: Broken | None = None
    scans: int = 0
    proof: Proof | None = None
    by_equality: bool = False
    """It is proved of the reference, and the program is proved to be the same."""


@dataclass
class Replays:
    """What the published vectors showed. seen: the demands that were asked in them."""

    cases: int = 0
    scans: int = 0
    runs: list[Run] = field(default_factory=list)
    broken: dict[str, Broken] = field(default_factory=dict)
    seen: set[str] = field(default_factory=set)


@dataclass
class Judgement:
    """Judges the demands on one subject. seconds: limit for each, of CPU time."""

    beside: Beside
    vectors: Path | None
    seconds: float
    tell: Tell
    wrap: bool = False
    at_once: Callable[[Broken, Asked], None] = lambda broken, asked: None
    """Is told of a break when it is found, before fewer scans are looked for."""
    kept: Mapping[str, Proof] = field(default_factory=dict)
    """Proofs over the whole system that were found before, by the ids of demands: asked again at first."""
    left_out: Collection[str] = ()
    """Demands that are not asked."""
    brief: bool = False
    """Without a search for invariants, which may take long where another question settles it."""
    places: Sequence[str] = ()
    """Names of memory by whose values an invariant may be split, if nothing simpler is found."""

    @cached_property
    def every(self) -> list[Asked]:
        """What is asked, that on types first where there is something to it."""
        found = [Asked.of(row) for row in self.beside.rows if row.id not in self.left_out]
        if z3.is_true(z3.simplify(self.beside.system.inside)):
            return found
        says = (
            "The program does what its types allow." if self.wrap else "The program stays within its types."
        )
        return [Asked(TYPES, says), *found]

    def all(self) -> list[Found]:
        """The verdict on each."""
        still = {asked.id: one for asked in self.every if (one := self._still(asked)) is not None}
        if len(still) == len(self.every):
            return list(still.values())
        by_id = {asked.id: asked for asked in self.every}
        for id, broken in self.replays.broken.items():
            if id in by_id:
                self.at_once(broken, by_id[id])
        found: list[Found] = []
        for asked in self.every:
            self.tell(asked.id)
            found.append(still.get(asked.id) or self._judge(asked))
        types = next((one for one in found if one.asked.id == TYPES and one.word != "PROVED"), None)
        if types is not None:
            why = "the program may leave its types"
            found = [
                Found(one.asked, "UNKNOWN", why, scans=one.scans) if one.word == "PROVED" else one
                for one in found
            ]
        return found

    def longer(self, seconds: float, found: Sequence[Found]) -> list[Found]:
        """What is still not known, asked again with more time."""
        self.seconds, self.brief = seconds, False
        self.__dict__.pop("lemmas", None)
        if all(one.word != "UNKNOWN" or one.asked.id != TYPES for one in found):
            return [self._judge(one.asked) if one.word == "UNKNOWN" else one for one in found]
        return self.all()

    # ------------------------------------------------------------ runs with plain values

    @cached_property
    def replays(self) -> Replays:
        """The published vectors, as far as they fulfil what is assumed."""
        found = Replays()
        for where, run in self._published():
            if found.scans + len(run.scans) > MOST_SCANS:
                continue
            found.cases, found.scans = found.cases + 1, found.scans + len(run.scans)
            found.runs.append(run)
            self._watch(found, where, run)
        self.tell(f"{found.cases} published vectors replayed, {found.scans:,} scans")
        return found

    def _watch(self, found: Replays, where: str, run: Run) -> None:
        """One run, until every demand is broken in it."""
        watch, steps = self.beside.watch(run, [row.id for row in self.beside.rows]), []
        for number, step in enumerate(self.beside.subject.run(run), 1):
            steps.append(step)
            if step.stopped:
                found.broken.setdefault(TYPES, Broken(run.upto(number), tuple(steps), where, step.stopped))
                break
            broken = watch.scan(step.dt_ms, step.inputs, step.outputs)
            if broken is not None:
                known = found.broken.get(broken.id)
                if known is None or len(known.run.scans) > number:
                    found.broken[broken.id] = Broken(run.upto(number), tuple(steps), where)
                break
        found.seen |= {id for id, count in watch.counts.items() if count}

    def _published(self) -> Iterator[tuple[str, Run]]:
        if self.vectors is None:
            return
        of = self.beside.subject.reference
        for name in SUITES:
            path = self.vectors / f"{name}.jsonl.gz"
            if not path.is_file():
                continue
            try:
                for case in open_suite(path).cases():
                    parameters = of.with_defaults(of.from_wire("parameters", case.params))
                    parameters |= self.beside.subject.fixed
                    if case.requests or not case.reset or not self.beside.subject.allows(parameters):
                        continue
                    longest = self.beside.subject.longest_scan
                    if longest is not None and max(scan.dt_ms for scan in case.scans) > longest:
                        continue
                    scans = [(scan.dt_ms, of.from_wire("inputs", scan.inputs)) for scan in case.scans]
                    assumed = self.beside.assumed
                    run = assumed.fulfilling(assumed.steadied(Run(parameters, scans)))
                    if run.scans:
                        yield f"published vector {case.id} of {name}", run
            except KitUnjudged as error:
                raise Unjudged(str(error)) from None

    # ------------------------------------------------------------ terms

    @cached_property
    def system(self) -> System:
        """Both sides, without the values that never change."""
        return self.beside.system.without_constants()

    def plainly_bad(self, asked: Asked) -> z3.BoolRef:
        """The scans that break it, over the values before them."""
        return z3.Not(self.beside.system.inside) if asked.id == TYPES else self.beside.bad(asked.id)

    def bad(self, asked: Asked) -> z3.BoolRef:
        """The same over the values that can change."""
        known = self.beside.system.constants
        term = self.plainly_bad(asked)
        found: z3.BoolRef = z3.simplify(z3.substitute(term, *known) if known else term)
        return found

    @cached_property
    def samples(self) -> Sequence[Mapping[str, Any]]:
        """Values of memory that were met."""
        found: dict[tuple[Any, ...], Mapping[str, Any]] = {}
        for run in self.replays.runs:
            for sample in self.beside.samples(run):
                found.setdefault(tuple(sample.values()), sample)
                if len(found) >= MOST_SAMPLES:
                    return list(found.values())
        return list(found.values())

    @cached_property
    def lemmas(self) -> list[z3.BoolRef]:
        """Invariants of the part on which the demands depend, thinned out from what held in all samples."""
        bad = [self.bad(one) for one in self.every]
        system = self.system.cone(*bad)
        houdini = Houdini(system, sorted(compared_with([*system.after.values(), *bad])))
        try:
            houdini.find(self.samples, time.process_time() + self.seconds / 2)
        except TimeoutError:
            return []
        self.tell(f"{len(houdini.clauses)} invariants")
        return houdini.lemmas()

    # ------------------------------------------------------------ one demand

    def _still(self, asked: Asked) -> Found | None:
        """PROVED by the proof that was kept, if that is one now."""
        proof = self.kept.get(asked.id)
        if proof is None:
            return None
        self.tell(f"{asked.id}: as before")
        try:
            fits = holds_up(self.beside.system, self.plainly_bad(asked), proof)
        except TimeoutError:
            return None
        return Found(asked, "PROVED", proof.by, proof=proof) if fits else None

    def one(self, id: str) -> Found:
        """The verdict on one demand."""
        asked = next(asked for asked in self.every if asked.id == id)
        return self._still(asked) or self._judge(asked)

    def _judge(self, asked: Asked) -> Found:
        """Cheap questions first: few scans at once, few scans from power-up, Spacer, invariants."""
        known = self.replays.broken.get(asked.id)
        if known is not None:
            return self._fewest(asked, known)
        bad, started = self.bad(asked), time.process_time()
        seconds = min(SHORT_S, self.seconds) if self.replays.broken else self.seconds
        if z3.is_false(bad):
            return Found(
                asked, "PROVED", "the terms of one scan", proof=Proof(1, (), "the terms of one scan")
            )
        proof, looked = induction(self.system, bad, [], started + seconds), 0
        if proof is None:
            way, looked = shortest(self.system, bad, FEW_SCANS, started + seconds)
            if way is not None:
                return self._replayed(asked, self.beside.wires.run_of(way))
            proof = self._by_places(bad, time.process_time() + seconds) if self.places else None
            proof = proof or spacer_over_numbers(self.system, bad, [], seconds / 12)
            proof = proof or spacer(self.system, bad, [], seconds / 4)
        if proof is None and self.brief:
            how = f"nothing breaks it within {looked} scans; invariants were not looked for"
            return Found(asked, "UNKNOWN", how, scans=looked)
        if proof is None and not self.replays.broken and self.samples:
            proof = induction(self.system, bad, self.lemmas, started + seconds)
            proof = proof or spacer(self.system, bad, self.lemmas, seconds / 2)
        if proof is None and not self.replays.broken:
            proof = spacer_over_numbers(self.system, bad, [], seconds / 2)
        if proof is not None:
            return Found(asked, "PROVED", proof.by, proof=proof)
        way, looked = shortest(self.system, bad, MOST_FOUND, time.process_time() + seconds / 4)
        if way is not None:
            return self._replayed(asked, self.beside.wires.run_of(way))
        return Found(asked, "UNKNOWN", f"no proof; nothing breaks it within {looked} scans", scans=looked)

    def _by_places(self, bad: z3.BoolRef, until: float) -> Proof | None:
        """A proof by an invariant that is split by the places; None: it has none in that time."""
        system, places = self.system.cone(bad), self.places
        if not {*places} <= {*system.state}:
            return None
        located = Located(system, places, self.tell)
        try:
            located.find(until)
            proof = induction(self.system, bad, located.lemmas(), until + self.seconds)
        except TimeoutError:
            return None
        return proof and replace(proof, by=f"an invariant by {', '.join(places)}")

    def _replayed(self, asked: Asked, run: Run) -> Found:
        """The scans that a solver found, after they were run with plain values."""
        broken = self.beside.broken(run, "" if asked.id == TYPES else asked.id, "search for the fewest scans")
        if broken is None:
            why = f"the {len(run.scans)} scans found do not break it when they are run"
            return Found(asked, "UNKNOWN", why)
        self.at_once(broken, asked)
        return Found(asked, "BROKEN", f"nothing breaks it within {len(broken.run.scans) - 1} scans", broken)

    def _fewest(self, asked: Asked, known: Broken) -> Found:
        """A break in the fewest scans that are found in a short time."""
        until = time.process_time() + min(SHORT_S, self.seconds)
        most = len(known.run.scans) - 1
        way, looked = shortest(self.system, self.bad(asked), min(most, MOST_FOUND), until)
        if way is not None:
            found = self._again(
                asked, self.beside.wires.run_of(way), f"{known.found_by}, made shorter by a search"
            )
            if found is not None:
                return Found(
                    asked, "BROKEN", f"nothing breaks it within {len(found.run.scans) - 1} scans", found
                )
        if looked < most:
            known = self._shorter(asked, known)
            return Found(asked, "BROKEN", f"nothing breaks it within {looked} scans", known)
        return Found(asked, "BROKEN", f"nothing breaks it within {most} scans", known)

    def _again(self, asked: Asked, run: Run, found_by: str) -> Broken | None:
        return self.beside.broken(run, "" if asked.id == TYPES else asked.id, found_by)

    def _shorter(self, asked: Asked, known: Broken) -> Broken:
        """With scans left out as long as it breaks and what is assumed is fulfilled."""

        def shows(run: Run) -> Broken | None:
            if len(self.beside.assumed.fulfilling(run).scans) < len(run.scans):
                return None
            return self._again(asked, run, known.found_by)

        return fewer(known, shows, self.beside.subject.longest_scan)
