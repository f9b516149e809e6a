"""docs/mode-selector.md names our side as the registers do, and leaves out no state of the F-PLC."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from modeproof.registers.load import load_document
from modeproof.registers.rows import Document

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "mode-selector.md").read_text(encoding="utf-8")
BLOCK_WORDS = {"SafetyDemand", "mode_selection"}
"""In code type on the page, and no name of ours."""


@pytest.fixture(scope="module")
def document() -> Document:
    return load_document(ROOT, "mode_selection")


def names_of(document: Document) -> set[str]:
    """Every state, step, signal, parameter, property and finding that a reader can look up."""
    found = {one.id for one in document.properties} | {one.id for one in document.findings}
    for device in document.interface.devices.values():
        groups = (device.inputs, device.outputs, device.parameters)
        found |= {*device.states, *device.steps, *(name for group in groups for name in group)}
    return found


def used_in(page: str) -> set[str]:
    return set(re.findall(r"`([A-Za-z][\w-]*)`", page)) - BLOCK_WORDS


def rows_of_states(page: str) -> list[list[str]]:
    """For each row of the table of states the names before the first bracket of the column `here`."""
    table = page.split("## States and codes")[1].split("\n## ")[0]
    cells = [line.split("|")[5] for line in table.splitlines() if re.match(r"\| [0-9C]", line)]
    return [re.findall(r"`(\w+)`", cell.split("(")[0]) for cell in cells]


def unknown(page: str, document: Document) -> list[str]:
    return sorted(used_in(page) - names_of(document))


def misplaced(page: str, document: Document) -> list[str]:
    """States that do not stand in the table once (both errors of the block are one of ours), or are none."""
    found = [name for row in rows_of_states(page) for name in row]
    times = dict.fromkeys(document.interface.devices["fplc"].states, 1) | {"Error": 2}
    return [name for name in dict.fromkeys([*times, *found]) if found.count(name) != times.get(name)]


def test_each_of_our_names_on_the_page_is_registered(document: Document) -> None:
    assert len(used_in(PAGE)) > 50
    assert unknown(PAGE, document) == []
    assert unknown(PAGE.replace("`MW05`", "`MW06`"), document) == ["MW06"]
    assert unknown(PAGE.replace("`ErrorDropsMode`", "`ErrorKeepsMode`"), document) == ["ErrorKeepsMode"]


def test_every_state_of_the_fplc_is_mapped_once(document: Document) -> None:
    assert len(rows_of_states(PAGE)) == 7
    assert misplaced(PAGE, document) == []
    assert misplaced(PAGE.replace("`Switch`, `Settle`,", "`Switch`,"), document) == ["Settle"]
    assert misplaced(PAGE.replace("| `Start` |", "| `Start`, `Idle` |"), document) == ["Idle"]


def test_the_page_says_what_was_not_available() -> None:
    assert "it was not available, and nothing here quotes it" in " ".join(PAGE.split())
