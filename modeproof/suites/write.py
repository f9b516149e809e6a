"""Turns walks in graphs into a vector file (see modeproof.kit.vectors for the form)."""

from __future__ import annotations

import gzip
import io
import json
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.errors import Unjudged
from modeproof.evidence.files import write_whole
from modeproof.graph.classes import Members
from modeproof.graph.columns import Columns, merge_columns
from modeproof.graph.device import DeviceGraph
from modeproof.kit.rule import words as words_of
from modeproof.kit.vectors import EXACT, KIND, MONITOR, PACKED, SETTLED, VERSION, id_of_text
from modeproof.registers.rows import Device, Signal
from modeproof.suites import extra, refusals, sequences, sic, times, words, wp
from modeproof.suites.bound import lower_bound
from modeproof.suites.contract import declare, declare_parameters
from modeproof.suites.identify import machine
from modeproof.suites.script import Plan, Script, Shot
from modeproof.suites.tour import Move, covers, every_step, every_transition, walks

ADAPTER = "adapter"
PACKING = 9
"""How hard gzip tries."""
_ENCODE = json.JSONEncoder(separators=(",", ":")).encode
_SORTED = json.JSONEncoder(sort_keys=True, separators=(",", ":")).encode


@dataclass(frozen=True)
class Kind:
    """A suite: walks that take what `wanted` names, or ready `walks`, or the cases of a `plan`.

    `counted_by` is what makes a transition besides state and step: the column or the next state. `relations`
    are those by which a program can be judged with it, the closest first; `fast` suites end within a minute
    or so. Not `always` is there a suite of every target.
    """

    guarantees: str
    hypothesis: str
    does_not_show: str
    counted_by: str
    relations: tuple[str, ...] = (EXACT, MONITOR)
    fast: bool = True
    always: bool = True
    wanted: Callable[[Columns], list[list[int]]] | None = None
    plan: Plan | None = None
    walks: Callable[[Columns, int, Sequence[Hashable]], list[list[Move]]] | None = None
    rule: Callable[[DeviceGraph, Columns], dict[str, Any]] | None = None
    why: str = "takes transitions no earlier case has taken"


SUITES = {
    "tour": Kind(
        guarantees="every transition of the specification's graph with merged input columns is taken",
        hypothesis="the program treats all inputs of a column alike; members take turns, not all are tried",
        does_not_show="a memory of the program beyond the states of the graph; inputs that were not used",
        counted_by="column",
        fast=False,
        wanted=every_transition,
    ),
    "brief": Kind(
        guarantees="from every state of the specification every step to every next state is taken",
        hypothesis="the program treats all inputs alike that lead from one state by one step to one state",
        does_not_show="what `tour` shows besides: every column in every state",
        counted_by="next state",
        wanted=every_step,
    ),
    "wp": Kind(
        guarantees=(
            "a program with at most n states (k = 0 more than the graph) that treats all inputs of a column "
            "alike and passes is equal to the graph, over all columns; n stands under `complete` of each "
            "graph; a column is a set of inputs that take the graph by the same step to the same state from "
            "whatever state, time included; `modeproof vectors lint` proves this from the file alone"
        ),
        hypothesis=(
            "the program has at most n states, counted as an observer of its outputs would count them, and "
            "treats all inputs of a column alike; members take turns, not all are tried"
        ),
        does_not_show=(
            "a program that remembers more than n states; inputs of a column that were not used; that a "
            "reset is one is taken for granted"
        ),
        counted_by="column",
        fast=False,
        walks=wp.walks,
        why="ends each new transition with inputs that tell the state it led to from all others",
    ),
    "wp1": Kind(
        guarantees=(
            "a program with at most n + 1 states (k = 1 more than the graph) that passes answers every "
            "sequence of the sub-alphabet rightly, after the way to each state; under `rule` of each graph "
            "stand n (`states`), the columns of the sub-alphabet (the first `sub` of `letters`), and what "
            "the cases are made from while they are judged"
        ),
        hypothesis=(
            "the program has at most n + 1 states, counted as an observer of its outputs would count them, "
            "and is a function of them and of the inputs that are used"
        ),
        does_not_show="the other columns, which `wp` takes for k = 0; a program that remembers more",
        counted_by="next state",
        fast=False,
        rule=extra.rule,
    ),
    "words": Kind(
        guarantees=(
            "in every control state where a word decides, the one-bit neighbours of every code that decides "
            "there, its swapped bytes, complement and shifts, and the boundaries are tried; in one of these "
            "control states each word that agrees with the code in one byte only; after each, inputs follow "
            "by which outputs tell the right state from the one that the code leads to"
        ),
        hypothesis=(
            "the program compares a word in one way in all states of a control state, and a word that agrees "
            "with a code in one byte in one way in all control states"
        ),
        does_not_show="each of the 65,536 words in each state; two wrong words at once",
        counted_by="next state",
        always=False,
        plan=words.plan,
    ),
    "refusals": Kind(
        guarantees=(
            "each form of request that protocol 1 forbids is sent once, in a control state where it would "
            "change the state without its fault; and in every control state well-formed inputs that no "
            "adapter may refuse are answered by the program as specified"
        ),
        hypothesis="the adapter checks a request in one way, whatever the program behind it is doing",
        does_not_show="every combination of faults in one request; what the program does besides",
        counted_by="next state",
        relations=(EXACT,),
        plan=refusals.plan,
    ),
    "sic": Kind(
        guarantees=(
            "inputs change one at a time and are held until all has settled; every step from every state to "
            "every next state that such changes can take is taken; the header lists the others"
        ),
        hypothesis="the program settles in the scans given, and treats all inputs of a column alike",
        does_not_show="what outputs are while they settle; the transitions that single changes do not reach",
        counted_by="next state",
        relations=(EXACT, SETTLED, MONITOR),
        plan=sic.plan,
    ),
    "times": Kind(
        guarantees=(
            "in every control state where time passes, the time of one scan is sent in pieces too, to the "
            "millisecond; and where a state stays as it is, it is held for more than 32,768 ms and for about "
            "65,536 ms; after each, inputs follow by which outputs tell the right state from the same "
            "control state at another time"
        ),
        hypothesis="the program counts time in one way in all states of a control state",
        does_not_show="every split of every time; waits of days",
        counted_by="next state",
        always=False,
        plan=times.plan,
    ),
    "sequences": Kind(
        guarantees=(
            "the document's diagrams are walked as drawn: every good flow, and every other ending that is "
            "printed, from power-up; the clauses that a case is about are those of its boxes"
        ),
        hypothesis="none beyond these inputs: they are examples",
        does_not_show="anything off the ways that are drawn",
        counted_by="next state",
        always=False,
        plan=sequences.plan,
    ),
}
"""All suites by name."""


class NoCases(Unjudged):
    """A suite that has nothing to try in these graphs: no time passes, or the document declares nothing."""


Pieces = tuple[str, ...]
"""Signals as they are written, `"name":value` each, in the order of the names."""

Citations = Callable[[str], tuple[tuple[str, ...], tuple[str, ...]]]
"""From the name of a step to the clauses and the findings that it cites."""


@dataclass(frozen=True)
class Stats:
    """What a suite holds: transitions of the merged graphs, inputs that were used of all, cases and scans."""

    states: int
    columns: int
    transitions: int
    inputs_used: int
    inputs: int
    cases: int
    scans: int
    longest: int

    def __str__(self) -> str:
        return (
            f"{self.states:,} states x {self.columns:,} columns: {self.transitions:,} transitions in "
            f"{self.cases:,} cases, {self.scans:,} scans (longest case {self.longest:,}); "
            f"{self.inputs_used:,} of {self.inputs:,} inputs used"
        )


def no_citations(step: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """For graphs whose registers are not at hand."""
    return (), ()


def write_suite(
    path: Path,
    suite: str,
    devices: Sequence[DeviceGraph],
    *,
    citations: Citations = no_citations,
    sources: Mapping[str, str] | None = None,
    generator: str = "modeproof",
    contract: Mapping[str, Any] | None = None,
    texts: Mapping[str, str] | None = None,
) -> Stats:
    """Build a suite of `SUITES` from all graphs of one target and write it as a whole or not at all.

    `sources` are hashes of what the graphs were made from, by relative path, `contract` what
    `load_contract` says of the target, `texts` what clauses and findings say in our words. Raises Unjudged
    when the graphs belong to several targets, when the walks do not cover what they must, or when the file
    cannot be written.
    """
    if suite not in SUITES:
        raise Unjudged(f"no suite {suite!r}; there are: {', '.join(SUITES)}")
    if not devices or len({(one.document, one.device.id) for one in devices}) != 1:
        raise Unjudged("a suite is built from the graphs of one target")
    writer = _Writer(suite, devices, citations)
    for number, device in enumerate(devices):
        writer.add(number, device)
    if not (writer.cases or writer.made):
        raise NoCases(f"{devices[0].device.id} {suite}: the suite would have no cases")
    header = writer.header(dict(sources or {}), generator, contract)
    header["texts"] = _cited_texts(header, texts or {})
    _write_lines(path, [_line(header), *writer.cases])
    return writer.stats()


class _Writer:
    def __init__(self, suite: str, devices: Sequence[DeviceGraph], citations: Citations) -> None:
        self.suite = suite
        self.device = devices[0]
        self.citations = citations
        self.steps = {name: n for n, name in enumerate(self.device.device.steps)}
        self.transitions: Counter[str] = Counter()
        self.cases: list[str] = []
        self.graphs: list[dict[str, Any]] = []
        self.states = self.columns = self.scans = self.longest = self.inputs = self.used = 0
        self.bound = self.made = 0
        self.ids: set[str] = set()

    def add(self, number: int, device: DeviceGraph) -> None:
        """Walk through one graph."""
        columns = merge_columns(device)
        kind = SUITES[self.suite]
        self.states += len(columns.next_of)
        self.columns += len(columns.members)
        self.inputs += len(device.alphabet)
        if kind.rule is not None:
            self._ruled(device, kind.rule(device, columns))
            return
        if kind.plan is not None:
            self._scripted(number, device, columns, kind.plan)
            return
        if kind.walks is not None:
            cases, about = self._ready(device, columns, kind.walks)
        else:
            cases, about = self._covering(device, columns, kind), {}
        by_column = kind.counted_by == "column"
        seen: set[tuple[int, int, int]] = set()
        for state, column in {(move.state, move.column) for case in cases for move in case}:
            after = column if by_column else columns.next_of[state][column]
            seen.add((state, columns.step_of[state][column], after))
        self.transitions.update(device.graph.steps[step] for _, step, _ in seen)
        self.graphs.append({**self._graph(device, columns), **about})
        letters = _Letters(device, columns)
        rows: dict[tuple[Any, ...], Pieces] = {}
        for case in cases:
            self._case(number, device, columns, letters, case, rows)
        self.used += len(letters.used)

    def _ruled(self, device: DeviceGraph, rule: dict[str, Any]) -> None:
        """Count what a rule makes, with the steps as the header numbers them."""
        numbers = [self.steps[name] for name in device.graph.steps]
        rule["step"] = [[numbers[step] for step in row] for row in rule["step"]]
        nexts, initial = rule["next"], device.graph.initial
        seen: set[tuple[int, int]] = set()
        for word in words_of(rule):
            if word:
                self.made += 1
                self.scans += len(word)
                self.longest = max(self.longest, len(word))
                state = initial
                for letter in word:
                    seen.add((state, letter))
                    state = nexts[state][letter]
        taken = {(state, rule["step"][state][letter], nexts[state][letter]) for state, letter in seen}
        names = list(self.device.device.steps)
        self.transitions.update(names[step] for _, step, _ in taken)
        self.used += len(rule["letters"])
        self.graphs.append({**self._about(device), "rule": rule})

    def _covering(self, device: DeviceGraph, columns: Columns, kind: Kind) -> list[list[Move]]:
        """Walks that take what is wanted."""
        assert kind.wanted is not None
        initial, wanted = device.graph.initial, kind.wanted(columns)
        if self.suite == "tour":
            self.bound += lower_bound(columns, initial)
        cases = walks(columns, initial, wanted)
        if not covers(columns, initial, wanted, cases):
            raise Unjudged(f"{device.name}: the suite {self.suite} does not cover what it must")
        return cases

    def _ready(
        self,
        device: DeviceGraph,
        columns: Columns,
        make: Callable[[Columns, int, Sequence[Hashable]], list[list[Move]]],
    ) -> tuple[list[list[Move]], dict[str, Any]]:
        """Walks, and for whom they leave no freedom; `number_of` numbers the states as outputs tell them."""
        rows = device.seen
        seen = machine(columns, rows, device.graph.initial)
        complete = {
            "states": len(seen.next_of),
            "extra_states": 0,
            "columns": len(columns.members),
            "number_of": list(seen.number_of),
        }
        return make(columns, device.graph.initial, rows), {"complete": complete}

    def _scripted(self, number: int, device: DeviceGraph, columns: Columns, plan: Plan) -> None:
        column_of = {letter: c for c, members in enumerate(columns.members) for letter in members}
        graph = device.graph
        seen: set[tuple[int, int, int]] = set()
        used: set[int] = set()
        scripts = plan(device, columns)
        rows = _Rows(device)
        for script in scripts.cases:
            self._script(number, rows, script, column_of, seen, used)
        self.transitions.update(graph.steps[step] for _, step, _ in seen)
        self.used += len(used)
        self.graphs.append({**self._about(device), **scripts.notes})

    def _script(
        self,
        number: int,
        known: _Rows,
        script: Script,
        column_of: Mapping[int, int],
        seen: set[tuple[int, int, int]],
        used: set[int],
    ) -> None:
        device, graph = known.device, known.device.graph
        rows: list[str] = []
        going_in: list[str] = []
        cited: set[str] = set()
        inputs: Pieces = ()
        outputs: Pieces = ()
        state = graph.initial
        for n, shot in enumerate(script.shots):
            if shot.refuse is not None:
                request = _SORTED(shot.refuse)
                rows.append(f'{{"refuse":{request}}}')
                going_in.append(f'["refuse",{request}]')
                continue
            before, state = state, graph.next_of[state][shot.letter]
            step = graph.step_of[before][shot.letter]
            seen.add((before, step, state))
            used.add(shot.letter)
            if not script.about or n in script.about:
                cited.add(graph.steps[step])
            now_in, now_out = known.pieces(shot, state, script.renamed)
            dt_ms = shot.values.get("dt_ms", device.alphabet[shot.letter]["dt_ms"])
            change = _changed(inputs, now_in)
            going_in.append(f"[{dt_ms},{{{change}}}]")
            settling = ',"settling":true' if shot.settling else ""
            rows.append(
                f'{{"dt_ms":{dt_ms},"in":{{{change}}},"out":{{{_changed(outputs, now_out)}}},'
                f'"step":{self.steps[graph.steps[step]]},"to":{state},"column":{column_of[shot.letter]}'
                f"{settling}}}"
            )
            inputs, outputs = now_in, now_out
        clauses, findings = self._cited(cited)
        params = dict(device.params) if script.reset else {}
        id = id_of_text(device.device.id, params, ",".join(going_in))
        if id in self.ids or (not script.reset and self.cases):
            return  # before any reset is only the first case of all
        self.ids.add(id)
        case = {
            "id": id,
            "clauses": clauses,
            "basis": f"finding:{','.join(findings)}" if findings else "document",
            "why": script.why,
            "timing": "exact",
            "params": params,
            "graph": number,
        }
        if script.judges:
            case["judges"] = script.judges
        if script.clauses:
            case.update(clauses=sorted(set(script.clauses)), basis=script.basis)
        if script.judges == ADAPTER:
            case.update(clauses=[], basis="protocol")
        if not script.reset:
            case["reset"] = False
        self.cases.append(f'{_ENCODE(case)[:-1]},"scans":[{",".join(rows)}]}}\n')
        self.scans += sum(shot.refuse is None for shot in script.shots)
        self.longest = max(self.longest, len(rows))

    def _cited(self, steps: Iterable[str]) -> tuple[list[str], list[str]]:
        """The clauses and the findings of these steps."""
        clauses: set[str] = set()
        findings: set[str] = set()
        for step in steps:
            of_step = self.citations(step)
            clauses.update(of_step[0])
            findings.update(of_step[1])
        return sorted(clauses), sorted(findings)

    def _about(self, device: DeviceGraph) -> dict[str, Any]:
        graph = device.graph
        return {
            "run": device.run,
            "params": dict(device.params),
            "initial": graph.initial,
            "views": list(graph.views),
        }

    def _graph(self, device: DeviceGraph, columns: Columns) -> dict[str, Any]:
        graph = device.graph
        column_of = {letter: c for c, members in enumerate(columns.members) for letter in members}
        ways: list[Any] = []
        for state, move in enumerate(graph.shortest_paths()):
            if move is None:
                ways.append(None)
                continue
            before, letter = move
            values = device.alphabet[letter]
            ways.append(
                [
                    before,
                    values["dt_ms"],
                    device.wire_inputs(values),
                    device.wire_outputs(device.expected(state, values)),
                    self.steps[graph.steps[graph.step_of[before][letter]]],
                    column_of[letter],
                ]
            )
        return {**self._about(device), "ways": ways}

    def _case(
        self,
        number: int,
        device: DeviceGraph,
        columns: Columns,
        letters: _Letters,
        walk: Sequence[Move],
        known: dict[tuple[Any, ...], Pieces],
    ) -> None:
        rows: list[str] = []
        going_in: list[str] = []
        cited: set[int] = set()
        inputs: Pieces = ()
        outputs: Pieces = ()
        numbers = [self.steps[name] for name in device.graph.steps]
        passed = tuple(device.passed.values())
        for move in walk:
            column = move.column
            values, now_in = letters.next(column)
            to = columns.next_of[move.state][column]
            step = numbers[columns.step_of[move.state][column]]
            cited.add(step)
            key = (to, *[values[one] for one in passed])
            if key not in known:
                known[key] = _pieces(device.wire_outputs(device.expected(to, values)))
            now_out = known[key]
            dt_ms, change = values["dt_ms"], _changed(inputs, now_in)
            going_in.append(f"[{dt_ms},{{{change}}}]")
            rows.append(
                f'{{"dt_ms":{dt_ms},"in":{{{change}}},"out":{{{_changed(outputs, now_out)}}},'
                f'"step":{step},"to":{to},"column":{column}}}'
            )
            inputs, outputs = now_in, now_out
        names = self.device.device.steps
        clauses, findings = self._cited(names[step] for step in cited)
        case = {
            "id": id_of_text(device.device.id, device.params, ",".join(going_in)),
            "clauses": clauses,
            "basis": f"finding:{','.join(findings)}" if findings else "document",
            "why": f"a walk through {device.run} that {SUITES[self.suite].why}",
            "timing": "exact",
            "params": dict(device.params),
            "graph": number,
        }
        self.cases.append(f'{_ENCODE(case)[:-1]},"scans":[{",".join(rows)}]}}\n')
        self.scans += len(rows)
        self.longest = max(self.longest, len(rows))

    def header(
        self, sources: Mapping[str, str], generator: str, contract: Mapping[str, Any] | None
    ) -> dict[str, Any]:
        device = self.device.device
        modes = list(self.device.forms.modes)
        kind = SUITES[self.suite]
        relations = [one for one in kind.relations if one != MONITOR or contract]
        return {
            "kind": KIND,
            "version": VERSION,
            "target": device.id,
            "document": self.device.document,
            "protocol": 1,
            "suite": self.suite,
            "relations": relations,
            "pace": "fast" if kind.fast else "slow",
            "counted_by": kind.counted_by,
            "shrink": "graph" if kind.plan is None and kind.rule is None else "prefix",
            "guarantees": kind.guarantees,
            "hypothesis": kind.hypothesis,
            "does_not_show": kind.does_not_show + _codes(self.device.codes),
            "generator": generator,
            "sources": dict(sorted(sources.items())),
            "cases": len(self.cases) + self.made,
            "scans": self.scans,
            **({"lower_bound": self.bound} if self.bound else {}),
            "states": self.states,
            "columns": self.columns,
            "transitions": sum(self.transitions.values()),
            "inputs": declare(device.inputs, modes),
            "outputs": declare(device.outputs, modes),
            "parameters": declare_parameters(device, modes),
            "steps": self._steps(device),
            **({"contract": contract} if contract else {}),
            "graphs": self.graphs,
        }

    def _steps(self, device: Device) -> list[dict[str, Any]]:
        rows = []
        for name in device.steps:
            clauses, findings = self.citations(name)
            rows.append(
                {
                    "name": name,
                    "clauses": list(clauses),
                    "findings": list(findings),
                    "transitions": self.transitions[name],
                }
            )
        return rows

    def stats(self) -> Stats:
        return Stats(
            states=self.states,
            columns=self.columns,
            transitions=sum(self.transitions.values()),
            inputs_used=self.used,
            inputs=self.inputs,
            cases=len(self.cases) + self.made,
            scans=self.scans,
            longest=self.longest,
        )


class _Rows:
    """Inputs and outputs of scripted scans as they are written; what repeats is written once."""

    def __init__(self, device: DeviceGraph) -> None:
        self.device = device
        self._in: dict[int, Pieces] = {}
        self._out: dict[tuple[Any, ...], Pieces] = {}

    def pieces(self, shot: Shot, state: int, renamed: Mapping[int, int]) -> tuple[Pieces, Pieces]:
        """The inputs of a shot, and the outputs after it in `state`."""
        device = self.device
        values = {**device.alphabet[shot.letter], **shot.values}
        if renamed:
            expected = _renamed(device.device.outputs, device.expected(state, values), renamed)
            values = _renamed(device.device.inputs, values, renamed)
            return _pieces(device.wire_inputs(values)), _pieces(device.wire_outputs(expected))
        if shot.values:
            now_in = _pieces(device.wire_inputs(values))
        else:
            if shot.letter not in self._in:
                self._in[shot.letter] = _pieces(device.wire_inputs(values))
            now_in = self._in[shot.letter]
        key = (state, *[values[one] for one in device.passed.values()])
        if key not in self._out:
            self._out[key] = _pieces(device.wire_outputs(device.expected(state, values)))
        return now_in, self._out[key]


class _Letters:
    """Gives the inputs of a column in turn, and for an input that stands for a class its members in turn."""

    def __init__(self, device: DeviceGraph, columns: Columns) -> None:
        self._device, self._columns = device, columns
        self._members = Members(device.classes, device.alphabet)
        self._turn = [0] * len(columns.members)
        self.used: set[int] = set()
        self._wire: dict[int, Pieces] = {}

    def next(self, column: int) -> tuple[Mapping[str, Any], Pieces]:
        """The values of the next member, in Python form and as they are written."""
        device = self._device
        members = self._columns.members[column]
        letter = members[self._turn[column] % len(members)]
        self._turn[column] += 1
        values = device.alphabet[letter]
        if letter in self.used and self._members.any_of(letter):
            values = self._members.another(letter)
            return values, _pieces(device.wire_inputs(values))
        if letter not in self._wire:
            self._wire[letter] = _pieces(device.wire_inputs(values))
        self.used.add(letter)
        return values, self._wire[letter]


def _codes(names: Sequence[str]) -> str:
    """What is not shown of outputs whose values the document does not give."""
    return (
        f"; unless they are compared: {', '.join(names)}, for states are told apart without" if names else ""
    )


def _pieces(values: Mapping[str, Any]) -> Pieces:
    return tuple(f"{_ENCODE(name)}:{_ENCODE(values[name])}" for name in sorted(values))


def _renamed(
    signals: Mapping[str, Signal], values: Mapping[str, Any], names: Mapping[int, int]
) -> dict[str, Any]:
    """The values with other words for the words in `names`, in signals of type word only."""
    return {
        name: names.get(value, value) if name in signals and signals[name].type == "word" else value
        for name, value in values.items()
    }


def _changed(before: Pieces, now: Pieces) -> str:
    if not before:
        return ",".join(now)
    return ",".join([new for old, new in zip(before, now, strict=True) if old != new])


def _cited_texts(header: Mapping[str, Any], texts: Mapping[str, str]) -> dict[str, str]:
    """What is said of everything that the steps and the contract cite."""
    cited = {id for step in header["steps"] for id in (*step["clauses"], *step["findings"])}
    for one in header.get("contract", {}).get("properties", []):
        cited.update(one["clauses"])
    return {id: texts[id] for id in sorted(cited) if id in texts}


def _line(row: Mapping[str, Any]) -> str:
    return _ENCODE(row) + "\n"


def _write_lines(path: Path, lines: Sequence[str]) -> None:
    content = "".join(lines).encode()
    if path.suffix == PACKED:
        held = io.BytesIO()
        # No name, date or system (gzip.compress names the system): the same lines, the same bytes anywhere.
        with gzip.GzipFile("", "wb", PACKING, held, mtime=0) as packed:
            packed.write(content)
        content = held.getvalue()
    write_whole(path, content)
