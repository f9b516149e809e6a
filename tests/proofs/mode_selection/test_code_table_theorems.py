"""The theorems about the code tables: all proved, each exported, and each false as soon as a fault is planted."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import z3

from proofs.mode_selection import code_errors, code_handling, code_tables, residual_error, transcriptions
from proofs.runner import TheoremResult, prove
from proofs.solvers import ask_z3
from proofs.theorem import Theorem, theorems_of
from refimpl.mode_selection import code_tables as shipped

THEOREMS = theorems_of("mode_selection")
MODULES = ("code_copies", "code_errors", "code_handling", "code_tables", "residual_error", "transcriptions")
OURS = [item for item in THEOREMS if item.build.__module__.removeprefix("proofs.mode_selection.") in MODULES]

RANGES = ("RE", "SE", "CH", "SW")
Plant = Callable[[pytest.MonkeyPatch], None]


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[str, TheoremResult]:
    out = tmp_path_factory.mktemp("proofs")
    return {result.name: result for result in prove("mode_selection", out, lambda line: None)}


@pytest.mark.parametrize("name", [item.name for item in OURS])
def test_the_theorem_is_proved_by_both_solvers(results: dict[str, TheoremResult], name: str) -> None:
    result = results[name]
    assert (result.verdict, result.reason) == ("PROVED", "")
    assert any(query.expected == "unsat" for query in result.queries)
    assert all(query.z3 == query.cvc5 == query.expected for query in result.queries)


def test_the_exported_files_read_back_by_z3_give_the_same_answers(results: dict[str, TheoremResult]) -> None:
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


def _table(name: str, change: Callable[[tuple[int, ...]], tuple[int, ...]]) -> Plant:
    return lambda patch: patch.setattr(shipped, name, change(getattr(shipped, name)))


def _digit(name: str, mode: int, flip: int) -> Plant:
    """One hexadecimal digit of one word is wrong."""
    return _table(name, lambda row: (*row[:mode], row[mode] ^ flip, *row[mode + 1 :]))


def _value(name: str, mode: int, value: int) -> Plant:
    return _table(name, lambda row: (*row[:mode], value, *row[mode + 1 :]))


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


def _specification(old: str, new: str) -> Plant:
    """The specification's own transcription has a wrong digit."""

    class Changed:
        @staticmethod
        def read_text(encoding: str) -> str:
            text = transcriptions.SPECIFICATION.read_text(encoding=encoding)
            assert old in text
            return text.replace(old, new)

    return _in(transcriptions, "SPECIFICATION", Changed)


ROWS = code_tables.FOUR_DISJOINT_RANGES
PLANTS: dict[str, Plant] = {
    **{f"{name}_MSO_{m} with a wrong digit": _digit(name, m, 0x0010) for name in RANGES for m in range(5)},
    **{f"{name}_MSO_{m} with a wrong high byte": _digit(name, m, 0xFF00) for name in RANGES for m in range(5)},
    **{f"{name} is {other}": _copy_of(name, other) for name in RANGES for other in RANGES if name < other},
    **{f"{name}_MSO_0 is zero": _value(name, 0, 0) for name in RANGES},
    **{f"{name}_MSO_1 is {name}_MSO_0": _value(name, 1, getattr(shipped, name)[0]) for name in RANGES},
    **{f"{word:04X}H is accepted": _accepts(word) for word in (0xF0F0, 0xFFFF, 0xF00F, 0x5500, 0x7878, 0x1E1E)},
    "the reader compares one byte": _decoder(_compares_one_byte),
    "the reader forgets mode 4": _decoder(_forgets_mode_4),
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
    "the bit-error rate is 1/99": _in(residual_error, "BIT_ERROR_RATE", residual_error.Fraction(1, 99)),
    "the bit-error rate is 1/1000": _in(residual_error, "BIT_ERROR_RATE", residual_error.Fraction(1, 1000)),
    **{f"the distance is {d}": _in(residual_error, "DISTANCE", d) for d in range(1, 17) if d != 8},
    "the word has 15 bits": _in(residual_error, "BITS", 15),
    "the printed figure is 1.3e-12": lambda patch: (
        patch.setattr(residual_error, "PRINTED_FROM", residual_error.Fraction(125, 10**14)),
        patch.setattr(residual_error, "PRINTED_TO", residual_error.Fraction(135, 10**14)),
    )[0],
    "the exact sum counts 9 bits on": _in(
        residual_error, "tail", lambda rate, bits, distance: residual_error.Fraction(119, 10**14)
    ),
    "the exact first term is rounded": _in(
        residual_error, "first_term", lambda rate, bits, distance: residual_error.Fraction(119, 10**14)
    ),
    "the bound is a thousandth": _in(
        residual_error,
        "_tail",
        lambda rate, bits, distance: residual_error._flips(rate, bits, distance) / 1000,
    ),
    "the specification has a wrong digit in RE": _specification("RE == TLCEval([m \\in MSO |-> CASE m = 0 -> \\h0F0F", "RE == TLCEval([m \\in MSO |-> CASE m = 0 -> \\h0F1F"),
}


def _claims_that_fall(item: Theorem) -> Iterator[str]:
    """The claims of a theorem that z3 refutes in the present, planted state of the code."""
    for query in item.build():
        if query.expected == "unsat" and ask_z3(query, "", 5000).answer == "sat":
            yield query.name


@pytest.mark.parametrize("item", OURS, ids=lambda item: item.name)
def test_every_claim_of_the_theorem_falls_under_some_planted_fault(item: Theorem) -> None:
    standing = {query.name for query in item.queries() if query.expected == "unsat"}
    assert standing
    assert not set(_claims_that_fall(item)), "the claim falls without a fault"
    for plant in PLANTS.values():
        if not standing:
            return
        with pytest.MonkeyPatch.context() as patch:
            plant(patch)
            try:
                standing -= set(_claims_that_fall(item))
            except ValueError:
                continue  # the theorem refuses the planted state before it asks a solver
    assert not standing
