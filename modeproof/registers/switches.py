"""Switches against findings and runs: every reading that can be restored is tried alone once and named by a
finding, and every switch changes something. Needs the register replay.toml, which names the constant that
holds them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from modeproof.ground.errors import suggestion
from modeproof.registers.cfg import Constant
from modeproof.registers.citations import Sources
from modeproof.registers.made import read_cfg
from modeproof.registers.replay import Traces, has_replay, load_replay
from modeproof.registers.rows import Document, Problem
from modeproof.registers.runs import Run
from modeproof.registers.tla import Definition, Module

_TEXT = re.compile(r'"([^"\n]*)"')
_NAME = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True)
class Model:
    """What a run checks its properties on: module, constants, specification and view, and the pinned
    counts.
    """

    run: Run
    constants: Mapping[str, Constant]
    restored: frozenset[str]
    bounds: tuple[Any, ...]
    """All but the restored readings: what makes two runs comparable."""
    counts: tuple[int | None, int | None]


def check_switches(document: Document, sources: Sources) -> list[Problem]:
    """All that is wrong with the switches of a document; nothing where it has no replay.toml."""
    if not has_literal(document, sources.modules):
        return []
    traces = load_replay(document.root, document.name)
    readings = readings_of(traces, sources)
    if not readings:
        text = f"{traces.readings} lists no reading: no module defines it as a set of names in quotes"
        return [Problem(f"spec/{document.name}/replay.toml", "readings", text)]
    models = models_of(document, traces)
    return [
        *_readings(document, traces, sources, readings, models),
        *_misnamed(document, traces, sources, readings),
        *_findings(document, sources, readings, models),
        *_idle(document, models),
    ]


def has_literal(document: Document, modules: Mapping[str, Module]) -> bool:
    """Whether a constant holds the readings, as it was before they stood in modules of their own."""
    if not has_replay(document.root, document.name):
        return False
    literal = load_replay(document.root, document.name).literal
    return any(literal in one.constants for one in modules.values())


def readings_of(traces: Traces, sources: Sources) -> tuple[str, ...]:
    """The names that the specification lists, in their order."""
    return tuple(dict.fromkeys(name for one in _lists(traces, sources) for name in _TEXT.findall(one.body)))


def _lists(traces: Traces, sources: Sources) -> list[Definition]:
    """The definition that lists the readings, and before it those of shared modules that it names."""
    every = [one for module in sources.modules.values() for one in module.definitions]
    own = [one for one in every if one.name == traces.readings][:1]
    named = set(_NAME.findall(_TEXT.sub("", own[0].body))) if own else set()
    return [one for one in every if one.name in named and one not in own and _TEXT.search(one.body)] + own


def models_of(document: Document, traces: Traces) -> tuple[Model, ...]:
    """The model of every run whose cfg exists."""
    found = []
    for run in document.runs:
        if not (document.folder / run.cfg).is_file():
            continue
        cfg = read_cfg(document.root, run)
        others = tuple(sorted((k, v.text) for k, v in cfg.constants.items() if k != traces.literal))
        spec = (cfg.specification, cfg.init, cfg.next, cfg.view)
        names = restored(cfg.constants, traces.literal)
        counts = (run.distinct, run.generated)
        found.append(Model(run, cfg.constants, names, (run.module, others, spec), counts))
    return tuple(found)


def restored(constants: Mapping[str, Constant], literal: str) -> frozenset[str]:
    """The readings that a cfg restores: the texts in its constant `literal`."""
    given = constants.get(literal)
    return frozenset(_TEXT.findall(given.text)) if given is not None else frozenset()


def idle_switch(document: Document, run: str, counts: tuple[int, int]) -> str:
    """Why a run that was to fail does not, in the words of its switch; empty where it restores nothing.

    `counts` are the distinct and generated states that it has now.
    """
    if not has_replay(document.root, document.name):
        return ""
    models = models_of(document, load_replay(document.root, document.name))
    own = next((model for model in models if model.run.id == run), None)
    if own is None or not own.restored:
        return ""
    names = " and ".join(sorted(own.restored))
    for other in models:
        if not other.restored and other.bounds == own.bounds and other.counts == counts:
            return f"the switch {names} changes nothing: its counts are those of {other.run.id}"
    return f"{names} restored breaks nothing that this run checks"


def _readings(
    document: Document, traces: Traces, sources: Sources, readings: Sequence[str], models: Sequence[Model]
) -> Iterator[Problem]:
    """Every reading is asked for, tried alone in exactly one run, and named by a finding."""
    file = document.source("runs")
    asked = _asked(traces, sources, readings)
    named = {name for one in document.findings for name in one.switches}
    for name in readings:
        alone = [model.run.id for model in models if model.restored == {name}]
        if name not in asked:
            text = f"the switch changes nothing: it is in {traces.readings}, and no definition asks for it"
            yield Problem(file, name, text)
        if not alone:
            yield Problem(file, name, "no run restores this reading alone")
        if len(alone) > 1:
            yield Problem(file, name, f"more than one run restores this reading alone: {', '.join(alone)}")
        if name not in named:
            yield Problem(document.source("findings"), name, "no finding names this switch")
    for model in models:
        if model.run.switch in readings and model.restored != {model.run.switch}:
            found = ", ".join(sorted(model.restored)) or "nothing"
            yield Problem(
                file, model.run.id, f"switch {model.run.switch!r}, but {model.run.cfg} restores {found}"
            )
        for name in sorted(model.restored - set(readings)):
            text = f"{model.run.cfg} restores {name!r}, which {traces.readings} does not list; "
            yield Problem(file, model.run.id, text + suggestion(name, readings))


def _asked(traces: Traces, sources: Sources, readings: Sequence[str]) -> set[str]:
    """The readings that a definition asks for, in quotes or by the name of a definition that does.

    Such a definition is called as the reading is. Alone it asks for nothing, and neither do the lists.
    """
    lists = _lists(traces, sources)
    every = [one for module in sources.modules.values() for one in module.definitions if one not in lists]
    named = {one.name for one in every if one.name in readings and _TEXT.findall(one.body) == [one.name]}
    asked: set[str] = set()
    for one in every:
        if one.name not in named:
            asked |= set(_TEXT.findall(one.body)) | (named & set(_NAME.findall(_TEXT.sub("", one.body))))
    return asked


def _misnamed(
    document: Document, traces: Traces, sources: Sources, readings: Sequence[str]
) -> Iterator[Problem]:
    """A definition that is called as a reading is asks for that one."""
    lists = _lists(traces, sources)
    for module in sources.modules.values():
        for one in module.definitions:
            found = [text for text in _TEXT.findall(one.body) if text in readings]
            if one.name in readings and one not in lists and found != [one.name]:
                what = " and ".join(found) or "no reading"
                text = (
                    f"the definition of {one.name} asks for {what}; it is to ask for the reading of its name"
                )
                yield Problem(f"spec/{document.name}/replay.toml", one.name, text)


def _findings(
    document: Document, sources: Sources, readings: Sequence[str], models: Sequence[Model]
) -> Iterator[Problem]:
    """A switch of a finding is a reading or a constant, and a run among the finding's evidence uses it."""
    file = document.source("findings")
    constants = {name for module in sources.modules.values() for name in module.constants}
    for one in document.findings:
        for name in one.switches:
            if name not in readings and name not in constants:
                text = f"switch {name!r} is not in the specification; {suggestion(name, readings)}"
                yield Problem(file, one.id, text)
            elif name in readings and not any(
                name in model.restored and model.run.id in one.evidence for model in models
            ):
                text = f"has the switch {name!r}, but no run in its evidence restores it"
                yield Problem(file, one.id, text)


def _idle(document: Document, models: Sequence[Model]) -> Iterator[Problem]:
    """A run whose counts are those of the good model at the same bounds: its switch changes nothing."""
    good = [model for model in models if not model.restored]
    for model in models:
        for other in good:
            same = model.restored and model.bounds == other.bounds and model.counts == other.counts
            if same and None not in model.counts and model.run.kind != "NEG":
                names = " and ".join(sorted(model.restored))
                text = f"the switch {names} changes nothing: its counts are those of {other.run.id}"
                yield Problem(document.source("runs"), model.run.id, text)
                break
