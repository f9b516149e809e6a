"""Cases in which what the page calls constant stays as it is.

Vectors put every input that a program can be given; a page may say that some input is constant. Whether a
program follows the page is then asked of runs in which it is: it keeps the value of the first scan, and the
reference implementation says what the outputs are. The comparison with the reference is for every input.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace

from modeproof.kit.builtin import own_reference
from modeproof.kit.vectors import DEMANDS, Case, Scan, Step, Suite

STEP = Step("a scan in which what the page calls constant is held", (), (), 0)


def constant_inputs(suite: Suite) -> tuple[str, ...]:
    """The inputs that the page calls constant."""
    return tuple((suite.header.get(DEMANDS) or {}).get("constant", ()))


def changing(names: Sequence[str], scans: Sequence[Scan]) -> list[str]:
    """Those of these inputs that change in some scans."""
    rows = [scan.inputs for scan in scans if scan.request is None]
    return [name for name in names if any(row[name] != rows[0][name] for row in rows)]


def with_constants(suite: Suite) -> Suite:
    """The suite with these inputs held; itself where there are none."""
    if not (names := constant_inputs(suite)):
        return suite
    values = {one.name: getattr(suite, one.name) for one in fields(Suite)}
    return Held(**{**values, "steps": (*suite.steps, STEP)}, whole=suite, names=names)


@dataclass(frozen=True)
class Held(Suite):
    """A suite in which some inputs keep their first value in each case."""

    whole: Suite | None = None
    names: tuple[str, ...] = ()

    def cases(self) -> Iterator[Case]:
        """As of the suite. Raises Unjudged like it, and where there is no reference beside the kit."""
        assert self.whole is not None
        reference = own_reference(self)
        for case in self.whole.cases():
            if not changing(self.names, case.scans):
                yield case
                continue
            reference.reset(case.params)
            first = next(scan.inputs for scan in case.scans if scan.request is None)
            held, scans = {name: first[name] for name in self.names}, []
            for scan in case.scans:
                if scan.request is None:
                    inputs = {**scan.inputs, **held}
                    outputs = {**scan.outputs, **reference.scan(scan.dt_ms, inputs)}
                    scan = replace(scan, inputs=inputs, outputs=outputs, step=len(self.steps) - 1, to=-1)
                scans.append(scan)
            yield replace(case, scans=tuple(scans))

    def has_ways(self, case: Case) -> bool:
        """The ways of the file are those of its own inputs."""
        return False
