"""Words taken apart or put together wrongly: byte order, torn and straddled words, inversion, AND, OR,
XOR, shifts.
"""

from typing import Final

import z3

from proofs.mode_selection.ranges import (
    FLAG_WORD,
    free_mode,
    is_accepted,
    is_code,
    mode_of,
    word_of,
)
from proofs.theorem import Queries, claim, theorem
from proofs.words import high, low, one_of, rotated_left, word
from refimpl.mode_selection import code_tables

SAME_WHEN_SWAPPED: Final = (0x0F0F, 0x3333, 0x3C3C)
STRADDLED: Final = (
    (0x0F0F, 0x0F0F),
    (0x0F0F, 0x0FF0),
    (0x3333, 0x3333),
    (0x3333, 0x33CC),
    (0x3C3C, 0x3C3C),
)
"""The pairs of neighbouring flag words whose adjoining bytes form a code; the code formed is the first of
the pair.
"""
LOW_BYTE_INVERTED: Final = (0x0F0F, 0x0FF0, 0x3333, 0x33CC)
SUMS: Final = ((0x0F0F, 0x3333, 0x3C3C), (0x0FF0, 0x33CC, 0x3C3C))
"""The triples of codes in which the exclusive OR of any two is the third."""


def _any_of(rows: tuple[tuple[int, int], ...], first: z3.BitVecRef, second: z3.BitVecRef) -> z3.BoolRef:
    """The two terms are one of the listed pairs."""
    return z3.Or(*[z3.And(first == word, second == two) for word, two in rows])


@theorem(clauses=["EKS-T2", "EKS-T2-1"], findings=["E-18"])
def a_word_with_its_bytes_swapped_is_either_unchanged_or_no_code() -> Queries:
    """Swapping the bytes leaves 0F0F, 3333 and 3C3C as they are and makes 0FF0 and 33CC no code: never
    another mode.

    So a wrong byte order on one path shows in two modes of five and stays hidden in the other three.
    """
    sent = word("sent")
    swapped = z3.Concat(low(sent), high(sent))
    for name in FLAG_WORD:
        given = {f"sent is a code of {name}": is_code(name, sent)}
        yield from claim(f"{name}: unchanged", given, (swapped == sent) == one_of(sent, SAME_WHEN_SWAPPED))
        yield from claim(
            f"{name}: or refused", given, z3.Or(swapped == sent, z3.Not(is_accepted(name, swapped)))
        )


@theorem(clauses=["EKS-T2", "EKS-KS-9"], findings=[])
def the_complement_of_a_code_word_is_never_a_code_word() -> Queries:
    """The complement of a code word or of zero is neither a code word nor zero, in any range."""
    sent = word("sent")
    for name in FLAG_WORD:
        given = {f"sent is zero or a code of {name}": is_accepted(name, sent)}
        yield from claim(f"{name}: complement", given, z3.Not(is_accepted(name, ~sent)))


@theorem(clauses=["EKS-T2", "EKS-KS-9"], findings=[])
def an_inverted_high_byte_is_always_detected_and_an_inverted_low_byte_only_in_3c3c_and_zero() -> Queries:
    """Inverting the high byte of a code word or zero never gives an accepted word; inverting the low byte
    does for four codes.

    It turns 0F0F and 0FF0, and 3333 and 33CC, into each other: eight bits, just the distance. Only 3C3C and
    zero are protected from it.
    """
    sent = word("sent")
    upper = z3.Concat(~high(sent), low(sent))
    lower = z3.Concat(high(sent), ~low(sent))
    for name in FLAG_WORD:
        given = {f"sent is zero or a code of {name}": is_accepted(name, sent)}
        yield from claim(f"{name}: high byte", given, z3.Not(is_accepted(name, upper)))
        undetected = one_of(sent, LOW_BYTE_INVERTED)
        yield from claim(f"{name}: low byte", given, is_accepted(name, lower) == undetected)


@theorem(clauses=["EKS-T2", "EKS-SD-15", "EKS-KS-8"], findings=[])
def a_torn_word_is_never_a_third_accepted_word() -> Queries:
    """The high byte of one accepted word with the low byte of another is one of the two or is refused, zero
    included.

    So a word that is read while it changes byte by byte shows its old value, its new value or a value that is
    refused.
    """
    old, new = word("old"), word("new")
    torn = z3.Concat(high(old), low(new))
    for name in FLAG_WORD:
        given = {
            f"old is zero or a code of {name}": is_accepted(name, old),
            f"new is zero or a code of {name}": is_accepted(name, new),
            "they are different": old != new,
        }
        harmless = z3.Or(torn == old, torn == new, z3.Not(is_accepted(name, torn)))
        yield from claim(f"{name}: torn", given, harmless)


@theorem(clauses=["EKS-T2", "EKS-T2-1"], findings=["E-18"])
def a_straddled_address_reads_a_code_in_exactly_five_of_the_25_pairs() -> Queries:
    """MW2, MW4 or MW6 reads a code only if its neighbours are 0F0F+0F0F, 0F0F+0FF0, 3333+3333, 3333+33CC or
    3C3C+3C3C.

    What is read is then the word at the lower address. With a zero on either side no code can be read, and
    zero only when both are zero. MW2 is the low byte of MW01 and the high byte of MW03; MW4 and MW6 alike.
    """
    lower, upper = word("lower"), word("upper")
    straddled = z3.Concat(low(lower), high(upper))
    for address, first, second in (("MW2", "RE", "SE"), ("MW4", "SE", "CH"), ("MW6", "CH", "SW")):
        given = {
            f"{FLAG_WORD[first]} is zero or a code": is_accepted(first, lower),
            f"{FLAG_WORD[second]} is zero or a code": is_accepted(second, upper),
        }
        reads_code = is_code(first, straddled)
        listed = _any_of(STRADDLED, lower, upper)
        yield from claim(f"{address}: exactly the five pairs", given, reads_code == listed)
        is_lower = z3.Implies(reads_code, straddled == lower)
        yield from claim(f"{address}: the word at the lower address", given, is_lower)
        both = z3.And(lower == code_tables.ZERO, upper == code_tables.ZERO)
        yield from claim(f"{address}: zero", given, (straddled == code_tables.ZERO) == both)


@theorem(clauses=["EKS-T2-1", "EKS-2-17", "EKS-2-27"], findings=["E-18"])
def a_straddled_address_can_pass_for_a_selection_but_never_for_the_acknowledgment() -> Queries:
    """MW2 read in place of MW03 passes the level check only for (level, selection) = (2, 1), (2, 2) and (4,
    3).

    For (2, 2) it reads mode 1, a mode that was not selected; for the other two the right one by chance. MW6
    read in place of MW07 never reads the acknowledgment of the selection that MW05 echoes, whatever code or
    zero is in MW07.
    """
    level, is_level = free_mode("level")
    selection, is_selection = free_mode("selection")
    permitted = {
        "level is 0 to 4": is_level,
        "selection is 0 to 4": is_selection,
        "it is permitted": z3.ULE(selection, level),
    }
    read = mode_of("SE", z3.Concat(low(word_of("RE", level)), high(word_of("SE", selection))))
    passes = z3.And(read != code_tables.NONE, z3.ULE(read, level))
    listed = z3.Or(*[z3.And(level == a, selection == s) for a, s in ((2, 1), (2, 2), (4, 3))])
    yield from claim("MW2 for MW03: passes", permitted, passes == listed)
    passing = {**permitted, "what is read passes the level check": passes}
    wrong = z3.And(level == 2, selection == 2)
    yield from claim("MW2 for MW03: wrong mode", passing, (read != selection) == wrong)
    acknowledged = word("acknowledged")
    echoed = {
        "selection is 0 to 4": is_selection,
        "MW07 is zero or a code": is_accepted("SW", acknowledged),
    }
    straddled = z3.Concat(low(word_of("CH", selection)), high(acknowledged))
    yield from claim("MW6 for MW07", echoed, straddled != word_of("SW", selection))


@theorem(clauses=["EKS-KS-9", "EKS-SD-15"], findings=["E-18"])
def two_different_code_words_and_ed_or_ored_are_never_accepted() -> Queries:
    """AND and OR of two different code words are neither code words nor zero, in any range.

    So two writers on a wired-AND or wired-OR path are seen, if each writes a different code.
    """
    first, second = word("first"), word("second")
    for name in FLAG_WORD:
        given = {
            f"first is a code of {name}": is_code(name, first),
            f"second is a code of {name}": is_code(name, second),
            "they are different": first != second,
        }
        yield from claim(f"{name}: AND", given, z3.Not(is_accepted(name, first & second)))
        yield from claim(f"{name}: OR", given, z3.Not(is_accepted(name, first | second)))


@theorem(clauses=["EKS-T2", "EKS-KS-9"], findings=["E-18"])
def the_exclusive_or_of_two_code_words_is_a_code_word_in_exactly_two_triples() -> Queries:
    """The exclusive OR of two different codes is a code only within {0F0F, 3333, 3C3C} and {0FF0, 33CC,
    3C3C}: the third one.
    """
    first, second = word("first"), word("second")
    listed = z3.Or(*[z3.And(one_of(first, triple), one_of(second, triple)) for triple in SUMS])
    for name in FLAG_WORD:
        given = {
            f"first is a code of {name}": is_code(name, first),
            f"second is a code of {name}": is_code(name, second),
            "they are different": first != second,
        }
        yield from claim(
            f"{name}: exactly the listed pairs", given, is_accepted(name, first ^ second) == listed
        )


@theorem(clauses=["EKS-T2", "EKS-KS-9"], findings=["E-18"])
def a_shifted_or_rotated_word_is_another_code_only_between_0f0f_and_3c3c() -> Queries:
    """Shifting or rotating a code word by 1 to 15 bits gives another code only between 0F0F and 3C3C.

    0F0F becomes 3C3C by 2 to the left (rotated also by 10), 3C3C becomes 0F0F by 2 to the right (rotated also
    by 10 to the right). Rotation by 8, and of 3333 by 4 and 12 too, leaves a word as it is; shifting can also
    leave zero.
    """
    sent, count = word("sent"), word("count")
    for name in FLAG_WORD:
        given = {
            f"sent is a code of {name}": is_code(name, sent),
            "count is 1 to 15": z3.And(z3.UGE(count, 1), z3.ULE(count, 15)),
        }
        left, right, around = sent << count, z3.LShR(sent, count), rotated_left(sent, count)
        shifted_up = z3.And(sent == 0x0F0F, count == 2)
        shifted_down = z3.And(sent == 0x3C3C, count == 2)
        rotated = z3.Or(
            z3.And(sent == 0x0F0F, one_of(count, (2, 10))), z3.And(sent == 0x3C3C, one_of(count, (6, 14)))
        )
        same = z3.Or(
            z3.And(sent == 0x3333, one_of(count, (4, 8, 12))),
            z3.And(one_of(sent, (0x0F0F, 0x3C3C)), count == 8),
        )
        yield from claim(f"{name}: shifted left", given, is_code(name, left) == shifted_up)
        yield from claim(f"{name}: shifted right", given, is_code(name, right) == shifted_down)
        yield from claim(f"{name}: rotated", given, is_accepted(name, around) == z3.Or(rotated, same))
        yield from claim(f"{name}: rotated and unchanged", given, (around == sent) == same)
