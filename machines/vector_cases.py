"""Cases for test vectors of a whole machine, from runs of the composed reference (refimpl/machine_cell).

A situation is what shows of the machine after a scan: which modes, safeguards, latches, errors and outputs
are on. No graph of the whole machine is walked: cases begin with the stories of how the machine is used.
"""

from __future__ import annotations

import itertools
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from machines.composed_program import NONE
from machines.concrete_runs import Inputs, Runner, Scan, Use
from machines.trial import Edit, edits, reads_of
from machines.wiring import Wiring, wiring_of
from refimpl.errors import InputError, ParameterError
from refimpl.machine_cell import cell as reference
from refimpl.machine_cell.expression import Signal, Value, signal

Situation = tuple[str, ...]
"""The names of what is on after a scan."""
Change = Mapping[str, Value]
IDLE: tuple[Change, ...] = ({}, {})
"""Scans after a story, in which no button changes."""
RUNS = 25
"""Random runs in which a mistake of the wiring may show."""
TRIES = 60
"""Runs that may be made to shorten one of them."""
SETTLE, QUIET = 8, 2
"""Scans for which a single change is held: as long as allowed if it shows, else of the set time."""


@dataclass(frozen=True)
class Case:
    """Why it is there, and its scans from power-up."""

    why: str
    scans: Sequence[Scan]


@dataclass(frozen=True)
class Point:
    """Of a story: the scan and the state and situation after it, and what is told after that."""

    scan: Scan
    state: reference.State
    situation: Situation
    before: Sequence[Scan]
    """The scans from power-up, this one too."""
    rest: Sequence[Change]


@dataclass
class Cases:
    """The cases of a wiring, and how it is used."""

    text: str
    file: str
    use: Use
    moves: set[tuple[Situation, Situation]] = field(default_factory=set)
    """The changes of situation that some case took."""

    @cached_property
    def wiring(self) -> Wiring:
        """The wiring, looked through. Raises Unjudged."""
        return wiring_of(self.text, self.file)

    @cached_property
    def table(self) -> Mapping[str, Any]:
        """The same as plain tables."""
        return tomllib.loads(self.text)

    @cached_property
    def runner(self) -> Runner:
        """What runs it. Raises Unjudged."""
        return Runner.of(self.wiring, NONE, self.use, self.table)

    @cached_property
    def _shown(self) -> dict[str, Signal]:
        table, pins = self.wiring.table, reference.power_up(self.runner.cell).pins
        texts = {name: name for name in table.modes}
        texts |= {name: wire.text for name, wire in table.safeguards.items()}
        on = [f"{block}.{pin}" for block in table.order for pin in ("Q1", "Error", "ResetRequest")]
        texts |= {pin: pin for pin in on if pin in pins}
        texts |= {name: row.text for name, row in table.outputs.items()}
        return {name: signal(text, self.runner.named) for name, text in texts.items()}

    def situation(self, state: reference.State, inputs: Inputs) -> Situation:
        """What is on after a scan."""
        values = {**inputs, **state.pins}
        return tuple(name for name, of in self._shown.items() if of(values) is True)

    def _anywhere(self, situation: Situation) -> Situation:
        """The same in any mode."""
        return tuple(name for name in situation if name not in self.wiring.table.modes)

    # ------------------------------------------------------------ stories

    @cached_property
    def stories(self) -> dict[str, list[Change]]:
        """What changes in each scan of each story, with the scans after it in which nothing does."""
        return {name: [*rows, *IDLE] for name, rows in self.runner.stories().items()}

    def paths(self) -> Iterator[list[str]]:
        """Stories in a row: after each one that begins a run, every one that likes to follow another.

        Then for each two that begin a run one after the other, with what likes to follow each.
        """
        then = {
            story["id"]: [name for name in dict.fromkeys(story.get("then", ())) if name in self.stories]
            for story in self.use.story
        }
        left = [*self.stories]
        firsts = [story["id"] for story in self.use.story if story.get("first") and story["id"] in then]
        firsts = [name for name in firsts if name in self.stories]
        for first in firsts:
            ways = [[first]]
            seen: set[tuple[str, str]] = set()
            for way in ways:
                left = [name for name in left if name not in way]
                new = [name for name in then[way[-1]] if (way[-1], name) not in seen]
                seen |= {(way[-1], name) for name in new}
                ways += [[*way, name] for name in new]
                if not new:
                    yield way
        yield from ([name] for name in left)
        for first, second in itertools.permutations(firsts, 2):
            for name in then[first]:
                yield [first, name, second, *then[second][:1]]

    def told(self) -> Iterator[tuple[list[str], list[Point]]]:
        """Each path, and the points of its run."""
        low, high = self.wiring.table.scan_ms
        for number, path in enumerate(self.paths()):
            dt_ms = (self.wiring.table.cycle_ms, low, high)[number % 3]
            changes = [change for name in path for change in self.stories[name]]
            scans: list[Scan] = []
            points = []
            for at, (scan, state) in enumerate(self._played(changes, dt_ms)):
                scans.append(scan)
                here = self.situation(state, scan[1])
                points.append(Point(scan, state, here, scans[: at + 1], changes[at + 1 :]))
            yield path, points

    def _played(
        self, changes: Sequence[Change], dt_ms: int, since: Point | None = None, stuck: Change | None = None
    ) -> Iterator[tuple[Scan, reference.State]]:
        """A run from power-up, or from a point on: inputs that follow the machine do, stories change others.

        stuck: inputs with a value that nothing changes.
        """
        cell = self.runner.cell
        state = reference.power_up(cell) if since is None else since.state
        inputs = self.rest if since is None else since.scan[1]
        for at, change in enumerate(changes):
            follows: Inputs = {}
            if at or since is not None:
                values = reference.values_after(cell, state, inputs)
                follows = {name: source(values) for name, source in self.runner.follows.items()}
            inputs = {**inputs, **follows, **change, **(stuck or {})}
            state, _ = reference.step(cell, state, inputs, dt_ms)
            yield (dt_ms, inputs), state

    @cached_property
    def rest(self) -> Inputs:
        """The inputs at power-up."""
        given = {name: kind == "WORD" and 0 for name, kind in self.runner.cell.inputs.items()}
        return given | {name: value for name, value in self.use.rest.items() if name in given}

    # ------------------------------------------------------------ suites

    @cached_property
    def walks(self) -> list[tuple[list[str], list[Point]]]:
        """The runs of all paths."""
        return list(self.told())

    @cached_property
    def points(self) -> list[tuple[str, Point]]:
        """The first point of each situation of the stories, and the path that leads there."""
        found: dict[Situation, tuple[str, Point]] = {}
        for path, points in self.walks:
            for point in points[:-1]:
                found.setdefault(point.situation, (", ".join(path), point))
        return list(found.values())

    def sequences(self) -> Iterator[Case]:
        """Each path."""
        for path, points in self.walks:
            before: Situation = ()
            for point in points:
                here = self._anywhere(point.situation)
                self.moves.add((before, here))
                before = here
            yield Case(f"the stories: {', '.join(path)}", points[-1].before)

    def faults(self) -> Iterator[Case]:
        """One input that sticks, from each situation to the end of the story."""
        for path, point in self.points:
            for name, kind in self.runner.cell.inputs.items():
                now = point.scan[1][name]
                for value in (now, not now) if kind == "BOOL" else (now, now ^ 1):
                    run = self._played(point.rest, point.scan[0], point, {name: value})
                    if kept := self._new(point, run, self.moves):
                        why = f"{path}: {name} sticks at {_shown(value)} after scan {len(point.before)}"
                        yield Case(why, [*point.before, *kept])

    def sic(self) -> Iterator[Case]:
        """One input that changes alone and back, in each situation; those that show nothing in a row."""
        table, own = self.wiring.table, set[tuple[Situation, Situation]]()
        for path, point in self.points:
            quiet, end = list[Scan](), point.state
            for name, kind in self.runner.cell.inputs.items():
                now = point.scan[1][name]
                other = not now if kind == "BOOL" else now ^ 1
                run = list(self._alone(point, end, name, (other, now), QUIET, table.cycle_ms))
                if all(self.situation(state, scan[1]) == point.situation for scan, state in run):
                    quiet += [scan for scan, _ in run]
                    end = run[-1][1]
                    continue
                run = list(self._alone(point, point.state, name, (other, now), SETTLE, table.scan_ms[1]))
                if kept := self._new(point, run, own):
                    why = f"{path}: after scan {len(point.before)} {name} alone is {_shown(other)}, and back"
                    yield Case(why, [*point.before, *kept])
            if quiet:
                why = f"{path}: after scan {len(point.before)} single inputs change and nothing more shows"
                yield Case(why, [*point.before, *quiet])

    def _alone(
        self, point: Point, state: reference.State, name: str, values: Sequence[Value], hold: int, dt_ms: int
    ) -> Iterator[tuple[Scan, reference.State]]:
        for value in values:
            for _ in range(hold):
                inputs = {**point.scan[1], name: value}
                state, _ = reference.step(self.runner.cell, state, inputs, dt_ms)
                yield (dt_ms, inputs), state

    def _new(
        self,
        point: Point,
        run: Iterable[tuple[Scan, reference.State]],
        moves: set[tuple[Situation, Situation]],
    ) -> list[Scan]:
        """The scans of a run up to the last change of situation that is new; they are not new then."""
        before, last = self._anywhere(point.situation), 0
        scans: list[Scan] = []
        for scan, state in run:
            scans.append(scan)
            here = self._anywhere(self.situation(state, scan[1]))
            if (before, here) not in moves:
                moves.add((before, here))
                last = len(scans)
            before = here
        return scans[:last]


def _shown(value: Value) -> str:
    return str(value).upper() if isinstance(value, bool) else f"{value:04X}"


# ---------------------------------------------------------------- mistakes of the wiring


Run = list[tuple[Scan, Mapping[str, Value]]]
"""Scans from power-up with the outputs after each."""


@dataclass
class Node:
    """A scan in a tree of cases: the outputs after it, and the scans that follow."""

    scan: Scan
    outputs: Mapping[str, Value]
    after: dict[tuple[Value, ...], Node] = field(default_factory=dict)
    states: dict[tuple[Value, ...], tuple[reference.State, dict[str, Value]]] = field(default_factory=dict)
    """What each scan that follows leaves behind."""


@dataclass
class Mistakes:
    """Edits of a wiring, and which cases show them."""

    cases: Cases
    edits: int = 0
    """Of those that are another program."""
    unseen: list[str] = field(default_factory=list)
    """The edits that no case shows and no run did."""

    def found(self, known: Sequence[Case]) -> Iterator[Case]:
        """Cases for the edits that none of the known cases shows."""
        tree = self._tree(known)
        told: list[Run] = []
        for edit in edits(self.cases.text, self.cases.wiring):
            try:
                other = reference.made_of(tomllib.loads(edit.after))
                if edit.kind == "order" and self._same_order(edit):
                    continue
                self.edits += 1
                if any(self.differs(other, run) for run in told) or self._in_tree(other, tree):
                    continue
                if run := self._run(other):
                    told.insert(0, run)
                    scans = [scan for scan, _ in run]
                    yield Case(f"the wiring with {edit.kind}: {edit.id} answers otherwise", scans)
                else:
                    self.unseen.append(edit.id)
            except (ParameterError, InputError, KeyError):
                self.edits += 1  # it does not run: that shows

    def _tree(self, known: Sequence[Case]) -> Node:
        """The cases with the outputs after each scan, what they begin with alike once."""
        cell = self.cases.runner.cell
        top = Node((0, {}), {})
        top_state = reference.power_up(cell)
        for case in known:
            node, state = top, top_state
            for scan in case.scans:
                key = (scan[0], *scan[1].values())
                state, outputs = node.states.get(key) or reference.step(cell, state, scan[1], scan[0])
                node.states[key] = state, outputs
                node = node.after.setdefault(key, Node(scan, outputs))
        return top

    @staticmethod
    def _in_tree(other: reference.Cell, tree: Node) -> bool:
        """Whether some case shows other outputs of another cell."""
        left = [(reference.power_up(other), node) for node in tree.after.values()]
        while left:
            before, node = left.pop()
            state, outputs = reference.step(other, before, node.scan[1], node.scan[0])
            if outputs != node.outputs:
                return True
            left += [(state, after) for after in node.after.values()]
        return False

    def _with_outputs(self, scans: Sequence[Scan]) -> Run:
        cell = self.cases.runner.cell
        state, run = reference.power_up(cell), list[tuple[Scan, Mapping[str, Value]]]()
        for dt_ms, inputs in scans:
            state, outputs = reference.step(cell, state, inputs, dt_ms)
            run.append(((dt_ms, inputs), outputs))
        return run

    @staticmethod
    def differs(other: reference.Cell, run: Run) -> int:
        """The number of the first scan after which another cell has other outputs; 0 if there is none."""
        state = reference.power_up(other)
        for number, ((dt_ms, inputs), expected) in enumerate(run, 1):
            state, outputs = reference.step(other, state, inputs, dt_ms)
            if outputs != expected:
                return number
        return 0

    @cached_property
    def _random(self) -> list[Run]:
        return [
            self._with_outputs([scan for scan, _, _ in self.cases.runner.random_run(seed)])
            for seed in range(RUNS)
        ]

    def _run(self, other: reference.Cell) -> Run:
        """A short run after which another cell has other outputs."""
        for run in self._random:
            if number := self.differs(other, run):
                return self._shortened(other, run[:number])
        return []

    def _shortened(self, other: reference.Cell, run: Run) -> Run:
        size, tries = len(run) // 2, TRIES
        while size and tries:
            at = 0
            while at < len(run) and tries:
                tries -= 1
                less = self._with_outputs([scan for scan, _ in (*run[:at], *run[at + size :])])
                if number := self.differs(other, less):
                    run = less[:number]
                else:
                    at += size
            size //= 2
        return run

    def _same_order(self, edit: Edit) -> bool:
        """Whether another order of calls changes nothing: who reads whom has the same age."""
        return reads_of(wiring_of(edit.after, self.cases.file)) == self._reads

    @cached_property
    def _reads(self) -> set[tuple[str, str, bool]]:
        return reads_of(self.cases.wiring)
