"""Builds one piece of evidence: the fields that are the same for every kind are filled in here."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import platform
import time
from collections.abc import Iterable, Mapping
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.meaning import is_there, meaning, reached
from modeproof.ground.places import TREE

SCHEMA_VERSION = 1
_OF_THE_RUN = frozenset({"started", "seconds", "machine", "tools", "command", "seal"})
_OF_TIME_AND_HOST = frozenset(
    {"seconds", "work", "shared", "first_difference_s", "tlc_command", "log", "workers", "heap_mb"}
)
"""Keys of a record, and of its `result`, that may be others when the same thing is found again."""


def sha256(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal. Raises Unjudged when the file cannot be read."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise Unjudged(f"{path}: {error.strerror or error}") from None


def tool(version: str, path: Path | None = None) -> dict[str, str | None]:
    """One entry of `tools`: a version, and the hash of the file that was run when there is one."""
    return {"version": version, "sha256": None if path is None else sha256(path)}


@cache
def package(name: str) -> dict[str, str | None]:
    """One entry of `tools` for an installed package: its version, and one hash over all files that it brings.

    What the installer writes is left out, so that the same wheel has the same hash everywhere. Raises
    Unjudged when a file of it is not there.
    """
    try:
        found = metadata.distribution(name)
    except metadata.PackageNotFoundError:
        return tool("not installed")
    digest = hashlib.sha256()
    for path in sorted(found.files or ()):
        if path.suffix != ".pyc" and path.parts[0] != ".." and not path.parts[0].endswith(".dist-info"):
            own = tool("", Path(str(path.locate())))["sha256"]
            digest.update(f"{path.as_posix()} {own}\n".encode())
    return {"version": found.version, "sha256": digest.hexdigest()}


@cache
def solvers() -> dict[str, dict[str, str | None]]:
    """The entries of both solvers, as they are installed."""
    return {"z3": package("z3-solver"), "cvc5": package("cvc5")}


def other_tools(place: Path, record: Mapping[str, Any]) -> tuple[str, ...]:
    """The tools that made a piece of evidence and have changed since, as far as they can be compared.

    Solvers of another system are other files of the same package, so only those of one like this are.
    """
    alike = all(record["machine"][key] == machine()[key] for key in ("system", "arch"))
    try:
        now = {**own_tools(place, *record["code"]), **(solvers() if alike else {})}
    except Unjudged:  # a module that judged it is there no more
        now = {"modeproof": tool("another", None)}
    return tuple(
        f"{name} (the tool)"
        for name, entry in record["tools"].items()
        if entry["sha256"] is not None and entry["sha256"] != now.get(name, entry)["sha256"]
    )


def result_sha256(record: Mapping[str, Any]) -> str:
    """SHA-256 of what was found, on which files: the same whenever and wherever it is found again.

    Times, the machine, versions of tools and the command as it was typed are left out.
    """

    def kept(value: Any) -> Any:
        if isinstance(value, Mapping):
            return {key: kept(inner) for key, inner in value.items() if key not in _OF_TIME_AND_HOST}
        return list(map(kept, value)) if isinstance(value, (list, tuple)) else value

    found = {key: kept(value) for key, value in record.items() if key not in _OF_THE_RUN}
    return sha256_of(found)


def seal_of(record: Mapping[str, Any]) -> str:
    """SHA-256 of all that a record says: who edits it without thought is found out."""
    return sha256_of({key: value for key, value in record.items() if key != "seal"})


def sealed(record: Mapping[str, Any]) -> dict[str, Any]:
    """The record as a file holds it, with its seal."""
    said: dict[str, Any] = json.loads(json.dumps(record))
    return said | {"seal": seal_of(said)}


def is_sealed(record: Mapping[str, Any]) -> bool:
    """Whether a record says what it said when it was written."""
    return "seal" in record and record["seal"] == seal_of(record)


def day(started: float) -> str:
    """When something began, as evidence says it; `started` is seconds since the epoch."""
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(started))


def sha256_of(value: Any) -> str:
    """SHA-256 of a value as JSON."""
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


@cache
def own_tools(place: Path = TREE, *code: str) -> dict[str, dict[str, str | None]]:
    """Version and hash of modeproof itself, and the version of Python.

    The hash is of the meaning of these modules, which lie below `place` or in the tree of this package, and
    of all of ours that they need; none named: of all Python of the package, byte for byte. Raises Unjudged
    when a module is not there.
    """
    digest = hashlib.sha256()
    found: dict[str, str] = {}
    for entry in code:
        root = place if is_there(place, entry) else TREE
        found |= {path.relative_to(root).as_posix(): meaning(path) for path in reached(root, entry)}
    package = TREE / "modeproof"
    for source in () if code else sorted(package.rglob("*.py")):
        found[source.relative_to(package).as_posix()] = sha256(source)
    digest.update(repr(sorted(found.items())).encode())
    try:
        version = metadata.version("modeproof")
    except metadata.PackageNotFoundError:
        version = "not installed"
    return {
        "modeproof": {"version": version, "sha256": digest.hexdigest()},
        "python": {"version": platform.python_version(), "sha256": None},
    }


@cache
def machine() -> dict[str, Any]:
    """What this computer is: system, architecture, processor, cores, memory in MiB (0: unknown)."""
    cpu = platform.processor()
    with contextlib.suppress(OSError), open("/proc/cpuinfo", encoding="utf-8") as lines:
        cpu = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), cpu)
    return {
        "system": f"{platform.system()} {platform.release()}",
        "arch": platform.machine(),
        "cpu": cpu,
        "cores": os.cpu_count() or 1,
        "memory_mb": _memory_mb(),
    }


def _memory_mb() -> int:
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // (1 << 20)
    except (OSError, ValueError, AttributeError):  # the last is Windows
        return 0


def make(
    *,
    kind: str,
    id: str,
    document: str,
    verdict: str,
    expected: str,
    as_expected: bool,
    command: str,
    started: float,
    seconds: float,
    environment: str = "",
    strength: str = "",
    inputs: Mapping[str, str] | None = None,
    tools: Mapping[str, Mapping[str, str | None]] | None = None,
    code: Iterable[str] = (),
    place: Path = TREE,
    result: Mapping[str, Any] | None = None,
    reason: str = "",
) -> dict[str, Any]:
    """One piece of evidence, ready to be written.

    `started` is seconds since the epoch, `seconds` the duration; `inputs` are the meanings of the files that
    it rests on, `code` the modules below `place` that judged. The machine and the Python are always recorded.
    """
    code = tuple(code)
    return sealed(
        {
            "schema_version": SCHEMA_VERSION,
            "kind": kind,
            "id": id,
            "document": document,
            "verdict": verdict,
            "expected": expected,
            "as_expected": as_expected,
            "environment": environment,
            "strength": strength,
            "command": command,
            "started": day(started),
            "seconds": round(seconds, 3),
            "inputs": dict(inputs or {}),
            "code": list(code),
            "tools": {
                **own_tools(place, *code),
                **{name: dict(entry) for name, entry in (tools or {}).items()},
            },
            "machine": machine(),
            "result": dict(result or {}),
            "reason": " ".join(reason.split()),
        }
    )
