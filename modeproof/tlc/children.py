"""Starts processes, each in a group of its own. They all end when we end, however we end.

Ctrl-C, SIGTERM and every exception pass through `stop_all`. Against SIGKILL, which no program can catch, a
watcher holds the reading end of a pipe of which only we hold the other: when that is closed, it kills what is
left.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from modeproof.ground.places import TREE
from modeproof.kit.process_group import APART, end_all

_WATCHER = """
import sys
sys.path.insert(0, sys.argv[1])
from modeproof.kit.process_group import end_all
groups = set()
for line in sys.stdin:
    word, group = line.split()
    (groups.add if word == "+" else groups.discard)(int(group))
for group in groups:
    end_all(group)
"""

_RUNNING: dict[int, subprocess.Popen[bytes]] = {}
_ROOMS: set[Path] = set()
_GUARD = threading.RLock()
_watcher: subprocess.Popen[bytes] | None = None
_pipe: int | None = None


def _tell(word: str, group: int) -> None:
    """Tell the watcher, and start it if needed. It is a second safeguard, so we go on without it."""
    with contextlib.suppress(OSError):
        if _watcher is None or _watcher.poll() is not None:
            _start_watcher()
        _say(word, group)


def _start_watcher() -> None:
    global _watcher, _pipe
    if _pipe is not None:
        os.close(_pipe)
        _pipe = None
    reading, _pipe = os.pipe()
    try:
        _watcher = subprocess.Popen(
            [sys.executable, "-I", "-S", "-c", _WATCHER, str(TREE)],
            stdin=reading,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            **APART,
        )
    finally:
        os.close(reading)
    for other in _RUNNING:
        _say("+", other)


def _say(word: str, group: int) -> None:
    if _pipe is not None:
        os.write(_pipe, f"{word} {group}\n".encode())


@atexit.register
def _dismiss_watcher() -> None:
    if _watcher is not None and _pipe is not None:
        os.close(_pipe)
        with contextlib.suppress(subprocess.TimeoutExpired):
            _watcher.wait(timeout=5)


def start(
    command: list[str], folder: Path, stdout: IO[bytes] | int, stderr: IO[bytes] | int
) -> subprocess.Popen[bytes]:
    """Start a program in a group of its own, without input. Raises OSError when it cannot be started."""
    with _GUARD:
        process = subprocess.Popen(
            command,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=stdout,
            stderr=stderr,
            bufsize=1 << 20,
            **APART,
        )
        _RUNNING[process.pid] = process
        _tell("+", process.pid)
    return process


def kill(process: subprocess.Popen[bytes]) -> None:
    """Kill a program and all that it has started; not an error when it has ended."""
    end_all(process.pid)
    with contextlib.suppress(OSError):
        process.kill()


def end(process: subprocess.Popen[bytes]) -> int:
    """Kill what is left of a program, wait for it, forget it; returns its exit status."""
    kill(process)
    status = process.wait()
    if process.stdout is not None:
        process.stdout.close()
    with _GUARD:
        if _RUNNING.pop(process.pid, None) is not None:
            _tell("-", process.pid)
    return status


def running() -> tuple[int, ...]:
    """The process groups that were started and have not been ended."""
    with _GUARD:
        return tuple(_RUNNING)


def stop_all() -> None:
    """Kill everything that was started, and remove the rooms; for Ctrl-C and for the end of the program."""
    with _GUARD:
        for process in list(_RUNNING.values()):
            kill(process)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(timeout=5)
    for room in list(_ROOMS):
        shutil.rmtree(room, ignore_errors=True)


@contextlib.contextmanager
def room(prefix: str, folder: Path) -> Iterator[Path]:
    """A folder of its own for a program while it runs. Raises OSError when it cannot be made."""
    place = Path(tempfile.mkdtemp(prefix=prefix, dir=folder))
    _ROOMS.add(place)
    try:
        yield place
    finally:
        shutil.rmtree(place, ignore_errors=True)
        _ROOMS.discard(place)
