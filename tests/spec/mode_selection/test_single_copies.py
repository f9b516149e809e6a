"""One flag word over another: what TLC finds in the specification is what refimpl does."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.registers import load_document
from refimpl.mode_selection import fplc
from tests.spec.mode_selection import single_copies

ROOT = Path(__file__).resolve().parents[3]
RUN = "WIT_KeyFlows_copies"


@pytest.fixture(scope="module")
def cells() -> set[str]:
    return single_copies.single_copies()


def of_the_specification() -> set[str]:
    """Every cell that TLC printed; a run that prints another one, or fewer, is not as expected."""
    run = next(run for run in load_document(ROOT, "mode_selection").runs if run.id == RUN)
    return set(run.witnesses)


@pytest.mark.deep
def test_specification_and_implementation_agree_in_every_cell(cells: set[str]) -> None:
    assert cells == of_the_specification()
    assert len(cells) > 250


def test_the_matrix_has_all_word_pairs_and_words_beside(cells: set[str]) -> None:
    pairs = {tuple(cell.split(" at ")[0].split(" over ")) for cell in cells}
    straight = {(a, b) for a in single_copies.PLACES for b in single_copies.PLACES if a != b}
    beside = {(a, b) for b, words in single_copies.BESIDE.items() for a in words}
    assert pairs == straight | beside


def test_only_touched_modes_switch_and_two_copies_pass_unconfirmed(cells: set[str]) -> None:
    wrong = sorted(cell for cell in cells if "level" in cell)
    place = "MW01 over MW07 at AwaitAcknowledgment, five scans: not confirmed"
    assert wrong == [f"{place} (level 3, mode 0)", f"{place} (level 4, mode 1)"]


def test_an_implementation_that_takes_any_acknowledgment_differs(
    cells: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The planted fault: every permissible acknowledgment confirms every selection."""
    monkeypatch.setattr(fplc, "matches", lambda MW03, MW07: fplc.permissible_acknowledgment(MW07))
    assert single_copies.single_copies() - cells
