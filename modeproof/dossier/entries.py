"""What a dossier is about: each record of the project, whether it still stands, and what was never judged."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.places import PROJECT_FILE, project
from modeproof.ground.progress import Progress
from modeproof.output import outcome
from modeproof.output.options import records
from modeproof.output.outcome import Outcome, path_of
from modeproof.project.basis import basis_path, kept
from modeproof.project.entries import Adapter
from modeproof.project.file import Listed, Project, Wrong, read
from modeproof.project.judging import Judging

FAILED, STALE, OPEN, STANDS = "failed", "stale", "open", "stands"
ORDER = (FAILED, STALE, OPEN, STANDS)
"""In this order entries stand in a dossier: the worst first."""
NEVER = "never judged"


@dataclass(frozen=True)
class Entry:
    """One record, or an entry of the project file without one."""

    name: str
    found: Outcome | None
    stale: Sequence[str] = ()
    """What has changed since: a sentence each."""
    trouble: str = ""
    """Why there is no record that counts."""
    again: str = ""

    @property
    def state(self) -> str:
        """Whether it stands, and if not why."""
        if self.found is None:
            return OPEN
        if self.found.status == 1:
            return FAILED
        if self.stale:
            return STALE
        return OPEN if self.found.status else STANDS

    @property
    def status(self) -> int:
        """As an exit status: what is stale is not judged."""
        return {FAILED: 1, STANDS: 0}.get(self.state, 2)


@dataclass(frozen=True)
class Entries:
    """All of a project. troubles: what is wrong with the project file."""

    rows: Sequence[Entry]
    troubles: Sequence[str] = ()
    files: Mapping[str, str] = field(default_factory=dict)
    """The records that were read, with their hashes."""

    @property
    def status(self) -> int:
        """1 if an entry is not as expected, else 2 if one does not stand or there is none, else 0."""
        statuses = {entry.status for entry in self.rows}
        return 1 if 1 in statuses else 0 if statuses == {0} and not self.troubles else 2


def gather() -> Entries:
    """The records of this project, the worst first, then as the project file lists them."""
    troubles: list[str] = []
    listed = None
    try:
        listed = _listed()
    except Wrong as error:
        troubles += error.lines
    except Unjudged as error:
        troubles.append(error.message)
    order = {entry.name: number for number, entry in enumerate(listed.entries)} if listed else {}
    rows, files = [], {}
    for path in sorted(records().glob("*.json")):
        name = path.stem
        try:
            files[name] = hashlib.sha256(path.read_bytes()).hexdigest()
            found = outcome.read(path)
        except (OSError, Unjudged) as error:
            why = error.message if isinstance(error, Unjudged) else str(error)
            rows.append(Entry(name, None, trouble=why, again=_again(name, order)))
            continue
        stale = [*_stale(found), *(_basis(listed, name) if listed else ())]
        again = _again(name, order) if name in order else found.again
        rows.append(Entry(name, found, list(dict.fromkeys(stale)), again=again))
    known = {entry.name for entry in rows}
    rows += [
        Entry(name, None, trouble=NEVER, again=_again(name, order)) for name in order if name not in known
    ]
    rows.sort(key=lambda entry: (ORDER.index(entry.state), order.get(entry.name, len(order)), entry.name))
    return Entries(rows, troubles, files)


def _listed() -> Project | None:
    """What the project file lists; None: there is none. Raises Unjudged and Wrong."""
    path = project() / PROJECT_FILE
    return read(path, PROJECT_FILE) if path.is_file() else None


def _again(name: str, listed: Mapping[str, Any]) -> str:
    return f"modeproof judge {name}" if name in listed else "judge it again by its command"


def _stale(found: Outcome) -> Iterator[str]:
    """The files that are not as they were when they were judged."""
    for file in found.files:
        try:
            now = hashlib.sha256(path_of(file.path).read_bytes()).hexdigest()
        except OSError:
            yield f"{file.path} is gone"
            continue
        if now != file.sha256:
            yield f"{file.path} has changed since"


def _basis(listed: Project, name: str) -> Iterator[str]:
    """What else has changed, by what `judge` noted: the row of the project file, the tool."""
    entry = next((one for one in listed.entries if one.name == name), None)
    if entry is None or not _is_noted(entry):
        return
    judging = Judging(listed, 1, Progress(quiet=True), lambda line: None)
    _, why = kept(name, judging.basis(entry), listed.folder)
    if why and not any(why.startswith(file) for file in _files(entry)):
        yield why


def _files(entry: Listed) -> list[str]:
    return [path for _, path in entry.row.paths()]


def _is_noted(entry: Listed) -> bool:
    """Whether `judge` noted what it rests on; of an adapter that it cannot look into it never can."""
    blind = isinstance(entry.row, Adapter) and not entry.row.files
    return not blind and basis_path(entry.name).is_file()


def shown_folder(path: Path) -> str:
    """A folder by its own name: a dossier names no place of this machine."""
    return path.resolve().name or "project"
