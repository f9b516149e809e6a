"""The same facts by plain counting over all 65536 words, without a solver and without the path runner."""

from fractions import Fraction
from itertools import combinations, product

import pytest

from proofs.mode_selection.code_copies import SHIFT
from proofs.mode_selection.code_errors import UNDETECTED
from proofs.mode_selection.code_handling import STRADDLED
from proofs.mode_selection.code_tables import FOUR_DISJOINT_RANGES
from proofs.mode_selection.residual_error import first_term, rounds_to_the_printed_figure, tail, undetected
from refimpl.mode_selection import code_tables
from refimpl.mode_selection.code_tables import RANGES, decode

ONE_PERCENT = Fraction(1, 100)
ALL_WORDS = range(65536)


def _accepted(codes: tuple[int, ...]) -> set[int]:
    """Zero and every word of 65536 that the shipped reader takes for a mode."""
    return {0} | {word for word in ALL_WORDS if decode(codes, word) != code_tables.NONE}


@pytest.mark.parametrize("name", RANGES)
def test_the_reader_accepts_five_words_all_eight_bits_apart(name: str) -> None:
    accepted = _accepted(RANGES[name])
    assert accepted == {0, *code_tables.SET_OF_VALUES}
    assert [(a ^ b).bit_count() for a, b in combinations(accepted, 2)] == [8] * 15


@pytest.mark.parametrize("name", RANGES)
def test_only_the_listed_error_patterns_go_undetected_on_any_word(name: str) -> None:
    accepted = _accepted(RANGES[name])
    escaped = {
        (sent, error) for sent in accepted for error in ALL_WORDS if error and sent ^ error in accepted
    }
    listed = {(sent, error) for error, pairs in UNDETECTED.items() for pair in pairs for sent in pair}
    assert escaped == listed
    assert len(escaped) == 30


def test_the_twelve_copies_move_the_mode_by_the_listed_number() -> None:
    for (source, target), shift in SHIFT.items():
        moved = [decode(RANGES[target], word) for word in RANGES[source]]
        assert moved == [(mode + shift) % 5 for mode in range(5)]
    assert len(SHIFT) == 12


def test_five_straddled_pairs_and_zero_beside_zero_are_accepted() -> None:
    words = (0, *code_tables.SET_OF_VALUES)
    read = {(a, b): (a & 0xFF) << 8 | b >> 8 for a, b in product(words, words)}
    assert {pair for pair, word in read.items() if word in words} == {(0, 0), *STRADDLED}


def test_twenty_words_of_four_ranges_have_minimum_distance_eight() -> None:
    words = [0, *(word for row in FOUR_DISJOINT_RANGES for word in row)]
    assert len(set(words)) == 21
    assert min((a ^ b).bit_count() for a, b in combinations(words, 2)) == 8


def test_the_tail_is_exact_and_rounds_to_the_printed_figure() -> None:
    exact = tail(ONE_PERCENT, 16, 8)
    assert exact == Fraction(23966221203706743047, 2 * 10**31)
    assert Fraction(115, 10**14) < exact < Fraction(125, 10**14)
    assert rounds_to_the_printed_figure(exact)


def test_of_other_candidates_only_the_first_term_rounds_to_it() -> None:
    assert rounds_to_the_printed_figure(first_term(ONE_PERCENT, 16, 8))
    others = [
        first_term(ONE_PERCENT, 16, 8) / Fraction(99, 100) ** 8,
        *(tail(Fraction(1, 10**k), 16, 8) for k in (1, 3, 4, 5, 6)),
        tail(Fraction(1, 2), 16, 8),
        *(tail(ONE_PERCENT, 16, distance) for distance in range(17) if distance != 8),
        *(tail(ONE_PERCENT, bits, 8) for bits in (8, 12, 15, 17, 24, 32)),
    ]
    assert not any(rounds_to_the_printed_figure(other) for other in others)


@pytest.mark.parametrize("name", RANGES)
def test_the_exact_figure_sums_all_accepted_error_patterns(name: str) -> None:
    codes = RANGES[name]
    accepted = _accepted(codes)
    for sent in codes:
        flips = [e.bit_count() for e in ALL_WORDS if e and sent ^ e in accepted]
        counted = sum((ONE_PERCENT**n * (1 - ONE_PERCENT) ** (16 - n) for n in flips), Fraction(0))
        assert counted == undetected(sent, (0, *codes), ONE_PERCENT) == 5 * Fraction(99, 10000) ** 8
        assert undetected(sent, codes, ONE_PERCENT) == 4 * Fraction(99, 10000) ** 8
    assert f"{float(4 * Fraction(99, 10000) ** 8):.3e}" == "3.691e-16"
    assert f"{float(tail(ONE_PERCENT, 16, 8) / (4 * Fraction(99, 10000) ** 8)):.1f}" == "3246.6"
