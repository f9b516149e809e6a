"""Figures 5 to 7: theorems are proved, false variants are refuted, every example is replayed in Python."""

# ruff: noqa: SIM300 -- the names of words are upper case

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import z3

from proofs.explorer.errors import LintError
from proofs.mode_selection import figures
from proofs.runner import prove_all
from proofs.solvers import ask_z3
from proofs.theorem import Theorem
from refimpl.mode_selection import fplc
from refimpl.mode_selection.code_tables import CH, RE, SE, SW
from tests.any_machine import LONG_MS

THEOREMS = [item for item in vars(figures).values() if isinstance(item, Theorem)]
ONE_OF_THE_REST = 0x5A5A
"""Stands for the 65530 words that are neither zero nor a code."""
REST = 65530
WORDS = (0, *RE, ONE_OF_THE_REST)
"""All ranges hold the same five words; every chain compares with them alone."""


def _count(*words: int) -> int:
    """How many tuples of words this one stands for."""
    product = 1
    for word in words:
        product *= REST if word == ONE_OF_THE_REST else 1
    return product


def _accepted(chain: Callable[[int, int], bool]) -> set[tuple[int, int]]:
    return {(first, second) for first in WORDS for second in WORDS if chain(first, second)}


def _size(pairs: set[tuple[int, int]]) -> int:
    return sum(_count(*pair) for pair in pairs)


TO_SELECT = {(RE[level], SE[mode]) for level in range(5) for mode in range(level + 1)}
SAME_MODE = {(SE[mode], SW[mode]) for mode in range(5)}


@pytest.mark.parametrize("item", THEOREMS, ids=lambda item: item.name)
def test_every_theorem_on_the_figures_is_proved_by_both_solvers(item: Theorem, tmp_path: Path) -> None:
    (result,) = prove_all([item], tmp_path, lambda line: None, LONG_MS)
    assert (result.verdict, result.reason) == ("PROVED", "")


def test_there_are_eleven_of_them() -> None:
    assert len(THEOREMS) == 11


def test_the_shipped_figures_are_the_relations_by_counting() -> None:
    assert _accepted(fplc.permitted) == TO_SELECT
    assert _accepted(fplc.matches) == SAME_MODE


def test_the_sizes_that_the_theorems_name_by_counting() -> None:
    falls_through = _accepted(lambda a, b: figures.figure_5(a, b, True))
    assert falls_through >= TO_SELECT
    assert _size(falls_through - TO_SELECT) == 65536 * 65531 + 65531
    by_both = {pair for pair in falls_through if figures.figure_6_exclusive(pair[1], 0)[0]}
    assert _size(by_both - TO_SELECT) == 65531
    assert {pair[1] for pair in by_both - TO_SELECT} == {SE[0]}
    ends_in_error = _accepted(lambda a, b: figures.figure_5(a, b, False))
    assert TO_SELECT - ends_in_error == {(RE[0], SE[0])}
    assert _size(ends_in_error - TO_SELECT) == 4 * 65531


def test_the_pairs_that_figure_7_accepts_by_counting() -> None:
    pairs = {
        (name, rows): _accepted(lambda a, b, chain=chain, rows=rows: chain(a, b, rows))  # type: ignore[misc]
        for name, chain in (
            ("exclusive", figures.figure_7_exclusive),
            ("falling through", figures.figure_7_falling_through),
        )
        for rows in (figures.RIGHT, figures.PRINTED)
    }
    without_2 = SAME_MODE - {(SE[2], SW[2])}
    assert pairs["exclusive", figures.RIGHT] == SAME_MODE
    assert pairs["falling through", figures.RIGHT] == SAME_MODE
    assert pairs["exclusive", figures.PRINTED] == without_2
    assert pairs["falling through", figures.PRINTED] == without_2 | {(SE[2], SW[3])}


@pytest.mark.parametrize(
    ("theorem", "query", "chain", "fields"),
    [
        (
            figures.figure_5_as_printed_takes_every_word_that_is_no_level_for_level_0_and_every_word_that_is_no_mode,
            "zero in MW01 selects a mode",
            lambda a, b: figures.figure_5(a, b, True),
            ("MW01", "MW03"),
        ),
        (
            figures.figure_6_after_figure_5_leaves_only_the_words_that_are_no_level,
            "a pair is wrongly accepted",
            lambda a, b: figures.figure_5(a, b, True) and figures.figure_6_exclusive(b, 0)[0],
            ("MW01", "MW03"),
        ),
        (
            figures.figure_7_as_printed_and_falling_through_accepts_one_wrong_pair_mode_3_for_mode_2,
            "a pair is wrongly accepted",
            lambda a, b: figures.figure_7_falling_through(a, b, figures.PRINTED),
            ("MW03", "MW07"),
        ),
    ],
)
def test_the_printed_chain_accepts_a_wrong_pair_that_ours_refuses(
    theorem: Theorem, query: str, chain: Callable[[int, int], bool], fields: tuple[str, str]
) -> None:
    first, second = _example(next(one for one in theorem.build() if one.name == query).formulas, fields)
    assert chain(first, second)
    assert not (fplc.permitted if fields[0] == "MW01" else fplc.matches)(first, second)


def _example(formulas: Any, fields: tuple[str, ...]) -> list[int]:
    solver = z3.Solver()
    solver.add(*formulas.values())
    assert solver.check() == z3.sat
    model = solver.model()
    return [model.eval(z3.BitVec(name, 16), model_completion=True).as_long() for name in fields]


def _permits_one_more(MW01: int, MW03: int) -> bool:
    if MW01 == 0x33CD and MW03 == 0x3333:
        return True
    return MW01 == RE[4] and MW03 == SE[4]


def _matches_the_low_byte(MW03: int, MW07: int) -> bool:
    return MW03 & 0xFF == 0x0F and MW07 & 0xFF == 0x33


def _echoes_itself(MW03: int) -> int:
    return MW03


@pytest.mark.parametrize(
    ("name", "planted", "theorem", "fields"),
    [
        (
            "permitted",
            _permits_one_more,
            figures.our_figure_5_is_the_order_of_the_levels_for_all_words,
            ("MW01", "MW03"),
        ),
        (
            "matches",
            _matches_the_low_byte,
            figures.our_figure_7_accepts_an_acknowledgment_if_and_only_if_both_words_mean_the_same_mode,
            ("MW03", "MW07"),
        ),
        ("echo", _echoes_itself, figures.our_figure_6_echoes_the_selected_mode_for_all_words, ("MW03",)),
    ],
)
def test_a_planted_fault_has_a_counterexample_in_python_too(
    name: str,
    planted: Callable[..., Any],
    theorem: Theorem,
    fields: tuple[str, ...],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shipped = getattr(fplc, name)
    monkeypatch.setattr(fplc, name, planted)
    fallen = [
        query
        for query in theorem.build()
        if query.expected == "unsat" and ask_z3(query, "", LONG_MS).answer == "sat"
    ]
    assert fallen
    for query in fallen:
        words = _example(query.formulas, fields)
        assert planted(*words) != shipped(*words)


def _looks_up(MW01: int, MW03: int) -> bool:
    return MW01 in RE


def test_a_figure_that_looks_words_up_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fplc, "permitted", _looks_up)
    with pytest.raises(LintError, match="in"):
        figures.our_figure_5_is_the_order_of_the_levels_for_all_words.queries()


def test_an_old_echo_outlives_errors_only_in_printed_figure_6() -> None:
    for chain in (figures.figure_6_exclusive, figures.figure_6_going_on):
        assert chain(0x1234, CH[3]) == (False, CH[3])
    assert fplc.echo(0x1234) == 0
