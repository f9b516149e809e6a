"""What the PLC promises whatever words it reads. It needs no invariant: each scan is judged from any memory.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in PlcOpen.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.mode_selection.devices import PLC
from proofs.sentences import Judge, Obligation
from proofs.theorem import Queries, theorem

JUDGE: Final = Judge(PLC, ())
SOURCE: Final = MappingProxyType(
    {"ReadAuthorization": "MW01", "MW03": "SelectMSO", "CheckMSO": "MW05", "MW07": "SwitchMSO"}
)
"""Which word each copy is taken from. EKS-2-13, EKS-2-16, EKS-2-21, EKS-2-26"""
ORDER: Final = ("CopyReadAuthorization", "CopyMW03", "CopyCheckMSO", "CopyMW07")


def copies_unchanged(scan: Scanned) -> Obligation:
    words = [
        z3.And(
            z3.Or(getattr(scan.after, to) == getattr(scan.before, to), _copied(scan, to)),
            getattr(scan.sends, to) == getattr(scan.after, to),
        )
        for to in SOURCE
    ]
    return TRUE, z3.And(*words)


def _copied(scan: Scanned, to: str) -> z3.BoolRef:
    copied: z3.BoolRef = getattr(scan.after, to) == getattr(scan.inputs, SOURCE[to])
    return copied


@theorem(
    clauses=["EKS-2-13", "EKS-2-16", "EKS-2-21", "EKS-2-26"],
    findings=["E-08"],
    properties=["CopiesUnchanged"],
)
def the_plc_sends_each_word_unchanged() -> Queries:
    """After every scan each word that the PLC sends is what it was, or what its source shows in this scan."""
    yield from JUDGE.in_every_scan(copies_unchanged)

    def nothing_new(scan: Scanned) -> Obligation:
        return TRUE, scan.after.MW03 == scan.before.MW03

    yield JUDGE.too_strong("no word ever changes", nothing_new, "CopyMW03")


def copies_take_turns(scan: Scanned) -> Obligation:
    due = next(name for name in ORDER if scan.was(name))
    if not scan.becomes(ORDER[(ORDER.index(due) + 1) % len(ORDER)]):
        return TRUE, FALSE
    word = due.removeprefix("Copy")
    others = [getattr(scan.after, to) == getattr(scan.before, to) for to in SOURCE if to != word]
    return TRUE, z3.And(_copied(scan, word), *others)


@theorem(
    clauses=["EKS-2-13", "EKS-2-16", "EKS-2-21", "EKS-2-26"],
    findings=["E-08"],
    properties=["CopiesTakeTurns"],
)
def the_plc_leaves_no_copy_out() -> Queries:
    """Every scan makes the copy that is due, leaves the other words as they are, and passes the turn on in
    the order of the note.
    """
    yield from JUDGE.in_every_scan(copies_take_turns)

    def keeps_the_turn(scan: Scanned) -> Obligation:
        return TRUE, TRUE if scan.becomes("CopyMW07") else FALSE

    yield JUDGE.too_strong("the turn stays", keeps_the_turn, "CopyMW07")
