"""Does independent work in processes of its own, as many at once as there are cores."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import active_children, connection, get_context
from typing import Any, Generic, TypeVar

from modeproof.ground.errors import Unjudged
from modeproof.ground.progress import Progress

T = TypeVar("T")
Task = tuple[Callable[..., T], tuple[Any, ...]]
"""A function of a module, and what it is given; both must go through pickle."""


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_processes(
    name: str, tasks: Sequence[Task[T]], progress: Progress, done: Callable[[T], None], fork: bool = False
) -> list[T]:
    """The results in the order of `tasks`, which are begun in that order; `done` gets each as it comes.

    fork: the processes are copies of this one, so that what it has made already need not be made again;
    else they begin anew.

    With one core or one task all is done in this process. The first exception of a task is raised; Unjudged
    when a process dies. However this ends, no process is left behind.
    """
    progress.expect(1)
    progress.begin(name)
    results: dict[int, T] = {}

    def take(number: int, result: T) -> None:
        results[number] = result
        done(result)
        progress.update(name, f"{len(results)} of {len(tasks)}", len(results) / len(tasks))

    if len(tasks) < 2 or cores() < 2:
        try:
            for number, (work, given) in enumerate(tasks):
                take(number, work(*given))
            return [results[number] for number in range(len(tasks))]
        finally:
            progress.end(name)
    context = get_context("fork" if fork else "spawn")
    executor = ProcessPoolExecutor(min(cores(), len(tasks)), context, _begin, (os.getpid(),))
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


def meanwhile(name: str, tasks: Sequence[Task[T]], work: Callable[[], None]) -> list[T]:
    """Call `work` here, while a copy of this process does the tasks one after another; the results so far.

    The copy ends with the task that it is at when `work` returns: the results are those of the first tasks,
    perhaps of all. With one core there is no copy. The first exception of a task is raised; Unjudged when
    the copy dies. However this ends, no process is left behind.
    """
    if cores() < 2 or not tasks:
        work()
        return []
    context = get_context("fork")
    enough = context.Event()
    read, write = context.Pipe(duplex=False)
    process = context.Process(target=_until, args=(tasks, enough, write, os.getpid()), daemon=True)
    process.start()
    write.close()
    try:
        work()
        enough.set()
        results, error = read.recv()
    except EOFError:
        raise Unjudged(f"{name}: a process died") from None
    finally:
        read.close()
        process.terminate()
        process.join()
    if error is not None:
        raise error
    return list(results)


def _until(tasks: Sequence[Task[T]], enough: Any, out: Any, parent: int) -> None:
    _begin(parent)
    results: list[T] = []
    error: Exception | None = None
    try:
        for work, given in tasks:
            if enough.is_set():
                break
            results.append(work(*given))
    except Exception as one:  # raised by who asked
        error = one
    out.send((results, error))
    out.close()


def _begin(parent: int) -> None:
    """In a new process: the parent alone hears Ctrl-C, and none outlives it, even if it is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(0.5)
        os._exit(2)

    threading.Thread(target=watch, daemon=True).start()


@dataclass(frozen=True)
class Outcome(Generic[T]):
    """What one item came to: a result, or why there is none."""

    number: int
    result: T | None
    why: str = ""


def in_forks(
    work: Callable[[Any], T], items: Sequence[Any], jobs: int, limit_s: float
) -> Iterator[Outcome[T] | None]:
    """The outcome of each item as it comes, each worked on in a copy of this process that ends with it.

    So nothing that one item leaves behind meets the next one, and what this process knows already need not be
    made again. None now and then while nothing has come. limit_s: wall-clock time for one item; one that
    takes longer is ended. However this ends, no process is left behind.
    """
    context = get_context("fork")
    waiting = list(enumerate(items))[::-1]
    running: dict[Any, tuple[Any, int, float]] = {}

    def child(number: int, item: Any, out: Any) -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        try:
            outcome = Outcome(number, work(item))
        except Exception as error:  # reported, and the others go on
            outcome = Outcome(number, None, f"{type(error).__name__}: {' '.join(str(error).split())}"[:300])
        out.send(outcome)
        out.close()

    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                number, item = waiting.pop()
                read, write = context.Pipe(duplex=False)
                process = context.Process(target=child, args=(number, item, write), daemon=True)
                process.start()
                write.close()
                running[read] = process, number, time.monotonic()
            ready = connection.wait(list(running), timeout=1.0)
            late = [one for one, (_, _, began) in running.items() if time.monotonic() - began > limit_s]
            for one in [*ready, *(task for task in late if task not in ready)]:
                process, number, _ = running.pop(one)
                outcome = Outcome[T](number, None, f"the limit of {limit_s:.0f} s came first")
                if one in ready:
                    outcome = Outcome(number, None, "its process died")
                    with contextlib.suppress(EOFError, OSError):
                        outcome = one.recv()
                else:
                    process.kill()
                process.join()
                yield outcome
            if not ready and not late:
                yield None
    finally:
        for process, _, _ in running.values():
            process.kill()
            process.join()
