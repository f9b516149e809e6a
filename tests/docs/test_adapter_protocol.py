"""docs/adapter-protocol.md says of hello, relations and refusals what the kit does; tables are whole."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from modeproof.kit.adapter import LONGEST_REFUSAL
from modeproof.kit.errors import Unjudged
from modeproof.kit.hello import read_hello
from modeproof.kit.relation import MOST_LATENCY
from modeproof.kit.vectors import open_suite
from modeproof.suites.kinds import SUITES

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/adapter-protocol.md").read_text(encoding="utf-8")
SUITE = open_suite(ROOT / "vectors/sf_edm/sic.jsonl.gz")


def test_the_page_names_every_field_that_the_kit_reads() -> None:
    class Asked(dict[str, Any]):
        def get(self, key: str, default: Any = None) -> Any:
            asked.add(key)
            return super().get(key, default)

    asked: set[str] = set()
    read_hello(Asked(ok=True), SUITE.outputs, "exact")
    table = PAGE.partition("## What hello says")[2].partition("\n## ")[0]
    rows = re.findall(r"^- \*\*(`.*?)\*\*$", table, re.MULTILINE)
    assert asked == {name for row in rows for name in re.findall(r"`(\w+)`", row)}


@pytest.mark.parametrize(
    ("hello", "relation", "good"),
    [
        ({}, "exact", True),
        ({"relations": ["exact"]}, "monitor", True),
        ({"relations": ["settled"]}, "monitor", True),
        ({"relations": ["settled"]}, "exact", False),
        ({"relations": ["monitor"]}, "settled", False),
        ({"time": "real"}, "exact", False),
        ({"max_latency_scans": 1}, "exact", False),
        ({"other": 1}, "exact", True),
    ],
)
def test_hello_is_read_as_the_page_says(hello: Mapping[str, Any], relation: str, good: bool) -> None:
    try:
        read_hello({"ok": True, **hello}, SUITE.outputs, relation)
    except Unjudged:
        assert not good
    else:
        assert good
    assert f"0 to {MOST_LATENCY:,}" in PAGE and f"at most {LONGEST_REFUSAL} characters" in PAGE


def test_the_page_gives_each_suite_its_relations() -> None:
    table = PAGE.partition("## Which suites there are")[2].partition("\n## ")[0]
    for names, relations in re.findall(r"^\| (`.*?) \|.*\| (.*?) \|$", table, re.MULTILINE):
        for name in re.findall(r"`(\w+)`", names):
            assert relations.split(", ") == list(SUITES[name].relations), name


@pytest.mark.parametrize("page", ["adapter-protocol.md", "check-your-plc.md"])
def test_each_table_is_one_table(page: str) -> None:
    """As many cells in every row as its heading has, and no row by itself."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    tables = [block.splitlines() for block in re.split(r"\n(?!\|)", text) if "\n|" in f"\n{block}"]
    rows = [[line for line in table if line.startswith("|")] for table in tables]
    rows = [table for table in rows if table]
    assert rows
    for table in rows:
        assert re.fullmatch(r"[|:-]+", table[1]), table[0]
        assert {line.count("|") for line in table} == {table[1].count("|")}, table[0]
