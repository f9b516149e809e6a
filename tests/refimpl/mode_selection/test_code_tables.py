"""Tables 1 and 2 as transcribed in refimpl: pinned digit by digit, and what follows from them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from refimpl.errors import InputError
from refimpl.mode_selection import code_tables as tables

PRINTED = {
    "RE": "0F0F 0FF0 3333 33CC 3C3C",
    "SE": "0FF0 3333 33CC 3C3C 0F0F",
    "CH": "3333 33CC 3C3C 0F0F 0FF0",
    "SW": "33CC 3C3C 0F0F 0FF0 3333",
}


def hex_row(words: tuple[int, ...]) -> str:
    return " ".join(f"{word:04X}" for word in words)


def test_table_1_has_the_printed_words() -> None:
    binary = "0000111100001111 0000111111110000 0011001100110011 0011001111001100 0011110000111100"
    assert " ".join(f"{word:016b}" for word in tables.SET_OF_VALUES) == binary


@pytest.mark.parametrize("name", PRINTED)
def test_table_2_has_the_printed_words(name: str) -> None:
    assert hex_row(tables.RANGES[name]) == PRINTED[name]


def test_four_ranges_use_exactly_the_words_of_table_1() -> None:
    assert list(tables.RANGES) == ["RE", "SE", "CH", "SW"]
    for codes in tables.RANGES.values():
        assert sorted(codes) == sorted(tables.SET_OF_VALUES)


def test_five_words_and_zero_differ_in_exactly_eight_bits() -> None:
    words = (*tables.SET_OF_VALUES, tables.ZERO)
    distances = [(a ^ b).bit_count() for i, a in enumerate(words) for b in words[:i]]
    assert distances == [8] * 15


def test_no_word_means_the_same_mode_in_two_ranges() -> None:
    for mode in range(5):
        assert len({codes[mode] for codes in tables.RANGES.values()}) == 4


@pytest.mark.parametrize("name", PRINTED)
def test_decode_inverts_encode_and_accepts_exactly_five_of_all_words(name: str) -> None:
    codes = tables.RANGES[name]
    assert [tables.decode(codes, tables.encode(codes, mode)) for mode in range(5)] == [0, 1, 2, 3, 4]
    accepted = [word for word in range(0x10000) if tables.decode(codes, word) != tables.NONE]
    assert sorted(codes) == accepted


@pytest.mark.parametrize("name", PRINTED)
def test_zero_is_the_word_of_none_and_means_none(name: str) -> None:
    assert tables.encode(tables.RANGES[name], tables.NONE) == 0
    assert tables.decode(tables.RANGES[name], 0) == tables.NONE


@given(st.integers().filter(lambda number: not -1 <= number <= 4))
def test_a_number_that_is_no_mode_has_no_word(number: int) -> None:
    with pytest.raises(InputError, match="mode"):
        tables.encode(tables.RE, number)
