"""Runs TLC once: a fresh folder for its states, a time limit, and a clean end whatever happens."""

from __future__ import annotations

import os
import shutil
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build
from modeproof.registers.made import make
from modeproof.registers.runs import Run
from modeproof.tlc import children
from modeproof.tlc.messages import Counts, Log, LogReader
from modeproof.tlc.start_up import start_up_options
from modeproof.tlc.toolchain import Toolchain

FINGERPRINT = 1
SEED = 1
SMALL_HEAP_MB = 512
"""A run that declares at most this much heap is a small one, over in seconds."""
FEW_STATES = 150_000
"""A run that generates fewer states is over before Java's second compiler has paid for itself.

Seconds of the processor without it and with it: 119,000 states of KeyFlows 3.4 and 4.2, 26,000 of the PLC 1.2
and 1.8. With more it depends on what a state costs: 329,000 of the F-PLC 4.9 and 5.8, 174,000 of the
machine 17.7 and 13.0. A liveness run also searches the graph, so that its states say little: 119,000 states
10.1 and 8.6.
"""
WITNESS_LIMIT = 100_000
LINES_A_WORD = 20_000
"""So many printed lines of a graph are worth a word of progress."""


@dataclass(frozen=True)
class Outcome:
    """What came of one TLC run.

    `status` is the exit status (negative: killed by that signal), `seconds` the wall-clock time, `printed`
    the distinct printed lines (OPEN runs keep them in `graph_file` instead), `stderr` the last lines of Java,
    `stopped` whether whoever watched the printed lines had seen enough.
    """

    status: int
    seconds: float
    timed_out: bool
    log: Log
    command: tuple[str, ...]
    printed: frozenset[bytes] = frozenset()
    printed_all: bool = True
    graph_file: Path | None = None
    stderr: str = ""
    stopped: bool = False
    broken_off: str = ""
    """Why the run was ended before TLC had finished; empty when it was not."""


def command_line(
    run: Run, tools: Toolchain, metadir: Path, places: Sequence[Path] = (), quick: bool = False
) -> list[str]:
    """The command that runs TLC, to be started in the folder of module and cfg; `places` are searched too.

    A small run (SMALL_HEAP_MB), one with FEW_STATES, and a `quick` one are compiled by Java's quick compiler
    alone.
    """
    java = [
        str(tools.java),
        "-XX:+UseParallelGC",
        "-XX:+ExitOnOutOfMemoryError",
        "-Xss16m",
        f"-Xmx{run.heap_mb}m",
        f"-Djava.io.tmpdir={metadir / 'tmp'}",
        *start_up_options(tools),
    ]
    few = run.kind != "LIVE" and run.generated is not None and run.generated < FEW_STATES
    if run.heap_mb <= SMALL_HEAP_MB or few or quick:
        java.append("-XX:TieredStopAtLevel=1")
    if places:
        java.append(f"-DTLA-Library={os.pathsep.join(map(str, places))}")
    tlc = ["-tool", "-fp", str(FINGERPRINT), "-seed", str(SEED), "-workers", str(run.workers)]
    tlc += ["-checkpoint", "0", "-metadir", str(metadir / "states"), "-config", run.cfg]
    tlc += [
        "-lncheck",
        "final",
    ]  # otherwise the clock would decide when liveness is checked, and which lasso is found
    if not run.deadlock:
        tlc.append("-deadlock")  # this option of TLC turns the check off
    return [*java, "-cp", str(tools.jar), "tlc2.TLC", *tlc, run.module]


class _Sink:
    """Where printed lines go: a file for OPEN runs, whoever watches them, a bounded set otherwise."""

    def __init__(
        self,
        stream: BinaryIO | None,
        on_lines: Callable[[int], None] | None = None,
        watch: Callable[[bytes], None] | None = None,
    ) -> None:
        self.lines: set[bytes] = set()
        self.complete = True
        self.written = 0
        self._stream = stream
        self._on_lines = on_lines
        self._watch = watch

    def take(self, line: bytes) -> None:
        if self._watch is not None:
            self._watch(line)
        elif self._stream is not None:
            self._stream.write(line + b"\n")
            self.written += 1
            if self.written % LINES_A_WORD == 0 and self._on_lines is not None:
                self._on_lines(self.written)
        elif line not in self.lines:
            if len(self.lines) < WITNESS_LIMIT:
                self.lines.add(line)
            else:
                self.complete = False


def run_tlc(
    place: Path,
    run: Run,
    tools: Toolchain,
    on_progress: Callable[[Counts], None] | None = None,
    on_lines: Callable[[int], None] | None = None,
    made_in: Path | None = None,
    watch: Callable[[bytes], bool] | None = None,
    also: Sequence[Path] = (),
) -> Outcome:
    """Run TLC on `run` and read its log to the end.

    Module and cfg lie in the document's folder of the specification; those of a run with a base are made, and
    those that were made for a run that no register declares lie in `made_in`; the document's modules are
    found all the same, and those in the folders `also`. `watch` gets each printed line of a
    run that is not of kind OPEN, in the place of the set of lines; once it says True the run is stopped.

    The framed log is kept at build/tlc/<document>/<run>.log. The printed lines of an OPEN run are written to
    build/graphs/<document>/<run>.txt, which appears only when the log is complete. Raises Unjudged when TLC
    cannot be started or the disk is full.
    """
    quick = made_in is not None and not also
    if run.base or not run.cfg:
        made_in, run = make(place, run)
    own = place / "spec" / run.document
    folder = own if made_in is None else made_in
    for needed in (folder / f"{run.module}.tla", folder / run.cfg):
        if not needed.is_file():
            raise Unjudged(f"{run.name}: {needed.relative_to(place)} is missing")
    logs = build(place) / "tlc" / run.document
    graph = build(place) / "graphs" / run.document / f"{run.id}.txt"
    places = [path for path in (own, *also, place / "spec" / "common") if path != folder and path.is_dir()]
    try:
        logs.mkdir(parents=True, exist_ok=True)
        for stale in logs.glob(f"{run.id}.????????"):  # of a run that was killed
            shutil.rmtree(stale, ignore_errors=True)
    except OSError as error:
        raise Unjudged(f"{run.name}: cannot write to {logs}: {error.strerror}") from None
    try:
        with children.room(f"{run.id}.", logs) as metadir:
            (metadir / "tmp").mkdir()
            command = command_line(run, tools, metadir, places, quick)
            if run.kind != "OPEN":
                return _follow(run, command, folder, metadir, logs, None, on_progress, None, watch)
            graph.parent.mkdir(parents=True, exist_ok=True)
            graph.unlink(missing_ok=True)
            part = metadir / "graph"
            with part.open("wb", buffering=1 << 20) as stream:
                outcome = _follow(run, command, folder, metadir, logs, stream, on_progress, on_lines, None)
                stream.flush()
                os.fsync(stream.fileno())
            log = outcome.log
            if log.success and log.finished and not log.broken and outcome.status == 0:
                part.replace(graph)
                return _with_graph(outcome, graph)
            return outcome
    except OSError as error:
        raise Unjudged(f"{run.name}: {error.strerror or error} ({error.filename or logs})") from None


def _with_graph(outcome: Outcome, graph: Path) -> Outcome:
    return Outcome(**{**outcome.__dict__, "graph_file": graph})


def _follow(
    run: Run,
    command: list[str],
    folder: Path,
    metadir: Path,
    logs: Path,
    stream: BinaryIO | None,
    on_progress: Callable[[Counts], None] | None,
    on_lines: Callable[[int], None] | None,
    watch: Callable[[bytes], bool] | None,
) -> Outcome:
    enough = threading.Event()

    def look(line: bytes) -> None:
        if not enough.is_set() and watch is not None and watch(line):
            enough.set()
            children.kill(process)

    sink = _Sink(stream, on_lines, None if watch is None else look)
    reader = LogReader(on_printed=sink.take, on_progress=on_progress)
    errors = metadir / "stderr"
    expired = threading.Event()
    began = time.monotonic()
    with errors.open("wb") as stderr, (logs / f"{run.id}.log").open("wb", buffering=0) as log_file:
        process = children.start(command, folder, subprocess.PIPE, stderr)

        def expire() -> None:
            expired.set()
            children.kill(process)

        timer = threading.Timer(run.timeout_s, expire)
        timer.daemon = True
        timer.start()
        try:
            assert process.stdout is not None
            for line in process.stdout:
                if line[:1] != b'"':
                    log_file.write(line)
                reader.feed(line)
            status = process.wait()
        finally:
            timer.cancel()
            children.end(process)
    seconds = time.monotonic() - began
    tail = errors.read_bytes()[-4000:].decode("utf-8", "replace").strip()
    return Outcome(
        status=status,
        seconds=seconds,
        timed_out=expired.is_set(),
        log=reader.close(),
        command=tuple(command),
        printed=frozenset(sink.lines),
        printed_all=sink.complete,
        stderr=tail,
        stopped=enough.is_set(),
    )
