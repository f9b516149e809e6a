"""Runs a published suite on the program of the page: every scan of every case, all outputs compared."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from modeproof.simulate.program.device import give, take

SLICE = 400
"""Scans between two pauses, in which the page stays usable."""


class Verdict:
    """What came out so far: `difference` is the first one, as text."""

    def __init__(self, target: str, suite: str, cases: int, scans: int) -> None:
        self.target, self.suite = target, suite
        self.cases, self.scans = cases, scans
        self.done_cases = self.done_scans = 0
        self.difference = ""

    @property
    def word(self) -> str:
        """CONFORMS, DIFFERS, or UNJUDGED: nothing, or not all that the header says, was compared."""
        if self.difference:
            return "DIFFERS"
        whole = self.done_cases == self.cases > 0 and self.done_scans == self.scans > 0
        return "CONFORMS" if whole else "UNJUDGED"

    def compared(self) -> str:
        """How much was compared, and the first difference."""
        head = f"{self.done_cases:,} of {self.cases:,} cases, {self.done_scans:,} scans"
        return f"{head}: {self.difference}" if self.difference else head


def judge(code: Any, header: dict[str, Any], cases: Any) -> Iterator[Verdict]:
    """Run the cases (an iterable of rows as the vector file has them); a pause after each SLICE of scans.

    The last verdict that is given is whole. A case that asks for a refusal is of no suite that runs here:
    it ends the run as a difference.
    """
    ins, outs, kinds = header["inputs"], header["outputs"], header["parameters"]
    verdict = Verdict(header["target"], header["suite"], header["cases"], header["scans"])
    since = 0
    for case in cases:
        params = {name: take(kinds[name], value) for name, value in case["params"].items()}
        state = code.power_up(code.Params(**params))
        given: dict[str, Any] = {}
        wanted: dict[str, Any] = {}
        record: Any = None
        for number, scan in enumerate(case["scans"], 1):
            if "refuse" in scan:
                verdict.difference = f"{case['id']}: asks for a refusal, which nothing here can give"
                yield verdict
                return
            for name in scan["in"]:
                given[name] = take(ins[name], scan["in"][name])
            for name in scan["out"]:
                wanted[name] = take(outs[name], scan["out"][name])
            if scan["in"] or record is None or record.dt_ms != scan["dt_ms"]:
                record = code.Inputs(scan["dt_ms"], **given)
            state, out = code.step(state, record)
            verdict.done_scans += 1
            for name in () if "settling" in scan else wanted:
                value = wanted[name]
                if getattr(out, name) != value:
                    got, value = give(outs[name], getattr(out, name)), give(outs[name], value)
                    verdict.difference = f"{case['id']}, scan {number}: {name} is {got}, expected {value}"
                    yield verdict
                    return
            since += 1
            if since == SLICE:
                since = 0
                yield verdict
        verdict.done_cases += 1
    yield verdict
