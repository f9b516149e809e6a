"""Reads what TLC says with `-tool`: framed messages with numeric codes, and the model's own printed lines.

Codes are judged, never English sentences; a sentence is read only for the number or name that it carries.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

# Message codes of TLC 2.15 (tlc2.output.EC).
VERSION = 2262
STARTED = 2185
INITIAL = 2190
SUCCESS = 2193
DEPTH = 2194
STATS = 2199
PROGRESS = 2200
FINISHED = 2186
STATE_TEXT = (2216, 2217)
STUTTERING = 2218
BACK_TO_STATE = 2122
INITIALLY = (2107, 2108)
INVARIANT = (2107, 2110)
ACTION_PROPERTY = (2108, 2112)
TEMPORAL = 2116
DEADLOCK = 2114
ASSUMPTION = (2104, 2105)
OUT_OF_MEMORY = (1001, 1002, 1003)
GENERAL = 1000
TRACE = 2121

_FRAME = re.compile(rb"@!@!@(STARTMSG|ENDMSG) (\d+)(?::(\d+))? @!@!@")
_COUNTS = re.compile(r"([\d,.]+) states generated.*?([\d,.]+) distinct states found.*?([\d,.]+) states left")
_INITIAL_ALL = re.compile(r"initial states: ([\d,.]+) states? generated, with ([\d,.]+) of them distinct")
_INITIAL = re.compile(r"initial states: ([\d,.]+) (?:distinct )?states? generated")
_DEPTH = re.compile(r"search is (\d+)")
_INVARIANT_NAME = re.compile(r"Invariant (\S+) is violated")
_PROPERTY_NAME = re.compile(r"[Pp]roperty (\S+) is violated")
_STEP = re.compile(r"(\d+): <(.*)>\s*$")
_PLACE = re.compile(r"^(.*?) line \d+, col \d+ to line \d+, col \d+ of module (\S+)$")
_BACK = re.compile(r"(?:Back to state )?(\d+)(?:: Back to state)?")
_VARIABLE = re.compile(r"^(?:/\\ )?([A-Za-z_]\w*) = (.*)$")
_PARSED = re.compile(r"^Parsing file (.+)$")
_COLLISION = {
    "calculated": re.compile(r"calculated \(optimistic\):\s+val = (\S+)"),
    "actual": re.compile(r"based on the actual fingerprints:\s+val = (\S+)"),
}
_EDGE = b'"<<\\"EDGE\\", '
_TAG = re.compile(rb'^"<<\\"([A-Z_]+)\\"')


@dataclass(frozen=True)
class TraceState:
    """One state of a counterexample: its number from 1, the action that led to it, all variables as text."""

    number: int
    action: str
    module: str
    variables: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Counts:
    """Numbers of states so far: generated, distinct, and still to be explored."""

    generated: int
    distinct: int
    queue: int


@dataclass
class Log:
    """What was understood of one log. A field that was never said stays None or empty."""

    version: str = ""
    files: list[str] = field(default_factory=list)
    counts: Counts | None = None
    final: bool = False
    initial: int | None = None
    depth: int | None = None
    success: bool = False
    finished: bool = False
    started: bool = False
    violations: list[tuple[str, str]] = field(default_factory=list)
    initially: bool = False
    """An initial state already violates something: TLC ends at once, and says no counts."""
    collision: dict[str, float] = field(default_factory=dict)
    """TLC's estimates of the probability that two states had one fingerprint: calculated, and actual."""
    trace: list[TraceState] = field(default_factory=list)
    loop: str = ""
    errors: list[tuple[int, str]] = field(default_factory=list)
    printed: int = 0
    tags: dict[str, int] = field(default_factory=dict)
    broken: str = ""
    unframed: list[str] = field(default_factory=list)
    """The first lines outside of any message that are not TLC's: Java complains like this."""


def _number(text: str) -> int:
    return int(re.sub(r"[,.]", "", text))


def unquote(line: bytes) -> bytes:
    r"""The content of a TLA+ string literal that TLC printed: `"<<\"A\", 1>>"` becomes `<<"A", 1>>`."""
    inner = line[1:-1]
    if b"\\" not in inner:
        return inner
    if b"\\\\" not in inner:
        return inner.replace(b'\\"', b'"')
    return re.sub(rb"\\(.)", rb"\1", inner)


class LogReader:
    """Takes TLC's standard output line by line.

    `on_printed` gets each printed line of the model (a TLA+ string, unquoted, without the newline),
    `on_progress` gets the counts as TLC reports them, `on_message` the code of every message. Printed lines
    are the hot path: a run may print millions.
    """

    def __init__(
        self,
        on_printed: Callable[[bytes], None] | None = None,
        on_progress: Callable[[Counts], None] | None = None,
        on_message: Callable[[int], None] | None = None,
    ) -> None:
        self.log = Log()
        self._on_printed = on_printed
        self._on_progress = on_progress
        self._on_message = on_message
        self._open: list[tuple[int, int, list[str]]] = []
        self._tags: dict[bytes, int] = {}
        self._edges = 0

    def feed(self, line: bytes) -> None:
        """Take one line, with or without its newline."""
        if line.startswith(_EDGE) and line.endswith(b'>>"\n') and b"\\\\" not in line:
            # The common case of a graph with millions of edges, without detours.
            self._edges += 1
            if self._on_printed is not None:
                self._on_printed(line[1:-2].replace(b'\\"', b'"'))
            return
        if line[:1] == b'"':
            self._printed(line.rstrip(b"\r\n"))
            return
        line = line.rstrip(b"\r\n")
        if b"@!@!@" not in line:
            text = line.decode("utf-8", "replace")
            if self._open:
                self._open[-1][2].append(text)
            elif parsed := _PARSED.match(text):
                self.log.files.append(parsed.group(1))
            elif text.strip() and not text.startswith("Semantic processing") and len(self.log.unframed) < 20:
                self.log.unframed.append(text)
            return
        rest = line
        while match := _FRAME.search(rest):
            before = rest[: match.start()]
            if before and self._open:
                self._open[-1][2].append(before.decode("utf-8", "replace"))
            code = int(match.group(2))
            if match.group(1) == b"STARTMSG":
                self._open.append((code, int(match.group(3) or 0), []))
            elif self._open and self._open[-1][0] == code:
                _, severity, lines = self._open.pop()
                self._message(code, severity, lines)
            else:
                self.log.broken = self.log.broken or f"message {code} ends without a start"
            rest = rest[match.end() :]

    def close(self) -> Log:
        """End of the log: whatever is still open was cut off."""
        if self._open:
            self.log.broken = self.log.broken or f"message {self._open[-1][0]} has no end"
        tags = {tag.decode("ascii"): count for tag, count in self._tags.items()}
        if self._edges:
            tags["EDGE"] = tags.get("EDGE", 0) + self._edges
            self.log.printed += self._edges
        self.log.tags = tags
        return self.log

    def _printed(self, line: bytes) -> None:
        self.log.printed += 1
        if len(line) < 2 or line[-1:] != b'"':
            self.log.broken = self.log.broken or f"printed line {self.log.printed} is cut off"
            return
        tag = _TAG.match(line)
        if tag is not None:
            name = tag.group(1)
            self._tags[name] = self._tags.get(name, 0) + 1
        if self._on_printed is not None:
            self._on_printed(unquote(line))

    def _message(self, code: int, severity: int, lines: list[str]) -> None:
        text = "\n".join(lines)
        log = self.log
        if self._on_message is not None:
            self._on_message(code)
        if code == VERSION:
            log.version = text.strip()
        elif code == STARTED:
            log.started = True
        elif code == INITIAL:
            if match := _INITIAL_ALL.search(text) or _INITIAL.search(text):
                log.initial = _number(match.group(1))
        elif code in (PROGRESS, STATS):
            self._counts(code, text)
        elif code == SUCCESS:
            log.success = True
            log.collision = {
                name: float(match.group(1))
                for name, form in _COLLISION.items()
                if (match := form.search(text))
            }
        elif code == FINISHED:
            log.finished = True
        elif code == DEPTH:
            if match := _DEPTH.search(text):
                log.depth = int(match.group(1))
        elif code in STATE_TEXT:
            self._state(lines)
        elif code == STUTTERING:
            log.loop = "stuttering"
        elif code == BACK_TO_STATE:
            match = _BACK.search(text)
            log.loop = f"back to state {match.group(1)}" if match else "back to an earlier state"
        elif code in INVARIANT or code in ACTION_PROPERTY:
            kind = "invariant" if code in INVARIANT else "property"
            match = (_INVARIANT_NAME if code in INVARIANT else _PROPERTY_NAME).search(text)
            log.violations.append((kind, match.group(1) if match else ""))
            if code in INITIALLY:
                log.initially = True
                log.trace.append(TraceState(1, "Initial predicate", "", _variables(lines[1:])))
        elif code == TEMPORAL:
            log.violations.append(("temporal", ""))
        elif code == DEADLOCK:
            log.violations.append(("deadlock", ""))
        elif code in ASSUMPTION:
            log.violations.append(("assumption", ""))
            log.errors.append((code, text.strip()))
        elif severity in (1, 2) and code not in (2121, 2264):
            log.errors.append((code, text.strip()))

    def _counts(self, code: int, text: str) -> None:
        match = _COUNTS.search(text)
        if match is None:
            self.log.broken = self.log.broken or f"message {code} has no counts"
            return
        counts = Counts(_number(match.group(1)), _number(match.group(2)), _number(match.group(3)))
        self.log.counts = counts
        self.log.final = self.log.final or code == STATS
        if self._on_progress is not None:
            self._on_progress(counts)

    def _state(self, lines: list[str]) -> None:
        head = _STEP.match(lines[0]) if lines else None
        if head is None:
            self.log.broken = self.log.broken or "a state of the counterexample has no number"
            return
        place = _PLACE.match(head.group(2))
        action, module = (place.group(1), place.group(2)) if place else (head.group(2), "")
        self.log.trace.append(TraceState(int(head.group(1)), action, module, _variables(lines[1:])))


def _variables(lines: list[str]) -> tuple[tuple[str, str], ...]:
    """The variables of a state as TLC prints it; a value may go on over several lines."""
    variables: list[tuple[str, str]] = []
    for line in lines:
        match = _VARIABLE.match(line)
        if match is not None:
            variables.append((match.group(1), match.group(2).strip()))
        elif variables and line.strip():
            name, value = variables[-1]
            variables[-1] = (name, f"{value} {line.strip()}")
    return tuple(variables)


_BOILERPLATE = (
    "TLC threw an unexpected exception.",
    "This was probably caused by an error in the spec or model.",
    "See the User Output or TLC Console for clues to what happened.",
)


def essence(text: str) -> list[str]:
    """The lines of an error message that say something: no boilerplate, no Java stack."""
    lines = [line.rstrip() for line in text.splitlines()]
    kept = [line for line in lines if line.strip() and not line.startswith("\tat ")]
    return [line for line in kept if line.strip() not in _BOILERPLATE]


def format_trace(
    trace: list[TraceState] | tuple[TraceState, ...],
    loop: str,
    everything: bool = False,
    wires: Sequence[Mapping[str, str]] = (),
) -> str:
    """A counterexample to read: each step with the variables that it changed (all of them in the first
    state).

    `wires` gives for each state what is on the wires; it takes the place of variables of the same name.
    """
    lines: list[str] = []
    before: dict[str, str] = {}
    for state, told in zip(trace, wires or [{}] * len(trace), strict=True):
        lines.append(f"{state.number:>4}  {state.action}")
        now = {**dict(state.variables), **told}
        changed = {name: value for name, value in now.items() if everything or before.get(name) != value}
        width = max((len(name) for name in changed), default=0)
        lines.extend(f"        {name:<{width}} = {value}" for name, value in changed.items())
        if not changed:
            lines.append("        (nothing changes)")
        before = now
    if loop:
        lines.append(f"      then {loop}")
    return "\n".join(lines)
