"""Ctrl-C ends a command with one line and status 2, whatever it is doing; no solver takes it for itself."""

from __future__ import annotations

import contextlib
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from modeproof.cli import main
from modeproof.ground.places import TREE
from tests.any_machine import until

pytestmark = pytest.mark.usefixtures("deaf")

LIMIT_S = 40
HARD = """
from modeproof.ground.solvers import needing_solvers
with needing_solvers():
    import proofs.theorem
import z3
# here
first, second = z3.BitVecs("first second", 128)
solver = z3.SolverFor("QF_BV")
solver.set("timeout", 40000)
solver.add(first * second == 2**89 - 1, z3.ULT(first, 2**64), z3.ULT(second, 2**64), first != 1, second != 1)
print("at work", flush=True)
print("went on:", solver.check())
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A tree of its own, so that nobody else holds its lock."""
    place = tmp_path_factory.mktemp("copy")
    for room in ("spec/edm", "spec/common", "refimpl", "proofs", "examples/adapters", "vectors/sf_edm"):
        shutil.copytree(TREE / room, place / room, ignore=shutil.ignore_patterns("__pycache__"))
    (place / "modeproof").symlink_to(TREE / "modeproof")
    shutil.copyfile(TREE / "vectors/SHA256SUMS", place / "vectors/SHA256SUMS")
    (place / "log.jsonl").write_text('{"dt_ms":10,"out":{"Ready":false}}\n')
    return place


def interrupted(place: Path, command: list[str], after_s: float) -> tuple[int, str, str]:
    """Exit status, output and errors of a command that gets Ctrl-C so long after its first line."""
    pipe = subprocess.PIPE
    running = subprocess.Popen(
        command,
        cwd=place,
        env={**os.environ, "MODEPROOF_ROOT": str(place)},
        stdout=pipe,
        stderr=pipe,
        text=True,
        start_new_session=True,
    )
    assert running.stdout is not None
    first = running.stdout.readline()
    time.sleep(after_s)
    running.send_signal(signal.SIGINT)
    out, err = running.communicate(timeout=60)
    return running.returncode, first + out, err


@pytest.mark.parametrize("swallows", [False, True])
def test_z3_takes_no_interrupt_for_itself(swallows: bool) -> None:
    text = HARD.replace("# here", 'z3.set_param("ctrl_c", True)' if swallows else "")
    began = time.monotonic()
    status, out, err = interrupted(TREE, [sys.executable, "-c", text], 0.5)
    assert ("went on: unknown" in out) == swallows, err
    assert ("KeyboardInterrupt" in err) != swallows and (status == 0) == swallows
    assert time.monotonic() - began < LIMIT_S


class Deleted:
    """What Ctrl-C meets while it is being deleted: Python prints the exception and drops it."""

    def __del__(self) -> None:
        raise KeyboardInterrupt


def test_an_interrupt_during_a_deletion_is_not_dropped(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def work() -> Path:
        Deleted()
        for _ in range(100):
            time.sleep(0.01)
        return TREE

    monkeypatch.setattr("modeproof.cli.root", work)
    assert main(["check", "--list"]) == 2
    assert capsys.readouterr() == (
        "",
        "modeproof: interrupted: no verdict; what was finished before is kept\n",
    )


def test_an_interrupt_that_a_library_catches_still_counts(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def work() -> Path:
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        return TREE

    monkeypatch.setattr("modeproof.cli.root", work)
    assert main(["check", "--list"]) == 2
    assert capsys.readouterr().err == SAID


@pytest.mark.deep
@pytest.mark.parametrize("moment", range(8))
def test_interrupted_proofs_end_with_one_line(copy: Path, moment: int) -> None:
    prove = ["prove", "--document", "edm", "--quiet"]  # all theorems: far longer than any moment here
    status, _, err = interrupted(copy, [sys.executable, "-m", "modeproof", *prove], 0.2 * moment)
    assert (status, err) == (2, "modeproof: interrupted: no verdict; what was finished before is kept\n")


def lives(place: Path) -> list[str]:
    """The processes that work on a tree."""
    found = subprocess.run(["ps", "-wweo", "args"], capture_output=True, text=True, check=True).stdout
    return [line for line in found.splitlines() if str(place) in line]


def left_over(place: Path) -> list[str]:
    """Files and folders that are there for a while only."""
    return [path.name for path in (place / "build").rglob("*") if re.search(r"\.[a-z0-9_]{8}$", path.name)]


SAID = "modeproof: interrupted: no verdict; what was finished before is kept\n"
CONFORM = ["conform", "sf_edm", "--suite", "soak", "--jobs", "2", "--quiet", "--adapter"]
TRACE = ["trace", "sf_edm", "log.jsonl", "--quiet"]


@pytest.mark.parametrize(
    ("command", "after_s"),
    [
        pytest.param(CONFORM, 1.5),
        *(pytest.param(CONFORM, after, marks=pytest.mark.deep) for after in (0.0, 0.5, 2.5)),
        *(pytest.param(TRACE, after, marks=pytest.mark.deep) for after in (0.0, 0.4, 0.8, 1.2)),
        *(pytest.param(["report"], after, marks=pytest.mark.deep) for after in (0.0, 0.4, 0.8)),
    ],
)
def test_an_interrupt_leaves_files_and_children_clean(copy: Path, command: list[str], after_s: float) -> None:
    adapter = [f"'{sys.executable}' '{copy}/examples/adapters/refimpl_adapter.py' sf_edm"]
    whole = [*command, *(adapter if command is CONFORM else [])]
    status, out, err = interrupted(copy, [sys.executable, "-m", "modeproof", *whole], after_s)
    assert status == 2 and (err.endswith(SAID) or "UNJUDGED: interrupted after " in out), err
    assert "Traceback" not in err + out
    until(lambda: not lives(copy), "the end of all that it has started")
    assert not left_over(copy) and not (copy / "build/yours").exists()


@pytest.mark.deep
def test_an_interrupt_wipes_the_line_of_progress(copy: Path) -> None:
    ours, theirs = pty.openpty()
    words = ["prove", "--document", "edm"]
    running = subprocess.Popen(
        [sys.executable, "-m", "modeproof", *words],
        cwd=copy, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True,
    )  # fmt: skip
    os.close(theirs)
    said, sent = b"", False
    with contextlib.suppress(OSError):  # at its end
        while chunk := os.read(ours, 4096):
            said += chunk
            if not sent and b"] proofs" in said:
                sent = True
                running.send_signal(signal.SIGINT)
    assert running.wait(timeout=60) == 2
    last = said.decode().replace("\r\n", "\n").rstrip("\n").rsplit("\n", 1)[-1]
    assert re.split(r"\r\x1b\[K|\r", last)[-1] + "\n" == SAID and b"\x1b[?" not in said


def test_the_end_of_a_copy_leaves_its_parent_alone() -> None:
    """A worker out of time is ended before it has handlers of its own: it writes into our pipe."""
    text = """
import os, signal, sys, time
from modeproof.ground.solvers import needing_solvers
with needing_solvers():
    import proofs.theorem
import z3
signal.signal(signal.SIGTERM, lambda *_: None)
child = os.fork()
if not child:
    time.sleep(0.3)
    os._exit(0)
time.sleep(0.1)
os.kill(child, signal.SIGTERM)
os.waitpid(child, 0)
time.sleep(0.2)
x = z3.Int("x")
print(z3.simplify(z3.substitute(z3.And(x + 3 > 4, x < 9), (x, z3.IntVal(5)))))
"""
    found = subprocess.run([sys.executable, "-c", text], cwd=TREE, capture_output=True, text=True, check=True)
    assert found.stdout == "True\n"


def test_a_signal_that_ends_nothing_ends_no_query() -> None:
    """A timer, say, or the end of a child: whatever has a handler is told to the same pipe."""
    text = """
import signal, time
from modeproof.ground.solvers import needing_solvers
with needing_solvers():
    import proofs.theorem
import z3
signal.signal(signal.SIGUSR1, lambda *_: None)
signal.raise_signal(signal.SIGUSR1)
time.sleep(0.2)
x = z3.Int("x")
print(z3.simplify(z3.substitute(z3.And(x + 3 > 4, x < 9), (x, z3.IntVal(5)))))
"""
    found = subprocess.run([sys.executable, "-c", text], cwd=TREE, capture_output=True, text=True, check=True)
    assert found.stdout == "True\n"
