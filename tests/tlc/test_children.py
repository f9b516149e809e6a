"""What we start ends with us, however we end."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from modeproof.tlc import children
from tests.any_machine import until
from tests.toy_tree import toy_tree

SLEEPER = [sys.executable, "-c", "import time; time.sleep(600)"]


def alive(group: int) -> bool:
    listed = subprocess.run(["ps", "-eo", "pgid,stat"], capture_output=True, text=True, check=True).stdout
    return any(int(row.split()[0]) == group and "Z" not in row.split()[1] for row in listed.splitlines()[1:])


def test_what_was_ended_is_forgotten(tmp_path: Path) -> None:
    with (tmp_path / "out").open("wb") as out:
        process = children.start(SLEEPER, tmp_path, out, out)
        assert process.pid in children.running() and alive(process.pid)
        assert children.end(process) == -signal.SIGKILL
    assert process.pid not in children.running() and not alive(process.pid)


def test_a_watcher_that_was_killed_is_started_again(tmp_path: Path) -> None:
    with (tmp_path / "out").open("wb") as out:
        first = children.start(SLEEPER, tmp_path, out, out)
        watcher = children._watcher
        assert watcher is not None
        watcher.kill()
        watcher.wait()
        second = children.start(SLEEPER, tmp_path, out, out)
        assert children._watcher is not watcher
        children.stop_all()
        children.end(first)
        children.end(second)
    assert children.running() == ()


@pytest.mark.deep
def test_tlc_ends_when_modeproof_is_killed_by_sigkill(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_big")
    command = [sys.executable, "-m", "modeproof", "check", "MC_big", "--quiet"]
    running = subprocess.Popen(command, env={**os.environ, "MODEPROOF_ROOT": str(root)})
    groups: list[int] = []

    def begun() -> bool:
        listed = subprocess.run(
            ["ps", "-wweo", "pgid,args"], capture_output=True, text=True, check=True
        ).stdout
        rows = [row for row in listed.splitlines() if str(root) in row and "tlc2.TLC" in row]
        groups.extend(int(row.split()[0]) for row in rows)
        return bool(groups)

    until(begun, "TLC at work")
    assert alive(groups[0])
    running.kill()
    running.wait()
    until(lambda: not alive(groups[0]), "the end of TLC")
    left = list((root / "build/tlc/toy").glob("MC_big.*"))
    assert [path.suffix for path in left if path.is_file()] == [".log"]
    assert not (root / "build/evidence/toy/MC_big.json").exists()


def test_the_next_run_clears_what_a_killed_run_left(tmp_path: Path) -> None:
    root = toy_tree(tmp_path, "MC_toy")
    stale = root / "build/tlc/toy/MC_toy.abcd1234"
    (stale / "states").mkdir(parents=True)
    command = [sys.executable, "-m", "modeproof", "check", "MC_toy", "--quiet"]
    subprocess.run(command, env={**os.environ, "MODEPROOF_ROOT": str(root)}, check=True, capture_output=True)
    assert sorted(path.name for path in stale.parent.iterdir()) == ["MC_toy.log"]
