"""Why the first impossible scan is impossible: what the specification does instead, and what was in the way.

A module is made that puts the device into each state that is possible before that scan, takes the scan with
the log's inputs whatever the log's outputs, and evaluates the guards of the step that the log seems to have
taken. That step is the one whose outputs are the log's, from the nearest state and with the nearest inputs.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.suites.write import Citations
from modeproof.tlc.parse_tree import ParseTree, Place, read_tree
from modeproof.tlc.tla_values import canonical, parse
from modeproof.tlc.toolchain import Toolchain
from modeproof.trace.alphabet import Alphabet
from modeproof.trace.exact import HEAP_MB, constant_definitions, run_alone, trace_run
from modeproof.trace.follow import timeless
from modeproof.trace.guards import Conjunct, Effect, Guards
from modeproof.trace.log import Log, Row, Rows
from modeproof.trace.log_module import Reading, input_record
from modeproof.trace.targets import Target

MOST_STATES = 12
MOST_INPUTS = 12
MOST_STEPS = 2
MOST_LOST = 3
_LOCAL = re.compile(r"^LOCAL\b", re.MULTILINE)


@dataclass(frozen=True)
class Taken:
    """A step that the specification takes in this scan, and the outputs after it, in Python form.

    `effects` are the conjuncts that set what the wrong outputs depend on, `outputs` their definitions.
    The reference tells no step: then there is no place.
    """

    step: str
    place: Place | None
    cites: tuple[str, ...]
    expected: Mapping[str, Any]
    wrong: tuple[str, ...]
    effects: tuple[Effect, ...]
    outputs: tuple[tuple[str, Place], ...]


@dataclass(frozen=True)
class Missed:
    """The step that the log seems to have taken, and the first conjunct of its guard that is false.

    `sides` are the values of both sides of each comparison in it. Without conjunct: the guard is true, but
    the state is not the one that leads to these outputs.
    """

    step: str
    place: Place
    cites: tuple[str, ...]
    conjunct: Conjunct
    sides: tuple[str, ...]


@dataclass(frozen=True)
class Why:
    """`before`: one of the `states` possible states before the scan, by memory variable, in TLA+.

    `lost`: after so many more scans with the same inputs the line would fit.
    """

    device: str
    states: int
    before: Mapping[str, str]
    taken: tuple[Taken, ...]
    missed: tuple[Missed, ...]
    lost: int | None = None
    wrong_input: tuple[str, Any, str] | None = None
    fits_alone: bool = field(default=False)


def explain(
    place: Path,
    target: Target,
    reading: Reading,
    row: Row,
    views: Sequence[Mapping[str, str]],
    alphabet: Alphabet | None,
    passed: Mapping[str, str],
    cites: Citations,
    tools: Toolchain,
    wrong_input: tuple[str, Any, str] | None = None,
) -> Why:
    """Explain a row that is impossible; `target` is the device alone, `views` what it may remember.

    Raises Unjudged when TLC or the parser fail; the verdict on the log does not depend on it.
    """
    device = target.parts[row.device].device
    possible = sorted({view[row.device] for view in views})
    near = {} if alphabet is None else nearest_steps(target, alphabet, possible, row)
    tree = read_tree(place / "spec" / target.document, target.module, tools, place / "spec" / "common")
    asked = _Question(place, target, reading, row, possible[:MOST_STATES], list(near), tree, passed)
    taken, missed = asked.answer(tools, cites)
    fits = any(not action.wrong for action in taken)
    return Why(
        device=device.id,
        states=len(possible),
        before=dict(zip(device.memory, map(canonical, parse(possible[0])), strict=False)) if possible else {},
        taken=taken,
        missed=() if fits else missed,
        lost=None
        if alphabet is None or fits or 0 in near.values()
        else lost_scans(target, alphabet, possible, row),
        wrong_input=wrong_input,
        fits_alone=fits,
    )


def nearest_steps(target: Target, alphabet: Alphabet, views: Sequence[str], row: Row) -> dict[str, int]:
    """The steps of the graph that lead to the outputs of `row` at the least cost, and that cost.

    The cost is the number of memory variables in which the state before differs from a possible one (times
    do not count), and the number of inputs that differ.
    """
    graph, device = alphabet.graph, row.device
    if not row.outputs or not views:
        return {}
    fitting = {
        state
        for state, outputs in enumerate(graph.rows)
        if all(outputs[name] == value for name, value in row.outputs.items() if name in outputs)
    }
    now = [timeless(target, device, parse(view)) for view in views]
    memories = [timeless(target, device, parse(view)) for view in graph.graph.views]
    far = [
        min(sum(canonical(a) != canonical(b) for a, b in zip(one, memory, strict=True)) for one in now)
        for memory in memories
    ]
    letters = alphabet.nearest(row.inputs)
    found: dict[str, int] = {}
    least = 1 << 30
    for state in sorted(range(len(far)), key=far.__getitem__):
        if far[state] > least:
            break
        for odd, letter in letters:
            if far[state] + odd > least:
                break
            if graph.graph.next_of[state][letter] in fitting:
                step = graph.graph.steps[graph.graph.step_of[state][letter]]
                if far[state] + odd < least:
                    least, found = far[state] + odd, {}
                found[step] = least
    return found


def lost_scans(target: Target, alphabet: Alphabet, views: Sequence[str], row: Row) -> int | None:
    """After how many more scans with the inputs of `row` its outputs would fit, time left open."""
    graph, device = alphabet.graph, row.device
    now = {canonical(timeless(target, device, parse(view))) for view in views}
    keys = [canonical(timeless(target, device, parse(view))) for view in graph.graph.views]
    same: dict[str, list[int]] = {}
    for number, key in enumerate(keys):
        same.setdefault(key, []).append(number)
    states = {number for key in now for number in same.get(key, ())}
    letters = alphabet.letters(row.inputs)
    for extra in range(MOST_LOST + 1):
        after = {graph.graph.next_of[state][n] for state in states for n in letters}
        if extra and any(
            all(graph.rows[state].get(name, value) == value for name, value in row.outputs.items())
            for state in after
        ):
            return extra
        states = {number for state in after for number in same[keys[state]]}
    return None


class _Question:
    """The module that is made for one scan, and what TLC answers."""

    def __init__(
        self,
        place: Path,
        target: Target,
        reading: Reading,
        row: Row,
        views: Sequence[str],
        near: Sequence[str],
        tree: ParseTree,
        passed: Mapping[str, str],
    ) -> None:
        self.target, self.row, self.views, self.tree = target, row, views, tree
        self.part = target.parts[row.device]
        self.passed = passed
        self.name = f"Why_{target.id}"
        self.place = place
        self.guards = Guards(tree, self.part.scan, self.part.device.steps)
        self.near = near
        self.paths = [(step, path) for step in near for path in self.guards.paths(step)]
        self.inputs = [
            (values, dt) for values in reading.candidates(row)[:MOST_INPUTS] for dt in reading.times(row)
        ]
        self.reading = reading

    def answer(self, tools: Toolchain, cites: Citations) -> tuple[tuple[Taken, ...], tuple[Missed, ...]]:
        """What the specification does, and what was in the way of what the log shows."""
        if not self.views or not self.inputs:
            return (), ()
        texts = {
            f"{module}.tla": _LOCAL.sub("     ", path.read_text(encoding="utf-8"))
            for module, path in self.tree.files.items()
        }
        run = trace_run(self.target, self.name, HEAP_MB)
        texts |= {f"{self.name}.tla": self._text(), run.cfg: self._cfg()}
        outcome = run_alone(self.place, run, tools, texts)
        rows = [parse(line.decode()) for line in sorted(outcome.printed)]
        taken: dict[tuple[str, tuple[str, ...]], Taken] = {}
        for _, _, of, step, outputs in (row for row in rows if row[0] == "TAKES"):
            one = self._taken(step, outputs, self.inputs[of - 1][0], cites)
            taken.setdefault((step, one.wrong), one)
        missed: dict[str, tuple[int, Missed]] = {}
        for _, _, _, number, first, sides in (row for row in rows if row[0] == "PATH"):
            step, path = self.paths[number - 1]
            if first == 0 or any(action.step == step for action in taken.values()):
                continue
            if step not in missed or missed[step][0] < first:
                conjunct = path[first - 1]
                place = self._place(step)
                values = tuple(map(canonical, sides))
                missed[step] = (first, Missed(step, place, cited(cites, step), conjunct, values))
        order = [step for step in self.near if step in missed][:MOST_STEPS]
        return tuple(taken.values()), tuple(missed[step][1] for step in order)

    def _place(self, step: str) -> Place:
        definition = self.tree.find(step)
        if definition is None:
            raise Unjudged(f"{self.name}: no definition of the step {step!r}")
        return definition.place

    def _taken(
        self, step: str, outputs: Mapping[str, Any], values: Mapping[str, Any], cites: Citations
    ) -> Taken:
        device, forms = self.part.device, self.target.forms
        expected = {
            name: forms.from_tla(device.outputs[name], value, self.name) for name, value in outputs.items()
        }
        expected |= {output: values[given] for output, given in self.passed.items()}
        wrong = tuple(
            name for name, value in self.row.outputs.items() if name in expected and expected[name] != value
        )
        defined = self.guards.row(self.part.row)
        depends = {variable for name in wrong if name in defined for variable in defined[name][2]}
        return Taken(
            step=step,
            place=self._place(step),
            cites=cited(cites, step),
            expected={name: expected[name] for name in device.outputs if name in expected},
            wrong=wrong,
            effects=tuple(effect for effect in self.guards.effects(step) if effect.sets & depends),
            outputs=tuple(dict.fromkeys(defined[name][:2] for name in wrong if name in defined)),
        )

    def _text(self) -> str:
        device, target = self.part.device, self.target
        variables = self.guards.view(self.part.view)
        records = [input_record(device, values, dt) for values, dt in self.inputs]
        state = " /\\ ".join(f"{name} = LogViews[at][{n}]" for n, name in enumerate(variables, 1))
        parts = [
            f"---- MODULE {self.name} ----",
            f"EXTENDS {target.module}, Naturals, Sequences, TLC",
            "VARIABLES at, of",
            *constant_definitions(target, [self.reading]),
            f"LogViews == <<{', '.join(self.views)}>>",
            f"LogInputs == <<{', '.join(records)}>>",
            *self.guards.made,
            *(_chain(number, path) for number, (_, path) in enumerate(self.paths, 1)),
            f"LogWhich == at \\in 1..{len(self.views)} /\\ of \\in 1..{len(records)}",
            f'LogInit == LogWhich /\\ step = "" /\\ {state}',
            f"LogScan == \\E w \\in {{LogInputs[of]}} : {self.part.scan}",
            'LogNext == step = "" /\\ LogScan /\\ UNCHANGED <<at, of>>',
            f"LogView == <<at, of, step, {self.part.view}>>",
            "LogTells(what) == PrintT(ToString(what))",
            f"LogTakes == LogTells(<<\"TAKES\", at, of, step', {self.part.row}'>>)",
            'LogSays == step # "" \\/ LET w == LogInputs[of] IN',
            '    /\\ LogTells(<<"ASKED", at, of>>)',
        ]
        parts += [
            f'    /\\ LogTells(<<"PATH", at, of, {number}>> \\o Path_{number}(w))'
            for number in range(1, len(self.paths) + 1)
        ]
        return "\n".join([*parts, "====", ""])

    def _cfg(self) -> str:
        lines = ["CONSTANTS", *(f"    {name} <- Log_{name}" for name in self.target.constants)]
        lines += ["INIT LogInit", "NEXT LogNext", "VIEW LogView", "INVARIANT LogSays"]
        return "\n".join([*lines, "ACTION_CONSTRAINT LogTakes", ""])


def _chain(number: int, path: Sequence[Conjunct]) -> str:
    """The number of the first conjunct that is false, and the values of its sides; 0 when all are true."""
    text = "<<0, <<>>>>"
    for n in range(len(path), 0, -1):
        sides = ", ".join(path[n - 1].sides)
        text = f"IF ~({path[n - 1].expression}) THEN <<{n}, <<{sides}>>>>\n    ELSE {text}"
    return f"Path_{number}(w) ==\n    {text}"


def cited(cites: Citations, step: str) -> tuple[str, ...]:
    """The clauses and findings that a step cites."""
    clauses, findings = cites(step)
    return (*clauses, *findings)


def device_log(target: Target, log: Log) -> Log:
    """The rows of a log that are of the only device of `target`."""
    name = target.only.device.id
    rows = Rows(row for row in log.rows if row.device == name)
    return Log(log.name, rows, {name: log.params[name]})
