"""Judged mutants as they lie on the disk: one line of JSON each, appended as soon as it is known.

A file can be cut at any moment. A last line that is cut off is dropped with a remark; any other damage is an
error, for a result that cannot be read must not pass for one that is not there.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import threading
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import build

FORMAT = 1
_FIELDS = {"mutant", "module", "inputs", "complete", "verdict", "killers", "reason", "answers"}


@dataclass
class Results:
    """The results of one document's mutants, by mutant id and hash of the inputs."""

    path: Path
    records: dict[tuple[str, str], dict[str, Any]] = field(default_factory=dict)
    remark: str = ""
    _guard: threading.Lock = field(default_factory=threading.Lock)

    def of(self, mutant: str) -> list[dict[str, Any]]:
        """All results of a mutant, in the order in which they were found."""
        return [record for (known, _), record in self.records.items() if known == mutant]

    def add(self, record: Mapping[str, Any]) -> None:
        """Append one result. Raises Unjudged when it cannot be written."""
        line = json.dumps(record, ensure_ascii=False, separators=(",", ":"), sort_keys=True) + "\n"
        with self._guard:
            try:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                with self.path.open("ab") as stream:
                    stream.write(line.encode("utf-8"))
                    stream.flush()
                    os.fsync(stream.fileno())
            except OSError as error:
                raise Unjudged(f"{self.path}: cannot be written: {error.strerror or error}") from None
            self.records[record["mutant"], record["inputs"]] = dict(record)


def results_path(place: Path, document: str, what: str) -> Path:
    """Where the results lie; `what` is spec or impl."""
    return build(place) / "strength" / document / f"{what}.jsonl"


def read_results(path: Path) -> Results:
    """Read what there is. Drops a cut last line from the file; raises Unjudged for any other damage."""
    results = Results(path)
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return results
    except OSError as error:
        raise Unjudged(f"{path}: {error.strerror or error}") from None
    lines = content.split(b"\n")
    rest = lines.pop()
    if rest:
        results.remark = f"{path.name}: the last line was cut off and is dropped; its mutant is judged again"
        try:
            with path.open("r+b") as stream:
                stream.truncate(len(content) - len(rest))
        except OSError as error:
            raise Unjudged(f"{path}: cannot be mended: {error.strerror or error}") from None
    for number, line in enumerate(lines, 1):
        record = _record(path, number, line)
        results.records[record["mutant"], record["inputs"]] = record
    return results


def _record(path: Path, number: int, line: bytes) -> dict[str, Any]:
    try:
        record = json.loads(line)
    except (json.JSONDecodeError, UnicodeDecodeError):
        raise Unjudged(f"{path}: line {number} is damaged; delete it, or the file, and run again") from None
    if not isinstance(record, dict) or set(record) < _FIELDS:
        raise Unjudged(f"{path}: line {number} is no result; delete it, or the file, and run again")
    return record


def digest(parts: Iterable[str]) -> str:
    """A hash of texts, in their order."""
    whole = hashlib.sha256(str(FORMAT).encode())
    for part in parts:
        data = part.encode("utf-8")
        whole.update(len(data).to_bytes(8, "big") + data)
    return whole.hexdigest()[:16]


_COMMENT = re.compile(r'("[^"\n]*")|\\\*[^\n]*|\(\*.*?\*\)', re.DOTALL)


def without_comments(text: str) -> str:
    """A module's text without comments and without blanks at the end of lines: what TLC reads."""
    kept = _COMMENT.sub(lambda match: match[1] or "", text)
    return "\n".join(line.rstrip() for line in kept.split("\n"))
