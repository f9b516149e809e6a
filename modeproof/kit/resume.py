"""A note of the cases that passed, so that a run which was interrupted goes on where it was."""

from __future__ import annotations

import hashlib
import json
import threading
import time
from pathlib import Path
from typing import Any

from modeproof.kit.errors import Unjudged
from modeproof.kit.text import write_json
from modeproof.kit.vectors import Suite

KIND = "modeproof-resume"
EVERY_S = 2.0


class Resume:
    """The note in one file. `done` are the numbers of the cases that passed, `note` is told of one more.

    Raises Unjudged where the file is of another run: other vectors, another program, relation or choice of
    outputs. Remove it to begin anew.
    """

    def __init__(self, path: Path, suite: Suite, program: str, relation: str, codes: bool = False) -> None:
        self.path = path
        self._about = {
            "kind": KIND,
            "target": suite.target,
            "suite": suite.name,
            "vectors": hashlib.sha256(json.dumps(suite.header).encode()).hexdigest(),
            "program": program,
            "relation": relation,
            "codes": codes,
        }
        self.done: set[int] = set()
        self._lock = threading.Lock()
        self._written = time.monotonic()
        if path.is_file():
            self.done = self._read()

    def _read(self) -> set[int]:
        try:
            row: dict[str, Any] = json.loads(self.path.read_text(encoding="utf-8"))
            spans = [(int(first), int(last)) for first, last in row["passed"]]
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise Unjudged(f"{self.path}: not a note of a run: {type(error).__name__} {error}") from None
        for name, value in self._about.items():
            if row.get(name) != value:
                raise Unjudged(f"{self.path}: the note is of another run ({name} {row.get(name)}); remove it")
        return {n for first, last in spans for n in range(first, last + 1)}

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
