"""Runs of a machine with plain values: scans that break a property, and situations that do occur.

The steps are those of refimpl, wired by refimpl/machine_cell; nothing of the terms is used. A file such as
spec/machine_cell/use.toml says how a cell is used, so that runs get somewhere.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import SimpleNamespace
from typing import Any

from machines.composed_program import Watched, kind_of
from machines.use import Use as Use
from machines.use import check_use
from machines.use import read_use as read_use
from machines.wiring import PLAIN, Wiring, is_plain
from modeproof.ground.errors import Unjudged
from refimpl.errors import ParameterError
from refimpl.machine_cell import cell as reference
from refimpl.machine_cell.expression import Signal, Value, signal

Inputs = Mapping[str, Value]
Scan = tuple[int, Inputs]
"""The time since the scan before in ms, and the inputs."""
SCANS = 150
"""Of a run."""


@dataclass(frozen=True)
class Rule:
    """A property over plain values; the fields are those of `cell.Asked`."""

    id: str
    holds: Signal
    triggers: tuple[Signal, ...]
    within_ms: int | None
    once: Signal | None

    def start(self) -> tuple[bool, int]:
        """What it remembers at power-up: whether it waits, and for how long."""
        return False, 0

    def after(self, memory: tuple[bool, int], values: Mapping[str, Value], dt_ms: int) -> Any:
        """Whether the property is false after a scan, and what is remembered."""
        waits, since = memory
        if self.once is not None:
            waits = (waits or bool(self.triggers[0](values))) and not self.once(values)
            return waits and bool(self.holds(values)), (waits, 0)
        if self.within_ms is None:
            return not self.holds(values), memory
        since = since + dt_ms if waits else 0
        late = waits and since > self.within_ms
        return late, ((waits or bool(self.triggers[0](values))) and not self.holds(values), since)


def rule_of(row: Mapping[str, Any], triggers: Sequence[str], named: Mapping[str, str]) -> Rule:
    """A row of a file of properties; `triggers` are the texts of what must occur."""

    def made(text: str) -> Signal:
        return signal(text, named)

    if "never" in row:
        holds = made(f"NOT ({row['never']})")
    elif "always" in row:
        holds = made(row["always"])
    elif "only_if" in row:
        holds = made(f"NOT ({row['holds']}) OR ({row['only_if']})")
    else:
        holds = made(row["holds"])
    if "after" in row and not triggers:
        triggers = [row["after"]]
    once = made(row["only_once"]) if "only_once" in row else None
    return Rule(row["id"], holds, tuple(map(made, triggers)), row.get("within_ms"), once)


@dataclass(frozen=True)
class Runner:
    """A wiring with observers, as the reference runs it."""

    wiring: Wiring
    watched: Watched
    use: Use
    table: Mapping[str, Any]
    """The wiring as plain tables, with the observers as blocks that are called last."""
    cell: reference.Cell
    named: Mapping[str, str]
    follows: Mapping[str, Signal]

    @staticmethod
    def of(wiring: Wiring, watched: Watched, use: Use, table: Mapping[str, Any]) -> Runner:
        """The runner of a wiring whose file says `table`. Raises Unjudged, also for the use."""
        made = Runner.without_cell(wiring, watched, use, table)
        try:
            return replace(made, cell=reference.made_of(made.table))
        except ParameterError as error:
            raise Unjudged(f"{wiring.file}: {error}") from None

    @staticmethod
    def without_cell(wiring: Wiring, watched: Watched, use: Use, table: Mapping[str, Any]) -> Runner:
        """The same, of whose cell the inputs alone are known: for a machine that something else runs."""
        check_use(use, wiring)
        rows = {name: {"of": seen.of, "inputs": seen.inputs} for name, seen in watched.rows.items()}
        whole = {
            **table,
            "block": {**table["block"], **rows},
            "order": [*table["order"], *rows],
            "signals": {
                **table.get("signals", {}),
                **{name: row for name, row in table["outputs"].items() if name not in table["inputs"]},
            },
        }
        cell: Any = SimpleNamespace(inputs={name: row.type for name, row in wiring.table.inputs.items()})
        try:
            named = {name: row["is"] for name, row in whole["signals"].items()}
            named |= reference.from_matrix(whole)
            follows = {name: signal(text, named) for name, text in followed(use, wiring, watched).items()}
        except ParameterError as error:
            raise Unjudged(f"{wiring.file}: {error}") from None
        return Runner(wiring, watched, use, whole, cell, named, follows)

    def power_up(self) -> Any:
        """The state before the first scan."""
        return reference.power_up(self.cell)

    def scan(self, state: Any, inputs: Inputs, dt_ms: int) -> tuple[Any, dict[str, Value]]:
        """The state after a scan, and all values then."""
        after, _ = reference.step(self.cell, state, inputs, dt_ms)
        return after, reference.values_after(self.cell, after, inputs)

    def kept(self, state: Any) -> Any:
        """A state that later scans do not change."""
        return state

    def stories(self) -> dict[str, list[dict[str, Value]]]:
        """What changes in each scan of each story; an input that this cell has not is left out."""
        found = {}
        for story in self.use.story:
            rows: list[dict[str, Value]] = []
            for row in story["row"]:
                given = {name: value for name, value in row.items() if name in self.cell.inputs}
                rows += [given] * row.get("scans", 1)
            if any(rows):
                found[story["id"]] = rows
        return found

    @cached_property
    def tours(self) -> list[tuple[int, list[dict[str, Value]]]]:
        """Scan time and rows of the tours: each story that likes to begin, and what likes to follow it.

        Of what follows that, one story each; then a fresh start, or another beginning. Each comes with the
        shortest and with the longest scans. Last from each beginning to the next.
        """
        known, times = self.stories(), self.wiring.table.scan_ms
        then = {
            story["id"]: [name for name in dict.fromkeys(story.get("then", ())) if name in known]
            for story in self.use.story
        }
        first = [story["id"] for story in self.use.story if story.get("first") and story["id"] in known]
        found = []
        for at, name in enumerate(first):
            for begin in then[name]:
                for number, last in enumerate(then[begin]):
                    other = first[(at + 1 + number % max(1, len(first) - 1)) % len(first)]
                    pair = [(times[0], begin), (times[1], other)], [(times[1], begin), (times[0], other)]
                    for dt_ms, end in pair[number % 2]:
                        found.append((dt_ms, [name, begin, last, end]))
        random.Random(1).shuffle(found)  # so that one that breaks something comes early
        for number, names in enumerate(itertools.pairwise((*first, *reversed(first)))):
            found.append((times[number % 2], [part for name in names for part in (name, *then[name][:1])]))
        return [(dt_ms, [row for name in names for row in known[name]]) for dt_ms, names in found]

    def runs(self, seed: int) -> Iterator[tuple[Scan, Any, Inputs]]:
        """The tours, and then random runs."""
        if seed < len(self.tours):
            dt_ms, told = self.tours[seed]
            return self.run(random.Random(seed), len(told), list(told), (0.0, 1.0, dt_ms))
        return self.random_run(seed)

    def random_run(self, seed: int, scans: int = SCANS) -> Iterator[tuple[Scan, Any, Inputs]]:
        """A run with stories by chance, and with inputs that change by chance or are stuck."""
        choose = random.Random(seed)
        wild, honest = choose.choice((0.0, 0.01, 0.03, 0.1)), choose.choice((1.0, 0.98, 0.8))
        return self.run(choose, scans, [], (wild, honest, choose.choice(self.wiring.table.scan_ms)))

    def run(
        self,
        choose: random.Random,
        scans: int,
        told: list[dict[str, Value]],
        likely: tuple[float, float, int],
    ) -> Iterator[tuple[Scan, Any, Inputs]]:
        """A run from power-up: each scan, the state and all values after it.

        told: what changes in the first scans. likely: how often an input changes by chance, how often one
        follows as it should, the usual scan time.
        """
        wild, honest, usual = likely
        low, high = self.wiring.table.scan_ms
        times = [low, self.wiring.table.cycle_ms, high]
        inputs: dict[str, Value] = {name: kind == "WORD" and 0 for name, kind in self.cell.inputs.items()}
        inputs |= {name: value for name, value in self.use.rest.items() if name in inputs}
        state, values = self.power_up(), dict[str, Value]()
        stories, toured = self.stories(), bool(told)
        then = {
            story["id"]: [name for name in story.get("then", ()) if name in stories]
            for story in self.use.story
        }
        following = [story["id"] for story in self.use.story if story.get("first") and story["id"] in stories]
        stuck: dict[str, int] = {}
        for _ in range(scans):
            if not told and stories and choose.random() < (0.8 if following else 0.5):
                name = choose.choice(following or list(stories))
                told, following = list(stories[name]), then[name]
            elif not told and choose.random() < 0.6:
                told = [{} for _ in range(choose.randrange(1, 6))]
            before = dict(inputs)
            for name, source in self.follows.items():
                if values and choose.random() < honest:
                    inputs[name] = source(values)
            for pattern in self.use.pattern:
                if (
                    not toured
                    and choose.random() < 0.06
                    and all(name in inputs for name in pattern["inputs"])
                ):
                    inputs |= zip(pattern["inputs"], choose.choice(pattern["rows"]), strict=True)
            for name, kind in self.cell.inputs.items() if wild else ():
                if choose.random() < wild:
                    inputs[name] = not inputs[name] if kind == "BOOL" else choose.choice((0, 1, 0x0FF0))
            inputs |= told.pop(0) if told else {}
            if choose.random() < wild:
                stuck[choose.choice(list(inputs))] = choose.randrange(2, 20)
            for name in [*stuck]:
                inputs[name] = before[name]
                stuck[name] -= 1
                if not stuck[name]:
                    del stuck[name]
            dt_ms = choose.choice(times) if not toured and choose.random() < 0.2 else usual
            state, values = self.scan(state, inputs, dt_ms)
            yield (dt_ms, dict(inputs)), state, values

    def on(self, state: Any, scans: int, choose: random.Random) -> Iterator[tuple[int, Any, Inputs]]:
        """A run with any inputs from a state on: the time, the state and all values after each scan."""
        words = sorted(
            {
                value
                for rows in self.stories().values()
                for row in rows
                for value in row.values()
                if type(value) is int
            }
        )
        inputs = {
            name: self.use.rest.get(name, kind == "WORD" and 0) for name, kind in self.cell.inputs.items()
        }
        likely = choose.choice((0.1, 0.3, 0.5))
        for _ in range(scans):
            for pattern in self.use.pattern:
                if choose.random() < 0.5 and all(name in inputs for name in pattern["inputs"]):
                    inputs |= zip(pattern["inputs"], choose.choice(pattern["rows"]), strict=True)
            for name, kind in self.cell.inputs.items():
                if choose.random() < likely:
                    inputs[name] = not inputs[name] if kind == "BOOL" else choose.choice(words or [0])
            dt_ms = choose.choice(self.wiring.table.scan_ms)
            state, values = self.scan(state, inputs, dt_ms)
            yield dt_ms, state, values

    def replayed(self, scans: Sequence[Scan]) -> Iterator[Inputs]:
        """All values after each of these scans from power-up."""
        state = self.power_up()
        for dt_ms, inputs in scans:
            state, values = self.scan(state, inputs, dt_ms)
            yield values

    def broken(self, scans: Sequence[Scan], rule: Rule) -> int | None:
        """The number of the first scan after which a property is false; None: it is true after all."""
        state, memory = self.power_up(), rule.start()
        for number, (dt_ms, inputs) in enumerate(scans, 1):
            state, values = self.scan(state, inputs, dt_ms)
            wrong, memory = rule.after(memory, values, dt_ms)
            if wrong:
                return number
        return None

    def shortened(self, scans: Sequence[Scan], rule: Rule, tries: int) -> list[Scan]:
        """Fewer scans, and fewer changes of inputs, that break the property too."""
        kept = list(scans[: self.broken(scans, rule)])
        size = max(1, len(kept) // 2)
        while size and tries > 0:
            at = 0
            while at < len(kept) and tries > 0:
                tries -= 1
                less = [*kept[:at], *kept[at + size :]]
                if (number := self.broken(less, rule)) is not None:
                    kept = less[:number]
                else:
                    at += size
            size //= 2
        return self._calmer(kept, rule, tries)

    def calmed(self, scans: Sequence[Scan], rule: Rule, tries: int) -> list[Scan]:
        """As many scans that break the property too: usual times, and inputs that rest where they may."""
        kept, cycle = list(scans), self.wiring.table.cycle_ms
        for name, kind in self.cell.inputs.items():
            rest = self.use.rest.get(name, kind == "WORD" and 0)
            for value in dict.fromkeys((rest, kept[-1][1][name])):
                trial: list[Scan] = [(dt_ms, {**inputs, name: value}) for dt_ms, inputs in kept]
                tries -= 1
                if self.broken(trial, rule) == len(kept):
                    kept = trial
                    break
        usual: list[Scan] = [(cycle, inputs) for _, inputs in kept]
        if self.broken(usual, rule) == len(kept):
            kept = usual
        return self._calmer(kept, rule, tries)

    def _calmer(self, scans: list[Scan], rule: Rule, tries: int) -> list[Scan]:
        """The same scans with each input left as it was in the scan before, wherever that breaks it too."""
        for name in self.cell.inputs:
            for at in range(1, len(scans)):
                before = scans[at - 1][1][name]
                if scans[at][1][name] == before or tries <= 0:
                    continue
                tries -= 1
                end = next((n for n in range(at, len(scans)) if scans[n][1][name] == before), len(scans))
                trial = [
                    (dt_ms, {**inputs, name: before} if at <= n < end else inputs)
                    for n, (dt_ms, inputs) in enumerate(scans)
                ]
                if self.broken(trial, rule) is not None:
                    scans = trial[: self.broken(trial, rule)]
                    break
        return scans


def followed(use: Use, wiring: Wiring, watched: Watched) -> dict[str, str]:
    """What each input of the wiring follows; what names nothing of the wiring is left out.

    Raises Unjudged with file, line and row: no signal, or one of another type than the input.
    """
    found = {}
    for name, text in use.follows.items():
        if name not in wiring.table.inputs:
            continue
        place, here = use.place(f"follows.{name}"), f"follows.{name}"
        kind = kind_of(wiring, watched, text, place, here)
        if kind is None:
            continue
        if not is_plain(text):
            raise place.refuse(f"{here}: {text!r}: {PLAIN}")
        if kind.name != (wanted := wiring.table.inputs[name].type):
            raise place.refuse(f"{here}: {text!r} is a {kind.name}, and {name} is a {wanted}")
        found[name] = text
    return found


@dataclass
class Seen:
    """What runs gave: the shortest run that breaks each property, and which triggers were true."""

    broken: dict[str, list[Scan]] = field(default_factory=dict)
    reached: dict[str, list[int | None]] = field(default_factory=dict)
    """For each trigger of a property the scans of the first run in which it was true."""
    samples: list[tuple[Any, Mapping[str, tuple[bool, int]]]] = field(default_factory=list)
    scans: int = 0


def look(
    runner: Runner,
    rules: Sequence[Rule],
    runs: range,
    enough: Callable[[Seen], bool],
    keep: int = 0,
) -> Seen:
    """Random runs, until it is enough. keep: every so many scans are kept as a sample; 0: none."""
    seen = Seen(reached={rule.id: [None] * len(rule.triggers) for rule in rules})
    missed = [(rule.id, number, made) for rule in rules for number, made in enumerate(rule.triggers)]
    plain = [rule for rule in rules if rule.once is None and rule.within_ms is None]
    watching = [rule for rule in rules if rule.once is not None or rule.within_ms is not None]
    for seed in runs:
        memory = {rule.id: rule.start() for rule in rules}
        scans: list[Scan] = []
        for scan, state, values in runner.runs(seed):
            scans.append(scan)
            seen.scans += 1
            broken = [rule.id for rule in plain if not rule.holds(values)]
            for rule in watching:
                wrong, memory[rule.id] = rule.after(memory[rule.id], values, scan[0])
                if wrong:
                    broken.append(rule.id)
            for id in broken:
                if id not in seen.broken or len(scans) < len(seen.broken[id]):
                    seen.broken[id] = list(scans)
            if found := [part for part in missed if part[2](values)]:
                for id, number, _ in found:
                    seen.reached[id][number] = len(scans)
                missed = [part for part in missed if part not in found]
            if keep and seen.scans % keep == 0:
                seen.samples.append((runner.kept(state), dict(memory)))
        if enough(seen):
            break
    return seen
