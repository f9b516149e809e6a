"""A program and the reference side by side with plain values: published vectors, and traces of a solver."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.kit.errors import Unjudged as KitUnjudged
from modeproof.kit.vectors import open_suite
from programs.bind import Binding
from programs.product import Pair, Product
from programs.relations import Values
from programs.run import Frame, Machine, Overflow, Standard

SUITES = ("sequences", "times", "brief")
MOST_SCANS = 6_000
MOST_SAMPLES = 24
"""Values of one pair that relations are tried on; a solver judges those that are left."""
Scans = Sequence[tuple[int, Mapping[str, Any]]]
"""Elapsed milliseconds and inputs of each scan."""


@dataclass(frozen=True)
class Difference:
    """Scans from power-up after which the outputs differ, or in which the program stops (`stopped`)."""

    parameters: Mapping[str, Any]
    scans: Scans
    expected: tuple[Mapping[str, Any], ...]
    given: tuple[Mapping[str, Any], ...]
    """Of the program; one fewer than `expected` where it stops."""
    found_by: str
    stopped: str = ""

    @property
    def differing(self) -> list[str]:
        """The outputs that differ after the last scan."""
        if self.stopped:
            return []
        return [name for name, value in self.given[-1].items() if value != self.expected[-1][name]]


@dataclass
class Replayed:
    """What was replayed without a difference, and the values that were met."""

    cases: int
    scans: int
    samples: Mapping[Pair, Sequence[Values]]


def replay(
    binding: Binding, wrap: bool, parameters: Mapping[str, Any], scans: Scans, found_by: str
) -> Difference | None:
    """Run both from power-up to the first difference; None: there is none."""
    return next((found for found in _steps(binding, wrap, parameters, scans, found_by) if found), None)


def _steps(
    binding: Binding,
    wrap: bool,
    parameters: Mapping[str, Any],
    scans: Scans,
    found_by: str,
    product: Product | None = None,
    samples: dict[Pair, list[Values]] | None = None,
) -> Iterator[Difference | None]:
    reference, machine = binding.reference, Machine(binding.source, binding.unit, wrap)
    state = reference.start(parameters)
    expected: list[Mapping[str, Any]] = []
    given: list[Mapping[str, Any]] = []
    constants = _parameters(binding, parameters)
    for number, (dt_ms, inputs) in enumerate(scans, 1):
        state, row = reference.scan(state, dt_ms, inputs)
        expected.append({name: row[name] for name in binding.compared})
        stopped = ""
        try:
            given.append(
                binding.plain_outputs(machine.scan(binding.plain_inputs(inputs, parameters, dt_ms), dt_ms))
            )
        except Overflow as error:
            stopped = error.message
        if stopped or given[-1] != expected[-1]:
            yield Difference(parameters, scans[:number], tuple(expected), tuple(given), found_by, stopped)
            return
        if product is not None and samples is not None:
            _keep(product, samples, reference.plain_memory(state), memory_of(machine), constants)
        yield None


def _parameters(binding: Binding, parameters: Mapping[str, Any]) -> Values:
    found: Values = {}
    for name, signal in binding.reference.signals("parameters").items():
        value = parameters[name]
        if signal.type == "modes":
            found |= {f"g:{name}[{mode}]": value[mode] for mode in range(5)}
        else:
            found[f"g:{name}"] = signal.values.index(value) if signal.type == "text" else value
    return found


def _keep(
    product: Product,
    samples: dict[Pair, list[Values]],
    of_reference: tuple[str, Mapping[str, Any]],
    own: Mapping[str, Any],
    constants: Values,
) -> None:
    pair = of_reference[0], tuple(int(own[path]) for path in product.control)
    kept = samples[pair]
    if len(kept) < MOST_SAMPLES:
        values = {
            **{f"r:{place}": value for place, value in of_reference[1].items()},
            **{f"p:{path}": value for path, value in own.items()},
            **constants,
        }
        values = {name: values[name] for name in product.symbols}
        if values not in kept:
            kept.append(values)


def memory_of(machine: Machine) -> dict[str, Any]:
    """Every value in a program's memory by the paths of `terms.slots`."""
    return dict(_values(machine.memory, "", machine.now))


def _values(frame: Frame, above: str, now: int) -> Iterator[tuple[str, Any]]:
    if frame.unit.device is not None:
        yield f"{above}age", now - frame.since
    for key, value in frame.values.items():
        path = f"{above}{key}"
        if isinstance(value, Frame):
            yield from _values(value, f"{path}.", now)
        elif isinstance(value, Standard):
            yield from ((f"{path}.{pin}", found) for pin, found in value.values.items())
            yield f"{path}.before", value.before
            yield f"{path}.running", value.running
            yield f"{path}.age", now - value.since
        elif isinstance(value, list):
            low = getattr(frame.unit.variables[key].type, "low", 0)
            yield from ((f"{path}[{low + number}]", found) for number, found in enumerate(value))
        else:
            yield path, value


def published(product: Product, folder: Path) -> Difference | Replayed:
    """Replay the published vectors whose parameters the binding allows.

    The shortest difference of the first suite that has one, else what was replayed. Raises Unjudged for a
    vector file that cannot be read.
    """
    binding, reference = product.binding, product.binding.reference
    samples: dict[Pair, list[Values]] = defaultdict(list)
    cases = scans = 0
    for name in SUITES:
        path = folder / f"{name}.jsonl.gz"
        if not path.is_file():
            continue
        found: list[Difference] = []
        try:
            for case in open_suite(path).cases():
                given = reference.from_wire("parameters", case.params)
                parameters = reference.with_defaults(given)
                if case.requests or not case.reset or not binding.allows(parameters):
                    continue
                longest = max(scan.dt_ms for scan in case.scans)
                if scans + len(case.scans) > MOST_SCANS or longest > (binding.longest_scan or longest):
                    continue
                taken = [(scan.dt_ms, reference.from_wire("inputs", scan.inputs)) for scan in case.scans]
                where = f"published vector {case.id} of {name}"
                cases, scans = cases + 1, scans + len(taken)
                found += filter(
                    None, _steps(binding, product.wrap, parameters, taken, where, product, samples)
                )
        except KitUnjudged as error:
            raise Unjudged(str(error)) from None
        if found:
            return min(found, key=lambda difference: len(difference.scans))
    return Replayed(cases, scans, samples)
