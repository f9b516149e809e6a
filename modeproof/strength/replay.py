"""Test vectors run on a program in this process: every output of every scan, at the speed of the program.

The values of a vector file are turned into records of the program once, so that what is timed and judged
afterwards is the program alone. Outputs are compared as records; true and 1 count as equal, which can only
let a wrong program pass. A request that an adapter must refuse is left out: there is no adapter here. A
refusal (an error that names its `field`) leaves the memory of the program as it was, as behind an adapter;
any other error in `power_up` or `step` is a difference.
"""

from __future__ import annotations

import marshal
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from modeproof.graph.implementation import Implementation
from modeproof.graph.values import ValueForms
from modeproof.ground.errors import Unjudged
from modeproof.kit.vectors import Case, Suite
from modeproof.registers.rows import Device

PASSES, DIFFERS, RAISES, REFUSES = "passes", "differs", "raises", "refuses"


@dataclass(frozen=True)
class ReplayCase:
    """One case: what power-up is given, and for each scan the inputs and the outputs that must follow.

    No outputs: the scan is not compared.
    """

    id: str
    params: Any
    scans: Sequence[tuple[Any, Any]]


@dataclass(frozen=True)
class Vectors:
    """A suite of one target in records of a program; `left_out` counts requests that need an adapter."""

    target: str
    suite: str
    cases: Sequence[ReplayCase]
    left_out: int

    @property
    def scans(self) -> int:
        """All scans."""
        return sum(len(case.scans) for case in self.cases)

    @property
    def last_compared(self) -> int:
        """The number, from 1 and over all cases, of the last scan that is compared. Raises Unjudged."""
        number, last = 0, 0
        for case in self.cases:
            for n, (_, wanted) in enumerate(case.scans, number + 1):
                last = last if wanted is None else n
            number += len(case.scans)
        if not last:
            raise Unjudged(f"{self.target} {self.suite}: no scan of the suite is compared")
        return last


@dataclass(frozen=True)
class Answer:
    """What a suite says of a program.

    result: passes, differs, raises, or refuses (it refused well-formed inputs `refused` times and differed
    nowhere). case and scan (from 1) are where it was caught, `scans` is the number of scans run until then,
    that one included.
    """

    result: str
    scans: int
    case: str = ""
    scan: int = 0
    detail: str = ""
    refused: int = 0
    seconds: float = 0.0

    @property
    def caught(self) -> bool:
        """Whether the program is told from the right one."""
        return self.result in (DIFFERS, RAISES)


def vectors_of(suite: Suite, device: Device, forms: ValueForms, code: Implementation) -> Vectors:
    """Read all cases. Raises Unjudged when the program takes no such parameters or inputs."""
    place = f"{suite.target} {suite.name}"
    inputs: dict[bytes, Any] = {}
    outputs: dict[bytes, Any] = {}
    pairs: dict[tuple[int, int], tuple[Any, Any]] = {}
    left_out = 0

    def record(build: Any, signals: Any, wire: Any, **more: Any) -> Any:
        named = {signals[name].python: forms.from_wire(signals[name], wire[name], place) for name in wire}
        try:
            return build(**named, **more)
        except Exception as error:
            raise Unjudged(f"{place}: {code.name} refuses {dict(wire)}: {error}") from None

    def converted(case: Case) -> ReplayCase:
        scans = []
        for scan in case.scans:
            if scan.request is not None:
                continue
            given = marshal.dumps((scan.dt_ms, dict(scan.inputs)))
            if given not in inputs:
                inputs[given] = record(code.inputs, device.inputs, scan.inputs, dt_ms=scan.dt_ms)
            wanted = None
            if scan.compared:
                key = marshal.dumps(dict(scan.outputs))
                if key not in outputs:
                    outputs[key] = record(code.outputs, device.outputs, scan.outputs)
                wanted = outputs[key]
            pair = (inputs[given], wanted)
            scans.append(pairs.setdefault((id(pair[0]), id(wanted)), pair))
        return ReplayCase(case.id, record(code.params, device.parameters, case.params), scans)

    cases = []
    for case in suite.cases():
        left_out += sum(scan.request is not None for scan in case.scans)
        if any(scan.request is None for scan in case.scans):
            cases.append(converted(case))
    return Vectors(suite.target, suite.name, cases, left_out)


def replay(vectors: Vectors, code: Implementation) -> Answer:
    """Run all cases on a program, up to the first scan that tells it from the right one.

    It may not end when the program does not: give it a process and a time limit.
    """
    began = time.perf_counter()
    found = _replay(vectors, code)
    return replace(found, seconds=round(time.perf_counter() - began, 3))


def _replay(vectors: Vectors, code: Implementation) -> Answer:
    step, done, refused, first = code.step, 0, 0, ""
    for case in vectors.cases:
        n = 0
        try:
            state = code.power_up(case.params)
        except Exception as error:
            return Answer(RAISES, done, case.id, 0, f"power-up: {_message(error)}", refused)
        scans = iter(enumerate(case.scans, 1))
        while True:
            try:
                for n, (inputs, wanted) in scans:
                    state, outputs = step(state, inputs)
                    if outputs != wanted and wanted is not None:
                        what = f"expected {wanted!r}, got {outputs!r}"
                        return Answer(DIFFERS, done + n, case.id, n, what, refused)
                break
            except Exception as error:
                if not is_refusal(error):
                    return Answer(RAISES, done + n, case.id, n, _message(error), refused)
                refused += 1
                first = first or f"{case.id}, scan {n}: {_message(error)}"
        done += len(case.scans)
    return Answer(REFUSES, done, "", 0, first, refused) if refused else Answer(PASSES, done)


def is_refusal(error: Exception) -> bool:
    """Whether a program refuses what it was given: the error names the field."""
    return isinstance(error, ValueError) and isinstance(getattr(error, "field", None), str)


def _message(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"[:200]


def planted(vectors: Vectors, code: Implementation) -> Implementation:
    """The same program with one fault: in the last scan that is compared, it gives other outputs."""
    last, run = vectors.last_compared, [0]
    rows = {wanted for case in vectors.cases for _, wanted in case.scans if wanted is not None}

    def step(state: Any, inputs: Any) -> tuple[Any, Any]:
        run[0] += 1
        after, outputs = code.step(state, inputs)
        return after, next((row for row in rows if row != outputs), None) if run[0] == last else outputs

    return replace(code, step=step)


def control(vectors: Vectors, code: Implementation) -> Answer:
    """Show that the vectors judge: the right program passes, and is caught when its last outputs are wrong.

    Raises Unjudged when it is not so: then no mutant can be judged by them.
    """
    name = f"{vectors.target} {vectors.suite}"
    found = replay(vectors, planted(vectors, code))
    if not found.caught:
        raise Unjudged(f"{name}: a fault that was planted in the last scan was not found")
    if found.scans != vectors.last_compared or found.refused:
        raise Unjudged(f"{name}: the shipped code itself does not pass: {found.case}, scan {found.scan}")
    return found
