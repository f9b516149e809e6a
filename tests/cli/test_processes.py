"""Work in processes of its own: what they know, and that none is left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

from tests.any_machine import until

PROGRAM = """
import os, sys, time
from modeproof import processes
from modeproof.progress import Progress
processes.cores = lambda: 2
KNOWN = []

def known():
    return list(KNOWN)

def live(path):
    open(path, "w").write(str(os.getpid()))
    time.sleep(600)

if __name__ == "__main__":
    KNOWN.append("made before")
    tasks = [(live, (one,)) for one in sys.argv[2:]] or [(known, ())] * 3
    print(processes.in_processes("work", tasks, Progress(), lambda one: None, knowing=sys.argv[1] == "yes"))
"""


def _program(folder: Path) -> str:
    path = folder / "program.py"
    path.write_text(PROGRAM)
    return str(path)


def test_processes_know_what_was_made_before_only_when_that_is_asked_for(tmp_path: Path) -> None:
    def said(knowing: str) -> str:
        command = [sys.executable, _program(tmp_path), knowing]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    assert said("yes") == str([["made before"]] * 3)
    assert said("no") == str([[]] * 3)


def test_no_process_outlives_one_that_was_killed(tmp_path: Path) -> None:
    told = [tmp_path / "one", tmp_path / "two"]
    command = [sys.executable, _program(tmp_path), "yes", *map(str, told)]
    parent = subprocess.Popen(command, start_new_session=True)
    until(lambda: all(one.is_file() and bool(one.read_text()) for one in told), "the work of both")
    children = [int(one.read_text()) for one in told]
    assert all(_lives(one) for one in children)
    parent.send_signal(signal.SIGKILL)
    parent.wait()
    until(lambda: not any(_lives(one) for one in children), "the end of both")


def _lives(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    stat = Path(f"/proc/{process}/stat")
    return not stat.is_file() or stat.read_text().rsplit(")", 1)[1].split()[0] != "Z"
