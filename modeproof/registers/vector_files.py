"""The published vectors: what a file holds, and from what each target was made.

SHA256SUMS says both. Its sums show that nobody edited a file; `sha256sum -c` reads them. In its comments,
which that skips, stands for each target the meaning of everything that its vectors depend on. So drift shows
without making them again, and a comment in a source is no drift.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import re
import zlib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.files import write_whole
from modeproof.ground.meaning import meaning_of, meanings, reached
from modeproof.ground.places import documents, machines
from modeproof.registers.citations import Sources, citations
from modeproof.registers.load import load_document, load_interface
from modeproof.registers.made import cfg_text
from modeproof.registers.rows import Device, Problem
from modeproof.registers.runs import load_runs
from modeproof.registers.stale import stale
from modeproof.registers.tla import read_modules

ROOM = "vectors"
SUMS = "SHA256SUMS"
DECIDING = ("interface", "sequences", "replay")
"""Registers of a document that decide what a vector holds. Others give its sentences."""
WIRED = ("wiring.toml", "use.toml")
"""Files of a machine that decide it, besides the code of its reference and of the blocks."""
SHOWN = 16
"""Digits of a hash in a comment."""
_MADE_FROM = re.compile(rf"# (\S+) ([0-9a-f]{{{SHOWN}}}) (.+)")
_ERRORS = (OSError, EOFError, ValueError, zlib.error, LookupError, TypeError, AttributeError)
"""What reading a file that is none of vectors may raise."""
Meanings = Mapping[str, str]
"""By the name of a source, the beginning of the hash of its meaning."""


@dataclass(frozen=True)
class VectorFile:
    """One file of the room, its lines as the schema says."""

    header: Mapping[str, Any]
    cases: tuple[Mapping[str, Any], ...]


def vectors_path(target: str, suite: str) -> str:
    """The file of a suite, relative to the root."""
    return f"{ROOM}/{target}/{suite}.jsonl.gz"


def read_vectors(packed: bytes) -> VectorFile:
    """A whole file. Raises Unjudged where it is damaged, or does not hold the cases that it counts."""
    try:
        header, *cases = map(json.loads, gzip.decompress(packed).decode("utf-8").rstrip("\n").split("\n"))
        counted = int(header["cases"])
    except _ERRORS as error:
        raise Unjudged(_no_file(error)) from None
    if len(cases) != counted:
        raise Unjudged(f"holds {len(cases)} cases and says {counted}")
    return VectorFile(header, tuple(cases))


# ---------------------------------------------------------------------- what they are made of


def document_of(root: Path, target: str) -> str:
    """The document or machine that a target belongs to; empty where there is none."""
    return next((name for name in documents(root) if target in _devices(root, name)), "") or (
        target if target in machines(root) else ""
    )


def made_from(root: Path, target: str) -> Meanings:
    """The meaning of everything that the vectors of a target depend on, as it is now; nothing where there is
    no such target. Raises Unjudged when a file cannot be read.

    Of a device these are the modules and cfgs of its graphs, the registers that decide, and what its steps
    cite; of a machine its wiring, its stories, and the code of its reference.
    """
    document = document_of(root, target)
    if document in machines(root):
        folder = root / "spec" / document
        files = [*reached(root, f"refimpl/{document}"), *(folder / name for name in WIRED)]
        return _short(meanings(root, [path for path in files if path.is_file()]))
    return _of_device(root, document, target) if document else {}


def _of_device(root: Path, document: str, target: str) -> Meanings:
    folder = root / "spec" / document
    runs = [run for run in load_runs(root, document) if run.graph is not None and run.graph.device == target]
    modules = {path for run in runs for path in reached(root, folder / f"{run.module}.tla")}
    registers = [path for name in DECIDING if (path := folder / f"{name}.toml").is_file()]
    found = meanings(root, [*modules, *registers])
    for run in runs:
        assert run.graph is not None
        graph = msgspec.to_builtins(run.graph) | {"states": None, "edges": None}  # counts decide nothing
        said = meaning_of("run.cfg", cfg_text(root, run).encode()) + json.dumps(graph, sort_keys=True)
        found[f"spec/{document}/runs.toml, {run.id}"] = hashlib.sha256(said.encode()).hexdigest()
    device = _devices(root, document)[target]
    cited = json.dumps(step_citations(root, document, device), sort_keys=True)
    found[f"what the steps of {device.module} cite"] = hashlib.sha256(cited.encode()).hexdigest()
    return _short(found)


def step_citations(
    root: Path, document: str, device: Device
) -> dict[str, tuple[tuple[str, ...], tuple[str, ...]]]:
    """The clauses and the findings that each step of a device cites in the specification; nothing where the
    registers cannot be read.
    """
    try:
        registers = load_document(root, document)
        found = citations(registers, Sources(read_modules(root, document), (), ()))
    except Unjudged:
        return {}
    table = {
        citation.name: (citation.clauses, citation.findings)
        for citation in found
        if citation.kind == "definition" and citation.room == "spec"
    }
    return {step: table[name] for step in device.steps if (name := f"{device.module}!{step}") in table}


def changed(root: Path, target: str) -> list[str]:
    """The sources of a target that are not, or are no longer, what its published vectors were made from."""
    then = _sealed(root).get(target, {})
    now = made_from(root, target)
    return [name for name in dict.fromkeys((*now, *then)) if now.get(name) != then.get(name)]


def _document(root: Path, target: str) -> str:
    """The document to name in the command; none for a machine, which hangs on all of them."""
    document = document_of(root, target)
    return "" if document in machines(root) else document


def _devices(root: Path, document: str) -> Mapping[str, Device]:
    there = (root / "spec" / document / "interface.toml").is_file()
    return load_interface(root, document).devices if there else {}


def _short(found: Mapping[str, str]) -> dict[str, str]:
    return {name: digest[:SHOWN] for name, digest in sorted(found.items())}


# ---------------------------------------------------------------------- what is published


def check_vectors(root: Path) -> list[Problem]:
    """Every target whose vectors were made from another text, and every file that is damaged or edited."""
    paths = published_files(root)
    sums = _sums(root)
    names = {_name(root, path) for path in paths}
    problems = [Problem(f"{ROOM}/{name}", "", "is not there") for name in sorted(set(sums) - names)]
    for path in paths:
        shown = path.relative_to(root).as_posix()
        problems += [
            Problem(shown, "", stale(text, _document(root, path.parent.name)))
            for text in _faults(path, sums.get(_name(root, path)))
        ]
    for target in dict.fromkeys([*(path.parent.name for path in paths), *_sealed(root)]):
        if text := why_stale(root, target):
            problems.append(Problem(f"{ROOM}/{target}", "", stale(text, _document(root, target))))
    return problems


def why_stale(root: Path, target: str) -> str:
    """What of a target has changed since its vectors were published; empty where nothing has."""
    names = changed(root, target)
    if not names:
        return "" if _sealed(root).get(target) else f"is not in {SUMS}: no target of this name is left"
    more = f" and {len(names) - 1} more" if len(names) > 1 else ""
    verb = "have" if more else "has"
    return f"{names[0]}{more} {verb} changed since it was published"


def unfit(root: Path, target: str) -> str:
    """Why the vectors of a target cannot be used as they lie there; empty where they can."""
    sums = _sums(root)
    paths = published_files(root, target)
    lost = [name for name in sums if name.startswith(f"{target}/") and not (root / ROOM / name).is_file()]
    faults = [f"{path.name} {text}" for path in paths for text in _faults(path, sums.get(_name(root, path)))]
    return next(iter([*faults, *(f"{name} is not there" for name in lost)]), "") or why_stale(root, target)


def published_files(root: Path, target: str | None = None) -> list[Path]:
    """The published files of a target (whatever a user calls one), or of all."""
    found = sorted((root / ROOM).glob("*/*.jsonl.gz"))
    return [path for path in found if target in (None, path.parent.name)]


def suite_name(path: Path) -> str:
    """The suite of a published file."""
    return path.name.removesuffix(".jsonl.gz")


def of_machine(path: Path) -> bool:
    """Whether a file holds vectors of a whole machine, whose header has its wiring."""
    try:
        with gzip.open(path, "rb") as lines:
            return "wiring" in json.loads(next(lines, b""))
    except _ERRORS:
        return False


def published(root: Path, target: str, suite: str) -> Path | None:
    """The published file of a suite, if it is sealed, whole and of the specification as it is now."""
    path = root / vectors_path(target, suite)
    if not path.is_file() or any(_faults(path, _sums(root).get(_name(root, path)))):
        return None
    return None if why_stale(root, target) else path


def seal(root: Path, targets: Collection[str]) -> None:
    """Write SHA256SUMS: the sum of every file, and what these targets are made from now; of others as it was.

    Raises Unjudged when it cannot be written.
    """
    rows: dict[str, Meanings] = {
        name: of for name, of in _sealed(root).items() if any(published_files(root, name))
    }
    rows |= {name: made_from(root, name) for name in targets if any(published_files(root, name))}
    lines = [
        f"# {target} {digest} {name}" for target in sorted(rows) for name, digest in rows[target].items()
    ]
    lines += [f"{_sha256(path)}  {_name(root, path)}" for path in published_files(root)]
    write_whole(root / ROOM / SUMS, "".join(f"{line}\n" for line in lines).encode())


def _sealed(root: Path) -> dict[str, dict[str, str]]:
    """For each target what its vectors were made from, as SHA256SUMS says."""
    found: dict[str, dict[str, str]] = {}
    for line in _lines(root):
        if match := _MADE_FROM.fullmatch(line):
            found.setdefault(match[1], {})[match[3]] = match[2]
    return found


def _sums(root: Path) -> dict[str, str]:
    """The SHA-256 of each published file, as SHA256SUMS says."""
    return dict(line.split("  ")[::-1] for line in _lines(root) if not line.startswith("#"))


def _lines(root: Path) -> list[str]:
    path = root / ROOM / SUMS
    return path.read_text(encoding="utf-8").splitlines() if path.is_file() else []


def _name(root: Path, path: Path) -> str:
    return path.relative_to(root / ROOM).as_posix()


def _faults(path: Path, listed: str | None) -> Iterator[str]:
    if listed != _sha256(path):
        yield f"was changed since it was published, says {ROOM}/{SUMS}" if listed else f"is not in {SUMS}"
    try:
        with gzip.open(path, "rb") as lines:
            int(json.loads(next(lines, b""))["cases"])
            for line in lines:
                if 0 < line.count(b'"dt_ms":') == line.count(b'"settling":true'):
                    yield f"compares nothing in case {json.loads(line)['id']}"
                    break
    except _ERRORS as error:
        yield _no_file(error)


def _no_file(error: BaseException) -> str:
    return f"is no file of vectors ({type(error).__name__})"


def _sha256(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""
