"""Finds contradictions between the registers of one document. The schema of a single file cannot see them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from modeproof.ground.errors import suggestion
from modeproof.registers.citations import Sources
from modeproof.registers.demands_page import check_demands
from modeproof.registers.fault_table import check_faults
from modeproof.registers.profiles import check_profiles
from modeproof.registers.rows import Device, Document, Problem, Signal
from modeproof.registers.runs import Run
from modeproof.registers.tla import closure

PERSON = "user"
"""The only actor that is not a device of an interface."""

TECHNICAL = re.compile(r"\w*TypeOK|Print\w*")
"""Invariants that type the variables or print the graph; they state no requirement and need no row."""


PROMISE = re.compile(
    r"\b(not yet|no run yet|comes? with|they come|later|to come|will be|planned|to do|soon|unreleased)\b",
    re.IGNORECASE,
)
"""Words of a promise: what is missing now is not explained by what is meant to come."""


def cross_check(document: Document, sources: Sources) -> list[Problem]:
    """All contradictions between registers; an empty list when there is none."""
    return [
        *_clauses(document),
        *_interface(document),
        *_properties(document, sources),
        *check_profiles(document, value_fault),
        *_theorems(document, sources),
        *_findings(document, sources),
        *_assumptions(document),
        *_runs(document, sources),
        *check_faults(document),
        *check_demands(document),
    ]


def _clauses(document: Document) -> Iterator[Problem]:
    file = document.source("clauses")
    known = [*document.interface.devices, PERSON]
    for clause in document.clauses:
        if not clause.id.startswith(f"{document.about.prefix}-"):
            yield Problem(file, clause.id, f"the id does not begin with the prefix {document.about.prefix}-")
        for device in clause.device:
            if device not in known:
                yield Problem(file, clause.id, f"unknown device {device!r}; {suggestion(device, known)}")


def _interface(document: Document) -> Iterator[Problem]:
    file = document.source("interface")
    for device in document.interface.devices.values():
        if device.codes and {*device.codes} != {*device.states}:
            other = min({*device.codes} ^ {*device.states})
            yield Problem(file, f"devices.{device.id}.codes", f"{other}: each state has a code, and no other")
        for name in sorted(device.inputs.keys() & device.outputs.keys()):
            yield Problem(file, f"devices.{device.id}", f"{name} is both an input and an output")
        for group, signals in _groups(device):
            for signal in signals:
                for text in _signal_faults(signal, group):
                    yield Problem(file, f"devices.{device.id}.{group}.{signal.name}", text)


def _groups(device: Device) -> list[tuple[str, list[Signal]]]:
    return [
        ("memory", list(device.memory.values())),
        ("inputs", list(device.inputs.values())),
        ("outputs", list(device.outputs.values())),
        ("parameters", list(device.parameters.values())),
    ]


def _signal_faults(signal: Signal, group: str) -> Iterator[str]:
    if signal.minimum is not None and signal.maximum is not None and signal.minimum > signal.maximum:
        yield f"min {signal.minimum} is greater than max {signal.maximum}"
    if signal.type == "text" and not signal.values and group != "memory":
        yield "a text needs the list of its values"
    if signal.type != "text" and signal.values:
        yield f"values belong to the type text, not to {signal.type}"
    if signal.type in ("int", "ms") and group == "parameters" and None in (signal.minimum, signal.maximum):
        yield "a number needs min and max"
    if group == "parameters" and not signal.required and signal.default is None:
        yield "a parameter needs a default, or required = true"
    if signal.default is not None:
        fault = value_fault(signal, signal.default)
        if fault:
            yield f"default {signal.default!r} {fault}"


def value_fault(signal: Signal, value: object) -> str:
    """Why a parameter cannot have this value (as TOML has it); empty when it can."""
    if signal.type == "bool":
        return "" if isinstance(value, bool) else "is not true or false"
    if signal.type == "text":
        return "" if value in signal.values else f"is not one of {', '.join(map(repr, signal.values))}"
    if signal.type == "modes":
        modes = [mode for mode in value if type(mode) is int and mode >= 0] if isinstance(value, list) else []
        return "" if modes == value and modes == sorted(set(modes)) else "is not an ascending list of modes"
    if isinstance(value, str) and signal.type in ("word", "function"):
        return "" if re.fullmatch(r"[0-9A-F]{4}", value) else "is not a word of four upper-case hex digits"
    if not isinstance(value, int) or isinstance(value, bool):
        return "is not an integer"
    low = {"word": 0, "function": 0, "mode": -1}.get(signal.type, signal.minimum)
    high = {"word": 65535, "function": 65535}.get(signal.type, signal.maximum)
    if (low is not None and value < low) or (high is not None and value > high):
        return f"is not in {low}..{high}"
    return ""


def _properties(document: Document, sources: Sources) -> Iterator[Problem]:
    file = document.source("properties")
    witnesses = [name for run in document.runs for name in run.witnesses]
    decided = [run for run in document.runs if "full" in run.lanes and not run.readings]
    judged = {name for run in decided for name in run.witnesses}
    for prop in document.properties:
        runs = [
            run
            for run in document.runs
            if prop.tla in run.properties and run.kind != "NEG" and not run.readings
        ]
        if not runs:
            yield Problem(file, prop.id, f"no run checks {prop.tla}")
        for environment in prop.environments:
            if runs and environment not in [run.environment for run in runs]:
                names = dict.fromkeys(run.environment for run in runs)
                yield Problem(
                    file,
                    prop.id,
                    f"no run checks it in the environment {environment!r}; checked in: {', '.join(names)}",
                )
        if prop.antecedent and prop.antecedent not in witnesses:
            yield Problem(
                file,
                prop.id,
                f"no run has the witness {prop.antecedent!r}; {suggestion(prop.antecedent, witnesses)}",
            )
        elif prop.antecedent and prop.antecedent not in judged:
            text = f"the witness {prop.antecedent!r} is reached by no run of what was decided in lane full"
            yield Problem(file, prop.id, text)
        if prop.antecedent and prop.reason:
            yield Problem(file, prop.id, "names an antecedent, and `reason` says why it needs none")
        if not prop.antecedent and not prop.reason.strip():
            yield Problem(file, prop.id, "names no antecedent, and `reason` does not say why it needs none")
        modules = closure(sources.modules, prop.module)
        if not modules:
            yield Problem(
                file,
                prop.id,
                f"module {prop.module} does not exist; {suggestion(prop.module, sources.modules)}",
            )
        elif not any(prop.tla in module.defined for module in modules):
            defined = sorted(modules[0].defined)
            yield Problem(
                file,
                prop.id,
                f"{prop.module}.tla does not define {prop.tla}; {suggestion_of(prop.tla, defined)}",
            )


def _theorems(document: Document, sources: Sources) -> Iterator[Problem]:
    """A theorem that says that it proves a property names one that the register has."""
    known = [prop.id for prop in document.properties]
    for module in sources.proofs:
        for theorem in module.theorems:
            for name in theorem.properties:
                if name not in known:
                    text = f"proves the unknown property {name!r}; {suggestion_of(name, known)}"
                    yield Problem(module.file, theorem.name, text)


def suggestion_of(name: str, allowed: list[str]) -> str:
    """Like `suggestion`, without the list of everything that is allowed."""
    return (
        suggestion(name, allowed).split("? ")[0] + "?"
        if "? " in suggestion(name, allowed)
        else "nothing is close"
    )


def _findings(document: Document, sources: Sources) -> Iterator[Problem]:
    file = document.source("findings")
    known = _evidence_names(document, sources)
    clauses = {clause.id for clause in document.clauses}
    constants = sorted({name for module in sources.modules.values() for name in module.constants})
    for finding in document.findings:
        for name in finding.evidence:
            if name not in known and name not in clauses:
                yield Problem(
                    file,
                    finding.id,
                    f"evidence {name!r} is no run and no theorem; {suggestion_of(name, known)}",
                )
        if not finding.evidence and not finding.evidence_open.strip():
            yield Problem(
                file, finding.id, "names no evidence, and `evidence_open` does not say what is open"
            )
        if match := PROMISE.search(finding.evidence_open):
            yield Problem(
                file, finding.id, _promise("evidence_open", match.group(), "why no model can show it")
            )
        if finding.parameter and finding.parameter not in constants:
            text = f"parameter {finding.parameter!r} is no CONSTANT of the specification; "
            yield Problem(file, finding.id, text + suggestion_of(finding.parameter, constants))


def _promise(key: str, words: str, instead: str) -> str:
    return f"`{key}` is a promise ({words!r}); say {instead}, or name the evidence"


def _evidence_names(document: Document, sources: Sources) -> list[str]:
    theorems = [theorem.name for module in sources.proofs for theorem in module.theorems]
    return [*(run.id for run in document.runs), *theorems]


def _assumptions(document: Document) -> Iterator[Problem]:
    file = document.source("assumptions")
    runs = [run.id for run in document.runs]
    for assumption in document.assumptions:
        for name in assumption.breaks:
            if name not in runs:
                yield Problem(
                    file, assumption.id, f"breaks: unknown run {name!r}; {suggestion_of(name, runs)}"
                )
        if not assumption.breaks and not assumption.breaks_open.strip():
            yield Problem(
                file, assumption.id, "names no run that breaks it, and `breaks_open` does not say why"
            )
        if match := PROMISE.search(assumption.breaks_open):
            yield Problem(
                file, assumption.id, _promise("breaks_open", match.group(), "why no run can break it")
            )


def _runs(document: Document, sources: Sources) -> Iterator[Problem]:
    file = document.source("runs")
    known = [prop.tla for prop in document.properties]
    shown = {name for finding in document.findings for name in finding.evidence}
    shown |= {name for assumption in document.assumptions for name in assumption.breaks}
    yield from _steps_never_seen(document)
    for run in document.runs:
        modules = closure(sources.modules, run.module)
        if not modules:
            yield Problem(
                file, run.id, f"module {run.module} does not exist; {suggestion(run.module, sources.modules)}"
            )
        if run.kind == "NEG" and run.id not in shown:
            yield Problem(file, run.id, "no finding and no assumption names this negative run")
        for name in (*run.properties, *([run.property] if run.property else [])):
            if name not in known and not TECHNICAL.fullmatch(name):
                yield Problem(
                    file, run.id, f"{name} is in no row of properties.toml; {suggestion_of(name, known)}"
                )
        if run.graph is not None:
            for text in _graph_faults(document, run):
                yield Problem(file, run.id, text)


def _steps_never_seen(document: Document) -> Iterator[Problem]:
    """Steps of which no run shows that they fire: neither a witness nor a printed graph of the device."""
    witnesses = {name for run in document.runs for name in run.witnesses}
    printed = {run.graph.device for run in document.runs if run.graph is not None}
    for device in document.interface.devices.values():
        missing = [step for step in device.steps if step not in witnesses]
        if missing and device.id not in printed:
            text = f"no run shows that these steps of {device.id} fire: {', '.join(missing)}"
            yield Problem(document.source("runs"), "", text)


def _graph_faults(document: Document, run: Run) -> Iterator[str]:
    assert run.graph is not None
    device = document.interface.devices.get(run.graph.device)
    if device is None:
        yield f"graph.device: {suggestion(run.graph.device, document.interface.devices)}"
        return
    for name, value in run.graph.params.items():
        signal = device.parameters.get(name)
        if signal is None:
            yield f"graph.params: unknown parameter {name!r}; {suggestion(name, device.parameters)}"
        elif fault := value_fault(signal, value):
            yield f"graph.params: {name} = {value!r} {fault}"
    for output, source in run.graph.passed.items():
        if output not in device.outputs:
            yield f"graph.pass: unknown output {output!r}; {suggestion(output, device.outputs)}"
        if source not in device.inputs:
            yield f"graph.pass: unknown input {source!r}; {suggestion(source, device.inputs)}"
