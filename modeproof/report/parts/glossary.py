"""Glossary: the words of the field, as this report uses them."""

from __future__ import annotations

from modeproof.report.part import Part
from modeproof.report.sources import Sources
from modeproof.report.terms import REGISTER, terms_of


def part(sources: Sources) -> Part:
    """One entry a term, in the order of the alphabet."""
    terms, troubles = terms_of(sources)
    rows = [
        {"word": term.word, "says": term.says, "forms": term.forms, "anchor": term.anchor} for term in terms
    ]
    return Part("glossary", "Glossary", {"register": REGISTER, "terms": rows}, troubles)
