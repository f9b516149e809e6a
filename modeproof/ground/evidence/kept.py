"""Whether a result of an earlier day is still valid: what it rests on is the same, and nobody touched it.

It is judged again if it was not as expected; if a file, a tool or a module that judged it means something
else now; if its evidence, or a file that it made, is not what was written.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.ground.evidence.record import is_sealed, own_tools, sha256_of
from modeproof.ground.meaning import meaning
from modeproof.ground.places import located

_NO_PART_OF_A_RESULT = frozenset({"start-up cache"})
"""Tools that make a result come sooner and no other."""


@dataclass(frozen=True)
class Rests:
    """What a result rests on: the meanings of files by path, the modules that judge it, the tools.

    `said`: what its `result` must say as well, such as the hash of the row of its register.
    """

    inputs: Mapping[str, str]
    code: tuple[str, ...] = ()
    tools: Mapping[str, Mapping[str, str | None]] = field(default_factory=dict)
    said: Mapping[str, str] = field(default_factory=dict)

    def digest(self, place: Path) -> str:
        """One hash of it all, for a part of a result that is kept by itself. Raises Unjudged."""
        every = {**own_tools(place, *self.code), **self.tools}
        tools = {name: _which(name, every) for name in every.keys() - _NO_PART_OF_A_RESULT}
        return sha256_of([dict(self.inputs), self.code, tools, dict(self.said)])


def why_again(place: Path, record: Mapping[str, Any], rests: Rests, alone: bool = False) -> str:
    """Why a result must be judged again; empty where it is still valid. Raises Unjudged as `own_tools` does.

    alone: whatever judged it.
    """
    if not record["as_expected"]:
        return f"it was {record['verdict']}, not as expected"
    if not is_sealed(record):
        return "its evidence was changed since it was written"
    for name in sorted({*record["inputs"], *rests.inputs}):
        if record["inputs"].get(name) != rests.inputs.get(name):
            return f"{name} has changed"
    for name in rests.said:
        if record["result"].get(name) != rests.said[name]:
            return f"its {name} has changed"
    if not alone and tuple(record["code"]) != rests.code:
        return "other modules judge it now"
    tools = {} if alone else {**own_tools(place, *rests.code), **rests.tools}
    for name in sorted({*record["tools"], *tools} - _NO_PART_OF_A_RESULT) if tools else ():
        if _which(name, record["tools"]) != _which(name, tools):
            return "the code that judges it has changed" if name == "modeproof" else f"{name} is another"
    return next(
        (
            f"{name} is not what it made"
            for name, digest in made(record)
            if not _is(located(place, name), digest)
        ),
        "",
    )


def made(record: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """The files that a result left beside its evidence, each with the hash of its meaning."""
    result = record["result"]
    graph = result.get("graph", {})
    if "file" in graph:
        yield graph["file"], graph["sha256"]
    yield from result.get("artefacts", {}).items()
    for query in result.get("queries", ()):
        yield query["smt2"], query.get("smt2_sha256", "")


def _which(name: str, tools: Mapping[str, Mapping[str, str | None]]) -> tuple[str | None, ...] | None:
    """The hash and the version of a tool; what TLC says of itself is known only after it ran."""
    entry = tools.get(name)
    return None if entry is None else (entry["sha256"], None if name == "tlc" else entry["version"])


def _is(path: Path, digest: str) -> bool:
    try:
        return meaning(path) == digest
    except Unjudged:
        return False
