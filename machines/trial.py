"""The wiring on trial: one edit of a wiring file at a time, and what becomes of the properties.

KILLED: scans with plain values break a property, or no run reaches what a property is about (its witness).
REFUSED: the reader of wirings refuses the file. HARMLESS: all properties are PROVED of that machine too.
SURVIVED: neither.
"""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import z3

from machines.concrete_runs import Seen
from machines.signal_names import names
from machines.verdicts import Machine
from machines.wiring import Wiring
from modeproof.ground.errors import Unjudged
from programs.invariants.houdini import Houdini
from programs.language.tree import BOOL, TIME, Binary, Expression, Literal, Unary
from programs.properties.property_file import parsed, shown
from programs.semantics.terms import names_in

FEW_RUNS, MORE_RUNS = 100, 130
"""Before a proof is tried, and before a witness is given up."""
TRIES = 60
"""Runs that may be made to shorten what breaks a property."""
SECONDS = 90
"""Of CPU, for the invariants of one edited machine."""


@dataclass(frozen=True)
class Edit:
    """One edit: its kind, the row, and the text in the place of the one that is there."""

    kind: str
    row: str
    text: str
    after: str
    """The whole file."""

    @property
    def id(self) -> str:
        """Its name."""
        return f"{self.row} = {self.text}"


@dataclass(frozen=True)
class Outcome:
    """What became of an edit. by: the properties that were seen to fail, or why it is harmless."""

    edit: Edit
    word: str
    by: Sequence[str]
    scans: int = 0
    """Of the shortest scans that were found."""


def edits(text: str, wiring: Wiring) -> Iterator[Edit]:
    """All edits of a file, each once."""
    seen = {text}
    for edit in _edits(text, wiring):
        if edit.after not in seen:
            seen.add(edit.after)
            yield edit


def _edits(text: str, wiring: Wiring) -> Iterator[Edit]:
    def at(kind: str, row: str, new: str) -> Edit:
        return Edit(kind, row, new, _with_value(text, wiring, row, new))

    table = wiring.table
    for name, block in table.block.items():
        pins = list(block.inputs)
        for pin, source in block.inputs.items():
            row = f"block.{name}.inputs.{pin}"
            if wiring.kinds[name].inputs[pin] is BOOL:
                yield at("left out", row, "TRUE" if source == "FALSE" else "FALSE")
                yield at("bridged", row, "FALSE" if source == "TRUE" else "TRUE")
            for new in _weaker(source, wiring, row):
                yield at("part left out", row, new)
        for pin, other in itertools.pairwise(pins):
            if wiring.kinds[name].inputs[pin] == wiring.kinds[name].inputs[other]:
                rows = [f"block.{name}.inputs.{part}" for part in (pin, other)]
                once = _with_value(text, wiring, rows[0], block.inputs[other])
                crossed = f"{block.inputs[other]}, and {other} = {block.inputs[pin]}"
                yield Edit("crossed", rows[0], crossed, _with_value(once, wiring, rows[1], block.inputs[pin]))
    for name, wire in table.signals.items():
        for new in _weaker(wire.text, wiring, f"signals.{name}"):
            yield at("part left out", f"signals.{name}", new)
    for name, output in table.outputs.items():
        for new in _weaker(output.text, wiring, f"outputs.{name}"):
            yield at("part left out", f"outputs.{name}", new)
        feeder = table.block.get(output.text.partition(".")[0])
        for source in sorted({*feeder.inputs.values()} - {"TRUE", "FALSE"}) if feeder else ():
            tree = parsed(source, wiring.place(f"outputs.{name}"))
            if wiring.type_of(tree) is wiring.type_of(wiring.shown[name]) is BOOL:
                yield at("block left out", f"outputs.{name}", source)
    yield from _of_matrix(text, wiring)
    for (name, mode), (other, there) in itertools.permutations(table.modes.items(), 2):
        yield at("modes not exclusive", f"modes.{name}", f"{mode.text} OR {there.text}")
        if name < other:
            once = _with_value(text, wiring, f"modes.{name}", there.text)
            twice = _with_value(once, wiring, f"modes.{other}", mode.text)
            yield Edit("crossed", f"modes.{name}", f"{there.text}, and {other} = {mode.text}", twice)
    for name, block in table.block.items():
        for pin, value in block.parameters.items():
            if wiring.kinds[name].parameters[pin] is TIME:
                yield _timed(text, wiring, f"block.{name}.parameters.{pin}", 10 * int(value))
    yield from _by_kind(text, wiring)
    for number, other_number in itertools.combinations(range(len(table.order)), 2):
        order = list(table.order)
        order[number], order[other_number] = order[other_number], order[number]
        yield _ordered(text, f"{order[other_number]} and {order[number]} changed over", order)
    for name in table.order[:-1]:
        rest = [block for block in table.order if block != name]
        yield _ordered(text, f"{name} last", [*rest, name])


def _by_kind(text: str, wiring: Wiring) -> Iterator[Edit]:
    """Mistakes of the trade: shared resets, Activate from a mode, a status for a request."""
    table = wiring.table
    resets = sorted({row.inputs["Reset"] for row in table.block.values() if "Reset" in row.inputs})
    uses = [f"{name}_in_use" for name in table.safeguards]
    for name, block in table.block.items():
        given: dict[str, Sequence[str]] = {
            "Reset": [*resets, *(name for name in table.inputs if name == "Start")],
            "Activate": ["a_mode", *uses],
            "S_SafetyActive": ["a_mode", *uses],
            "S_OutControl": ["safeguards_hold", *(wire.text for wire in table.safeguards.values()), "Start"],
        }
        for pin, others in given.items():
            for other in others:
                if block.inputs.get(pin, other) != other:
                    row = f"block.{name}.inputs.{pin}"
                    yield Edit("another source", row, other, _with_value(text, wiring, row, other))


def _of_matrix(text: str, wiring: Wiring) -> Iterator[Edit]:
    def row(mode: str, sets: Any) -> Edit:
        return Edit(
            "matrix", f"matrix.{mode}", json.dumps(sets), _with_list(text, wiring, f"matrix.{mode}", sets)
        )

    for mode, given in wiring.table.matrix.items():
        sets = [list(part) for part in given]
        for number, part in enumerate(sets):
            if len(sets) > 1:
                yield row(mode, [*sets[:number], *sets[number + 1 :]])
            for name in part:
                if less := [other for other in part if other != name]:
                    yield row(mode, [*sets[:number], less, *sets[number + 1 :]])
        for name in wiring.table.safeguards:
            if [name] not in sets:
                yield row(mode, [*sets, [name]])


def _weaker(text: str, wiring: Wiring, row: str) -> Iterator[str]:
    """A signal with one operand less, or one NOT less."""
    tree = parsed(text, wiring.place(row))
    if not isinstance(tree, Literal):
        for other in _less(tree):
            yield (
                shown(other).removeprefix("(").removesuffix(")")
                if isinstance(other, Binary)
                else shown(other)
            )


def _less(tree: Expression) -> Iterator[Expression]:
    match tree:
        case Binary(operator, left, right, place):
            yield left
            yield right
            for part in _less(left):
                yield Binary(operator, part, right, place)
            for part in _less(right):
                yield Binary(operator, left, part, place)
        case Unary("NOT", operand, _):
            yield operand


def _with_value(text: str, wiring: Wiring, row: str, new: str) -> str:
    """The file with another text in a row: the first one in quotes."""
    lines = text.splitlines(keepends=True)
    number = wiring.lines[row] - 1
    lines[number] = re.sub(r'"[^"]*"', lambda _: json.dumps(new), lines[number], count=1)
    return "".join(lines)


def _with_list(text: str, wiring: Wiring, row: str, new: Any) -> str:
    lines = text.splitlines(keepends=True)
    number = wiring.lines[row] - 1
    lines[number] = f"{lines[number].partition('=')[0]}= {json.dumps(new)}\n"
    return "".join(lines)


def _timed(text: str, wiring: Wiring, row: str, new: int) -> Edit:
    lines = text.splitlines(keepends=True)
    number = wiring.lines[row] - 1
    lines[number] = re.sub(r"= \d+", f"= {new}", lines[number], count=1)
    return Edit("time", row, str(new), "".join(lines))


def _ordered(text: str, name: str, order: Sequence[str]) -> Edit:
    new = f"order = {json.dumps(order)}"
    return Edit(
        "order", "order", name, re.sub(r"^order = \[[^\]]*\]", lambda _: new, text, count=1, flags=re.M)
    )


@dataclass
class Trial:
    """Judges edits of one machine."""

    machine: Machine
    looked: set[str] = field(default_factory=set)
    """The edits of which runs say nothing."""

    @cached_property
    def lemmas(self) -> list[z3.BoolRef]:
        """Of the machine as it is."""
        return self.machine.lemmas(SECONDS)

    @cached_property
    def terms(self) -> dict[str, str]:
        """What the properties of the machine as it is depend on."""
        return terms_of(self.machine)

    def run(self, edit: Edit) -> Outcome | None:
        """What becomes of an edit, from runs and the order of calls alone; None: that takes a proof."""
        if edit.id in self.looked:
            return None
        try:
            edited = self.edited(edit)
        except Unjudged as error:
            return Outcome(edit, "REFUSED", [error.message.replace(self.machine.file, "wiring.toml")])
        if edit.kind == "order" and reads_of(edited.wiring) == reads_of(self.machine.wiring):
            return Outcome(edit, "HARMLESS", ["the same program"])
        seen = edited.look(lambda seen: bool(seen.broken))
        if seen.broken:
            return self._killed(edit, edited, seen)
        if idle := self._idle(edited, seen):
            return Outcome(edit, "KILLED", idle)
        self.looked.add(edit.id)
        return None

    def prove(self, edit: Edit) -> Outcome | None:
        """The same with more runs and the invariants of the machine as it is; None: that takes others."""
        if (found := self.run(edit)) is not None:
            return found
        edited = self.edited(edit)
        edited.runs = self.machine.runs
        seen = edited.look(lambda seen: bool(seen.broken), FEW_RUNS)
        if seen.broken:
            return self._killed(edit, edited, seen)
        if self._same(edited):
            return Outcome(edit, "HARMLESS", ["no property depends on what it changes"])
        facts = self._facts(edited)
        if self._proved(edited, facts) or self._proved(edited, _kept(edited, facts)):
            return Outcome(edit, "HARMLESS", ["every property is proved of it too"])
        return None

    def of(self, edit: Edit) -> Outcome:
        """What becomes of an edit, with a search for invariants where it is needed."""
        if (found := self.prove(edit)) is not None:
            return found
        edited = self.edited(edit)
        edited.runs = self.machine.runs
        if self._proved(edited, _weakened(edited, self._facts(edited))) or self._proved(
            edited, edited.lemmas(SECONDS)
        ):
            return Outcome(edit, "HARMLESS", ["every property is proved of it too"])
        return Outcome(edit, "SURVIVED", [])

    def _facts(self, edited: Machine) -> list[z3.BoolRef]:
        """The invariants of the machine as it is that an edited one can be asked about."""
        known = set(map(str, edited.system.state.values()))
        return [lemma for lemma in self.lemmas if _names(lemma) <= known]

    def edited(self, edit: Edit) -> Machine:
        """The machine with the edit. Raises Unjudged."""
        base = self.machine
        triggers = [[text for text, _ in asked.trigger] for asked in base.asked]
        given = edit.after, base.file, base.properties, base.use
        found = Machine(*given, runs=FEW_RUNS, triggers=triggers, leave_out=base.leave_out)
        assert found.rules
        return found

    def _same(self, edited: Machine) -> bool:
        """Whether the edited program is the same, but for what no property depends on."""
        return terms_of(edited) == self.terms

    @staticmethod
    def _killed(edit: Edit, edited: Machine, seen: Seen) -> Outcome:
        """The outcome, where runs break a property."""
        rules = {rule.id: rule for rule in edited.rules}
        name = min(seen.broken, key=lambda id: len(seen.broken[id]))
        scans = edited.runner.shortened(seen.broken[name], rules[name], TRIES)
        fallen = [name, *(id for id in rules if id != name and id in seen.broken)]
        return Outcome(edit, "KILLED", fallen, len(scans))

    @staticmethod
    def _idle(edited: Machine, seen: Seen) -> list[str]:
        """The properties of which some trigger was not reached in these runs, nor in more."""
        missed = {id for id, scans in seen.reached.items() if None in scans}
        if missed:
            edited.runs = MORE_RUNS
            reached = edited.look(lambda more: False, FEW_RUNS).reached
            for id in [*missed]:
                both = zip(seen.reached[id], reached[id], strict=True)
                if all(before is not None or after is not None for before, after in both):
                    missed.remove(id)
        found = [f"the witness of {id}" for id in seen.reached if id in missed]
        return found if len(found) < 5 else [*found[:3], f"{len(found) - 3} other witnesses"]

    @staticmethod
    def _proved(edited: Machine, lemmas: Sequence[z3.BoolRef]) -> bool:
        return bool(lemmas) and all(edited.shown(lemmas, edited.asked).values())


def _kept(edited: Machine, facts: Sequence[z3.BoolRef]) -> list[z3.BoolRef]:
    """Those facts that are invariants of an edited machine."""
    return _last(edited, facts, [(number, number) for number in range(1, len(facts) + 1)])


def _last(edited: Machine, facts: Sequence[z3.BoolRef], clauses: list[tuple[int, ...]]) -> list[z3.BoolRef]:
    """The clauses over facts that are invariants of an edited machine."""
    houdini = Houdini(edited.system, facts=list(facts), clauses=clauses, singly=True)
    try:
        houdini.thin(float("inf"))
    except TimeoutError:
        return []
    return houdini.lemmas()


def _weakened(edited: Machine, facts: Sequence[z3.BoolRef]) -> list[z3.BoolRef]:
    """The invariants of an edited machine that say: this fact, or that flag."""
    flags = [term for term in edited.system.state.values() if z3.is_bool(term)]
    firm = {fact.get_id() for fact in _kept(edited, facts)}
    clauses: list[tuple[int, ...]] = []
    for number, fact in enumerate(facts, 1):
        if fact.get_id() in firm:
            clauses.append((number, number))
            continue
        for flag in range(len(facts) + 1, len(facts) + len(flags) + 1):
            clauses += [(number, flag), (number, -flag)]
    return _last(edited, [*facts, *flags], clauses)


def terms_of(machine: Machine) -> dict[str, str]:
    """All terms on which the properties of a machine depend: its memory after a scan, and each property."""
    terms = {**machine.system.after, **{f"broken {id}": term for id, term in machine.bad.items()}}
    return {name: term.sexpr() for name, term in terms.items()}


def reads_of(wiring: Wiring) -> set[tuple[str, str, bool]]:
    """Which block reads which, and whether that one was called before it: all that an order says."""
    order, found = wiring.table.order, set()
    for name in order:
        left, known = [*wiring.sources[name].values()], set[str]()
        while left:
            for part in set(names(left.pop())) - known:
                known.add(part)
                if part in wiring.signals:
                    left.append(wiring.signals[part])
                elif part in wiring.table.block:
                    found.add((name, part, order.index(part) < order.index(name)))
    return found


def _names(term: z3.BoolRef) -> set[str]:
    return set(names_in([term]))
