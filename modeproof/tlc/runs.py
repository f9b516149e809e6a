"""The register runs.toml: every TLC run of a document, what it must show, and its pinned counts."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from modeproof.errors import Unjudged

LANES = ("smoke", "full", "exhaustive")
KINDS = ("MC", "LIVE", "NEG", "WIT", "OPEN")
EXPECTED = {"MC": "HOLDS", "LIVE": "HOLDS", "OPEN": "HOLDS", "NEG": "VIOLATED", "WIT": "REACHED"}


@dataclass(frozen=True)
class GraphPins:
    """What an OPEN run says about the graph that it prints.

    `states` and `edges` are counts (None until pinned), `tick_ms` is the length of one tick of the model.
    """

    device: str
    tick_ms: int
    params: Mapping[str, Any]
    passed: Mapping[str, str]
    states: int | None
    edges: int | None


@dataclass(frozen=True)
class Run:
    """One declared TLC run.

    Heap in MiB, time limit in seconds, workers 1 or more. `distinct`, `generated`, `trace_length` and
    `cfg_sha256` are pins: None means not pinned yet, which is never as expected.
    """

    document: str
    id: str
    module: str
    cfg: str
    kind: str
    lanes: tuple[str, ...]
    environment: str
    strength: str
    workers: int
    heap_mb: int
    timeout_s: float
    expect: str
    properties: tuple[str, ...]
    violates: str | None = None
    witnesses: tuple[str, ...] = ()
    deadlock: bool = False
    distinct: int | None = None
    generated: int | None = None
    trace_length: int | None = None
    cfg_sha256: str | None = None
    graph: GraphPins | None = None
    clauses: tuple[str, ...] = ()
    why: str = ""
    extra: Mapping[str, Any] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The run's name across documents."""
        return f"{self.document}/{self.id}"


class _Table:
    """One TOML table with its place in the file, so that every error names both."""

    def __init__(self, place: str, values: Mapping[str, Any]) -> None:
        self.place = place
        self.values = dict(values)

    def take(
        self, key: str, kind: type | tuple[type, ...], default: Any = None, required: bool = False
    ) -> Any:
        if key not in self.values:
            if required:
                raise Unjudged(f"{self.place}: {key} is missing")
            return default
        value = self.values.pop(key)
        kinds = kind if isinstance(kind, tuple) else (kind,)
        if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
            names = " or ".join(k.__name__ for k in kinds)
            raise Unjudged(f"{self.place}: {key} must be {names}, not {value!r}")
        return value

    def count(self, key: str, least: int = 0, required: bool = False) -> int | None:
        value = self.take(key, int, required=required)
        if value is not None and value < least:
            raise Unjudged(f"{self.place}: {key} must be at least {least}, not {value}")
        return None if value is None else int(value)

    def names(self, key: str) -> tuple[str, ...]:
        value = self.take(key, list, default=[])
        if not all(isinstance(item, str) and item for item in value):
            raise Unjudged(f"{self.place}: {key} must be a list of names, not {value!r}")
        if len(set(value)) != len(value):
            raise Unjudged(f"{self.place}: {key} holds a name twice: {value!r}")
        return tuple(value)

    def done(self) -> None:
        if self.values:
            raise Unjudged(f"{self.place}: unknown field {sorted(self.values)[0]!r}")


def _graph(place: str, values: Mapping[str, Any]) -> GraphPins:
    table = _Table(f"{place} [run.graph]", values)
    graph = GraphPins(
        device=table.take("device", str, required=True),
        tick_ms=table.count("tick_ms", 1, required=True) or 1,
        params=table.take("params", dict, default={}),
        passed=table.take("pass", dict, default={}),
        states=table.count("states", 1),
        edges=table.count("edges", 1),
    )
    table.done()
    return graph


def _run(document: str, source: str, values: Mapping[str, Any]) -> Run:
    identity = values.get("id")
    table = _Table(f"{source}: run {identity or '?'}", values)
    run_id = table.take("id", str, required=True)
    kind = table.take("kind", str, required=True)
    if kind not in KINDS:
        raise Unjudged(f"{table.place}: kind must be one of {', '.join(KINDS)}, not {kind!r}")
    lanes = table.names("lanes")
    lane = table.take("lane", str)
    if lane is not None and lane not in lanes:
        lanes = (lane, *lanes)
    if not lanes or any(one not in LANES for one in lanes):
        raise Unjudged(f"{table.place}: lanes must name some of {', '.join(LANES)}, not {list(lanes)!r}")
    expect = table.take("expect", str, default=EXPECTED[kind])
    if expect != EXPECTED[kind]:
        raise Unjudged(f"{table.place}: a run of kind {kind} expects {EXPECTED[kind]}, not {expect!r}")
    graph = table.take("graph", dict)
    run = Run(
        document=document,
        id=run_id,
        module=table.take("module", str, required=True),
        cfg=table.take("cfg", str, required=True),
        kind=kind,
        lanes=lanes,
        environment=table.take("environment", str, default=""),
        strength=table.take("strength", str, default=""),
        workers=table.count("workers", 1) or 1,
        heap_mb=table.count("heap_mb", 1) or 1024,
        timeout_s=float(table.take("timeout_s", (int, float), default=300)),
        expect=expect,
        properties=table.names("properties"),
        violates=table.take("property", str),
        witnesses=table.names("witnesses"),
        deadlock=table.take("deadlock", bool, default=False),
        distinct=table.count("distinct", 1),
        generated=table.count("generated", 1),
        trace_length=table.count("trace_length", 1),
        cfg_sha256=table.take("cfg_sha256", str),
        graph=None if graph is None else _graph(table.place, graph),
        clauses=table.names("clauses"),
        why=table.take("why", str, default=""),
        extra={key: table.values.pop(key) for key in ("findings", "switch", "breaks") if key in table.values},
    )
    table.done()
    _check_kind(table.place, run)
    return run


def _check_kind(place: str, run: Run) -> None:
    if run.timeout_s <= 0:
        raise Unjudged(f"{place}: timeout_s must be greater than 0")
    if not run.id.startswith(f"{run.kind}_"):
        raise Unjudged(f"{place}: the id of a run of kind {run.kind} starts with {run.kind}_")
    if run.kind in ("LIVE", "OPEN") and run.workers != 1:
        raise Unjudged(f"{place}: a run of kind {run.kind} needs workers = 1")
    if run.kind == "LIVE" and len(run.properties) > 1 and run.violates is None:
        raise Unjudged(f"{place}: TLC does not name a violated temporal property, so state one in `property`")
    if run.kind == "NEG" and run.violates is None:
        raise Unjudged(f"{place}: `property` must name what is violated")
    if run.kind == "NEG" and run.trace_length is not None and run.workers != 1:
        raise Unjudged(f"{place}: trace_length is exact with workers = 1 only")
    if run.kind == "WIT" and not run.witnesses:
        raise Unjudged(f"{place}: witnesses is empty; such a run shows nothing")
    if run.kind != "WIT" and run.witnesses:
        raise Unjudged(f"{place}: witnesses belong to runs of kind WIT")
    if (run.kind == "OPEN") != (run.graph is not None):
        raise Unjudged(f"{place}: [run.graph] belongs to runs of kind OPEN, and to each of them")


def load_runs(place: Path, document: str) -> tuple[Run, ...]:
    """All runs that spec/<document>/runs.toml declares.

    Raises Unjudged with place and cause: no file, no run, malformed TOML, a field that is unknown or has the
    wrong type, an id twice.
    """
    path = place / "spec" / document / "runs.toml"
    source = f"spec/{document}/runs.toml"
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise Unjudged(f"{source}: not found") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Unjudged(f"{source}: {error}") from None
    top = _Table(source, data)
    top.take("document", str)
    tables = top.take("run", list, default=[])
    top.done()
    if not tables:
        raise Unjudged(f"{source}: no run is declared")
    if not all(isinstance(one, dict) for one in tables):
        raise Unjudged(f"{source}: `run` must be a list of tables ([[run]])")
    runs = tuple(_run(document, source, values) for values in tables)
    seen: set[str] = set()
    for run in runs:
        if run.id in seen:
            raise Unjudged(f"{source}: run {run.id} is declared twice")
        seen.add(run.id)
    return runs
