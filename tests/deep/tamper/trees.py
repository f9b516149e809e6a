"""Copies of the repository in which one line is changed, and the commands that must notice.

A copy is made of hard links; what is edited is written anew, so that the original stays as it is. One process
has the tool loaded and forks for each command: a case costs what its judging costs, and no start of Python.
"""

from __future__ import annotations

import gzip
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
LEFT_OUT = shutil.ignore_patterns("__pycache__", "build", ".*", "*.egg-info")

MADE = ("build", "vectors")

DRIVER = """
import io, json, os, sys, traceback
import modeproof.cli, cvc5, networkx, tomlkit, msgspec, z3  # loaded once, for every case
from pathlib import Path

def stage(document):
    from modeproof.lane.verify import _registers_of
    record = _registers_of(Path.cwd(), document, "full", False)
    print(record["verdict"], record["reason"], *record["result"]["problems"], sep="\\n")
    return {"EQUAL": 0, "DIFFERS": 1}.get(record["verdict"], 2)

for line in sys.stdin:
    words, out = json.loads(line)
    child = os.fork()
    if child == 0:
        status = 99
        with open(out, "w") as said:
            os.dup2(said.fileno(), 1)
            os.dup2(said.fileno(), 2)
            try:
                status = stage(words[1]) if words[0] == "stage" else modeproof.cli.main(words)
            except SystemExit as end:
                status = int(end.code or 0)
            except BaseException as error:
                text = getattr(error, "message", "")
                print(text or traceback.format_exc())
                status = 2 if text else 99
            sys.stdout.flush(); sys.stderr.flush()
        os._exit(status)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""


@dataclass(frozen=True)
class Case:
    """One line that is changed, who must notice, and what follows.

    `old` stands once in `file`; `new` takes its place, or, None, the file is gone. command: `stage DOCUMENT`
    is what `make verify` does with its registers; anything else is a command of modeproof. says: a part of
    what is printed.
    """

    name: str
    file: str
    old: str
    new: str | None
    command: str
    status: int
    says: str


class Copy:
    """A copy of the repository, and a process that judges it."""

    def __init__(self, root: Path) -> None:
        self.root = root
        env = {**os.environ, "MODEPROOF_ROOT": str(root), "PYTHONPATH": str(root), "CI": "1"}
        self._process = subprocess.Popen(
            [sys.executable, "-c", DRIVER],
            cwd=root,
            env={**env, "PYTHONDONTWRITEBYTECODE": "1"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def judged(self, command: str) -> tuple[int, str]:
        """Exit status and output of a command on the copy as it is now."""
        assert self._process.stdin is not None and self._process.stdout is not None
        out = self.root / "said.txt"
        self._process.stdin.write(json.dumps([command.split(), str(out)]) + "\n")
        self._process.stdin.flush()
        status = int(self._process.stdout.readline())
        return status, out.read_text(encoding="utf-8", errors="replace")

    @contextmanager
    def changed(self, case: Case) -> Iterator[None]:
        """The copy with the line of a case changed."""
        path = self.root / case.file
        kept = path.read_bytes()
        packed = path.suffix == ".gz"
        text = (gzip.decompress(kept) if packed else kept).decode("utf-8")
        try:
            path.unlink()
            if case.new is not None:
                assert text.count(case.old) == 1, (
                    f"{case.file}: {case.old!r} is there {text.count(case.old)} times"
                )
                data = text.replace(case.old, case.new).encode("utf-8")
                path.write_bytes(gzip.compress(data, mtime=0) if packed else data)
            yield
        finally:
            path.write_bytes(kept)

    def keep(self) -> None:
        """What is built now is what every case finds (see `as_kept`)."""
        for name in MADE:
            shutil.copytree(self.root / name, self.root / "kept" / name)

    def as_kept(self) -> None:
        """Take back what a command has written."""
        for name in MADE if (self.root / "kept").is_dir() else ():
            shutil.rmtree(self.root / name)
            shutil.copytree(self.root / "kept" / name, self.root / name)

    def close(self) -> None:
        """End the process that judges."""
        assert self._process.stdin is not None
        with self._process:
            self._process.stdin.close()


def linked(source: Any, target: Any) -> Any:
    """A hard link, or a copy where that cannot be."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copy2(source, target)
    return target


def copy_of(root: Path, place: Path) -> Path:
    """A copy of the repository made of hard links, without what is built."""
    shutil.copytree(root, place, ignore=LEFT_OUT, copy_function=linked)
    return place
