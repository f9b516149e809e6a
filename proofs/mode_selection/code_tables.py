"""Tables 1 and 2: the words, their distances, and what each of them means in each range."""

from itertools import combinations
from typing import Final

import z3

from proofs.mode_selection.ranges import (
    FLAG_WORD,
    accepted,
    codes,
    free_mode,
    is_code,
    mode_of,
    word_of,
)
from proofs.theorem import Queries, claim, control, theorem
from proofs.words import one_of, ones, word
from refimpl.mode_selection import code_tables

DISTANCE: Final = 8
TABLE_1_WITH_A_WRONG_DIGIT: Final = (0x0F1F, 0x0FF0, 0x3333, 0x33CC, 0x3C3C)
SW_AS_PRINTED_IN_FIGURE_7: Final = (0x33CC, 0x3C3C, 0x0FF0, 0x0FF0, 0x3333)
FOUR_DISJOINT_RANGES: Final = (
    (0x0F0F, 0x0FF0, 0x3333, 0x33CC, 0x3C3C),
    (0x3CC3, 0x5555, 0x55AA, 0x5A5A, 0x5AA5),
    (0x6666, 0x6699, 0x6969, 0x6996, 0x00FF),
    (0xF0F0, 0xF00F, 0xCCCC, 0xCC33, 0xC3C3),
)


@theorem(clauses=["EKS-T1", "EKS-T2", "EKS-KS-8", "EKS-KS-9"], findings=["E-18"])
def every_two_code_words_and_zero_differ_in_exactly_eight_bits() -> Queries:
    """Every two different words among the five code words and zero differ in exactly eight bits, in every
    range.

    Zero included, every code word has eight ones. All fifteen pairs are as far apart as the note says of its
    Hamming distance; no pair is farther.
    """
    first, second = word("first"), word("second")
    for name in FLAG_WORD:
        given = {
            f"first is zero or a code of {name}": one_of(first, accepted(name)),
            f"second is zero or a code of {name}": one_of(second, accepted(name)),
            "they are different": first != second,
        }
        yield from claim(f"{name}: distance 8", given, ones(first ^ second) == DISTANCE)
    planted = {
        "first is in the table with a wrong digit": one_of(first, TABLE_1_WITH_A_WRONG_DIGIT),
        "second is in the table with a wrong digit": one_of(second, TABLE_1_WITH_A_WRONG_DIGIT),
        "they are different": first != second,
        "their distance is not 8": ones(first ^ second) != DISTANCE,
    }
    yield control("planted: one wrong digit in RE_MSO_0 breaks the distance", planted)


@theorem(clauses=["EKS-T1", "EKS-T2", "EKS-KS-8", "EKS-KS-10"], findings=["E-18"])
def every_range_is_the_set_of_values_of_table_1_and_zero_is_in_none() -> Queries:
    """Each of the four ranges holds exactly the five words of Table 1, each once, and never zero.

    So the ranges are not disjoint as sets of words: a range check alone cannot tell which of the four words
    it reads.
    """
    mode, is_mode = free_mode("mode")
    other, is_other = free_mode("other")
    read = word("read")
    for name in FLAG_WORD:
        is_read_code = {f"the word read is a code of {name}": is_code(name, read)}
        in_table_1 = {"the word is in Table 1": one_of(read, code_tables.SET_OF_VALUES)}
        yield from claim(
            f"{name}: codes are in Table 1", is_read_code, one_of(read, code_tables.SET_OF_VALUES)
        )
        yield from claim(f"{name}: Table 1 is accepted", in_table_1, is_code(name, read))
        yield from claim(f"{name}: zero is no code", is_read_code, read != code_tables.ZERO)
        two = {"mode is 0 to 4": is_mode, "other is 0 to 4": is_other, "they are different": mode != other}
        yield from claim(f"{name}: each word once", two, word_of(name, mode) != word_of(name, other))


@theorem(clauses=["EKS-T2", "EKS-T2-1", "EKS-SD-17"], findings=["E-18"])
def no_word_means_the_same_mode_in_two_ranges() -> Queries:
    """No word means the same mode in two of the four ranges: as relations of word and mode they are
    disjoint.
    """
    read = word("read")
    for first, second in combinations(FLAG_WORD, 2):
        given = {
            f"the word is a code of {first}": is_code(first, read),
            f"the word is a code of {second}": is_code(second, read),
        }
        yield from claim(f"{first} and {second}", given, mode_of(first, read) != mode_of(second, read))


@theorem(clauses=["EKS-T2", "EKS-T2-4", "EKS-KS-8", "EKS-KS-10"], findings=[])
def decoding_gives_the_encoded_mode_and_none_for_every_other_word() -> Queries:
    """In every range the word written for a mode is read as that mode, and each of the other 65531 words as
    none.

    These are the functions `encode` and `decode` of the reference implementation, run path by path. Zero is
    written for no mode and read as none.
    """
    mode, is_mode = free_mode("mode")
    read = word("read")
    none = {"there is no mode": mode == code_tables.NONE}
    for name in FLAG_WORD:
        written = word_of(name, mode)
        yield from claim(
            f"{name}: there and back", {"mode is 0 to 4": is_mode}, mode_of(name, written) == mode
        )
        a_code = {f"the word is read as a mode in {name}": is_code(name, read)}
        yield from claim(f"{name}: back and there", a_code, word_of(name, mode_of(name, read)) == read)
        a_stranger = {
            f"the word is none of the five in {name}": z3.Not(one_of(read, codes(name))),
        }
        yield from claim(f"{name}: strangers are none", a_stranger, mode_of(name, read) == code_tables.NONE)
        silent = z3.And(written == code_tables.ZERO, mode_of(name, written) == code_tables.NONE)
        yield from claim(f"{name}: none is zero", none, silent)


@theorem(clauses=["EKS-T2", "EKS-7-3", "EKS-7-5", "EKS-2-27"], findings=["E-01"])
def each_mode_has_its_own_acknowledgment_word() -> Queries:
    """In SW of Table 2 two different modes never share a word; with 0FF0H, as printed in Figure 7 step 5,
    modes 2 and 3 do.

    With the printed word the acknowledgment of mode 3 can be taken for mode 2, and the word of Table 2 for
    mode 2 is refused. Only the text was read; a drawing could settle which is meant. Table 2 is used.
    """
    mode, is_mode = free_mode("mode")
    other, is_other = free_mode("other")
    two = {"mode is 0 to 4": is_mode, "other is 0 to 4": is_other, "they are different": mode != other}
    yield from claim("Table 2 tells all five apart", two, word_of("SW", mode) != word_of("SW", other))
    read = word("read")
    mistaken = {
        "the word means mode 3 in SW": mode_of("SW", read) == 3,
        "step 5 as printed takes it for mode 2": read == SW_AS_PRINTED_IN_FIGURE_7[2],
    }
    yield control("printed: step 5 takes the acknowledgment of mode 3 for mode 2", mistaken)
    unknown = {
        "the word means mode 2 in SW": mode_of("SW", read) == 2,
        "no odd step as printed knows the word": z3.Not(one_of(read, SW_AS_PRINTED_IN_FIGURE_7)),
    }
    yield control("printed: the acknowledgment of mode 2 is unknown to every step", unknown)


@theorem(clauses=["EKS-T2-1", "EKS-KS-9"], findings=["E-18"])
def four_disjoint_ranges_at_the_same_distance_would_have_been_possible() -> Queries:
    """There are twenty words, those of Table 1 among them, that differ from each other and from zero in at
    least eight bits.

    With them each of the four ranges could have had words of its own, and a range check would have caught
    every copy between two ranges. This is a remark on E-18; the tables of the note are used as they are.
    """
    flat = [value for row in FOUR_DISJOINT_RANGES for value in row]
    first, second = word("first"), word("second")
    given = {
        "first is zero or one of the twenty": one_of(first, [0, *flat]),
        "second is zero or one of the twenty": one_of(second, [0, *flat]),
        "they are different": first != second,
    }
    yield from claim(
        "twenty words and zero, distance at least 8", given, z3.UGE(ones(first ^ second), DISTANCE)
    )
    of_table_1 = {"the word is in Table 1": one_of(first, code_tables.SET_OF_VALUES)}
    yield from claim("the first five are Table 1", of_table_1, one_of(first, FOUR_DISJOINT_RANGES[0]))
    for first_row, second_row in combinations(range(len(FOUR_DISJOINT_RANGES)), 2):
        rows = {
            f"first is in row {first_row + 1}": one_of(first, FOUR_DISJOINT_RANGES[first_row]),
            f"second is in row {second_row + 1}": one_of(second, FOUR_DISJOINT_RANGES[second_row]),
        }
        yield from claim(f"rows {first_row + 1} and {second_row + 1} share no word", rows, first != second)
