"""A program and the reference side by side with plain values: published vectors, and traces of a solver."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.vectors import open_suite
from programs.equality.binding import Binding
from programs.equality.product import Pair, Product
from programs.equality.shortest_path import Way
from programs.invariants.relations import Values
from programs.semantics.interpreter import Machine
from programs.semantics.interpreter_expressions import Limit, Overflow
from programs.semantics.value_paths import memory_of, put

SUITES = ("sequences", "times", "brief")
MOST_SCANS = 6_000
MOST_SAMPLES = 24
"""Values of one pair that relations are tried on; a solver judges those that are left."""
Scans = Sequence[tuple[int, Mapping[str, Any]]]
"""Elapsed milliseconds and inputs of each scan."""


@dataclass(frozen=True)
class Run:
    """What both are run on. retained: the first values of RETAIN variables by their paths; else their own."""

    parameters: Mapping[str, Any]
    scans: Scans
    retained: Mapping[str, Any] = field(default_factory=dict)

    def upto(self, number: int) -> Run:
        """The first scans of it."""
        return Run(self.parameters, self.scans[:number], self.retained)


@dataclass(frozen=True)
class Difference:
    """Scans from power-up after which the outputs differ, or in which the program stops (`stopped`)."""

    run: Run
    expected: tuple[Mapping[str, Any], ...]
    given: tuple[Mapping[str, Any], ...]
    """Of the program; one fewer than `expected` where it stops."""
    found_by: str
    stopped: str = ""

    @property
    def parameters(self) -> Mapping[str, Any]:
        """The parameters of the run."""
        return self.run.parameters

    @property
    def scans(self) -> Scans:
        """The scans of the run."""
        return self.run.scans

    @property
    def differing(self) -> list[str]:
        """The outputs that differ after the last scan."""
        if self.stopped:
            return []
        return [name for name, value in self.given[-1].items() if value != self.expected[-1][name]]


@dataclass(frozen=True)
class Met:
    """The memories of both after a scan without a difference."""

    control: str
    values: Values
    """Every value, control variables of the program too."""
    run: Run
    number: int
    """Scans of the run up to here."""

    def pair(self, product: Product) -> Pair:
        """The pair of control states."""
        return self.control, tuple(int(self.values[f"p:{path}"]) for path in product.control)


@dataclass
class Replayed:
    """What was replayed without a difference, and the values that were met."""

    cases: int = 0
    scans: int = 0
    met: list[Met] = field(default_factory=list)

    def samples(self, product: Product) -> Mapping[Pair, Sequence[Values]]:
        """Some of the values that were met in each pair."""
        found: dict[Pair, list[Values]] = defaultdict(list)
        for met in self.met:
            kept = found[met.pair(product)]
            if len(kept) < MOST_SAMPLES:
                values = {name: met.values[name] for name in product.symbols}
                if values not in kept:
                    kept.append(values)
        return found

    def ways(self, product: Product) -> Mapping[Pair, Run]:
        """The fewest scans that led to each pair."""
        found: dict[Pair, Met] = {}
        for met in self.met:
            pair = met.pair(product)
            if pair not in found or met.number < found[pair].number:
                found[pair] = met
        return {pair: met.run.upto(met.number) for pair, met in found.items()}

    def routes(self, product: Product) -> Mapping[Pair, tuple[Pair, ...]]:
        """The pairs on the way of the fewest scans to each pair, without those that a scan stays in."""
        found: dict[Pair, tuple[Pair, ...]] = {}
        route: tuple[Pair, ...] = ()
        for met in self.met:
            if met.number == 1:
                route = (product.start[0],)
            pair = met.pair(product)
            route = route if pair == route[-1] else (*route, pair)
            if pair not in found or len(route) < len(found[pair]):
                found[pair] = route
        return found


def replay(binding: Binding, wrap: bool, run: Run, found_by: str) -> Difference | None:
    """Run both from power-up to the first difference; None: there is none."""
    return next((step for step in steps(binding, wrap, run, found_by) if isinstance(step, Difference)), None)


def steps(binding: Binding, wrap: bool, run: Run, found_by: str = "") -> Iterator[Difference | Met]:
    """Run both from power-up: what was met after each scan, up to the first difference."""
    reference, machine = binding.reference, Machine(binding.source, binding.unit, wrap)
    for path, value in run.retained.items():
        put(machine.memory, path, value)
    state = reference.start(run.parameters)
    expected: list[Mapping[str, Any]] = []
    given: list[Mapping[str, Any]] = []
    constants = _parameters(binding, run.parameters)
    for number, (dt_ms, inputs) in enumerate(run.scans, 1):
        state, row = reference.scan(state, dt_ms, inputs)
        expected.append({name: row[name] for name in binding.compared})
        stopped = ""
        try:
            own = machine.scan(binding.plain_inputs(inputs, run.parameters, dt_ms), dt_ms)
            given.append(binding.plain_outputs(own))
        except Limit:
            raise
        except Overflow as error:
            stopped = error.message
        if stopped or given[-1] != expected[-1]:
            yield Difference(run.upto(number), tuple(expected), tuple(given), found_by, stopped)
            return
        control, memory = reference.plain_memory(state)
        values = {
            **{f"r:{place}": value for place, value in memory.items()},
            **{f"p:{path}": value for path, value in memory_of(machine).items()},
            **constants,
        }
        yield Met(control, values, run, number)


def _parameters(binding: Binding, parameters: Mapping[str, Any]) -> Values:
    found: Values = {}
    for name, signal in binding.reference.signals("parameters").items():
        value = parameters[name]
        if signal.type == "modes":
            found |= {f"g:{name}[{mode}]": value[mode] for mode in range(5)}
            found[f"g:{name}"] = sum(1 << mode for mode in range(5) if value[mode])
        else:
            found[f"g:{name}"] = signal.values.index(value) if signal.type == "text" else value
    return found


def run_of(product: Product, way: Way) -> Run:
    """What a solver found, as values of the code."""
    reference = product.binding.reference
    return Run(
        reference.plain("parameters", way.parameters),
        [(int(scan["dt_ms"]), reference.plain("inputs", scan)) for scan in way.scans],
        dict(way.retained),
    )


def published(binding: Binding, wrap: bool, folder: Path) -> Difference | Replayed:
    """Replay the published vectors whose parameters the binding allows.

    The first difference, else what was replayed. Raises Unjudged for a vector file that cannot be read.
    """
    replayed = Replayed()
    for where, run in published_runs(binding, folder):
        replayed.cases, replayed.scans = replayed.cases + 1, replayed.scans + len(run.scans)
        for step in steps(binding, wrap, run, f"published vector {where}"):
            if isinstance(step, Difference):
                return step
            replayed.met.append(step)
    return replayed


def published_runs(binding: Binding, folder: Path, every: bool = False) -> Iterator[tuple[str, Run]]:
    """Published vectors whose parameters the binding allows, at most `MOST_SCANS` scans of them, by their
    names; every: also others, with the parameters that the binding fixes. Raises Unjudged for a vector file
    that cannot be read.
    """
    fixed = binding.fixed_parameters() if every else {}
    reference, count = binding.reference, 0
    for name in SUITES:
        path = folder / f"{name}.jsonl.gz"
        if not path.is_file():
            continue
        try:
            for case in open_suite(path).cases():
                given = reference.from_wire("parameters", case.params)
                parameters = {**reference.with_defaults(given), **fixed}
                if case.requests or not case.reset or not binding.allows(parameters):
                    continue
                longest = max(scan.dt_ms for scan in case.scans)
                if count + len(case.scans) > MOST_SCANS or longest > (binding.longest_scan or longest):
                    continue
                count += len(case.scans)
                taken = [(scan.dt_ms, reference.from_wire("inputs", scan.inputs)) for scan in case.scans]
                yield f"{case.id} of {name}", Run(parameters, taken)
        except KitUnjudged as error:
            raise Unjudged(str(error)) from None
