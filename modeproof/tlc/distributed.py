"""Runs TLC's own distributed mode: one server and some workers, which talk over RMI.

The server holds the states that were seen and the queue, the workers compute successors and check them.
Without --listen they have a network of their own, which nobody else can reach; with it, workers of other
machines may join (docs/distributed.md). What that mode of TLC 2.15 leaves out is made up for, or refused:

- action properties are asserted on every transition (transitions.py); TLC checks them on new states only;
- ASSUME is checked by a local run over the initial states, which comes first;
- a violation has no name and half a trace: a local run has to find it again, and is what is judged;
- the server's count of generated states is another one: `generated` below;
- it believes every worker: with more workers than were invited there is no verdict, and none when a local run
  of RECHECK_S seconds contradicts it;
- fairness, printed graphs and printed witnesses are refused.
"""

from __future__ import annotations

import re
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from msgspec import structs

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build
from modeproof.registers.cfg import Cfg
from modeproof.registers.made import cfg_text, make
from modeproof.registers.runs import Run
from modeproof.tlc import children, messages
from modeproof.tlc.messages import Counts, Log, LogReader
from modeproof.tlc.parse_tree import read_tree
from modeproof.tlc.process import FINGERPRINT, SMALL_HEAP_MB, Outcome, run_tlc
from modeproof.tlc.toolchain import Toolchain
from modeproof.tlc.transitions import PREFIX, rewrite

SERVER = "tlc2.tool.distributed.TLCServer"
WORKER = "tlc2.tool.distributed.TLCWorker"
WORKER_HEAP_MB = 1024
WAIT_S = 600.0
"""So long the server waits for the workers of other machines to register."""
RECHECK_S = 20.0
"""So long a local run looks over the first states again."""
GRACE_S = 5.0
"""So long a worker has to end by itself after the server has finished."""
_BLOCK = b".containsBlock("
_CALLER = re.compile(rb"\[([0-9a-f.:]+): ")
_ALONE = ("unshare", "--user", "--map-root-user", "--net", sys.executable, "-I", "-S", "-c")
_LOOPBACK = """
import fcntl, os, socket, struct, sys
request = struct.pack("16sh14x", b"lo", 0x49)  # up, running, loopback
fcntl.ioctl(socket.socket(), 0x8914, request)
os.execvp(sys.argv[1], sys.argv[1:])
"""
"""Started in a new network, this switches its loopback on and becomes the program that is named."""
_REFUSED = {
    "LIVE": "TLC's distributed mode does not check liveness",
    "OPEN": "the printed graph would be scattered over the workers",
    "WIT": "the printed witnesses would be scattered over the workers, and TLCSet is not shared by them",
}
_PARSED = re.compile(r"/([^/]+\.tla)$")


@dataclass(frozen=True)
class Where:
    """Who takes part: `workers` on this machine, `wait_for` worker threads of other machines.

    `address` is the one under which server and workers of this machine are reached, `port` that of the
    server's registry (0: any free one). Without an address they have a network of their own.
    """

    workers: int
    address: str = ""
    port: int = 0
    wait_for: int = 0

    @property
    def invited(self) -> int:
        """How many workers there may be."""
        return self.workers + self.wait_for


def refusal(run: Run, cfg: Cfg) -> str:
    """Why this run cannot be judged in distributed mode; empty when nothing is known against it.

    The form of its properties is looked at when it is run.
    """
    if run.kind != "MC":
        return _REFUSED.get(run.kind, "that mode does not give the counterexample by which it is judged")
    if run.deadlock:
        return "TLC's distributed mode does not name a deadlock"
    return "symmetry is not tested in that mode" if cfg.symmetry else ""


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
        made = tempfile.TemporaryDirectory(
            dir=logs, prefix=f"{run.id}.distributed.", ignore_cleanup_errors=True
        )
        with made as room:
            session = _Session(place, run, cfg, tools, where, Path(room).resolve(), on_progress, say)
            outcome = session.run()
    except OSError as error:
        raise Unjudged(f"{run.name}: {error.strerror or error} ({error.filename or logs})") from None
    if session.registered > where.invited:
        raise Unjudged(
            f"{run.name}: {session.registered} workers registered and {where.invited} were invited; called "
            f"from {', '.join(sorted(session.callers))}; a stranger can make any verdict"
        )
    if outcome.stderr.startswith("unshare"):
        raise Unjudged(
            f"{run.name}: no network of its own here ({outcome.stderr}); --listen 127.0.0.1 does without"
        )
    if outcome.timed_out or outcome.broken_off or outcome.status != 0:
        return outcome
    if not session.violation:
        return _rechecked(place, run, tools, outcome)
    say(f"{run.id}: a violation; TLC's distributed mode does not name it: a local run looks for it again")
    local = run_tlc(place, run, tools, on_progress)
    how = {**outcome.how, "confirmed": bool(local.log.violations)}
    if local.log.success:
        raise Unjudged(f"{run.name}: the distributed run found a violation that the local run does not find")
    return replace(local, how=how)


def _rechecked(place: Path, run: Run, tools: Toolchain, outcome: Outcome) -> Outcome:
    """The outcome, if a local run of RECHECK_S does not contradict it. Raises Unjudged otherwise."""
    if not outcome.log.success or outcome.log.counts is None:
        return outcome
    local = run_tlc(place, structs.replace(run, id=f"{run.id}_again", timeout_s=RECHECK_S), tools)
    there, here = outcome.log.counts.distinct, local.log.counts.distinct if local.log.counts else 0
    if local.log.violations or here > there or (local.log.success and here != there):
        what = "violates it" if local.log.violations else f"has {here:,} states and not {there:,}"
        raise Unjudged(f"{run.name}: the distributed run found nothing, and a local one {what}")
    whole = bool(local.log.success)
    return replace(outcome, how={**outcome.how, "rechecked": {"distinct": here, "whole": whole}})


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
    registered: int = 0
    callers: set[str] = field(default_factory=set)
    _ready: threading.Event = field(default_factory=threading.Event)
    _lost: int = 0
    _too_big: bool = False
    _blocks: int = 0
    _done: bool = False
    _complaints: deque[str] = field(default_factory=lambda: deque(maxlen=40))
    _workers: list[subprocess.Popen[bytes]] = field(default_factory=list)
    _stopped: str = ""
    _expired: bool = False
    _first: Log = field(default_factory=Log)

    def run(self) -> Outcome:
        """The snapshot, the local run over the initial states, then server and workers to the end."""
        run = self.run_
        module, cfg_name, files = self._snapshot()
        first = self._initial_states(module)
        if first is not None:
            return first
        port = self.where.port or _free_port(self._address)
        command = [
            *((*_ALONE, _LOOPBACK) if not self.where.address else ()),
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
            patience = time.monotonic() + (GRACE_S if server.returncode == 0 else 0.0)
            for worker in self._workers:
                while worker.poll() is None and time.monotonic() < patience:
                    time.sleep(0.05)
                children.end(worker)
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
                "registered": self.registered,
                "called_from": sorted(self.callers),
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

    def _initial_states(self, module: str) -> Outcome | None:
        """A local run over the initial states: assumptions, syntax, version. The outcome if wrong."""
        own = self.run_
        run = structs.replace(own, id=f"{own.id}_first", module=module, cfg="First.cfg", base="", heap_mb=512)
        outcome = run_tlc(self.place, run, self.tools, made_in=self.room)
        self._first = outcome.log
        if outcome.status == 0 and outcome.log.success and outcome.log.finished:
            return None
        self.violation = bool(outcome.log.violations) and not outcome.log.errors
        return replace(outcome, status=0) if self.violation else outcome  # a local run will say which

    @property
    def _address(self) -> str:
        return self.where.address or "127.0.0.1"

    def _java(self, heap_mb: int, name: str, port: int) -> list[str]:
        folder = self.room / "tmp" / name
        folder.mkdir(exist_ok=True)
        small = self.run_.heap_mb <= SMALL_HEAP_MB
        return [
            *(str(self.tools.java), "-XX:+UseParallelGC", "-XX:+ExitOnOutOfMemoryError", "-Xss16m"),
            *(("-XX:TieredStopAtLevel=1",) if small else ()),
            *(f"-Xmx{heap_mb}m", f"-Djava.io.tmpdir={folder}"),
            *(f"-Djava.rmi.server.hostname={self._address}", f"-D{SERVER}.port={port}"),
        ]

    # ------------------------------------------------------------------ while it runs

    def _message(self, code: int) -> None:
        self.registered += code == messages.WORKER_REGISTERED
        self._lost += code == messages.WORKER_DISCONNECTED
        self._too_big |= code == messages.BLOCK_TOO_BIG
        self._done |= code in (messages.SUCCESS, messages.WORKER_STATS)
        self.violation |= code == messages.TRACE
        if code == messages.SERVER_READY:
            self._ready.set()

    def _read_calls(self, server: subprocess.Popen[bytes]) -> None:
        """Count the blocks of states that workers asked about: one call each, as Java logs them."""
        assert server.stderr is not None
        for line in server.stderr:
            if found := _CALLER.search(line):
                self.callers.add(found.group(1).decode())
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
            elif self.registered > where.invited:
                self._stopped = "strangers"
            elif self._ready.is_set() and not started:
                ready_at = ready_at or now
                if self.registered >= where.wait_for:
                    started = True
                    self._start_workers(server.pid, port)
                elif now - ready_at > WAIT_S:
                    seen = f"{self.registered} of {where.wait_for} workers of other machines"
                    self._stopped = f"{seen} registered within {WAIT_S:.0f} s"
                elif ready_at == now:
                    self.say(
                        f"{self.run_.id}: the server listens at {where.address}:{port} and waits for "
                        f"{where.wait_for} workers of other machines (docs/distributed.md)"
                    )
            elif started and not (self._done or self.violation):  # then it sends its workers home
                here = any(worker.poll() is None for worker in self._workers)
                if not here and (self.registered <= self._lost or not where.wait_for):
                    said = f"all workers are gone ({self.registered} registered)"
                    self._stopped = said + self._last_words()
            if self._expired or self._stopped:
                children.kill(server)
                return

    def _start_workers(self, server: int, port: int) -> None:
        inside = ("nsenter", "--target", str(server), "--user", "--net", "--preserve-credentials")
        heap = min(WORKER_HEAP_MB, max(256, self.run_.heap_mb))
        for number in range(1, self.where.workers + 1):
            command = [
                *(inside if not self.where.address else ()),
                *self._java(heap, f"worker{number}", port),
                f"-D{WORKER}.threadCount=1",
                *("-cp", str(self.tools.jar), WORKER, self._address),
            ]
            with (self.room / f"worker{number}.log").open("wb") as output:
                self._workers.append(children.start(command, self.room, output, output))

    def _last_words(self) -> str:
        """The first worker's first complaint; every current Java complains about UnicastRef."""
        log = self.room / "worker1.log"
        lines = log.read_text("utf-8", "replace").splitlines() if log.is_file() else []
        said = [
            line for line in lines if re.search("Error|Exception", line) and "UnicastRef port" not in line
        ]
        return f": {said[0].strip()[:200]}" if said else ""

    # ------------------------------------------------------------------ after

    def _log(self, log: Log, files: list[str]) -> Log:
        """What the server said, in the terms of a local run: version, files, and the pinned counts."""
        log.version = self._first.version
        log.initial = self._first.counts.generated if self._first.counts is not None else None
        parsed = {match.group(1) for name in self._first.files if (match := _PARSED.search(name))}
        log.files = [path for path in files if Path(path).name in parsed]
        if self._lost:  # `lost` counts broken connections; they are no error of the model
            general = messages.GENERAL
            log.errors = [one for one in log.errors if one[0] != general or "java.rmi." not in one[1]]
        if log.counts is not None and log.final and log.success:
            # The server adds, for each block of states: successors - 1; and the distinct states once.
            successors = log.counts.generated - log.counts.distinct + self._blocks
            log.counts = replace(log.counts, generated=successors + (log.initial or 0))
        return log

    def _doubt(self) -> str:
        if self._lost:
            count = f"{self._lost} of {self.registered} workers"
            return f"{count} lost on the way: how many states were generated is not known; run it again"
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
