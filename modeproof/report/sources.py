"""What the report is made from: registers and evidence files, each with its hash.

What is missing is kept as a trouble, never dropped.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import OURS, YOURS, evidence_path, read
from modeproof.ground.evidence.record import other_tools, result_sha256, sha256
from modeproof.ground.meaning import meaning
from modeproof.ground.places import build, documents, located, machines, within
from modeproof.registers.load import load_document
from modeproof.registers.rows import Document
from modeproof.report.evidence_judge import contradiction, doubt_on_machine
from modeproof.report.filing import Filing

T = TypeVar("T")
NOTE, DIFFERS, HOLE = 0, 1, 2
"""What a trouble is: something to know, which changes no status; something is not as expected or contradicts
something else; something is not there."""


@dataclass(frozen=True)
class Trouble:
    """Something that the report must say before all else.

    `status` is NOTE, DIFFERS or HOLE; `part` is the id of the part of the page where it shows; `items` is
    what the one cause concerns, where that is more than `what` can name.
    """

    status: int
    part: str
    what: str
    remedy: str = ""
    items: tuple[str, ...] = ()


@dataclass(frozen=True)
class Figure:
    """A number or word of the page that a machine measured, and its file relative to the root."""

    value: int | float | str | bool | None
    source: str
    unit: str = ""


@dataclass(frozen=True)
class Evidence:
    """One piece of evidence: its record, its file relative to the root, the SHA-256 of that file, and that
    of what was found, apart from times and host.

    `changed`, `gone`: the files that it rests on or made which are no longer what they were, or not there;
    a tool that made it and is no longer what it was is in `changed` too.
    """

    record: Mapping[str, Any]
    path: str
    sha256: str
    result_sha256: str = ""
    changed: tuple[str, ...] = ()
    gone: tuple[str, ...] = ()

    @property
    def id(self) -> str:
        """The run, theorem or comparison."""
        return str(self.record["id"])

    @property
    def artefacts(self) -> tuple[str, ...]:
        """The files that it made for the report and that are what it made; each is in `Sources.files`."""
        made: Mapping[str, str] = self.result.get("artefacts", {})
        return tuple(file for file in made if file not in self.changed and file not in self.gone)

    @property
    def result(self) -> Mapping[str, Any]:
        """What was found, by kind."""
        result: Mapping[str, Any] = self.record["result"]
        return result

    def figure(self, *keys: str, unit: str = "") -> Figure:
        """A value of the record by its keys, with its source; None where there is none."""
        value: Any = self.record
        for key in keys:
            value = value.get(key) if isinstance(value, Mapping) else None
        return Figure(value, self.path, unit)


@dataclass(frozen=True)
class Sources:
    """Registers and evidence of all documents.

    `files` is the hash of every file that was read, and of those that evidence rests on, by its path relative
    to the root (`hash_of`); a part that reads another file reads it by `content`, so that it is among them.
    """

    root: Path
    documents: Mapping[str, Document]
    evidence: Mapping[str, Mapping[str, Evidence]]
    files: dict[str, str]
    troubles: tuple[Trouble, ...] = ()
    yours: Mapping[str, Mapping[str, Evidence]] = field(default_factory=dict)
    """What was found out about a user's programs and logs: shown, and counted for nothing."""
    filing: Filing = field(default_factory=Filing)
    """What the caller says about the report."""
    machines: Mapping[str, Evidence | None] = field(default_factory=dict)
    """The evidence on each machine of the project's own, which is no document. None: there is none."""
    cache: dict[str, Any] = field(default_factory=dict, compare=False, repr=False)
    """What a part worked out and another may use again."""

    def once(self, key: str, make: Callable[[], T]) -> T:
        """What is made under this key, the first time that it is asked for."""
        if key not in self.cache:
            self.cache[key] = make()
        found: T = self.cache[key]
        return found

    def of_kind(self, document: str, kind: str) -> list[Evidence]:
        """The evidence of a document of one kind (tlc, conformance, proof, agreement, registers, ..)."""
        return [record for record in self.evidence[document].values() if record.record["kind"] == kind]

    def everything(self) -> Iterator[Evidence]:
        """All evidence, by document and id."""
        for of_document in self.evidence.values():
            yield from of_document.values()
        yield from filter(None, self.machines.values())

    @property
    def results(self) -> dict[str, str]:
        """For each file of evidence the SHA-256 of what was found, apart from times and host."""
        return {piece.path: piece.result_sha256 for piece in self.everything()}

    def content(self, path: str) -> bytes | None:
        """A file by its path relative to the root, and from now on one of `files`; None: there is none."""
        try:
            content = located(self.root, path).read_bytes()
        except OSError:
            return None
        self.files[path] = hash_of(self.root, path) or ""
        return content

    @property
    def digest(self) -> str:
        """One SHA-256 over all files that were read until now."""
        return self.digest_of("")

    def digest_of(self, folder: str) -> str:
        """The same over the files below a folder, whose name ends with a slash."""
        some = {path: digest for path, digest in self.files.items() if path.startswith(folder)}
        lines = "".join(f"{digest}  {path}\n" for path, digest in sorted(some.items()))
        return hashlib.sha256(lines.encode()).hexdigest()


def gather(root: Path, filing: Filing | None = None) -> Sources:
    """Read all there is, or what is of the chosen documents, in the order of the texts that they are about.

    A register or a piece of evidence that is damaged becomes a trouble; the rest is read.
    Raises Unjudged only when there is no document at all.
    """
    filing = filing or Filing()
    chosen = [name for name in documents(root) if name in (filing.documents or (name,))]
    if not chosen:
        raise Unjudged("spec/ holds no document; there is nothing to report")
    troubles: list[Trouble] = []
    files: dict[str, str] = {}
    found: dict[str, Document] = {}
    evidence: dict[str, dict[str, Evidence]] = {}
    yours: dict[str, dict[str, Evidence]] = {}
    hashes = _Hashes(root)
    for name in chosen:
        try:
            found[name] = load_document(root, name)
        except Unjudged as error:
            what = error.message.replace(f"{root}/", "")
            troubles.append(Trouble(HOLE, "scope", what, f"modeproof registers --document {name}"))
            continue
        for path in sorted((root / "spec" / name).glob("*.toml")):
            shown = path.relative_to(root).as_posix()
            files[shown] = hashes[shown] or ""
        pieces: dict[str, dict[str, Evidence]] = {OURS: {}, YOURS: {}}
        for folder, of in pieces.items():
            for path in sorted((build(root) / folder / name).glob("*.json")):
                shown = within(root, path)
                files[shown] = hashes[shown] or ""
                try:
                    piece, before = _piece(root, partial(contradiction, root, found[name]), path, hashes)
                except Unjudged as error:
                    what = error.message.replace(f"{root}/", "")
                    remedy = "modeproof verify" if folder == OURS else "modeproof conform"
                    status, part = (HOLE, "verdict") if folder == OURS else (NOTE, "conformance")
                    troubles.append(Trouble(status, part, what, remedy))
                    files.pop(shown)
                    continue
                if folder == OURS:
                    files |= {file: digest for file in before if (digest := hashes[file]) is not None}
                of[path.stem] = piece
        evidence[name], yours[name] = pieces[OURS], pieces[YOURS]
        if not evidence[name]:
            what = f"{name}: there is no evidence in build/evidence/{name}/"
            troubles.append(Trouble(HOLE, "verdict", what, f"modeproof verify --document {name}"))
    own = dict(_machines(root, hashes, files)) if not filing.documents else {}
    ordered = sorted(found.values(), key=lambda one: (one.about.seed, one.name))
    troubles += _stale({document.name: evidence[document.name] for document in ordered})
    return Sources(
        root,
        {document.name: document for document in ordered},
        {document.name: evidence[document.name] for document in ordered},
        dict(sorted(files.items())),
        tuple(troubles),
        {document.name: yours[document.name] for document in ordered},
        filing,
        own,
    )


def _machines(root: Path, hashes: _Hashes, files: dict[str, str]) -> Iterator[tuple[str, Evidence | None]]:
    """The evidence on each machine; what was read for it is among the files from now on."""
    for name in machines(root):
        path = evidence_path(root, name, "machine")
        read_files = [*sorted((root / "spec" / name).glob("*.toml")), *([path] if path.exists() else [])]
        piece: Evidence | None = None
        before: Sequence[str] = ()
        if path.exists():
            try:
                piece, before = _piece(root, doubt_on_machine, path, hashes)
            except Unjudged:  # its part says so
                read_files.pop()
        shown = [within(root, file) for file in read_files]
        files |= {file: digest for file in (*shown, *before) if (digest := hashes[file]) is not None}
        yield name, piece


def _piece(
    root: Path, doubt: Callable[[Mapping[str, Any]], str], path: Path, hashes: _Hashes
) -> tuple[Evidence, Sequence[str]]:
    """One piece of evidence, and the files that it rests on or made. Raises Unjudged as `read` does."""
    record, shown = read(path), within(root, path)
    artefacts = record["result"].get("artefacts", {})
    before = {**record["inputs"], **(artefacts if isinstance(artefacts, Mapping) else {})}
    changed = (
        *other_tools(root, record),
        *(one for one, digest in before.items() if hashes[one] not in (digest, None)),
    )
    gone = tuple(file for file in before if hashes[file] is None)
    found = result_sha256(record)
    if why := "" if changed else doubt(record):
        record |= {"as_expected": False, "reason": f"the evidence contradicts itself: {why}"}
    return Evidence(record, shown, hashes[shown] or "", found, changed, gone), tuple(before)


def few(names: Sequence[str], most: int = 3) -> str:
    """The first of several names, and how many more there are."""
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def _stale(evidence: Mapping[str, Mapping[str, Evidence]]) -> Iterator[Trouble]:
    """Evidence of other texts than the present ones: one trouble a document, and one for all that rests on
    files of build/ that went: the command that made them makes them again.
    """
    unmade: dict[str, list[str]] = {}
    for name, of in evidence.items():
        items: list[str] = []
        files: dict[str, int] = {}
        for piece in of.values():
            for path in piece.gone:
                if path.startswith("build/"):
                    unmade.setdefault(path, []).append(piece.id)
            bad = (*piece.changed, *(path for path in piece.gone if not path.startswith("build/")))
            if bad:
                items.append(f"{piece.id} ({', '.join(bad)})")
                files |= {path: files.get(path, 0) + 1 for path in bad}
        if items:
            most = sorted(files, key=lambda path: (-files[path], path))
            what = (
                f"{name}: {len(items)} of {len(of)} pieces of evidence are of another text ({few(most, 2)})"
            )
            yield Trouble(HOLE, "verdict", what, f"modeproof verify --document {name}", tuple(items))
    if unmade:
        what = f"files were made, used and are not there now: {few(tuple(unmade))}"
        lost = tuple(f"{path} ({few(ids)})" for path, ids in unmade.items())
        yield Trouble(NOTE, "reproduce", what, "", lost)


def version_of(name: str, entry: Mapping[str, Any]) -> tuple[str, str]:
    """The version of a tool, and its hash; that of modeproof is of the modules that judged each piece, so it
    is no version of the tool.
    """
    return str(entry["version"]), "" if name == "modeproof" else str(entry["sha256"] or "")


def hash_of(root: Path, path: str) -> str | None:
    """The meaning of a file by its path relative to the root; None: no such file.

    Of evidence it is the SHA-256, as `sha256sum` gives it: nobody writes that by hand.
    """
    try:
        return (sha256 if path.startswith(f"build/{OURS}/") else meaning)(located(root, path))
    except Unjudged:
        return None


class _Hashes(dict[str, str | None]):
    """The hashes of files by their path relative to the root, each made once; None: no such file."""

    def __init__(self, root: Path) -> None:
        super().__init__()
        self._root = root

    def __missing__(self, path: str) -> str | None:
        self[path] = hash_of(self._root, path)
        return self[path]
