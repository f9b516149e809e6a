"""Two runs in one checkout never collide, and a lock left behind never blocks."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from modeproof.ground.errors import Unjudged
from modeproof.ground.lock import only_one
from tests.anywhere.test_no_posix import windows

HOLD = """
import sys, time
from pathlib import Path
from modeproof.ground.lock import only_one
with only_one(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600)
"""


def hold(place: Path, **environment: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", HOLD, str(place)]
    given = os.environ | environment
    holder = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=given)
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


def test_what_may_wait_begins_when_the_first_is_done(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    holder = hold(tmp_path)
    threading.Timer(0.3, holder.kill).start()
    with only_one(tmp_path, wait_for="this log"):
        assert (tmp_path / "build/modeproof.lock").read_text() == f"{os.getpid()}\n"
    assert f"(pid {holder.pid}, " in (said := capsys.readouterr().err)
    assert said.endswith("; this log begins when it is done\n")
    holder.communicate()


def test_the_lock_of_windows_refuses_a_second_run(tmp_path: Path) -> None:
    holder = hold(tmp_path, **windows())
    try:
        script = HOLD.replace("print", "raise SystemExit")
        done = subprocess.run(
            [sys.executable, "-c", script, str(tmp_path)],
            env=os.environ | windows(),
            capture_output=True,
            text=True,
            check=False,
        )
        assert f"another modeproof is running here (pid {holder.pid}," in done.stderr
    finally:
        holder.kill()
        holder.communicate()
