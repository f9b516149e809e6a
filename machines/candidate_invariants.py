"""Candidates of invariants of a machine, from runs with plain values: what was never seen otherwise.

Which values are always equal, which control states of a block a latch or a watcher was never seen with, how
two latches go together, and how far a timer was ahead of a watcher. A solver drops what does not last.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import z3

from programs.invariants.houdini import Houdini
from programs.invariants.induction import System
from programs.invariants.relations import like, plain
from programs.properties.transition_system import Cell
from programs.semantics.document_blocks import CONTROL, Block, instances
from programs.semantics.terms import compared_with
from refimpl.machine_cell import cell as reference

Sample = Mapping[str, Any]
MOST_VALUES = 8


def sample_of(cell: Cell, state: reference.State, memory: Mapping[str, tuple[bool, int]]) -> dict[str, Any]:
    """A state of the reference, with what watches the properties, by the names of the terms."""
    found: dict[str, Any] = {f"{id} waits": waits for id, (waits, _) in memory.items()}
    found |= {f"{id} since": since for id, (_, since) in memory.items()}
    for pin, value in state.pins.items():
        found[pin.upper()] = value
    for name, kept in state.memory.items():
        above = name.upper()
        for part in fields(kept):
            value = getattr(kept, part.name)
            if part.name == "state":
                found[f"{above}.{CONTROL}"] = _members(value).index(value)
            elif part.name != "params":
                found[f"{above}.{part.name}"] = value
    return found


def kinds_of(block: Block) -> tuple[tuple[int, ...], ...]:
    """The control states of a block; errors that show the same and differ by a number go together."""
    module = block.reference.device.module
    start = block.start({key: variable.initial for key, variable in block.unit().variables.items()})
    found: dict[Any, list[int]] = {}
    for number, state in enumerate(module.Step):
        row = module.outputs(replace(start, state=state))
        shown = tuple(getattr(row, part.name) for part in fields(row) if part.name != "DiagCode")
        same = (state.name.rstrip("0123456789"), shown) if getattr(row, "Error", False) else number
        found.setdefault(same, []).append(number)
    return tuple(map(tuple, found.values()))


class Candidates:
    """What is true in all samples, over the values on which the properties depend."""

    def __init__(self, cell: Cell, system: System, samples: Sequence[Sample]) -> None:
        self.system, self.samples = system, _distinct(system, samples)
        samples = self.samples
        self.kinds = {
            f"{path}.{CONTROL}": kinds_of(block) for path, block in instances(cell.source, cell.unit)
        }
        self.everywhere = (1 << len(samples)) - 1
        known = samples[0] if samples else {}
        self.bools = [path for path, term in system.state.items() if z3.is_bool(term) and path in known]
        self.numbers = [path for path, term in system.state.items() if z3.is_int(term) and path in known]
        self.controls = [path for path in self.numbers if _few(path, samples)]
        self.facts: list[z3.BoolRef] = []
        self.true: list[Callable[[Sample], bool]] = []
        self.clauses: list[tuple[int, ...]] = []

    def fact(self, formula: z3.BoolRef, true: Callable[[Sample], bool]) -> tuple[int, int]:
        """A new fact: its number, and where it is true."""
        self.facts.append(formula)
        self.true.append(true)
        return len(self.facts), sum(1 << n for n, sample in enumerate(self.samples) if true(sample))

    def always(self, fact: tuple[int, int]) -> bool:
        """Keep the fact, if it was true in all samples."""
        if fact[1] == self.everywhere:
            self.clauses.append((fact[0], fact[0]))
        return fact[1] == self.everywhere

    def either(self, left: tuple[int, int], right: tuple[int, int]) -> None:
        """Keep that one of two is true, if it was so in all samples and the first is not true everywhere."""
        if left[1] | right[1] == self.everywhere and left[1] != self.everywhere:
            self.clauses.append((left[0], right[0]))

    def _one_of(self, three: tuple[tuple[int, int], ...]) -> None:
        """Keep that one of three is true, if it was so in all samples, and of no two of them."""
        masks = [mask for _, mask in three]
        if masks[0] | masks[1] | masks[2] == self.everywhere and all(
            left | right != self.everywhere for left, right in itertools.combinations(masks, 2)
        ):
            self.clauses.append(tuple(number for number, _ in three))

    def denied(self, fact: tuple[int, int]) -> tuple[int, int]:
        """The opposite of a fact."""
        return -fact[0], self.everywhere & ~fact[1]

    def find(self) -> None:
        """All of them."""
        state = self.system.state
        flags = {path: self.fact(state[path], _true(path)) for path in self.bools}
        for path in self.bools:
            self.always(flags[path])
            self.always(self.denied(flags[path]))
        places = {
            (path, kind): self.fact(z3.Or([state[path] == value for value in kind]), _among(path, kind))
            for path in self.controls
            for kind in self.kinds.get(path) or sorted({(sample[path],) for sample in self.samples})
        }
        for path in self.controls:
            self._only_seen(path)
        self._equal(flags, places)
        for (path, kind), (other, there) in itertools.combinations(places, 2):
            if path != other and _beside(path) == _beside(other) != "":
                self.either(self.denied(places[path, kind]), self.denied(places[other, there]))
        latches = [path for path in self.bools if _latch(path)]
        single = list({flags[path][1]: path for path in reversed(self.bools)}.values())
        for path, (control, kind) in itertools.product(self.bools, places):
            own = path.rpartition(".")[0] == control.rpartition(".")[0]
            if path in latches or own:
                there = self.denied(places[control, kind])
                self.either(self.denied(flags[path]), there)
                self.either(flags[path], there)
        both = {path: (flags[path], self.denied(flags[path])) for path in self.bools}
        remembered = [path for path in self.bools if _latch(path) or path.endswith(".before")]
        for path, other in itertools.product(remembered, single):
            if path != other and (other not in remembered or path < other):
                for left, right in itertools.product(both[path], both[other]):
                    self.either(left, right)
        kept = [path for path in latches if not path.endswith(" waits")]
        for (path, other), third in itertools.product(itertools.combinations(kept, 2), single):
            if third not in (path, other):
                for three in itertools.product(both[path], both[other], both[third]):
                    self._one_of(three)
        self._timed(flags)
        self._at_first(places)

    def find_pairs(self, prefix: str) -> None:
        """Those that pair a value with the one of the same name behind a prefix, and values alike."""
        state = self.system.state
        flags = {path: self.fact(state[path], _true(path)) for path in self.bools}
        places = {
            (path, (value,)): self.fact(state[path] == value, _among(path, (value,)))
            for path in self.controls
            for value in sorted({sample[path] for sample in self.samples})
        }
        for path in self.bools:
            self.always(flags[path])
            self.always(self.denied(flags[path]))
        for path in (*self.bools, *self.numbers):
            if (other := f"{prefix}{path}") in state:
                self.always(self.fact(state[path] == state[other], _alike(path, other)))
        for path in self.controls:
            self._only_seen(path)
        self._equal(flags, places)

    def _at_first(self, places: Mapping[Any, tuple[int, int]]) -> None:
        """What is as at power-up in one part is so in another."""
        starts = [
            there
            for (path, kind), there in places.items()
            if self.system.start[path] is not None and plain(self.system.start[path]) in kind
        ]
        for there, other in itertools.permutations(starts, 2):
            self.either(self.denied(there), other)

    def _only_seen(self, path: str) -> None:
        """A control state that was never seen is not taken."""
        seen = {sample[path] for sample in self.samples}
        terms = [self.system.state[path] == like(self.system.state[path], value) for value in sorted(seen)]
        self.always(self.fact(z3.Or(terms), _among(path, seen)))

    def _equal(self, flags: Mapping[str, tuple[int, int]], places: Mapping[Any, tuple[int, int]]) -> None:
        """Values that were always the same, or always opposite: each with the first of its kind."""
        first: dict[int, int] = {}
        for number, mask in (*places.values(), *flags.values()):
            if mask in (0, self.everywhere):
                continue
            for known, alike in ((mask, True), (self.everywhere & ~mask, False)):
                if known in first:
                    formula, other = self.facts[number - 1], self.facts[first[known] - 1]
                    same = formula == (other if alike else z3.Not(other))
                    self.always(self.fact(same, self._same(number, first[known], alike)))
                    break
            else:
                first[mask] = number

    def _same(self, number: int, other: int, alike: bool) -> Callable[[Sample], bool]:
        left, right = self.true[number - 1], self.true[other - 1]
        return lambda sample: (bool(left(sample)) == bool(right(sample))) == alike

    def _timed(self, flags: Mapping[str, tuple[int, int]]) -> None:
        """While a watcher waits, its time is no more than that of a timer, and a timer is below a limit."""
        limits = sorted(compared_with([*self.system.after.values()]))
        state = self.system.state
        timers = [path for path in self.numbers if path.endswith("elapsed_ms")]
        for since in (path for path in self.numbers if path.endswith(" since")):
            waits = flags.get(since.replace(" since", " waits"))
            if waits is None:
                continue
            for timer in timers:
                ahead = self.fact(state[since] <= state[timer], _ordered(since, timer))
                self.either(self.denied(waits), ahead)
        for timer, limit in itertools.product(timers, limits):
            below = self.fact(state[timer] < limit, _below(timer, limit))
            if not self.always(below):
                for path in (path for path in flags if path.endswith(" waits")):
                    self.either(self.denied(flags[path]), below)

    def thinned(self, until: float, on: Callable[[Sample], Iterator[Sample]]) -> list[z3.BoolRef]:
        """Those that hold at power-up and survive every scan. Raises TimeoutError.

        on: runs on from a sample. The lemmas that last hold in every sample in which all that are left hold,
        and so in all that follow it: what is false in one of these falls without a question.
        """
        houdini = Houdini(self.system, facts=self.facts, clauses=list(self.clauses), singly=True)

        def further(model: z3.ModelRef) -> Iterator[list[bool]]:
            now = {
                path: plain(model.eval(term, model_completion=True))
                for path, term in self.system.state.items()
            }
            for sample in on(now):
                yield [bool(true(sample)) for true in self.true]

        houdini.further = further
        houdini.thin(until)
        self.rounds = houdini.rounds
        return houdini.lemmas()


def _members(value: Any) -> list[Any]:
    """All values of the enumeration that a value is of."""
    kind: Any = type(value)
    return [*kind]


def _true(path: str) -> Callable[[Sample], bool]:
    return lambda sample: bool(sample[path])


def _among(path: str, values: Collection[int]) -> Callable[[Sample], bool]:
    return lambda sample: sample[path] in values


def _alike(path: str, other: str) -> Callable[[Sample], bool]:
    return lambda sample: bool(sample[path] == sample[other])


def _ordered(path: str, other: str) -> Callable[[Sample], bool]:
    return lambda sample: bool(sample[path] <= sample[other])


def _below(path: str, limit: int) -> Callable[[Sample], bool]:
    return lambda sample: bool(sample[path] < limit)


def _distinct(system: System, samples: Sequence[Sample]) -> list[Sample]:
    """The samples that differ in what the system has."""
    paths = [path for path in system.state if samples and path in samples[0]]
    return list({tuple(sample[path] for path in paths): sample for sample in samples}.values())


def _latch(path: str) -> bool:
    return path.endswith((".Q1", " waits")) or "." not in path


def _beside(path: str) -> str:
    """The block to which a number belongs that is no control state; nothing for a control state."""
    above, _, name = path.rpartition(".")
    return "" if name == CONTROL else above


def _few(path: str, samples: Sequence[Sample]) -> bool:
    """Whether a number is one of few: a control state or a mode, no time."""
    if path.endswith((" since", "_ms")):
        return False
    return path.endswith(f".{CONTROL}") or len({sample[path] for sample in samples}) <= MOST_VALUES


def state_of(cell: Cell, start: reference.State, sample: Sample) -> reference.State:
    """The state of the reference that a sample says; what it leaves out is as in `start`."""
    pins = {pin: sample.get(pin.upper(), value) for pin, value in start.pins.items()}
    memory = {}
    for name, kept in start.memory.items():
        above = name.upper()
        given = {
            part.name: sample[f"{above}.{part.name}"]
            for part in fields(kept)
            if f"{above}.{part.name}" in sample
        }
        if f"{above}.Q1" in sample:
            given["on"] = sample[f"{above}.Q1"]
        if f"{above}.{CONTROL}" in sample:
            given["state"] = _members(kept.state)[sample[f"{above}.{CONTROL}"]]
        memory[name] = replace(kept, **given)
    return reference.State(memory, pins)
