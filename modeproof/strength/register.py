"""strength.toml: what is edited, who judges the mutants, and what nobody notices, with the reason.

spec/<document>/strength.toml is about the specification, proofs/<document>/strength.toml about the code. Both
have one form: a rule for names, modules and tiers (specification), suites (code), what survives, and, for the
code, the places that no path passes, which `modeproof prove --coverage` reads.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import msgspec

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.files import read_toml
from modeproof.registers.load import load_interface
from modeproof.registers.refuting import Edit
from modeproof.registers.runs import Run, load_runs
from modeproof.registers.typed import Count, Entry, Name, Names, RunId, SomeNames, Text, typed
from modeproof.strength.operators import Rule

Asks = Literal["properties", "graph", "liveness"]
When = Literal["always", "complete", "left"]
Judge = Literal["properties", "theorems", "vectors"]
AS_PRINTED = "AsPrinted"
"""The name of a module that holds readings ends so."""
_OFF = {"graph": "RECORD_STEPS", "properties": "PRINT_GRAPH"}
"""Of a run that prints a graph: the constant that is FALSE where its graph is compared, or is not wanted."""
Ids = Annotated[tuple[Text, ...], msgspec.Meta(min_length=1)]


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
    asks: Asks
    when: When
    constants: Mapping[str, str]
    definitions: str
    types: tuple[str, ...]
    decides: bool
    timeout_s: float
    heap_mb: int


class Explained(Entry, frozen=True):
    """Why a survivor survives, given by a person. `ids` may hold patterns of one explanation."""

    ids: Ids
    kind: Literal["harmless", "seen by comparison", "outside the model"]
    why: Text
    judge: Judge = "properties"


class Rejudged(Entry, frozen=True):
    """A mutant that the tests judge again each time, and what must come of it; `killer` is the first one."""

    id: Text
    verdict: Text
    killer: str = ""


class _Rule(Entry, frozen=True):
    """`leave`: names that are not edited; in `cycles` a name becomes the next one, in `turns` the second."""

    leave: Names = ()
    cycles: tuple[tuple[str, ...], ...] = ()
    turns: tuple[tuple[str, str], ...] = ()


class _Module(Entry, frozen=True):
    """A module that is edited: what makes up its behaviour, and definitions that only sort actions."""

    name: Name
    behaviour: SomeNames
    groups: Names = ()
    device: str = ""


class _Tier(Entry, frozen=True):
    """A tier as it is written; what is left out follows from its run (`_made`)."""

    run: RunId
    modules: Names = ()
    id: str = ""
    asks: Asks | None = None
    when: When | None = None
    constants: dict[Name, Text] = msgspec.field(default_factory=dict)
    definitions: str = ""
    types: Names = ()
    decides: bool = True
    timeout_s: Annotated[float, msgspec.Meta(gt=0)] = 120
    heap_mb: Count = 512


class _Unreached(Entry, frozen=True):
    """What no feasible path of these devices passes; proofs/explorer/coverage.py judges it."""

    devices: Ids
    places: Ids
    why: Text


class _File(Entry, frozen=True):
    document: str = ""
    rule: _Rule = _Rule()
    module: tuple[_Module, ...] = ()
    definitions: dict[Name, Text] = msgspec.field(default_factory=dict)
    tier: tuple[_Tier, ...] = ()
    suites: Names = ()
    rejudged: tuple[Rejudged, ...] = ()
    survivor: tuple[Explained, ...] = ()
    unreached: tuple[_Unreached, ...] = ()
    refuted: dict[str, Edit] = msgspec.field(default_factory=dict)
    by_construction: dict[str, Text] = msgspec.field(default_factory=dict)


@dataclass(frozen=True)
class Strength:
    """What edits and judges a specification: a rule for each module, tiers in the order of judging."""

    document: str
    rules: Mapping[str, Rule]
    tiers: tuple[Tier, ...]
    explained: tuple[Explained, ...]
    rejudged: tuple[Rejudged, ...] = ()

    def tiers_of(self, module: str) -> tuple[Tier, ...]:
        """The tiers that judge mutants of a module, in order."""
        return tuple(tier for tier in self.tiers if module in tier.modules)


@dataclass(frozen=True)
class CodeStrength:
    """What edits the code, and the suites that judge it (empty: every suite); survivors by their judge."""

    cycles: tuple[tuple[str, ...], ...] = ()
    turns: tuple[tuple[str, str], ...] = ()
    suites: tuple[str, ...] = ()
    survivors: tuple[Explained, ...] = ()

    def explained(self, judge: Judge) -> tuple[Explained, ...]:
        """The survivors of one judge."""
        return tuple(row for row in self.survivors if row.judge == judge)


def path_of(place: Path, document: str) -> Path:
    """Where the register of the specification lies."""
    return place / "spec" / document / "strength.toml"


def code_path(place: Path, document: str) -> Path:
    """Where the register of the code lies."""
    return place / "proofs" / document / "strength.toml"


def edited(place: Path, path: Path) -> bool:
    """Whether there is a register that says what is edited. Raises Unjudged."""
    return path.is_file() and _read(place, path)[1].rule != _Rule()


def load_strength(place: Path, document: str) -> Strength:
    """Read the register. Raises Unjudged with place and cause for whatever is not understood."""
    path = path_of(place, document)
    if not path.is_file():
        raise Unjudged(f"spec/{document}/strength.toml: not found; it says what is edited and who judges it")
    source, file = _read(place, path)
    if not file.module or not file.tier:
        raise Unjudged(f"{source}: no module or no tier is declared")
    rules = {row.name: _rule(place, document, source, file, row) for row in file.module}
    runs = {run.id: run for run in load_runs(place, document)}
    tiers: list[Tier] = []
    for row in file.tier:
        tier = _made(source, file, row, runs, tiers)
        if tier.id in (other.id for other in tiers):
            raise Unjudged(f"{source}: tier {tier.id} is declared twice")
        tiers.append(tier)
    for module in rules:
        if not any(module in tier.modules for tier in tiers):
            raise Unjudged(f"{source}: no tier judges module {module}")
    return Strength(document, rules, tuple(tiers), file.survivor, file.rejudged)


def load_code(place: Path, document: str) -> CodeStrength:
    """Read the register of the code. Raises Unjudged with place and cause for whatever is not understood."""
    _, file = _read(place, code_path(place, document))
    return CodeStrength(file.rule.cycles, file.rule.turns, file.suites, file.survivor)


def _read(place: Path, path: Path) -> tuple[str, _File]:
    source = path.relative_to(place).as_posix()
    return source, typed(_File, read_toml(place, path), source)


def _rule(place: Path, document: str, source: str, file: _File, row: _Module) -> Rule:
    if row.name.endswith(AS_PRINTED):
        raise Unjudged(f"{source}: module {row.name}: a module of readings is not mutated")
    return Rule(
        behaviour=row.behaviour,
        leave=frozenset(file.rule.leave),
        kinds=_kinds(place, document, source, row.device) if row.device else (),
        cycles=file.rule.cycles,
        groups=frozenset(row.groups),
    )


def _made(source: str, file: _File, row: _Tier, runs: Mapping[str, Run], before: list[Tier]) -> Tier:
    """The tier of a row. Of itself it asks what a run of its kind can say, of the modules that are edited,
    always where it is the first of a module; a type invariant of its run stops it.
    """
    at = f"{source}: tier {row.id or row.run}"
    if row.run not in runs:
        raise Unjudged(f"{at}: run {row.run} is not in runs.toml; {suggestion(row.run, runs)}")
    run = runs[row.run]
    asks: Asks = row.asks or ("liveness" if run.kind == "LIVE" else "properties")
    known = tuple(module.name for module in file.module)
    modules = row.modules or known
    for module in modules:
        if module not in known:
            raise Unjudged(f"{at}: module {module} is not declared; {suggestion(module, known)}")
    if asks == "graph" and run.kind != "OPEN":
        raise Unjudged(f"{at}: a graph is printed by a run of kind OPEN only")
    if asks == "liveness" and len(run.properties) != 1:
        raise Unjudged(f"{at}: TLC does not name a violated temporal property, so a run must have one only")
    if row.definitions and row.definitions not in file.definitions:
        raise Unjudged(f"{at}: definitions: {suggestion(row.definitions, file.definitions)}")
    first = not any(set(modules) & set(tier.modules) for tier in before)
    types = [name for name in run.properties if name.endswith("TypeOK")] if asks == "properties" else []
    off = {_OFF[asks]: "FALSE"} if run.kind == "OPEN" and asks in _OFF else {}
    return Tier(
        id=row.id or f"{row.run}{', graph' if asks == 'graph' else ''}",
        modules=modules,
        run=run,
        asks=asks,
        when=row.when or ("always" if first else "left"),
        constants={**off, **row.constants},
        definitions=file.definitions.get(row.definitions, ""),
        types=(*types, *row.types),
        decides=asks == "graph" and row.decides,
        timeout_s=row.timeout_s,
        heap_mb=row.heap_mb,
    )


def _kinds(place: Path, document: str, source: str, name: str) -> tuple[tuple[str, ...], ...]:
    """The lists of strings that interface.toml declares for a device: its states, and the values of texts."""
    devices = load_interface(place, document).devices
    if name not in devices:
        raise Unjudged(f"{source}: device {name} is not in interface.toml; {suggestion(name, devices)}")
    device = devices[name]
    kinds = [device.states]
    for group in (device.inputs, device.outputs, device.parameters):
        kinds += [tuple(map(str, signal.values)) for signal in group.values() if signal.values]
    return tuple(kind for kind in kinds if len(kind) > 1)
