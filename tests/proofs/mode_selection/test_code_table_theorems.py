"""The theorems about the code tables: all proved, all exported, and false as soon as a fault is planted."""

import contextlib
import re
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest
import z3

from proofs.mode_selection import code_tables, residual_error, transcriptions
from proofs.runner import TheoremResult, prove_all
from proofs.solvers import ask_z3
from proofs.theorem import Query, Theorem, TheoremError, theorems_of
from refimpl.mode_selection import code_tables as shipped
from tests.any_machine import LONG_MS

THEOREMS = theorems_of("mode_selection")
MODULES = ("code_copies", "code_errors", "code_handling", "code_tables", "residual_error", "transcriptions")
OURS = [item for item in THEOREMS if item.build.__module__.removeprefix("proofs.mode_selection.") in MODULES]

RANGES = ("RE", "SE", "CH", "SW")
Plant = Callable[[pytest.MonkeyPatch], None]


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[str, TheoremResult]:
    out = tmp_path_factory.mktemp("proofs")
    return {result.name: result for result in prove_all(OURS, out, lambda line: None, LONG_MS)}


@pytest.mark.parametrize("name", [item.name for item in OURS])
def test_the_theorem_is_proved_by_both_solvers(results: dict[str, TheoremResult], name: str) -> None:
    result = results[name]
    assert (result.verdict, result.reason) == ("PROVED", "")
    assert any(query.expected == "unsat" for query in result.queries)
    assert all(query.z3 == query.cvc5 == query.expected for query in result.queries)


def test_exported_files_read_back_by_z3_give_the_same_answers(results: dict[str, TheoremResult]) -> None:
    queries = [query for item in OURS for query in results[item.name].queries]
    assert len(queries) > 300
    for query in queries:
        solver = z3.Solver()
        solver.from_file(str(query.smt2))
        assert str(solver.check()) == query.expected, query.smt2


def test_no_exported_file_tells_the_solver_the_expected_answer(results: dict[str, TheoremResult]) -> None:
    for query in results[OURS[0].name].queries:
        text = [line for line in query.smt2.read_text().splitlines() if not line.startswith(";")]
        assert not any("sat" in line.replace("(check-sat)", "") for line in text)


def _everywhere(mode: int, change: Callable[[int], int]) -> Plant:
    """The word of one mode is wrong in every range."""

    def plant(patch: pytest.MonkeyPatch) -> None:
        for name in RANGES:
            row = getattr(shipped, name)
            patch.setattr(shipped, name, (*row[:mode], change(row[mode]), *row[mode + 1 :]))

    return plant


def _twice(patch: pytest.MonkeyPatch) -> None:
    """In every range mode 1 has the word of mode 0."""
    for name in RANGES:
        row = getattr(shipped, name)
        patch.setattr(shipped, name, (row[0], row[0], *row[2:]))


def _copy_of(name: str, other: str) -> Plant:
    """A range has the meanings of another one."""
    return lambda patch: patch.setattr(shipped, name, getattr(shipped, other))


def _decoder(decode: Callable[[tuple[int, ...], int], int]) -> Plant:
    return lambda patch: patch.setattr(shipped, "decode", decode)


def _compares_one_byte(codes: tuple[int, ...], word: int) -> int:
    """A reader that accepts a stranger beside each code."""
    for mode, code in enumerate(codes):
        if word == code or word == code ^ 0xFF00:
            return mode
    return -1


def _forgets_mode_4(codes: tuple[int, ...], word: int) -> int:
    for mode in range(4):
        if word == codes[mode]:
            return mode
    return -1


def _accepts(stranger: int) -> Plant:
    """A reader that takes one more word for mode 2."""

    def decode(codes: tuple[int, ...], word: int) -> int:
        for mode, code in enumerate(codes):
            if word == code:
                return mode
        return 2 if word == stranger else -1

    return _decoder(decode)


def _zero_is_ffff(codes: tuple[int, ...], mode: int) -> int:
    for number, code in enumerate(codes):
        if mode == number:
            return code
    return 0xFFFF


def _in(module: object, name: str, value: object) -> Plant:
    return lambda patch: patch.setattr(module, name, value)


def _rows(*rows: tuple[int, ...]) -> Plant:
    return _in(code_tables, "FOUR_DISJOINT_RANGES", rows)


def _prints_1_3(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(residual_error, "PRINTED_FROM", Fraction(125, 10**14))
    patch.setattr(residual_error, "PRINTED_TO", Fraction(135, 10**14))


class _WrongDigits:
    """The text of the specification with the word of mode 0 wrong in every range."""

    def __init__(self, original: Path) -> None:
        self.original = original

    def read_text(self, encoding: str) -> str:
        text = self.original.read_text(encoding=encoding)
        assert text.count("CASE m = 0 -> ") == 4
        return re.sub(r"(CASE m = 0 -> \\h..)..", r"\g<1>77", text)


def _specification_with_wrong_digits(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(transcriptions, "SPECIFICATION", _WrongDigits(transcriptions.SPECIFICATION))


ROWS = code_tables.FOUR_DISJOINT_RANGES
TABLE_PLANTS: dict[str, Plant] = {
    "the reader compares one byte": _decoder(_compares_one_byte),
    "the reader forgets mode 4": _decoder(_forgets_mode_4),
    **{
        f"{word:04X}H is accepted": _accepts(word)
        for word in (0xF0F0, 0xFFFF, 0x5500, 0xF00F, 0x7878, 0x1E1E)
    },
    **{f"{name} is {other}": _copy_of(name, other) for name in RANGES for other in RANGES if name < other},
    **{f"mode {m} has a wrong digit": _everywhere(m, lambda word: word ^ 0x0010) for m in range(5)},
    **{f"mode {m} has a wrong high byte": _everywhere(m, lambda word: word ^ 0xFF00) for m in range(5)},
    "mode 0 has the word zero": _everywhere(0, lambda word: 0),
    "mode 1 has the word of mode 0": _twice,
    "nothing is written as FFFFH": _in(shipped, "encode", _zero_is_ffff),
    "Table 1 lacks a word": _in(shipped, "SET_OF_VALUES", shipped.SET_OF_VALUES[:4]),
    "Table 1 has a sixth word": _in(shipped, "SET_OF_VALUES", (*shipped.SET_OF_VALUES, 0x5555)),
    "a range of its own is too near": _rows(ROWS[0], ROWS[1], ROWS[2], (0xF0F1, *ROWS[3][1:])),
    **{
        f"ranges {a} and {b} of their own share a word": _rows(
            *(ROWS[i] if i != b else (*ROWS[b][:4], ROWS[a][4]) for i in range(4))
        )
        for a in range(4)
        for b in range(a + 1, 4)
    },
    "the specification has a wrong digit": _specification_with_wrong_digits,
}
RATE_PLANTS: dict[str, Plant] = {
    "the bit-error rate is 1/99": _in(residual_error, "BIT_ERROR_RATE", Fraction(1, 99)),
    **{f"the distance is {d}": _in(residual_error, "DISTANCE", d) for d in range(1, 17) if d != 8},
    "the word has 15 bits": _in(residual_error, "BITS", 15),
    "the printed figure is 1.3e-12": _prints_1_3,
    "the exact sum is rounded": _in(residual_error, "tail", lambda *_: Fraction(119, 10**14)),
    "the exact first term is rounded": _in(residual_error, "first_term", lambda *_: Fraction(119, 10**14)),
    "the bound is a thousandth": _in(
        residual_error,
        "_tail",
        lambda rate, bits, distance: residual_error._flips(rate, bits, distance) / 1000,
    ),
}


ASKED: dict[frozenset[int], tuple[Query, bool]] = {}
"""What was asked, by the numbers that z3 gives to the formulas; the queries are kept, and so the numbers."""


def _falls(query: Query) -> bool:
    """Whether z3 refutes it; a plant that a question does not touch leaves it word for word as it was."""
    formulas = frozenset(formula.get_id() for formula in query.formulas.values())
    if formulas not in ASKED:
        ASKED[formulas] = query, ask_z3(query, "", LONG_MS).answer == "sat"
    return ASKED[formulas][1]


def _claims_that_fall(item: Theorem, standing: set[str]) -> set[str]:
    """Those of the standing claims that z3 refutes in the present, planted state of the code."""
    return {query.name for query in item.build() if query.name in standing and _falls(query)}


@pytest.mark.sampled(6)
@pytest.mark.parametrize("item", OURS, ids=lambda item: item.name)
def test_every_claim_of_the_theorem_falls_under_some_planted_fault(item: Theorem) -> None:
    standing = {query.name for query in item.queries() if query.expected == "unsat"}
    assert standing
    assert not _claims_that_fall(item, standing), "a claim falls without a fault"
    plants = RATE_PLANTS if item.build.__module__.endswith("residual_error") else TABLE_PLANTS
    for plant in plants.values():
        if standing:
            with pytest.MonkeyPatch.context() as patch:
                plant(patch)
                with contextlib.suppress(
                    TheoremError
                ):  # the planted state is refused before a solver is asked
                    standing -= _claims_that_fall(item, standing)
    assert not standing


def test_a_wrong_digit_is_reported_with_the_pair_of_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shipped, "SW", (0x33CC, 0x3C3C, 0x0F0E, 0x0FF0, 0x3333))
    items = [item for item in OURS if item.name.startswith("every_two_code_words")]
    result = prove_all(items, tmp_path, lambda line: None, LONG_MS)[0]
    assert result.verdict == "VIOLATED"
    assert result.reason.startswith("SW: distance 8: counterexample first = ")
    assert "0F0EH" in result.reason


REFUTED_BY_FIGURE_7 = (
    "each_mode_has_its_own_acknowledgment_word",
    "every_range_is_the_set_of_values_of_table_1_and_zero_is_in_none",
    "decoding_gives_the_encoded_mode_and_none_for_every_other_word",
    "the_specification_and_the_implementation_have_the_same_tables",
)


def test_four_theorems_refute_a_table_with_the_figure_7_word(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shipped, "SW", (0x33CC, 0x3C3C, 0x0FF0, 0x0FF0, 0x3333))
    items = [item for item in OURS if item.name in REFUTED_BY_FIGURE_7]
    verdicts = {
        result.name: result.verdict for result in prove_all(items, tmp_path, lambda line: None, LONG_MS)
    }
    assert verdicts == dict.fromkeys(REFUTED_BY_FIGURE_7, "VIOLATED")


def test_one_wrong_digit_refutes_the_exact_figure_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shipped, "CH", (0x3333, 0x33CC, 0x3C3C, 0x0F0E, 0x0FF0))
    items = [item for item in OURS if item.name.startswith("the_code_itself")]
    assert prove_all(items, tmp_path, lambda line: None, LONG_MS)[0].verdict == "VIOLATED"
