"""What a command found about a user's program, wiring or log, in one shape.

`outcome.schema.json` is made of it. An `Outcome` is one run of a command. It has a `Demand` for each thing
that was asked: equality with a target, a property, a suite, a log. A demand that does not stand has a
`Problem`: which rule, where, and the scans.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Literal

import msgspec

from modeproof.ground.errors import LONGEST, Unjudged
from modeproof.ground.evidence import own_tools, sha256
from modeproof.ground.places import project, root
from modeproof.kit.errors import plain
from modeproof.kit.files import write_text

VERSION = 1
SCHEMA = "outcome.schema.json"
UNJUDGED = "UNJUDGED"
Json = Any
"""A value of a signal: a number, a text, true or false, or a list of them."""


class _Row(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Part of an outcome."""


class File(_Row, frozen=True, kw_only=True):
    """A file that was judged, or by which one was: its path from the project folder, with `/`."""

    path: str
    sha256: str
    role: str
    """`program`, `binding`, `properties`, `wiring`, `use`, `log`, `vectors`, `adapter`."""


class Tool(_Row, frozen=True, kw_only=True):
    """A tool that took part. sha256: of its files, where that is known."""

    name: str
    version: str
    sha256: str = ""


class Spot(_Row, frozen=True, kw_only=True):
    """A place in a file: its path from the project folder, with `/`. line, column: from 1; 0: not known."""

    file: str
    line: int = 0
    column: int = 0


class Rule(_Row, frozen=True, kw_only=True):
    """What a problem is about: an id, and a sentence that says it."""

    id: str
    kind: Literal["clause", "finding", "demand", "property", "target", "log"]
    sentence: str
    source: str = ""
    """Where it is: a document and its page, or a file."""


class Scan(_Row, frozen=True, kw_only=True):
    """One scan of a counterexample, with whole rows."""

    dt_ms: int | None
    """Since the scan before; None: not known."""
    inputs: dict[str, Json]
    given: dict[str, Json]
    """What the program gave, or what the log shows."""
    expected: dict[str, Json] = {}
    """What the reference gives; empty where it is a property that is broken."""
    note: str = ""
    """What the specification does here, where that is known."""
    spot: Spot | None = None
    """The line of the program that set what is wrong."""


class Counterexample(_Row, frozen=True, kw_only=True):
    """Scans from power-up; the last is the wrong one."""

    scans: list[Scan]
    parameters: dict[str, Json] = {}
    retained: dict[str, Json] = {}
    """The first values of RETAIN variables, where they are not their own."""
    wrong: list[str] = []
    """The outputs or signals that are wrong in the last scan, where they are known."""
    stopped: str = ""
    """Why the program stops in the last scan, where it does."""
    found_by: str = ""
    first: int = 1
    """The number of the first scan here: those before it are left out of a log."""


class Problem(_Row, frozen=True, kw_only=True):
    """What is wrong with one demand, or what is missing to judge it."""

    rule: Rule
    message: str
    others: list[Rule] = []
    """The other clauses and findings that it touches."""
    spot: Spot | None = None
    counterexample: Counterexample | None = None


class Demand(_Row, frozen=True, kw_only=True):
    """One thing that was asked, and the word that answers it."""

    id: str
    word: str
    sentence: str
    text: str = ""
    """The same in a formal language, where there is one."""
    strength: str = ""
    """How it was shown, or how far."""
    problems: list[Problem] = []
    required: bool = True
    """Whether the exit status depends on it: a program may follow its page and not be as the reference is."""


class Outcome(_Row, frozen=True, kw_only=True):
    """One run of a command. `status` is its exit status: 0 as expected, 1 not as expected, 2 not judged."""

    command: Literal["prove-program", "conform", "machine", "trace"]
    subject: str
    """What was examined: a block, a wiring, an adapter, a log."""
    target: str
    """What it was asked for: a published target, or a file of properties."""
    word: str
    """Of the whole; the words of the command, or UNJUDGED."""
    status: Literal[0, 1, 2]
    sentence: str
    """The verdict in a sentence."""
    again: str
    """The command line that does it again."""
    started: str
    seconds: float
    demands: list[Demand] = []
    files: list[File] = []
    tools: list[Tool] = []
    document: str = ""
    profile: str = ""
    strength: str = ""
    assumptions: list[str] = []
    trusted: list[str] = []
    not_shown: list[str] = []
    reason: str = ""
    """Why it was not judged."""
    text: str = ""
    """What the command printed."""
    schema_version: Literal[1] = 1
    seal: str = ""
    """SHA-256 of all the rest: who edits a record without thought is found out."""

    @property
    def problems(self) -> list[tuple[Demand, Problem]]:
        """All problems with the demands that they are of, those that the exit status depends on first."""
        rows = [(demand, problem) for demand in self.demands for problem in demand.problems]
        return sorted(rows, key=lambda row: not row[0].required)


def as_json(outcome: Outcome) -> str:
    """The outcome as a record, sealed."""
    sealed = msgspec.structs.replace(outcome, seal=_seal(outcome))
    return json.dumps(msgspec.to_builtins(sealed), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def write(path: Path, outcome: Outcome) -> None:
    """Write a record; its folder is made. Raises Unjudged."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise Unjudged(f"{path.parent}: cannot be made: {error.strerror or error}") from None
    write_text(path, as_json(outcome))


def read(path: Path) -> Outcome:
    """A record. Raises Unjudged: of another version, changed since it was written, or none at all."""
    again = "remove it and judge again"
    try:
        table = json.loads(path.read_text("utf-8"))
        if isinstance(table, dict) and (version := table.get("schema_version")) != VERSION:
            raise Unjudged(f"{path}: a record of version {version}, and this tool reads {VERSION}; {again}")
        found = msgspec.convert(table, Outcome)
    except OSError as error:
        raise Unjudged(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:  # also of msgspec, json and UTF-8
        raise Unjudged(f"{path}: no record: {error}; {again}") from None
    if found.seal != _seal(found):
        raise Unjudged(f"{path}: it was changed since it was written; {again}")
    return found


def unjudged(command: Any, subject: str, target: str, again: str, reason: str, **known: Any) -> Outcome:
    """The outcome of a run that ended without a verdict: a file is gone, or refused."""
    reason = plain(" ".join(reason.split()), LONGEST)
    sentence = f"{UNJUDGED}: {reason}"
    base = {"started": "", "seconds": 0.0, "tools": tools(), "text": sentence}
    return Outcome(
        command=command,
        subject=subject,
        target=target,
        word=UNJUDGED,
        status=2,
        sentence=sentence,
        again=again,
        reason=reason,
        **{**base, **known},
    )


def schema() -> dict[str, Any]:
    """The JSON schema of a record."""
    found = msgspec.json.schema(Outcome)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "modeproof outcome", **found}


def tools(versions: Mapping[str, str] | None = None) -> list[Tool]:
    """modeproof itself, with its hash, Python, and other tools by their versions."""
    own = own_tools().items()
    found = [Tool(name=name, version=str(row["version"]), sha256=row["sha256"] or "") for name, row in own]
    known = {tool.name for tool in found}
    return found + [
        Tool(name=name, version=version) for name, version in (versions or {}).items() if name not in known
    ]


def files(role: str, hashes: Mapping[str, str] | Iterable[Path]) -> list[File]:
    """Files with their hashes; paths that are given alone are read. Raises Unjudged."""
    rows = hashes if isinstance(hashes, Mapping) else {str(path): sha256(path) for path in hashes}
    return [File(path=shown_path(path), sha256=digest, role=role) for path, digest in rows.items()]


TOOL = "modeproof:"
"""How the path of a file begins that is of the tool itself."""


def shown_path(path: str | Path) -> str:
    """A path from the project folder, with `/`; of a file of the tool from its tree; else as it is given."""
    given = Path(path)
    whole = given.resolve()
    for above, place in (("", project().resolve()), (TOOL, root().resolve())):
        if whole.is_relative_to(place):
            return above + whole.relative_to(place).as_posix()
    return given.as_posix()


def path_of(shown: str) -> Path:
    """The file of a path that `shown_path` gave."""
    return root() / shown.removeprefix(TOOL) if shown.startswith(TOOL) else project() / shown


def _seal(outcome: Outcome) -> str:
    table = msgspec.to_builtins(outcome)
    del table["seal"]
    return hashlib.sha256(json.dumps(table, sort_keys=True).encode()).hexdigest()
