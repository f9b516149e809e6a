"""Suite `sic`: one input changes at a time, and outputs are compared after they have settled.

Hardware that reads its inputs one by one sees two changes at once as two changes in some order. Here no two
inputs ever change together: each event is one input that changes (one bit, or one word), or time that passes
with all inputs held. Then the inputs are held, with as little time as the alphabet has, until the state stays
as it is or goes round among states of the same outputs; then `HOLD` scans more, and only the last scan is
compared.

All states and held inputs that can be reached so are searched, breadth first; so the transitions that the
header lists under `not_so` are those that no sequence of single changes within the alphabet takes. For each
other transition (state, step and next state) there is a case that takes it, and for each settled state and
step one for every state in which it can settle after it. Where a change leads out of a state, each value that
does is tried with each row of outputs that stands there: each level with each selection that it forbids.

The cases of `sequences` are there too, so that programs that need some scans for a step walk the document's
diagrams: where inputs of a scan change together, they change in some order.
"""

from __future__ import annotations

import functools
import itertools
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from modeproof.graph.columns import Columns
from modeproof.graph.device import DeviceGraph
from modeproof.ground.errors import Unjudged
from modeproof.suites import sequences
from modeproof.suites.script import Alphabet, Script, Scripts, Shot, control_state

HOLD = 2
"""Scans for which settled inputs are held at least before outputs are compared."""

Change = tuple[Any, ...]
"""A settled row of outputs, the changed input with its new value, and the step that leads out of the
state."""
Node = tuple[int, int]
"""A settled state and the letter that is held."""
Triple = tuple[int, int, int]
"""A transition: state, step, next state; or -1 less the state in which it settles after that step."""
Pattern = tuple[bool, ...]


@dataclass(frozen=True)
class _Event:
    """From a node one letter is sent once, then `held` until all has settled in `to`."""

    before: Node
    letter: int
    to: Node


def plan(device: DeviceGraph, columns: Columns) -> Scripts:
    """The cases for one graph; `notes` tell which transitions single changes do not reach."""
    search = _Search(device)
    search.run()
    every = {
        (state, step, after)
        for state, (steps, nexts) in enumerate(zip(device.graph.step_of, device.graph.next_of, strict=True))
        for step, after in set(zip(steps, nexts, strict=True))
    }
    missed = every - set(search.found)  # what else was found are changes
    names = device.graph.steps
    all_of = Counter(names[step] for _, step, _ in every)
    not_so = Counter(names[step] for _, step, _ in missed)
    places = Counter(
        (control_state(device, state), names[step], control_state(device, after))
        for state, step, after in missed
    )
    notes = {
        "nodes": len(search.parent),
        "not_so": {name: f"{not_so[name]} of {all_of[name]}" for name in sorted(not_so)},
        "not_so_places": [[*place, count] for place, count in sorted(places.items())],
        "unsettled": search.unsettled,
    }
    drawn = search.drawn(sequences.plan(device, columns).cases)
    return Scripts(itertools.chain(search.cases(), drawn), notes)


class _Search:
    def __init__(self, device: DeviceGraph) -> None:
        self.device, self.graph = device, device.graph
        self.least = min(letter["dt_ms"] for letter in device.alphabet)
        self.inputs = _Inputs(device)
        held = [n for n, letter in enumerate(device.alphabet) if letter["dt_ms"] == self.least]
        self.neighbours = {n: self.inputs.changes(n) for n in held}
        self.later = {n: self.inputs.later(n, self.least) for n in held}
        self.settled: dict[Node, tuple[int, ...] | None] = {}
        self.parent: dict[Node, _Event] = {}
        self.found: dict[Triple | Change, _Event] = {}
        self.depth: dict[Node, int] = {}
        self.unsettled = 0

    def run(self) -> None:
        """Search all nodes; `found` holds for each transition the event that takes it first."""
        first = next(n for n, inputs in enumerate(self.device.alphabet) if inputs["dt_ms"] == self.least)
        start = (self.graph.initial, first)
        queue = [] if self._go(start, first, first, None) is None else list(self.parent)
        for node in queue:
            state, held = node
            for letter, then in self._events(held):
                after = self._go(node, letter, then, state)
                if after is not None:
                    queue.append(after)

    def _events(self, held: int) -> Iterator[tuple[int, int]]:
        for letter in self.neighbours[held]:
            yield letter, letter
        for letter in self.later[held]:
            yield letter, held

    def _go(self, node: Node, letter: int, held: int, state: int | None) -> Node | None:
        """Take an event; the node that it leads to, if it is a new one."""
        origin = node[0] if state is None else state
        after = self.graph.next_of[origin][letter]
        path = self._settle(after, held)
        if path is None:
            self.unsettled += 1
            return None
        to = (path[-1], held)
        event = _Event(node, letter, to)
        before, step = origin, self.graph.step_of[origin][letter]
        self.found.setdefault((before, step, -1 - path[-1]), event)
        if state is not None and after != origin:
            self.found.setdefault(self._change(origin, node[1], letter, step), event)
        for n, reached in enumerate(path):
            triple = (before, step, reached)
            if triple not in self.found:
                self.found[triple] = event
            if n + 1 < len(path):
                before, step = reached, self.graph.step_of[reached][held]
        if to in self.parent:
            return None
        self.parent[to] = event
        if state is None:
            self.first = event
        self.depth[to] = 0 if state is None else self.depth[node] + 1
        return to

    def _change(self, state: int, held: int, letter: int, step: int) -> Change:
        old, new = self.device.alphabet[held], self.device.alphabet[letter]
        values = tuple((name, value) for name, value in new.items() if value != old[name])
        return ("change", self.device.seen[state], values, step)

    def _settle(self, state: int, held: int) -> tuple[int, ...] | None:
        """The states from `state` on while the letter is held, to the last of the hold; None if never."""
        key = (state, held)
        if key not in self.settled:
            path, at = [state], {state: 0}
            while (after := self.graph.next_of[path[-1]][held]) not in at:
                at[after] = len(path)
                path.append(after)
            cycle = path[at[after] :]
            rows = self.device.rows
            if any(rows[node] != rows[cycle[0]] for node in cycle):
                self.settled[key] = None
            else:
                path = path[: at[after] + 1]
                rounds = -(-HOLD // len(cycle))
                self.settled[key] = (*path, *([*cycle[1:], cycle[0]] * rounds))
        return self.settled[key]

    # -------------------------------------------------------------------------------------------- cases

    def cases(self) -> Iterator[Script]:
        """Cases that take every transition found, those that need most events first."""
        left = dict(self.found)
        order = sorted(left, key=lambda wanted: -self.depth.get(left[wanted].before, -1))
        for triple in order:
            if triple in left:
                script, taken = self._script(triple, left[triple])
                for transition in taken:
                    left.pop(transition, None)
                yield script

    def _script(self, triple: Triple | Change, event: _Event) -> tuple[Script, set[Triple | Change]]:
        chain = [event]
        while chain[-1] is not self.first:
            chain.append(self.parent[chain[-1].before])
        walk = _Walk(self.graph.initial)
        for step in reversed(chain):
            if step is not self.first:
                target = step.letter if step.letter in self.neighbours[step.before[1]] else step.before[1]
                *inner, last = self.inputs.way(walk.pattern, step.before[1], target)
                for pattern in inner:
                    self._take(walk, step.before[1], step.before[1], pattern)
                walk.pattern = last
                moved = self.graph.step_of[walk.state][step.letter]
                walk.taken.add(self._change(walk.state, step.before[1], step.letter, moved))
            else:
                walk.pattern = self.inputs.own(step.letter)
            self._take(walk, step.letter, step.to[1], walk.pattern)
        if triple not in walk.taken:
            raise Unjudged(f"{self.device.name}: a case of the suite sic does not take what it must")
        state, step = event.before[0], triple[-1]
        if triple[0] != "change":
            state, step = triple[:2]
        control = control_state(self.device, state)
        why = f"single changes of inputs lead to {self.graph.steps[step]} in {control}"
        return Script(why, walk.shots, about=(walk.last,)), walk.taken

    def drawn(self, scripts: Iterable[Script]) -> Iterator[Script]:
        """The given cases with single changes, as far as all settles on the way."""
        for script in scripts:
            shots = self._one_at_a_time([shot.letter for shot in script.shots])
            if shots:
                yield replace(script, why=f"{script.why} Inputs change one at a time.", shots=shots)

    def _one_at_a_time(self, letters: Sequence[int]) -> list[Shot]:
        """Scans in which each letter is reached by single changes and settles; none if that cannot be."""
        walk, held = _Walk(self.graph.initial), -1
        for letter in letters:
            still = self.inputs.alphabet.changed(letter, dt_ms=self.least)
            way = None if still is None else self._way(held, still)
            if still is None or way is None:
                return []
            for changed in way:
                patterns = (
                    self.inputs.way(walk.pattern, held, changed) if held >= 0 else [self.inputs.own(changed)]
                )
                for pattern in patterns[:-1]:
                    self._take(walk, held, held, pattern)
                walk.pattern = patterns[-1]
                if self._settle(self.graph.next_of[walk.state][changed], changed) is None:
                    return []
                self._take(walk, changed, changed, walk.pattern)
                held = changed
            if letter != held:
                if self._settle(self.graph.next_of[walk.state][letter], held) is None:
                    return []
                self._take(walk, letter, held, walk.pattern)
        return walk.shots

    def _way(self, held: int, letter: int) -> list[int] | None:
        """Letters one change apart to `letter`, none twice, each input as in the one or in the other."""
        if held < 0 or held == letter:
            return [letter] if held < 0 else []
        ends = [self.device.alphabet[end] for end in (held, letter)]
        before, queue = {held: held}, [held]
        for reached in queue:
            for near in self.neighbours[reached]:
                between = all(
                    value in (ends[0][name], ends[1][name])
                    for name, value in self.device.alphabet[near].items()
                )
                if near not in before and between:
                    before[near] = reached
                    queue.append(near)
        way = [letter] if letter in before else []
        while way and before[way[-1]] != held:
            way.append(before[way[-1]])
        return way[::-1] or None

    def _take(self, walk: _Walk, letter: int, held: int, pattern: Pattern) -> None:
        values = dict(zip(self.inputs.fields, pattern, strict=True))
        path = self._settle(self.graph.next_of[walk.state][letter], held)
        assert path is not None, "the search has settled it"
        walk.last = len(walk.shots)
        step = self.graph.step_of[walk.state][letter]
        walk.taken.add((walk.state, step, -1 - path[-1]))
        for n, reached in enumerate(path):
            used = held if n else letter
            walk.taken.add((walk.state, self.graph.step_of[walk.state][used], reached))
            walk.shots.append(Shot(used, values, settling=n + 1 < len(path)))
            walk.state = reached


@dataclass
class _Walk:
    """A case while it is made; `pattern` are the fields of classes as they are, `last` the last event."""

    state: int
    pattern: Pattern = ()
    shots: list[Shot] = field(default_factory=list)
    taken: set[Triple | Change] = field(default_factory=set)
    last: int = 0


class _Inputs:
    """Single changes between letters, also where one stands for a class of patterns of several fields."""

    def __init__(self, device: DeviceGraph) -> None:
        self.device, self.alphabet = device, Alphabet(device)
        classes = [input_class for input_class in device.classes if len(input_class.representative) > 1]
        self.fields = tuple(sorted({name for input_class in classes for name in input_class.representative}))
        letters = {self.own(n) for n in range(len(device.alphabet))}
        self._of: dict[Pattern, Pattern] = {pattern: pattern for pattern in letters}
        for input_class in classes:
            if set(input_class.representative) == set(self.fields):
                stands = self._pattern(input_class.representative)
                for member in input_class.members:
                    self._of.setdefault(self._pattern(member), stands)

    def own(self, letter: int) -> Pattern:
        """The fields of classes as the letter has them."""
        return self._pattern(self.device.alphabet[letter])

    def _pattern(self, values: Mapping[str, Any]) -> Pattern:
        return tuple(values[name] for name in self.fields)

    def _flips(self, pattern: Pattern) -> Iterator[Pattern]:
        for n in range(len(pattern)):
            flipped = (*pattern[:n], not pattern[n], *pattern[n + 1 :])
            if flipped in self._of:
                yield flipped

    def changes(self, letter: int) -> tuple[int, ...]:
        """The letters that one changed input leads to, in the order of inputs and values."""
        have = self.device.alphabet[letter]
        found: dict[int, None] = {}
        for name in self.device.device.inputs:
            if name in self.fields:
                continue
            for value in self._values(name):
                other = self.alphabet.changed(letter, **{name: value})
                if other is not None and value != have[name]:
                    found[other] = None
        mine = self.own(letter)
        for pattern in [known for known, stands in self._of.items() if stands == mine]:
            for flipped in self._flips(pattern):
                fields = dict(zip(self.fields, self._of[flipped], strict=True))
                other = self.alphabet.changed(letter, **fields)
                if other is not None and other != letter:
                    found[other] = None
        return tuple(found)

    @functools.cache  # noqa: B019 -- it lives as long as one search
    def _values(self, name: str) -> tuple[Any, ...]:
        return tuple(dict.fromkeys(letter[name] for letter in self.device.alphabet))

    def later(self, letter: int, least: int) -> tuple[int, ...]:
        """The letters of the same inputs with more time."""
        times = [time for time in self._values("dt_ms") if time > least]
        found = [self.alphabet.changed(letter, dt_ms=time) for time in sorted(times)]
        return tuple(changed for changed in found if changed is not None)

    def way(self, pattern: Pattern, held: int, letter: int) -> list[Pattern]:
        """Patterns one flip apart, within what `held` stands for, to one that `letter` stands for."""
        mine, goal = self.own(held), self.own(letter)
        if mine == goal:
            return [pattern]
        before: dict[Pattern, Pattern] = {pattern: pattern}
        queue = [pattern]
        for reached in queue:
            for flipped in self._flips(reached):
                if flipped in before or self._of[flipped] not in (mine, goal):
                    continue
                before[flipped] = reached
                if self._of[flipped] == goal:
                    way = [flipped]
                    while (back := before[way[-1]]) != pattern:
                        way.append(back)
                    return way[::-1]
                queue.append(flipped)
        raise Unjudged(f"{self.device.name}: no single changes lead from {pattern} to {goal}")
