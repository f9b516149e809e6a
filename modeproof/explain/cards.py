"""The card of a thing: what it is, what the paper says, what we decided, and what was shown."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from modeproof.explain.shown import record_of, tally, verdict
from modeproof.explain.things import Thing, lines_with
from modeproof.registers.citations import Citation, Sources, citations
from modeproof.registers.files import read_text, shown
from modeproof.registers.killers import load_killers
from modeproof.registers.matrix import matrix_of
from modeproof.registers.python_source import PythonTheorem, scan_python
from modeproof.registers.rows import Clause, Device, Document, Finding, Property, Signal
from modeproof.registers.runs import Run
from modeproof.registers.tla import scan

Lines = Iterator[tuple[str, str]]
"""A label and a text each; without a label the text goes on."""
MANY = 8
"""So many places of one kind are listed; of more the number is told."""


def card(root: Path, thing: Thing) -> list[tuple[str, str]]:
    """The lines of the card below its head."""
    return list(_CARDS[thing.kind](root, thing))


def head(thing: Thing) -> str:
    """What it is and where it is declared."""
    of = f" of {thing.of.id}" if thing.of else ""
    document = f", {thing.document.name}" if thing.document and thing.kind != "document" else ""
    return f"{thing.id}: {thing.kind}{of}{document} ({thing.place})"


def _clause(root: Path, thing: Thing) -> Lines:
    row, document = thing.row, _document(thing)
    assert isinstance(row, Clause)
    yield "the paper says", f"{row.title}. {row.text}"
    yield "kind", f"{row.kind}; of {', '.join(row.device)}" if row.device else row.kind
    yield "where", ", ".join(text for text in (row.pages, row.figure) if text)
    yield "why so", row.because
    cited, where = _cited(root, document, row.id)
    for finding in document.findings:
        if row.id in finding.clauses:
            yield "we decided", f"{finding.id}: {finding.decision}"
    yield from _places(cited, where)
    for prop in document.properties:
        if row.id in prop.clauses:
            yield "property", f"{prop.id}: {prop.sentence} {_judged(root, document, prop)}"
    yield from _theorems(root, document, (one.name for one in cited if one.kind == "theorem"))
    for assumption in document.assumptions:
        if row.id in assumption.clauses:
            yield "assumption", f"{assumption.id}: {assumption.text} Ensured by: {assumption.who}."
    (line,) = matrix_of(dataclasses.replace(document, clauses=(row,)), cited)
    yield from _vectors(root, line.vector)


def _finding(root: Path, thing: Thing) -> Lines:
    row, document = thing.row, _document(thing)
    assert isinstance(row, Finding)
    yield "what is open", f"{row.title}."
    yield "the paper says", row.says
    for number, reading in enumerate(row.readings, 1):
        yield f"reading {number}", reading
    yield "what may happen", row.consequence
    yield "we decided", row.decision
    yield "class", row.severity + ("; the drawing could settle it" if row.drawing_could_settle else "")
    yield "parameter", row.parameter
    yield "clauses", ", ".join(row.clauses)
    cited, where = _cited(root, document, row.id)
    yield from _places(cited, where)
    for id in row.evidence:
        yield "shown by", f"{id}: {_how(document, id)}{verdict(root, document.name, id)}"
    yield "not shown", row.evidence_open
    if row.telling:
        yield "see it", f"modeproof check {row.telling.run} --trace; docs/{document.name}.md tells the story"


def _property(root: Path, thing: Thing) -> Lines:
    row, document = thing.row, _document(thing)
    assert isinstance(row, Property)
    yield "it says", row.sentence
    yield "if it is not so", row.hazard
    yield "clauses", ", ".join((*row.clauses, *row.findings))
    yield "in TLA+", f"{row.module}!{row.tla} ({_defined(root, document, row.module, row.tla)})"
    yield "why so", row.reason
    asking = [run for run in document.runs if row.tla in _checks(run) and run.kind != "NEG"]
    for run in asking[:MANY]:
        text = verdict(root, document.name, run.id)
        yield "asked in", f"{run.id} (environment {run.environment}): {text}"
    yield "", f"and {len(asking) - MANY} more runs" if len(asking) > MANY else ""
    yield from _theorems(
        root, document, (t.name for t in _theorems_of(root, document, row.id) if row.id in t.properties)
    )
    for run in document.runs:
        if run.kind == "NEG" and run.property == row.tla:
            yield "fails in", f"{run.id}: {_how(document, run.id)}{verdict(root, document.name, run.id)}"
    for name, edit in load_killers(root, document.name).edits.items():
        if edit.property == row.id:
            yield "fails with", f"{edit.module}.tla: {_short(edit.old)} -> {_short(edit.new)} ({name})"


def _machine_property(root: Path, thing: Thing) -> Lines:
    row, name = thing.row, thing.file.split("/")[1]
    yield "it says", str(row.get("sentence", ""))
    yield "if it is not so", str(row.get("hazard", ""))
    yield "in the file", "; ".join(f"{key} {row[key]}" for key in ("holds", "only_if") if key in row)
    yield "rests on", ", ".join(row.get("cites", ()))
    record = record_of(root, name, "machine") or {}
    judged = {one["id"]: one["verdict"] for one in record.get("result", {}).get("verdicts", ())}
    whole = verdict(root, name, "machine")
    yield "shown", f"{judged[thing.id]}; the whole machine: {whole}" if thing.id in judged else whole
    yield "judge it", "modeproof machine; with your own wiring: modeproof machine MY.toml"


def _assumption(root: Path, thing: Thing) -> Lines:
    row, document = thing.row, _document(thing)
    yield "we assume", row.text
    yield "kind", row.kind
    yield "ensured by", row.who
    yield "check it", row.check
    yield "clauses", ", ".join(row.clauses)
    for id in row.breaks:
        yield "without it", f"{id}: {_how(document, id)}{verdict(root, document.name, id)}"
    yield "without it", row.breaks_open


def _fault(root: Path, thing: Thing) -> Lines:
    row, document = thing.row, _document(thing)
    yield "what happens", f"{row.title} (class: {row.kind}). {row.model}"
    yield "detected by", "; ".join(row.detected_by)
    yield "not detected", row.not_detected
    yield "still true", ", ".join(row.holds)
    for id in row.runs:
        yield "asked in", f"{id}: {verdict(root, document.name, id)}"
    for fall in row.falls:
        yield "fails", f"{fall.property} in {fall.run}: {fall.needs}"
    yield "not modelled", row.not_modelled


def _response(root: Path, thing: Thing) -> Lines:
    row, document = thing.row, _document(thing)
    yield "from", row.start
    yield "to", row.end
    times = "".join(f" + {count} x {name}" for name, count in row.times.items())
    yield "at most", f"{row.calls} calls of {row.device}{times}" if row.calls else ""
    yield "no bound", row.unbounded
    yield "clauses", ", ".join(row.clauses)
    yield from _theorems(
        root, document, (t.name for t in _theorems_of(root, document, row.id) if row.id in t.responses)
    )


def _chain(root: Path, thing: Thing) -> Lines:
    yield "what", thing.row.title
    yield "steps", ", ".join(thing.row.steps)
    yield "then", thing.row.then


def _run(root: Path, thing: Thing) -> Lines:
    row, document = thing.row, _document(thing)
    assert isinstance(row, Run)
    kinds = {
        "MC": "every property must hold in every state",
        "LIVE": "what must happen some day does",
        "OPEN": "as MC; the whole graph is kept and compared with the reference implementation",
        "NEG": "a run that must fail: another reading, or a fault",
        "WIT": "each situation named must be reached",
    }
    yield "what it is", f"a run of TLC: {kinds[row.kind]}"
    yield "model", f"{row.module} ({_defined(root, document, row.module, '')})"
    yield "based on", row.base
    yield "reading", ", ".join(row.readings)
    yield "environment", row.environment
    yield "bounds", row.strength
    yield "must fail", row.property if row.kind == "NEG" else ""
    yield "checks", ", ".join(row.properties)
    yield "reaches", ", ".join(row.witnesses)
    yield "why", row.why
    states = f"{row.distinct:,} distinct states" if row.distinct is not None else ""
    yield "must give", f"{row.expect}{f', {states}' if states else ''}"
    yield "lanes", ", ".join(row.lanes)
    yield "shown", verdict(root, document.name, row.id)
    yield "judge it", f"modeproof check {row.name} --trace"


def _theorem(root: Path, thing: Thing) -> Lines:
    row, document = thing.row, _document(thing)
    assert isinstance(row, PythonTheorem)
    yield "it says", row.sentence
    yield "about", f"the reference implementation in refimpl/{document.name}/"
    yield "clauses", ", ".join((*row.clauses, *row.findings))
    yield "properties", ", ".join(row.properties)
    yield "response times", ", ".join(row.responses)
    yield "shown", verdict(root, document.name, row.name)
    yield "judge it", f"modeproof prove --document {document.name} {row.name}"


def _target(root: Path, thing: Thing) -> Lines:
    device, document = thing.row, _document(thing)
    assert isinstance(device, Device)
    yield "what it is", f"{device.title}. Document: {document.about.title}."
    yield "in TLA+", f"{device.module} ({_defined(root, document, device.module, '')})"
    yield "in Python", f"refimpl/{document.name}/{device.id}.py"
    for label, group in (("inputs", device.inputs), ("outputs", device.outputs)):
        yield label, ", ".join(group)
    yield "parameters", ", ".join(device.parameters)
    yield "states", ", ".join(device.states)
    yield "read", f"docs/{document.name}.md, docs/{document.name}-findings.md"
    if device.published:
        yield "vectors", f"vectors/{device.id}/"
        yield "judge yours", f"modeproof prove-program FILE --target {device.id}"
        yield "", f"modeproof conform {device.id} --adapter CMD"


def _document_card(root: Path, thing: Thing) -> Lines:
    document = _document(thing)
    about = document.about
    yield "title", about.title
    yield "edition", f"{about.edition}; publisher: {about.publisher}"
    yield "not available", "; ".join(about.not_available)
    yield "targets", ", ".join(d.id for d in document.interface.devices.values() if d.published)
    rows = ("clauses", "findings", "properties", "assumptions", "runs")
    counts = ", ".join(f"{len(getattr(document, name))} {name}" for name in rows)
    yield "registers", f"{counts} in spec/{document.name}/"
    yield "read", f"docs/{document.name}.md, docs/{document.name}-findings.md"
    yield "note", about.not_endorsed


def _signal(root: Path, thing: Thing) -> Lines:
    signal = thing.row
    assert isinstance(signal, Signal)
    yield "what it is", signal.why
    bounds = [f"from {signal.minimum}" * (signal.minimum is not None)]
    bounds += [f"to {signal.maximum}" * (signal.maximum is not None), *signal.values]
    yield "type", " ".join(text for text in (signal.type, *bounds) if text)
    yield "default", "" if signal.default is None else str(signal.default)
    yield "cautious", "" if signal.cautious is None else str(signal.cautious)
    yield "why so", signal.because
    yield "ours", "the paper does not print it; it is compared only with --codes" if signal.project else ""
    yield "clauses", ", ".join(signal.clauses)


def _state(root: Path, thing: Thing) -> Lines:
    device, document = thing.of, _document(thing)
    assert device is not None
    yield "what it is", f"a state of {device.id}: {device.title}"
    yield "code", device.codes.get(thing.id, "")
    yield "in TLA+", f"{device.module} ({_defined(root, document, device.module, '')})"
    yield "see also", f"modeproof explain {device.id}"


def _step(root: Path, thing: Thing) -> Lines:
    device, document = thing.of, _document(thing)
    assert device is not None
    path = root / "spec" / document.name / f"{device.module}.tla"
    module = scan(read_text(root, path), device.module, shown(root, path))
    yield "what it is", f"a step of {device.id}: {device.title}"
    yield "in TLA+", f"{module.name}!{thing.id} ({_defined(root, document, device.module, thing.id)})"
    name = f"{module.name}!{thing.id}"
    cited = citations(document, Sources({module.name: module}, (), ()))
    own = next((one for one in cited if one.kind == "definition" and one.name == name), None)
    yield "clauses", ", ".join((*own.clauses, *own.findings)) if own else ""
    yield from _vectors(root, (f"{device.id}/tour:{thing.id}",) if device.published else ())


def _code(root: Path, thing: Thing) -> Lines:
    device = thing.of
    assert device is not None
    yield "what it is", f"what {device.id} shows in the state {thing.row}: {device.title}"
    yield "see also", f"modeproof explain {thing.row}; modeproof explain {device.id}"


def _reading(root: Path, thing: Thing) -> Lines:
    document = _document(thing)
    yield "what it is", f"another reading of the paper, tried for {thing.row.id}: {thing.row.title}"
    for run in document.runs:
        if thing.id in run.readings and not run.of:
            text = f"{run.id} (must give {run.expect}): {verdict(root, document.name, run.id)}"
            yield "tried in", text
    yield "see also", f"modeproof explain {thing.row.id}"


def _verdict(root: Path, thing: Thing) -> Lines:
    yield "it means", f"{thing.row[0].upper()}{thing.row[1:]}."


def _term(root: Path, thing: Thing) -> Lines:
    yield "it means", thing.row["says"]
    yield "clauses", ", ".join(thing.row.get("clauses", ()))


_CARDS: dict[str, Callable[[Path, Thing], Lines]] = {
    "clause": _clause,
    "finding": _finding,
    "property": _property,
    "property of the machine": _machine_property,
    "assumption": _assumption,
    "fault from outside": _fault,
    "response time": _response,
    "chain of response times": _chain,
    "run": _run,
    "theorem": _theorem,
    "target": _target,
    "device": _target,
    "document": _document_card,
    **dict.fromkeys(("input", "output", "parameter", "memory"), _signal),
    "state": _state,
    "step": _step,
    "diagnostic code": _code,
    "reading": _reading,
    "verdict": _verdict,
    "word of the field": _term,
}


def _document(thing: Thing) -> Document:
    assert thing.document is not None
    return thing.document


def _checks(run: Run) -> tuple[str, ...]:
    return (*run.properties, run.property)


def _judged(root: Path, document: Document, prop: Property) -> str:
    asking = [
        run.id for run in document.runs if prop.tla in _checks(run) and run.kind != "NEG" and not run.of
    ]
    said = tally(root, document.name, asking)
    return f"({len(asking)} {'runs' if len(asking) != 1 else 'run'}; {said})" if said else "(no run asks it)"


def _theorems(root: Path, document: Document, names: Iterable[str]) -> Lines:
    listed = list(names)
    for name in listed[:MANY]:
        yield "theorem", f"{name}: {verdict(root, document.name, name)}"
    if len(listed) > MANY:
        yield "", f"and {len(listed) - MANY} more theorems"


def _theorems_of(root: Path, document: Document, id: str) -> Iterator[PythonTheorem]:
    """The theorems of the modules that name an id."""
    for path, text in lines_with(root, (f"proofs/{document.name}",), id, ".py"):
        yield from scan_python(text, path.stem, shown(root, path)).theorems


def _cited(root: Path, document: Document, id: str) -> tuple[list[Citation], dict[str, int]]:
    """Who cites an id, and the lines of what cites it; only files that have the id are read."""
    name = document.name
    modules = {
        module.name: module
        for path, text in lines_with(root, (f"spec/{name}", "spec/common"), id, ".tla")
        for module in (scan(text, path.stem, shown(root, path)),)
    }
    code = [
        tuple(
            scan_python(text, path.stem, shown(root, path))
            for path, text in lines_with(root, (f"{room}/{name}",), id, ".py")
        )
        for room in ("refimpl", "proofs")
    ]
    cited = citations(document, Sources(modules, code[0], code[1]))
    where = {f"{m.name}!{d.name}": d.line for m in modules.values() for d in m.definitions}
    where |= {f"{m.name}.{d.name}": d.line for m in code[0] for d in m.definitions}
    return [one for one in cited if id in (*one.clauses, *one.findings)], where


def _places(cited: Iterable[Citation], where: dict[str, int]) -> Lines:
    """The definitions that carry it out, in TLA+ and in Python."""
    for label, room in (("in TLA+", "spec"), ("in Python", "refimpl")):
        found = [one for one in cited if one.kind == "definition" and one.room == room]
        for one in found[:MANY]:
            yield label, f"{one.name} ({one.file}:{where.get(one.name, 0)})"
        if len(found) > MANY:
            yield "", f"and {len(found) - MANY} more places"


def _vectors(root: Path, tours: Iterable[str]) -> Lines:
    """The published vectors whose cases take these steps."""
    steps: dict[str, list[str]] = {}
    for tour in tours:
        target, _, step = tour.partition("/tour:")
        steps.setdefault(target, []).append(step)
    for target, names in steps.items():
        if (root / "vectors" / target).is_dir():
            yield "vectors", f"vectors/{target}/: cases that take {', '.join(names)}"


def _defined(root: Path, document: Document, module: str, name: str) -> str:
    """File and line of an operator: in its module, else in another of the document or the common ones."""
    folders = [root / "spec" / document.name, root / "spec" / "common"]
    paths = [folders[0] / f"{module}.tla", *(path for f in folders for path in sorted(f.glob("*.tla")))]
    for path in paths:
        if path.is_file():
            if not name:
                return shown(root, path)
            definitions = {d.name: d.line for d in scan(read_text(root, path), path.stem, "").definitions}
            if name in definitions:
                return f"{shown(root, path)}:{definitions[name]}"
    return "its module is not there"


def _how(document: Document, id: str) -> str:
    run = next((run for run in document.runs if run.id == id), None)
    if run is None:
        return ""
    tries = f", reading {', '.join(run.readings)}" if run.readings else ""
    fails = f", {run.property} must fail" if run.kind == "NEG" else ""
    return f"must give {run.expect}{tries}{fails}: "


def _short(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= 60 else f"{line[:57]}..."
