"""Judges a machine: what must be true after every scan, of the blocks as a wiring file joins them.

First runs with plain values, which look for scans that break a property. For the rest an invariant is found
from the same runs, over the composed program as terms; z3 then shows that it holds at power-up, survives
every scan, and leaves no scan that breaks the property. So PROVED is for every input, for ever.
"""

from __future__ import annotations

import random
import time
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import z3

from machines.candidate_invariants import Candidates, Sample, sample_of, state_of
from machines.composed_program import Observer, Watched, cell_of, looked, spelled
from machines.concrete_runs import Rule, Runner, Scan, Seen, look, read_use, rule_of
from machines.coverage import TABLE, excused, unasked, unread
from machines.missing_names import EXPRESSIONS, lacking, observers_lacking
from machines.wiring import Wiring, wiring_of
from modeproof.ground.errors import Unjudged
from modeproof.registers.typed import rows_of, typed
from programs.certificates.certificate_folder import Obligation
from programs.certificates.recheck import SOLVERS
from programs.invariants.induction import System, conjuncts, is_inductive, named
from programs.properties.property_file import Beside, Questions, read_questions, words_of
from programs.properties.property_verdicts import SAYS_NOTHING, Judgement
from programs.properties.transition_system import Asked, Cell
from refimpl.errors import ParameterError
from refimpl.machine_cell import cell as reference

BESIDE = {"hazard": str, "cites": list}
"""What a property of a machine has besides."""
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
class Machine:
    """A wiring with the properties that are asked of it and the file that says how it is used."""

    text: str
    file: str
    properties: Path
    use: Path
    tell: Callable[[str], None] = field(default=lambda text: None)
    runs: int = RUNS
    triggers: Sequence[Sequence[str]] | None = None
    """The texts of what must occur for each property, where they are known; they come from the terms."""
    leave_out: bool = False
    """A property that names what the wiring has not is NOT JUDGED; else the file is refused."""
    tries: int = TRIES
    leaves: bool = False
    """Whether a value might leave its type, as far as the invariants show; then nothing is PROVED."""

    @property
    def files(self) -> Mapping[str, str]:
        """The files of a program of one's own, with their SHA-256."""
        return {}

    @cached_property
    def wiring(self) -> Wiring:
        """The wiring, looked through. Raises Unjudged."""
        return wiring_of(self.text, self.file)

    @cached_property
    def table(self) -> Mapping[str, Any]:
        """The same as plain tables."""
        return tomllib.loads(self.text)

    @cached_property
    def every(self) -> Questions:
        """The file of properties. Raises Unjudged."""
        return read_questions(self.properties, Beside(BESIDE, ("observer", TABLE), self.wiring.table.scan_ms))

    @cached_property
    def lacking(self) -> Mapping[str, str]:
        """By property that is not judged the name that the wiring has not. Raises Unjudged."""
        return lacking(self.wiring, self.observers, self.every) if self.leave_out else {}

    @cached_property
    def questions(self) -> Questions:
        """The properties that are judged, in the spelling of the wiring. Raises Unjudged."""
        rows = tuple(self.spelled(row) for row in self.every.rows if row["id"] not in self.lacking)
        return replace(self.every, rows=rows)

    def spelled(self, row: Mapping[str, Any]) -> Mapping[str, Any]:
        """A property in the spelling of the wiring. Raises Unjudged: what no property of a machine has."""
        if self.every.file != str(self.properties):
            return row  # a question that was made, not read
        place = self.every.place(row)
        texts = {
            key: spelled(self.wiring, self.watched, row[key], place, f"{row['id']}: {key}")
            for key in EXPRESSIONS
            if key in row
        }
        return {**row, **texts}

    @cached_property
    def observers(self) -> Watched:
        """The observers of the file. Raises Unjudged."""
        lines = {row: number for number, row in rows_of(self.every.text)}
        rows = self.every.tables.get("observer", {})
        if not isinstance(rows, dict):
            raise Unjudged(f"{self.properties}: [observer] is a table")
        made = Watched(str(self.properties), {}, lines)
        told = {name: f"{made.file}:{made.place(name).line}: observer.{name}" for name in rows}
        return replace(made, rows={name: typed(Observer, row, told[name]) for name, row in rows.items()})

    @cached_property
    def watched(self) -> Watched:
        """Those that the cell can have, in the spelling of the wiring. Raises Unjudged."""
        lost = observers_lacking(self.wiring, self.observers) if self.leave_out else {}
        rows = {name: row for name, row in self.observers.rows.items() if name not in lost}
        return looked(self.wiring, replace(self.observers, rows=rows))

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
    def system(self) -> System:
        """One scan, without what no property depends on."""
        return self.judgement.system.cone(*self.bad.values())

    def lemmas(self, seconds: float) -> list[z3.BoolRef]:
        """Invariants, found from the runs. seconds: of CPU; then there are none."""
        first = self.sample(self.runner.power_up(), {rule.id: rule.start() for rule in self.rules})
        seen = [self.sample(state, memory) for state, memory in self.seen.samples]
        found = self.candidates([first, *seen])
        self.tell(f"{len(found.clauses)} candidates of invariants")
        try:
            return found.thinned(time.process_time() + seconds, self.on(random.Random(1)))
        except TimeoutError:
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
        try:
            if not is_inductive(self.system, lemmas):
                return {one.id: False for one in asked}
        except TimeoutError:
            return {one.id: False for one in asked}
        solver = z3.Solver()
        solver.set("timeout", LIMIT_MS)
        solver.add(self.system.within, self.system.assumed, *lemmas)
        self.leaves = solver.check(z3.Not(self.system.inside)) != z3.unsat
        if self.leaves:
            return {one.id: False for one in asked}
        solver.add(self.system.inside)
        return {one.id: solver.check(self.bad[one.id]) == z3.unsat for one in asked}

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
        left = [asked for asked in self.asked if asked.id not in self.seen.broken]
        lemmas = self.lemmas(seconds) if left else []
        holds = self.shown(lemmas, left) if left else {}
        against = self.again(lemmas, [one for one in left if holds[one.id]]) if recheck and left else ""
        proof = f"an invariant of {len(lemmas)} clauses{', judged again by z3 and cvc5' * recheck}"
        found = []
        for row in self.every.rows:
            if lost := self.lacking.get(row["id"]):
                asked = Asked(row["id"], row["sentence"], words_of(row), None)
                found.append(Verdict(asked, row, "NOT JUDGED", f"the wiring has no {lost!r}"))
        for asked, row, rule in zip(self.asked, self.questions.rows, self.rules, strict=True):
            reached = self.seen.reached[asked.id]
            if asked.id in self.seen.broken:
                self.tell(f"scans that break {asked.id}")
                scans = self.runner.shortened(self.seen.broken[asked.id], rule, self.tries)
                mended = list(self.mended(scans, row, own)) if own is not None else []
                how = f"{len(scans)} scans, the shortest that were found"
                found.append(Verdict(asked, row, "REFUTED", how, reached, scans, mended))
            elif not holds[asked.id]:
                why = "a value may leave its type" if self.leaves else "no invariant was found"
                how = f"{why}, and nothing breaks it in {self.seen.scans:,} scans of runs"
                found.append(Verdict(asked, row, "UNKNOWN", how, reached))
            elif against:
                how = f"the proof is not confirmed: {against}"
                found.append(Verdict(asked, row, "UNKNOWN", how, reached))
            elif self.cell.says_nothing(asked):
                found.append(Verdict(asked, row, "EMPTY", SAYS_NOTHING, reached))
            elif None in reached:
                text = asked.trigger[list(reached).index(None)][0]
                how = f"it follows, but `{text}` was never true in {self.seen.scans:,} scans"
                found.append(Verdict(asked, row, "UNKNOWN", how, reached))
            else:
                found.append(Verdict(asked, row, "PROVED", proof, reached))
        order = [row["id"] for row in self.every.rows]
        return [*sorted(found, key=lambda verdict: order.index(verdict.asked.id)), *self.left_out()]

    def left_out(self) -> Iterator[Verdict]:
        """An output that no property is about, an input that nothing reads, if the file does not say why."""
        reasons = excused(self.every, self.wiring, strictly=not self.leave_out)
        lost = [(f"input {name}", "has an effect", "nothing reads it") for name in self.unread]
        outputs = unasked(self.wiring, self.watched, self.questions)
        lost += [(f"output {name}", "is in a question", "no property is about it") for name in outputs]
        for id, sentence, how in lost:
            if id.split()[1] not in reasons:
                row = {"hazard": "What it does, or should do, was not looked at.", "cites": []}
                yield Verdict(Asked(id, f"The {id} {sentence}.", id, None), row, "NOT ASKED", how)

    @property
    def unread(self) -> Iterator[str]:
        """The inputs that nothing reads."""
        return unread(self.wiring)

    def mended(self, scans: Sequence[Scan], row: Mapping[str, Any], own: Mapping[str, Any]) -> Iterator[str]:
        """The rows that are not as in `own`, and with whose text there the scans break nothing."""
        for path, there in differences(self.table, own):
            table = with_row(self.table, path, there)
            try:
                runner = Runner.of(self.wiring, self.watched, self.runner.use, table)
                if runner.broken(scans, rule_of(row, [], runner.named)) is None:
                    here = f"{self.file}:{self.wiring.place(path).line}: {path}"
                    yield f"{here}; with {there!r}, as in the project's own, these scans break nothing"
            except (Unjudged, ParameterError, KeyError):
                continue


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


def differences(
    table: Mapping[str, Any], own: Mapping[str, Any], above: str = ""
) -> Iterator[tuple[str, Any]]:
    """The rows of `table` that stand otherwise in `own`, with their value there."""
    for key, value in table.items():
        path = f"{above}{key}"
        if key not in own or key in ("why", "title", "from", "to"):
            continue
        if isinstance(value, dict) and isinstance(own[key], dict):
            yield from differences(value, own[key], f"{path}.")
        elif value != own[key]:
            yield path, own[key]


def with_row(table: Mapping[str, Any], path: str, value: Any) -> dict[str, Any]:
    """The tables with another value in one row."""
    head, _, rest = path.partition(".")
    return {**table, head: with_row(table[head], rest, value) if rest else value}
