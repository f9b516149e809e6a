"""The register runs.toml: every TLC run of a document, what it must show, and its pinned counts.

A row says what differs from [default.run] and from [constants], or, in [based.RUN], from that run: a
reading, other constants, another specification. The cfg is made of it (modeproof/registers/made.py); a row
may also name a cfg by hand. The id of a run in `properties` stands for all that it checks, without what
`without` names. A row that tries a reading names in `also` the other runs that this reading must hold in:
each makes a run of its own, `<that run>_with_<reading>`.
"""

from __future__ import annotations

import builtins
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.files import read_toml
from modeproof.registers.typed import (
    DEFAULT,
    Count,
    Entry,
    Name,
    RunId,
    Sha256,
    Table,
    Text,
    only_keys,
    tables,
    typed,
)

Kind = Literal["MC", "LIVE", "NEG", "WIT", "OPEN"]
Lane = Literal["smoke", "full", "exhaustive"]
LANES: tuple[Lane, ...] = ("smoke", "full", "exhaustive")
EXPECTED: Mapping[str, str] = {
    "MC": "HOLDS",
    "LIVE": "HOLDS",
    "OPEN": "HOLDS",
    "NEG": "VIOLATED",
    "WIT": "REACHED",
}
ASKING: tuple[Kind, ...] = ("MC", "LIVE", "OPEN")
"""Kinds of runs in which every property must hold."""
OWN_OF_BASE = (
    *("id", "lanes", "cfg_sha256", "distinct", "generated", "trace_length", "properties"),
    *("property", "witnesses", "clauses", "findings", "why", "also", "counts", "without"),
)
"""What a run never takes from its base."""


class Graph(Entry, frozen=True, kw_only=True):
    """What an OPEN run says about the graph that it prints.

    `states` and `edges` are counts (None until pinned), `tick_ms` is the length of one tick of the model;
    `passed` (the key `pass`) maps an output to the input that it shows.
    """

    device: str
    tick_ms: Count
    params: dict[Name, Any] = msgspec.field(default_factory=dict)
    passed: dict[str, Name] = msgspec.field(default_factory=dict, name="pass")
    states: Count | None = None
    edges: Count | None = None


class Model(Entry, frozen=True, kw_only=True):
    """What a row says of the cfg that is made of it; a run with a base has that of its base.

    `constants` are those of the document, with the run's own in their place.
    """

    specification: Name
    view: str = ""
    constants: dict[Name, Text] = msgspec.field(default_factory=dict)
    action_constraints: tuple[Name, ...] = ()


class _Also(Entry, frozen=True, kw_only=True):
    also: dict[Name, tuple[Count, ...]] = msgspec.field(default_factory=dict)


class Run(Entry, frozen=True, kw_only=True):
    """One declared TLC run.

    Heap in MiB, time limit in seconds. `distinct`, `generated`, `trace_length` and `cfg_sha256` are pins:
    None means not pinned yet, which is never as expected. `property` is what a NEG run must violate, or
    the temporal property of a LIVE run. `model`: of what the cfg is made; None where `cfg` is by hand.

    Of a run with `base`, `module` and `cfg` are those of its base; `constants`, `specification` and `view`
    take the place of what that cfg gives. `more_witnesses` are reached besides those of the base. `of` names
    the row whose `also` makes the run, and the run there; it is empty where a run has a row of its own.
    """

    document: str
    id: RunId
    module: Name
    cfg: Annotated[str, msgspec.Meta(pattern=r"^(models/\w+\.cfg)?$")] = ""
    kind: Kind
    """What the id begins with."""
    lanes: tuple[Lane, ...] = ("full",)
    environment: Annotated[str, msgspec.Meta(pattern=r"^[a-z][a-z_]*$")]
    strength: str = ""
    base: str = ""
    reading: Name | tuple[Name, ...] = ()
    constants: dict[Name, Text] = msgspec.field(default_factory=dict)
    specification: Name | None = None
    view: str | None = None
    model: Model | None = None
    workers: Count = 1
    heap_mb: Count = 512
    timeout_s: Annotated[float, msgspec.Meta(gt=0)] = 300
    properties: tuple[Name, ...] = ()
    property: str = ""
    witnesses: tuple[Text, ...] = ()
    deadlock: bool = False
    distinct: Count | None = None
    generated: Count | None = None
    trace_length: Count | None = None
    cfg_sha256: Sha256 | None = None
    graph: Graph | None = None
    clauses: tuple[str, ...] = ()
    findings: tuple[str, ...] = ()
    why: str = ""
    of: tuple[str, ...] = ()

    @builtins.property
    def name(self) -> str:
        """The run's name across documents."""
        return f"{self.document}/{self.id}"

    @builtins.property
    def expect(self) -> str:
        """The verdict that a run of its kind must have."""
        return EXPECTED[self.kind]

    @builtins.property
    def readings(self) -> tuple[str, ...]:
        """The readings that take the place of what was decided; none in a run by hand."""
        return (self.reading,) if isinstance(self.reading, str) else self.reading

    @builtins.property
    def config(self) -> str:
        """The cfg that TLC reads, relative to the root of the repository."""
        if self.base or not self.cfg:
            return f"build/tlc/{self.document}/made/{self.id}/{self.id}.cfg"
        return f"spec/{self.document}/{self.cfg}"


def load_runs(root: Path, document: str) -> tuple[Run, ...]:
    """All runs that spec/<document>/runs.toml declares.

    Raises Unjudged with file, run and cause: no file, no run, malformed TOML, a field that is unknown or has
    the wrong type, an id twice, a base that is unknown, has a base itself, or does not check the property.
    """
    source = f"spec/{document}/runs.toml"
    data = read_toml(root, root / "spec" / document / "runs.toml")
    if data.pop("document", document) != document:
        raise Unjudged(f"{source}: document is not the name of its folder, {document!r}")
    only_keys(
        source, data, ("document", "constants", "moved", "hidden", "run", "based", "series", "measured_on")
    )
    rows = dict(_rows(source, data))
    found = {name: _run(document, source, values) for name, values in rows.items() if "base" not in values}
    for name, values in rows.items():
        if "base" in values:
            found[name] = _derived(document, source, values, rows, found)
    also = [
        run for name, values in rows.items() for run in _also(f"{source}: run {name}: also", values, found)
    ]
    return (*(found[name] for name in rows), *also)


def reasons_of(root: Path, document: str) -> tuple[str, ...]:
    """Why the pins of its runs have moved, each with its day. Raises Unjudged like `load_runs`."""
    source = f"spec/{document}/runs.toml"
    data = read_toml(root, root / "spec" / document / "runs.toml")
    return typed(tuple[Text, ...], data.get("moved", []), f"{source}: moved")


def hidden_of(root: Path, document: str) -> dict[str, str]:
    """The variables that a view may hide from a property that reads them, each with its reason. Raises
    Unjudged like `load_runs`.
    """
    source = f"spec/{document}/runs.toml"
    data = read_toml(root, root / "spec" / document / "runs.toml")
    return typed(dict[Name, Text], data.get("hidden", {}), f"{source}: hidden")


def _rows(source: str, data: Table) -> Iterator[tuple[str, Table]]:
    """The rows by their ids: in the place of what is short for something stands what it is short for."""
    usual = data.get(DEFAULT, {}).get("run", {})
    rows: dict[str, dict[str, Any]] = {
        id: dict(row) for id, row in tables(source, {"run": data.get("run", [])}, "run").items()
    }
    for base, own in typed(dict[RunId, dict[RunId, dict[str, Any]]], data.get("based", {}), source).items():
        for id, row in own.items():
            if id in rows or "base" in row:
                raise Unjudged(f"{source}: based.{base}.{id}: declared twice, or has another base")
            rows[id] = {"id": id, "base": base, **row}
    constants = data.get("constants", {})
    checked: dict[str, list[str]] = {}
    for id, given in rows.items():
        row = given if "base" in given else {**usual, **given}
        place = f"{source}: run {id}"
        if "base" not in row and "cfg" not in row:
            own = {key: row.pop(key) for key in Model.__struct_fields__ if key in row}
            row["model"] = {**own, "constants": {**constants, **own.get("constants", {})}}
        if "counts" in row:
            row["distinct"], row["generated"] = typed(
                tuple[Count, Count], row.pop("counts"), f"{place}: counts"
            )
        without = row.pop("without", [])
        if "properties" in row:
            names = [name for entry in row["properties"] for name in checked.get(entry, [entry])]
            if lost := [name for name in without if name not in names]:
                raise Unjudged(f"{place}: without: {lost[0]} is none of its properties")
            row["properties"] = [name for name in dict.fromkeys(names) if name not in without]
            checked[id] = row["properties"]
        yield id, row


def _also(place: str, row: Mapping[str, Any], found: Mapping[str, Run]) -> Iterator[Run]:
    """The runs that a row makes of others with its reading, in its lanes; a graph is not printed again."""
    main = found[row["id"]]
    for name, counts in typed(_Also, {"also": row.get("also", {})}, place).also.items():
        if main.kind != "MC" or len(main.readings) != 1:
            raise Unjudged(f"{place} belongs to an MC run with one reading")
        if name not in found:
            raise Unjudged(f"{place}: unknown run {name!r}; {suggestion(name, found)}")
        other = found[name]
        if other.kind not in ASKING or other.readings:
            raise Unjudged(f"{place}: {name} is no run of kind {', '.join(ASKING)} of what was decided")
        if len(counts) not in (0, 2):
            raise Unjudged(f"{place}: {name} must be [distinct, generated], or [] until --repin writes them")
        yield msgspec.structs.replace(
            other,
            id=f"{'MC_' if other.kind == 'OPEN' else ''}{name}_with_{main.readings[0]}",
            kind="MC" if other.kind == "OPEN" else other.kind,
            base=other.base or other.id,
            reading=main.reading,
            lanes=main.lanes,
            distinct=counts[0] if counts else None,
            generated=counts[1] if counts else None,
            **{
                "graph": None,
                "cfg_sha256": None,
                "clauses": (),
                "findings": (),
                "why": "",
                "of": (main.id, name),
            },
        )


def _run(document: str, source: str, values: Mapping[str, Any]) -> Run:
    place = f"{source}: run {values.get('id', '?')}"
    for key in ("document", "kind", "of"):
        if key in values:
            raise Unjudged(f"{place}: unknown key {key!r}")
    kind = str(values.get("id", "")).partition("_")[0]
    values = {key: value for key, value in values.items() if key != "also"}
    run = typed(Run, {**values, "kind": kind if kind in EXPECTED else "MC", "document": document}, place)
    _check_kind(place, run)
    return run


def _derived(
    document: str,
    source: str,
    values: Mapping[str, Any],
    rows: Mapping[str, Mapping[str, Any]],
    found: Mapping[str, Run],
) -> Run:
    """A run that takes from its base whatever its own row does not give."""
    place = f"{source}: run {values.get('id', '?')}"
    base = values["base"]
    if not isinstance(base, str) or base not in rows:
        raise Unjudged(f"{place}: unknown base {base!r}; {suggestion(str(base), rows)}")
    if "base" in rows[base]:
        raise Unjudged(f"{place}: its base {base} has a base itself; name {rows[base]['base']!r}")
    for key in ("cfg", "cfg_sha256", "model"):
        if key in values:
            raise Unjudged(f"{place}: {key} belongs to a run by hand; the cfg of a run with a base is made")
    taken = {key: value for key, value in rows[base].items() if key not in OWN_OF_BASE}
    graph = {key: value for key, value in taken.pop("graph", {}).items() if key not in ("states", "edges")}
    table = {"lanes": ["full"], **taken, **values}
    if "graph" in values and isinstance(values["graph"], dict):
        table["graph"] = {**graph, **values["graph"]}
    of_base = found[base].properties
    if "properties" not in values:
        negative = str(values.get("id", "")).startswith("NEG_") and "property" in values
        table["properties"] = [values["property"]] if negative else list(of_base)
    if "more_witnesses" in values:
        table["witnesses"] = [*found[base].witnesses, *table.pop("more_witnesses")]
    run = _run(document, source, table)
    deadlock = ("deadlock",) if run.deadlock else ()
    for name in (*run.properties, *((run.property,) if run.property else ())):
        if name not in (*of_base, *deadlock):
            raise Unjudged(f"{place}: its base {base} does not check {name}; {suggestion(name, of_base)}")
    if not run.readings and not (run.constants or run.specification or "module" in values):
        raise Unjudged(f"{place}: nothing differs from its base {base}: no reading, no constants")
    return run


def _check_kind(place: str, run: Run) -> None:
    if not run.lanes:
        raise Unjudged(f"{place}: lanes must name some of {', '.join(LANES)}")
    if not run.base and (run.readings or run.constants or run.specification or run.view is not None):
        raise Unjudged(f"{place}: reading, constants, specification and view belong to a run with a base")
    if run.kind in ("LIVE", "OPEN") and run.workers != 1:
        raise Unjudged(f"{place}: a run of kind {run.kind} needs workers = 1")
    if run.kind == "LIVE" and len(run.properties) > 1 and not run.property:
        raise Unjudged(f"{place}: TLC does not name a violated temporal property, so state one in `property`")
    if run.kind == "NEG" and not run.property:
        raise Unjudged(f"{place}: `property` must name what is violated")
    if run.kind == "NEG" and run.trace_length is not None and run.workers != 1:
        raise Unjudged(f"{place}: trace_length is exact with workers = 1 only")
    if run.kind == "WIT" and not run.witnesses:
        raise Unjudged(f"{place}: witnesses is empty; such a run shows nothing")
    if run.kind != "WIT" and run.witnesses:
        raise Unjudged(f"{place}: witnesses belong to runs of kind WIT")
    if (run.kind == "OPEN") != (run.graph is not None):
        raise Unjudged(f"{place}: [run.graph] belongs to runs of kind OPEN, and to each of them")
