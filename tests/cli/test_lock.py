"""Two runs in one checkout never collide, and a lock left behind never blocks."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.lock import only_one

HOLD = """
import sys, time
from pathlib import Path
from modeproof.ground.lock import only_one
with only_one(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600)
"""


def hold(place: Path) -> subprocess.Popen[str]:
    holder = subprocess.Popen([sys.executable, "-c", HOLD, str(place)], stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None and holder.stdout.readline() == "held\n"
    return holder


def test_a_second_run_is_refused_with_the_first_pid(tmp_path: Path) -> None:
    holder = hold(tmp_path)
    try:
        words = rf"another modeproof is running here \(pid {holder.pid},"
        with pytest.raises(Unjudged, match=words), only_one(tmp_path):
            pass
    finally:
        holder.kill()
        holder.communicate()


def test_the_lock_of_a_killed_run_is_recovered(tmp_path: Path) -> None:
    holder = hold(tmp_path)
    os.kill(holder.pid, signal.SIGKILL)
    holder.communicate()
    assert (tmp_path / "build/modeproof.lock").read_text() == f"{holder.pid}\n"
    with only_one(tmp_path):
        assert (tmp_path / "build/modeproof.lock").read_text() == f"{os.getpid()}\n"


def test_a_stale_file_with_garbage_is_no_lock(tmp_path: Path) -> None:
    (tmp_path / "build").mkdir()
    (tmp_path / "build/modeproof.lock").write_text("999999999 or so\n")
    for _ in range(2):
        with only_one(tmp_path):
            pass
