"""Judges a machine: what must be true after every scan, of the blocks as a wiring file joins them.

First the fewest scans that break a property are looked for, of all inputs and scan times. For the rest an
invariant is found from runs with plain values, over the composed program as terms; z3 then shows that it
holds at power-up, survives every scan, and leaves no scan that breaks the property. So PROVED is for every
input, for ever. What is neither found nor proved is looked for in more scans.
"""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import z3

from machines.asking import Asking
from machines.candidate_invariants import Candidates, Sample, sample_of, state_of
from machines.causes import mended
from machines.composed_program import cell_of
from machines.concrete_runs import Rule, Runner, Scan, Seen, look, read_use, rule_of
from machines.coverage import excused, unasked, unasked_blocks, unread
from machines.search import DEEPER, DEEPER_S, FIRST_S, Search, trigger
from programs.certificates.certificate_folder import Obligation
from programs.certificates.recheck import SOLVERS
from programs.invariants.induction import System, conjuncts, is_inductive, named
from programs.properties.property_file import words_of
from programs.properties.property_verdicts import SAYS_NOTHING, Judgement
from programs.properties.transition_system import Asked, Cell
from refimpl.machine_cell import cell as reference

RUNS = 260
TRIES = 250
"""Runs that may be made to shorten one counterexample."""
LIMIT_MS = 30_000
"""For one question."""


@dataclass(frozen=True)
class Verdict:
    """What came out for one property.

    PROVED for every input, for ever; REFUTED by `scans`; UNKNOWN; NOT JUDGED, for the wiring lacks what it
    names; EMPTY, for nothing can make it false; NOT ASKED, of an output or input that is in no question.
    reached: scans after which each trigger was
    true in a run. mended: the rows of the project's own wiring with which the same scans break nothing.
    """

    asked: Asked
    row: Mapping[str, Any]
    word: str
    how: str
    reached: Sequence[int | None] = ()
    scans: Sequence[Scan] = ()
    mended: Sequence[str] = ()


@dataclass
class Machine(Asking):
    """Judges the properties that are asked of a wiring."""

    tell: Callable[[str], None] = field(default=lambda text: None)
    runs: int = RUNS
    triggers: Sequence[Sequence[str]] | None = None
    """The texts of what must occur for each property, where they are known; they come from the terms."""
    tries: int = TRIES
    leaves: bool = False
    """Whether a value might leave its type, as far as the invariants show; then nothing is PROVED."""
    gave_up: str = "no invariant was found"
    """Why a proof did not come about: a busy computer may give a question too little time."""

    @property
    def files(self) -> Mapping[str, str]:
        """The files of a program of one's own, with their SHA-256."""
        return {}

    @cached_property
    def cell(self) -> Cell:
        """The composed program. Raises Unjudged: a name in a property, or a block, that does not exist."""
        return cell_of(self.wiring, self.watched)

    @cached_property
    def asked(self) -> list[Asked]:
        """The properties over it. Raises Unjudged."""
        return self.questions.asked(self.cell)

    @cached_property
    def runner(self) -> Runner:
        """What runs it with plain values. Raises Unjudged."""
        return Runner.of(self.wiring, self.watched, read_use(self.use), self.table)

    @cached_property
    def rules(self) -> list[Rule]:
        """The properties over plain values."""
        texts = self.triggers
        if texts is None:
            texts = [[text for text, _ in asked.trigger] for asked in self.asked]
        rows = zip(self.questions.rows, texts, strict=True)
        return [rule_of(row, triggers, self.runner.named) for row, triggers in rows]

    def look(self, enough: Callable[[Seen], bool] = lambda seen: False, known: int = 0) -> Seen:
        """Runs with plain values, without those that are known."""
        return look(self.runner, self.rules, range(known, self.runs), enough, keep=1)

    @cached_property
    def seen(self) -> Seen:
        """All of them."""
        self.tell("runs")
        return self.look()

    # ------------------------------------------------------------ terms

    @cached_property
    def judgement(self) -> Judgement:
        """The composed program with the watchers of the properties, as terms."""
        self.tell("terms")
        return Judgement(self.cell, self.asked, LIMIT_MS / 1000, self.tell)

    @cached_property
    def bad(self) -> dict[str, z3.BoolRef]:
        """For each property the scans after which it is false."""
        return {asked.id: self.judgement.bad(asked) for asked in self.asked}

    @cached_property
    def occurs(self) -> dict[tuple[str, int], z3.BoolRef]:
        """For each trigger of a property the scans after which it is true."""
        return {
            (asked.id, number): self.judgement.occurs(tree)
            for asked in self.asked
            for number, (_, tree) in enumerate(asked.trigger)
        }

    @cached_property
    def system(self) -> System:
        """One scan, without what no property depends on."""
        return self.judgement.system.cone(*self.bad.values(), *self.occurs.values())

    @cached_property
    def search(self) -> Search:
        """What looks for the fewest scans to the breach of a property, and to its triggers."""
        targets = self.bad | {trigger(*key): term for key, term in self.occurs.items()}
        return Search(self.system, targets, self.wiring.table.inputs)

    def lemmas(self, seconds: float) -> list[z3.BoolRef]:
        """Invariants, found from the runs. seconds: of CPU; then there are none."""
        first = self.sample(self.runner.power_up(), {rule.id: rule.start() for rule in self.rules})
        seen = [self.sample(state, memory) for state, memory in self.seen.samples]
        found = self.candidates([first, *seen])
        self.tell(f"{len(found.clauses)} candidates of invariants")
        try:
            return found.thinned(time.process_time() + seconds, self.on(random.Random(1)))
        except TimeoutError as error:
            self.gave_up = f"no invariant was found: {error}"
            return []

    def candidates(self, samples: Sequence[Sample]) -> Candidates:
        """What is true in all samples."""
        found = Candidates(self.cell, self.system, samples)
        found.find()
        return found

    def sample(self, state: Any, memory: Mapping[str, tuple[bool, int]]) -> Sample:
        """A state of the runner with what the rules remember, by the names of the terms."""
        return sample_of(self.cell, state, memory)

    def on(self, choose: random.Random) -> Callable[[Sample], Iterator[Sample]]:
        """What runs on from a sample with any inputs."""
        start = reference.power_up(self.runner.cell)

        def on(sample: Sample) -> Iterator[Sample]:
            memory = {
                rule.id: (bool(sample.get(f"{rule.id} waits", False)), int(sample.get(f"{rule.id} since", 0)))
                for rule in self.rules
            }
            for dt_ms, state, values in self.runner.on(state_of(self.cell, start, sample), 8, choose):
                for rule in self.rules:
                    _, memory[rule.id] = rule.after(memory[rule.id], values, dt_ms)
                yield self.sample(state, memory)

        return on

    def shown(self, lemmas: Sequence[z3.BoolRef], asked: Sequence[Asked]) -> dict[str, bool]:
        """Which properties follow from invariants; these are asked anew, in a solver of their own."""
        return self.never(lemmas, {one.id: self.bad[one.id] for one in asked})

    def never(self, lemmas: Sequence[z3.BoolRef], terms: Mapping[str, z3.BoolRef]) -> dict[str, bool]:
        """Which of these are never true, as far as invariants show it."""
        try:
            if not is_inductive(self.system, lemmas):
                return dict.fromkeys(terms, False)
        except TimeoutError:
            return dict.fromkeys(terms, False)
        solver = z3.Solver()
        solver.set("timeout", LIMIT_MS)
        solver.add(self.system.within, self.system.assumed, *lemmas)
        self.leaves = solver.check(z3.Not(self.system.inside)) != z3.unsat
        if self.leaves:
            return dict.fromkeys(terms, False)
        solver.add(self.system.inside)
        return {name: solver.check(term) == z3.unsat for name, term in terms.items()}

    def questions_again(self, lemmas: Sequence[z3.BoolRef], asked: Sequence[Asked]) -> list[Obligation]:
        """The proof as SMT-LIB for another solver; every answer is `unsat`. The search is not in it."""
        system = self.system
        then = {path: named(term, "after") for path, term in system.state.items()}
        where = [(term, then[path]) for path, term in system.state.items()]
        scan = [system.within, system.assumed, system.inside, *lemmas]
        moves = [new == system.after[path] for path, new in then.items()]
        survive = [z3.substitute(lemma, *where) for lemma in (*conjuncts(system.within), *lemmas)]
        types = [] if z3.is_true(z3.simplify(system.inside)) else [system.inside]
        return [
            _owed("start.smt2", [system.first], [*conjuncts(system.within), *lemmas]),
            _owed("scan.smt2", [*scan, *moves], survive),
            _owed("properties.smt2", scan, [z3.Not(self.bad[one.id]) for one in asked]),
            *(_owed("types.smt2", [system.within, system.assumed, *lemmas], [part]) for part in types),
        ]

    # ------------------------------------------------------------ verdicts

    def again(self, lemmas: Sequence[z3.BoolRef], asked: Sequence[Asked]) -> str:
        """What z3 and cvc5 say against the proof, each on its text; nothing if all answers are unsat."""
        for owed in self.questions_again(lemmas, asked):
            for name, solver in SOLVERS.items():
                self.tell(f"{name} on {owed.file}")
                if (said := solver(owed)) != "unsat":
                    return f"{name} on {owed.file}: {said}"
        return ""

    def all(
        self, seconds: float, own: Mapping[str, Any] | None = None, recheck: bool = False
    ) -> list[Verdict]:
        """The verdict on each. seconds: limit of the search for invariants. own: the project's wiring.

        recheck: z3 and cvc5 judge the proof again, from its text alone.
        """
        assert self.asked is not None  # a refusal comes before any work
        self.tell("search")
        self.search.look([asked.id for asked in self.asked], FIRST_S)
        left = [asked for asked in self.asked if not self.broken(asked.id)]
        self.reach(left)
        lemmas = self.lemmas(seconds) if left else []
        holds = self.shown(lemmas, left) if left else {}
        against = self.again(lemmas, [one for one in left if holds[one.id]]) if recheck and left else ""
        self.look_deeper([one for one in self.asked if not holds.get(one.id)])
        proof = f"an invariant of {len(lemmas)} clauses{', judged again by z3 and cvc5' * recheck}"
        found = []
        for row in self.every.rows:
            if lost := self.lacking.get(row["id"]):
                asked = Asked(row["id"], row["sentence"], words_of(row), None)
                found.append(Verdict(asked, row, "NOT JUDGED", f"the wiring has no {lost!r}"))
        for asked, row, rule in zip(self.asked, self.questions.rows, self.rules, strict=True):
            reached = self.reached(asked)
            if scans := self.broken(asked.id):
                found.append(self.refuted(asked, row, rule, scans, own))
            elif not holds[asked.id]:
                why = "a value may leave its type" if self.leaves else self.gave_up
                found.append(Verdict(asked, row, "UNKNOWN", f"{why}; {self.looked(asked.id)}", reached))
            elif against:
                how = f"the proof is not confirmed: {against}"
                found.append(Verdict(asked, row, "UNKNOWN", how, reached))
            elif self.cell.says_nothing(asked):
                found.append(Verdict(asked, row, "EMPTY", SAYS_NOTHING, reached))
            elif None in reached:
                found.append(self.idle(asked, row, lemmas, reached))
            else:
                found.append(Verdict(asked, row, "PROVED", proof, reached))
        order = [row["id"] for row in self.every.rows]
        return [*sorted(found, key=lambda verdict: order.index(verdict.asked.id)), *self.left_out()]

    def broken(self, id: str) -> list[Scan] | None:
        """The fewest scans that are known to break a property."""
        return self.search.scans(id) or self.seen.broken.get(id)

    def looked(self, name: str) -> str:
        """In how many scans something was looked for."""
        return f"none in {self.search.clean(name)} scans, all inputs and scan times"

    def look_deeper(self, asked: Sequence[Asked]) -> None:
        """Look in more scans for what is neither found nor proved, and for fewer scans than runs needed."""
        known = {one.id: len(self.seen.broken.get(one.id, ())) for one in asked}
        wanted = [id for id in known if self.search.scans(id) is None]
        until = time.process_time() + DEEPER_S
        for most in (*sorted({known[id] - 1 for id in wanted if known[id]}), DEEPER):
            some = [id for id in wanted if known[id] > most or not known[id]]
            if some and (rest := until - time.process_time()) > 0:
                self.tell(f"{len(some)} not proved: search in more scans")
                self.search.look(some, rest, most)

    def reach(self, asked: Sequence[Asked]) -> None:
        """Look for scans to what no run has reached."""
        missed = [
            trigger(one.id, number)
            for one in asked
            for number, scans in enumerate(self.seen.reached[one.id])
            if scans is None
        ]
        if missed:
            self.tell(f"search for {len(missed)} situations")
            self.search.look(missed, FIRST_S)

    def reached(self, asked: Asked) -> list[int | None]:
        """For each trigger of a property the scans after which it was true, in a run or found by search."""
        found = list(self.seen.reached[asked.id])
        rule = self.rules[[one.id for one in self.asked].index(asked.id)]
        for number, scans in enumerate(found):
            way = self.search.scans(trigger(asked.id, number)) if scans is None else None
            if way and rule.triggers[number]([*self.runner.replayed(way)][-1]):
                found[number] = len(way)
        return found

    def refuted(
        self,
        asked: Asked,
        row: Mapping[str, Any],
        rule: Rule,
        scans: Sequence[Scan],
        own: Mapping[str, Any] | None,
    ) -> Verdict:
        """The verdict on scans that break a property, if they do when the composed reference runs them."""
        self.tell(f"scans that break {asked.id}")
        reached, clean = self.reached(asked), self.search.clean(asked.id)
        if self.runner.broken(scans, rule) is None:
            how = f"the {len(scans)} scans that were found do not break it when they are run"
            return Verdict(asked, row, "UNKNOWN", how, reached)
        if self.search.scans(asked.id) is None:
            scans = self.runner.shortened(scans, rule, self.tries)
        else:
            scans = self.runner.calmed(scans, rule, self.tries)
        fewest = clean == len(scans) - 1
        less = "no fewer do" if fewest else f"none in {clean} scans"
        how = f"{len(scans)} scans: {less}, whatever inputs and scan times"
        wires = [] if own is None else list(mended(self.runner, self.table, scans, row, own))
        return Verdict(asked, row, "REFUTED", how, reached, scans, wires)

    def idle(
        self,
        asked: Asked,
        row: Mapping[str, Any],
        lemmas: Sequence[z3.BoolRef],
        reached: Sequence[int | None],
    ) -> Verdict:
        """The verdict on what follows, but was never seen to matter."""
        number = list(reached).index(None)
        text, name = asked.trigger[number][0], trigger(asked.id, number)
        if self.never(lemmas, {name: self.occurs[asked.id, number]})[name]:
            return Verdict(asked, row, "EMPTY", f"`{text}` can never be true, so it says nothing", reached)
        how = f"it follows, but nothing was seen to make `{text}` true: {self.looked(name)}"
        return Verdict(asked, row, "UNKNOWN", how, reached)

    def left_out(self) -> Iterator[Verdict]:
        """An output that no property is about, an input that nothing reads, if the file does not say why."""
        reasons = excused(self.every, self.wiring, strictly=not self.leave_out)
        lost = [(f"input {name}", "has an effect", "nothing reads it") for name in self.unread]
        outputs = unasked(self.wiring, self.watched, self.questions)
        lost += [(f"output {name}", "is in a question", "no property is about it") for name in outputs]
        if self.leave_out:  # our own questions are about each device
            blocks = unasked_blocks(self.wiring, self.watched, self.questions)
            lost += [(f"block {name}", "is in a question", "no property names it") for name in blocks]
        for id, sentence, how in lost:
            if id.split()[1] not in reasons:
                row = {"hazard": "What it does, or should do, was not looked at.", "cites": []}
                yield Verdict(Asked(id, f"The {id} {sentence}.", id, None), row, "NOT ASKED", how)

    @property
    def unread(self) -> Iterator[str]:
        """The inputs that nothing reads."""
        return unread(self.wiring)


def _owed(file: str, known: Sequence[z3.BoolRef], follow: Sequence[z3.BoolRef]) -> Obligation:
    """What follows from what is known, one question for each."""
    solver = z3.Solver()
    solver.add(known)
    solver.push()
    solver.add(z3.Or([z3.BoolVal(False), *follow]))  # so that each symbol is declared
    text = solver.to_smt2().splitlines(keepends=True)
    declared = "".join(line for line in text if line.startswith("(declare"))
    lines = ["(set-logic ALL)\n", declared, *(f"(assert {part.sexpr()})\n" for part in known)]
    for part in follow:
        lines.append(f"(push 1)\n(assert (not {part.sexpr()}))\n(check-sat)\n(pop 1)\n")
    return Obligation(file, "".join(lines), len(follow))
