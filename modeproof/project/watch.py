"""`judge --watch`: judges again what a saved file touches, until Ctrl-C."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.project.basis import digest
from modeproof.project.file import Listed, Wrong
from modeproof.project.judging import Judged, Judging
from modeproof.project.table import about, status_of

EVERY_S = 0.3
Stamp = tuple[int, int] | None
"""When a file was last written, and its size; None: it is gone."""


class Watch:
    """What was found last, of which files.

    begin: reads the project file anew and chooses its entries; the files that they name must be there.
    """

    def __init__(
        self, begin: Callable[[], tuple[Judging, Sequence[Listed]]], found: Sequence[Judged]
    ) -> None:
        self.begin = begin
        self.found = {one.entry.name: one for one in found}
        self.broken = False
        self.stamps: dict[Path, Stamp] = {}
        self.hashes: dict[Path, str | None] = {}

    def run(self, judging: Judging, entries: Sequence[Listed]) -> int:
        """Watch until Ctrl-C; the status of what was found last."""
        self._look(judging, entries)
        over = threading.Event()
        with _until_interrupted(over, judging) as hold:
            while not over.is_set():
                over.wait(EVERY_S)
                changed = self._changed()
                if not changed or over.is_set():
                    continue
                try:
                    judging, entries = self.begin()
                    hold(judging)
                    self._again(judging, entries, changed)
                    self.broken = False
                except Wrong as error:
                    self._say(changed, "; ".join(error.lines))
                    self.broken = True
                except Unjudged as error:
                    if not over.is_set():
                        self._say(changed, error.message)
                        self.broken = True
        return 2 if self.broken else status_of(list(self.found.values()))

    def _again(self, judging: Judging, entries: Sequence[Listed], changed: Sequence[Path]) -> None:
        started = time.monotonic()
        before = self.found
        judged = judging.all(entries)
        self.found = {one.entry.name: one for one in judged}
        self._look(judging, entries)
        anew = [one for one in judged if not one.kept or one.entry.name not in before]
        said = ", ".join(f"{one.entry.name} {one.outcome.word} ({about(one.outcome)})" for one in anew)
        self._say(changed, f"{said or 'nothing to judge again'}, {time.monotonic() - started:.1f} s")

    def _look(self, judging: Judging, entries: Sequence[Listed]) -> None:
        folder = judging.folder
        files = {folder / name for entry in entries for name in judging.basis(entry).files}
        files |= {folder / file.path for one in self.found.values() for file in one.outcome.files}
        self.stamps = {path: _stamp(path) for path in (judging.project.path, *sorted(files))}
        self.hashes = {path: digest(path) for path in self.stamps}

    def _changed(self) -> list[Path]:
        """The files whose content is another; one that is gone too."""
        touched = [path for path, stamp in self.stamps.items() if _stamp(path) != stamp]
        changed = []
        for path in touched:
            self.stamps[path], now = _stamp(path), digest(path)
            if now != self.hashes[path]:
                self.hashes[path] = now
                changed.append(path)
        return changed

    def _say(self, changed: Sequence[Path], text: str) -> None:
        names = ", ".join(path.name for path in changed)
        print(f"{time.strftime('%H:%M:%S')}  {names}: {text}", flush=True)


def _stamp(path: Path) -> Stamp:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size


@contextmanager
def _until_interrupted(over: threading.Event, first: Judging) -> Iterator[Callable[[Judging], None]]:
    """Ctrl-C ends the watch, and the commands that run; a second one is as anywhere else."""
    now = [first]
    before: Mapping[int, Any] = {}

    def stop(number: int, frame: Any) -> None:
        over.set()
        signal.signal(signal.SIGINT, before[signal.SIGINT])
        threading.Thread(target=now[0].end).start()

    def hold(judging: Judging) -> None:
        now[0] = judging
        if over.is_set():
            judging.end()

    before = {signal.SIGINT: signal.signal(signal.SIGINT, stop)}
    try:
        yield hold
    finally:
        signal.signal(signal.SIGINT, before[signal.SIGINT])
