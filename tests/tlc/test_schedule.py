"""Runs share cores and memory, the longest starts first, and a failure stops what has not begun."""

from __future__ import annotations

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from modeproof.tlc.check import SMALL_SHARE
from modeproof.tlc.schedule import Job, fits, memory_mb, order, run_all

jobs = st.lists(
    st.builds(
        Job,
        name=st.just("job"),
        cores=st.integers(1, 4),
        memory_mb=st.integers(1, 4000),
        seconds=st.floats(0, 100),
    ),
    max_size=6,
)


@given(jobs, st.integers(1, 4), st.integers(1, 6000))
def test_cores_and_memory_are_never_overdrawn(all_jobs: list[Job], cores: int, memory: int) -> None:
    running: list[Job] = []
    guard = threading.Lock()
    crowds: list[list[Job]] = []

    def work(index: int) -> int:
        with guard:
            running.append(all_jobs[index])
            crowds.append(list(running))
        with guard:
            running.remove(all_jobs[index])
        return index

    assert run_all(all_jobs, work, cores, memory) == list(range(len(all_jobs)))
    for crowd in crowds:
        assert len(crowd) == 1 or sum(min(job.cores, cores) for job in crowd) <= cores
        assert len(crowd) == 1 or sum(job.memory_mb for job in crowd) <= memory


def test_a_job_that_is_too_big_runs_alone() -> None:
    big, small = Job("big", 8, 9000, 1), Job("small", 1, 100, 1)
    assert fits(big, [], 2, 4000)
    assert not fits(big, [small], 2, 4000)
    assert not fits(small, [big], 2, 4000)
    assert fits(small, [small], 2, 4000)


def test_three_small_runs_share_two_cores_beside_a_big_one() -> None:
    small, big = Job("small", SMALL_SHARE, 100, 1), Job("big", 1, 100, 9)
    assert fits(small, [small, small], 2, 4000)
    assert not fits(small, [small, small, small], 2, 4000)
    assert fits(small, [big], 2, 4000) and not fits(small, [big, small], 2, 4000)
    assert fits(small, [], 1, 4000) and not fits(small, [small], 1, 4000)


def test_the_longest_job_starts_first() -> None:
    assert order([Job("a", 1, 1, 2), Job("b", 1, 1, 9), Job("c", 1, 1, 2)]) == [1, 0, 2]


def test_a_failing_job_is_raised_and_waiting_ones_never_start() -> None:
    begun: list[int] = []

    def work(index: int) -> None:
        begun.append(index)
        raise ValueError(f"job {index}")

    with pytest.raises(ValueError, match="job 0"):
        run_all([Job("a", 1, 1, 9), Job("b", 1, 1, 1)], work, 1, 100)
    assert begun == [0]


def test_the_memory_for_java_can_be_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MODEPROOF_HEAP_MB", "700")
    assert memory_mb() == 700
    monkeypatch.setenv("MODEPROOF_HEAP_MB", "much")
    assert 1024 <= memory_mb() <= 5120
