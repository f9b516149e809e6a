"""Follows a log through the graphs of the devices: the set of states that the device may be in, line by line.

A graph counts time in ticks and was made with the parameters of its OPEN_ run. If the log has the same
parameters and only times that the graph has, the graph is followed exactly. Otherwise time is left open:
before every scan the clock of the device may stand anywhere. That accepts too much, never too little. In a
log of several devices each is followed by itself, and what it reads must be what the others last wrote, as
far as the log tells.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from modeproof.graph.device import DeviceGraph
from modeproof.ground.errors import Unjudged
from modeproof.tlc.tla_values import canonical, parse
from modeproof.trace.alphabet import Alphabet
from modeproof.trace.log import Log, Row
from modeproof.trace.targets import Copies, Target

MOST_STEPS = 20_000_000
MOST_MOVES = 20_000


@dataclass(frozen=True)
class Followed:
    """How far the graphs follow a log.

    `accepted` lines fit; `open` says what was left open (empty: followed exactly); `states` is the number of
    states that the device may be in after the last line that fits.
    """

    accepted: int
    open: tuple[str, ...]
    runs: tuple[str, ...]
    states: int
    wrong_input: tuple[str, Any, str] | None = None
    """The input that differs from what was written last, that value, and who wrote it."""


@dataclass(frozen=True)
class NotFollowed:
    """Why no graph can follow a log."""

    reason: str


def timeless(target: Target, device: str, view: Sequence[Any]) -> tuple[Any, ...]:
    """A view without its times. Raises Unjudged when it does not have one component a memory variable."""
    memory = list(target.parts[device].device.memory.values())
    if len(memory) != len(view):
        raise Unjudged(
            f"{target.document}: a state of {device} has {len(view)} components, interface.toml "
            f"declares {len(memory)} memory variables"
        )
    return tuple(value for signal, value in zip(memory, view, strict=True) if signal.type != "ms")


class Follower:
    """The states that one device may be in. `exact`: the times of the log are those of the graph."""

    def __init__(self, target: Target, alphabet: Alphabet, exact: bool, anywhere: bool) -> None:
        self.alphabet = alphabet
        self.graph = alphabet.graph
        self.exact = exact
        graph = self.graph.graph
        self.states = frozenset(range(len(graph.views))) if anywhere else frozenset({graph.initial})
        groups: dict[str, list[int]] = {}
        device = self.graph.device.id
        for number, view in enumerate(graph.views):
            groups.setdefault(canonical(timeless(target, device, parse(view))), []).append(number)
        self._same_but_time = {number: frozenset(group) for group in groups.values() for number in group}
        self._moves: dict[tuple[frozenset[int], tuple[int, ...], bool | None], frozenset[int]] = {}
        self._next: dict[tuple[int, tuple[int, ...]], frozenset[int]] = {}
        self._compared = _Compared(target, self.graph) if target.copies else None

    def scan(self, row: Row, same: bool | None = None) -> bool:
        """Take one scan; false, and the states stay, when it is impossible. `same`: see `_Compared`."""
        move = (self.states, self._letters(row), same)
        if move not in self._moves:
            if len(self._moves) > MOST_MOVES:
                self._moves.clear()
            states, letters = self._opened(self.states), move[1]
            self._moves[move] = self._reached(states, letters, same)
        return self._arrive(self._moves[move], row, (row,))

    def sample(self, before: Row | None, row: Row) -> bool:
        """Any number of scans with the inputs of either row, then the outputs of `row`."""
        letters = tuple(
            dict.fromkeys(n for one in (before, row) if one is not None for n in self._letters(one))
        )
        reached = set(self._opened(self.states))
        waiting = list(reached)
        while waiting:
            for after in self._opened(self._reached((waiting.pop(),), letters, None)):
                if after not in reached:
                    reached.add(after)
                    waiting.append(after)
        return self._arrive(reached, row, tuple(one for one in (before, row) if one is not None))

    def _letters(self, row: Row) -> tuple[int, ...]:
        return self.alphabet.letters(row.inputs, row.dt_ms if self.exact else None)

    def _opened(self, states: Iterable[int]) -> frozenset[int]:
        if self.exact:
            return frozenset(states)
        return frozenset(other for state in states for other in self._same_but_time[state])

    def _reached(self, states: Iterable[int], letters: tuple[int, ...], same: bool | None) -> frozenset[int]:
        moves = [(state, letters) for state in states]
        if self._compared is not None:
            moves = [move for pair in moves for move in self._compared.moves(*pair, same)]
        return frozenset(after for move in moves for after in self._after(*move))

    def _after(self, state: int, letters: tuple[int, ...]) -> frozenset[int]:
        key = (state, letters)
        if key not in self._next:
            row = self.graph.graph.next_of[state]
            self._next[key] = frozenset(row[n] for n in letters)
        return self._next[key]

    def _arrive(self, reached: Iterable[int], row: Row, inputs: Sequence[Row]) -> bool:
        if not passes(self.graph.passed, row, inputs):
            return False
        fitting = frozenset(state for state in reached if self._fits(state, row))
        if fitting:
            self.states = fitting
        return bool(fitting)

    def _fits(self, state: int, row: Row) -> bool:
        outputs = self.graph.rows[state]
        return all(outputs[name] == value for name, value in row.outputs.items() if name in outputs)

    def agreed(self, name: str) -> Any:
        """The value of an output if all possible states have the same, else None."""
        values = {self.graph.rows[state].get(name) for state in self.states}
        return next(iter(values)) if len(values) == 1 else None


def passes(passed: Mapping[str, str], row: Row, inputs: Sequence[Row]) -> bool:
    """Whether the outputs that repeat an input do so, as far as both were observed."""
    return all(
        any(row.outputs[output] == value.inputs.get(given, row.outputs[output]) for value in inputs)
        for output, given in passed.items()
        if output in row.outputs
    )


class _Compared:
    """What a device that only copies compares, in a graph where one word stands for all others.

    Two others can be the same word or not. Where they are not, the device does what it does in the state
    that has zero in that place.
    """

    def __init__(self, target: Target, graph: DeviceGraph) -> None:
        assert target.copies is not None
        copies = target.copies
        at = list(graph.device.memory).index(copies.kept)
        views = [parse(view) for view in graph.graph.views]
        numbers = {canonical(view): number for number, view in enumerate(views)}
        self._zeroed = {
            number: numbers[canonical((*view[:at], 0, *view[at + 1 :]))]
            for number, view in enumerate(views)
            if view[at] == copies.other
        }
        self._others = {n for n, letter in enumerate(graph.alphabet) if letter[copies.read] == copies.other}

    def moves(
        self, state: int, letters: tuple[int, ...], same: bool | None
    ) -> Iterable[tuple[int, tuple[int, ...]]]:
        """From which states, with which letters. `same`: whether the two words are; None: nobody knows."""
        others = tuple(n for n in letters if n in self._others)
        if state not in self._zeroed or not others or same is True:
            return [(state, letters)]
        apart = (self._zeroed[state], others)
        if same is None:
            return [(state, letters), apart]
        return [(state, tuple(n for n in letters if n not in self._others)), apart]


def follow(
    target: Target, log: Log, alphabets: Mapping[str, Alphabet], anywhere: bool, samples: bool
) -> Followed | NotFollowed:
    """Follow a log; `alphabets` has a graph for each device, made with the log's parameters but for times."""
    if target.copies is not None:
        return _follow_each_word(target, log, alphabets, anywhere, samples)
    return _follow(target, log, alphabets, anywhere, samples)


def _follow(
    target: Target,
    log: Log,
    alphabets: Mapping[str, Alphabet],
    anywhere: bool,
    samples: bool,
    same: Iterable[bool | None] = itertools.repeat(None),
) -> Followed | NotFollowed:
    left_open = []
    followers: dict[str, Follower] = {}
    for device in target.parts:
        alphabet = alphabets.get(device)
        reason = _unknown(log, device, alphabet)
        if alphabet is None or reason:
            if not target.system:
                return NotFollowed(reason)
            left_open.append(f"{device} ({reason})")
            continue
        exact = not target.timed(device) or (not samples and _same_times(target, log, alphabet))
        if not exact:
            left_open.append(f"the time of {device}")
        timed = exact and target.timed(device)
        followers[device] = Follower(target, alphabet, exact=timed, anywhere=anywhere)
    if samples:
        left_open.append("how many scans lie between two samples")
    if target.system:
        left_open.append("what no line tells about a wire")
    wires = Wires(target, followers)
    before: Row | None = None
    runs = tuple(candidate.graph.run for candidate in followers.values())
    for n, (row, equal) in enumerate(zip(log.rows, same, strict=False)):
        follower = followers.get(row.device)
        wrong = wires.wrong(row)
        good = wrong is None and (
            follower is None or (follower.sample(before, row) if samples else follower.scan(row, equal))
        )
        if not good:
            states = 0 if follower is None else len(follower.states)
            return Followed(n, tuple(left_open), runs, states, wrong)
        wires.write(row)
        before = row
    states = max((len(candidate.states) for candidate in followers.values()), default=0)
    return Followed(len(log.rows), tuple(left_open), runs, states)


def _unknown(log: Log, device: str, alphabet: Alphabet | None) -> str:
    """Why the graph of a device cannot follow the log, or nothing."""
    if alphabet is None:
        return f"no OPEN run of {device} has the log's parameters"
    for row, _ in log.rows.kinds():
        if row.device == device and not alphabet.letters(row.inputs):
            odd = {name: value for name, value in row.inputs.items() if not alphabet.letters({name: value})}
            shown = ", ".join(f"{name} = {value}" for name, value in (odd or row.inputs).items())
            return f"line {row.line}: no input of {alphabet.graph.run} stands for {shown}"
    return ""


def _same_times(target: Target, log: Log, alphabet: Alphabet) -> bool:
    """Whether the graph was made with the log's times as parameters, and has each time of its rows."""
    device = alphabet.graph.device
    for signal in device.parameters.values():
        given = log.params[device.id].get(signal.name, signal.default)
        if signal.type == "ms" and alphabet.graph.params.get(signal.name, signal.default) != given:
            return False
    known = {letter["dt_ms"] for letter in alphabet.graph.alphabet}
    return log.rows.times(device.id) <= known


class Wires:
    """What each device last wrote, as far as the log and the graphs tell; a wire is an equal name."""

    def __init__(self, target: Target, followers: Mapping[str, Follower] | None = None) -> None:
        self._target = target
        self._followers = followers or {}
        self._values: dict[str, Any] = {}
        self._writer = {name: device for device, part in target.parts.items() for name in part.device.outputs}
        for device in self._followers:
            self._write(device, {})

    def value(self, device: str, name: str) -> Any:
        """What is on the wire that this input reads; None when that is not known."""
        writer = self._writer.get(name)
        return None if writer in (None, device) else self._values.get(name)

    def wrong(self, row: Row) -> tuple[str, Any, str] | None:
        """The first input that differs from what was written: its name, that value, who wrote it."""
        for name, value in row.inputs.items():
            written = self.value(row.device, name)
            if written is not None and written != value:
                return name, written, self._writer[name]
        return None

    def write(self, row: Row) -> None:
        """The outputs of a row go onto the wires."""
        self._write(row.device, row.outputs)

    def _write(self, device: str, outputs: Mapping[str, Any]) -> None:
        for name in self._target.parts[device].device.outputs:
            follower = self._followers.get(device)
            known = outputs.get(name, follower.agreed(name) if follower is not None else None)
            self._values[name] = known


# --------------------------------------------------------------------------- devices that only copy words


def _follow_each_word(
    target: Target, log: Log, alphabets: Mapping[str, Alphabet], anywhere: bool, samples: bool
) -> Followed | NotFollowed:
    """A device that only copies words: its graph is followed once for each word of the log.

    That word is put to the one word of the graph, every other one but zero to the other.
    """
    assert target.copies is not None
    words = sorted(words_of(target, log, target.only.device.id) - {0}) or [target.copies.one]
    if len(words) * len(log.rows) > MOST_STEPS:
        return NotFollowed(f"{len(words):,} words in {len(log.rows):,} lines are too many to follow each")
    found: list[Followed] = []
    for word in words:
        seen = _seen_as(target, log, word)
        one = _follow(target, seen, alphabets, anywhere, samples, _same(target.copies, log, anywhere))
        if isinstance(one, NotFollowed):
            return one
        found.append(one)
    worst = min(found, key=lambda one: one.accepted)
    return Followed(worst.accepted, (*worst.open, "how words hang together"), worst.runs, worst.states)


def _same(copies: Copies, log: Log, anywhere: bool) -> Iterator[bool | None]:
    """Of each scan: whether the two words that the device compares are one; None where the log is silent."""
    kept = None if anywhere else 0
    for row in log.rows:
        read = row.inputs.get(copies.read)
        yield None if kept is None or read is None else kept == read
        kept = row.outputs.get(copies.kept)


def words_of(target: Target, log: Log, device: str) -> frozenset[int]:
    """Every word that the log shows of a device."""
    signals = {**target.parts[device].device.inputs, **target.parts[device].device.outputs}
    return frozenset(
        value
        for row, _ in log.rows.kinds()
        if row.device == device
        for name, value in (*row.inputs.items(), *row.outputs.items())
        if signals[name].type == "word"
    )


def _seen_as(target: Target, log: Log, word: int) -> Log:
    assert target.copies is not None
    one, other = target.copies.one, target.copies.other
    device = target.only.device
    types = {name: signal.type for name, signal in (*device.inputs.items(), *device.outputs.items())}

    def seen(_device: str, _side: str, values: Mapping[str, Any]) -> Mapping[str, Any]:
        return {
            name: (0 if value == 0 else one if value == word else other) if types[name] == "word" else value
            for name, value in values.items()
        }

    return replace(log, rows=log.rows.changed(seen))
