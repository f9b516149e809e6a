"""Bit errors on a code word or on zero: which are detected, and exactly which are not."""

from typing import Final

import z3

from proofs.mode_selection.ranges import FLAG_WORD, accepted, is_accepted, is_code
from proofs.theorem import Queries, claim, control, theorem
from proofs.words import one_of, ones, word

UNDETECTED: Final = {
    0x0F0F: ((0x0000, 0x0F0F), (0x3333, 0x3C3C)),
    0x0FF0: ((0x0000, 0x0FF0), (0x33CC, 0x3C3C)),
    0x3333: ((0x0000, 0x3333), (0x0F0F, 0x3C3C)),
    0x33CC: ((0x0000, 0x33CC), (0x0FF0, 0x3C3C)),
    0x3C3C: ((0x0000, 0x3C3C), (0x0F0F, 0x3333), (0x0FF0, 0x33CC)),
    0x00FF: ((0x0F0F, 0x0FF0), (0x3333, 0x33CC)),
    0x3CC3: ((0x0F0F, 0x33CC), (0x0FF0, 0x3333)),
}
"""Each error pattern (the bits that flip) that can go undetected, with the pairs of words that it turns
into each other.
"""


@theorem(clauses=["EKS-KS-9", "EKS-T2-4", "EKS-SD-15"], findings=["E-49"])
def every_error_of_one_to_seven_bits_is_detected() -> Queries:
    """One to seven flipped bits never turn a code word or zero into another accepted word, in any range.

    All 65536 error patterns are covered. Detected means: what arrives is neither zero nor one of the five
    codes. A word that is lost, late or repeated is no bit error, and no code word sees it.
    """
    sent, error = word("sent"), word("error")
    for name in FLAG_WORD:
        given = {
            f"sent is zero or a code of {name}": one_of(sent, accepted(name)),
            "one to seven bits flip": z3.And(z3.UGE(ones(error), 1), z3.ULE(ones(error), 7)),
        }
        yield from claim(f"{name}: one to seven bits", given, z3.Not(is_accepted(name, sent ^ error)))


@theorem(clauses=["EKS-KS-9", "EKS-SD-15"], findings=["E-49"])
def every_error_of_nine_to_sixteen_bits_is_detected() -> Queries:
    """Nine to sixteen flipped bits never turn a code word or zero into another accepted word, in any range.

    So the code is better than its distance says: only errors of exactly eight bits can go undetected.
    """
    sent, error = word("sent"), word("error")
    for name in FLAG_WORD:
        given = {
            f"sent is zero or a code of {name}": one_of(sent, accepted(name)),
            "nine or more bits flip": z3.UGE(ones(error), 9),
        }
        yield from claim(f"{name}: nine to sixteen bits", given, z3.Not(is_accepted(name, sent ^ error)))


@theorem(clauses=["EKS-KS-9", "EKS-SD-15"], findings=["E-49"])
def the_undetected_errors_are_exactly_seven_patterns_of_eight_bits() -> Queries:
    """Of the 12870 errors of eight bits exactly seven can go undetected: 0F0F, 0FF0, 3333, 33CC, 3C3C, 00FF
    and 3CC3.

    The five code words as patterns turn zero into that word or back; 3C3C also turns 0F0F and 3333, 0FF0 and
    33CC into each other, and so on: the claims list every pair. Pattern 00FF is worth noting: inverting one
    byte is enough.
    """
    sent, error = word("sent"), word("error")
    listed = z3.Or(
        *[
            z3.And(error == pattern, one_of(sent, pair))
            for pattern, pairs in UNDETECTED.items()
            for pair in pairs
        ]
    )
    for name in FLAG_WORD:
        given = {
            f"sent is zero or a code of {name}": one_of(sent, accepted(name)),
            "some bit flips": error != 0,
        }
        yield from claim(
            f"{name}: exactly the listed pairs", given, is_accepted(name, sent ^ error) == listed
        )
    for pattern in UNDETECTED:
        example = {
            "sent is a code of RE": is_code("RE", sent),
            "these bits flip": error == pattern,
            "another code of RE arrives": is_code("RE", sent ^ error),
        }
        yield control(f"{pattern:04X}H turns a code into another", example)
