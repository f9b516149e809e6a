"""Says on standard error what is going on: one line that is rewritten on a terminal, a line now and then
elsewhere.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator, Sequence
from typing import TextIO, TypeVar

from modeproof.kit.text import left

T = TypeVar("T")
QUIET_SECONDS = 10.0
"""Elsewhere than on a terminal a running task says a word this often."""


class Progress:
    """The state of all running tasks; may be used from several threads."""

    def __init__(self, stream: TextIO | None = None, quiet: bool = False) -> None:
        self._stream = sys.stderr if stream is None else stream
        self._quiet = quiet
        self._terminal = self._stream.isatty()
        self._tasks: dict[str, tuple[float, str]] = {}
        self._marks: dict[str, tuple[float, float]] = {}
        """When each task first said how much of it was done, and how much: starting up takes a while."""
        self._last = time.monotonic()
        self._width = 0
        self._guard = threading.Lock()
        self._total = 0
        self._done = 0

    def expect(self, tasks: int) -> None:
        """So many more tasks are to come."""
        with self._guard:
            self._total += tasks

    def begin(self, name: str) -> None:
        """A task starts."""
        with self._guard:
            self._tasks[name] = (time.monotonic(), "")
            self._show()

    def update(self, name: str, text: str, share: float = 0.0) -> None:
        """A running task has something to say, such as counts so far, and how much of it is done (0 to 1)."""
        with self._guard:
            now = time.monotonic()
            began, _ = self._tasks.get(name, (now, ""))
            since, done = self._marks.setdefault(name, (now, share)) if share else (now, 0.0)
            rest = left(now - since, (share - done) / (1 - done)) if done < share < 1 else ""
            self._tasks[name] = (began, text + rest)
            self._show()

    def end(self, name: str) -> None:
        """A task is over."""
        with self._guard:
            self._tasks.pop(name, None)
            self._marks.pop(name, None)
            self._done += 1
            self._wipe()

    def over(self, name: str, items: Sequence[T]) -> Iterator[T]:
        """The items one by one, as one task that says how many are done and how long the others may take."""
        self.expect(1)
        self.begin(name)
        try:
            for number, item in enumerate(items):
                self.update(name, f"{number} of {len(items)}", number / len(items))
                yield item
        finally:
            self.end(name)

    def tick(self) -> None:
        """Time goes on: show the seconds."""
        with self._guard:
            self._show()

    def say(self, line: str) -> None:
        """Print one line on standard output, above the progress line."""
        with self._guard:
            self._wipe()
            print(line, flush=True)

    def _wipe(self) -> None:
        if self._terminal and self._width:
            self._stream.write("\r" + " " * self._width + "\r")
            self._stream.flush()
            self._width = 0

    def _show(self) -> None:
        if self._quiet or not self._tasks:
            return
        now = time.monotonic()
        if not self._terminal and now - self._last < QUIET_SECONDS:
            return
        parts = [
            f"{name} {now - began:.0f} s{', ' if text else ''}{text}"
            for name, (began, text) in self._tasks.items()
        ]
        line = f"[{self._done}/{self._total}] " + " | ".join(parts)
        self._last = now
        if self._terminal:
            line = line[:150]
            self._stream.write("\r" + line + " " * max(0, self._width - len(line)))
            self._width = len(line)
        else:
            self._stream.write(line + "\n")
        self._stream.flush()
