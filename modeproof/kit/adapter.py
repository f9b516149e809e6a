"""What the judge talks to: a `Program`. `Adapter` is the one behind a process that speaks adapter protocol 1.

A request, one answer, each within a time limit. An adapter that hangs, floods or never ends a line cannot
hold us up, and a thread takes what it says on standard error. The process is ended in every case, with what
it started where the system allows it. What a system lacks has another way here (see modeproof.kit.lines).
"""

from __future__ import annotations

import contextlib
import json
import os
import shlex
import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from types import TracebackType
from typing import IO, Any, Protocol

from modeproof.kit.errors import Unjudged, plain
from modeproof.kit.lines import END, TOO_LONG, Lines, lines_of
from modeproof.kit.process_group import APART, WINDOWS, end_all
from modeproof.kit.signals import loads, shown

LONGEST_LINE = 1 << 20
"""Bytes of one answer; a longer line is refused while it is still coming in."""
LONGEST_REFUSAL = 1000
"""Characters of the line that says why a request is refused."""
GRACE_S = 0.2
"""How long an answer too many is waited for before a difference is believed."""
CLOSING_S = 0.2
"""How long an adapter that is no longer needed may take to end by itself."""
ENDING_S = 1.0
_TAIL = 2000
_REMEMBERED = 20_000
_ENCODE = json.JSONEncoder(separators=(",", ":")).encode


class Program(Protocol):
    """A program to be judged, whatever lies between it and us: a process, or a module in Python.

    Values are those of the wire (see `modeproof.kit`): words are four upper-case hex digits, booleans bool.
    The judge calls `hello` once, then for each case `reset` and some `scan`, and in any case `close`. Every
    method may raise `Unjudged` with one line that says what is wrong and what to do; nothing else. The judge
    adds case and scan. What `scan` returns is checked by the judge: types, missing and extra outputs. Where a
    program has an attribute `keeps_answers` that is true, it never changes what it has returned, so that the
    same object need not be checked again.
    """

    def hello(self, target: str) -> Mapping[str, Any]:
        """What the program says of itself, as the answer to `hello` of protocol 1.

        `time` is "virtual" (dt_ms is taken as given) or "real" (time passes by itself: relation exact is then
        not possible); `max_latency_scans` the most scans after which an input that is held has had all its
        effects.
        """

    def reset(self, params: Mapping[str, Any]) -> None:
        """Put the program in its power-up state with these parameters; those left out take the defaults."""

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """One scan, `dt_ms` after the one before, with all `inputs`; all outputs after it.

        With real time: wait until `dt_ms` have passed since the last call, write the inputs, let the program
        run one cycle at least, and read the outputs.
        """

    def close(self) -> None:
        """End it, and free what it holds; never raises, and may be called twice."""


class Adapter:
    """A running adapter, a `Program`; use it as a context manager. Every method may raise Unjudged."""

    keeps_answers = True

    def __init__(
        self,
        command: str | Sequence[str],
        timeout_s: float = 10.0,
        lines: Callable[[IO[bytes], int], Lines] = lines_of,
    ) -> None:
        self.command = split_command(command) if isinstance(command, str) else list(command)
        if not self.command:
            raise Unjudged("--adapter: the command is empty")
        self.timeout_s = timeout_s
        self._stderr = b""
        self._hung = False
        self._real_time = False
        self._requests: dict[tuple[Any, ...], bytes] = {}
        self._answers: dict[bytes, Mapping[str, Any]] = {}
        try:
            self.process = subprocess.Popen(
                self.command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                bufsize=0,
                **APART,
            )
        except (OSError, ValueError) as error:
            cause = getattr(error, "strerror", None) or error
            raise Unjudged(f"the adapter cannot be started: {self.command[0]}: {cause}") from None
        if self.process.stdin is None or self.process.stdout is None or self.process.stderr is None:
            raise Unjudged("the adapter has no pipes")
        self._stdin: IO[bytes] = self.process.stdin
        self._lines = lines(self.process.stdout, LONGEST_LINE)
        self._words: IO[bytes] = self.process.stderr
        self._listener = threading.Thread(target=self._drain, daemon=True)
        self._listener.start()
        self._sending_since: float | None = None
        self._closed = threading.Event()
        threading.Thread(target=self._watch_sending, daemon=True).start()

    def _drain(self) -> None:
        with contextlib.suppress(OSError, ValueError):
            while chunk := os.read(self._words.fileno(), 65536):
                self._stderr = (self._stderr + chunk)[-_TAIL:]

    # ------------------------------------------------------------------------------------------- program

    def hello(self, target: str) -> Mapping[str, Any]:
        """The answer to hello."""
        answer = parse_answer(self.ask({"op": "hello", "protocol": 1, "target": target}))
        self._real_time = answer.get("time") == "real"
        return answer

    def reset(self, params: Mapping[str, Any]) -> None:
        """Reset; any answer but {"ok":true} is refused."""
        self._ask_ok({"op": "reset", "params": params})

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """The outputs after one scan."""
        # Requests and answers come again and again; what they mean is worked out once.
        key = (dt_ms, *map(str, inputs.values()))
        request = self._requests.get(key)
        if request is None:
            request = _ENCODE({"op": "scan", "dt_ms": dt_ms, "in": inputs}).encode() + b"\n"
            if len(self._requests) < _REMEMBERED:
                self._requests[key] = request
        line = self.ask_line(request, dt_ms)
        out = self._answers.get(line)
        if out is None:
            answer = parse_answer(line)
            out = answer.get("out")
            if set(answer) != {"out"} or not isinstance(out, dict):
                raise Unjudged(f'{{"out":{{..}}}} expected, got {shown(answer)}')
            if len(self._answers) < _REMEMBERED:
                self._answers[line] = out
        return out

    def scans(self, scans: Sequence[tuple[int, Mapping[str, Any]]]) -> list[Mapping[str, Any]]:
        """The outputs after each of several scans, in one request; for adapters that say that they can."""
        entries = [{"dt_ms": dt_ms, "in": inputs} for dt_ms, inputs in scans]
        request = _ENCODE({"op": "scans", "list": entries}).encode() + b"\n"
        answer = parse_answer(self.ask_line(request, sum(dt_ms for dt_ms, _ in scans)))
        outs = answer.get("list")
        if set(answer) != {"list"} or not isinstance(outs, list):
            raise Unjudged(f'{{"list":[..]}} expected, got {shown(answer)}')
        if len(outs) != len(scans):
            raise Unjudged(f"{len(scans)} answers expected, got {len(outs)}")
        for out in outs:
            if not isinstance(out, dict) or set(out) != {"out"} or not isinstance(out["out"], dict):
                raise Unjudged(f'{{"out":{{..}}}} expected, got {shown(out)}')
        return [out["out"] for out in outs]

    def refused(self, request: Mapping[str, Any] | str) -> Mapping[str, Any]:
        """Send what must be refused; nothing when it is, with {"error":"one line"}, else what was answered.

        Raises Unjudged for an answer that is no JSON object.
        """
        text = request if isinstance(request, str) else _ENCODE(request)
        line = self.ask_line(text.encode() + b"\n")
        try:
            answer = loads(line.decode("utf-8"))
        except (ValueError, RecursionError):
            answer = None
        if not isinstance(answer, dict):
            words = shown(line.decode("utf-8", "replace"))
            raise Unjudged(f"a refusal or an answer was expected, got {words}")
        error = answer.get("error")
        one_line = isinstance(error, str) and error.isprintable() and 0 < len(error) <= LONGEST_REFUSAL
        return {} if one_line and set(answer) == {"error"} else {"answer": shown(answer)}

    # ------------------------------------------------------------------------------------------ requests

    def _ask_ok(self, request: Mapping[str, Any]) -> None:
        answer = parse_answer(self.ask(request))
        if set(answer) != {"ok"} or answer["ok"] is not True:
            raise Unjudged(f"{request['op']} was answered with {shown(answer)}")

    def ask(self, request: Mapping[str, Any]) -> bytes:
        """Send a request and return the line that answers it."""
        return self.ask_line(_ENCODE(request).encode() + b"\n")

    def ask_line(self, line: bytes, dt_ms: int = 0) -> bytes:
        """As `ask`, for a line that is ready to be sent; in real time the answer takes `dt_ms` longer."""
        stray = self._lines.waiting()
        if stray is not None:
            self._refuse_stray(stray)
        self._send(line)
        answer = self._lines.get(self.timeout_s + (dt_ms / 1000 if self._real_time else 0))
        if answer is None:
            raise Unjudged(f"no answer within {self.timeout_s:g} s")
        if isinstance(answer, bytes):
            if len(answer) > LONGEST_LINE:
                raise Unjudged(f"an answer longer than {LONGEST_LINE} bytes")
            return answer
        if answer == TOO_LONG:
            raise Unjudged(f"an answer longer than {LONGEST_LINE} bytes")
        raise Unjudged(self._how_it_ended())

    def _send(self, line: bytes) -> None:
        self._sending_since = time.monotonic()
        try:
            sent = 0
            while sent < len(line):
                sent += self._stdin.write(line[sent:]) or 0
        except (OSError, ValueError):
            if self._hung:
                raise Unjudged(f"a request was not read within {self.timeout_s:g} s") from None
            raise Unjudged(self._how_it_ended()) from None
        finally:
            self._sending_since = None

    def _watch_sending(self) -> None:
        """Ends an adapter that does not read: a full pipe would hold us up for ever."""
        while not self._closed.wait(min(0.5, self.timeout_s / 2)):
            since = self._sending_since
            if since is not None and time.monotonic() - since > self.timeout_s:
                self._hung = True
                self._kill()

    def _refuse_stray(self, found: bytes | int) -> None:
        if isinstance(found, bytes):
            raise Unjudged(f"a line that nobody asked for: {_printable(found)}")
        if found == TOO_LONG:
            raise Unjudged(f"a line longer than {LONGEST_LINE} bytes that nobody asked for")
        raise Unjudged(self._how_it_ended())

    def quiet(self) -> None:
        """Wait a moment and raise Unjudged if one more line comes: an answer too many."""
        found = self._lines.get(GRACE_S)
        if found is not None:
            self._refuse_stray(found)

    def bye(self) -> None:
        """Say goodbye; whatever follows the answer is refused."""
        self._ask_ok({"op": "bye"})
        with contextlib.suppress(OSError):
            self._stdin.close()
        found = self._lines.get(ENDING_S)
        if found not in (None, END):
            self._refuse_stray(found)

    # -------------------------------------------------------------------------------------------- ending

    def _how_it_ended(self) -> str:
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(timeout=ENDING_S)
        status = self.process.poll()
        how = "the adapter closed its output" if status is None else f"the adapter ended with status {status}"
        self._listener.join(ENDING_S if status is not None else CLOSING_S)  # for the last words
        words = self._stderr.decode("utf-8", "replace").strip().splitlines()
        return f"{how}; it said: {plain(words[-1], 200)}" if words else how

    def _kill(self) -> None:
        end_all(self.process.pid)
        with contextlib.suppress(OSError):
            self.process.kill()

    def close(self) -> None:
        """End the process, whatever it is doing."""
        self._closed.set()
        with contextlib.suppress(OSError):
            self._stdin.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(timeout=0.0 if self._hung else CLOSING_S)
        self._kill()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(timeout=ENDING_S)
        self._lines.close()
        self._listener.join(CLOSING_S)
        if not self._listener.is_alive():  # else a child that escaped still holds the pipe
            self._words.close()

    def __enter__(self) -> Adapter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def parse_answer(line: bytes) -> dict[str, Any]:
    """The JSON object of an answer. Raises Unjudged for anything else, and for a refusal."""
    try:
        answer = loads(line.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise Unjudged(f"not a line of JSON ({plain(error, 80)}): {_printable(line)}") from None
    if not isinstance(answer, dict):
        raise Unjudged(f"not a JSON object: {_printable(line)}")
    if "error" in answer:
        raise Unjudged(f"refused: {shown(answer['error'], 200)}")
    return answer


def split_command(command: str) -> list[str]:
    """The words of a command line as this system writes it; no shell is used."""
    try:
        words = shlex.split(command, posix=not WINDOWS)
    except ValueError as error:
        raise Unjudged(f"--adapter: {error}: {command}") from None
    return [word.strip('"') for word in words] if WINDOWS else words


def _printable(line: bytes) -> str:
    return repr(line[:80].decode("utf-8", "replace")) + ("..." if len(line) > 80 else "")
