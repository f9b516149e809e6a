"""The registers of this repository: no contradiction, no unresolved citation, no orphan, one name for all."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from modeproof.ground.places import documents
from modeproof.registers import judge, judge_tree, load_document
from modeproof.registers.register_judge import Judgement

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = sorted(path.parent.name for path in ROOT.glob("spec/*/interface.toml"))


def test_there_is_a_document() -> None:
    assert FOLDERS


@cache
def judged(name: str) -> Judgement:
    """Each document is judged once."""
    return judge(load_document(ROOT, name))


@pytest.mark.parametrize("name", FOLDERS)
def test_every_register_is_as_expected(name: str) -> None:
    judgement = judged(name)
    assert [str(problem) for problem in judgement.problems] == []
    assert judgement.unresolved == 0
    assert len(judgement.rows) > 3


@pytest.mark.parametrize("name", FOLDERS)
def test_every_column_of_the_matrix_is_filled_somewhere(name: str) -> None:
    rows = judged(name).rows
    for column in ("action", "definition", "step", "property", "theorem", "vector", "finding", "assumption"):
        assert any(getattr(row, column) for row in rows), column


def test_walls_between_rooms_hold_and_rendered_tables_have_not_drifted() -> None:
    assert documents(ROOT) == tuple(FOLDERS)
    assert [str(problem) for problem in judge_tree(ROOT)] == []


LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
CODE = re.compile(r"^```.*?^```$|`[^`\n]*`", re.MULTILINE | re.DOTALL)


def broken_links(root: Path) -> list[str]:
    """Links of README.md, docs/ and examples/ that lead to no file."""
    pages = [root / "README.md", *root.glob("docs/**/*.md"), *root.glob("examples/**/*.md")]
    return [
        f"{page.relative_to(root).as_posix()}: {target}"
        for page in pages
        for target in LINK.findall(CODE.sub("", page.read_text(encoding="utf-8")))
        if "://" not in target and not (page.parent / target).exists()
    ]


def test_every_link_of_every_page_leads_somewhere(tmp_path: Path) -> None:
    assert broken_links(ROOT) == []
    (tmp_path / "README.md").write_text("[a](docs/a.md) [b](docs/gone.md#x) `[c](no)` [d](https://e.org/f)\n")
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs/a.md").write_text("[up](../README.md)\n")
    assert broken_links(tmp_path) == ["README.md: docs/gone.md"]
