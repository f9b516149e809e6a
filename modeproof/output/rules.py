"""Clauses and findings of the documents as rules: what a problem is about, in a sentence."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path

from modeproof.ground.places import documents, root
from modeproof.output.outcome import Rule
from modeproof.registers.load import load_clauses, load_findings


def rules_of(ids: Iterable[str], document: str = "") -> list[Rule]:
    """The clauses and findings with these ids, of one document or of any; one that is not known is left out.

    A finding's id is of one document, so it is only found where that is named. Raises Unjudged for a register
    that cannot be read.
    """
    place = root()
    known = _known(place, document if document in _with_clauses(place) else "")
    return [known[id] for id in dict.fromkeys(ids) if id in known]


@cache
def _known(place: Path, document: str) -> dict[str, Rule]:
    found: dict[str, Rule] = {}
    for name in [document] if document else _with_clauses(place):
        about, clauses = load_clauses(place, name)
        for clause in clauses:
            where = ", ".join(part for part in (about.title, _pages(clause.pages)) if part)
            found[clause.id] = Rule(id=clause.id, kind="clause", sentence=clause.text, source=where)
        for finding in load_findings(place, name) if document else ():
            sentence = f"{finding.title.rstrip('.')}. We decided: {finding.decision}"
            found[finding.id] = Rule(id=finding.id, kind="finding", sentence=sentence, source=about.title)
    return found


def _with_clauses(place: Path) -> list[str]:
    return [name for name in documents(place) if (place / "spec" / name / "clauses.toml").is_file()]


def _pages(pages: str) -> str:
    return f"page {pages}" if pages and pages.isdigit() else f"pages {pages}" if pages else ""
