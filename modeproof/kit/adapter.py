"""What the judge talks to: a `Program`. `Adapter` is the one behind a process that speaks adapter protocol 1.

A request, one answer, each within a time limit: a thread reads standard output and hands over whole lines,
another drains standard error; so an adapter that hangs, floods or never ends a line cannot hold us up. The
process is ended in every case, with what it started where the system allows it. No POSIX-only call is needed.
"""

from __future__ import annotations

import contextlib
import json
import os
import queue
import shlex
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import IO, Any, Protocol

from modeproof.kit.errors import Unjudged
from modeproof.kit.signals import loads, shown

LONGEST_LINE = 1 << 20
"""Bytes of one answer; a longer line is refused while it is still coming in."""
SAFE_WRITE = 4000
"""Bytes that surely fit into an empty pipe; a longer request is guarded by a timer."""
GRACE_S = 0.2
"""How long an answer too many is waited for before a difference is believed."""
ENDING_S = 1.0
_TAIL = 2000
_ENCODE = json.JSONEncoder(separators=(",", ":")).encode
_END, _TOO_LONG = 1, 2
_WINDOWS = sys.platform == "win32"


class Program(Protocol):
    """A program to be judged, whatever lies between it and us: a process, a PLC over S7, a module in Python.

    Values are those of the wire (see `modeproof.kit`): words are four upper-case hex digits, booleans bool.
    The judge calls `hello` once, then for each case `reset` and some `scan`, and in any case `close`. Every
    method may raise `Unjudged` with one line that says what is wrong and what to do; nothing else. The judge
    adds case and scan. What `scan` returns is checked by the judge: types, missing and extra outputs.
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

    def __init__(self, command: str | Sequence[str], timeout_s: float = 10.0) -> None:
        self.command = split_command(command) if isinstance(command, str) else list(command)
        if not self.command:
            raise Unjudged("--adapter: the command is empty")
        self.timeout_s = timeout_s
        self._lines: queue.SimpleQueue[bytes | int] = queue.SimpleQueue()
        self._stderr = b""
        self._hung = False
        group: dict[str, Any] = {} if _WINDOWS else {"start_new_session": True}
        try:
            self.process = subprocess.Popen(
                self.command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                bufsize=0,
                **group,
            )
        except (OSError, ValueError) as error:
            cause = getattr(error, "strerror", None) or error
            raise Unjudged(f"the adapter cannot be started: {self.command[0]}: {cause}") from None
        if self.process.stdin is None or self.process.stdout is None or self.process.stderr is None:
            raise Unjudged("the adapter has no pipes")
        self._stdin: IO[bytes] = self.process.stdin
        self._readers = [
            (
                threading.Thread(target=self._read_answers, args=(self.process.stdout,), daemon=True),
                self.process.stdout,
            ),
            (
                threading.Thread(target=self._drain, args=(self.process.stderr,), daemon=True),
                self.process.stderr,
            ),
        ]
        for thread, _ in self._readers:
            thread.start()

    # ------------------------------------------------------------------------------------------- threads

    def _read_answers(self, stream: Any) -> None:
        rest = b""
        put = self._lines.put
        with contextlib.suppress(OSError, ValueError):
            while chunk := os.read(stream.fileno(), 65536):
                rest += chunk
                if b"\n" in chunk:
                    *lines, rest = rest.split(b"\n")
                    for line in lines:
                        put(line)
                if len(rest) > LONGEST_LINE:
                    put(_TOO_LONG)
                    rest = b""
                    break
        if rest:
            put(rest)
        put(_END)
        with contextlib.suppress(OSError, ValueError):  # keep the pipe empty until it is closed
            while os.read(stream.fileno(), 65536):
                pass

    def _drain(self, stream: Any) -> None:
        with contextlib.suppress(OSError, ValueError):
            while chunk := os.read(stream.fileno(), 65536):
                self._stderr = (self._stderr + chunk)[-_TAIL:]

    # ------------------------------------------------------------------------------------------- program

    def hello(self, target: str) -> Mapping[str, Any]:
        """The answer to hello."""
        return parse_answer(self.ask({"op": "hello", "protocol": 1, "target": target}))

    def reset(self, params: Mapping[str, Any]) -> None:
        """Reset; any answer but {"ok":true} is refused."""
        answer = parse_answer(self.ask({"op": "reset", "params": params}))
        if answer != {"ok": True}:
            raise Unjudged(f"reset was answered with {shown(answer)}")

    def scan(self, dt_ms: int, inputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """The outputs after one scan."""
        answer = parse_answer(self.ask({"op": "scan", "dt_ms": dt_ms, "in": inputs}))
        out = answer.get("out")
        if set(answer) != {"out"} or not isinstance(out, dict):
            raise Unjudged(f'{{"out":{{..}}}} expected, got {shown(answer)}')
        return out

    # ------------------------------------------------------------------------------------------ requests

    def ask(self, request: Mapping[str, Any]) -> bytes:
        """Send a request and return the line that answers it."""
        return self.ask_line(_ENCODE(request).encode() + b"\n")

    def ask_line(self, line: bytes) -> bytes:
        """As `ask`, for a line that is ready to be sent."""
        if not self._lines.empty():
            self._refuse_stray(self._lines.get())
        self._send(line)
        try:
            answer = self._lines.get(timeout=self.timeout_s)
        except queue.Empty:
            raise Unjudged(f"no answer within {self.timeout_s:g} s") from None
        if isinstance(answer, bytes):
            if len(answer) > LONGEST_LINE:
                raise Unjudged(f"an answer longer than {LONGEST_LINE} bytes")
            return answer
        if answer == _TOO_LONG:
            raise Unjudged(f"an answer longer than {LONGEST_LINE} bytes")
        raise Unjudged(self._how_it_ended())

    def _send(self, line: bytes) -> None:
        guard = None
        if len(line) > SAFE_WRITE:
            guard = threading.Timer(self.timeout_s, self._give_up)
            guard.daemon = True
            guard.start()
        try:
            sent = 0
            while sent < len(line):
                sent += self._stdin.write(line[sent:]) or 0
        except (OSError, ValueError):
            if self._hung:
                raise Unjudged(f"a request was not read within {self.timeout_s:g} s") from None
            raise Unjudged(self._how_it_ended()) from None
        finally:
            if guard is not None:
                guard.cancel()

    def _give_up(self) -> None:
        self._hung = True
        self._kill()

    def _refuse_stray(self, found: bytes | int) -> None:
        if isinstance(found, bytes):
            raise Unjudged(f"a line that nobody asked for: {_printable(found)}")
        if found == _TOO_LONG:
            raise Unjudged(f"a line longer than {LONGEST_LINE} bytes that nobody asked for")
        raise Unjudged(self._how_it_ended())

    def quiet(self) -> None:
        """Wait a moment and raise Unjudged if one more line comes: an answer too many."""
        try:
            found = self._lines.get(timeout=GRACE_S)
        except queue.Empty:
            return
        self._refuse_stray(found)

    def bye(self) -> None:
        """Say goodbye; whatever follows the answer is refused."""
        answer = parse_answer(self.ask({"op": "bye"}))
        if answer != {"ok": True}:
            raise Unjudged(f"bye was answered with {shown(answer)}")
        with contextlib.suppress(OSError):
            self._stdin.close()
        try:
            found = self._lines.get(timeout=ENDING_S)
        except queue.Empty:
            return
        if found != _END:
            self._refuse_stray(found)

    # -------------------------------------------------------------------------------------------- ending

    def _how_it_ended(self) -> str:
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(timeout=ENDING_S)
        status = self.process.poll()
        how = "the adapter closed its output" if status is None else f"the adapter ended with status {status}"
        time.sleep(0.05)  # for the last words on standard error
        words = self._stderr.decode("utf-8", "replace").strip().splitlines()
        return f"{how}; it said: {words[-1][:200]}" if words else how

    def _kill(self) -> None:
        with contextlib.suppress(OSError):
            if sys.platform == "win32":
                subprocess.run(
                    ["taskkill", "/T", "/F", "/PID", str(self.process.pid)], capture_output=True, check=False
                )
            else:
                os.killpg(self.process.pid, signal.SIGKILL)
        with contextlib.suppress(OSError):
            self.process.kill()

    def close(self) -> None:
        """End the process, whatever it is doing."""
        with contextlib.suppress(OSError):
            self._stdin.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(timeout=0.0 if self._hung else GRACE_S)
        self._kill()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(timeout=ENDING_S)
        for thread, stream in self._readers:
            thread.join(GRACE_S)
            if (
                not thread.is_alive()
            ):  # else a child that escaped still holds the pipe; leave it to the system
                stream.close()

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
        raise Unjudged(f"not a line of JSON ({str(error)[:80]}): {_printable(line)}") from None
    if not isinstance(answer, dict):
        raise Unjudged(f"not a JSON object: {_printable(line)}")
    if "error" in answer:
        raise Unjudged(f"refused: {shown(answer['error'], 200)}")
    return answer


def split_command(command: str) -> list[str]:
    """The words of a command line as this system writes it; no shell is used."""
    try:
        words = shlex.split(command, posix=not _WINDOWS)
    except ValueError as error:
        raise Unjudged(f"--adapter: {error}: {command}") from None
    return [word.strip('"') for word in words] if _WINDOWS else words


def _printable(line: bytes, limit: int = 80) -> str:
    return repr(line[:limit].decode("utf-8", "replace")) + ("..." if len(line) > limit else "")
