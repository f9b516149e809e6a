"""Ctrl-C ends a command with one line and status 2, whatever it is doing; no solver takes it for itself."""

from __future__ import annotations

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

LIMIT_S = 40
HARD = """
from modeproof.ground.proofs import proofs_module
proofs_module("proofs.theorem")
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
    for room in ("spec/edm", "spec/common", "refimpl", "proofs"):
        shutil.copytree(TREE / room, place / room, ignore=shutil.ignore_patterns("__pycache__"))
    (place / "modeproof").symlink_to(TREE / "modeproof")
    return place


def interrupted(place: Path, command: list[str], after_s: float) -> tuple[int, str, str]:
    """Exit status, output and errors of a command that gets Ctrl-C so long after its first line."""
    pipe = subprocess.PIPE
    running = subprocess.Popen(
        command, cwd=place, stdout=pipe, stderr=pipe, text=True, start_new_session=True
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


@pytest.mark.deep
@pytest.mark.parametrize("moment", range(8))
def test_interrupted_proofs_end_with_one_line(copy: Path, moment: int) -> None:
    prove = ["prove", "--document", "edm", "--quiet"]  # all theorems: far longer than any moment here
    status, out, err = interrupted(copy, [sys.executable, "-m", "modeproof", *prove], 0.2 * moment)
    assert (status, err) == (2, "modeproof: interrupted: no verdict; what was finished before is kept\n")
    assert not re.search(r"^proofs ", out, re.MULTILINE)
