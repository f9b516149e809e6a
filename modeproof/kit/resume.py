"""A note of the cases that passed, so that a run which was interrupted goes on where it was."""

from __future__ import annotations

import hashlib
import shutil
import threading
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from modeproof.kit.errors import Unjudged
from modeproof.kit.files import write_json
from modeproof.kit.hello import Hello
from modeproof.kit.signals import loads
from modeproof.kit.vectors import Suite, content_hash

KIND = "modeproof-resume"
EVERY_S = 2.0


def identity(words: Iterable[str]) -> dict[str, str]:
    """Hashes of all files that the words of a command name: what is executed, as far as it can be known."""
    found = {}
    for word in words:
        path = Path(shutil.which(word) or word)
        if path.is_file():
            found[word] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


class Resume:
    """The note in one file. `done` are the numbers of the cases that passed, `note` is told of one more.

    `about` is all that decides what passes: the program and the hashes of its files, and every option. Raises
    Unjudged where the file is of another run; remove it to begin anew.
    """

    def __init__(self, path: Path, suite: Suite, about: Mapping[str, Any]) -> None:
        self.path = path
        self._about: dict[str, Any] = {
            "kind": KIND,
            "target": suite.target,
            "suite": suite.name,
            "vectors": content_hash(suite),
            **about,
        }
        self.done: set[int] = set()
        self._lock = threading.Lock()
        self._written = time.monotonic()
        self._read: Mapping[str, Any] | None = None
        if path.is_file():
            try:
                row = self._read = dict(loads(path.read_text(encoding="utf-8")))
                spans = [(first, last) for first, last in row["passed"]]
                if not all(type(n) is int and 0 <= n < suite.case_count for span in spans for n in span):
                    raise ValueError("passed names cases that the suite does not have")
            except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
                raise Unjudged(f"{path}: not a note of a run: {type(error).__name__} {error}") from None
            self._compare(self._about)
            self.done = {n for first, last in spans for n in range(first, last + 1)}

    def _compare(self, about: Mapping[str, Any]) -> None:
        for name, value in about.items():
            if self._read is not None and self._read.get(name) != value:
                was = self._read.get(name)
                raise Unjudged(f"{self.path}: the note is of another run ({name} {was}); remove it")

    def hello(self, hello: Hello) -> None:
        """What the program says of itself. Raises Unjudged where the note is of one that said otherwise."""
        about = {"name": hello.name, "version": hello.version, "unobserved": list(hello.unobserved)}
        self._compare(about)
        self._about |= about

    def note(self, number: int) -> None:
        """A case passed; written now and then."""
        with self._lock:
            self.done.add(number)
            due = time.monotonic() - self._written > EVERY_S
        if due:
            self.write()

    def write(self) -> None:
        """Write the note."""
        with self._lock:
            spans: list[list[int]] = []
            for n in sorted(self.done):
                if spans and spans[-1][1] == n - 1:
                    spans[-1][1] = n
                else:
                    spans.append([n, n])
            self._written = time.monotonic()
            write_json(self.path, {**self._about, "passed": spans})
