"""Runs TLC's own distributed mode: one server and some workers, which talk over RMI.

The server holds the states that were seen and the queue, the workers compute successors and check them. We
start server and workers on this machine; workers on other machines may join (docs/distributed.md). What that
mode of TLC 2.15 leaves out is made up for here, or the run is refused:

- action properties are checked on transitions to new states only: they are asserted on every transition
  (transitions.py);
- ASSUME is not checked at all: one local run over the initial states alone comes first, and checks it;
- a violation has no name and half a trace: a local run has to find it again, and is what is judged;
- the server's count of generated states is another one: `generated` below;
- fairness, printed graphs and printed witnesses: refused.
"""

from __future__ import annotations

import re
import shutil
import socket
import subprocess
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import IO

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build
from modeproof.registers.cfg import Cfg
from modeproof.registers.made import cfg_text, make
from modeproof.registers.runs import Run
from modeproof.tlc import children
from modeproof.tlc.messages import (
    BLOCK_TOO_BIG,
    GENERAL,
    SERVER_READY,
    SUCCESS,
    TRACE,
    WORKER_DISCONNECTED,
    WORKER_REGISTERED,
    WORKER_STATS,
    Counts,
    Log,
    LogReader,
)
from modeproof.tlc.parse_tree import read_tree
from modeproof.tlc.process import FINGERPRINT, SMALL_HEAP_MB, Outcome, run_tlc
from modeproof.tlc.toolchain import Toolchain
from modeproof.tlc.transitions import PREFIX, rewrite

SERVER = "tlc2.tool.distributed.TLCServer"
WORKER = "tlc2.tool.distributed.TLCWorker"
WORKER_HEAP_MB = 1024
WAIT_S = 600.0
"""So long the server waits for the workers of other machines to register."""
GRACE_S = 5.0
"""So long a worker has to end by itself after the server has finished."""
_BLOCK = b".containsBlock("
_PARSED = re.compile(r"/([^/]+\.tla)$")


@dataclass(frozen=True)
class Where:
    """Who takes part: `workers` on this machine, `wait_for` worker threads of other machines.

    `address` is the one under which server and workers of this machine are reached, `port` that of the
    server's registry (0: any free one).
    """

    workers: int
    address: str = "127.0.0.1"
    port: int = 0
    wait_for: int = 0


def refusal(run: Run, cfg: Cfg) -> str:
    """Why this run cannot be judged in distributed mode; empty when nothing is known against it.

    The form of its properties is looked at when it is run.
    """
    if run.kind == "LIVE":
        return "TLC's distributed mode does not check liveness"
    if run.kind == "OPEN":
        return "the printed graph would be scattered over the workers"
    if run.kind == "WIT":
        return "the printed witnesses would be scattered over the workers, and TLCSet is not shared by them"
    if run.kind != "MC":
        return f"a run of kind {run.kind} is judged by its counterexample, which that mode does not give"
    if run.deadlock:
        return "TLC's distributed mode does not name a deadlock"
    if cfg.symmetry:
        return "symmetry is not tested in that mode"
    return ""


def run_distributed(
    place: Path,
    run: Run,
    cfg: Cfg,
    tools: Toolchain,
    where: Where,
    on_progress: Callable[[Counts], None] | None = None,
    say: Callable[[str], None] = lambda line: None,
) -> Outcome:
    """Run TLC's distributed mode on `run`; the outcome is one that is judged as that of a local run.

    A violation is looked for again by a local run, whose outcome is then the one returned. Raises Unjudged
    when the run cannot be judged in this mode, or a program cannot be started.
    """
    if reason := refusal(run, cfg):
        raise Unjudged(f"{run.name} cannot be judged in distributed mode: {reason}")
    logs = build(place) / "tlc" / run.document
    try:
        logs.mkdir(parents=True, exist_ok=True)
        for stale in logs.glob(f"{run.id}.distributed.*"):
            shutil.rmtree(stale, ignore_errors=True)
        room = Path(tempfile.mkdtemp(prefix=f"{run.id}.distributed.", dir=logs)).resolve()
    except OSError as error:
        raise Unjudged(f"{run.name}: cannot write to {logs}: {error.strerror}") from None
    try:
        session = _Session(place, run, cfg, tools, where, room, on_progress, say)
        outcome = session.run()
    except OSError as error:
        raise Unjudged(f"{run.name}: {error.strerror or error} ({error.filename or logs})") from None
    finally:
        shutil.rmtree(room, ignore_errors=True)
    if not session.violation or outcome.timed_out or outcome.broken_off or outcome.status != 0:
        return outcome
    say(f"{run.id}: a violation; TLC's distributed mode does not name it: a local run looks for it again")
    local = run_tlc(place, run, tools, on_progress)
    how = {**outcome.how, "confirmed": bool(local.log.violations)}
    if local.log.success:
        raise Unjudged(f"{run.name}: the distributed run found a violation that the local run does not find")
    return replace(local, how=how)


@dataclass
class _Session:
    """One server with its workers."""

    place: Path
    run_: Run
    cfg: Cfg
    tools: Toolchain
    where: Where
    room: Path
    on_progress: Callable[[Counts], None] | None
    say: Callable[[str], None]
    violation: bool = False
    _ready: threading.Event = field(default_factory=threading.Event)
    _registered: int = 0
    _lost: int = 0
    _too_big: bool = False
    _blocks: int = 0
    _done: bool = False
    _complaints: deque[str] = field(default_factory=lambda: deque(maxlen=40))
    _workers: list[subprocess.Popen[bytes]] = field(default_factory=list)
    _files: list[IO[bytes]] = field(default_factory=list)
    _stopped: str = ""
    _expired: bool = False
    _first: Log = field(default_factory=Log)

    def run(self) -> Outcome:
        """The snapshot, the local run over the initial states, then server and workers to the end."""
        run = self.run_
        module, cfg_name, files = self._snapshot()
        first = self._initial_states(module, cfg_name)
        if first is not None:
            return first
        port = self.where.port or _free_port(self.where.address)
        command = [
            *self._java(run.heap_mb, "server", port),
            f"-D{SERVER}.report=5000",
            "-Djava.rmi.server.logCalls=true",
            *("-cp", str(self.tools.jar), SERVER, "-tool", "-deadlock", "-fp", str(FINGERPRINT)),
            *("-checkpoint", "0", "-metadir", str(self.room / "states"), "-config", cfg_name, module),
        ]
        began = time.monotonic()
        reader = LogReader(on_progress=self.on_progress, on_message=self._message)
        log_path = build(self.place) / "tlc" / run.document / f"{run.id}.log"
        server = children.start(command, self.room, subprocess.PIPE, subprocess.PIPE)
        over = threading.Event()
        threads = [
            threading.Thread(target=self._read_calls, args=(server,), daemon=True),
            threading.Thread(target=self._watch, args=(server, port, began, over), daemon=True),
        ]
        try:
            for thread in threads:
                thread.start()
            assert server.stdout is not None
            with log_path.open("wb", buffering=0) as log_file:
                for line in server.stdout:
                    if line[:1] != b'"':
                        log_file.write(line)
                    reader.feed(line)
            status = server.wait()
        finally:
            over.set()
            children.end(server)
            for thread in threads:
                thread.join()
            if server.stderr is not None:
                server.stderr.close()
            self._end_workers(GRACE_S if server.returncode == 0 else 0.0)
        log = self._log(reader.close(), files)
        return Outcome(
            status=status,
            seconds=time.monotonic() - began,
            timed_out=self._expired,
            log=log,
            command=tuple(command),
            stderr="\n".join(self._complaints)[-4000:],
            broken_off=self._stopped,
            doubt=self._doubt(),
            how={
                "mode": "distributed",
                "workers": self.where.workers,
                "workers_elsewhere": self.where.wait_for,
                "registered": self._registered,
                "lost": self._lost,
                "blocks": self._blocks,
            },
        )

    # ------------------------------------------------------------------ before

    def _snapshot(self) -> tuple[str, str, list[str]]:
        """Copy the modules into one folder, from which the server hands them to its workers."""
        folder = self.place / "spec" / self.run_.document
        sources: dict[str, Path] = {}
        for source in (self.place / "spec" / "common", folder):
            sources |= {path.name: path for path in sorted(source.glob("*.tla"))}
        for name, path in sources.items():
            shutil.copyfile(path, self.room / name)
        run, text = self.run_, cfg_text(self.place, self.run_)
        if run.base:
            made_in, run = make(self.place, run)
            sources[f"{run.module}.tla"] = made_in / f"{run.module}.tla"
            shutil.copyfile(sources[f"{run.module}.tla"], self.room / f"{run.module}.tla")
        tree = read_tree(self.room, run.module, self.tools)
        made = rewrite(tree, self.cfg, text, self.run_.name)
        (self.room / f"{made.module}.tla").write_text(made.text, encoding="utf-8")
        (self.room / f"{made.module}.cfg").write_text(made.cfg, encoding="utf-8")
        first = made.cfg + f"CONSTRAINT {PREFIX}Nothing\n"
        (self.room / "First.cfg").write_text(first, encoding="utf-8")
        (self.room / "tmp").mkdir()
        return made.module, f"{made.module}.cfg", [str(path) for path in sources.values()]

    def _initial_states(self, module: str, cfg_name: str) -> Outcome | None:
        """A local run over the initial states: assumptions, syntax, version. The outcome if wrong."""
        command = [
            *self._java(512, "first", 0),
            *("-cp", str(self.tools.jar), "tlc2.TLC", "-tool", "-deadlock", "-workers", "1"),
            *("-checkpoint", "0", "-metadir", str(self.room / "first"), "-config", "First.cfg", module),
        ]
        reader = LogReader()
        began = time.monotonic()
        with (self.room / "first.err").open("wb") as errors:
            process = children.start(command, self.room, subprocess.PIPE, errors)
            try:
                assert process.stdout is not None
                for line in process.stdout:
                    reader.feed(line)
                status = process.wait()
            finally:
                children.end(process)
        self._first = reader.close()
        if status == 0 and self._first.success and self._first.finished:
            return None
        self.violation = bool(self._first.violations) and not self._first.errors
        stderr = (self.room / "first.err").read_bytes()[-4000:].decode("utf-8", "replace")
        seconds = time.monotonic() - began
        if self.violation:
            status = 0  # a local run of the module itself says which
        return Outcome(status, seconds, False, self._first, tuple(command), stderr=stderr)

    def _java(self, heap_mb: int, name: str, port: int) -> list[str]:
        folder = self.room / "tmp" / name
        folder.mkdir(exist_ok=True)
        small = self.run_.heap_mb <= SMALL_HEAP_MB or name == "first"
        return [
            *(str(self.tools.java), "-XX:+UseParallelGC", "-XX:+ExitOnOutOfMemoryError", "-Xss16m"),
            *(("-XX:TieredStopAtLevel=1",) if small else ()),
            *(f"-Xmx{heap_mb}m", f"-Djava.io.tmpdir={folder}"),
            *(f"-Djava.rmi.server.hostname={self.where.address}", f"-D{SERVER}.port={port}"),
        ]

    # ------------------------------------------------------------------ while it runs

    def _message(self, code: int) -> None:
        if code == SERVER_READY:
            self._ready.set()
        elif code == WORKER_REGISTERED:
            self._registered += 1
        elif code == WORKER_DISCONNECTED:
            self._lost += 1
        elif code == BLOCK_TOO_BIG:
            self._too_big = True
        elif code in (SUCCESS, WORKER_STATS):
            self._done = True
        elif code == TRACE:
            self.violation = True

    def _read_calls(self, server: subprocess.Popen[bytes]) -> None:
        """Count the blocks of states that workers asked about: one call each, as Java logs them."""
        assert server.stderr is not None
        for line in server.stderr:
            if _BLOCK in line:
                self._blocks += 1
            elif not line.startswith(b"FINER:") and b"sun.rmi.server.UnicastServerRef" not in line:
                self._complaints.append(line.decode("utf-8", "replace").rstrip())

    def _watch(self, server: subprocess.Popen[bytes], port: int, began: float, over: threading.Event) -> None:
        """Start the workers when the server is ready; end the server when nobody is left to work for it."""
        where, ready_at, started = self.where, 0.0, False
        while not over.wait(0.2):
            now = time.monotonic()
            if now - began > self.run_.timeout_s:
                self._expired = True
            elif self._ready.is_set() and not started:
                ready_at = ready_at or now
                if self._registered >= where.wait_for:
                    started = True
                    self._start_workers(port)
                elif now - ready_at > WAIT_S:
                    seen = f"{self._registered} of {where.wait_for} workers of other machines"
                    self._stopped = f"{seen} registered within {WAIT_S:.0f} s"
                elif ready_at == now:
                    self.say(
                        f"{self.run_.id}: the server listens at {where.address}:{port} and waits for "
                        f"{where.wait_for} from other machines; there: {self._invite(port)}"
                    )
            elif started and not self._finishing():
                here = any(worker.poll() is None for worker in self._workers)
                joined = self._registered - self._lost > 0
                if not here and (not joined or not where.wait_for):
                    self._stopped = (
                        f"all workers are gone ({self._registered} registered){self._last_words()}"
                    )
            if self._expired or self._stopped:
                children.kill(server)
                return

    def _finishing(self) -> bool:
        """Whether the server has begun to send its workers home."""
        return self._done or self.violation

    def _start_workers(self, port: int) -> None:
        heap = min(WORKER_HEAP_MB, max(256, self.run_.heap_mb))
        for number in range(1, self.where.workers + 1):
            command = [
                *self._java(heap, f"worker{number}", port),
                f"-D{WORKER}.threadCount=1",
                *("-cp", str(self.tools.jar), WORKER, self.where.address),
            ]
            output = (self.room / f"worker{number}.log").open("wb")
            self._files.append(output)
            self._workers.append(children.start(command, self.room, output, output))

    def _invite(self, port: int) -> str:
        return (
            f"java -Djava.rmi.server.hostname=ITS_ADDRESS -D{SERVER}.port={port} "
            f"-D{WORKER}.threadCount=1 -cp tla2tools.jar {WORKER} {self.where.address}"
        )

    def _last_words(self) -> str:
        """The last line that says something of the first worker's output."""
        log = self.room / "worker1.log"
        lines = log.read_text("utf-8", "replace").splitlines() if log.is_file() else []
        said = [line.strip() for line in lines if "Error" in line or "Exception" in line]
        kept = [line for line in said if "UnicastRef port" not in line]  # every current Java says that
        return f": {kept[0][:200]}" if kept else ""

    def _end_workers(self, grace_s: float) -> None:
        patience = time.monotonic() + grace_s
        for worker in self._workers:
            while worker.poll() is None and time.monotonic() < patience:
                time.sleep(0.05)
            children.end(worker)
        for output in self._files:
            output.close()

    # ------------------------------------------------------------------ after

    def _log(self, log: Log, files: list[str]) -> Log:
        """What the server said, in the terms of a local run: version, files, and the pinned counts."""
        log.version = self._first.version
        log.initial = self._first.counts.generated if self._first.counts is not None else None
        log.files = [path for path in files if Path(path).name in self._parsed()]
        if self._lost:  # `lost` counts broken connections; they are no error of the model
            log.errors = [
                error for error in log.errors if not (error[0] == GENERAL and "java.rmi." in error[1])
            ]
        if log.counts is not None and log.final and log.success:
            # The server adds, for each block of states: successors - 1; and the distinct states once.
            successors = log.counts.generated - log.counts.distinct + self._blocks
            log.counts = replace(log.counts, generated=successors + (log.initial or 0))
        return log

    def _parsed(self) -> set[str]:
        return {match.group(1) for name in self._first.files if (match := _PARSED.search(name))}

    def _doubt(self) -> str:
        if self._lost:
            count = f"{self._lost} of {self._registered} workers" if self._registered > 1 else "the worker"
            return (
                f"{count} lost on the way: others did the work, but how many states were generated is not "
                "known; run it again"
            )
        if self._too_big:
            return "a block of states was too big to send, and may be lost in part: run it again"
        return ""


def _free_port(address: str) -> int:
    with socket.socket() as probe:
        try:
            probe.bind((address, 0))
        except OSError as error:
            raise Unjudged(f"{address} is no address of this machine: {error.strerror or error}") from None
        return int(probe.getsockname()[1])
