"""What the PLC promises whatever words it reads. It needs no invariant: each scan is judged from any memory.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in PlcOpen.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
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


def still_same(scan: Scanned) -> z3.BoolRef:
    """ReadAuthorization is MW01. EKS-3-1-PLC, EKS-9-1-PLC"""
    same: z3.BoolRef = scan.before.ReadAuthorization == scan.inputs.MW01
    return same


def due(scan: Scanned) -> str:
    """The copy whose turn it was."""
    return next(name for name in ORDER if scan.was(name))


def makes(scan: Scanned, copy: str) -> z3.BoolRef:
    """The scan makes this copy and no other, and passes the turn on."""
    if not scan.becomes(ORDER[(ORDER.index(copy) + 1) % len(ORDER)]):
        return FALSE
    word = copy.removeprefix("Copy")
    others = [getattr(scan.after, to) == getattr(scan.before, to) for to in SOURCE if to != word]
    return z3.And(_copied(scan, word), *others)


def copies_take_turns(scan: Scanned) -> Obligation:
    return TRUE, z3.Or(makes(scan, due(scan)), makes(scan, ORDER[0]))


@theorem(
    clauses=["EKS-2-13", "EKS-2-16", "EKS-2-21", "EKS-2-26", "EKS-3-4-PLC", "EKS-9-4-PLC"],
    findings=["E-08"],
    properties=["CopiesTakeTurns"],
)
def the_plc_leaves_no_copy_out() -> Queries:
    """Every scan makes the copy that is due or begins anew with that of MW01, leaves the other words as they
    are, and passes the turn on in the order of the note.
    """
    yield from JUDGE.in_every_scan(copies_take_turns)

    def keeps_the_turn(scan: Scanned) -> Obligation:
        return TRUE, TRUE if scan.becomes("CopyMW07") else FALSE

    yield JUDGE.too_strong("the turn stays", keeps_the_turn, "CopyMW07")


def level_goes_first(scan: Scanned) -> Obligation:
    return TRUE, z3.If(still_same(scan), makes(scan, due(scan)), makes(scan, ORDER[0]))


@theorem(
    clauses=["EKS-GP-4", "EKS-3-1-PLC", "EKS-3-4-PLC", "EKS-9-1-PLC", "EKS-9-4-PLC"],
    findings=["E-08"],
    properties=["LevelGoesFirst"],
)
def the_plc_copies_a_new_level_before_anything_else() -> Queries:
    """A scan that finds ReadAuthorization and MW01 different copies MW01; any other makes the copy due."""
    yield from JUDGE.in_every_scan(level_goes_first)

    def only_copies(scan: Scanned) -> Obligation:
        return TRUE, makes(scan, due(scan))

    yield JUDGE.too_strong("the turn is kept to", only_copies, "CopyCheckMSO")


def scans_to(copy: str, control: str, same: z3.BoolRef) -> z3.ArithRef:
    """The scans up to and with this copy, from a turn, while MW01 stays as it is: 1 to 4."""
    at = ORDER.index(copy)
    in_turn = (at - ORDER.index(control)) % len(ORDER) + 1
    return z3.If(same, z3.IntVal(in_turn), z3.IntVal(at + 1))


def every_copy_comes_closer(scan: Scanned) -> Obligation:
    """Of each copy: this scan makes it, or one scan less is left where the next finds the same MW01."""
    same = scan.after.ReadAuthorization == scan.inputs.MW01
    found = []
    for copy in ORDER:
        left = scans_to(copy, due(scan), still_same(scan))
        goes_on = scans_to(copy, control(PLC, scan.after), same) == left - 1
        found += [left >= 1, left <= len(ORDER), z3.If(left == 1, makes(scan, copy), goes_on)]
    return TRUE, z3.And(*found)


@theorem(clauses=["EKS-2-13", "EKS-2-16", "EKS-2-21", "EKS-2-26", "EKS-GP-4"], findings=["E-08"])
def while_mw01_stays_every_copy_is_made_within_four_scans() -> Queries:
    """From any memory: a new level is copied in the first scan that sees it, and while MW01 stays as it is,
    each of the four words is copied within four scans. A MW01 that changed in every scan would hold up the
    others.
    """
    yield from JUDGE.in_every_scan(every_copy_comes_closer)

    def whatever_mw01_does(scan: Scanned) -> Obligation:
        left = scans_to("CopyMW07", due(scan), TRUE)
        return TRUE, z3.Or(left == 1, scans_to("CopyMW07", control(PLC, scan.after), TRUE) == left - 1)

    yield JUDGE.too_strong("also while MW01 changes", whatever_mw01_does, "CopyCheckMSO")
