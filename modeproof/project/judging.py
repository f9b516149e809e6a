"""Judges the entries of a project, each by the command for it in a process of its own, several at once."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.places import TREE, build, root
from modeproof.ground.progress import Progress
from modeproof.kit.adapter import split_command
from modeproof.kit.again import quoted
from modeproof.output import outcome
from modeproof.output.options import Clock
from modeproof.output.outcome import Outcome
from modeproof.project import basis
from modeproof.project.basis import Basis
from modeproof.project.entries import Adapter, Binding, Log, Machine, Program
from modeproof.project.file import Listed, Project

START = "import sys; sys.path.insert(0, sys.argv.pop(1)); from modeproof.cli import main; sys.exit(main())"
"""Starts the tool as it is here, whatever the current folder holds."""
BINDINGS = "bindings"
LONG = (Machine.KIND, Log.KIND)
"""What takes longest, and is begun first."""
GRACE_S = 5.0
"""For a command that was told to end."""


@dataclass(frozen=True)
class Judged:
    """What came of an entry. kept: it was found before, and is still valid."""

    entry: Listed
    outcome: Outcome
    kept: bool = False


@dataclass
class Judging:
    """The entries of one project file, from where the command runs."""

    project: Project
    jobs: int
    progress: Progress
    say: Callable[[str], None]
    running: list[subprocess.Popen[bytes]] = field(default_factory=list)
    guard: threading.Lock = field(default_factory=threading.Lock)
    over: bool = False

    def all(self, entries: Sequence[Listed], anew: bool = False) -> list[Judged]:
        """What comes of each, in their order. Raises Unjudged; however it ends, no process is left behind."""
        found: dict[str, Judged] = {}
        waiting: list[Listed] = []
        reasons: dict[str, str] = {}
        for entry in entries:
            result, why = (None, "") if anew else basis.kept(entry.name, self.basis(entry), self.folder)
            if result is not None:
                found[entry.name] = Judged(entry, result, kept=True)
            else:
                waiting.append(entry)
                reasons[entry.name] = why
        for why in dict.fromkeys(reasons.values()):
            if why and why != basis.FIRST:
                names = ", ".join(name for name, reason in reasons.items() if reason == why)
                self.say(f"judged again: {names}: {why}")
        waiting.sort(key=lambda entry: entry.row.KIND not in LONG)
        self.progress.expect(len(waiting))
        with ThreadPoolExecutor(max(1, min(self.jobs, len(waiting)))) as pool:
            futures = {pool.submit(self._one, entry): entry for entry in waiting}
            try:
                left: set[Future[Outcome]] = set(futures)
                while left:
                    done, left = wait(left, timeout=0.5, return_when=FIRST_COMPLETED)
                    self.progress.tick()
                    for future in done:
                        entry = futures[future]
                        found[entry.name] = Judged(entry, future.result())
            finally:
                self.end()
                for future in futures:
                    future.cancel()
        return [found[entry.name] for entry in entries]

    def end(self) -> None:
        """End every command that still runs."""
        with self.guard:
            self.over = True
            running = list(self.running)
        for child in running:
            child.terminate()
        for child in running:
            try:
                child.wait(GRACE_S)
            except subprocess.TimeoutExpired:
                child.kill()

    @property
    def folder(self) -> Path:
        """The folder of the project."""
        return self.project.folder

    def basis(self, entry: Listed) -> Basis:
        """What a judgement of an entry is about now."""
        row = entry.row
        said: list[str] = []
        files = {path: basis.digest(self.folder / path) for _, path in row.paths()}
        if isinstance(row, Program) and row.inline is not None:
            said = [binding_text(row.inline)]
        if isinstance(row, Adapter):
            said = [] if row.files else [f"judged each time {time.time_ns()}"]
            programs = {word: self._program(word) for word in split_command(row.command)}
            files |= {word: basis.digest(path) for word, path in programs.items() if path is not None}
        return Basis(row.words(str), said, files)

    def _program(self, word: str) -> Path | None:
        """The file that a word of a command names."""
        here = self.folder / word
        if here.is_file():
            return here
        found = shutil.which(word)
        return Path(found) if found else None

    def again(self, entry: Listed) -> str:
        """The command that judges an entry alone, from where this one runs."""
        row = entry.row
        if isinstance(row, Program) and row.inline is not None and row.inline.unfinished:
            return f"modeproof judge {entry.name}"
        inline = isinstance(row, Program) and row.inline is not None
        binding = from_here(binding_path(entry)) if inline else None
        words = row.words(lambda path: from_here(self.folder / path), binding)
        return " ".join(map(quoted, ["modeproof", *words]))

    def _one(self, entry: Listed) -> Outcome:
        self.progress.begin(entry.name)
        try:
            basis.forget(entry.name)
            found, before = self._carried_out(entry, Clock())
            unjudged = outcome.UNJUDGED in (found.word, *(demand.word for demand in found.demands))
            if not unjudged and self.basis(entry) == before and before.is_what_was_read(found):
                basis.keep(entry.name, before, found)
            return found
        finally:
            self.progress.end(entry.name)

    def _carried_out(self, entry: Listed, clock: Clock) -> tuple[Outcome, Basis]:
        row, record = entry.row, basis.record_path(entry.name)
        record.unlink(missing_ok=True)
        before = self.basis(entry)
        file: str | None = None
        if isinstance(row, Program) and row.inline is not None:
            if left := row.inline.unfinished:
                here = self.project.at(entry, "binding.names")
                reason = (
                    f"{here}: the names of {', '.join(left)} are still empty; write those of your program"
                )
                return self._unjudged(entry, clock, reason), before
            path = binding_path(entry)
            write_whole(path, binding_text(row.inline).encode())
            file = str(path)
        status, told = self._run([*row.words(str, file), "--record", str(record)])
        if self.over:
            raise Unjudged("interrupted: no verdict; what was finished before is kept")
        if not record.is_file():
            return self._unjudged(entry, clock, told or f"the command ended with status {status}"), before
        found = outcome.read(record)
        if found.status != status:
            record.unlink(missing_ok=True)
            return self._unjudged(entry, clock, f"the command ended with status {status}: {told}"), before
        return found, before

    def _run(self, words: Sequence[str]) -> tuple[int, str]:
        """Run a command of the tool in the project; its exit status, and its last word on standard error."""
        argv = [sys.executable, "-P", "-c", START, str(TREE), *words]
        env = {**os.environ, "PYTHONIOENCODING": "utf-8", "MODEPROOF_STATE": str(build(root()))}
        with self.guard:
            if self.over:
                raise Unjudged("interrupted: no verdict; what was finished before is kept")
            child = subprocess.Popen(
                argv,
                cwd=self.folder,
                env=env,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
            )
            self.running.append(child)
        try:
            _, told = child.communicate()
        finally:
            with self.guard:
                self.running.remove(child)
        lines = told.decode("utf-8", "replace").strip().splitlines() or [""]
        return child.returncode, lines[-1].removeprefix("modeproof: ")

    def _unjudged(self, entry: Listed, clock: Clock, reason: str) -> Outcome:
        """The outcome of an entry without a verdict, which is its record too. Raises Unjudged."""
        row: Any = entry.row
        target: str = getattr(row, "target", None) or getattr(row, "own", None) or ""
        subject: str = next((path for _, path in row.paths()), getattr(row, "command", ""))
        known: dict[str, Any] = {"started": clock.started, "seconds": clock.seconds}
        found = outcome.unjudged(row.words(str)[0], subject, target, self.again(entry), reason, **known)
        outcome.write(basis.record_path(entry.name), found)
        return found


def from_here(path: Path) -> str:
    """A path as it is written from the current folder; whole where that is on another drive."""
    try:
        return Path(os.path.relpath(path)).as_posix()
    except ValueError:
        return path.as_posix()


def binding_path(entry: Listed) -> Path:
    """Where the inline table of an entry is written for the command that needs a file."""
    return build(root()) / BINDINGS / f"{entry.name}.toml"


def binding_text(found: Binding) -> str:
    """A binding as the TOML file that `prove-program` reads."""
    import tomlkit

    table = {key: value for key, value in msgspec.to_builtins(found).items() if value not in (None, [], {})}
    return tomlkit.dumps(dict(sorted(table.items(), key=lambda item: isinstance(item[1], dict))))
