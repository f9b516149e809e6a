"""Shares the machine's cores and memory between runs: longest first, never more than there is."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from modeproof.ground.evidence import machine

T = TypeVar("T")


@dataclass(frozen=True)
class Job:
    """One thing to run: how many cores and MiB it takes, and how long it may last in seconds.

    `cores` need not be whole: what waits now and then leaves a part of a core to others.
    """

    name: str
    cores: float
    memory_mb: int
    seconds: float


ORDINARY_MB = 5120
"""All heaps together have no more than this, so that the machine can be used for other things meanwhile."""


def machine_mb() -> int:
    """The machine's memory in MiB; 0 when it cannot be told."""
    return int(machine()["memory_mb"])


def memory_mb(exhaustive: bool = False) -> int:
    """Memory in MiB for all Java heaps together: MODEPROOF_HEAP_MB, else what the machine has less 1 GiB.

    Of that at most ORDINARY_MB, except where runs of the exhaustive lane are among them: these may be large,
    and take hours. A run that needs more than all of it is run alone.
    """
    named = os.environ.get("MODEPROOF_HEAP_MB", "")
    if named.isdigit() and int(named) > 0:
        return int(named)
    there = machine_mb() - 1024
    if there < 0:
        return ORDINARY_MB
    return max(1024, there if exhaustive else min(ORDINARY_MB, there))


def order(jobs: Sequence[Job]) -> list[int]:
    """Indices of the jobs, longest first; equal ones keep their order."""
    return sorted(range(len(jobs)), key=lambda i: -jobs[i].seconds)


def fits(job: Job, running: Sequence[Job], core_limit: int, memory_limit: int) -> bool:
    """Whether `job` may start beside the running ones. Alone it always may, however big it is."""
    if not running:
        return True
    used = sum(min(other.cores, core_limit) for other in running)
    memory = sum(other.memory_mb for other in running)
    return used + min(job.cores, core_limit) <= core_limit and memory + job.memory_mb <= memory_limit


class _Failure(Generic[T]):
    def __init__(self, error: BaseException) -> None:
        self.error = error


def run_all(
    jobs: Sequence[Job],
    work: Callable[[int], T],
    core_limit: int,
    memory_limit: int,
    tick: Callable[[], None] = lambda: None,
) -> list[T]:
    """Call `work(i)` for each job, as many at once as fit; results in the order of `jobs`.

    The first exception of a job is raised here, after the jobs that run beside it have been waited for; no
    further job starts. `tick` is called about twice a second while waiting. An exception of the waiting
    thread itself (Ctrl-C) is raised at once: the caller must end what the jobs have started.
    """
    waiting = order(jobs)
    running: dict[int, Job] = {}
    results: dict[int, T] = {}
    failure: BaseException | None = None
    done: queue.SimpleQueue[tuple[int, T | _Failure[T]]] = queue.SimpleQueue()

    def start(index: int) -> None:
        def body() -> None:
            try:
                done.put((index, work(index)))
            except BaseException as error:  # handed to the waiting thread
                done.put((index, _Failure(error)))

        threading.Thread(target=body, name=jobs[index].name, daemon=True).start()

    while running or (waiting and failure is None):
        for index in list(waiting) if failure is None else []:
            if fits(jobs[index], list(running.values()), core_limit, memory_limit):
                waiting.remove(index)
                running[index] = jobs[index]
                start(index)
        try:
            index, result = done.get(timeout=0.5)
        except queue.Empty:
            tick()
            continue
        running.pop(index)
        if isinstance(result, _Failure):
            failure = failure or result.error
        else:
            results[index] = result
    if failure is not None:
        raise failure
    return [results[index] for index in range(len(jobs))]
