"""Puts both judgements of a log together: the graphs' and TLC's. TLC's is the exact one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from modeproof.graph.device import graph_file, load_device_graph, open_runs
from modeproof.ground.errors import Unjudged
from modeproof.registers.rows import Device
from modeproof.registers.runs import Run
from modeproof.suites.build import citations_of
from modeproof.tlc.process import Outcome
from modeproof.tlc.toolchain import Toolchain
from modeproof.trace.alphabet import Alphabet
from modeproof.trace.exact import Matched, Scans, judge_exactly
from modeproof.trace.follow import Followed, NotFollowed, follow
from modeproof.trace.log import Log
from modeproof.trace.log_module import Reading
from modeproof.trace.targets import Target, targets_of
from modeproof.trace.why import Why, device_log, explain


class Graphs:
    """The graphs of the devices: read when they are needed, made by TLC when they are missing or old.

    `read` has graphs that were read before, by run.
    """

    def __init__(
        self, place: Path, make: Callable[[tuple[Run, ...]], None], read: Mapping[str, Alphabet] | None = None
    ) -> None:
        self._place = place
        self._make = make
        self._read: dict[str, Alphabet] = dict(read or {})
        self.used: list[Path] = []

    def passed(self, target: Target) -> Mapping[str, Mapping[str, str]]:
        """For each device the outputs that repeat an input of the same scan."""
        return {
            name: runs[0].graph.passed
            for name in target.parts
            if (runs := open_runs(self._place, target.document, name)) and runs[0].graph is not None
        }

    def matching(self, target: Target, log: Log) -> Mapping[str, Alphabet]:
        """For each device the graph with the log's parameters (but those in ms), if there is one."""
        found = {}
        for name, part in target.parts.items():
            for run in open_runs(self._place, target.document, name):
                if run.graph is not None and _same(part.device, run, log):
                    found[name] = self._alphabet(run)
                    break
        return found

    def any_of(self, target: Target, log: Log) -> Mapping[str, Alphabet]:
        """For each device a graph whose inputs tell what an input that was not observed can be."""
        found = dict(self.matching(target, log))
        for name, part in target.parts.items():
            whole = all(
                signal in row.inputs
                for row, _ in log.rows.kinds()
                if row.device == name
                for signal in part.device.inputs
            )
            runs = open_runs(self._place, target.document, name)
            if name not in found and not whole and runs:
                found[name] = self._alphabet(runs[0])
        return found

    def one_of(self, target: Target, log: Log) -> Alphabet | None:
        """A graph of the only device of a target: with the log's parameters, or else any that was read."""
        name = target.only.device.id
        found = self.matching(target, log).get(name)
        others = (
            self._read[run.id]
            for run in open_runs(self._place, target.document, name)
            if run.id in self._read
        )
        return found if found is not None else next(others, None)

    def _alphabet(self, run: Run) -> Alphabet:
        if run.id not in self._read:
            self._make((run,))
            self._read[run.id] = Alphabet(load_device_graph(self._place, run))
            self.used.append(graph_file(self._place, run))
        return self._read[run.id]


def _same(device: Device, run: Run, log: Log) -> bool:
    """Whether a graph makes the choices of a log. Of a time that chooses it is whether it has its default."""
    assert run.graph is not None
    given, printed = log.params[device.id], run.graph.params
    return all(
        (printed.get(name, of.default) == of.default) == (given.get(name) == of.default)
        if of.type == "ms" and of.cautious is not None
        else of.type == "ms" or printed.get(name, of.default) == given.get(name)
        for name, of in device.parameters.items()
    )


@dataclass(frozen=True)
class Compared:
    """In how many of the lines each output was compared, by device, and in how many any was."""

    outputs: Mapping[str, Mapping[str, int]]
    lines: int


def compared(target: Target, log: Log, passed: Mapping[str, Mapping[str, str]]) -> Compared:
    """What a log lets compare. An output that repeats an input needs that input in its line."""
    outputs = {name: dict.fromkeys(part.device.outputs, 0) for name, part in target.parts.items()}
    lines = 0
    for row, number in log.rows.kinds():
        given = passed.get(row.device, {})
        names = [name for name in row.outputs if name not in given or given[name] in row.inputs]
        lines += number if names else 0
        for name in names:
            outputs[row.device][name] += number
    return Compared(outputs, lines)


BY_TLC, BY_REFERENCE = "TLC", "reference"
"""Who judged."""


@dataclass(frozen=True)
class Judgement:
    """What came out for one log. `accepted` lines fit the specification, by TLC or by the reference."""

    log: Log
    followed: Followed | NotFollowed
    matched: Matched
    compared: Compared
    by: str = BY_TLC

    @property
    def accepted(self) -> int:
        """The length of the longest prefix that the specification allows."""
        return self.matched.accepted

    @property
    def verdict(self) -> str:
        """CONFORMS: every line fits; DIFFERS: the line after `accepted` is impossible."""
        return "CONFORMS" if self.accepted == len(self.log.rows) else "DIFFERS"

    @property
    def status(self) -> int:
        """Exit status."""
        return 0 if self.verdict == "CONFORMS" else 1


def judge_logs(
    place: Path,
    target: Target,
    logs: Sequence[Log],
    graphs: Graphs,
    tools: Toolchain,
    *,
    anywhere: bool = False,
    samples: Scans | None = None,
    say: Callable[[str], None] = lambda line: None,
) -> tuple[tuple[Judgement, ...], Outcome]:
    """Judge logs of one target with the same parameters, together in each run of TLC.

    Raises Unjudged when a log shows no output, and when the two judgements contradict each other and nothing
    that was left open explains it.
    """
    if samples and target.system:
        raise Unjudged(f"--samples is for one device; a line of a log of {target.id} is one scan")
    if anywhere and not target.anywhere:
        raise Unjudged(f"a log of {target.id} must begin at power-up")
    passed = graphs.passed(target)
    shares = [compared(target, log, passed) for log in logs]
    for log, share in zip(logs, shares, strict=True):
        if not share.lines:
            raise Unjudged(f"{log.name}: nothing to compare: no line shows an output of {target.id}")
    readings = [Reading(target, log, graphs.any_of(target, log)) for log in logs]
    done = judge_exactly(
        place, target, readings, tools, passed=passed, anywhere=anywhere, samples=samples, say=say
    )
    found = []
    for log, matched, share in zip(logs, done.matched, shares, strict=True):
        followed = follow(target, log, graphs.matching(target, log), anywhere, samples is not None)
        found.append(Judgement(log, followed, matched, share))
        check(found[-1])
    return tuple(found), done.outcome


def check(found: Judgement) -> None:
    """Raise Unjudged for a contradiction: the graphs may accept more, if they left something open."""
    one = found.followed
    if isinstance(one, NotFollowed) or one.accepted == found.accepted:
        return
    if one.accepted < found.accepted or not one.open:
        raise Unjudged(
            f"{found.log.name}: the judgements contradict each other: the graph {' '.join(one.runs)} follows "
            f"{one.accepted:,} scans, TLC {found.accepted:,}; one of the two tools is wrong"
        )


def why_not(
    place: Path, target: Target, found: Judgement, graphs: Graphs, tools: Toolchain, *, anywhere: bool = False
) -> Why | None:
    """Why the first impossible line of a log is impossible.

    None for a log that fits, and where too little is known to say: no line of a log that may begin anywhere
    fits, or the device is no target by itself. Raises Unjudged when TLC or the parser fail.
    """
    if found.status == 0 or (anywhere and found.accepted == 0):
        return None
    row = found.log.rows[found.accepted]
    alone = [other for other in targets_of(place, target.document) if set(other.parts) == {row.device}]
    if not alone:
        return None
    log = device_log(alone[0], found.log)
    one = found.followed
    stopped = isinstance(one, Followed) and one.accepted == found.accepted
    return explain(
        place,
        alone[0],
        Reading(alone[0], log, graphs.any_of(alone[0], log)),
        row,
        found.matched.views,
        graphs.one_of(alone[0], log),
        graphs.passed(alone[0]).get(row.device, {}),
        citations_of(place, target.document, row.device),
        tools,
        one.wrong_input if isinstance(one, Followed) and stopped else None,
    )
