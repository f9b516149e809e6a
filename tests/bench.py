"""Benchmarks, by `make bench`: machine, figure and spread. Nothing here is a test: being slow fails nothing.

Replay: every transition of a device graph, from power-up, on the reference implementation in this process, on
one core; outputs and states are compared in every scan. Missing graphs are made first, by TLC.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable

from modeproof import evidence
from modeproof.cli import main as modeproof
from modeproof.graph.device import graph_file, load_device_graph
from modeproof.graph.equal import compare
from modeproof.graph.implementation import load_implementation
from modeproof.places import documents, root
from modeproof.tlc.messages import LogReader
from modeproof.tlc.runs import Run, load_runs

REPEATS = 5
SHORT_SECONDS = 2.0
"""A repetition lasts at least this long: small graphs are replayed several times."""


def measure(work: Callable[[], int]) -> list[float]:
    """Units of work a second, once for each repetition."""
    rates = []
    for _ in range(REPEATS):
        units, began = 0, time.perf_counter()
        while (passed := time.perf_counter() - began) < SHORT_SECONDS or units == 0:
            units += work()
        rates.append(units / passed)
    return rates


def show(name: str, unit: str, rates: list[float]) -> None:
    """One line: median, least and greatest rate."""
    middle = statistics.median(rates)
    print(
        f"{name:<34} {middle:>12,.0f} {unit}/s   least {min(rates):,.0f}, greatest {max(rates):,.0f}, "
        f"{len(rates)} repetitions",
        flush=True,
    )


def replay(run: Run) -> Callable[[], int]:
    """One comparison of a graph with refimpl; gives the number of scans."""
    assert run.graph is not None
    graph = load_device_graph(root(), run)
    code = load_implementation("refimpl", run.document, run.graph.device)

    def work() -> int:
        found = compare(graph, code)
        if not found.equal:
            print(f"note: {run.name}: {found.summary()}", file=sys.stderr)
        return found.scans + found.class_scans

    return work


def read_lines(run: Run) -> Callable[[], int]:
    """Reading what TLC prints, as it comes through the pipe; gives the number of lines."""
    with graph_file(root(), run).open("rb") as stream:
        lines = [
            b'"' + line.rstrip().replace(b'"', b'\\"') + b'"\n'
            for line, _ in zip(stream, range(200_000), strict=False)
        ]

    def work() -> int:
        reader = LogReader(on_printed=lambda line: None)
        for line in lines:
            reader.feed(line)
        return len(lines)

    return work


def main() -> int:
    """Print all figures."""
    place = root()
    runs = [
        run
        for document in documents(place)
        if (place / "spec" / document / "runs.toml").is_file()
        for run in load_runs(place, document)
        if run.graph is not None
    ]
    missing = [run.name for run in runs if not graph_file(place, run).is_file()]
    if missing and modeproof(["check", *missing]) == 2:
        return 2
    if not runs:
        print("no run prints a graph", file=sys.stderr)
        return 2
    machine = evidence.machine()
    print(
        f"machine: {machine['cpu'] or machine['arch']}, {machine['cores']} cores, "
        f"{machine['memory_mb']:,} MB, {machine['system']}, Python {sys.version.split()[0]}"
    )
    for run in runs:
        show(f"replay {run.id}", "scans", measure(replay(run)))
    biggest = max(runs, key=lambda run: graph_file(place, run).stat().st_size)
    show(f"read {biggest.id}", "lines", measure(read_lines(biggest)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
