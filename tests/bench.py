"""Benchmarks, by `make bench`: machine, figure and spread. Nothing here is a test: being slow fails nothing.

Replay: every transition of a device graph, from power-up, on the reference implementation in this process, on
one core; outputs and states are compared in every scan. Missing graphs are made first, by TLC. Then the first
cases of a fast suite, on the statement-list program: behind its adapter, and in its simulated PLC over S7.
Last the report: how long it takes to be made, and its first paint in Chromium.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import islice
from pathlib import Path

from modeproof.cli import main as modeproof
from modeproof.graph.device import graph_file, load_device_graph
from modeproof.graph.equal import compare
from modeproof.graph.implementation import load_implementation
from modeproof.ground import evidence
from modeproof.ground.places import documents, root
from modeproof.kit.adapter import Adapter, Program
from modeproof.kit.vectors import Suite, open_suite
from modeproof.registers.load import load_interface
from modeproof.registers.runs import Run, load_runs
from modeproof.s7 import program as s7
from modeproof.suites.demands import declare_parameters
from modeproof.tlc.messages import LogReader
from tests.s7.server import STEPPED, Plc

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


CASES = 4
AWL = Path("examples/awl")


def drive(program: Program, suite: Suite) -> Callable[[], int]:
    """The first cases of a suite, in lock-step, without any judgement; gives the number of scans."""

    def work() -> int:
        scans = 0
        for case in islice(suite.cases(), CASES):
            program.reset(case.params)
            for scan in case.scans:
                program.scan(scan.dt_ms, scan.inputs)
            scans += len(case.scans)
        return scans

    return work


@contextmanager
def statement_list(place: Path, suite: Suite) -> Iterator[tuple[Program, Program]]:
    """The program behind its adapter, and behind the S7 protocol."""
    served = [sys.executable, str(place / AWL / "server.py"), suite.target]
    command = [sys.executable, str(place / AWL / "adapter.py"), suite.target]
    with Adapter(command, 60.0) as adapter:
        adapter.hello(suite.target)
        with subprocess.Popen(served, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as plc:
            assert plc.stdout is not None
            address = plc.stdout.readline().split()[-1]
            with s7.connect(address, place / AWL / f"{suite.target}.map.csv", suite) as client:
                yield adapter, client
            plc.kill()


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
    suite = open_suite(place / "vectors/fplc/brief.jsonl.gz")
    interface = load_interface(place, suite.document)
    modes = [int(mode) for mode in interface.constants["MODES"]]
    suite = replace(suite, parameters=declare_parameters(interface.devices[suite.target], modes))
    with statement_list(place, suite) as (adapter, client):
        show("awlsim behind its adapter", "scans", measure(drive(adapter, suite)))
        show("awlsim over S7", "scans", measure(drive(client, suite)))
    with tempfile.TemporaryDirectory() as folder, Plc() as plc:
        addresses = Path(folder, "map.csv")
        addresses.write_text(STEPPED, encoding="utf-8")
        with s7.connect(plc.address, addresses, suite) as client:
            show("refimpl over S7, client and server", "scans", measure(drive(client, suite)))
    from tests.bench_kit import show_kit

    show_kit(place)
    from tests.bench_page import show_page

    show_page(place)
    return 0


if __name__ == "__main__":
    sys.exit(main())
