"""Compares a graph with an implementation in this process, both ways.

Forwards: from power-up, every transition of the graph is replayed on the implementation, and its outputs must
be those of the graph. Backwards: every state of the implementation that is found this way meets every input,
so a transition that the graph lacks would be seen. States are paired while going along; the two are EQUAL
when every transition was replayed without a difference and the pairs are one to one. The pairs are visited
breadth first, so the first difference comes with a shortest sequence of inputs that shows it.

An input may stand for a class (see `classes`). In every state, for every step and next state that such inputs
lead to, all members of the class are tried in place of the representative, and must do what it does.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

from modeproof.graph.device import DeviceGraph
from modeproof.graph.implementation import Implementation
from modeproof.ground.errors import Unjudged

STATES_EACH = 64
"""So many states of the implementation may belong to one state of the graph before the search gives up."""
DIFFERENCES_SHOWN = 20


@dataclass(frozen=True)
class Difference:
    """One transition that differs, with the shortest inputs that lead to it; values in wire form.

    `scans` are whole inputs with `dt_ms`, the last one being the scan that shows it. `expected` and `got`
    hold only what differs.
    """

    kind: str
    view: str
    step: str
    scans: tuple[Mapping[str, Any], ...]
    expected: Mapping[str, Any]
    got: Mapping[str, Any]

    def __str__(self) -> str:
        wanted = ", ".join(f"{name}={value!r}" for name, value in self.expected.items())
        found = ", ".join(f"{name}={value!r}" for name, value in self.got.items())
        return f"{self.kind} in {self.step} after {len(self.scans)} scans: expected {wanted}; got {found}"


@dataclass(frozen=True)
class Comparison:
    """What a comparison found.

    `covered` counts for each step the transitions of the graph that were replayed, and how many there are.
    `classes` counts for each input class the members, all of which were tried. `problem` says
    why the two are not EQUAL though no difference was seen. `not_compared` names outputs that were left out.
    """

    run: str
    implementation: str
    states: int
    inputs: int
    transitions: int
    replayed: int
    implementation_states: int
    scans: int
    class_scans: int
    covered: Mapping[str, tuple[int, int]]
    classes: Mapping[str, int]
    difference_count: int
    differences: tuple[Difference, ...]
    problem: str = ""
    not_compared: tuple[str, ...] = ()

    @property
    def equal(self) -> bool:
        """Whether every transition was replayed, no difference was seen and the states are one to one."""
        found = self.difference_count or self.differences or self.problem
        return not found and self.replayed == self.transitions > 0

    @property
    def verdict(self) -> str:
        """EQUAL or DIFFERS."""
        return "EQUAL" if self.equal else "DIFFERS"

    def summary(self) -> str:
        """One line."""
        line = f"{self.states:,} states, {self.transitions:,} transitions, {self.verdict}"
        if self.difference_count:
            line += f": {self.difference_count:,} differences"
        if self.not_compared:
            line += f"; not compared (--codes compares them): {', '.join(self.not_compared)}"
        return f"{line}: {self.problem}" if self.problem else line


@dataclass
class _Pairs:
    """The pairs of states found so far, in the order of finding."""

    states: list[tuple[int, Any]] = field(default_factory=list)
    reached: list[tuple[int, Mapping[str, Any]] | None] = field(default_factory=list)
    of_spec: dict[int, dict[Any, int]] = field(default_factory=dict)

    def add(self, spec: int, state: Any, reached: tuple[int, Mapping[str, Any]] | None) -> None:
        known = self.of_spec.setdefault(spec, {})
        if state not in known:
            known[state] = len(self.states)
            self.states.append((spec, state))
            self.reached.append(reached)
            if len(known) > STATES_EACH:
                raise Unjudged(
                    f"one state of the graph meets more than {STATES_EACH} states of the implementation"
                    f" (does a timer run on for ever?); the last: {state!r}"
                )

    def scans_to(self, n: int) -> list[Mapping[str, Any]]:
        back: list[Mapping[str, Any]] = []
        move = self.reached[n]
        while move is not None:
            back.append(move[1])
            move = self.reached[move[0]]
        return back[::-1]


def compare(
    device: DeviceGraph,
    code: Implementation,
    on_progress: Callable[[int, int], None] | None = None,
    *,
    codes: bool = True,
) -> Comparison:
    """Compare the graph with the code. `on_progress` gets transitions replayed and the number there are.

    Without `codes` the outputs are left out whose values the document does not give; `not_compared` of the
    result names them.

    Raises Unjudged when the code refuses the parameters or an input of the alphabet, or when its states have
    no end.
    """
    return _Walk(device, code, on_progress, () if codes else device.codes).run()


class _Walk:
    def __init__(
        self,
        device: DeviceGraph,
        code: Implementation,
        on_progress: Callable[[int, int], None] | None,
        left_out: Sequence[str],
    ) -> None:
        self.device, self.code, self.on_progress = device, code, on_progress
        self.left_out = tuple(left_out)
        kept = [of.python for name, of in device.device.outputs.items() if name not in self.left_out]
        self.shown_of = attrgetter(*kept) if self.left_out and kept else None
        self.class_letters = [
            [n for n, values in enumerate(device.alphabet) if class_.representative.items() <= values.items()]
            for class_ in device.classes
        ]
        self.letters = [self._inputs(values) for values in device.alphabet]
        self.class_inputs: list[dict[tuple[int, int], Any]] = [{} for _ in device.classes]
        self.rows = self._expected_rows()
        self.pairs = _Pairs()
        self.count = 0
        self.shown: list[Difference] = []
        self.scans = self.class_scans = 0

    def _inputs(self, values: Mapping[str, Any]) -> Any:
        names = self.device.device.inputs
        given = {names[name].python if name in names else name: value for name, value in values.items()}
        try:
            return self.code.inputs(**given)
        except Exception as error:
            raise Unjudged(
                f"{self.code.name}: refuses an input of the alphabet: {type(error).__name__}: {error}"
            ) from None

    def _outputs(self, values: Mapping[str, Any]) -> Any:
        names = self.device.device.outputs
        try:
            return self.code.outputs(**{names[name].python: value for name, value in values.items()})
        except Exception as error:
            raise Unjudged(f"{self.code.name}: Outputs: {type(error).__name__}: {error}") from None

    def _expected_rows(self) -> list[list[Any]]:
        """For each state the expected outputs by input; one list member is shared where nothing is passed."""
        device = self.device
        given = tuple(device.passed.values())
        rows = []
        for state in range(len(device.rows)):
            if not given:
                rows.append([self._outputs(device.expected(state, {}))] * len(device.alphabet))
                continue
            made: dict[tuple[Any, ...], Any] = {}
            row = []
            for values in device.alphabet:
                key = tuple(values[name] for name in given)
                if key not in made:
                    made[key] = self._outputs(device.expected(state, values))
                row.append(made[key])
            rows.append(row)
        return rows

    def run(self) -> Comparison:
        device, graph = self.device, self.device.graph
        self.pairs.add(graph.initial, self.code.start(device.device, device.forms, device.params), None)
        for n, (spec, state) in enumerate(self.pairs.states):
            self._visit(n, spec, state)
            if self.on_progress is not None:
                self.on_progress((n + 1) * len(self.letters), graph.edges)
        visited = self.pairs.of_spec
        totals = graph.edges_of_steps()
        covered = dict.fromkeys(totals, 0)
        for spec in visited:
            for step in graph.step_of[spec]:
                covered[graph.steps[step]] += 1
        return Comparison(
            run=device.name,
            implementation=self.code.name,
            states=len(graph.views),
            inputs=len(self.letters),
            transitions=graph.edges,
            replayed=len(visited) * len(self.letters),
            implementation_states=len({state for _, state in self.pairs.states}),
            scans=self.scans,
            class_scans=self.class_scans,
            covered={step: (covered[step], totals[step]) for step in totals},
            classes={class_.name: len(class_.members) for class_ in device.classes},
            difference_count=self.count,
            differences=tuple(self.shown),
            problem=self._problem(),
            not_compared=self.left_out,
        )

    def _visit(self, n: int, spec: int, state: Any) -> None:
        """All inputs at one pair of states. The hot loop of the whole comparison."""
        step, pairs, of_spec = self.code.step, self.pairs, self.pairs.of_spec
        rows = self.rows
        met: dict[int, Any] = {}  # by state of the graph, the one met last: cheaper to compare than to hash
        afters: list[Any] = [None] * len(self.letters)
        outs: list[Any] = [None] * len(self.letters)
        nexts = self.device.graph.next_of[spec]
        for letter, inputs in enumerate(self.letters):
            to = nexts[letter]
            wanted = rows[to][letter]
            try:
                after, out = step(state, inputs)
            except Exception as error:
                self._differs("error", n, spec, letter, None, {"error": None}, {"error": repr(error)})
                continue
            if out != wanted and self._unlike(out, wanted):
                self._outputs_differ("outputs", n, spec, letter, None, wanted, out)
                continue
            if to not in met or met[to] != after:
                known = of_spec.get(to)
                if known is None or after not in known:
                    if not self._same_types(out, wanted):
                        self._outputs_differ("type", n, spec, letter, None, wanted, out)
                        continue
                    pairs.add(to, after, (n, self.device.alphabet[letter]))
                met[to] = after
            afters[letter], outs[letter] = after, out
        self.scans += len(self.letters)
        for one, letters in enumerate(self.class_letters):
            self._visit_class(n, spec, state, one, letters, afters, outs)

    def _visit_class(
        self,
        n: int,
        spec: int,
        state: Any,
        one: int,
        letters: Sequence[int],
        afters: Sequence[Any],
        outs: Sequence[Any],
    ) -> None:
        """All members of one class, once for each step and next state; the letters of a group take turns."""
        device, step = self.device, self.code.step
        steps, nexts = device.graph.step_of[spec], device.graph.next_of[spec]
        groups: dict[tuple[int, int], list[int]] = {}
        for letter in letters:
            if outs[letter] is not None:
                groups.setdefault((steps[letter], nexts[letter]), []).append(letter)
        known = self.class_inputs[one]
        for group in groups.values():
            self.class_scans += len(device.classes[one].members)
            for turn, member in enumerate(device.classes[one].members):
                letter = group[turn % len(group)]
                inputs = known.get((letter, turn))
                if inputs is None:
                    inputs = known[letter, turn] = self._inputs({**device.alphabet[letter], **member})
                try:
                    after, out = step(state, inputs)
                except Exception as error:
                    values = {**device.alphabet[letter], **member}
                    self._differs("error", n, spec, letter, values, {"error": None}, {"error": repr(error)})
                    continue
                if out == outs[letter] and after == afters[letter]:
                    continue
                unlike = self._unlike(out, outs[letter])
                if not unlike and after == afters[letter]:
                    continue
                values = {**device.alphabet[letter], **member}
                if unlike:
                    self._outputs_differ("class member", n, spec, letter, values, outs[letter], out)
                else:
                    shown = {"state": repr(afters[letter])}, {"state": repr(after)}
                    self._differs("class member", n, spec, letter, values, *shown)

    def _unlike(self, out: Any, wanted: Any) -> bool:
        """Whether two answers differ in an output that is compared."""
        if self.shown_of is None:
            return bool(out != wanted)
        return bool(self.shown_of(out) != self.shown_of(wanted))

    def _same_types(self, out: Any, wanted: Any) -> bool:
        outputs = self.device.device.outputs
        names = (of.python for name, of in outputs.items() if name not in self.left_out)
        return all(type(getattr(out, name, None)) is type(getattr(wanted, name)) for name in names)

    def _outputs_differ(
        self,
        kind: str,
        n: int,
        spec: int,
        letter: int,
        values: Mapping[str, Any] | None,
        wanted: Any,
        got: Any,
    ) -> None:
        outputs, forms = self.device.device.outputs, self.device.forms
        expected, found = {}, {}
        for name, of in outputs.items():
            if name in self.left_out:
                continue
            should, is_ = getattr(wanted, of.python), getattr(got, of.python, None)
            if should != is_ or type(should) is not type(is_):
                expected[name], found[name] = forms.to_wire(of, should), forms.to_wire(of, is_)
        self._differs(kind, n, spec, letter, values, expected, found)

    def _differs(
        self,
        kind: str,
        n: int,
        spec: int,
        letter: int,
        values: Mapping[str, Any] | None,
        expected: Mapping[str, Any],
        got: Mapping[str, Any],
    ) -> None:
        self.count += 1
        if len(self.shown) >= DIFFERENCES_SHOWN:
            return
        device, graph = self.device, self.device.graph
        scans = [*self.pairs.scans_to(n), self.device.alphabet[letter] if values is None else values]
        self.shown.append(
            Difference(
                kind=kind,
                view=graph.views[spec],
                step=graph.steps[graph.step_of[spec][letter]],
                scans=tuple({"dt_ms": scan["dt_ms"], **device.wire_inputs(scan)} for scan in scans),
                expected=expected,
                got=got,
            )
        )

    def _problem(self) -> str:
        graph, of_spec = self.device.graph, self.pairs.of_spec
        if self.count:
            return ""
        if len(of_spec) < len(graph.views):
            return f"{len(graph.views) - len(of_spec)} states of the graph were never reached"
        several = [spec for spec, known in of_spec.items() if len(known) > 1]
        if several:
            example = " and ".join(repr(state) for state in list(of_spec[several[0]])[:2])
            return (
                f"{len(several)} states of the graph meet several states of the implementation, the first "
                f"{graph.views[several[0]]}: {example}"
            )
        owner: dict[Any, int] = {}
        for spec, state in self.pairs.states:
            if owner.setdefault(state, spec) != spec:
                views = f"{graph.views[owner[state]]} and {graph.views[spec]}"
                return f"two states of the graph are one state of the implementation: {views}"
        return ""
