"""How much memory the runs of a lane may take."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.ground.progress import Progress
from modeproof.tlc.check import check_all, select
from modeproof.tlc.schedule import ORDINARY_MB, memory_mb
from modeproof.tlc.toolchain import find_toolchain
from tests.toy_tree import toy_tree


def test_the_exhaustive_lane_may_use_the_memory_that_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("MODEPROOF_HEAP_MB", raising=False)
    monkeypatch.setattr("modeproof.tlc.schedule.machine_mb", lambda: 24 * 1024)
    assert (memory_mb(), memory_mb(exhaustive=True)) == (ORDINARY_MB, 23 * 1024)
    monkeypatch.setattr("modeproof.tlc.schedule.machine_mb", lambda: 4096)
    assert (memory_mb(), memory_mb(exhaustive=True)) == (3072, 3072)
    monkeypatch.setenv("MODEPROOF_HEAP_MB", "700")
    assert memory_mb(exhaustive=True) == 700


def test_a_heap_beyond_the_machines_memory_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root = toy_tree(tmp_path, "MC_toy", heap_mb=8192)
    monkeypatch.setattr("modeproof.tlc.check.machine_mb", lambda: 4096)
    (one,) = check_all(root, select(root), find_toolchain(), Progress(quiet=True))
    assert one.judgement.verdict == "UNJUDGED"
    assert one.judgement.reason == "toy/MC_toy: heap_mb = 8192, but this machine has 4096 MiB of memory"
