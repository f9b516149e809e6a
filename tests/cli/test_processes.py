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
from modeproof.ground import processes
from modeproof.ground.progress import Progress
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
    print(processes.in_processes("work", tasks, Progress(), lambda one: None, fork=sys.argv[1] == "yes"))
"""


def _program(folder: Path) -> str:
    path = folder / "program.py"
    path.write_text(PROGRAM)
    return str(path)


def test_processes_know_what_was_made_before_only_if_asked(tmp_path: Path) -> None:
    def said(fork: str) -> str:
        command = [sys.executable, _program(tmp_path), fork]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    assert said("yes") == str([["made before"]] * 3)
    assert said("no") == str([[]] * 3)


MEANWHILE = """
import os, sys, time
from modeproof.ground import processes
from modeproof.ground.errors import Unjudged
processes.cores = lambda: int(sys.argv[2])
KNOWN = ["made before"]

def known():
    return KNOWN[0], os.getpid() != PARENT

def slow():
    time.sleep(0.4)
    return "slow"

def fail():
    raise ValueError("the second one")

def die():
    os._exit(1)

PARENT = os.getpid()
TASKS = {"all": [known] * 3, "some": [known, slow, known], "fails": [known, fail], "dies": [known, die]}

def work():
    KNOWN[0] = "made meanwhile"
    time.sleep(0.2 if sys.argv[1] == "some" else 2.0)

if __name__ == "__main__":
    try:
        print(processes.meanwhile("work", [(one, ()) for one in TASKS[sys.argv[1]]], work), KNOWN)
    except (ValueError, Unjudged) as error:
        print(type(error).__name__, error)
"""


def _meanwhile(folder: Path, what: str, cores: int = 2) -> str:
    path = folder / "meanwhile.py"
    path.write_text(MEANWHILE)
    command = [sys.executable, str(path), what, str(cores)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def test_a_copy_does_the_first_tasks_while_this_process_works(tmp_path: Path) -> None:
    one = ("made before", True)
    assert _meanwhile(tmp_path, "all") == f"{[one] * 3} ['made meanwhile']"


def test_the_copy_ends_with_the_task_that_it_is_at(tmp_path: Path) -> None:
    assert _meanwhile(tmp_path, "some") == f"{[('made before', True), 'slow']} ['made meanwhile']"


def test_with_one_core_there_is_no_copy(tmp_path: Path) -> None:
    assert _meanwhile(tmp_path, "all", 1) == "[] ['made meanwhile']"


def test_what_goes_wrong_in_the_copy_is_raised_here(tmp_path: Path) -> None:
    assert _meanwhile(tmp_path, "fails") == "ValueError the second one"
    assert _meanwhile(tmp_path, "dies") == "Unjudged work: a process died"


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
