"""The registers of this repository: no contradiction, no unresolved citation, no orphan, one name for all."""

from __future__ import annotations

from pathlib import Path

import pytest

from modeproof.registers import documents, judge, judge_tree, load_document

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = sorted(path.parent.name for path in ROOT.glob("spec/*/interface.toml"))


def test_there_is_a_document() -> None:
    assert FOLDERS


@pytest.mark.parametrize("name", FOLDERS)
def test_every_register_is_as_expected(name: str) -> None:
    judgement = judge(load_document(ROOT, name))
    assert [str(problem) for problem in judgement.problems] == []
    assert judgement.unresolved == 0
    assert len(judgement.rows) > 3


@pytest.mark.parametrize("name", FOLDERS)
def test_every_column_of_the_matrix_is_filled_somewhere(name: str) -> None:
    rows = judge(load_document(ROOT, name)).rows
    for column in ("action", "definition", "step", "property", "theorem", "vector", "finding", "assumption"):
        assert any(getattr(row, column) for row in rows), column


def test_walls_between_rooms_hold_and_rendered_tables_have_not_drifted() -> None:
    assert documents(ROOT) == tuple(FOLDERS)
    assert [str(problem) for problem in judge_tree(ROOT)] == []
