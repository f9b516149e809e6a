"""One run at a time where all runs write the same files: two would overwrite each other's evidence."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build

if sys.platform == "win32":
    import msvcrt

    _FAR = 1 << 30
    """A byte that nobody writes: on Windows a byte that is locked cannot be read, and others read the pid."""

    def _take(handle: int) -> None:
        os.lseek(handle, _FAR, os.SEEK_SET)
        msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _take(handle: int) -> None:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)


@contextlib.contextmanager
def only_one(place: Path, wait_for: str = "") -> Iterator[None]:
    """Hold build/modeproof.lock while the body runs.

    The system drops the lock when its owner dies, so a stale file never blocks. When another run holds it:
    wait, and say once on standard error for what (`wait_for`); without it raise Unjudged, naming the pid.
    """
    path = build(place) / "modeproof.lock"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as error:
        raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None
    try:
        _held(handle, path, wait_for)
        try:
            os.ftruncate(handle, 0)
            os.lseek(handle, 0, os.SEEK_SET)
            os.write(handle, f"{os.getpid()}\n".encode())
        except OSError as error:
            raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None
        for left in build(place).glob("evidence/*/.*.part"):  # of a run that was killed while it wrote
            left.unlink(missing_ok=True)
        yield
    finally:
        os.close(handle)


def _held(handle: int, path: Path, wait_for: str) -> None:
    said = False
    while True:
        try:
            _take(handle)
            return
        except (BlockingIOError, PermissionError):  # the latter is what Windows says
            os.lseek(handle, 0, os.SEEK_SET)
            owner = os.read(handle, 32).decode("ascii", "replace").strip() or "unknown"
            running = f"another modeproof is running here (pid {owner}, lock {path})"
            if not wait_for:
                raise Unjudged(f"{running}; wait for it") from None
        except OSError as error:
            raise Unjudged(f"{path}: cannot be locked: {error.strerror or error}") from None
        if not said:
            said = True
            print(f"modeproof: {running}; {wait_for} begins when it is done", file=sys.stderr, flush=True)
        time.sleep(0.1)
