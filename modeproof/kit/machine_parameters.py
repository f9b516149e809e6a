"""The cases of a suite with the parameters of a machine: same inputs, and what to expect worked out anew.

The reference implementation says what to expect; theorems of each document are about all parameters that it
accepts. The times of the cases were not chosen for these parameters. With relation exact a scan in which
something happens by its time comes in pieces: up to a millisecond before the limit, that millisecond, and the
rest. In the others a limit may lie between two scans. Transitions are not counted.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

from modeproof.kit.builtin import Builtin, own_reference
from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import loads, read_signals, shown
from modeproof.kit.vectors import EXACT, SETTLED, Case, Scan, Step, Suite

STEP = Step("a scan with parameters of your own", (), (), 0)


@dataclass(frozen=True)
class OwnParameters(Suite):
    """A suite in which every case has the parameters `machine` instead of its own."""

    whole: Suite | None = None
    machine: Mapping[str, Any] = field(default_factory=dict)
    relation: str = EXACT

    def cases(self) -> Iterator[Case]:
        """As of the suite, with other outputs. Raises Unjudged for parameters that are refused."""
        assert self.whole is not None
        program = own_reference(self)
        for case in self.whole.cases():
            params = {**case.params, **self.machine} if case.reset else case.params
            try:
                program.reset(params)
            except Unjudged as error:
                raise Unjudged(f"--param: {shown(params)}: {error}") from None
            yield replace(case, params=params, scans=tuple(self._scans(program, case)))

    def _scans(self, program: Builtin, case: Case) -> Iterator[Scan]:
        outputs, step = case.scans[0].outputs, len(self.steps) - 1
        for n, scan in enumerate(case.scans, 1):
            if scan.request is not None:
                yield replace(scan, outputs=outputs, step=step)
                continue
            for dt_ms in program.pieces(scan.dt_ms, scan.inputs) if self.relation == EXACT else (scan.dt_ms,):
                outputs = {**scan.outputs, **program.scan(dt_ms, scan.inputs)}
                yield replace(scan, dt_ms=dt_ms, outputs=outputs, step=step)
            if self.relation == SETTLED and scan.compared and not program.at_rest(scan.inputs):
                raise Unjudged(
                    f"{case.id}, scan {n}: with these parameters the outputs have not settled here; "
                    "relation exact can judge it"
                )

    def has_ways(self, case: Case) -> bool:
        """The ways of the file are those of other parameters."""
        return False


def with_parameters(suite: Suite, words: Sequence[str], relation: str) -> Suite:
    """The suite with parameters given as NAME=VALUE. Raises Unjudged where the target has no such one."""
    machine = {}
    signals = read_signals(suite.parameters, f"{suite.path.name}: parameters")
    for word in words:
        name, equals, text = word.partition("=")
        if name not in signals or not equals:
            known = ", ".join(signals) or "none"
            raise Unjudged(
                f"--param {word}: NAME=VALUE expected, with a parameter of {suite.target}: {known}"
            )
        try:
            value = loads(text)
        except ValueError:
            value = text
        if fault := signals[name].fault(value):
            raise Unjudged(f"--param {fault}")
        machine[name] = value
    values = {one.name: getattr(suite, one.name) for one in fields(Suite)}
    values["steps"] = (*(replace(step, transitions=0) for step in suite.steps), STEP)
    own = OwnParameters(**values, whole=suite, machine=machine, relation=relation)
    own_reference(own)
    return own
