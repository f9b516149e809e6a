"""Does independent work in processes of its own, as many at once as there are cores."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import active_children, get_context
from typing import Any, TypeVar

from modeproof.errors import Unjudged
from modeproof.progress import Progress
from modeproof.tlc.schedule import cores

T = TypeVar("T")
Task = tuple[Callable[..., T], tuple[Any, ...]]
"""A function of a module, and what it is given; both must go through pickle."""


def in_processes(
    name: str, tasks: Sequence[Task[T]], progress: Progress, done: Callable[[T], None]
) -> list[T]:
    """The results in the order of `tasks`, which are begun in that order; `done` gets each as it comes.

    With one core or one task all is done in this process. The first exception of a task is raised; Unjudged
    when a process dies. However this ends, no process is left behind.
    """
    progress.expect(1)
    progress.begin(name)
    results: dict[int, T] = {}

    def take(number: int, result: T) -> None:
        results[number] = result
        done(result)
        progress.update(name, f"{len(results)} of {len(tasks)}")

    if len(tasks) < 2 or cores() < 2:
        try:
            for number, (work, given) in enumerate(tasks):
                take(number, work(*given))
            return [results[number] for number in range(len(tasks))]
        finally:
            progress.end(name)
    executor = ProcessPoolExecutor(min(cores(), len(tasks)), mp_context=get_context("spawn"))
    try:
        numbers = {executor.submit(work, *given): number for number, (work, given) in enumerate(tasks)}
        waiting = set(numbers)
        while waiting:
            ready, waiting = wait(waiting, timeout=0.5, return_when=FIRST_COMPLETED)
            for future in ready:
                take(numbers[future], future.result())
            progress.tick()
        return [results[number] for number in range(len(tasks))]
    except BrokenProcessPool as error:
        raise Unjudged(f"{name}: a process died: {error}") from None
    finally:
        progress.end(name)
        executor.shutdown(wait=False, cancel_futures=True)
        for child in active_children():
            child.terminate()
