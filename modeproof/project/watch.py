"""`judge --watch`: judges again what a saved file touches, until Ctrl-C."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from modeproof.ground.errors import EXIT_UNJUDGED, Unjudged
from modeproof.output.outcome import TOOL
from modeproof.project.basis import digest
from modeproof.project.file import Listed, Wrong
from modeproof.project.judging import Judged, Judging
from modeproof.project.table import line_of, status_of

EVERY_S = 0.3
Stamp = tuple[int, int] | None
"""When a file was last written, and its size; None: it is gone."""


class Watch:
    """What was found last, of which files.

    begin: reads the project file anew and chooses its entries; the files that they name must be there.
    """

    def __init__(
        self,
        begin: Callable[[], tuple[Judging, Sequence[Listed]]],
        judging: Judging,
        entries: Sequence[Listed],
    ) -> None:
        self.begin = begin
        self.judging, self.entries = judging, entries
        self.found: Sequence[Judged] = ()
        self.broken = False
        self.stamps: dict[Path, Stamp] = {}
        self.hashes: dict[Path, str | None] = {}
        self._look()

    def run(self, found: Sequence[Judged]) -> int:
        """Watch until Ctrl-C; the status of what was found last. found: before it begins."""
        self._take(found)
        over = threading.Event()
        with _until_interrupted(over, self):
            while not over.wait(EVERY_S):
                if not (changed := self._changed()):
                    continue
                try:
                    self.judging, self.entries = self.begin()
                    self._again(changed)
                    self.broken = False
                except (Wrong, Unjudged) as error:
                    if not over.is_set():
                        said = error.lines if isinstance(error, Wrong) else [error.message]
                        self._say(changed, "; ".join(said))
                        self.broken = True
        return EXIT_UNJUDGED if self.broken else status_of(self.found)

    def _again(self, changed: Sequence[Path]) -> None:
        started = time.monotonic()
        before = {one.entry.name for one in self.found}
        self._look()
        judged = self.judging.all(self.entries)
        anew = [one for one in judged if not one.kept or one.entry.name not in before]
        said = "; ".join(f"{one.entry.name} {line_of(one.outcome)}" for one in anew)
        self._say(changed, f"{said or 'nothing to judge again'}, {time.monotonic() - started:.1f} s")
        self._take(judged)

    def _look(self) -> None:
        """Note the files that the entries name as they are now, before they are judged."""
        folder = self.judging.folder
        files = {folder / name for entry in self.entries for name in self.judging.basis(entry).files}
        for path in (self.judging.project.path, *sorted(files)):
            self.stamps[path], self.hashes[path] = _stamp(path), digest(path)

    def _take(self, found: Sequence[Judged]) -> None:
        """Note what was found, and the files besides that were read for it, as they were then."""
        self.found = found
        for file in (file for one in found for file in one.outcome.files):
            path = self.judging.folder / file.path
            if path not in self.stamps and not file.path.startswith(TOOL):
                self.stamps[path], self.hashes[path] = None, file.sha256

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
def _until_interrupted(over: threading.Event, watch: Watch) -> Iterator[None]:
    """Ctrl-C ends the watch, and the commands that run; a second one is as anywhere else."""

    def stop(number: int, frame: Any) -> None:
        over.set()
        signal.signal(signal.SIGINT, before)
        threading.Thread(target=watch.judging.end).start()

    before = signal.signal(signal.SIGINT, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
