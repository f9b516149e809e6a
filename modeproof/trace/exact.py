"""TLC's judgement of logs: a module made for them alone, in which each scan must be the log's next line.

Nothing is approximated: times are in ms, words are the words of the log, the parameters are the log's own.
What was not observed may be anything in the alphabet of the device's graph. A time that was not observed is
left open: none, or one that passes a deadline. Between two samples the program scans as often as the time
between them and its scan time allow, first with the inputs of the one and then with those of the other.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import build
from modeproof.registers.runs import Run
from modeproof.registers.tla import closure, read_modules
from modeproof.tlc.children import room
from modeproof.tlc.messages import essence
from modeproof.tlc.process import Outcome, run_tlc
from modeproof.tlc.tla_values import TlaError, canonical, parse
from modeproof.tlc.toolchain import Toolchain
from modeproof.trace.log_module import Reading, constants, read_inputs
from modeproof.trace.targets import Target

HEAP_MB = 512
HEAP_ANYWHERE_MB = 1536
TIME_LIMIT_S = 600.0
PIECE_LINES = 5_000
MOST_SCANS = 30_000
"""So many scans of samples at most in one piece: TLC gets slower with the length of a run."""
MOST_STATES = 2_000
"""So many states may be possible between two pieces."""
ANY_TIME = 2_000_000_000
"""The time before the first sample of a log that does not tell it."""


@dataclass(frozen=True)
class Scans:
    """How long a scan of a sampled program takes, in ms from `shortest` (1 or more) to `longest`."""

    shortest: int
    longest: int

    def __str__(self) -> str:
        return f"{self.shortest}" + (f" to {self.longest}" if self.longest > self.shortest else "")


@dataclass(frozen=True)
class Matched:
    """What TLC found out about one log.

    `accepted` lines fit. `views` are the memories that are possible after the last of them, by device, as
    canonical TLA+; none for a log that begins anywhere or is sampled and fits, which may leave many.
    """

    accepted: int
    views: tuple[Mapping[str, str], ...]


@dataclass(frozen=True)
class Judged:
    """The logs of one call, in their order, and TLC's last run."""

    matched: tuple[Matched, ...]
    outcome: Outcome


@dataclass(frozen=True)
class _Piece:
    """Lines `first` to `last` of a log (from 0, the last one not included), and the states before them.

    A state has a value for each variable of the specification, then the ms since its last scan; none for
    the first piece. `shown`: after so many of the lines the possible states are to be told, -1 for never.
    """

    reading: Reading
    number: int
    first: int
    last: int
    states: tuple[str, ...] = ()
    shown: int = -1


@dataclass(frozen=True)
class _Told:
    accepted: int
    views: tuple[Mapping[str, str], ...]
    states: tuple[str, ...]


def judge_exactly(
    place: Path,
    target: Target,
    readings: Sequence[Reading],
    tools: Toolchain,
    *,
    passed: Mapping[str, Mapping[str, str]],
    anywhere: bool = False,
    samples: Scans | None = None,
    say: Callable[[str], None] = lambda line: None,
) -> Judged:
    """Let TLC judge logs of one target with the same parameters, PIECE_LINES of each at a time.

    The states that are possible after a piece are those before the next one. `passed` names for each device
    the outputs that repeat an input. Raises Unjudged when TLC cannot be run or does not come to an end.
    """
    work = _Work(place, target, readings, tools, passed, anywhere, samples)
    many = anywhere or samples is not None
    matched: dict[int, Matched] = {}
    going = [_Piece(reading, n, 0, work.end(reading, 0)) for n, reading in enumerate(readings)]
    while going:
        going = [
            replace(one, shown=-1 if many and one.last == len(one.reading.log.rows) else one.last - one.first)
            for one in going
        ]
        stuck, following = [], []
        for one, told in zip(going, work.told(going), strict=True):
            rows, at = one.reading.log.rows, one.first + told.accepted
            if at < one.last:
                matched[one.number] = Matched(at, ())
                stuck.append(replace(one, shown=told.accepted))
                continue
            matched[one.number] = Matched(at, told.views)
            if at < len(rows):
                say(f"{at:,} of {len(rows):,} lines of {one.reading.log.name} fit")
                following.append(_Piece(one.reading, one.number, at, work.end(one.reading, at), told.states))
        stuck = [one for one in stuck if samples is None and not (anywhere and one.first + one.shown == 0)]
        for one, told in zip(stuck, work.told(stuck) if stuck else (), strict=True):
            matched[one.number] = replace(matched[one.number], views=told.views)
        going = following
    assert work.outcome is not None
    return Judged(tuple(matched[n] for n in range(len(readings))), work.outcome)


class _Work:
    """Runs TLC on pieces of logs."""

    def __init__(
        self,
        place: Path,
        target: Target,
        readings: Sequence[Reading],
        tools: Toolchain,
        passed: Mapping[str, Mapping[str, str]],
        anywhere: bool,
        samples: Scans | None,
    ) -> None:
        self.place, self.target, self.readings, self.tools = place, target, readings, tools
        self.passed, self.anywhere, self.samples = passed, anywhere, samples
        self.outcome: Outcome | None = None
        self.constants = constant_definitions(target, readings)
        long = any(self.end(reading, 0) < len(reading.log.rows) for reading in readings)
        self.variables = self._variables() if long else ()

    def _variables(self) -> tuple[str, ...]:
        """Those of the target's module and of all that it extends; an instance has none of its own."""
        modules = read_modules(self.place, self.target.document)
        whole = closure(modules, self.target.module, instances=False)
        return tuple(sorted({name for module in whole for name in module.variables}))

    def end(self, reading: Reading, first: int) -> int:
        """Where the piece ends that begins with line `first`."""
        rows = reading.log.rows
        if self.samples is None:
            return min(first + PIECE_LINES, len(rows))
        scans, at = 0, first
        for row in rows[first : first + PIECE_LINES]:
            if row.dt_ms is None and row.line != rows[0].line:
                raise Unjudged(f"{reading.log.name}: line {row.line}: a sample needs its time")
            gap = (row.dt_ms or 0) // self.samples.shortest
            if gap > MOST_SCANS:
                raise Unjudged(
                    f"{reading.log.name}: line {row.line}: up to {gap:,} scans since the sample before are "
                    f"too many to follow; at most {MOST_SCANS:,}"
                )
            scans += gap + 1
            if scans > MOST_SCANS and at > first:
                break
            at += 1
        return at

    def told(self, pieces: Sequence[_Piece]) -> tuple[_Told, ...]:
        """What TLC says of these pieces."""
        name = f"Trace_{self.target.id}"
        run = trace_run(self.target, name, HEAP_ANYWHERE_MB if self.anywhere else HEAP_MB)
        texts = {f"{name}.tla": self.text(name, pieces), run.cfg: cfg_text(self.target)}
        self.outcome = run_alone(self.place, run, self.tools, texts)
        best = [self.before(piece) for piece in pieces]
        views: list[list[Mapping[str, str]]] = [[] for _ in pieces]
        states: list[list[str]] = [[] for _ in pieces]
        for text in sorted(self.outcome.printed):
            try:
                tag, log, line, *rest = parse(text.decode())
            except (TlaError, ValueError) as error:
                raise Unjudged(f"{run.name}: TLC printed a line that is not understood: {error}") from None
            if tag == "LINE":
                best[log - 1] = max(best[log - 1], line)
            else:
                parts = zip(self.target.parts, rest[0], strict=True)
                views[log - 1].append({device: canonical(one) for device, one in parts})
                states[log - 1].append(canonical(rest[1]))
        if max(map(len, states)) > MOST_STATES and self.variables:
            raise Unjudged(f"{run.name}: the log leaves more open than can be followed from piece to piece")
        return tuple(
            _Told(best[n] - self.before(piece), tuple(views[n]), tuple(dict.fromkeys(states[n])))
            for n, piece in enumerate(pieces)
        )

    def before(self, piece: _Piece) -> int:
        """How many lines before the piece its module has: a sample needs the one before it."""
        return 1 if self.samples is not None and piece.first else 0

    def text(self, name: str, pieces: Sequence[_Piece]) -> str:
        """The module. Its own names begin with Log, so that none is one of the specification's."""
        target, sampled = self.target, self.samples is not None
        tables: tuple[dict[str, int], ...] = ({}, {}, {})
        rows: dict[str, int] = {}
        lines = []
        for piece in pieces:
            numbers = []
            for row in piece.reading.log.rows[piece.first - self.before(piece) : piece.last]:
                texts = piece.reading.line(row, self.passed.get(row.device, {}))
                at = [table.setdefault(one, len(table) + 1) for table, one in zip(tables, texts, strict=True)]
                gap = f", {-1 if row.dt_ms is None else row.dt_ms}" if sampled else ""
                row_text = f"<<{', '.join(map(str, at))}{gap}>>"
                numbers.append(rows.setdefault(row_text, len(rows) + 1))
            lines.append("<<" + ", ".join(map(str, numbers)) + ">>")
        scans = " \\/ ".join(
            f'(w.device = "{device}" /\\ {part.scan})' for device, part in target.parts.items()
        )
        after = " [] ".join(
            f'w.device = "{device}" -> LogFits({part.row}\', out)' for device, part in target.parts.items()
        )
        views = ", ".join(part.view for part in target.parts.values())
        left = ", logLeft, logTurned" if sampled else ""
        tuples = zip(("LogIns", "LogTimes", "LogOuts"), tables, strict=True)
        state = ", ".join([*self.variables, "logLeft" if sampled else "0"])
        shown = [piece.shown + self.before(piece) if piece.shown >= 0 else -1 for piece in pieces]
        parts = [
            f"---- MODULE {name} ----",
            f"EXTENDS {target.module}, Naturals, Sequences, TLC",
            f"VARIABLES log, line{left}",
            *self.constants,
            *(f"{one} == <<\n  " + ",\n  ".join(table) + ">>" for one, table in tuples),
            "LogRows == <<" + ",\n  ".join(rows) + ">>",
            "LogLines == <<\n  " + ",\n  ".join(lines) + ">>",
            "LogStates == <<" + ",\n  ".join("{" + ",\n  ".join(one.states) + "}" for one in pieces) + ">>",
            "LogRow(n) == LogRows[LogLines[log][n]]",
            "LogIn(n) == LogIns[LogRow(n)[1]]",
            "LogOut(n) == LogOuts[LogRow(n)[3]]",
            "LogFits(row, out) == \\A name \\in DOMAIN out : row[name] = out[name]",
            *read_inputs(target),
            f"LogScan(w) == {scans}",
            f"LogView == <<log, line, {views}{left}>>",
            "LogTells(what) == PrintT(ToString(what))",
            f"LogInit == /\\ \\A n \\in 1..{len(pieces)} : TLCSet(n, -1)",
            f"           /\\ {self._begins(pieces)}",
            *(self._sampled(views, self.samples) if self.samples is not None else _exact(after)),
            "LogSays ==",
            '    /\\ line > TLCGet(log) => TLCSet(log, line) /\\ LogTells(<<"LINE", log, line>>)',
            f"    /\\ line = <<{', '.join(map(str, shown))}>>[log] =>",
            f'        LogTells(<<"STATE", log, line, <<{views}>>, <<{state}>>>>)',
            "====",
            "",
        ]
        return "\n".join(parts)

    def _begins(self, pieces: Sequence[_Piece]) -> str:
        """The states before each piece."""
        cases = []
        for n, piece in enumerate(pieces, 1):
            rows = piece.reading.log.rows
            if not piece.first:
                gap = rows[0].dt_ms
                case = f"line = 0 /\\ ({self.target.anywhere if self.anywhere else self.target.init})"
                left = f"logLeft = {ANY_TIME if gap is None else gap}"
            else:
                values = " /\\ ".join(f"{name} = s[{at}]" for at, name in enumerate(self.variables, 1))
                case = f"line = {self.before(piece)} /\\ \\E s \\in LogStates[{n}] : {values}"
                left = f"logLeft = s[{len(self.variables) + 1}] + {rows[piece.first].dt_ms}"
            sampled = f" /\\ {left} /\\ logTurned = FALSE" if self.samples else ""
            cases.append(f"(log = {n} /\\ {case}{sampled})")
        return "\n             \\/ ".join(["", *cases]) if len(cases) > 1 else cases[0]

    def _sampled(self, views: str, scans: Scans) -> list[str]:
        """Between two samples the program scans as often as the time between them allows.

        `logLeft`: the ms from the last scan to the next sample; `logTurned`: that one's inputs are read now.
        """
        gaps = {gap for reading in self.readings for gap in _gaps(reading)}
        unit = math.gcd(scans.longest, *gaps) if scans.shortest == scans.longest else 1
        return [
            "LogTurn == IF logTurned \\/ line = 0 THEN {TRUE} ELSE BOOLEAN",
            "LogBetween ==",
            "    /\\ line < Len(LogLines[log])",
            f"    /\\ \\E after \\in LogTurn, t \\in {scans.shortest}..{scans.longest} :",
            "        /\\ t <= logLeft",
            "        /\\ logTurned' = after",
            f"        /\\ logLeft' = IF logLeft = {ANY_TIME} THEN logLeft ELSE logLeft - t",
            "        /\\ \\E v \\in LogIn(IF after THEN line + 1 ELSE line) : LogScan(LogRead(v, t))",
            "    /\\ UNCHANGED <<log, line>>",
            f"LogRest == IF logLeft = {ANY_TIME} THEN {{n \\in 0..{scans.longest} : n % {unit} = 0}}",
            f"           ELSE {{logLeft}} \\cap 0..{scans.longest}",
            "LogGap == IF line + 1 = Len(LogLines[log]) THEN 0 ELSE LogRow(line + 2)[4]",
            "LogArrive ==",
            "    /\\ line < Len(LogLines[log]) /\\ LogIn(line + 1) # {}",
            f"    /\\ LogFits({self.target.only.row}, LogOut(line + 1))",
            "    /\\ \\E rest \\in LogRest : logLeft' = rest + LogGap",
            "    /\\ line' = line + 1 /\\ logTurned' = FALSE /\\ step' = step",
            f"    /\\ UNCHANGED <<log, {views}>>",
            "LogNext == LogBetween \\/ LogArrive",
        ]


def _gaps(reading: Reading) -> set[int]:
    return {dt for device in reading.target.parts for dt in reading.log.rows.times(device) if dt is not None}


def _exact(after: str) -> list[str]:
    """Each scan is the next line."""
    return [
        f"LogFitsAfter(w, out) == CASE {after}",
        "LogNext ==",
        "    /\\ line < Len(LogLines[log])",
        "    /\\ \\E v \\in LogIn(line + 1), t \\in LogTimes[LogRow(line + 1)[2]] :",
        "        LET w == LogRead(v, t) IN LogScan(w) /\\ LogFitsAfter(w, LogOut(line + 1))",
        "    /\\ line' = line + 1 /\\ log' = log",
    ]


def run_alone(place: Path, run: Run, tools: Toolchain, texts: Mapping[str, str]) -> Outcome:
    """Let TLC judge a module that was made here. Several processes may do so at once: each has a folder and
    a log of its own, which are gone when it is done. Raises Unjudged as `checked`.
    """
    apart = msgspec.structs.replace(run, id=f"{run.id}-{os.getpid()}")
    try:
        folder = build(place) / "trace" / run.document
        folder.mkdir(parents=True, exist_ok=True)
        with room(f"{apart.id}.", folder) as own:
            for name, text in texts.items():
                write_whole(own / name, text.encode())
            return checked(run.name, run_tlc(place, apart, tools, made_in=own))
    except OSError as error:
        raise Unjudged(f"{run.name}: {error.filename}: {error.strerror or error}") from None
    finally:
        (build(place) / "tlc" / run.document / f"{apart.id}.log").unlink(missing_ok=True)


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
