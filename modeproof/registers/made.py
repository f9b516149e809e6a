"""The readings of a document, and the files of a run that is another run with a reading.

A reading is in a module <Module>AsPrinted, which extends <Module>: an operator called Op_Reading takes
the place of the decided operator Op. What a reading replaces is derived from these names. The cfg of such a
run is that of its base with `Op <- Op_Reading` among its constants; its root module extends the base's and
the modules that hold the reading. Both are made below build/.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import msgspec

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.ground.evidence.files import write_whole
from modeproof.registers.cfg import Cfg, Constant, parse_cfg
from modeproof.registers.files import read_text
from modeproof.registers.runs import Run
from modeproof.registers.tla import Module, closure, read_modules

SUFFIX = "AsPrinted"
"""The end of the name of a module that holds readings."""
_NAME = re.compile(r"(\w+)_([A-Z][A-Za-z0-9]*)")
_WORD = re.compile(r"[A-Za-z_]\w*")
_TEMPORAL = re.compile(r"\[\]\[|(?<!<)<>(?!>)|~>|!\w*Spec\b")
"""What is in a formula about more than one state; `[]` alone also divides the cases of CASE."""
_NO_NAME = re.compile(r'"[^"\n]*"|\.\w+|\w+\s*\|->')
"""Strings, and the names of fields."""


@dataclass(frozen=True)
class Replacement:
    """An operator of a reading: it takes the place of the decided operator `replaced`."""

    reading: str
    replaced: str
    operator: str
    module: str
    parameters: str
    """As they are after its name: `(i)`, or nothing."""


def replacements(modules: Mapping[str, Module]) -> tuple[Replacement, ...]:
    """Every operator of every reading, in the order of the modules and of their text."""
    return tuple(
        Replacement(match.group(2), match.group(1), definition.name, module.name, definition.parameters)
        for module in modules.values()
        if module.name.endswith(SUFFIX)
        for definition in module.definitions
        if (match := _NAME.fullmatch(definition.name))
    )


def reading_problems(modules: Mapping[str, Module]) -> Iterator[tuple[str, str, str]]:
    """What is wrong with the modules of readings: file, definition, and cause."""
    known = {(replacement.module, replacement.operator) for replacement in replacements(modules)}
    for module in (candidate for candidate in modules.values() if candidate.name.endswith(SUFFIX)):
        for definition in module.definitions:
            if "_" in definition.name and (module.name, definition.name) not in known:
                text = "is no Op_Reading (a reading is called by a name such as Figure7)"
                yield module.file, definition.name, text
    for replacement in replacements(modules):
        if fault := _fault(modules, replacement):
            yield modules[replacement.module].file, replacement.operator, fault


def _fault(modules: Mapping[str, Module], replacement: Replacement) -> str:
    """Says why TLC cannot replace the decided operator; empty when it can."""
    own = {name.name: name for name in modules[replacement.module].definitions}
    reached = closure(modules, replacement.module)
    decided = [(m, d) for m in reached for d in m.definitions if d.name == replacement.replaced]
    if own[replacement.operator].local:
        return "is LOCAL, so that it cannot take the place of another"
    if not decided:
        return f"replaces nothing: no module that {replacement.module} extends defines {replacement.replaced}"
    if decided[0][1].local:
        return f"cannot replace {replacement.replaced}, which is LOCAL in {decided[0][0].file}"
    if replacement.replaced in used(
        {d.name: d.body for m in reached for d in m.definitions}, replacement.operator
    ):
        return f"uses {replacement.replaced}, which it replaces: TLC would never come to an end"
    return ""


@cache
def words_of(definition: str) -> frozenset[str]:
    """The names on the right side of a definition."""
    return frozenset(_WORD.findall(_NO_NAME.sub(" ", definition.partition("==")[2])))


def used(bodies: Mapping[str, str], name: str) -> set[str]:
    """All definitions that a definition uses, directly or by another."""
    reached: set[str] = set()
    waiting = [name]
    while waiting:
        for word in {word for word in words_of(bodies[waiting.pop()]) if word in bodies} - reached:
            reached.add(word)
            waiting.append(word)
    return reached


def replaced_by(modules: Mapping[str, Module], run: Run) -> tuple[Replacement, ...]:
    """What the readings of a run replace.

    Raises Unjudged with the run and the cause: a reading that no module has, or none for the run's module;
    two readings that replace the same operator; an operator that TLC could not replace.
    """
    return replacing(modules, run.module, run.readings, f"spec/{run.document}/runs.toml: run {run.id}")


def replacing(
    modules: Mapping[str, Module], module: str, readings: Sequence[str], place: str
) -> tuple[Replacement, ...]:
    """What readings replace in a module and all that it extends. Raises Unjudged like `replaced_by`."""
    every = replacements(modules)
    there = {extended.name for extended in closure(modules, module)}
    found: dict[str, Replacement] = {}
    for reading in readings:
        own = [replacement for replacement in every if replacement.reading == reading]
        if not own:
            known = dict.fromkeys(replacement.reading for replacement in every)
            raise Unjudged(f"{place}: unknown reading {reading!r}; {suggestion(reading, known)}")
        fitting = [
            replacement for replacement in own if decided_modules(modules, replacement.module) <= there
        ]
        if not fitting:
            names = " and ".join(dict.fromkeys(replacement.module for replacement in own))
            raise Unjudged(f"{place}: the reading {reading} is in {names}, which {module} cannot use")
        for replacement in fitting:
            if fault := _fault(modules, replacement):
                raise Unjudged(f"{place}: {modules[replacement.module].file}: {replacement.operator} {fault}")
            if (other := found.get(replacement.replaced)) is not None:
                both = f"{other.reading} and {reading}" if other.reading != reading else f"{reading} twice"
                raise Unjudged(
                    f"{place}: {replacement.replaced} is replaced by {both}; write one reading of its own"
                )
            found[replacement.replaced] = replacement
    return tuple(found.values())


def decided_modules(modules: Mapping[str, Module], name: str) -> set[str]:
    """The modules that a module of readings extends, without other modules of readings."""
    return {module.name for module in closure(modules, name) if not module.name.endswith(SUFFIX)}


def read_cfg(root: Path, run: Run) -> Cfg:
    """What the cfg of a run says, whether by hand or made. Raises Unjudged like `cfg_text`."""
    return parse_cfg(cfg_text(root, run), f"{run.name}: {run.config}")


def cfg_text(root: Path, run: Run) -> str:
    """The text of the cfg of a run, whether by hand or made.

    Raises Unjudged: the cfg or a module cannot be read; a reading that cannot be used (`replaced_by`).
    """
    if not run.base and run.cfg:
        return read_text(root, root / "spec" / run.document / run.cfg)
    cfg = base_cfg(root, run)
    if not run.base:
        return f"\\* Made from spec/{run.document}/runs.toml: {run.id}.\n{cfg.text()}"
    given = dict(cfg.constants)
    for name, value in run.constants.items():
        named = value.startswith("<-")
        given[name] = Constant(value.removeprefix("<-").strip(), named)
    if run.readings:
        for replacement in replaced_by(read_modules(root, run.document), run):
            given[replacement.replaced] = Constant(replacement.operator, True)
    cfg = replace(
        cfg,
        constants=given,
        invariants=tuple(name for name in cfg.invariants if name in run.properties),
        properties=tuple(name for name in cfg.properties if name in run.properties),
    )
    if run.specification:
        cfg = replace(cfg, init="", next="", specification=run.specification)
    if run.view is not None:
        cfg = replace(cfg, view=run.view)
    if run.of and "PRINT_GRAPH" in given:  # its base prints a graph; nobody reads this one
        given["PRINT_GRAPH"] = Constant("FALSE", False)
        cfg = replace(cfg, action_constraints=())
    differs = [f"the reading {' and '.join(run.readings)}"] if run.readings else []
    differs += [f"{name} given anew" for name in run.constants]
    words = ", ".join(differs) or "another specification"
    return f"\\* Made from spec/{run.document}/runs.toml: {run.base} with {words}.\n{cfg.text()}"


def base_cfg(root: Path, run: Run) -> Cfg:
    """The cfg of a run's base, or of a run without one: by hand, or made of its row. Raises Unjudged.

    Of the constants those are given that the modules declare.
    """
    if run.model is None:
        return parse_cfg(
            read_text(root, root / "spec" / run.document / run.cfg), f"{run.name}: {run.cfg or run.id}"
        )
    declared, temporal = _facts(root, run.document, run.module)
    given = {
        name: Constant(text.removeprefix("<-").strip(), text.startswith("<-"))
        for name, text in run.model.constants.items()
        if name in declared
    }
    return Cfg(
        constants=given,
        invariants=tuple(name for name in run.properties if name not in temporal),
        properties=tuple(name for name in run.properties if name in temporal),
        action_constraints=run.model.action_constraints,
        specification=run.model.specification,
        view=run.model.view,
    )


def _facts(root: Path, document: str, module: str) -> tuple[frozenset[str], frozenset[str]]:
    """What a module and all that it extends declare: its constants, and its formulas of time."""
    folders = (root / "spec" / "common", root / "spec" / document)
    files = [path.stat() for folder in folders for path in sorted(folder.glob("*.tla"))]
    return _read_facts(root, document, module, tuple((file.st_mtime_ns, file.st_ino) for file in files))


@cache
def _read_facts(
    root: Path, document: str, module: str, files: tuple[tuple[int, int], ...]
) -> tuple[frozenset[str], frozenset[str]]:
    """The same; `files` tells apart what was read before from what is there now."""
    modules = closure(_read(root, document, files), module, instances=False)
    temporal = {d.name for m in modules for d in m.definitions if _TEMPORAL.search(d.body)}
    return frozenset(name for m in modules for name in m.constants), frozenset(temporal)


@cache
def _read(root: Path, document: str, files: tuple[tuple[int, int], ...]) -> Mapping[str, Module]:
    return read_modules(root, document)


def module_text(root: Path, run: Run) -> str:
    """The text of the root module of a run whose cfg is made. Raises Unjudged like `cfg_text`."""
    found = replaced_by(read_modules(root, run.document), run)
    return root_module(run.id, run.module, found)


def root_module(name: str, module: str, replaced: Sequence[Replacement]) -> str:
    """The text of a module that extends a module and the modules of the readings."""
    holding = dict.fromkeys(replacement.module for replacement in replaced)
    return f"---- MODULE {name} ----\nEXTENDS {', '.join((module, *holding))}\n====\n"


def make(root: Path, run: Run) -> tuple[Path, Run]:
    """Write the root module and the cfg of a run; their folder, and the run by hand of them.

    Raises Unjudged like `cfg_text`, or when the files cannot be written.
    """
    config = root / run.config
    write_whole(config.with_suffix(".tla"), module_text(root, run).encode("utf-8"))
    write_whole(config, cfg_text(root, run).encode("utf-8"))
    return config.parent, msgspec.structs.replace(run, module=run.id, cfg=config.name, base="")
