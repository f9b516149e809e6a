"""TLC's judgement of logs: a module made for them alone, in which each scan must be the log's next line.

Nothing is approximated: times are in ms, words are the words of the log, the parameters are the log's own.
What was not observed may be anything in the alphabet of the device's graph. A time that was not observed, and
the time of every scan between two samples, is left open: none, or one that passes a deadline.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import build
from modeproof.registers.runs import Run
from modeproof.tlc.messages import essence
from modeproof.tlc.process import Outcome, run_tlc
from modeproof.tlc.tla_values import TlaError, canonical, parse
from modeproof.tlc.toolchain import Toolchain
from modeproof.trace.module import Reading, constants
from modeproof.trace.targets import Target

HEAP_MB = 512
HEAP_ANYWHERE_MB = 1536
TIME_LIMIT_S = 600.0


@dataclass(frozen=True)
class Matched:
    """What TLC found out about one log.

    `accepted` lines fit. `views` are the memories that are possible after the last of them, by device, as
    canonical TLA+; none when they were not asked for.
    """

    accepted: int
    views: tuple[Mapping[str, str], ...]


@dataclass(frozen=True)
class Judged:
    """The logs of one TLC run, in their order, and the run itself."""

    matched: tuple[Matched, ...]
    outcome: Outcome
    files: tuple[Path, ...]


def judge_exactly(
    place: Path,
    target: Target,
    readings: Sequence[Reading],
    tools: Toolchain,
    *,
    passed: Mapping[str, Mapping[str, str]],
    anywhere: bool = False,
    samples: bool = False,
    show: Sequence[int] | None = None,
) -> Judged:
    """Let TLC judge logs of one target with the same parameters.

    `passed` names for each device the outputs that repeat an input. The possible memories are told after
    line `show` of each log: -1 for none, and by default after each line, unless that would be too much (a log
    that begins anywhere or is sampled). Raises Unjudged when TLC cannot be run or does not come to an end.
    """
    if anywhere and not target.anywhere:
        raise Unjudged(f"a log of {target.id} must begin at power-up")
    name = f"Trace_{target.id}"
    folder = build(place) / "trace" / target.document / name
    if show is None and (anywhere or samples):
        show = [-1] * len(readings)
    text = module_text(name, target, readings, passed, anywhere, samples, show)
    cfg = cfg_text(target)
    write_whole(folder / f"{name}.tla", text.encode())
    write_whole(folder / f"{name}.cfg", cfg.encode())
    run = trace_run(target, name, HEAP_ANYWHERE_MB if anywhere else HEAP_MB)
    outcome = run_tlc(place, run, tools, made_in=folder)
    return Judged(
        _matched(target, run.name, outcome, len(readings)),
        outcome,
        (folder / f"{name}.tla", folder / f"{name}.cfg"),
    )


def trace_run(target: Target, name: str, heap_mb: int) -> Run:
    """The run of a module that was made here; it is in no register."""
    return Run(
        document=target.document,
        id=name,
        module=name,
        cfg=f"{name}.cfg",
        kind="MC",
        lanes=(),
        environment="as the log",
        strength="one log",
        workers=1,
        heap_mb=heap_mb,
        timeout_s=TIME_LIMIT_S,
        properties=(),
    )


def cfg_text(target: Target) -> str:
    """The cfg: each constant is a definition of the module that was made."""
    lines = ["CONSTANTS"]
    lines += [f"    {name} <- Log_{name}" for name in target.constants]
    return "\n".join([*lines, "INIT LogInit", "NEXT LogNext", "VIEW LogView", "INVARIANT LogSays", ""])


def constant_definitions(target: Target, readings: Sequence[Reading]) -> list[str]:
    """One definition for each constant."""
    return [f"Log_{name} == {text}" for name, text in constants(target, readings).items()]


def module_text(
    name: str,
    target: Target,
    readings: Sequence[Reading],
    passed: Mapping[str, Mapping[str, str]],
    anywhere: bool,
    samples: bool,
    show: Sequence[int] | None,
) -> str:
    """The text of the module. Its own names begin with Log, so that none is one of the specification's."""
    rows: dict[str, int] = {}
    logs = []
    for reading in readings:
        numbers = []
        for row in reading.log.rows:
            line = reading.line(row, passed.get(row.device, {}), free_time=samples)
            numbers.append(rows.setdefault(line, len(rows) + 1))
        logs.append("<<" + ", ".join(map(str, numbers)) + ">>")
    scans = " \\/ ".join(f'(w.device = "{device}" /\\ {part.scan})' for device, part in target.parts.items())
    after = " [] ".join(
        f'w.device = "{device}" -> LogFits({part.row}\', out)' for device, part in target.parts.items()
    )
    views = ", ".join(part.view for part in target.parts.values())
    parts = [
        f"---- MODULE {name} ----",
        f"EXTENDS {target.module}, Naturals, Sequences, TLC",
        "VARIABLES log, line",
        *constant_definitions(target, readings),
        "LogRows == <<\n  " + ",\n  ".join(rows) + ">>",
        "LogLines == <<\n  " + ",\n  ".join(logs) + ">>",
        "LogRow(n) == LogRows[LogLines[log][n]]",
        "LogFits(row, out) == \\A name \\in DOMAIN out : row[name] = out[name]",
        f"LogScan(w) == {scans}",
        f"LogView == <<log, line, {views}>>",
        "LogTells(what) == PrintT(ToString(what))",
    ]
    init = target.anywhere if anywhere else target.init
    reset = f"\\A n \\in 1..{len(readings)} : TLCSet(n, -1)"
    parts.append(f"LogInit == {reset} /\\ log \\in 1..{len(readings)} /\\ line = 0 /\\ ({init})")
    if samples:
        fits = f"LogFits({target.only.row}, LogRow(line + 1).out)"
        parts += [
            "LogNear == {n \\in {line, line + 1} : n \\in 1..Len(LogLines[log])}",
            "LogBetween == \\E n \\in LogNear :",
            "    \\E w \\in LogRow(n).in : LogScan(w) /\\ UNCHANGED <<log, line>>",
            f"LogSampled == line < Len(LogLines[log]) /\\ LogRow(line + 1).in # {{}} /\\ {fits}",
            f"LogArrive == LogSampled /\\ line' = line + 1 /\\ step' = step /\\ UNCHANGED <<log, {views}>>",
            "LogNext == LogBetween \\/ LogArrive",
        ]
    else:
        parts += [
            f"LogFitsAfter(w, out) == CASE {after}",
            "LogNext ==",
            "    /\\ line < Len(LogLines[log])",
            "    /\\ \\E w \\in LogRow(line + 1).in : LogScan(w) /\\ LogFitsAfter(w, LogRow(line + 1).out)",
            "    /\\ line' = line + 1 /\\ log' = log",
        ]
    shown = "TRUE" if show is None else f"line = <<{', '.join(map(str, show))}>>[log]"
    parts += [
        "LogSays ==",
        '    /\\ line > TLCGet(log) => TLCSet(log, line) /\\ LogTells(<<"LINE", log, line>>)',
        f'    /\\ {shown} => LogTells(<<"STATE", log, line, <<{views}>>>>)',
        "====",
        "",
    ]
    return "\n".join(parts)


def checked(name: str, outcome: Outcome) -> Outcome:
    """The outcome, if TLC came to a good end. Raises Unjudged with its first complaint otherwise."""
    log = outcome.log
    if outcome.timed_out:
        raise Unjudged(f"{name}: TLC was stopped after {TIME_LIMIT_S:.0f} s")
    if outcome.status != 0 or not log.success or not log.finished or log.broken or log.errors:
        said = [line for _, text in log.errors for line in essence(text)] or log.unframed
        cause = " ".join(said[:3]) or log.broken or outcome.stderr or f"exit status {outcome.status}"
        raise Unjudged(f"{name}: TLC could not judge it: {cause[:400]}")
    if not outcome.printed_all:
        raise Unjudged(f"{name}: the log leaves more open than can be followed")
    return outcome


def _matched(target: Target, name: str, outcome: Outcome, logs: int) -> tuple[Matched, ...]:
    checked(name, outcome)
    best = dict.fromkeys(range(1, logs + 1), 0)
    views: dict[tuple[int, int], list[Mapping[str, str]]] = {}
    for text in sorted(outcome.printed):
        try:
            tag, log, line, *rest = parse(text.decode())
        except (TlaError, ValueError) as error:
            raise Unjudged(f"{name}: TLC printed a line that is not understood: {error}") from None
        if tag == "LINE":
            best[log] = max(best[log], line)
        else:
            view = {device: canonical(one) for device, one in zip(target.parts, rest[0], strict=True)}
            views.setdefault((log, line), []).append(view)
    return tuple(Matched(line, tuple(views.get((log, line), ()))) for log, line in best.items())
