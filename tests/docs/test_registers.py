"""Every TOML file of the tree is of a kind that the page of registers explains, and the kinds are few."""

from __future__ import annotations

import re
from fnmatch import fnmatchcase

from modeproof.ground.places import root

PAGE = "docs/registers.md"
MOST_KINDS, MOST_LINES = 20, 21_000
LEFT_OUT = re.compile(r"^(?:\.|build/|(?:pyproject|docs/site/zensical)\.toml$)")
"""What is made, and the settings of other tools."""


def kinds(page: str) -> list[list[str]]:
    """The patterns of each row of the table."""
    rows = re.findall(r"^\| (`[^|]*\.toml`) \|", page, re.MULTILINE)
    return [re.findall(r"`([^`]+)`", row) for row in rows]


def files() -> list[str]:
    """Every TOML file; those of the toy document count as those of a document."""
    found = (path.relative_to(root()).as_posix() for path in root().rglob("*.toml"))
    return sorted(name.removeprefix("tests/sixth/") for name in found if not LEFT_OUT.match(name))


def problems(page: str, names: list[str]) -> list[str]:
    """Files of no kind or of several, and kinds without a file."""
    rows = kinds(page)
    found = [
        f"{name}: {len(own)} kinds"
        for name in names
        if len(own := [row for row in rows if any(fnmatchcase(name, pattern) for pattern in row)]) != 1
    ]
    unused = (pattern for row in rows for pattern in row if not any(fnmatchcase(n, pattern) for n in names))
    return [*found, *(f"{pattern}: no file" for pattern in unused)]


def test_each_file_is_of_one_kind_that_the_page_explains() -> None:
    page = (root() / PAGE).read_text(encoding="utf-8")
    assert problems(page, files()) == []
    assert len(kinds(page)) <= MOST_KINDS


def test_a_kind_without_row_or_file_is_found() -> None:
    page = (root() / PAGE).read_text(encoding="utf-8")
    assert problems(page, [*files(), "spec/edm/scores.toml"]) == ["spec/edm/scores.toml: 0 kinds"]
    without = [name for name in files() if not name.startswith("scenes/")]
    assert problems(page, without) == ["scenes/*/reasons.toml: no file", "scenes/*/stories.toml: no file"]


def test_the_registers_of_the_specification_stay_short() -> None:
    texts = (path.read_text(encoding="utf-8") for path in (root() / "spec").rglob("*.toml"))
    assert sum(text.count("\n") for text in texts) <= MOST_LINES
