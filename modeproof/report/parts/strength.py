"""Strength: planted faults by judge and operator, who kills nothing alone, what survives and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from modeproof.registers.rows import Document
from modeproof.report.campaigns import KINDS, WORDS, Campaign, campaign, id_of
from modeproof.report.part import Part
from modeproof.report.sources import NOTE, Figure, Sources, Trouble

ID = "strength"
LONG = 90
"""Of an edit so many characters are shown; the evidence has it whole."""


def part(sources: Sources) -> Part:
    """One entry a document, and in it one a campaign.

    `make exhaustive` runs campaigns. One that this text has not seen is a hole and changes no status.
    """
    troubles: list[Trouble] = []
    found = [_document(sources, document, troubles) for document in sources.documents.values()]
    return Part(ID, "Strength: planted faults", {"words": WORDS, "documents": found}, tuple(troubles))


def _document(sources: Sources, document: Document, troubles: list[Trouble]) -> dict[str, Any]:
    campaigns: list[dict[str, Any]] = []
    for kind, (edited, judges, command) in KINDS.items():
        found = campaign(sources, document.name, kind)
        about = {
            "kind": kind,
            "edited": edited,
            "judged_by": judges,
            "command": command.format(document.name),
        }
        if found is None:
            what = f"{document.name}: no campaign over this text: faults in {edited}, judged by {judges}"
            troubles.append(Trouble(NOTE, ID, what, command.format(document.name)))
            campaigns.append({**about, "recorded": None})
        else:
            campaigns.append({**about, "recorded": _campaign(document, found)})
    return {"id": document.name, "title": document.about.title, "campaigns": campaigns}


def _campaign(document: Document, campaign: Campaign) -> dict[str, Any]:
    source = campaign.evidence.path
    record = campaign.evidence.record
    counts = campaign.counts().get("", Counter())
    operators, cells = campaign.matrix()
    negatives = Counter(run.property for run in document.runs if run.kind == "NEG")
    names = list(dict.fromkeys([*campaign.judges, *sorted(campaign.killed)]))
    return {
        "evidence": source,
        "id": id_of(campaign.kind),
        "verdict": campaign.evidence.figure("verdict"),
        "good": True if record["as_expected"] else _bad(record["verdict"]),
        "why": record["reason"],
        "every": campaign.evidence.figure("result", "every"),
        "out_of_scope": campaign.evidence.figure("result", "out_of_scope"),
        "different": Figure(sum(counts[word] for word in ("KILLED", "SURVIVED", "UNMEASURED")), source),
        "counts": {word: Figure(counts[word], source) for word in WORDS},
        "modules": _by(campaign, "module"),
        "by_operator": _by(campaign, "operator"),
        "operators": list(operators),
        "judges": [
            {
                "id": name,
                "stated": _stated(document, campaign.kind, name),
                "asked": Figure(campaign.judges.get(name, 0), source),
                "killed": Figure(campaign.killed[name], source),
                "first": Figure(campaign.first[name], source),
                "alone": Figure(campaign.alone[name], source),
                "negatives": Figure(negatives[name], document.source("runs"))
                if campaign.kind == "spec"
                else None,
                "cells": [cells.get(name, Counter())[operator] for operator in operators],
            }
            for name in names
        ],
        "nothing": [name for name in names if campaign.judges.get(name) and not campaign.killed[name]],
        "never_alone": [name for name in names if campaign.killed[name] and not campaign.alone[name]],
        "survivors": _survivors(campaign),
        "unexplained": [
            _edit(each) for each in campaign.mutants if each["verdict"] == "SURVIVED" and not each.get("why")
        ],
        "unmeasured": [_edit(each) for each in campaign.mutants if each["verdict"] == "UNMEASURED"],
    }


def _bad(verdict: str) -> bool | None:
    return None if verdict in ("UNMEASURED", "UNJUDGED", "INCONCLUSIVE") else False


def _by(campaign: Campaign, field: str) -> list[dict[str, Any]]:
    return [
        {"id": name, **{word: Figure(counts[word], campaign.evidence.path) for word in WORDS}}
        for name, counts in campaign.counts(field).items()
    ]


def _stated(document: Document, kind: str, name: str) -> str | None:
    """The property of the register by this name in the specification; None where it is none."""
    if kind != "spec":
        return None
    return next((prop.id for prop in document.properties if prop.tla == name), None)


def _survivors(campaign: Campaign) -> list[dict[str, Any]]:
    """The survivors that are explained, by explanation."""
    groups: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for each in campaign.mutants:
        if each["verdict"] == "SURVIVED" and each.get("why"):
            groups.setdefault((each["kind"], each["why"]), []).append(each)
    return [
        {"kind": kind, "why": why, "mutants": [_edit(each) for each in ones]}
        for (kind, why), ones in sorted(groups.items())
    ]


def _edit(each: Mapping[str, Any]) -> dict[str, Any]:
    old, new = (
        text if len(text) <= LONG else text[: LONG - 3] + "..." for text in (each["old"], each["new"])
    )
    return {
        "id": each["id"],
        "place": f"{each['module']}, {each['definition']}, line {each['line']}",
        "operator": each["operator"],
        "old": old,
        "new": new,
        "reason": each.get("reason", ""),
    }
