"""Readings against runs and findings: every reading is tried alone once and named by a finding, and each
changes something. One that breaks nothing was asked every property that the decided device is asked. What a
reading is, modeproof/registers/made.py says.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from modeproof.ground.errors import Unjudged, suggestion
from modeproof.registers.crosscheck import TECHNICAL
from modeproof.registers.demands import MODULE
from modeproof.registers.made import SUFFIX, decided_modules, reading_problems, replaced_by, replacements
from modeproof.registers.profiles import profile_of
from modeproof.registers.replay import has_replay, load_replay
from modeproof.registers.rows import Document, Problem
from modeproof.registers.runs import ASKING, Run
from modeproof.registers.standing import UNASKED, standings
from modeproof.registers.tla import Module, closure

HARMLESS = re.compile(r"\b(?:is|are|as) harmless\b|breaks no property", re.IGNORECASE)
"""How a finding says that a reading does no harm."""


def readings_of(document: Document, modules: Mapping[str, Module]) -> tuple[str, ...]:
    """The readings of a document: those of its own modules, and of shared ones that a run could use."""
    reached: set[str] = set()
    for name in {run.module for run in document.runs}:
        reached |= {module.name for module in closure(modules, name)}
    own = f"spec/{document.name}/"
    return tuple(
        dict.fromkeys(
            replacement.reading
            for replacement in replacements(modules)
            if modules[replacement.module].file.startswith(own)
            or decided_modules(modules, replacement.module) <= reached
        )
    )


def check_readings(document: Document, modules: Mapping[str, Module]) -> list[Problem]:
    """All that is wrong with the readings of a document."""
    readings = readings_of(document, modules)
    own = f"spec/{document.name}/"
    return [
        *(
            Problem(file, name, text)
            for file, name, text in reading_problems(modules)
            if file.startswith(own)
        ),
        *_tried(document, readings),
        *_runs(document, modules),
        *_harmless(document, modules),
        *_findings(document, readings),
        *_unasked(document),
    ]


def _tried(document: Document, readings: Sequence[str]) -> Iterator[Problem]:
    """Every reading is tried alone in one run, NEG or MC, or by the demands, and is named by a finding.

    A reading that joins others which replace the same operator ends with SUFFIX. A run tries it with others.
    """
    named = {name for finding in document.findings for name in finding.tries}
    for name in readings:
        tried = [run for run in document.runs if run.readings == (name,) and not run.of]
        alone = {run.id: run.kind for run in tried if not run.module.endswith(MODULE)}
        if name.endswith(SUFFIX):
            if not any(name in run.readings for run in document.runs):
                yield Problem(document.source("runs"), name, "no run tries this reading")
        elif not tried:
            yield Problem(document.source("runs"), name, "no run tries this reading alone")
        if len(alone) > 1:
            text = f"more than one run tries this reading alone: {', '.join(alone)}"
            yield Problem(document.source("runs"), name, text)
        for run in (run for run, kind in alone.items() if kind not in ("NEG", "MC")):
            text = f"{run} tries it alone, which is neither a counterexample nor an MC run"
            yield Problem(document.source("runs"), name, text)
        if name not in named:
            yield Problem(document.source("findings"), name, "no finding names this reading in `tries`")


def _runs(document: Document, modules: Mapping[str, Module]) -> Iterator[Problem]:
    """The readings of every run can be used; one that breaks nothing changes something, and is asked in the
    view of its base.
    """
    of_base = {run.id: run.module for run in document.runs}
    for run in document.runs:
        try:
            replaced_by(modules, run)
        except Unjudged as error:
            place = f"{document.source('runs')}: run {run.id}: "
            yield Problem(document.source("runs"), run.id, error.message.removeprefix(place))
        asked = run.readings and run.kind in ASKING
        if asked and run.view is not None and run.module == of_base.get(run.base):
            yield Problem(document.source("runs"), run.id, "tries a reading in a view that is not its base's")
        counts = (run.distinct, run.generated)
        if not run.of and run.kind != "NEG" and None not in counts and (text := _idle(document, run, counts)):
            yield Problem(document.source("runs"), run.id, text)


def _harmless(document: Document, modules: Mapping[str, Module]) -> Iterator[Problem]:
    """Of a reading that an MC run calls harmless: the properties that none of its runs asks.

    It must be asked each that a run of the decided device asks, in the same module and the same profile,
    wherever that module can be given the reading. A run of the demands says that the page leaves a reading
    open, not that it is harmless.
    """
    for main in (run for run in document.runs if run.kind == "MC" and len(run.readings) == 1 and not run.of):
        if main.module.endswith(MODULE):
            continue
        try:
            there = askers(document, modules, main)
        except Unjudged:
            continue  # said where runs are looked at
        own = [run for run in document.runs if run.readings == main.readings and run.kind in ASKING]
        asked = {pair for run in own for pair in _asks(document, run)}
        while missing := [(run, lost) for run in there if (lost := _asks(document, run) - asked)]:
            run, lost = max(missing, key=lambda entry: (len(entry[1]), -(entry[0].generated or 0)))
            names = ", ".join(sorted(name for _, _, name in lost))
            text = f"calls {main.readings[0]} harmless without asking {names}; name {run.id} in its `also`"
            yield Problem(document.source("runs"), main.id, text)
            asked |= lost


def _asks(document: Document, run: Run) -> set[tuple[str, str, str]]:
    """The properties that a run asks, each with the module and the profile that it asks them in."""
    profile = profile_of(document.root, run, document.interface)
    return {
        (run.module, profile, name)
        for name in (*run.properties, run.property)
        if name and not TECHNICAL.fullmatch(name)
    }


def askers(document: Document, modules: Mapping[str, Module], run: Run) -> list[Run]:
    """The runs of the decided device that could be made with the reading of a run."""
    of = [decided_modules(modules, replacement.module) for replacement in replaced_by(modules, run)]
    return [
        other
        for other in document.runs
        if other.kind in ASKING
        and not other.readings
        and not other.module.endswith(MODULE)
        and any(needed <= {module.name for module in closure(modules, other.module)} for needed in of)
    ]


def _findings(document: Document, readings: Sequence[str]) -> Iterator[Problem]:
    """A finding names readings that there are, and among its evidence a run that has each; who says harmless
    shows an MC run with a reading, which is asked every property.
    """
    file = document.source("findings")
    for finding in document.findings:
        evidence = [run for run in document.runs if run.id in finding.evidence]
        judged = any(run.kind == "MC" and run.readings for run in evidence)
        said = " ".join((*finding.readings, finding.consequence, finding.decision))
        if HARMLESS.search(said) and not judged:
            yield Problem(file, finding.id, "says harmless, and no MC run with a reading is its evidence")
        for name in finding.tries:
            if name not in readings:
                text = f"tries {name!r}, which no module of readings has; {suggestion(name, readings)}"
                yield Problem(file, finding.id, text)
            elif not any(name in run.readings for run in evidence):
                yield Problem(
                    file, finding.id, f"tries {name!r}, but no run in its evidence has this reading"
                )


def _unasked(document: Document) -> Iterator[Problem]:
    """Where TLC judges demands, each reading is judged by them, or its finding says why it cannot be."""
    if not any(run.module.endswith(MODULE) for run in document.runs):
        return
    for finding in document.findings:
        asked = {one.reading: one.word != UNASKED for one in standings(finding, document.runs)}
        for name in sorted(asked.keys() | finding.unasked.keys()):
            if name not in asked:
                text = f"unasked: {name!r} is none of its readings"
            elif asked[name] == (name in finding.unasked):
                text = f"{name} is asked and has a reason why not" if asked[name] else f"{name} is not asked"
            else:
                continue
            yield Problem(document.source("findings"), finding.id, text)


def _idle(document: Document, run: Run, counts: tuple[int | None, int | None]) -> str:
    """Whether the readings of a run leave all counts as they are in its base; "" where they do not, or where
    something else differs too.
    """
    base = next((candidate for candidate in document.runs if candidate.id == run.base), None)
    others = run.constants or run.specification or run.view is not None
    if base is None or not run.readings or others or run.module != base.module or run.module.endswith(MODULE):
        return ""
    if counts != (base.distinct, base.generated):
        return ""
    return f"the reading {' and '.join(run.readings)} changes nothing: its counts are those of {base.id}"


def idle_reading(document: Document, run: Run, counts: tuple[int, int]) -> str:
    """Why a run that was to fail does not, in the words of its reading; "" where it has none.

    `counts` are the distinct and generated states that it has now.
    """
    if not run.readings:
        return ""
    broken = f"the reading {' and '.join(run.readings)} breaks nothing that this run checks"
    return _idle(document, run, counts) or broken


def check_tops(document: Document, modules: Mapping[str, Module]) -> Iterator[Problem]:
    """Every module that has a counterexample can be walked, by operators that exist (replay.toml)."""
    if not has_replay(document.root, document.name):
        return
    traces = load_replay(document.root, document.name)
    file = f"spec/{document.name}/replay.toml"
    for module, run in {run.module: run.id for run in document.runs if run.kind == "NEG"}.items():
        if module not in traces.tops:
            yield Problem(file, f"tops.{module}", f"missing; {run} checks that module")
    for module, top in traces.tops.items():
        defined = {name for reached in closure(modules, module) for name in reached.defined}
        names = {top.next, top.wires, *(text.split("(")[0] for text in top.inputs.values())}
        for name in sorted(names - defined) if defined else ():
            yield Problem(file, f"tops.{module}", f"{module}.tla and what it extends do not define {name}")
