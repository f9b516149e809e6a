"""Properties: what must hold, who suffers if it does not, the formal text, and what the evidence says."""

from __future__ import annotations

import textwrap
from typing import Any

from modeproof.ground.errors import Unjudged
from modeproof.registers.killers import Falls, Killers, load_killers, stamps_of, ways_to_fall
from modeproof.registers.pins import load_pins
from modeproof.registers.profiles import strength_of
from modeproof.registers.rows import Document, Property
from modeproof.registers.runs import Run
from modeproof.registers.stale import renew_command
from modeproof.registers.tla import closure
from modeproof.report.campaigns import KINDS, Campaign, campaign
from modeproof.report.claims import Claim, Result, claims, result_of, steps_of, texts_of, theorem_rows
from modeproof.report.part import Part
from modeproof.report.sources import DIFFERS, HOLE, Figure, Sources, Trouble

ID = "properties"
SHOWN = 12
"""So many mutants that a property kills are named; all are in the JSON of their campaign."""


def part(sources: Sources) -> Part:
    """One entry a document, and in it one a property."""
    troubles: list[Trouble] = []
    found = [_document(sources, document, troubles) for document in sources.documents.values()]
    return Part(ID, "Properties", {"documents": found}, tuple(troubles))


def _document(sources: Sources, document: Document, troubles: list[Trouble]) -> dict[str, Any]:
    every = claims(sources, document)
    sources.content(document.source("killers"))  # one of the files that the report rests on
    killing = campaign(sources, document.name, "spec")
    properties = [
        _property(sources, document, prop, [c for c in every if c.of is prop], killing, troubles)
        for prop in document.properties
    ]
    return {
        "id": document.name,
        "title": document.about.title,
        "strength_command": KINDS["spec"][2].format(document.name),
        "properties": properties,
        "runs": [_run(sources, document, run) for run in document.runs],
    }


def _run(sources: Sources, document: Document, run: Run) -> dict[str, Any]:
    """A row of the table of all runs of the model checker."""
    one = result_of(sources, document, run)
    record = None if one.evidence is None else one.evidence
    return {
        **one.data,
        "kind": run.kind,
        "environment": run.environment,
        "strength": strength_of(document.root, run),
        "violates": run.property,
        "expected": "" if record is None else record.record["expected"],
        "traced": record is not None and bool(record.result.get("trace")),
        "command": f"modeproof check {document.name}/{run.id}",
        **{
            key: None if record is None else record.figure("result", key)
            for key in ("distinct", "generated", "depth")
        },
        "steps": steps_of(one),
        "seconds": None if record is None else record.figure("seconds", unit="s"),
    }


def _property(
    sources: Sources,
    document: Document,
    prop: Property,
    own: list[Claim],
    killing: Campaign | None,
    troubles: list[Trouble],
) -> dict[str, Any]:
    name = f"{document.name}: {prop.id}"
    for what, text in (
        ("sentence", prop.sentence),
        ("hazard", prop.hazard),
        ("clause", "".join(prop.clauses)),
    ):
        if not text.strip():
            troubles.append(Trouble(HOLE, ID, f"{name} has no {what}", "modeproof registers"))
    witness = _witness(sources, document, prop)
    if witness["status"] == DIFFERS:
        troubles.append(Trouble(witness["status"], ID, f"{name}: {witness['why']}", witness["command"]))
    formal = _formal(sources, document, prop)
    if formal is None:
        what = f"{name}: its definition {prop.tla} is not found in module {prop.module}"
        troubles.append(Trouble(HOLE, ID, what, "modeproof registers"))
    return {
        "id": prop.id,
        "title": prop.title,
        "kind": prop.kind,
        "sentence": prop.sentence,
        "hazard": prop.hazard,
        "clauses": list(prop.clauses),
        "findings": list(prop.findings),
        "register": document.source("properties"),
        "formal": formal,
        "environments": [_environment(claim) for claim in own],
        "theorems": _theorems(sources, document, own),
        "witness": witness,
        "falls": _falls(sources, document, prop, troubles),
        "kills": _kills(killing, prop),
    }


def _environment(claim: Claim) -> dict[str, Any]:
    shown = claim.shown
    evidence = shown.evidence if shown is not None else None
    return {
        "environment": claim.environment,
        "word": claim.word,
        "good": claim.good,
        "verdict": None if shown is None else shown.verdict,
        "why": "no run is declared" if shown is None else shown.why,
        "strength": evidence.record["strength"] if evidence is not None else "",
        "engines": list(claim.engines),
        "disagreement": claim.disagreement,
        "run": None if shown is None else shown.id,
        "other_runs": [run.data for run in claim.runs if run is not shown],
        "theorems": [theorem.data for theorem in claim.theorems],
        "because": claim.because,
        "distinct": None if evidence is None else evidence.figure("result", "distinct"),
        "generated": None if evidence is None else evidence.figure("result", "generated"),
        "seconds": None if evidence is None else evidence.figure("seconds", unit="s"),
    }


def _formal(sources: Sources, document: Document, prop: Property) -> dict[str, Any] | None:
    modules = texts_of(sources, document).modules
    for module in closure(modules, prop.module):
        for definition in module.definitions:
            if definition.name == prop.tla:
                lines = [line.rstrip() for line in definition.body.splitlines()]
                text = textwrap.dedent("\n".join(line for line in lines if line))
                return {"file": module.file, "line": definition.line, "text": text}
    return None


def _theorems(sources: Sources, document: Document, own: list[Claim]) -> list[dict[str, Any]]:
    """The sentences of the theorems that prove it, each once."""
    names = {each.id: each for claim in own for each in claim.theorems}
    sentences = {one.name: one.sentence for _, one in theorem_rows(sources, document)}
    return [{**one.data, "sentence": sentences.get(name, "")} for name, one in names.items()]


def _witness(sources: Sources, document: Document, prop: Property) -> dict[str, Any]:
    """The situation that the property speaks of, and the run that reached it."""
    declared = [run for run in document.runs if prop.antecedent and prop.antecedent in run.witnesses]
    runs = [Result(run.id, sources.evidence[document.name].get(run.id)) for run in declared]
    reached = [
        each
        for each in runs
        if each.evidence is not None
        and each.status == 0
        and prop.antecedent in each.evidence.result.get("reached", ())
    ]
    answer = {
        "antecedent": prop.antecedent,
        "reason": prop.reason,
        "run": None,
        "verdict": None,
        "status": 0,
        "why": "",
        "command": "",
    }
    if reached:
        evidence = reached[0].evidence
        assert evidence is not None
        return {**answer, "run": reached[0].id, "verdict": Figure("REACHED", evidence.path)}
    if not prop.antecedent:
        return answer
    if not runs:
        why, command = f"no run looks for {prop.antecedent}", "modeproof registers"
        return {**answer, "status": HOLE, "why": why, "command": command}
    first = runs[0]
    command = f"modeproof check {document.name}/{first.id}"
    status = first.status or DIFFERS
    why = f"{first.id} has not reached {prop.antecedent}" + (f": {first.why}" if first.why else "")
    return {**answer, "run": first.id, "status": status, "why": why, "command": command}


def _falls(sources: Sources, document: Document, prop: Property, troubles: list[Trouble]) -> dict[str, Any]:
    """The negatives and the edits that break it, or why nothing breaks it."""
    every, killers, stamps = _killing(sources, document)
    falls, pinned = every[prop.id], load_pins(document).killers
    edits = [
        {
            **{key: getattr(killers.edits[name], key) for key in ("module", "old", "new", "slip")},
            "judged": pinned.get(name) == stamps[name],
        }
        for name in falls.edits
    ]
    if not all(edit["judged"] for edit in edits):
        what = f"{document.name}: an edit of {prop.id} was not judged on this text"
        troubles.append(Trouble(HOLE, ID, what, renew_command(document.name)))
    return {"negatives": list(falls.negatives), "edits": edits, "reason": falls.reason}


def _killing(
    sources: Sources, document: Document
) -> tuple[dict[str, Falls], Killers, dict[str, str | Unjudged]]:
    texts = texts_of(sources, document)

    def read() -> tuple[dict[str, Falls], Killers, dict[str, str | Unjudged]]:
        killers = load_killers(document.root, document.name)
        return ways_to_fall(document, texts), killers, stamps_of(document, texts, killers)

    return sources.once(f"killers {document.name}", read)


def fallen(sources: Sources, document: Document) -> tuple[int, int]:
    """How many properties are broken by a fault that was judged on this text, of those that one can break."""
    every, _, stamps = _killing(sources, document)
    pinned = load_pins(document).killers
    can = [falls for falls in every.values() if falls.kind != "by construction"]
    good = [
        falls
        for falls in can
        if falls.negatives or any(pinned.get(name) == stamps[name] for name in falls.edits)
    ]
    return len(good), len(can)


def _kills(killing: Campaign | None, prop: Property) -> dict[str, Any] | None:
    """What of the recorded campaign it kills; None where there is no campaign."""
    if killing is None:
        return None
    source = killing.evidence.path
    mutants = [mutant["id"] for mutant in killing.mutants if prop.tla in mutant["killers"]]
    return {
        "asked": Figure(killing.judges.get(prop.tla, 0), source),
        "killed": Figure(killing.killed[prop.tla], source),
        "alone": Figure(killing.alone[prop.tla], source),
        "mutants": mutants[:SHOWN],
        "more": max(0, len(mutants) - SHOWN),
    }
