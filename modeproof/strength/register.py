"""The registers of the three campaigns: what is edited, who judges, why survivors survive.

spec/<document>/strength.toml is that of the specification, proofs/<document>/strength.toml of the code judged
by theorems, and refimpl/<document>/adequacy.toml of the code judged by vectors.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.runs import Run, load_runs
from modeproof.strength.operators import Rule

ASKS = ("properties", "graph", "liveness")
WHEN = ("always", "complete", "left")
KINDS = ("harmless", "seen by comparison", "outside the model")
AS_PRINTED = "AsPrinted"
"""The name of a module that holds readings ends so."""


@dataclass(frozen=True)
class Tier:
    """One question put to a mutant: a declared run, its bounds made smaller or not.

    `asks`: properties (each property of the run is evaluated everywhere and named once when false), graph
    (the printed graph is compared with that of the original), liveness (TLC's own check of the run's
    property). `when`: always, complete (always under --complete, else left), left (only what nothing has
    killed). `constants` replace or add constants of the cfg; a value `<- Name` substitutes a definition;
    `definitions` is TLA+ text for them. `types`: invariants beyond whose violation nothing is explored.
    `decides`: a graph that is equal here makes the mutant EQUIVALENT. Limits in seconds and MiB.
    """

    id: str
    modules: tuple[str, ...]
    run: Run
    asks: str
    when: str
    constants: Mapping[str, str]
    definitions: str
    types: tuple[str, ...]
    decides: bool
    timeout_s: float
    heap_mb: int


@dataclass(frozen=True)
class Explained:
    """Why a survivor survives, given by a person. `ids` may hold patterns of one explanation."""

    ids: tuple[str, ...]
    kind: str
    why: str


@dataclass(frozen=True)
class Rejudged:
    """A mutant that the tests judge again each time, and what must come of it; `killer` is the first one."""

    id: str
    verdict: str
    killer: str


@dataclass(frozen=True)
class Strength:
    """strength.toml as read: a rule for each module, tiers in the order of judging, explanations."""

    document: str
    rules: Mapping[str, Rule]
    tiers: tuple[Tier, ...]
    explained: tuple[Explained, ...]
    rejudged: tuple[Rejudged, ...] = ()

    def tiers_of(self, module: str) -> tuple[Tier, ...]:
        """The tiers that judge mutants of a module, in order."""
        return tuple(tier for tier in self.tiers if module in tier.modules)


def path_of(place: Path, document: str) -> Path:
    """Where the register lies."""
    return place / "spec" / document / "strength.toml"


def load_strength(place: Path, document: str) -> Strength:
    """Read the register. Raises Unjudged with place and cause for whatever is not understood."""
    path = path_of(place, document)
    source = f"spec/{document}/strength.toml"
    if not path.is_file():
        raise Unjudged(f"{source}: not found; it says what is edited and which runs judge it")
    data = _read(place, path)
    data.pop("document", None)
    runs = {run.id: run for run in load_runs(place, document)}
    shared = _table(source, data, "rule", {"leave", "cycles"})
    rules: dict[str, Rule] = {}
    for values in _tables(source, data, "module"):
        name = _text(source, values, "name")
        at = f"{source}: module {name}"
        if name.endswith(AS_PRINTED):
            raise Unjudged(f"{at}: a module of readings is not mutated")
        refuse_unknown(at, values, {"name", "behaviour", "groups", "device"})
        rules[name] = Rule(
            behaviour=_names(at, values, "behaviour", required=True),
            leave=frozenset(_names(source, shared, "leave")),
            kinds=_kinds(place, document, values.get("device")),
            cycles=tuple(tuple(cycle) for cycle in shared.get("cycles", [])),
            groups=frozenset(_names(at, values, "groups")),
        )
    tiers = tuple(_tier(source, values, runs, rules) for values in _tables(source, data, "tier"))
    explained = tuple(read_explained(source, values) for values in _tables(source, data, "survivor"))
    rejudged = tuple(_rejudged(source, values) for values in _tables(source, data, "rejudged"))
    refuse_unknown(source, data, set())
    if not rules or not tiers:
        raise Unjudged(f"{source}: no module or no tier is declared")
    seen: set[str] = set()
    for tier in tiers:
        if tier.id in seen:
            raise Unjudged(f"{source}: tier {tier.id} is declared twice")
        seen.add(tier.id)
    for module in rules:
        if not any(module in tier.modules for tier in tiers):
            raise Unjudged(f"{source}: no tier judges module {module}")
    return Strength(document, rules, tiers, explained, rejudged)


@dataclass(frozen=True)
class TheoremsRegister:
    """proofs/<document>/strength.toml: what is put in the place of a name, and the explanations."""

    cycles: tuple[tuple[str, ...], ...] = ()
    turns: tuple[tuple[str, str], ...] = ()
    explained: tuple[Explained, ...] = ()


def theorems_path(place: Path, document: str) -> Path:
    """Where it lies."""
    return place / "proofs" / document / "strength.toml"


def load_theorems(place: Path, document: str) -> TheoremsRegister:
    """Read it. Raises Unjudged with place and cause for whatever is not understood."""
    path = theorems_path(place, document)
    data, source = _read(place, path), path.relative_to(place).as_posix()
    rule = _table(source, data, "rule", {"cycles", "turns"})
    explained = tuple(read_explained(source, values) for values in _tables(source, data, "survivor"))
    refuse_unknown(source, data, set())
    return TheoremsRegister(
        tuple(tuple(cycle) for cycle in rule.get("cycles", [])),
        tuple((before, after) for before, after in rule.get("turns", [])),
        explained,
    )


@dataclass(frozen=True)
class VectorsRegister:
    """refimpl/<document>/adequacy.toml: the suites that judge (empty: every suite), the explanations."""

    suites: tuple[str, ...] = ()
    explained: tuple[Explained, ...] = ()


def vectors_path(place: Path, document: str) -> Path:
    """Where it lies."""
    return place / "refimpl" / document / "adequacy.toml"


def load_vectors(place: Path, document: str) -> VectorsRegister:
    """Read it; empty where there is no file. Raises Unjudged for whatever is not understood."""
    path = vectors_path(place, document)
    if not path.is_file():
        return VectorsRegister()
    data, source = _read(place, path), path.relative_to(place).as_posix()
    suites = _names(source, data, "suites")
    explained = tuple(read_explained(source, values) for values in _tables(source, data, "survivor"))
    refuse_unknown(source, data, {"suites"})
    return VectorsRegister(suites, explained)


def _read(place: Path, path: Path) -> dict[str, Any]:
    source = path.relative_to(place).as_posix()
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise Unjudged(f"{source}: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Unjudged(f"{source}: {error}") from None


def _tier(source: str, values: dict[str, Any], runs: Mapping[str, Run], rules: Mapping[str, Rule]) -> Tier:
    name = _text(source, values, "id")
    at = f"{source}: tier {name}"
    known = {"id", "modules", "run", "asks", "when", "constants", "definitions", "types", "decides"}
    refuse_unknown(at, values, known | {"timeout_s", "heap_mb"})
    run = _text(at, values, "run")
    if run not in runs:
        raise Unjudged(f"{at}: run {run} is not in runs.toml")
    asks, when = _text(at, values, "asks"), values.get("when", "always")
    if asks not in ASKS or when not in WHEN:
        raise Unjudged(f"{at}: asks must be one of {', '.join(ASKS)}, when one of {', '.join(WHEN)}")
    modules = _names(at, values, "modules", required=True)
    strange = [module for module in modules if module not in rules]
    if strange:
        raise Unjudged(f"{at}: module {strange[0]} is not declared")
    if asks == "graph" and runs[run].kind != "OPEN":
        raise Unjudged(f"{at}: a graph is printed by a run of kind OPEN only")
    if asks == "liveness" and len(runs[run].properties) != 1:
        raise Unjudged(f"{at}: TLC does not name a violated temporal property, so a run must have one only")
    return Tier(
        id=name,
        modules=modules,
        run=runs[run],
        asks=asks,
        when=when,
        constants={key: str(value) for key, value in values.get("constants", {}).items()},
        definitions=str(values.get("definitions", "")),
        types=_names(at, values, "types"),
        decides=bool(values.get("decides", asks == "graph")),
        timeout_s=float(values.get("timeout_s", 120)),
        heap_mb=int(values.get("heap_mb", 512)),
    )


def read_explained(source: str, values: dict[str, Any]) -> Explained:
    """One explanation of survivors. Raises Unjudged when a field is missing, unknown, or of another kind."""
    ids = _names(f"{source}: survivor", values, "ids", required=True)
    at = f"{source}: survivor {ids[0]}"
    refuse_unknown(at, values, {"ids", "kind", "why"})
    kind = _text(at, values, "kind")
    if kind not in KINDS:
        raise Unjudged(f"{at}: kind must be one of {', '.join(KINDS)}")
    return Explained(ids, kind, _text(at, values, "why"))


def _rejudged(source: str, values: dict[str, Any]) -> Rejudged:
    id = _text(f"{source}: rejudged", values, "id")
    at = f"{source}: rejudged {id}"
    refuse_unknown(at, values, {"id", "verdict", "killer"})
    return Rejudged(id, _text(at, values, "verdict"), str(values.get("killer", "")))


def _kinds(place: Path, document: str, device: Any) -> tuple[tuple[str, ...], ...]:
    """The lists of strings that interface.toml declares for a device: its states, and the values of texts."""
    if device is None:
        return ()
    path = place / "spec" / document / "interface.toml"
    try:
        declared = tomllib.loads(path.read_text(encoding="utf-8"))["devices"][device]
    except (OSError, tomllib.TOMLDecodeError, KeyError, TypeError):
        raise Unjudged(f"spec/{document}/interface.toml: device {device} cannot be read") from None
    kinds = [tuple(declared.get("states", []))]
    for group in ("inputs", "outputs", "parameters"):
        for values in declared.get(group, {}).values():
            if isinstance(values, dict) and "values" in values:
                kinds.append(tuple(str(entry) for entry in values["values"]))
    return tuple(kind for kind in kinds if len(kind) > 1)


def _tables(source: str, data: dict[str, Any], key: str) -> list[dict[str, Any]]:
    tables = data.pop(key, [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise Unjudged(f"{source}: `{key}` must be a list of tables ([[{key}]])")
    return tables


def _table(source: str, data: dict[str, Any], key: str, known: set[str]) -> dict[str, Any]:
    table = data.pop(key, {})
    if not isinstance(table, dict):
        raise Unjudged(f"{source}: `{key}` must be a table ([{key}])")
    refuse_unknown(f"{source}: {key}", table, known)
    return table


def refuse_unknown(at: str, values: Mapping[str, Any], known: set[str]) -> None:
    """Raise Unjudged for a field that is none of these."""
    strange = sorted(set(values) - known)
    if strange:
        raise Unjudged(f"{at}: unknown field {strange[0]!r}")


def _text(at: str, values: Mapping[str, Any], key: str) -> str:
    value = values.get(key)
    if not isinstance(value, str) or not value:
        raise Unjudged(f"{at}: {key} must be a text")
    return value


def _names(at: str, values: Mapping[str, Any], key: str, required: bool = False) -> tuple[str, ...]:
    value = values.get(key, [])
    if not isinstance(value, list) or not all(isinstance(name, str) and name for name in value):
        raise Unjudged(f"{at}: {key} must be a list of names")
    if required and not value:
        raise Unjudged(f"{at}: {key} is missing or empty")
    return tuple(value)
