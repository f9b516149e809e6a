"""The order of the EKS's steps, what it rejects and latches and for what cause, and what it forgets.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in EksPrompt: for any
key in the reader, any settings, any time, and either answer of the checksum.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned, control
from proofs.mode_selection.eks_safety import JUDGE, SEEN, read_is, same_key
from proofs.mode_selection.invariants import REMEMBERING, WORKING, key_accepted, no_key
from proofs.mode_selection.vocabulary import none_set, vector
from proofs.sentences import Obligation
from proofs.theorem import Queries, theorem

IN_ORDER: Final = frozenset(
    {
        *pairwise(("Empty", "Read", "CheckChecksum", "CheckLevel", "SetLA", "StartTest", "TestOnes")),
        *pairwise(("TestOnes", "TestZeros", "Signal", "ClearOutputs", "CheckRegisters", "Empty")),
        *((step, "Rejected") for step in ("CheckChecksum", "CheckLevel")),
        ("CheckRegisters", "Fault"),
        *((step, step) for step in ("Empty", "TestOnes", "TestZeros", "Signal", "Rejected", "Fault")),
    }
)
"""One step after another, and waiting."""
REMOVALS: Final = frozenset({(step, "CheckRegisters") for step in WORKING - {"Signal"}})


def _pair(scan: Scanned) -> tuple[str, str]:
    return control(scan.device, scan.before), control(scan.device, scan.after)


def reader_steps_in_order(scan: Scanned) -> Obligation:
    return TRUE, TRUE if _pair(scan) in IN_ORDER | REMOVALS else FALSE


@theorem(
    clauses=[
        "EKS-2-1",
        "EKS-2-2",
        "EKS-2-3",
        "EKS-2-4",
        "EKS-2-5",
        "EKS-2-7",
        "EKS-2-10",
        "EKS-8-1",
        "EKS-8-4",
        "EKS-8-5",
    ],
    findings=[],
    properties=["ReaderStepsInOrder"],
)
def the_eks_leaves_no_step_out() -> Queries:
    """Every scan goes on to the next step of the EKS or waits; only the removal is reached from the side."""
    yield from JUDGE.in_every_scan(reader_steps_in_order)

    def never_aside(scan: Scanned) -> Obligation:
        return TRUE, TRUE if _pair(scan) in IN_ORDER else FALSE

    yield JUDGE.too_strong("nor that", never_aside, "TestOnes")


def la_before_outputs(scan: Scanned) -> Obligation:
    begins = z3.And(none_set(vector(scan.sent)), z3.Not(none_set(vector(scan.sends))))
    if scan.was("StartTest", "TestZeros"):
        return begins, scan.sent.LA
    return TRUE, z3.Implies(begins, scan.sent.LA)


@theorem(clauses=["EKS-2-5", "EKS-2-10"], findings=["E-40"], properties=["LABeforeOutputs"])
def the_eks_sets_la_a_scan_before_its_outputs() -> Queries:
    """A scan that sets an output where none was set begins with LA on."""
    yield from JUDGE.in_every_scan(la_before_outputs)

    def never(scan: Scanned) -> Obligation:
        begins = z3.And(none_set(vector(scan.sent)), z3.Not(none_set(vector(scan.sends))))
        return TRUE, z3.Not(begins)

    yield JUDGE.too_strong("and sets none at all", never, "TestZeros")


def right_keys_pass(scan: Scanned) -> Obligation:
    if scan.was("Rejected") or not scan.becomes("Rejected"):
        return None
    return TRUE, z3.Not(z3.And(SEEN.agrees, key_accepted(scan.params, scan.before.key)))


@theorem(
    clauses=["EKS-2-3", "EKS-2-4", "EKS-KS-1", "EKS-KS-2", "EKS-KS-3", "EKS-KS-4"],
    findings=[],
    properties=["RightKeysPass"],
)
def the_eks_rejects_no_right_key() -> Queries:
    """A scan that rejects a key has found its checksum, operating state, access code or level wrong."""
    yield from JUDGE.in_every_scan(right_keys_pass)

    def by_the_checksum(scan: Scanned) -> Obligation:
        return None if right_keys_pass(scan) is None else (TRUE, z3.Not(SEEN.agrees))

    yield JUDGE.too_strong("always the checksum", by_the_checksum, "CheckLevel")


def fault_needs_cause(scan: Scanned) -> Obligation:
    if scan.was("Fault") or not scan.becomes("Fault"):
        return None
    return TRUE, z3.Not(scan.inputs.registers_zero) if scan.was("CheckRegisters") else FALSE


@theorem(clauses=["EKS-8-4"], findings=["E-22", "E-26"], properties=["FaultNeedsCause"])
def the_eks_latches_a_fault_only_over_registers_that_are_not_zero() -> Queries:
    """A scan that leads to Fault is the register check after a removal, and finds the registers not zero."""
    yield from JUDGE.in_every_scan(fault_needs_cause)

    def without_a_key(scan: Scanned) -> Obligation:
        return None if fault_needs_cause(scan) is None else (TRUE, z3.Not(scan.inputs.inserted))

    yield JUDGE.too_strong("and no key", without_a_key, "CheckRegisters")


def key_is_forgotten(scan: Scanned, seen: Any) -> z3.BoolRef:
    c, key = control(scan.device, scan.after), scan.after.key
    timeless = TRUE if c in ("TestOnes", "TestZeros") else scan.after.elapsed_ms == 0
    if c in WORKING:
        return z3.And(timeless, read_is(scan, key))
    return timeless if c in REMEMBERING else z3.And(timeless, no_key(key))


@theorem(clauses=["EKS-8-1", "EKS-8-5"], findings=[], properties=["KeyIsForgotten"])
def the_eks_remembers_a_key_only_while_it_is_in() -> Queries:
    """At power-up and after every scan the key in memory is the one in the reader, or there is none, but for
    the scan in which the outputs are still to be cleared; and no time is kept outside the test pulse.
    """
    yield from JUDGE.after_every_scan(key_is_forgotten)
    sentence = JUDGE.after_a_scan(key_is_forgotten)
    yield JUDGE.without(sentence, "Empty", "KeyIsForgotten")
    yield JUDGE.without(sentence, "Signal", "PulseAloneTakesTime")


def reader_answers_at_once(scan: Scanned) -> Obligation:
    before, after = _pair(scan)
    if before != after:
        return None
    same = z3.And(same_key(scan.before.key, scan.after.key), scan.before.elapsed_ms == scan.after.elapsed_ms)
    own = read_is(scan, scan.before.key)
    absent = {
        "Empty": z3.Not(scan.inputs.inserted),
        "Signal": own,
        "Rejected": own,
        "TestOnes": z3.And(own, scan.inputs.dt_ms == 0),
        "TestZeros": z3.And(own, scan.inputs.dt_ms == 0),
        "Fault": TRUE,
    }
    return same, absent.get(before, FALSE)


@theorem(
    clauses=["EKS-GP-3", "EKS-2-1", "EKS-4-2", "EKS-4-3", "EKS-8-1"],
    findings=[],
    properties=["ReaderAnswersAtOnce"],
)
def the_eks_waits_only_for_what_is_not_there() -> Queries:
    """A scan that changes nothing has seen nothing that the EKS waits for: no key, no removal, and, in the
    test pulse, no time.
    """
    yield from JUDGE.in_every_scan(reader_answers_at_once)

    def never(scan: Scanned) -> Obligation:
        return None if reader_answers_at_once(scan) is None else (TRUE, FALSE)

    yield JUDGE.too_strong("and there is always something", never, "Rejected")
