"""One modeproof at a time in a checkout: two would overwrite each other's evidence."""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Iterator
from pathlib import Path

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build


@contextlib.contextmanager
def only_one(place: Path) -> Iterator[None]:
    """Hold build/modeproof.lock while the body runs.

    The kernel drops the lock when its owner dies, so a stale file never blocks. Raises Unjudged, naming the
    pid, when another run holds it.
    """
    path = build(place) / "modeproof.lock"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as error:
        raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            owner = os.read(handle, 32).decode("ascii", "replace").strip() or "unknown"
            raise Unjudged(
                f"another modeproof is running here (pid {owner}, lock {path}); wait for it"
            ) from None
        try:
            os.ftruncate(handle, 0)
            os.pwrite(handle, f"{os.getpid()}\n".encode(), 0)
        except OSError as error:
            raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None
        for left in build(place).glob("evidence/*/.*.part"):  # of a run that was killed while it wrote
            left.unlink(missing_ok=True)
        yield
    finally:
        os.close(handle)
