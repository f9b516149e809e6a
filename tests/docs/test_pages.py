"""Pages that a person reads: their lines and size, the words of README, and the files for contributors."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from modeproof.ground.fitted import WIDTH, fitted, too_long

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ("", "docs", "examples", "vectors", ".github")
TABLES = {"dialects.md", "wire-your-machine.md", "mode-selector.md", "registers.md"}
"""Pages whose tables are compared with the code by tests, row by row: they stay tables, however wide."""
LARGEST = 41_000
MOST_WORDS = 600


def pages() -> list[Path]:
    """All pages of the tree."""
    found = [path for room in ROOMS for path in (ROOT / room).glob("*.md" if not room else "**/*.md")]
    return sorted({path for path in found if "build" not in path.relative_to(ROOT).parts})


def words(text: str) -> int:
    """The words of a page: all but its picture in Mermaid."""
    return len(re.sub(r"```mermaid.*?```", "", text, flags=re.DOTALL).split())


@pytest.mark.parametrize("path", pages(), ids=lambda path: str(path.relative_to(ROOT)))
def test_no_line_is_too_long_and_no_page_too_large(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    wide = [n for n in too_long(text) if path.name not in TABLES or not lines[n - 1].startswith("|")]
    assert wide == []
    assert len(text.encode()) <= LARGEST or path.name == "CHANGELOG.md"


def test_a_line_of_one_more_is_found() -> None:
    good, bad = "x" * WIDTH, "y" * (WIDTH + 1)
    assert too_long(f"{good}\n{bad}\n```\n{bad}\n```\n| {bad} |\n") == [2, 6]
    assert too_long(f"[{good[4:]}](https://example.org)") == []


def test_readme_has_at_most_six_hundred_words() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert words(text) <= MOST_WORDS
    assert "```mermaid" in text and words("one ```mermaid\ntwo\n``` three") == 2


def test_a_wide_table_alone_becomes_a_list() -> None:
    narrow = "| a | b |\n|---|---|\n| 1 | 2 |\n"
    assert fitted(narrow) == narrow
    wide = fitted(f"| a | b |\n|---|---|\n| 1 | {'two ' * 60}|\n| 3 |  |\n")
    assert wide.startswith("- **1**\n  - b: two two") and wide.endswith("\n- **3**\n")
    assert too_long(wide) == [] and wide.count("two") == 60


def test_a_broken_line_begins_no_list_and_breaks_no_link() -> None:
    text = "word " * 29 + "- then [a link of some words](docs/a.md) " + "and " * 20
    made = fitted(text)
    assert "[a link of some words](docs/a.md)" in made and "\n- " not in made
    assert fitted(made) == made
    entry = fitted("- " + "word " * 50)
    assert entry.splitlines()[1].startswith("  word")


def test_the_hook_has_the_version_of_the_lock() -> None:
    hook = (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    (locked,) = re.findall(r"^ruff==(\S+)", (ROOT / "requirements.lock").read_text(encoding="utf-8"), re.M)
    assert re.findall(r"rev: v(\S+)", hook) == [locked]


def test_the_version_has_its_section_in_the_changelog() -> None:
    (version,) = re.findall(r'^version = "(.*)"', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.M)
    sections = re.findall(r"^## \[(.*?)\](.*)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.M)
    assert sections[0] == ("Unreleased", "")
    assert sections[1][0] == version and re.fullmatch(r" - \d{4}-\d\d-\d\d", sections[1][1])
