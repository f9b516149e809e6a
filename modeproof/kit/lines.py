"""Reads lines from a pipe, each within a time limit, and never more of one line than is allowed.

`PolledLines` asks the system whether something is there; it is the faster one, and not for Windows, where
pipes cannot be asked. `ThreadedLines` needs nothing but a thread, and does on every system. Both stop taking
bytes for lines after one that is too long.
"""

from __future__ import annotations

import contextlib
import os
import queue
import select
import sys
import threading
import time
from collections import deque
from typing import IO, Protocol

END, TOO_LONG = 1, 2
_CHUNK = 65536


class Lines(Protocol):
    """Lines as they come; END and TOO_LONG stand for the end and for a line that is longer than allowed."""

    def get(self, timeout_s: float) -> bytes | int | None:
        """The next line without its end, END or TOO_LONG; None when nothing came in time."""

    def waiting(self) -> bytes | int | None:
        """As `get`, for what is there already."""

    def close(self) -> None:
        """Let go of the pipe, if that is possible without waiting for whoever else holds it."""


class PolledLines:
    """For systems on which a pipe can be polled."""

    def __init__(self, stream: IO[bytes], longest: int) -> None:
        self._stream, self._longest = stream, longest
        self._fd = stream.fileno()
        self._poll = select.poll()
        self._poll.register(self._fd, select.POLLIN | select.POLLHUP)
        self._ready: deque[bytes | int] = deque()
        self._rest = b""
        self._ended = False

    def get(self, timeout_s: float) -> bytes | int | None:
        """See `Lines`."""
        if self._ready:
            return self._ready.popleft()
        if self._ended:
            return END
        due = 0.0
        left = timeout_s
        while True:
            if not self._poll.poll(left * 1000):
                return None
            self._take()
            if self._ready:
                return self._ready.popleft()
            now = time.monotonic()
            due = due or now + timeout_s
            left = max(0.0, due - now)
            if not left:
                return None

    def waiting(self) -> bytes | int | None:
        """See `Lines`."""
        if not self._ready and not self._ended and self._poll.poll(0):
            self._take()
        return self._ready.popleft() if self._ready else END if self._ended else None

    def _take(self) -> None:
        try:
            chunk = os.read(self._fd, _CHUNK)
        except OSError:
            chunk = b""
        if not chunk:
            self._ended = True
            if self._rest:
                self._ready.append(self._rest)
            self._ready.append(END)
            return
        if self._rest:
            chunk = self._rest + chunk
        *lines, self._rest = chunk.split(b"\n")
        self._ready.extend(lines)
        if len(self._rest) > self._longest:
            self._ended, self._rest = True, b""
            self._ready.append(TOO_LONG)

    def close(self) -> None:
        """See `Lines`."""
        self._ended = True
        with contextlib.suppress(OSError):
            self._stream.close()


class ThreadedLines:
    """For every system: a thread takes what comes, so that a writer is never held up."""

    def __init__(self, stream: IO[bytes], longest: int) -> None:
        self._stream, self._longest = stream, longest
        self._ready: queue.SimpleQueue[bytes | int] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def get(self, timeout_s: float) -> bytes | int | None:
        """See `Lines`."""
        try:
            return self._ready.get(timeout=timeout_s)
        except queue.Empty:
            return None

    def waiting(self) -> bytes | int | None:
        """See `Lines`."""
        try:
            return self._ready.get_nowait()
        except queue.Empty:
            return None

    def _read(self) -> None:
        rest = b""
        put = self._ready.put
        with contextlib.suppress(OSError, ValueError):
            while chunk := os.read(self._stream.fileno(), _CHUNK):
                *lines, rest = (rest + chunk).split(b"\n")
                for line in lines:
                    put(line)
                if len(rest) > self._longest:
                    put(TOO_LONG)
                    rest = b""
                    break
        if rest:
            put(rest)
        put(END)
        with contextlib.suppress(OSError, ValueError):  # keep the pipe empty until it is closed
            while os.read(self._stream.fileno(), _CHUNK):
                pass

    def close(self) -> None:
        """See `Lines`."""
        self._thread.join(0.2)
        if not self._thread.is_alive():  # else a child that escaped still holds the pipe
            with contextlib.suppress(OSError):
                self._stream.close()


def lines_of(stream: IO[bytes], longest: int) -> Lines:
    """The faster of the two that this system has."""
    if sys.platform == "win32" or not hasattr(select, "poll"):
        return ThreadedLines(stream, longest)
    return PolledLines(stream, longest)
