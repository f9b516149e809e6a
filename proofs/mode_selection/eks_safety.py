"""What the EKS promises whatever key is in the reader, and when: its invariant and properties.

Each theorem proves the property of properties.toml that it names, written like its TLA+ in Eks and EksOpen.
The maker's checksum is not public. Whether it agrees with the key in memory is one free truth value; it stays
the same as long as the key in memory does, and is free again for another key.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import z3

from proofs.explorer.ends import FALSE, TRUE
from proofs.explorer.scanned import Scanned
from proofs.mode_selection.devices import CHECKSUM_AGREES, EKS
from proofs.mode_selection.invariants import EKS_INVARIANT, key_accepted
from proofs.mode_selection.ranges import codes
from proofs.mode_selection.vocabulary import all_set, none_set, one_set, several_set, vector
from proofs.sentences import Judge, Obligation, Sentence
from proofs.theorem import Queries, theorem
from proofs.words import constant


@dataclass(frozen=True, eq=False)
class Seen:
    """agrees: the checksum is right for the key in memory · lasted: ms for which the outputs of this half of
    the test pulse have stood, by the wires alone.
    """

    agrees: z3.BoolRef
    lasted: z3.ArithRef


ANY_ANSWER: Final = z3.Bool("checksum_agrees_with_the_new_key")
SEEN: Final = Seen(CHECKSUM_AGREES.term, z3.Int("seen.lasted"))
NOTHING: Final = Seen(ANY_ANSWER, z3.IntVal(0))


def same_key(left: Any, other: Any) -> z3.BoolRef:
    """Two records have the same content of key memory; also a record of inputs has one."""
    names = ("operating_state", "authorization_level", "access_code", "KEYCRC", "KeyID")
    return z3.And(*[getattr(left, name) == getattr(other, name) for name in names])


def read_is(scan: Scanned, key: Any) -> z3.BoolRef:
    """The key in the reader is in, and is this one."""
    return z3.And(scan.inputs.inserted, same_key(scan.inputs, key))


def in_half(where: bool, outputs: Any) -> z3.BoolRef:
    """LA is on, and all outputs are set or, in TestZeros (`where`), none after all."""
    return z3.And(outputs.LA, z3.BoolVal(True) if where else all_set(vector(outputs)))


def same_vector(scan: Scanned) -> z3.BoolRef:
    """The scan changes none of the five outputs."""
    pairs = zip(vector(scan.sent), vector(scan.sends), strict=True)
    return z3.And(*[before == after for before, after in pairs])


def goes_on(scan: Scanned) -> z3.BoolRef:
    """A half of the pulse runs before and after the scan, with the same outputs."""
    before, after = in_half(scan.was("TestZeros"), scan.sent), in_half(scan.becomes("TestZeros"), scan.sends)
    return z3.And(before, after, same_vector(scan))


@cache
def sees(scan: Scanned) -> Seen:
    """What is known after a scan."""
    kept = same_key(scan.before.key, scan.after.key)
    return Seen(
        z3.If(kept, CHECKSUM_AGREES.term, ANY_ANSWER),
        z3.If(goes_on(scan), SEEN.lasted + scan.inputs.dt_ms, z3.IntVal(0)),
    )


JUDGE: Final = Judge(EKS, EKS_INVARIANT, SEEN, sees, NOTHING)


@theorem(clauses=["EKS-GP-3", "EKS-2-3", "EKS-2-4", "EKS-KS-7"], findings=["E-41"])
def every_scan_of_the_eks_keeps_its_invariant() -> Queries:
    """The invariant of the EKS is true at power-up, and every scan keeps it, with any key in memory and in
    the reader, any settings, any elapsed time, and any answer of the checksum.
    """
    yield from JUDGE.initiation()
    yield from JUDGE.consecution()


def one_output_outside_the_pulse(scan: Scanned, seen: Any) -> z3.BoolRef:
    return TRUE if scan.becomes("TestOnes") else z3.Not(several_set(vector(scan.sends)))


@theorem(clauses=["EKS-KS-5", "EKS-2-10"], findings=[], properties=["OneOutputOutsideThePulse"])
def the_eks_sets_several_outputs_only_in_its_test_pulse() -> Queries:
    """At power-up and after every scan that does not end in TestOnes at most one output of the EKS is set."""
    yield from JUDGE.after_every_scan(one_output_outside_the_pulse)
    always: Sentence = lambda scan: (TRUE, z3.Not(several_set(vector(scan.sends))))  # noqa: E731
    yield JUDGE.too_strong("nor in the pulse", always, "StartTest")


def no_output_without_la(scan: Scanned, seen: Any) -> z3.BoolRef:
    if scan.becomes("ClearOutputs"):
        return TRUE
    return z3.Implies(z3.Not(scan.sends.LA), none_set(vector(scan.sends)))


@theorem(
    clauses=["EKS-2-3", "EKS-2-9", "EKS-8-5", "EKS-SD-2", "EKS-SD-8"],
    findings=[],
    properties=["NoOutputWithoutLA"],
)
def the_eks_sets_no_output_without_la() -> Queries:
    """At power-up and after every scan after which LA is off no output is set, but for the scan that leads to
    ClearOutputs.
    """
    yield from JUDGE.after_every_scan(no_output_without_la)

    def at_once(scan: Scanned) -> Obligation:
        return z3.Not(scan.sends.LA), none_set(vector(scan.sends))

    yield JUDGE.too_strong("nor in that scan", at_once, "Signal")


def la_only_for_accepted_keys(scan: Scanned, seen: Any) -> z3.BoolRef:
    accepted = z3.Implies(scan.sends.LA, z3.And(seen.agrees, key_accepted(scan.params, scan.after.key)))
    if not scan.becomes("Signal"):
        return accepted
    level = scan.after.key.authorization_level
    by_level = [
        flag == (level == constant(codes("RE")[number])) for number, flag in enumerate(vector(scan.sends))
    ]
    return z3.And(accepted, *by_level)


@theorem(
    clauses=["EKS-2-4", "EKS-2-5", "EKS-KS-7", "EKS-T1"],
    findings=["E-25e", "E-67"],
    properties=["LAOnlyForAcceptedKeys"],
)
def the_eks_sets_la_only_for_an_accepted_key() -> Queries:
    """At power-up and after every scan LA is on only if checksum, operating state, access code and level of
    the key in memory are right; and in Signal the output of its level is set and no other.
    """
    yield from JUDGE.after_every_scan(la_only_for_accepted_keys)
    sentence = JUDGE.after_a_scan(la_only_for_accepted_keys)
    yield JUDGE.without(sentence, "SetLA", "ChecksumWasRight")
    yield JUDGE.without(sentence, "Signal", "KeyWasAccepted")


def la_drops_at_once(scan: Scanned) -> Obligation:
    agrees = sees(scan).agrees
    right = z3.And(key_accepted(scan.params, scan.inputs), agrees, read_is(scan, scan.after.key))
    gone = z3.And(scan.sent.LA, z3.Not(read_is(scan, scan.before.key)))
    leftover = z3.And(z3.Not(scan.sent.LA), z3.Not(none_set(vector(scan.sent))))
    return TRUE, z3.And(
        z3.Implies(scan.sends.LA, right),
        z3.Implies(gone, z3.Not(scan.sends.LA)),
        z3.Implies(leftover, none_set(vector(scan.sends))),
    )


@theorem(clauses=["EKS-8-2", "EKS-SD-2"], findings=["E-41"], properties=["LADropsAtOnce"])
def the_eks_drops_la_in_the_scan_without_its_key() -> Queries:
    """LA is on after a scan only if a right key is in the reader, the one in memory; it is off in the scan in
    which that key is gone or another one is in, and an output without LA goes off one scan later.
    """
    yield from JUDGE.in_every_scan(la_drops_at_once)
    yield JUDGE.without(la_drops_at_once, "SetLA", "KeyWasAccepted")


def pulse_before_output(scan: Scanned) -> Obligation:
    appears = z3.And(one_set(vector(scan.sends)), z3.Not(same_vector(scan)))
    after_zeros = z3.And(none_set(vector(scan.sent)), scan.sent.LA, scan.sends.LA)
    if scan.was("TestZeros"):
        return appears, after_zeros
    begins = all_set(vector(scan.sent)) if scan.becomes("TestZeros") else TRUE
    return TRUE, z3.And(z3.Not(appears), begins)


@theorem(clauses=["EKS-2-10", "EKS-4-1", "EKS-4-3"], findings=["E-10"], properties=["PulseBeforeOutput"])
def the_eks_sets_its_output_only_after_all_and_none() -> Queries:
    """The single output appears only in a scan from TestZeros, with LA on and no output set; and TestZeros is
    entered only from a state in which all outputs are set.
    """
    yield from JUDGE.in_every_scan(pulse_before_output)

    def never(scan: Scanned) -> Obligation:
        return TRUE, z3.Not(z3.And(one_set(vector(scan.sends)), z3.Not(same_vector(scan))))

    yield JUDGE.too_strong("never", never, "TestZeros")


def pulse_halves_last(scan: Scanned) -> Obligation:
    running = in_half(scan.was("TestZeros"), scan.sent)
    given = z3.And(running, read_is(scan, scan.before.key))
    stands = z3.And(same_vector(scan), in_half(scan.becomes("TestZeros"), scan.sends))
    then = stands == (SEEN.lasted + scan.inputs.dt_ms < scan.params.T_PULSE_ms)
    return (given, then) if scan.was("TestOnes", "TestZeros") else (TRUE, z3.Implies(given, then))


@theorem(clauses=["EKS-4-2", "EKS-4-3"], findings=["E-39"], properties=["PulseHalvesLast"])
def each_half_of_the_test_pulse_lasts_as_long_as_it_is_set() -> Queries:
    """While the key is in, a half of the test pulse goes on exactly as long as its outputs have stood for
    less than T_PULSE.
    """
    yield from JUDGE.in_every_scan(pulse_halves_last)
    for start in ("TestOnes", "TestZeros"):
        yield JUDGE.without(pulse_halves_last, start, "TimerIsTheTimeOfThisHalf")


def fault_is_latched(scan: Scanned) -> Obligation:
    stays = TRUE if scan.becomes("Fault") else FALSE
    if scan.was("Fault"):
        return TRUE, stays
    return (z3.Not(scan.inputs.registers_zero), stays) if scan.was("CheckRegisters") else None


@theorem(clauses=["EKS-8-4"], findings=["E-22", "E-26"], properties=["FaultIsLatched"])
def the_eks_keeps_a_fault_of_its_registers() -> Queries:
    """Registers that are not zero after a removal lead to Fault in that scan, and no scan leaves Fault."""
    yield from JUDGE.in_every_scan(fault_is_latched)

    def always(scan: Scanned) -> Obligation:
        return TRUE, TRUE if scan.becomes("Fault") else FALSE

    yield JUDGE.too_strong("whatever the registers are", always, "CheckRegisters")
