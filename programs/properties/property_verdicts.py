"""Verdicts on properties of a program of one's own."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import z3

from programs.invariants.bounded_search import shortest
from programs.invariants.houdini import Houdini
from programs.invariants.induction import Proof, System, Way, induction, spacer
from programs.invariants.relations import like
from programs.language.tree import Expression, Unary
from programs.properties.property_file import TYPES
from programs.properties.transition_system import Asked, Cell, Judge, Scans, Trace
from programs.semantics.document_blocks import instances
from programs.semantics.terms import compared_with, in_range
from programs.semantics.value_paths import memory_of

RUNS, LENGTH = 60, 50
"""Of the random runs from which the candidates of invariants come."""
MOST_SAMPLES = 1_200
FEW_SCANS, MOST_SCANS = 6, 40
"""Scans of a counterexample that is looked for at once, and in the end."""


SAYS_NOTHING = "no values of its names make it false, so it says nothing"


@dataclass(frozen=True)
class Found:
    """What came out for one property.

    PROVED for ever; HOLDS in the first `scans` scans; REFUTED by `trace`; UNKNOWN; EMPTY: it holds only
    because its trigger can never be true, or because no values make it false.
    """

    asked: Asked
    word: str
    how: str
    trace: Trace | None = None
    scans: int = 0
    reached: tuple[Trace, ...] = ()
    """For each trigger the fewest scans after which it is true."""
    proof: Proof | None = None
    """What shows it, if it is PROVED."""


@dataclass(frozen=True)
class Chance:
    """What random runs gave: values of memory, and the shortest run after which a property was false."""

    samples: Sequence[Mapping[str, Any]]
    broken: Mapping[str, tuple[Mapping[str, Any], Scans]]


@dataclass
class Judgement:
    """Judges the properties of one program. seconds: limit for each property, of CPU time."""

    cell: Cell
    asked: Sequence[Asked]
    seconds: float
    tell: Callable[[str], None]

    @property
    def every(self) -> list[Asked]:
        """The properties, that on types first."""
        sentence, text = "The program stays within its types.", "no overflow, division by 0, wrong index"
        if self.cell.wrap:
            sentence, text = (
                "The program does what its types allow.",
                "no division by 0, wrong index; numbers wrap",
            )
        return [Asked(TYPES, sentence, text, None), *self.asked]

    def all(self) -> list[Found]:
        """The verdict on each."""
        found = []
        for asked in self.every:
            self.tell(asked.id)
            found.append(self._judge(asked))
        if found[0].word != "PROVED":
            why = "the program may leave its types"
            found = [
                Found(one.asked, "UNKNOWN", why) if one.word in ("PROVED", "EMPTY") else one for one in found
            ]
        return found

    @cached_property
    def chance(self) -> Chance:
        """Random runs with plain values."""
        samples: dict[tuple[Any, ...], dict[str, Any]] = {}
        broken: dict[str, tuple[Mapping[str, Any], Scans]] = {}
        paths = list(self.cell.slots)
        judges: dict[str, Judge] = {}
        for machine, retained, scans in self.cell.random_runs(1, RUNS, LENGTH):
            if len(scans) == 1:
                judges = {asked.id: Judge(asked) for asked in self.asked}
            values = memory_of(machine)
            sample = {path: values[path] for path in paths}
            for asked in self.asked:
                judge = judges[asked.id]
                shorter = asked.id not in broken or len(broken[asked.id][1]) > len(scans)
                if judge.broken(machine, scans[-1][0]) and shorter:
                    broken[asked.id] = retained, list(scans)
                if asked.watched:
                    sample |= {f"{asked.id} waits": judge.waits, f"{asked.id} since": judge.since}
            if len(samples) < MOST_SAMPLES:
                samples.setdefault(tuple(sample.values()), sample)
        return Chance(list(samples.values()), broken)

    # ------------------------------------------------------------ terms

    @cached_property
    def system(self) -> System:
        """The program with the watchers, without the values that never change."""
        return self.whole.without_constants()

    @cached_property
    def whole(self) -> System:
        """The program with the watchers of the properties that have a time."""
        cell = self.cell
        state = {path: cell.symbols[path] for path in cell.slots}
        start = {
            path: None if slot.initial is None else like(state[path], slot.initial)
            for path, slot in cell.slots.items()
        }
        after = {path: cell.after[path] for path in cell.slots}
        fits = []
        for path, slot in cell.slots.items():
            if path.endswith(".age"):
                fits.append(state[path] >= 0)
            elif not path.rpartition(".")[2].islower():  # the others are memory of a block
                fits.append(in_range(slot.type, state[path]))
        fits += [block.ranges(path, state) for path, block in instances(cell.source, cell.unit)]
        for asked in self.asked:
            if asked.watched:
                waits, since = z3.Bool(f"{asked.id} waits"), z3.Int(f"{asked.id} since")
                state |= {str(waits): waits, str(since): since}
                start |= {str(waits): z3.BoolVal(False), str(since): z3.IntVal(0)}
                after[str(waits)] = self._waits(asked)
                timed = asked.within_ms is not None
                after[str(since)] = z3.If(waits, since + cell.dt_ms, 0) if timed else z3.IntVal(0)
                fits.append(since >= 0)
        inputs = {path: cell.symbols[path] for path in cell.inputs} | {"dt_ms": cell.dt_ms}
        inside = z3.And([z3.BoolVal(True), *(owed.formula for owed in cell.obligations)])
        within = z3.And([z3.BoolVal(True), *(part for part in fits if not z3.is_true(part))])
        return System(state, inputs, start, after, cell.environment, inside, within)

    def _waits(self, asked: Asked) -> z3.BoolRef:
        """Whether `Judge` waits after a scan, over the values before it."""
        assert asked.holds is not None
        trigger = self.cell.holds(asked.trigger[0][1])
        end = self.cell.holds(asked.once or asked.holds)
        return z3.And(z3.Or(z3.Bool(f"{asked.id} waits"), trigger), z3.Not(end))

    def bad(self, asked: Asked) -> z3.BoolRef:
        """The scans after which a property is false, over the values before them that can change."""
        return self._put(self.plainly_bad(asked))

    def occurs(self, trigger: Expression) -> z3.BoolRef:
        """The scans after which a trigger is true, over the values before them that can change."""
        return self._put(z3.And(self.whole.inside, self.cell.holds(trigger)))

    def _put(self, term: z3.BoolRef) -> z3.BoolRef:
        found: z3.BoolRef = z3.simplify(z3.substitute(term, *self.whole.constants))
        return found

    def plainly_bad(self, asked: Asked) -> z3.BoolRef:
        """The scans after which a property is false, over the values before them."""
        if asked.holds is None:
            return z3.Not(self.whole.inside)
        if asked.once is not None:
            return z3.And(self.whole.inside, self._waits(asked), self.cell.holds(asked.holds))
        if asked.within_ms is not None:
            since = z3.Int(f"{asked.id} since")
            late = z3.And(z3.Bool(f"{asked.id} waits"), since + self.cell.dt_ms > asked.within_ms)
            return z3.And(self.whole.inside, late)
        return z3.And(self.whole.inside, z3.Not(self.cell.holds(asked.holds)))

    @cached_property
    def lemmas(self) -> list[z3.BoolRef]:
        """Invariants of the part of the program that the properties depend on."""
        system = self.system.cone(*(self.bad(one) for one in self.asked))
        limits = sorted(compared_with([*system.after.values(), *(self.bad(one) for one in self.asked)]))
        few = {
            path: range(slot.type.low, slot.type.high + 1)
            for path, slot in self.cell.slots.items()
            if slot.type.kind == "enum"
        }
        houdini = Houdini(system, limits, few)
        try:
            houdini.find(self.chance.samples, time.process_time() + self.seconds)
        except TimeoutError:
            return []
        self.tell(f"{len(houdini.clauses)} invariants")
        return houdini.lemmas()

    # ------------------------------------------------------------ one property

    def _judge(self, asked: Asked) -> Found:
        """Cheap questions first: few scans at once, few scans from power-up, Spacer, invariants."""
        bad, until = self.bad(asked), time.process_time() + self.seconds
        if z3.is_false(bad):
            return self._proved(asked, Proof(1, (), "the terms of one scan"), until)
        proof = induction(self.system, bad, [], until)
        if proof is None:
            way, _ = shortest(self.system, bad, FEW_SCANS, until)
            if way is not None:
                return self._refuted(asked, way)
            proof = spacer(self.system, bad, [], self.seconds / 4)
        if proof is None and asked.id not in self.chance.broken:
            proof = induction(self.system, bad, self.lemmas, until)
            proof = proof or spacer(self.system, bad, self.lemmas, self.seconds / 4)
        if proof is not None:
            return self._proved(asked, proof, until)
        return self._searched(asked, bad, time.process_time() + self.seconds / 2)

    def _proved(self, asked: Asked, proof: Proof, until: float) -> Found:
        """PROVED, if it can be false and what triggers it can be true."""
        if self.cell.says_nothing(asked):
            return Found(asked, "EMPTY", SAYS_NOTHING)
        reached = []
        for text, trigger in asked.trigger:
            term = self.occurs(trigger)
            way, scans = shortest(self.system, term, MOST_SCANS // 2, until)
            if way is None:
                if induction(self.system, term, [], until + 10) or spacer(self.system, term, [], 10):
                    return Found(asked, "EMPTY", f"`{text}` can never be true, so it says nothing")
                why = f"it follows, but `{text}` was not seen to be true in {scans} scans"
                return Found(asked, "UNKNOWN", why)
            trace = self.cell.run(*self._plain(way), never(asked, trigger))
            if trace is None:
                why = f"it follows, but `{text}` is not true when the {scans} scans that were found are run"
                return Found(asked, "UNKNOWN", why)
            reached.append(trace)
        return Found(asked, "PROVED", proof.by, reached=tuple(reached), proof=proof)

    def _searched(self, asked: Asked, bad: z3.BoolRef, until: float) -> Found:
        """REFUTED by scans from power-up, or HOLDS in as many as were looked at."""
        known = self.chance.broken.get(asked.id)
        most = len(known[1]) - 1 if known else MOST_SCANS
        way, scans = shortest(self.system, bad, most, until)
        if way is not None:
            return self._refuted(asked, way)
        if known:
            trace = self.cell.run(*known, asked)
            assert trace is not None
            return Found(asked, "REFUTED", f"not known: nothing breaks it within {scans} scans", trace)
        if scans:
            why = f"a proof; nothing breaks it within {scans} scans from power-up"
            return Found(asked, "HOLDS", why, scans=scans)
        return Found(asked, "UNKNOWN", "no question had an answer in time")

    def _refuted(self, asked: Asked, way: Way) -> Found:
        """The scans, after they were run with plain values."""
        trace = self.cell.run(*self._plain(way), asked)
        if trace is None:
            return Found(
                asked, "UNKNOWN", f"the {len(way.scans)} scans found do not break it when they are run"
            )
        return Found(asked, "REFUTED", f"yes: nothing breaks it within {len(trace.scans) - 1} scans", trace)

    def _plain(self, way: Way) -> tuple[dict[str, Any], Scans]:
        retained = {path: way.start[path] for path in self.cell.retained if path in way.start}
        scans: Scans = [
            (values["dt_ms"], {path: values[path] for path in self.cell.inputs}) for values in way.scans
        ]
        return retained, scans


def never(asked: Asked, trigger: Expression) -> Asked:
    """That a trigger is never true: scans that break this reach it."""
    return Asked(asked.id, "", "", Unary("NOT", trigger, trigger.place))
