"""The page on dialects names what the readers read, refuse and drop, and a test for each difference."""

from __future__ import annotations

import re

import pytest

from modeproof.ground.places import root
from programs.readers import attributes, scl, sources, tia, twincat

PAGE = "docs/dialects.md"


def parts(page: str) -> dict[str, str]:
    """The text below each heading."""
    return dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL))


def rows(text: str) -> list[list[str]]:
    """The cells of a table, without its head."""
    found = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in found[2:]]


def named(text: str, pattern: str) -> set[str]:
    """What is in backticks and fits."""
    return set(re.findall(rf"`({pattern})`", text))


def problems(page: str) -> list[str]:
    """What the page and the code do not say alike."""
    found = parts(page)
    read = "".join(row[1] for row in rows(found["What is read"]))
    refused = "".join(row[0] for row in rows(found["What is refused by its name"]))
    dropped = found["Attributes that change nothing"]
    suffixes = {*sources.TEXTS, *sources.STATEMENT_LIST, ".xml", twincat.TASKS, twincat.PROJECT}
    pairs = {
        "read": (named(read, r"\.\w+"), suffixes),
        "refused": (named(refused, r"\.\w+"), set(sources.CLOSED)),
        "dropped": (named(dropped, r"\w+"), attributes.DROPPED | scl.DROPPED),
    }
    tests = "\n".join(path.read_text("utf-8") for path in (root() / "tests").rglob("test_*.py"))
    differences = rows(found["Where meanings differ"])
    wanted = {name for row in differences for name in named(row[3], r"test_\w+")}
    return [
        *(f"{what}: {sorted(said ^ known)}" for what, (said, known) in pairs.items() if said != known),
        *(f"no test {name}" for name in sorted(wanted) if f"def {name}(" not in tests),
        *(f"no test for {row[0]}" for row in differences if not named(row[3], r"test_\w+")),
    ]


def test_the_page_on_dialects_says_what_the_code_does() -> None:
    assert problems((root() / PAGE).read_text("utf-8")) == []
    assert set(tia.SUFFIXES) <= set(sources.TEXTS)


@pytest.mark.parametrize("gone", ["`.db`, ", "`.l5k`", "`naming`, ", "test_and_looks_at_both_sides"])
def test_a_page_that_says_otherwise_is_found(gone: str) -> None:
    page = (root() / PAGE).read_text("utf-8")
    assert gone in page and problems(page.replace(gone, "")) != []
