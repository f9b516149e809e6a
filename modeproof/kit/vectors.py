"""Reads a vector file: a header line, then one test case a line (JSON Lines).

The header names target, suite, relations, inputs, outputs and steps, and holds for each graph the rows of
outputs and a shortest way to each state. In a case `in` and `out` of a scan hold what differs from the scan
before; in the first scan they are whole. `to` is the state after the scan, `step` the number of its step,
`column` the number of the merged input column.

A row `{"refuse": REQUEST}` is no scan of the program: the adapter must refuse the request (an object, or a
text that is sent as it is), and the next scan must come out as if it had never been sent. A scan with
`"settling": true` is not compared. A case with `"reset": false` begins before any reset. Where the header
has `"shrink": "prefix"`, the shortest case that shows a difference is the beginning of the case itself;
without it, the graph's shortest way to the state is tried.
"""

from __future__ import annotations

import gzip
import hashlib
import itertools
import json
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, Any

from modeproof.kit.compact import expand
from modeproof.kit.demands import Demands, read_demands
from modeproof.kit.errors import Unjudged
from modeproof.kit.ids import case_id as case_id
from modeproof.kit.ids import id_of_text as id_of_text
from modeproof.kit.signals import Signal, loads, read_signals, shown

KIND, VERSION = "modeproof-vectors", 1
EXACT, SETTLED, MONITOR = "exact", "settled", "monitor"
"""The relations: each scan's outputs; the outputs once they do not change; the safety properties alone."""
PACKED = ".gz"
"""The suffix of a file that is packed with gzip."""
COMPACT = ".compact"
"""The suffix of a member of an archive that is in the form of modeproof.kit.compact."""
FILE_NAME = "{suite}.jsonl.gz"
"""How the file of a suite is called in the folder of its target."""
DEMANDS = "demands"
"""In the header of an open suite: what the document demands, where that is known. It is in no file."""
READINGS = "readings"
"""Beside it: for each parameter that chooses between readings the finding that says why."""
WIRING = "wiring"
"""In the header of vectors of a whole machine: how its blocks are wired, from which the reference is made."""
LONGEST_LINE = 1 << 26
"""Bytes; the longest published line has a fortieth of it."""
_ODD = (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError, RecursionError)
"""What a file of another form raises while it is read."""


@dataclass(frozen=True)
class Step:
    """One step of the specification: what it cites, and how many transitions of the suite take it."""

    name: str
    clauses: tuple[str, ...]
    findings: tuple[str, ...]
    transitions: int


@dataclass(slots=True)
class Scan:
    """One scan: whole inputs, whole expected outputs, and where the specification is after it.

    With a `request` it is no scan: the adapter must refuse the request. `compared` is false while the
    outputs settle. Nobody changes one; it is not frozen because there are millions of them.
    """

    dt_ms: int
    inputs: Mapping[str, Any]
    outputs: Mapping[str, Any]
    step: int
    to: int
    column: int
    compared: bool = True
    request: Mapping[str, Any] | str | None = None


@dataclass(frozen=True)
class Case:
    """One test case: reset with `params`, then the scans. `graph` is the number of the graph it walks in.

    Without `reset` it begins before any reset.
    """

    id: str
    why: str
    basis: str
    clauses: tuple[str, ...]
    params: Mapping[str, Any]
    graph: int
    initial: int
    scans: tuple[Scan, ...]
    reset: bool = True

    @property
    def requests(self) -> bool:
        """Whether the adapter must refuse something."""
        return any(scan.request is not None for scan in self.scans)


@dataclass(frozen=True)
class Suite:
    """A vector file that was opened; `header` is its first line."""

    path: Path
    header: Mapping[str, Any]
    target: str
    document: str
    name: str
    relations: tuple[str, ...]
    inputs: Mapping[str, Signal]
    outputs: Mapping[str, Signal]
    parameters: Mapping[str, Mapping[str, Any]]
    steps: tuple[Step, ...]
    case_count: int
    scan_count: int
    member: str = ""

    @property
    def says(self) -> dict[str, str]:
        """What its header says: what the suite guarantees, under which hypothesis, what it does not show."""
        return {key: str(self.header.get(key, "")) for key in ("guarantees", "hypothesis", "does_not_show")}

    def cases(self) -> Iterator[Case]:
        """All cases in order. Raises Unjudged with line and cause for a line that cannot be used."""
        count = 0
        for number, row in _rows(self.path, self.member):
            if number == 1:
                continue
            count += 1
            try:
                yield self._case(row)
            except _ODD as error:
                cause = f"{type(error).__name__} {error}"
                raise Unjudged(f"{self.path.name}: line {number}: not a test case: {cause}") from None
        if count != self.case_count:
            raise Unjudged(f"{self.path.name}: {count} cases, the header says {self.case_count}")

    def _case(self, row: Mapping[str, Any]) -> Case:
        inputs: dict[str, Any] = {}
        outputs: dict[str, Any] = {}
        scans: list[Scan] = []
        initial, steps = self.header["graphs"][row["graph"]]["initial"], len(self.steps)
        for scan in row["scans"]:
            if "refuse" in scan:
                to = scans[-1].to if scans else initial
                scans.append(Scan(0, inputs, outputs, 0, to, 0, request=scan["refuse"]))
                continue
            if scan["in"]:
                inputs = {**inputs, **scan["in"]}
            if scan["out"]:
                outputs = {**outputs, **scan["out"]}
            compared = "settling" not in scan
            numbers = (scan["dt_ms"], scan["step"], scan["to"], scan["column"])
            if any(type(number) is not int or number < 0 for number in numbers) or numbers[1] >= steps:
                raise ValueError(f"dt_ms, step, to and column {numbers}")
            scans.append(
                Scan(scan["dt_ms"], inputs, outputs, scan["step"], scan["to"], scan["column"], compared)
            )
        whole = set(inputs) == set(self.inputs) and set(outputs) == set(self.outputs)
        if not scans or not (whole or all(scan.request is not None for scan in scans)):
            raise ValueError("inputs or outputs are not those of the header, or there is no scan")
        going_in = [
            ("refuse", scan["refuse"]) if "refuse" in scan else (scan["dt_ms"], scan["in"])
            for scan in row["scans"]
        ]
        if row["id"] != case_id(self.target, row["params"], going_in):
            raise ValueError(f"id {row['id']} does not belong to these inputs (was the file edited?)")
        return Case(
            id=row["id"],
            why=_text(row["why"]),
            basis=_text(row["basis"]),
            clauses=_texts(row["clauses"]),
            params=row["params"],
            graph=row["graph"],
            initial=initial,
            scans=tuple(scans),
            reset=row.get("reset", True),
        )

    def demands(self) -> Demands | None:
        """What the document demands of the target, where that is known. Raises Unjudged."""
        table = self.header.get(DEMANDS)
        if table is None:
            return None
        read = read_demands(table, self.inputs, self.outputs, self.parameters, f"{self.target}: demands")
        ours = {name: row.get("default") for name, row in self.parameters.items() if row.get("project")}
        profiles = list(self.header.get("profiles", {}).values())
        own = {n: usual for n, usual in ours.items() if all(one.get(n, usual) == usual for one in profiles)}
        return replace(read, own=own)

    def demanding(
        self,
        table: Mapping[str, Any] | None,
        texts: Mapping[str, str] | None = None,
        readings: Mapping[str, str] | None = None,
    ) -> Suite:
        """The suite with what the document demands; it is no part of a vector file. `texts` are added.

        readings: for each parameter that chooses between readings its finding.
        """
        header = {**self.header, "texts": {**self.header.get("texts", {}), **(texts or {})}}
        header[READINGS] = dict(readings or {})
        return replace(self, header=header if table is None else {**header, DEMANDS: table})

    @property
    def codes(self) -> tuple[str, ...]:
        """The outputs whose values the document does not give: they are compared only where that is asked."""
        return tuple(name for name, of in self.outputs.items() if of.project)

    def has_ways(self, case: Case) -> bool:
        """Whether the header knows a shortest way to each state of the case's graph."""
        return "ways" in self.header["graphs"][case.graph] and self.header.get("shrink") != "prefix"

    def way(self, case: Case, state: int) -> tuple[Scan, ...]:
        """A shortest way from power-up to a state. Raises Unjudged where the header knows none."""
        graph = self.header["graphs"][case.graph]
        if not self.has_ways(case):
            raise Unjudged(f"{self.path.name}: no ways to states are known")
        way: list[Scan] = []
        while state != graph["initial"]:
            before, dt_ms, inputs, outputs, step, column = graph["ways"][state]
            way.append(Scan(dt_ms, inputs, outputs, step, state, column))
            state = before
        return tuple(reversed(way))

    def text(self, id: str) -> str:
        """What the registers say of a clause or decision, in our words; nothing where they do not."""
        return str(self.header.get("texts", {}).get(id, ""))


def open_suite(path: Path, member: str = "") -> Suite:
    """Read the header; with `member`, of that file in the archive `path`.

    Raises Unjudged for a missing file, another format, a header that lacks something, a suite without cases.
    """
    try:
        _, header = next(iter(_rows(path, member)))
    except StopIteration:
        raise Unjudged(f"{path.name}: the file is empty") from None
    place = f"{path.name}: header"
    if header.get("kind") != KIND or header.get("version") != VERSION:
        raise Unjudged(f"{place}: not a vector file of version {VERSION}")
    try:
        counts = [header["cases"], header["scans"], *(row["transitions"] for row in header["steps"])]
        if any(type(count) is not int for count in counts):
            raise TypeError("cases, scans and transitions are numbers")
        graphs = [
            (dict(graph["params"]), graph["initial"], len(graph["views"])) for graph in header["graphs"]
        ]
        suite = Suite(
            path=path,
            member=member,
            header=header,
            target=_text(header["target"]),
            document=_text(header["document"]),
            name=_text(header["suite"]),
            relations=_texts(header["relations"] if "relations" in header else [header["relation"]]),
            parameters={name: dict(row) for name, row in header.get("parameters", {}).items()},
            inputs=read_signals(header["inputs"], place),
            outputs=read_signals(header["outputs"], place),
            steps=tuple(
                Step(_text(row["name"]), _texts(row["clauses"]), _texts(row["findings"]), row["transitions"])
                for row in header["steps"]
            ),
            case_count=header["cases"],
            scan_count=header["scans"],
        )
    except _ODD as error:
        raise Unjudged(f"{place}: {type(error).__name__} {error}") from None
    if suite.case_count < 1 or not graphs:
        raise Unjudged(f"{path.name}: the suite has no cases, so it shows nothing")
    return suite


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"a text expected, not {shown(value)}")
    return value


def _texts(values: Any) -> tuple[str, ...]:
    if not isinstance(values, list):
        raise TypeError(f"a list of texts expected, not {shown(values)}")
    return tuple(map(_text, values))


def changes(scans: Sequence[Scan]) -> list[tuple[int | str, Any]]:
    """For each scan the time and the inputs that differ from the scan before; all of them in the first."""
    before: Mapping[str, Any] = {}
    found: list[tuple[int | str, Any]] = []
    for scan in scans:
        if scan.request is not None:
            found.append(("refuse", scan.request))
            continue
        found.append(
            (scan.dt_ms, {k: v for k, v in scan.inputs.items() if k not in before or before[k] != v})
        )
        before = scan.inputs
    return found


def read_lines(path: Path, member: str = "") -> Iterator[bytes]:
    """The lines of a vector file, packed or not; with `member`, of a packed file in the archive `path`.

    Raises Unjudged where it cannot be read to its end.
    """
    try:
        if member:
            with (
                zipfile.ZipFile(path) as archive,
                archive.open(member) as packed,
                gzip.open(packed) as stream,
            ):
                yield from _bounded(path, stream)
        else:
            with gzip.open(path, "rb") if path.suffix == PACKED else path.open("rb") as stream:
                yield from _bounded(path, stream)
    except (OSError, EOFError, KeyError, zlib.error, zipfile.BadZipFile) as error:
        raise Unjudged(f"{path}: {getattr(error, 'strerror', None) or error}") from None


def _bounded(path: Path, stream: IO[bytes] | gzip.GzipFile) -> Iterator[bytes]:
    while line := stream.readline(LONGEST_LINE + 1):
        if len(line) > LONGEST_LINE:
            raise Unjudged(f"{path}: a line longer than {LONGEST_LINE:,} bytes")
        yield line


def content_hash(suite: Suite) -> str:
    """SHA-256 of the rows of a vector file, however they are packed. Raises Unjudged as reading does."""
    found = hashlib.sha256()
    for _, row in _rows(suite.path, suite.member):
        found.update(json.dumps(row, sort_keys=True).encode())
    return found.hexdigest()


def same_rows(one: Suite, other: Suite) -> bool:
    """Whether two vector files hold the same header and the same cases."""
    rows = (_rows(suite.path, suite.member) for suite in (one, other))
    return all(pair[0] == pair[1] for pair in itertools.zip_longest(*rows))


def _rows(path: Path, member: str) -> Iterator[tuple[int, Mapping[str, Any]]]:
    if member.endswith(COMPACT):
        try:
            with zipfile.ZipFile(path) as archive:
                data = archive.read(member)
        except (OSError, KeyError, zipfile.BadZipFile) as error:
            raise Unjudged(f"{path}: {member}: {error}") from None
        yield from enumerate(expand(data), 1)
        return
    for number, line in enumerate(read_lines(path, member), 1):
        try:
            row = loads(line) if number == 1 else json.loads(line)
        except (ValueError, RecursionError) as error:
            raise Unjudged(f"{path.name}: line {number}: not JSON: {error}") from None
        if not isinstance(row, dict):
            raise Unjudged(f"{path.name}: line {number}: an object was expected")
        yield number, row
